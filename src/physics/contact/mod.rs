//! Who touches, and how hard: one pass writes the force of every possible contact, then whoever
//! is touched sums its own contacts in a fixed order. No atomics, so the bits do not depend on
//! the number of threads.

pub mod bodies;
pub mod grains;
pub mod law;
pub mod membrane;
pub mod walls;
pub mod sums;
