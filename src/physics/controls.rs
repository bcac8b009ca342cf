//! Controls: the inputs of a substep.

use super::boundary::body::BodyMotion;
use crate::base::Real;

/// The inputs of a substep. `cosim` sets them.
#[derive(Clone, Debug)]
pub struct Controls {
    /// Setpoint of the gauge pressure in the chamber (Pa).
    pub gauge_setpoint: Real,
    /// Motion of each wall: its pose at the end of this substep, and its velocity during it.
    pub walls: Vec<BodyMotion>,
    /// Motion of each rigid body that the membrane can touch.
    pub bodies: Vec<BodyMotion>,
}
