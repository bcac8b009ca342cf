//! Measurements in every tick, and the results of a grip from the rows of its record.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{build::PreparedGrip, phase::Phase, scene::GripperScene};
use crate::{
    base::{Real, Vec3, real::real},
    experiments::record::{Column, Record},
    measure,
    physics::System,
};

/// Share of the normal force on the object that acts within the contact angle; the rest may come
/// from single samples that barely touch.
const FORCE_WITHIN: Real = 0.98;

/// Columns of the record, with one row for each tick.
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

/// A tick of a grip.
#[derive(Clone, Copy)]
pub(super) struct Tick {
    /// Time since the start of the grip (s).
    pub(super) time: Real,
    /// Index of the grip.
    pub(super) grip: usize,
    /// Phase of the grip.
    pub(super) phase: Phase,
    /// Height of the object's top above the lowest point of the settled membrane (m).
    pub(super) penetration: Real,
    /// Mean vertical force of the membrane on the object over the tick (N), upward positive.
    pub(super) force: Real,
}

/// Records a tick. Returns the largest overlap over mean diameter, the pressure in the grains (Pa),
/// and the number of contacts with the object.
pub(super) fn record_tick(record: &mut Record, system: &System, tick: Tick) -> (Real, Real, usize) {
    let System { model, state, scratch, .. } = system;
    let packing = measure::packing(state, scratch);
    let volume = measure::enclosed_volume(model, state);
    let (pressure, energy) = contacts(system, volume);
    let object = ObjectContact::new(system);
    record.push_row(&[
        tick.time,
        real(tick.grip),
        real(tick.phase as usize),
        tick.penetration,
        tick.force,
        state.gauge,
        volume,
        packing.coordination_number,
        object.normal_force,
        object.angle,
        object.coulomb_limit,
        pressure,
        measure::kinetic_energy(model, state),
        energy,
    ]);
    (packing.overlap_max / (2.0 * model.radius_mean), pressure, packing.n_body_contacts)
}

/// Mean normal stress of the grains, p = Σ F_n l / 3 V over the branch lengths l of all contacts
/// (Pa), and the elastic energy of the contacts, Σ 2/5 F_n ξ (J).
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

/// Contact between membrane and object.
#[derive(Clone, Copy, Debug)]
struct ObjectContact {
    /// Sum of all normal forces (N).
    normal_force: Real,
    /// Polar angle from the top within which the membrane presses (rad).
    angle: Real,
    /// Largest pull that Coulomb friction allows with these normal forces, Σ F_n (μ sin θ − cos θ)
    /// (N).
    coulomb_limit: Real,
}

