//! Mean pressure of the normal forces.
//!
//! ```text
//! p = 1/(3 V) Σ F_n l        a third of the trace of the contact stress
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | V | volume | m³ |
//! | F_n | normal force of a contact | N |
//! | l | branch: distance of two grains' centers; at membrane and walls, of the center from the contact point | m |
//!
//! Source: Love–Weber stress of spheres. Valid for quasi-static packings, without the kinetic part.
//! Growth and compression are controlled by it, so it belongs to `physics`, not to `measure`.

use crate::{
    base::Real,
    physics::{Scratch, State},
};

/// Mean pressure (Pa) of the normal forces of the last substep in `volume` (m³).
pub fn normal_pressure(state: &State, scratch: &Scratch, volume: Real) -> Real {
    let radii = &state.grains.radii;
    let mut sum = 0.0;
    for (pair, [i, j]) in scratch.touching_pairs(state) {
        let branch = radii[*i as usize] + radii[*j as usize] - pair.overlap;
        sum += pair.normal * branch;
    }
    for (patches, radius) in scratch.patch_forces.iter().zip(radii) {
        for patch in &patches.contacts[..patches.n] {
            sum += patch.normal * (radius - patch.overlap);
        }
    }
    for (wall, [_, i]) in scratch.touching_walls(state) {
        sum += wall.normal * (radii[i] - wall.overlap / 2.0);
    }
    sum / (3.0 * volume)
}
