//! What is read off in every tick, and what a grip amounts to.

use std::f64::consts::{FRAC_PI_2, PI};

use super::phase::Phase;
use crate::{
    base::{Real, Vec3, real::real},
    experiments::record::{Column, Record},
    measure,
    physics::System,
};

/// Share of the normal force on the object that lies within the contact angle; the rest may come
/// from single samples that just touch.
const FORCE_WITHIN: Real = 0.98;

/// What is recorded in every tick: name and unit.
const COLUMNS: [(&str, &str); 14] = [
    ("time", "s"),
    ("grip", "1"),
    ("phase", "1"),
    ("penetration", "m"),
    ("force", "N"),
    ("gauge", "Pa"),
    ("volume", "m^3"),
    ("coordination", "1"),
    ("normal_force", "N"),
    ("contact_angle", "rad"),
    ("coulomb_limit", "N"),
    ("grain_pressure", "Pa"),
    ("kinetic_energy", "J"),
    ("contact_energy", "J"),
];

/// Empty columns.
pub(super) fn columns() -> Vec<Column> {
    COLUMNS.iter().map(|(name, unit)| Column::new(name, unit)).collect()
}

/// When and where a tick was.
#[derive(Clone, Copy)]
pub(super) struct When {
    /// Since the grip began (s).
    pub(super) time: Real,
    /// Number of the grip.
    pub(super) grip: usize,
    /// What was done.
    pub(super) phase: Phase,
    /// How far the object's top is beyond the lowest point of the settled bag (m).
    pub(super) penetration: Real,
    /// Mean vertical force of the membrane on the object over the tick (N), upward positive.
    pub(super) force: Real,
}

/// Writes down a tick. Returns largest overlap over mean diameter, pressure in the grains (Pa), and
/// the number of contacts with the object.
pub(super) fn look(record: &mut Record, system: &System, when: When) -> (Real, Real, usize) {
    let System { model, state, scratch, .. } = system;
    let packing = measure::packing(state, scratch);
    let volume = measure::enclosed_volume(model, state);
    let (pressure, energy) = contacts(system, volume);
    let grip = Grip::new(system);
    let row = [
        when.time,
        real(when.grip),
        real(when.phase as usize),
        when.penetration,
        when.force,
        state.gauge,
        volume,
        packing.coordination_number,
        grip.normal_force,
        grip.angle,
        grip.coulomb_limit,
        pressure,
        measure::kinetic_energy(model, state),
        energy,
    ];
    for (column, value) in record.columns.iter_mut().zip(row) {
        column.values.push(value);
    }
    (packing.overlap_max / (2.0 * model.radius_mean), pressure, packing.n_body_contacts)
}

/// Mean normal stress in the bag, p = Σ F_n l / 3 V over the branches l of all contacts (Pa), and
/// the elastic energy of the normal contacts, Σ 2/5 F_n ξ (J).
fn contacts(system: &System, volume: Real) -> (Real, Real) {
    let System { state, scratch, .. } = system;
    let radii = &state.grains.radii;
    let (mut virial, mut energy) = (0.0, 0.0);
    for (pair, ids) in scratch.touching_pairs(state) {
        let [a, b] = ids.map(|id| radii[id as usize]);
        virial += pair.normal * (a + b - pair.overlap);
        energy += 0.4 * pair.normal * pair.overlap;
    }
    for (patches, radius) in scratch.patch_forces.iter().zip(radii) {
        for patch in &patches.contacts[..patches.n] {
            virial += patch.normal * (radius - patch.overlap);
            energy += 0.4 * patch.normal * patch.overlap;
        }
    }
    (virial / (3.0 * volume), energy)
}

/// How the membrane lies on the object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    /// Sum of all normal forces (N).
    pub(super) normal_force: Real,
    /// Polar angle from the top within which the membrane presses (rad).
    pub(super) angle: Real,
    /// Largest pull that Coulomb friction allows with these normal forces, Σ F_n (μ sin θ − cos θ) (N).
    pub(super) coulomb_limit: Real,
}

impl Grip {
    fn new(system: &System) -> Self {
        let centre = system.controls.bodies[0].pose.translation.vector;
        let touching = system.scratch.sample_forces.iter().filter(|it| it.flags.touches());
        let mut presses: Vec<(Real, Real)> = touching
            .map(|it| (angle_from_top(&(it.point - centre)), it.force.dot(&it.normal)))
            .collect();
        presses.sort_by(|a, b| a.0.total_cmp(&b.0));
        let friction = system.model.bodies[0].law.friction;
        let coulomb_limit =
            presses.iter().map(|(at, force)| force * (friction * at.sin() - at.cos())).sum();
        let normal_force: Real = presses.iter().map(|it| it.1).sum();
        let mut within = 0.0;
        let mut angle = 0.0;
        for (at, force) in presses {
            if FORCE_WITHIN * normal_force <= within {
                break;
            }
            within += force;
            angle = at;
        }
        Self { normal_force, angle, coulomb_limit }
    }
}

fn angle_from_top(arm: &Vec3) -> Real {
    arm.z.atan2(arm.x.hypot(arm.y)).mul_add(-1.0, FRAC_PI_2)
}

/// Force that holds a sphere of `radius` (m) on which `normal_force` (N) lies evenly from the top
/// to the polar angle `angle` (rad), with friction `friction` fully used:
///
/// ```text
/// F_h = 2 π R² p_n [ μ (θ/2 − sin 2θ / 4) − ½ sin² θ ],   p_n = Σ F_n / 2 π R² (1 − cos θ)
/// ```
pub(super) fn pinch(normal_force: Real, angle: Real, friction: Real) -> Real {
    let even = normal_force / (1.0 - angle.cos());
    even * (friction * (angle / 2.0 - (2.0 * angle).sin() / 4.0) - 0.5 * angle.sin().powi(2))
}

/// Contact angle from which a sphere is held with `friction` under even pressure: where `pinch`
/// changes its sign (rad).
pub(super) fn pinch_threshold(friction: Real) -> Real {
    let (mut low, mut high) = (1e-6, PI);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if pinch(1.0, middle, friction) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the thresholds of the pinch formula, found independently by hand to 0.05°.
    #[test]
    fn pinch_changes_its_sign_at_the_known_angles() {
        for (friction, degrees) in
            [(0.25, 125.4), (0.5, 100.5), (0.8, 79.5), (1.0, 69.1), (1.2, 60.8)]
        {
            let found = pinch_threshold(friction).to_degrees();
            assert!((found - degrees).abs() < 0.06, "{friction}: {found}");
        }
    }

    /// Oracle: numeric integral of traction over rings, 1e-6.
    #[test]
    fn pinch_is_the_integral_of_pressure_and_friction() {
        let (angle, friction): (Real, Real) = (2.3, 0.6);
        let n = 20_000;
        let step = angle / f64::from(n);
        let (mut force, mut normal) = (0.0, 0.0);
        for k in 0..n {
            let at = (f64::from(k) + 0.5) * step;
            let ring = 2.0 * PI * at.sin() * step;
            normal += ring;
            force += ring * (friction * at.sin() - at.cos());
        }
        assert!((pinch(normal, angle, friction) / force - 1.0).abs() < 1e-6);
    }
}
