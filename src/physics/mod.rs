//! Grains, membrane and chamber: pure functions of model, state and controls.

pub mod membrane;
pub mod boundary;
