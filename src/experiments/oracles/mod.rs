//! Closed forms and exact reference solutions to compare measurements with.
//!
//! They are independent of the simulation: separate formulas and small integrations.

pub mod impact; // two bodies that collide
pub mod micro_slip; // oblique impact without the law's simplification
pub mod pinch; // holding force of a rigid glove
pub mod shell; // an elastic shell around an object
