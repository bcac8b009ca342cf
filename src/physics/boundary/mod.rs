//! What grains and membrane meet besides each other.

pub mod body;
pub mod motion; // how walls move
mod polyhedron;
pub mod shape;
#[cfg(test)]
mod tests;
pub mod touching; // where a sphere touches triangles
pub mod triangles; // rigid surfaces of triangles
pub mod wall;
