//! Walls and rigid bodies: their surfaces and motion.

pub mod body;
pub mod motion; // prescribed motion of walls
mod polyhedron;
pub mod shape;
#[cfg(test)]
mod tests;
pub mod touching; // contacts of a sphere with triangles
pub mod triangles; // triangulated surfaces of walls
pub mod wall;
