//! The phases of a grip, as set-points over time: pure functions, so that a resumed run meets the
//! same ones.

use serde::{Deserialize, Serialize};

use crate::base::Real;

/// What is done in a grip, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Phase {
    /// The object moves up into the bag.
    Insert,
    /// Nothing moves, the bag is still vented.
    Relax,
    /// The pressure falls in steps.
    Evacuate,
    /// Nothing moves, the bag is jammed.
    Hold,
    /// The object moves down until it is free.
    Withdraw,
}

impl Phase {
    /// All of them.
    pub(super) const ALL: [Self; 5] =
        [Self::Insert, Self::Relax, Self::Evacuate, Self::Hold, Self::Withdraw];

    /// Its name.
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

/// A straight way from rest to rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    /// Its length (m).
    pub(super) length: Real,
    /// The speed between the ramps (m/s).
    pub(super) speed: Real,
    /// How long it takes to reach the speed, and to stop (s).
    pub(super) ramp: Real,
}

impl Way {
    /// The ramp, shorter if the way is too short for it (s).
    fn ramp(&self) -> Real {
        self.ramp.min(self.length / self.speed)
    }

    /// How long it takes (s).
    pub(super) fn duration(&self) -> Real {
        self.length / self.speed + self.ramp()
    }

    /// Distance from the beginning (m) and speed (m/s) at `time` (s).
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

/// A set-point that goes from 0 to `goal` in `n_steps` equal steps, one each `step_time` (s), the
/// first at once; its value at `time` (s).
pub(super) fn staircase(goal: Real, n_steps: usize, step_time: Real, time: Real) -> Real {
    let n = crate::base::real::real(n_steps);
    goal * ((time / step_time).floor() + 1.0).clamp(1.0, n) / n
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracles: the speed is the derivative of the distance (central difference of a piecewise
    /// quadratic, exact but at the kinks: 1e-6 of the speed away from them), and the ends.
    #[test]
    fn the_way_begins_and_ends_at_rest_and_its_speed_is_its_derivative() {
        for way in [
            Way { length: 0.029, speed: 0.1, ramp: 0.01 },
            Way { length: 0.0005, speed: 0.1, ramp: 0.01 },
        ] {
            let end = way.duration();
            assert_eq!(way.at(0.0), (0.0, 0.0));
            assert_eq!(way.at(end), (way.length, 0.0));
            let h = end * 1e-6;
            for k in 1..100 {
                let time = end * f64::from(k) / 100.0 + 1e-3 * h;
                let slope = (way.at(time + h).0 - way.at(time - h).0) / (2.0 * h);
                let speed = way.at(time).1;
                assert!((slope - speed).abs() < 2e-4 * way.speed, "{time}: {slope} {speed}");
                assert!(speed <= way.speed);
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
