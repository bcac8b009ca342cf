//! Pressure of the air inside the membrane: it follows the setpoint with a first-order lag and a rate limit.
//!
//! ```text
//! p ← p + clamp((p_set − p) (1 − e^(−dt/τ)), ±rate_max dt)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | p, p_set | actual and commanded gauge pressure, negative under vacuum | Pa |
//! | τ | time constant of pump and line | s |
//! | rate_max | largest rate of change | Pa/s |
//! | dt | length of a substep | s |
//!
//! Source: no publication; a lag and a limit are the simplest model of a pump and its line, and the
//! update is exact for a constant setpoint while the limit does not act.
//!
//! Valid while τ is long compared with the time that sound takes to cross the membrane, 0.2 ms: the
//! pressure is uniform inside.

use super::{Controls, model::ChamberModel, state::State};
use crate::{base::Real, scene};

impl ChamberModel {
    /// The model of a scene's chamber, for substeps of `dt` (s).
    pub fn new(chamber: &scene::Chamber, dt: Real) -> Self {
        let lag_factor = if chamber.lag > 0.0 { (-dt / chamber.lag).exp() } else { 0.0 };
        Self { lag_factor, change_max: chamber.rate_max * dt }
    }
}

/// Advances the pressure by one substep.
pub fn advance(model: &ChamberModel, controls: &Controls, state: &mut State) {
    let change = (controls.gauge_setpoint - state.gauge) * (1.0 - model.lag_factor);
    state.gauge += change.clamp(-model.change_max, model.change_max);
}