impl ObjectContact {
    fn new(system: &System) -> Self {
        let center = system.controls.bodies[0].pose.translation.vector;
        let touching = system.scratch.sample_forces.iter().filter(|it| it.flags.touches());
        let mut forces: Vec<(Real, Real)> = touching
            .map(|it| (angle_from_top(&(it.point - center)), it.force.dot(&it.normal)))
            .collect();
        forces.sort_by(|a, b| a.0.total_cmp(&b.0));
        let friction = system.model.bodies[0].law.friction;
        let coulomb_limit =
            forces.iter().map(|(at, force)| force * (friction * at.sin() - at.cos())).sum();
        let normal_force: Real = forces.iter().map(|it| it.1).sum();
        let mut within = 0.0;
        let mut angle = 0.0;
        for (at, force) in forces {
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

/// Holding force (N) of a sphere with a uniform pressure of the total `normal_force` (N) from the
/// top to the polar angle `angle` (rad), with fully mobilized friction:
///
/// ```text
/// F_h = 2 π R² p_n [ μ (θ/2 − sin 2θ / 4) − ½ sin² θ ],   p_n = Σ F_n / 2 π R² (1 − cos θ)
/// ```
pub(super) fn pinch(normal_force: Real, angle: Real, friction: Real) -> Real {
    let uniform = normal_force / (1.0 - angle.cos());
    uniform * (friction * (angle / 2.0 - (2.0 * angle).sin() / 4.0) - 0.5 * angle.sin().powi(2))
}

/// Smallest contact angle (rad) at which friction holds a sphere under uniform pressure: where
/// `pinch` changes its sign.
pub(super) fn pinch_threshold(friction: Real) -> Real {
    let (mut low, mut high) = (1e-6, PI);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if pinch(1.0, middle, friction) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Share of the penetration without any pull after which none is expected: without vacuum, the
/// membrane pushes the object out all the way.
const NO_PULL_WITHIN: Real = 1.0 / 3.0;

/// Distance after the largest pull beyond which a smaller pull is no fluctuation (m).
const DISTANCE_AFTER_PEAK: Real = 1e-3;

/// True if the grip may end: the pull has fallen far enough below its peak, or there was none on
/// the first third of the distance.
pub(super) fn is_past_peak(record: &Record, grip: usize, scene: &GripperScene) -> bool {
    let until = scene.accelerations.withdraw_until;
    let force = rows(record, grip, Phase::Withdraw, "force");
    let at = rows(record, grip, Phase::Withdraw, "penetration");
    let best = (0..force.len()).max_by(|&a, &b| force[a].total_cmp(&force[b]));
    if let Some(best) = best.filter(|&k| force[k] > 0.0) {
        let distance = at[best] - at[at.len() - 1];
        return distance > DISTANCE_AFTER_PEAK && force[force.len() - 1] < until * force[best];
    }
    let depth = scene.protocol.penetration;
    until > 0.0 && at.last().is_some_and(|&at| at < depth * (1.0 - NO_PULL_WITHIN))
}

/// Values of a column in one phase of one grip.
pub(super) fn rows(record: &Record, grip: usize, phase: Phase, name: &str) -> Vec<Real> {
    let column = |name: &str| record.column(name).unwrap_or(&[]);
    let keys = column("grip").iter().zip(column("phase"));
    let key = [real(grip), real(phase as usize)].map(Real::to_bits);
    keys.zip(column(name))
        .filter(|((grip, phase), _)| [grip.to_bits(), phase.to_bits()] == key)
        .map(|(_, value)| *value)
        .collect()
}

/// Adds the results of a grip to the record, as numbers with the prefix of its name.
pub(super) fn record_results(record: &mut Record, grip: usize, prepared: &PreparedGrip) {
    let name = prepared.change.name();
    let last = |record: &Record, phase, column: &str| {
        rows(record, grip, phase, column).last().copied().unwrap_or(Real::NAN)
    };
    let pull = rows(record, grip, Phase::Withdraw, "force");
    let best = (0..pull.len()).max_by(|&a, &b| pull[a].total_cmp(&pull[b]));
    let at_best = |column: &str| {
        let values = rows(record, grip, Phase::Withdraw, column);
        best.and_then(|k| values.get(k).copied()).unwrap_or(Real::NAN)
    };
    let friction = prepared.scene.gripper.object.friction;
    let normal = last(record, Phase::Hold, "normal_force");
    let angle = last(record, Phase::Hold, "contact_angle");
    let depth = prepared.scene.protocol.penetration;
    let numbers = [
        // A grip without any pull holds nothing.
        ("holding_force", at_best("force").max(0.0), "N"),
        ("holding_distance", depth - at_best("penetration"), "m"),
        ("normal_force_at_best", at_best("normal_force"), "N"),
        ("contact_angle_at_best", at_best("contact_angle"), "rad"),
        ("coulomb_limit_at_best", at_best("coulomb_limit"), "N"),
        ("force_relaxed", last(record, Phase::Relax, "force"), "N"),
        ("force_held", last(record, Phase::Hold, "force"), "N"),
        ("normal_force", normal, "N"),
        ("contact_angle", angle, "rad"),
        ("pinch_force", pinch(normal, angle, friction), "N"),
        ("volume", last(record, Phase::Hold, "volume"), "m^3"),
        ("coordination", last(record, Phase::Hold, "coordination"), "1"),
        ("force_at_end", pull.last().copied().unwrap_or(Real::NAN), "N"),
    ];
    // A grip that starts inserted has no relaxation.
    for (quantity, value, unit) in numbers.into_iter().filter(|it| !it.1.is_nan()) {
        record.set(&format!("{name}.{quantity}"), value, unit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the thresholds of the pinch formula, computed by hand to 0.05°.
    #[test]
    fn pinch_changes_its_sign_at_the_known_angles() {
        for (friction, degrees) in
            [(0.25, 125.4), (0.5, 100.5), (0.8, 79.5), (1.0, 69.1), (1.2, 60.8)]
        {
            let found = pinch_threshold(friction).to_degrees();
            assert!((found - degrees).abs() < 0.06, "{friction}: {found}");
        }
    }

    /// Oracle: numerical integral of the traction over rings. Tolerance: 1e-6.
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
