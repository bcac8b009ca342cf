//! Is it worth measuring? A box whose grains have flown out, or whose list of contacts is empty, is
//! very fast.

use crate::{
    base::{Real, real::real},
    measure::{kinetic_energy, packing},
    node::lift_monitor::LiftMetrics,
    physics::{Model, Scratch, State},
};

/// What a state is like.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seen {
    pub(super) n_grains: usize,
    pub(super) n_grain_contacts: usize,
    pub(super) n_wall_contacts: usize,
    pub(super) n_membrane_contacts: usize,
    pub(super) n_body_contacts: usize,
    /// Largest overlap between grains [m].
    pub(super) overlap_max: Real,
    /// The same over the mean radius.
    pub(super) overlap_ratio_max: Real,
    /// Of grains and membrane [J].
    pub(super) kinetic_energy: Real,
    /// Root of the mean of the grains' v² by mass, from the kinetic energy [m/s].
    pub(super) speed: Real,
}

/// What must be true of a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Contacts between grains, per grain, at least.
    pub(super) contacts_per_grain: Real,
    /// Largest overlap over the mean radius.
    overlap_ratio: Real,
    /// Speed of the grains, from and to [m/s].
    speed: [Real; 2],
    /// Contacts with walls, with the membrane and of the membrane with bodies, at least.
    others: [usize; 3],
}

impl Limits {
    /// Under 50 kPa each of 3000 grains has 5.8 partners, so 2.9 contacts; their overlaps stay below
    /// a tenth of the radius. At rest only a few loose grains still fall on their neighbours.
    pub(super) const PACKED_AT_REST: Self = Self {
        contacts_per_grain: 2.5,
        overlap_ratio: 0.15,
        speed: [0.0, 5e-3],
        others: [100, 0, 0],
    };
    /// Most partners are kept while the grains shear along each other; 0.02 to 0.2 s after the box was tilted
    /// they have fallen for no longer than that, at half the gravity or less.
    pub(super) const FLOWING: Self = Self {
        contacts_per_grain: 1.2,
        overlap_ratio: 0.1,
        speed: [0.02, 1.0],
        others: [100, 0, 0],
    };
    /// The vented bag is full; its grains bear their own weight.
    pub(super) const BAG: Self = Self {
        contacts_per_grain: 1.5,
        overlap_ratio: 0.15,
        speed: [0.0, 0.05],
        others: [1, 100, 0],
    };
    /// The same on its way, under vacuum or vented after the object was set down.
    pub(super) const LIFTED: Self = Self { overlap_ratio: 0.2, speed: [0.0, 0.5], ..Self::BAG };
    /// Under vacuum, around an object.
    pub(super) const GRIPPING: Self = Self {
        contacts_per_grain: 2.0,
        overlap_ratio: 0.15,
        speed: [0.0, 0.2],
        others: [1, 500, 10],
    };
    /// By Hertz overlaps grow as (p/E)^(2/3): those of the softest grains are seven times as deep as those
    /// of 100 MPa.
    pub(super) const GRIPPING_SOFT: Self = Self { overlap_ratio: 0.6, ..Self::GRIPPING };
    /// At rest under vacuum in a closed membrane, whose triangles each have a grain or so.
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

/// Why a state is not worth measuring.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the state is not worth measuring: {what} {found:.4e}, expected {expected}")]
pub struct Unsound {
    /// What was looked at, with its unit.
    pub what: &'static str,
    /// What was found.
    pub found: Real,
    /// What it should be.
    pub expected: String,
}

impl Seen {
    /// Looks at the contacts of the last substep.
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
    /// The first that is not kept.
    pub(super) fn check(&self, limits: &Limits) -> Result<(), Unsound> {
        let at_least = |what, found: Real, least: Real| {
            // Written so that NaN fails.
            let is_kept = found >= least;
            if is_kept { Ok(()) } else { unsound(what, found, format!("{least} at least")) }
        };
        let at_most = |what, found: Real, most: Real| {
            let is_kept = found <= most;
            if is_kept { Ok(()) } else { unsound(what, found, format!("{most} at most")) }
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

/// Whether the object was held while the flange was.
///
/// # Errors
/// If it was not.
pub(super) fn check_lift(verdict: &LiftMetrics) -> Result<(), Unsound> {
    if verdict.is_held() {
        return Ok(());
    }
    let found = verdict.hold_share_min;
    unsound("share of the flange's rise that the object had", found, "a held object".to_owned())
}

fn unsound(what: &'static str, found: Real, expected: String) -> Result<(), Unsound> {
    Err(Unsound { what, found, expected })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        benchmarks::packing::{Boxed, Phase},
        physics::{System, boundary::wall::WallShape},
    };

    /// A small box like those that are measured, after a substep.
    fn packed() -> System {
        let boxed = Boxed { n_grains: 300, n_tiles: [1; 3], phase: Phase::Rest };
        let mut system = boxed.system(boxed.grow().unwrap());
        system.step();
        system
    }

    fn fault(system: &System) -> Option<&'static str> {
        let seen = Seen::of(&system.model, &system.state, &system.scratch);
        // Of 300 grains a third lies at a wall: they have fewer partners than in larger boxes.
        let limits = Limits { contacts_per_grain: 2.0, ..Limits::PACKED_AT_REST };
        seen.check(&limits).err().map(|it| it.what)
    }

    /// Oracle: what was done to the box. A state that would be fast for the wrong reason is refused.
    #[test]
    fn only_a_box_that_is_what_it_says_is_measured() {
        let packed = packed();
        assert_eq!(fault(&packed), None);

        // All grains far apart: no list, no contact.
        let mut emptied = packed.clone();
        emptied.state.grains.positions.iter_mut().for_each(|it| *it *= 3.0);
        emptied.step();
        assert_eq!(fault(&emptied), Some("contacts between grains per grain"));

        // The walls are gone.
        let mut open = packed.clone();
        for (wall, model) in open.controls.walls.iter_mut().zip(&open.model.walls) {
            let WallShape::Plane { normal } = &model.shape else { panic!("a box has planes") };
            wall.pose.translation.vector -= normal;
        }
        open.state.walls.clone_from(&open.controls.walls);
        open.step();
        assert_eq!(fault(&open), Some("contacts with walls"));

        // Grains larger by a fifth in the same places.
        let mut crowded = packed.clone();
        crowded.state.grains.radii.iter_mut().for_each(|it| *it *= 1.2);
        crowded.model.radius_max *= 1.2;
        crowded.scratch.neighbors.is_built = false;
        crowded.step();
        assert_eq!(fault(&crowded), Some("largest overlap over radius"));

        // It has exploded, and then there are no numbers any more.
        let mut hot = packed.clone();
        hot.state.grains.velocities[7].z = 100.0;
        assert_eq!(fault(&hot), Some("speed of the grains [m/s]"));
        hot.state.grains.velocities[7].z = f64::NAN;
        assert_eq!(fault(&hot), Some("speed of the grains [m/s]"));
    }
}
