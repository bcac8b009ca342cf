//! Who touches, and how hard: one pass writes the force of every possible contact, then whoever
//! is touched sums its own contacts in a fixed order. No atomics, so the bits do not depend on
//! the number of threads.

pub mod bodies;
mod candidates; // where a grain is closest to the membrane
pub mod grains;
pub mod membrane;
mod sharing; // one force among several places
pub mod spheres;
pub mod sums;
#[cfg(test)]
mod tests;
pub mod walls;

// Where laws were before; callers are to name `physics::law`.
pub use super::law;
