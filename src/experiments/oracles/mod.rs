//! Closed forms and exact reference solutions that measurements are set beside.
//!
//! Nothing here knows the simulation: these are formulas and small integrations of their own.

pub mod impact; // two bodies that collide
pub mod micro_slip; // oblique impact without the law's simplification
pub mod pinch; // what a rigid glove holds
pub mod shell; // an elastic shell around an object
