//! The scene of the hollow sphere, key by key.

use crate::{
    base::{Real, real::real},
    scene::{
        Grains, Material, Membrane,
        keys::{Inline, Map, Text, scene_keys},
        quantity::{LENGTH, PRESSURE, TIME},
        text::Keys,
        visit::{Quantity, Range},
    },
};

const SOME_TIME: Quantity = Quantity::above_zero(&TIME);
const SOME_PRESSURE: Quantity = Quantity::above_zero(&PRESSURE);

scene_keys! {
    /// The whole scene.
    pub(super) struct HollowSphereScene {
        /// Name of the scene.
        name: String = Text,
        /// Seed of the first filling.
        seed: u64 = 0..=u64::MAX,
        /// Number of fillings of each case.
        n_fillings: usize = 1..=100,
        /// The grains; the sweep replaces their modulus.
        grains: Grains = Map,
        /// The outer membrane.
        membrane: Membrane = Map,
        /// The inner membrane.
        inner: Inner = Map,
        /// The object in the middle.
        object: Object = Map,
        /// What is done with a packing.
        protocol: Protocol = Map,
        /// What is varied.
        sweep: Sweep = Map,
    }

    /// The inner membrane.
    pub(super) struct Inner {
        /// Subdivision frequency of its icosphere.
        frequency: usize = 1..=64,
        /// Distance of its vertices from the object (m).
        clearance: Real = Quantity::at_least_zero(&LENGTH),
    }

    /// The object in the middle.
    pub(super) struct Object {
        /// Radius (m).
        radius: Real = Quantity::above_zero(&LENGTH),
        /// Its material.
        material: Material = Inline,
        /// Coulomb friction with the membrane.
        friction: Real = Range::AtLeast(0.0),
    }

    /// What is done with a packing.
    pub(super) struct Protocol {
        /// Time in which the outer membrane shrinks to its own size (s).
        close_time: Real = SOME_TIME,
        /// Time to rest before the first level (s).
        rest_time: Real = SOME_TIME,
        /// Vacuum of the last level, positive (Pa).
        vacuum: Real = SOME_PRESSURE,
        /// Number of vacuum levels.
        n_levels: usize = 1..=100,
        /// Duration of a level (s).
        level_time: Real = SOME_TIME,
        /// Share of the critical step that is taken.
        safety: Real = Range::AboveUpTo(0.0, 1.0),
        /// Modulus above which grains are made heavier (Pa).
        mass_scaled_above: Real = SOME_PRESSURE,
    }

    /// What is varied.
    pub(super) struct Sweep {
        /// Moduli of the grains (Pa).
        youngs_moduli: Vec<Real> = SOME_PRESSURE,
        /// Moduli that are repeated without friction (Pa).
        frictionless: Vec<Real> = SOME_PRESSURE,
        /// Moduli that are repeated with the true mass (Pa).
        unscaled: Vec<Real> = SOME_PRESSURE,
        /// Moduli that are repeated with membrane contacts as stiff as the grains (Pa).
        stiff_contacts: Vec<Real> = SOME_PRESSURE,
    }
}

impl Keys for HollowSphereScene {
    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        let inside = self.object.radius + self.inner.clearance + 4.0 * self.grains.radius_max;
        if self.membrane.radius < inside {
            let reason = format!("leaves no room for grains around the object: {inside:.3e} m");
            unfit.push(("membrane.radius", reason, "take a larger shell or a smaller object"));
        }
        if self.grains.radius_max < self.grains.radius_min {
            let reason = "is below radius_min".to_owned();
            unfit.push(("grains.radius_max", reason, "write the smaller radius first"));
        }
        unfit
    }
}

impl Protocol {
    /// Time from closing to the end of the last level (s).
    pub(super) fn total_time(&self) -> Real {
        self.close_time + self.rest_time + real(self.n_levels) * self.level_time
    }
}
