//! What grains and membrane meet besides each other.

pub mod body;
mod polyhedron;
pub mod shape;
#[cfg(test)]
mod tests;
pub mod wall;
