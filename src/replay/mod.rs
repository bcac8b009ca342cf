//! Recordings, run again.

pub mod again; // a run from what is in a recording
pub mod branch; // a new run from a recorded moment
pub mod history; // which releases changed results
pub mod play; // publishes again with the original timing
#[cfg(feature = "ros")]
pub mod stage; // where played messages go
pub mod verify; // is every tick as it was?
