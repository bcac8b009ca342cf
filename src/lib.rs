//! `jamgrip`: co-simulation of granular jamming grippers for ROS 2.
//!
//! This list is the table of contents and the law: a module uses only modules listed above it.

pub mod base; // words that everything shares
pub mod scene; // text to checked numbers
pub mod physics; // grains, membrane, chamber
pub mod measure; // what a state shows
pub mod cosim; // one tick of the coupled system
pub mod command; // what the outside may ask
pub mod session; // one run in memory
pub mod snapshot; // what the outside may see
pub mod controller; // who asks, if nobody outside does
pub mod experiments; // validated experiments, cut into cases
pub mod wire; // bytes for the outside
#[cfg(feature = "bag")]
pub mod bag; // what a recording is, written and read
pub mod sinks; // where snapshots go
pub mod sources; // where commands come from
pub mod services; // where questions come in and answers go out
pub mod simulator; // what ROS 2 users may ask of a simulator
pub mod node; // the running thing
#[cfg(feature = "bag")]
pub mod replay; // recordings, run again
pub mod lab; // runs experiments: threads, files, reports
pub mod benchmarks; // how fast it is
