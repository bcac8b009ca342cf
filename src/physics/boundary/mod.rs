//! What grains and membrane meet besides each other.

pub mod body;
pub mod shape;
