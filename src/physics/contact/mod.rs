//! Contact forces. Passes compute the force of every listed contact. Then the forces on every grain, vertex, wall
//! and body are summed in a fixed order, without atomics, so the bits do not depend on the number of threads.

pub mod bodies;
mod candidates; // closest points of the membrane's triangles
pub mod grains;
pub mod membrane;
#[cfg(test)]
mod body_tests; // grains on bodies
pub mod surfaces; // grains on triangulated walls and bodies
mod sharing; // how several contacts share the force
pub mod spheres;
pub mod sums;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod triangle_tests; // grains on walls of triangles
pub mod walls;
