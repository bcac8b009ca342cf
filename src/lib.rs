//! Co-simulation of granular jamming grippers for ROS 2.
//!
//! This list is the table of contents and the dependency order: a module uses only modules listed
//! above it. `tests/architecture.rs` checks that.

pub mod base; // vectors, ticks, digests, random streams, threads, SIMD lanes
pub mod scene; // text to checked numbers
pub mod physics; // grains, membrane, chamber
pub mod measure; // what a state shows
pub mod cosim; // one tick of the coupled system
pub mod command; // inputs of a session
pub mod session; // one run in memory
pub mod snapshot; // outputs of a session
pub mod controller; // the built-in pick-and-lift controller
pub mod experiments; // validation experiments, divided into cases
pub mod host; // clock, signals, files, terminal
pub mod report; // pages and plots
pub mod runner; // runs experiments: threads, files, reports
pub mod wire; // ROS 2 messages and their encoding
pub mod io; // sinks, sources and their queues
#[cfg(feature = "ros")]
pub mod ros; // the ROS 2 node
#[cfg(feature = "shm")]
pub mod shm; // zero-copy streams
#[cfg(feature = "bag")]
pub mod bag; // recordings, written and read
pub mod simulator; // simulation_interfaces and gripper services
pub mod node; // the running node
#[cfg(feature = "bag")]
pub mod replay; // plays, verifies and branches recordings
pub mod benchmarks; // performance cases
