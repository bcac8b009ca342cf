//! How a kinematic body follows commanded poses within its limits.
//!
//! ```text
//! v_wanted = ê min(v_max, s(|e|)),   |v − v_before| ≤ a_max dt
//! s(e) = e/τ                 for e ≤ a τ²
//!        √(2 a (e − a τ²/2)) beyond,        a = 0.8 a_max
//! ```
//!
//! e is the remaining distance vector to the target; τ = 50 ms smooths targets that arrive in steps of a
//! controller's period. Farther away the body brakes at a, slightly less than the limit, so that it
//! arrives without overshoot. The same holds for rotations, with the rotation vector as e.

use crate::{
    base::{Pose, Real, Vec3, real::Twist},
    physics::boundary::body::BodyMotion,
    scene,
};

/// Time constant of the approach (s).
const FOLLOW_TIME: Real = 0.05;
/// Fraction of the acceleration limit used for braking.
const BRAKING: Real = 0.8;

/// Velocity and acceleration limits of a kinematic body.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Linear speed (m/s).
    pub speed_max: Real,
    /// Linear acceleration (m/s²).
    pub acceleration_max: Real,
    /// Angular speed (rad/s).
    pub angular_speed_max: Real,
    /// Angular acceleration (rad/s²).
    pub angular_acceleration_max: Real,
}

impl Limits {
    /// The limits of the flange in a scene; they also apply to driven objects.
    pub fn new(flange: &scene::Flange) -> Self {
        Self {
            speed_max: flange.speed_max,
            acceleration_max: flange.acceleration_max,
            angular_speed_max: flange.angular_speed_max,
            angular_acceleration_max: flange.angular_acceleration_max,
        }
    }

    /// Velocity after `dt` (s) of a body that moves to `target`.
    pub fn follow(&self, target: &Pose, motion: &BodyMotion, dt: Real) -> Twist {
        let offset = target.translation.vector - motion.pose.translation.vector;
        let turn = (target.rotation * motion.pose.rotation.inverse()).scaled_axis();
        let linear = (self.speed_max, self.acceleration_max);
        let angular = (self.angular_speed_max, self.angular_acceleration_max);
        Twist {
            linear: approach(offset, motion.twist.linear, linear, dt),
            angular: approach(turn, motion.twist.angular, angular, dt),
        }
    }
}

fn approach(offset: Vec3, velocity: Vec3, (fastest, acceleration): (Real, Real), dt: Real) -> Vec3 {
    let distance = offset.norm();
    let braking = BRAKING * acceleration;
    let near = braking * FOLLOW_TIME * FOLLOW_TIME;
    let approach = if distance <= near {
        distance / FOLLOW_TIME
    } else {
        (2.0 * braking * (distance - near / 2.0)).sqrt()
    };
    let speed = fastest.min(approach);
    // Below any distance that matters, a flange at rest keeps the bits of the pose.
    let target = if distance > 1e-12 { offset * (speed / distance) } else { Vec3::zeros() };
    let change = target - velocity;
    let size = change.norm();
    let allowed = acceleration * dt;
    if size > allowed { velocity + change * (allowed / size) } else { target }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        speed_max: 0.2,
        acceleration_max: 1.0,
        angular_speed_max: 1.0,
        angular_acceleration_max: 5.0,
    };

    #[test]
    fn a_far_target_is_reached_within_the_limits_and_without_overshoot() {
        // Oracle: the limits themselves; the final pose equals the target to a micrometer.
        let target = Pose::new(Vec3::new(0.0, 0.0, 0.3), Vec3::new(0.0, 0.5, 0.0));
        let mut motion = BodyMotion { pose: Pose::identity(), twist: Twist::zero() };
        let dt = 1e-3;
        for _ in 0..4000 {
            let before = motion.twist;
            motion.twist = LIMITS.follow(&target, &motion, dt);
            assert!(motion.twist.linear.norm() <= 0.2 + 1e-12);
            assert!((motion.twist.linear - before.linear).norm() <= 1e-3 + 1e-12);
            motion.advance(dt);
            assert!(motion.pose.translation.z < 0.3 + 1e-6);
        }
        assert!((motion.pose.translation.vector - target.translation.vector).norm() < 1e-6);
        assert!(motion.pose.rotation.angle_to(&target.rotation) < 1e-6);
    }
}
