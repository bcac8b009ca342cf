//! Checks of the measured state: a box whose grains have escaped, or whose contact list is empty,
//! would be very fast.

use crate::{
    base::{Real, real::real},
    measure::{kinetic_energy, packing},
    node::lift_monitor::LiftMetrics,
    physics::{Model, Scratch, State},
};

/// Summary of a state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StateSummary {
    pub(super) n_grains: usize,
    pub(super) n_grain_contacts: usize,
    pub(super) n_wall_contacts: usize,
    pub(super) n_membrane_contacts: usize,
    pub(super) n_body_contacts: usize,
    /// Largest overlap between grains (m).
    pub(super) overlap_max: Real,
    /// Largest overlap divided by the mean radius.
    pub(super) overlap_ratio_max: Real,
    /// Kinetic energy of grains and membrane (J).
    pub(super) kinetic_energy: Real,
    /// Mass-weighted root-mean-square speed of the grains, from the kinetic energy (m/s).
    pub(super) speed: Real,
}

/// Limits of a valid state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Minimum number of contacts between grains per grain.
    pub(super) contacts_per_grain: Real,
    /// Maximum overlap divided by the mean radius.
    overlap_ratio: Real,
    /// Minimum and maximum speed of the grains (m/s).
    speed: [Real; 2],
    /// Minimum numbers of contacts with walls, with the membrane, and of the membrane with bodies.
    others: [usize; 3],
}

impl Limits {
    /// Under 50 kPa each of 3000 grains touches 5.8 others, which is 2.9 contacts per grain;
    /// overlaps stay below a tenth of the radius. At rest only a few loose grains still fall on
    /// their neighbors.
    pub(super) const PACKED_AT_REST: Self = Self {
        contacts_per_grain: 2.5,
        overlap_ratio: 0.15,
        speed: [0.0, 5e-3],
        others: [100, 0, 0],
    };
    /// Most contacts persist while the grains shear; 0.02 to 0.2 s after tilting the box, grains
    /// have accelerated no longer than that, with at most half of gravity.
    pub(super) const FLOWING: Self = Self {
        contacts_per_grain: 1.2,
        overlap_ratio: 0.1,
        speed: [0.02, 1.0],
        others: [100, 0, 0],
    };
    /// The vented gripper is full; its grains carry their own weight.
    pub(super) const VENTED: Self = Self {
        contacts_per_grain: 1.5,
        overlap_ratio: 0.15,
        speed: [0.0, 0.05],
        others: [1, 100, 0],
    };
    /// The moving gripper, under vacuum, or vented after the object was set down.
    pub(super) const LIFTED: Self = Self { overlap_ratio: 0.2, speed: [0.0, 0.5], ..Self::VENTED };
    /// Under vacuum, around an object.
    pub(super) const GRIPPING: Self = Self {
        contacts_per_grain: 2.0,
        overlap_ratio: 0.15,
        speed: [0.0, 0.2],
        others: [1, 500, 10],
    };
    /// By Hertz' law overlaps grow as (p/E)^(2/3): those of the softest grains are seven times
    /// those of grains of 100 MPa.
    pub(super) const GRIPPING_SOFT: Self = Self { overlap_ratio: 0.6, ..Self::GRIPPING };
    /// At rest under vacuum in a closed membrane, with about one grain at each triangle.
    pub(super) const CLOSED: Self = Self {
        contacts_per_grain: 2.0,
        overlap_ratio: 0.1,
        speed: [0.0, 5e-3],
        others: [0, 2000, 0],
    };
    /// Under 100 kPa between two plates.
    pub(super) const CONFINED: Self = Self {
        contacts_per_grain: 1.5,
        overlap_ratio: 0.05,
        speed: [1e-3, 0.2],
        others: [10, 300, 0],
    };
}

/// Why a state is not valid for a benchmark.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the state is not valid for a benchmark: {what} {found:.4e}, expected {expected}")]
pub struct InvalidState {
    /// The checked quantity, with its unit.
    pub what: &'static str,
    /// Its value.
    pub found: Real,
    /// The expected values.
    pub expected: String,
}

impl StateSummary {
    /// Summarizes the state after the last substep.
    pub(super) fn of(model: &Model, state: &State, scratch: &Scratch) -> Self {
        let packing = packing(state, scratch);
        let kinetic_energy = kinetic_energy(model, state);
        let mass: Real = state.grains.masses.iter().sum();
        Self {
            n_grains: state.grains.len(),
            n_grain_contacts: packing.n_grain_contacts,
            n_wall_contacts: scratch.wall_forces.iter().filter(|wall| wall.flags.touches()).count(),
            n_membrane_contacts: packing.n_membrane_contacts,
            n_body_contacts: packing.n_body_contacts,
            overlap_max: packing.overlap_max,
            overlap_ratio_max: packing.overlap_max / model.radius_mean,
            kinetic_energy,
            speed: (2.0 * kinetic_energy / mass).sqrt(),
        }
    }

