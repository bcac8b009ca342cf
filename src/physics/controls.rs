//! Controls: what the outside wants during the next substeps.

use super::boundary::body::BodyMotion;
use crate::base::{Pose, Real, real::Twist};

/// Inputs held or moved by `cosim` while the physics runs.
#[derive(Clone, Debug)]
pub struct Controls {
    /// Set-point of the chamber's gauge pressure [Pa].
    pub gauge_setpoint: Real,
    /// Pose of the flange at the end of this substep.
    pub flange: Pose,
    /// Velocity of the flange during this substep [m/s], [rad/s].
    pub flange_twist: Twist,
    /// The rigid bodies that the membrane can touch.
    pub bodies: Vec<BodyMotion>,
}
