//! Controls: what the outside wants during the next substeps.

use super::boundary::body::BodyMotion;
use crate::base::Real;

/// Inputs held or moved by `cosim` while the physics runs.
#[derive(Clone, Debug)]
pub struct Controls {
    /// Set-point of the chamber's gauge pressure (Pa).
    pub gauge_setpoint: Real,
    /// The walls: poses at the end of this substep, velocities during it.
    pub walls: Vec<BodyMotion>,
    /// The rigid bodies that the membrane can touch.
    pub bodies: Vec<BodyMotion>,
}
