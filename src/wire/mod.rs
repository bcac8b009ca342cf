//! Bytes for the outside; pure functions from snapshots to messages and back to commands.

pub mod topics;
pub mod rows;
