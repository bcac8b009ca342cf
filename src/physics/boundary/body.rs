//! Interface to rigid bodies: the motion is an input, the wrench an output.

pub use crate::base::real::Wrench;
use crate::base::{Pose, Vec3, real::Twist};

/// Pose and velocity of a rigid body or a wall. For a body, the origin of its frame is the center of mass.
#[derive(Clone, Copy, Debug)]
pub struct BodyMotion {
    /// Pose in the world.
    pub pose: Pose,
    /// Velocity of the frame's origin (m/s) and angular velocity (rad/s), world axes.
    pub twist: Twist,
}

impl BodyMotion {
    /// Advances the pose by `dt` (s) at constant velocity.
    pub fn advance(&mut self, dt: f64) {
        self.pose.translation.vector += self.twist.linear * dt;
        if self.twist.angular != Vec3::zeros() {
            let rotation = crate::base::Quat::from_scaled_axis(self.twist.angular * dt);
            self.pose.rotation = rotation * self.pose.rotation;
        }
    }
}
