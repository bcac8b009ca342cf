//! What grains and membrane meet besides each other.

pub mod shape;
mod polyhedron;
#[cfg(test)]
mod tests;
