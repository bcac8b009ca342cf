//! The phases of a grip, and setpoints over time as pure functions, so that a resumed run has the
//! same.

use serde::{Deserialize, Serialize};

use crate::base::Real;

/// The phases of a grip, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Phase {
    /// The object moves up into the gripper.
    Insert,
    /// Nothing moves, the gripper is still vented.
    Relax,
    /// The pressure falls in steps.
    Evacuate,
    /// Nothing moves, the gripper is jammed.
    Hold,
    /// The object moves down until it is free.
    Withdraw,
}

impl Phase {
    /// All of them.
    pub(super) const ALL: [Self; 5] =
        [Self::Insert, Self::Relax, Self::Evacuate, Self::Hold, Self::Withdraw];

    /// Name in records.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Insert => "inserting",
            Self::Relax => "relaxing",
            Self::Evacuate => "evacuating",
            Self::Hold => "holding",
            Self::Withdraw => "withdrawing",
        }
    }

    /// The phase after it; `None` after the last.
    pub(super) fn next(self) -> Option<Self> {
        Self::ALL.get(self as usize + 1).copied()
    }
}

/// A straight motion from rest to rest with a trapezoidal velocity profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    /// Distance (m).
    pub(super) length: Real,
    /// Speed between the ramps (m/s).
    pub(super) speed: Real,
    /// Time to reach the speed, and to stop (s).
    pub(super) ramp: Real,
}

impl Stroke {
    /// The ramp, shortened if the distance is too short for it (s).
    fn ramp(&self) -> Real {
        self.ramp.min(self.length / self.speed)
    }

    /// Duration (s).
    pub(super) fn duration(&self) -> Real {
        self.length / self.speed + self.ramp()
    }

    /// Distance from the start (m) and speed (m/s) at `time` (s).
    pub(super) fn at(&self, time: Real) -> (Real, Real) {
        let (ramp, end) = (self.ramp(), self.duration());
        if end <= time {
            return (self.length, 0.0);
        }
        let (early, late) = (time.clamp(0.0, ramp), (end - time).clamp(0.0, ramp));
        let speed = self.speed * early.min(late) / ramp;
        let distance = if time <= ramp {
            0.5 * speed * time
        } else if end - time <= ramp {
            self.length - 0.5 * speed * (end - time)
        } else {
            self.speed * (time - 0.5 * ramp)
        };
        (distance, speed)
    }
}

/// Value at `time` (s) of a setpoint that goes from 0 to `goal` in `n_steps` equal steps, one
/// every `step_time` (s), the first one at time 0.
pub(super) fn staircase(goal: Real, n_steps: usize, step_time: Real, time: Real) -> Real {
    let n = crate::base::real::real(n_steps);
    goal * ((time / step_time).floor() + 1.0).clamp(1.0, n) / n
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracles: the speed is the derivative of the distance (central difference of a piecewise
    /// quadratic, exact except at the kinks: 1e-6 of the speed away from them), and the ends.
    #[test]
    fn a_stroke_starts_and_ends_at_rest_and_its_speed_is_the_derivative() {
        for stroke in [
            Stroke { length: 0.029, speed: 0.1, ramp: 0.01 },
            Stroke { length: 0.0005, speed: 0.1, ramp: 0.01 },
        ] {
            let end = stroke.duration();
            assert_eq!(stroke.at(0.0), (0.0, 0.0));
            assert_eq!(stroke.at(end), (stroke.length, 0.0));
            let h = end * 1e-6;
            for k in 1..100 {
                let time = end * f64::from(k) / 100.0 + 1e-3 * h;
                let slope = (stroke.at(time + h).0 - stroke.at(time - h).0) / (2.0 * h);
                let speed = stroke.at(time).1;
                assert!((slope - speed).abs() < 2e-4 * stroke.speed, "{time}: {slope} {speed}");
                assert!(speed <= stroke.speed);
            }
        }
    }

    /// Oracle: the definition; to rounding.
    #[test]
    fn the_staircase_has_equal_steps_and_ends_at_its_goal() {
        for (time, expected) in
            [(0.0, -9e3), (0.049, -9e3), (0.051, -18e3), (0.46, -90e3), (0.5, -90e3), (7.0, -90e3)]
        {
            let found = staircase(-90e3, 10, 0.05, time);
            assert!((found - expected).abs() < 1e-9, "{time}: {found}");
        }
    }
}
