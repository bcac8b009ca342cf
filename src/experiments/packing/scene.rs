//! The scene of the packings, key by key.

use crate::{
    base::Real,
    physics::law,
    scene::{
        Material,
        keys::{Inline, Map, scene_keys},
        quantity::{IMPULSE, LENGTH, PRESSURE, TIME, TORQUE},
        text::Keys,
        visit::{Quantity, Range},
    },
};

/// A length of a plausible magnitude, so that a wrong unit is detected.
const SOME_LENGTH: Quantity = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 0.1) };
const SOME_TIME: Quantity = Quantity::above_zero(&TIME);
const SOME_PRESSURE: Quantity = Quantity::above_zero(&PRESSURE);

scene_keys! {
    /// The whole scene.
    pub(super) struct PackingScene {
        /// Seed of all random numbers.
        seed: u64 = 0..=u64::MAX,
        /// The grains.
        grains: Grains = Map,
        /// Coulomb frictions of the cases with grains of one size.
        frictions: Vec<Real> = Range::AtLeast(0.0),
        /// How grains are compressed.
        compression: Compression = Map,
        /// The case whose elastic moduli are measured.
        moduli: Moduli = Map,
        /// The sample in a membrane.
        confined: Confined = Map,
    }

    /// The grains.
    pub(super) struct Grains {
        /// Number of grains.
        count: usize = 100..=200_000,
        /// Number of grains of one size without friction.
        count_smooth: usize = 100..=200_000,
        /// Smallest radius (m).
        radius_min: Real = SOME_LENGTH,
        /// Largest radius (m).
        radius_max: Real = SOME_LENGTH,
        /// Their material.
        material: Material = Inline,
        /// Dissipation time of the contacts (s).
        dissipation_time: Real = Quantity::at_least_zero(&TIME),
        /// Damping of the tangential springs.
        tangential_damping: Real = Range::AtLeast(0.0),
    }

    /// How grains are compressed.
    pub(super) struct Compression {
        /// Substep (s).
        substep: Real = SOME_TIME,
        /// Solid fraction at which grains are scattered.
        thin: Real = Range::AboveUpTo(0.0, 0.3),
        /// Time in which velocities decay (s).
        drag_time: Real = SOME_TIME,
        /// Pressure at which growth ends with friction (Pa).
        pressure_first: Real = SOME_PRESSURE,
        /// Pressure up to which grains are compressed with friction (Pa).
        pressure_last: Real = SOME_PRESSURE,
        /// Pressure at which growth ends without friction (Pa).
        pressure_high: Real = SOME_PRESSURE,
        /// Pressure down to which grains are decompressed without friction (Pa).
        pressure_low: Real = SOME_PRESSURE,
        /// Change of all diameters in a step, over the mean overlap.
        share: Real = Range::AboveUpTo(0.0, 0.9),
        /// Duration of a step (s).
        ramp_time: Real = SOME_TIME,
        /// Longest rest after a step (s).
        rest_time_max: Real = SOME_TIME,
    }

    /// The case whose elastic moduli are measured.
    pub(super) struct Moduli {
        /// Coulomb friction.
        friction: Real = Range::Above(0.0),
        /// Pressures at which they are measured, rising (Pa).
        pressures: Vec<Real> = SOME_PRESSURE,
        /// Strain of a measurement, over the mean overlap of the contacts.
        probe: Real = Range::AboveUpTo(0.0, 0.1),
    }

    /// The sample in a membrane.
    pub(super) struct Confined {
        /// Number of grains.
        count: usize = 50..=100_000,
        /// Coulomb friction between grains.
        friction: Real = Range::AtLeast(0.0),
        /// Vacuum, positive (Pa).
        pressure: Real = SOME_PRESSURE,
        /// Subdivision frequency of the icosphere.
        frequency: usize = 2..=64,
        /// Thickness of the membrane (m).
        thickness: Real = SOME_LENGTH,
        /// Young's modulus of the membrane (Pa).
        youngs_modulus: Real = SOME_PRESSURE,
        /// Coulomb friction between grains and membrane.
        friction_membrane: Real = Range::AtLeast(0.0),
        /// Damping ratio of the membrane's springs.
        spring_damping: Real = Range::AtLeast(0.0),
        /// Elastic constant of the hinges (N m).
        bending_stiffness: Real = Quantity::at_least_zero(&TORQUE),
        /// Damping constant of the hinges (N s).
        bending_damping: Real = Quantity::at_least_zero(&IMPULSE),
    }
}

impl Grains {
    /// Surface of two grains with this friction.
    pub(super) fn surface(&self, friction: Real) -> law::Surface {
        let Self { dissipation_time, tangential_damping, .. } = *self;
        law::Surface { friction, dissipation_time, tangential_damping }
    }

    /// Mean radius (m).
    pub(super) fn radius_mean(&self) -> Real {
        0.5 * (self.radius_min + self.radius_max)
    }
}

impl Keys for PackingScene {
    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        if self.grains.radius_max < self.grains.radius_min {
            let reason = "is below grains.radius_min".to_owned();
            unfit.push(("grains.radius_max", reason, "give the larger one here"));
        }
        if self.moduli.pressures.is_empty() || !self.moduli.pressures.is_sorted() {
            let reason = "has no pressure, or one below the one before".to_owned();
            unfit.push(("moduli.pressures", reason, "give rising ones: grains are compressed"));
        }
        let it = &self.compression;
        if it.pressure_last < it.pressure_first {
            let reason = "is below compression.pressure_first".to_owned();
            unfit.push(("compression.pressure_last", reason, "compress further than growth"));
        }
        if it.pressure_high < it.pressure_low {
            let reason = "is below compression.pressure_low".to_owned();
            unfit.push(("compression.pressure_high", reason, "decompression starts there"));
        }
        unfit
    }
}
