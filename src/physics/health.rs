//! Health check of a run, once per tick: speeds, finite numbers, leaks.

use super::{Scratch, State};
use crate::base::{Real, Vec3};

/// Why a run cannot continue.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("tick {tick}: {what} {which} is at {value:e}{}; {remedy}", limit_text(*limit))]
pub struct Diverged {
    /// Tick in which the problem was detected.
    pub tick: u64,
    /// The quantity, with its unit.
    pub what: &'static str,
    /// Index of the grain or vertex.
    pub which: usize,
    /// Its value.
    pub value: Real,
    /// The limit that the value exceeds; `None` for a leak, which has no limit.
    pub limit: Option<Real>,
    /// What the user can do.
    pub remedy: &'static str,
}

impl Diverged {
    /// True if a grain has left the membrane; all numbers are finite then.
    pub fn is_leak(&self) -> bool {
        self.limit.is_none()
    }
}

fn limit_text(limit: Option<Real>) -> String {
    limit.map(|limit| format!(", beyond {limit:e}")).unwrap_or_default()
}

/// Largest speed of a grain or a vertex (m/s); a working gripper stays far below it.
const SPEED_MAX: Real = 50.0;

/// Checks speeds, finiteness and leaks at the end of `tick`.
///
/// # Errors
/// The first problem found; grains are checked before vertices, and both before leaks.
pub fn check(state: &State, scratch: &Scratch, tick: u64) -> Result<(), Diverged> {
    let check_speeds = |what, velocities: &[Vec3]| {
        let limit = SPEED_MAX;
        // The comparison is false for NaN, which must not pass.
        let bad = velocities.iter().position(|v| {
            v.norm_squared().partial_cmp(&(limit * limit)) != Some(std::cmp::Ordering::Less)
        });
        match bad {
            None => Ok(()),
            Some(which) => Err(Diverged {
                tick,
                what,
                which,
                value: velocities[which].norm(),
                limit: Some(limit),
                remedy: "take a shorter substep, a slower pump or slower motion",
            }),
        }
    };
    check_speeds("speed (m/s) of grain", &state.grains.velocities)?;
    check_speeds("speed (m/s) of membrane vertex", &state.membrane.velocities)?;
    if let Some(which) = scratch.leaked {
        let from_carrier = state.grains.positions[which] - state.carrier_position();
        return Err(Diverged {
            tick,
            what: "the membrane leaks: distance from the carrier (m) of grain",
            which,
            value: from_carrier.norm(),
            limit: None,
            remedy: "use a finer or stiffer membrane, larger grains, less pressure or slower motion",
        });
    }
    Ok(())
}