    /// Compares with `limits`.
    ///
    /// # Errors
    /// The first limit that is not met.
    pub(super) fn check(&self, limits: &Limits) -> Result<(), InvalidState> {
        let at_least = |what, found: Real, least: Real| {
            // Written so that NaN fails.
            let is_met = found >= least;
            if is_met { Ok(()) } else { invalid(what, found, format!("at least {least}")) }
        };
        let at_most = |what, found: Real, most: Real| {
            let is_met = found <= most;
            if is_met { Ok(()) } else { invalid(what, found, format!("at most {most}")) }
        };
        let n_grains = real(self.n_grains.max(1));
        let per_grain = real(self.n_grain_contacts) / n_grains;
        at_least("contacts between grains per grain", per_grain, limits.contacts_per_grain)?;
        let [walls, membrane, bodies] = limits.others;
        at_least("contacts with walls", real(self.n_wall_contacts), real(walls))?;
        at_least("contacts with the membrane", real(self.n_membrane_contacts), real(membrane))?;
        at_least("contacts with bodies", real(self.n_body_contacts), real(bodies))?;
        at_most("largest overlap over radius", self.overlap_ratio_max, limits.overlap_ratio)?;
        at_least("speed of the grains [m/s]", self.speed, limits.speed[0])?;
        at_most("speed of the grains [m/s]", self.speed, limits.speed[1])
    }
}

/// Checks that the object was held while it was lifted.
///
/// # Errors
/// If it was not.
pub(super) fn check_lift(verdict: &LiftMetrics) -> Result<(), InvalidState> {
    if verdict.is_held() {
        return Ok(());
    }
    let found = verdict.hold_share_min;
    invalid(
        "share of the flange's rise that the object followed",
        found,
        "a held object".to_owned(),
    )
}

fn invalid(what: &'static str, found: Real, expected: String) -> Result<(), InvalidState> {
    Err(InvalidState { what, found, expected })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        benchmarks::packing::{Boxed, Phase},
        physics::{System, boundary::wall::WallShape},
    };

    /// A small box like the measured ones, after a substep.
    fn packed() -> System {
        let boxed = Boxed { n_grains: 300, n_tiles: [1; 3], phase: Phase::Rest };
        let mut system = boxed.system(boxed.grow().unwrap());
        system.step();
        system
    }

    fn violation(system: &System) -> Option<&'static str> {
        let summary = StateSummary::of(&system.model, &system.state, &system.scratch);
        // A third of 300 grains is at a wall: they have fewer contacts than in larger boxes.
        let limits = Limits { contacts_per_grain: 2.0, ..Limits::PACKED_AT_REST };
        summary.check(&limits).err().map(|it| it.what)
    }

    /// Oracle: what was done to the box. A state that is fast for the wrong reason is rejected.
    #[test]
    fn invalid_boxes_are_rejected() {
        let packed = packed();
        assert_eq!(violation(&packed), None);

        // All grains are far apart: no contacts.
        let mut emptied = packed.clone();
        emptied.state.grains.positions.iter_mut().for_each(|it| *it *= 3.0);
        emptied.step();
        assert_eq!(violation(&emptied), Some("contacts between grains per grain"));

        // The walls have moved away.
        let mut open = packed.clone();
        for (wall, model) in open.controls.walls.iter_mut().zip(&open.model.walls) {
            let WallShape::Plane { normal } = &model.shape else { panic!("a box has planes") };
            wall.pose.translation.vector -= normal;
        }
        open.state.walls.clone_from(&open.controls.walls);
        open.step();
        assert_eq!(violation(&open), Some("contacts with walls"));

        // Grains are larger by a fifth at the same positions.
        let mut crowded = packed.clone();
        crowded.state.grains.radii.iter_mut().for_each(|it| *it *= 1.2);
        crowded.model.radius_max *= 1.2;
        crowded.scratch.neighbors.is_built = false;
        crowded.step();
        assert_eq!(violation(&crowded), Some("largest overlap over radius"));

        // It has exploded, and then become NaN.
        let mut hot = packed.clone();
        hot.state.grains.velocities[7].z = 100.0;
        assert_eq!(violation(&hot), Some("speed of the grains [m/s]"));
        hot.state.grains.velocities[7].z = f64::NAN;
        assert_eq!(violation(&hot), Some("speed of the grains [m/s]"));
    }
}
