//! Bytes for the outside; pure functions from snapshots to messages and back to commands.

pub mod actions;
pub mod cdr;
pub mod from_ros;
pub mod messages;
pub mod to_ros;
pub mod topics;
