//! The built-in controller: a pure state machine from observations to commands.
//!
//! It uses neither clock nor network. The built-in controller and the ROS 2 example in another
//! process are the same state machine with different I/O.

#[cfg(test)]
mod mock_plant;
mod path;
pub mod pick_and_lift;

pub use pick_and_lift::{Observation, Phase, PickAndLift};
