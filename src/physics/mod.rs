//! Physics of grains, membranes, walls and air: deterministic, without input or output.
//!
//! `Model` is what the system consists of, `State` is everything needed to continue, `Controls` are
//! the inputs of a substep, and `Scratch` is everything that can be recomputed. What is published is
//! a `Snapshot`, which belongs to another module. `substep` advances the state; it is a list of
//! stages, each in a file of the same name.

pub mod boundary; // walls and rigid bodies
pub mod chamber; // the air inside the membranes
pub mod contact; // contact forces
pub mod controls;
pub mod critical_step; // the longest stable substep
pub mod fill; // fills a gripper with grains
pub mod health; // detects divergence and leaks
pub mod integrate;
pub mod law; // contact laws
pub mod membrane; // membranes: springs, hinges, pressure
pub mod model;
pub mod neighbors; // lists of possible contacts
pub mod packing; // dense packings of grains
pub mod scratch;
pub mod state;
pub mod substep;
pub mod system;
pub mod builder; // assembles a system from its parts

pub use builder::SystemBuilder;
pub use controls::Controls;
pub use model::Model;
pub use scratch::Scratch;
pub use state::State;
pub use substep::substep;
pub use system::System;
