//! Encoding and decoding of messages: pure functions from snapshots to ROS 2 messages, and from
//! messages to commands.

pub mod actions; // the hidden messages of actions
pub mod cdr; // CDR of any serde type
pub mod from_ros; // messages to commands and back
pub mod messages; // the message types
pub mod to_ros; // snapshots to messages
pub mod topics; // the list of topics
