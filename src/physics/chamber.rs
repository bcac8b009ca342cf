//! The air in the bag: the commanded pressure passes a first-order lag and a rate limit.
//!
//! ```text
//! p ← p + clamp((p_set − p) (1 − e^(−dt/τ)), ±rate_max dt)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | p, p_set | actual and commanded gauge pressure, negative under vacuum | Pa |
//! | τ | time constant of pump and line | s |
//!
//! The pressure is uniform in the bag: sound crosses it in 0.2 ms, far less than any τ.

use super::{Controls, model::ChamberModel, state::State};
use crate::{base::Real, scene};

impl ChamberModel {
    /// The chamber of a scene for substeps of `dt` (s).
    pub fn new(chamber: &scene::Chamber, dt: Real) -> Self {
        let lag_factor = if chamber.lag > 0.0 { (-dt / chamber.lag).exp() } else { 0.0 };
        Self { lag_factor, change_max: chamber.rate_max * dt }
    }
}

/// Moves the pressure on by one substep.
pub fn advance(model: &ChamberModel, controls: &Controls, state: &mut State) {
    let wanted = (controls.gauge_setpoint - state.gauge) * (1.0 - model.lag_factor);
    state.gauge += wanted.clamp(-model.change_max, model.change_max);
}
