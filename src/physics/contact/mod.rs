//! Contact forces. One pass writes the force of every listed contact; then every grain, vertex, wall and body
//! sums its own contacts in a fixed order. There are no atomics, so the bits do not depend on the number of
//! threads.

pub mod bodies;
mod candidates; // where a grain is closest to the membrane
pub mod grains;
pub mod membrane;
#[cfg(test)]
mod body_tests; // grains on bodies
pub mod places; // grains on triangles and bodies
mod sharing; // one force among several places
pub mod spheres;
pub mod sums;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod triangle_tests; // grains on walls of triangles
pub mod walls;
