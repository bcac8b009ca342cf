//! Recordings, run again.

pub mod again; // a run from what is in a recording
pub mod history; // which releases changed results
pub mod verify; // is every tick as it was?
