//! A setpoint that moves straight to its goal, with a ramp at either end.

use crate::base::{Real, Vec3};

/// Time in which the setpoint reaches full speed (s).
const RAMP: Real = 0.1;
/// Distance at which the goal counts as reached (m).
const ARRIVED: Real = 1e-6;

/// A moving setpoint.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// Position (m).
    pub(super) position: Vec3,
    /// Speed (m/s).
    speed: Real,
}

impl Path {
    /// A setpoint at rest.
    pub(super) fn at(position: Vec3) -> Self {
        Self { position, speed: 0.0 }
    }

    /// Stops at once.
    pub(super) fn stop(&mut self) {
        self.speed = 0.0;
    }

    /// Moves toward `goal` for `dt` (s), at most at `speed_max` (m/s). True on arrival.
    pub(super) fn advance(&mut self, goal: &Vec3, speed_max: Real, dt: Real) -> bool {
        let delta = goal - self.position;
        let distance = delta.norm();
        if distance <= ARRIVED {
            self.position = *goal;
            self.speed = 0.0;
            return true;
        }
        let acceleration = speed_max / RAMP;
        let braking = (2.0 * acceleration * distance).sqrt();
        self.speed = (self.speed + acceleration * dt).min(speed_max).min(braking);
        let step = (self.speed * dt).min(distance);
        self.position += delta * (step / distance);
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracles: the speed limit, the length of the path, and the time of a trapezoidal profile,
    /// distance / speed + ramp, within two steps and the last asymptotic one.
    #[test]
    fn the_goal_is_reached_in_the_expected_time_below_the_speed_limit() {
        let goal = Vec3::new(0.0, 0.03, 0.1);
        let mut path = Path::at(Vec3::zeros());
        let (dt, speed_max) = (0.01, 0.05);
        let mut n_steps = 0;
        loop {
            let before = path.position;
            let arrived = path.advance(&goal, speed_max, dt);
            assert!((path.position - before).norm() <= speed_max * dt * (1.0 + 1e-12));
            if arrived {
                break;
            }
            n_steps += 1;
        }
        let time = f64::from(n_steps) * dt;
        let expected = goal.norm() / speed_max + RAMP;
        assert!((time - expected).abs() < 0.1, "{time} s, expected {expected} s");
        assert_eq!(path.position, goal);
    }
}
