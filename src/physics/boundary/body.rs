//! The port to rigid bodies: motion in, wrench out.

pub use crate::base::real::Wrench;
use crate::base::{Pose, Vec3, real::Twist};

/// How a rigid body moves during the next substeps. The frame's origin is the center of mass.
#[derive(Clone, Copy, Debug)]
pub struct BodyMotion {
    /// Pose in the world.
    pub pose: Pose,
    /// Velocity of the center of mass and angular velocity, world axes (m/s), (rad/s).
    pub twist: Twist,
}

impl BodyMotion {
    /// The pose after `dt` seconds at constant twist.
    pub fn advance(&mut self, dt: f64) {
        self.pose.translation.vector += self.twist.linear * dt;
        if self.twist.angular != Vec3::zeros() {
            let turn = crate::base::Quat::from_scaled_axis(self.twist.angular * dt);
            self.pose.rotation = turn * self.pose.rotation;
        }
    }
}
