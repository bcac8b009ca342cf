//! Who decides what the gripper does: a pure state machine from observations to commands.
//!
//! It knows neither clock nor wire, so the built-in controller and the ROS 2 example in another
//! process are the same machine behind different ears and hands.

#[cfg(test)]
mod mock_plant;
mod path;
pub mod pick_and_lift;

pub use pick_and_lift::{Observation, Phase, PickAndLift};
