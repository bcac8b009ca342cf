//! The scene of the packings, key by key.

use crate::{
    base::Real,
    physics::law,
    scene::{
        Material,
        quantity::{IMPULSE, LENGTH, PRESSURE, TIME, TORQUE},
        schema,
        text::Keys,
        visit::{Quantity, Range, Visitor},
    },
};

/// All that the packings are made with.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub(super) seed: u64,
    pub(super) grains: Grains,
    /// Coulomb frictions of the cases with grains of one size.
    pub(super) frictions: Vec<Real>,
    pub(super) compression: Compression,
    pub(super) moduli: Moduli,
    pub(super) confined: Confined,
}

/// The grains.
#[derive(Clone, Debug)]
pub(super) struct Grains {
    pub(super) count: usize,
    /// Of smooth grains of one size.
    pub(super) count_smooth: usize,
    /// (m)
    pub(super) radius_min: Real,
    /// (m)
    pub(super) radius_max: Real,
    pub(super) material: Material,
    /// (s)
    pub(super) dissipation_time: Real,
    pub(super) tangential_damping: Real,
}

impl Grains {
    /// What two of them have in common at this friction.
    pub(super) fn surface(&self, friction: Real) -> law::Surface {
        let Self { dissipation_time, tangential_damping, .. } = *self;
        law::Surface { friction, dissipation_time, tangential_damping }
    }

    /// Mean radius (m).
    pub(super) fn radius_mean(&self) -> Real {
        0.5 * (self.radius_min + self.radius_max)
    }
}

/// How grains are made dense.
#[derive(Clone, Debug)]
pub(super) struct Compression {
    /// (s)
    pub(super) substep: Real,
    /// Solid fraction at which they are scattered.
    pub(super) thin: Real,
    /// Time in which velocities decay (s).
    pub(super) drag_time: Real,
    /// Where growth ends with friction (Pa).
    pub(super) pressure_first: Real,
    /// How far they are compressed with friction (Pa).
    pub(super) pressure_last: Real,
    /// Where growth ends without friction (Pa).
    pub(super) pressure_high: Real,
    /// How far they are let go without friction (Pa).
    pub(super) pressure_low: Real,
    /// Change of diameters in a step over the mean overlap.
    pub(super) share: Real,
    /// Length of a step (s).
    pub(super) ramp_time: Real,
    /// Longest rest after a step (s).
    pub(super) rest_time_max: Real,
}

/// The case whose elastic moduli are measured.
#[derive(Clone, Debug)]
pub(super) struct Moduli {
    pub(super) friction: Real,
    /// Where they are measured, rising (Pa).
    pub(super) pressures: Vec<Real>,
    /// Strain of a measurement over the mean overlap of the contacts.
    pub(super) probe: Real,
}

/// The sample in a membrane.
#[derive(Clone, Debug)]
pub(super) struct Confined {
    pub(super) count: usize,
    pub(super) friction: Real,
    /// (Pa)
    pub(super) pressure: Real,
    pub(super) frequency: usize,
    /// (m)
    pub(super) thickness: Real,
    /// (Pa)
    pub(super) youngs_modulus: Real,
    pub(super) friction_membrane: Real,
    pub(super) spring_damping: Real,
    /// (N m)
    pub(super) bending_stiffness: Real,
    /// (N s)
    pub(super) bending_damping: Real,
}

/// A scene in which nothing is set.
pub(super) fn blank() -> Scene {
    const NAN: Real = Real::NAN;
    Scene {
        seed: 0,
        grains: Grains {
            count: 0,
            count_smooth: 0,
            radius_min: NAN,
            radius_max: NAN,
            material: Material { youngs_modulus: NAN, poisson_ratio: NAN, density: NAN },
            dissipation_time: NAN,
            tangential_damping: NAN,
        },
        frictions: Vec::new(),
        compression: Compression {
            substep: NAN,
            thin: NAN,
            drag_time: NAN,
            pressure_first: NAN,
            pressure_last: NAN,
            pressure_high: NAN,
            pressure_low: NAN,
            share: NAN,
            ramp_time: NAN,
            rest_time_max: NAN,
        },
        moduli: Moduli { friction: NAN, pressures: Vec::new(), probe: NAN },
        confined: Confined {
            count: 0,
            friction: NAN,
            pressure: NAN,
            frequency: 0,
            thickness: NAN,
            youngs_modulus: NAN,
            friction_membrane: NAN,
            spring_damping: NAN,
            bending_stiffness: NAN,
            bending_damping: NAN,
        },
    }
}

impl Keys for Scene {
    fn walk(&mut self, walk: &mut impl Visitor) {
        walk.whole("seed", 0, u64::MAX, &mut self.seed);
        walk.section("grains", |walk| grains(walk, &mut self.grains));
        walk.plain_numbers("frictions", Range::AtLeast(0.0), &mut self.frictions);
        walk.section("compression", |walk| compression(walk, &mut self.compression));
        walk.section("moduli", |walk| {
            let it = &mut self.moduli;
            walk.number("friction", Range::Above(0.0), &mut it.friction);
            walk.quantities("pressures", Quantity::above_zero(&PRESSURE), &mut it.pressures);
            walk.number("probe", Range::AboveUpTo(0.0, 0.1), &mut it.probe);
        });
        walk.section("confined", |walk| confined(walk, &mut self.confined));
    }

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
            unfit.push(("compression.pressure_high", reason, "grains are let go from there"));
        }
        unfit
    }
}

fn grains(walk: &mut impl Visitor, it: &mut Grains) {
    schema::whole_usize(walk, "count", (100, 200_000), &mut it.count);
    schema::whole_usize(walk, "count_smooth", (100, 200_000), &mut it.count_smooth);
    let radius = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 0.1) };
    walk.quantity("radius_min", radius, &mut it.radius_min);
    walk.quantity("radius_max", radius, &mut it.radius_max);
    schema::material(walk, &mut it.material);
    walk.quantity("dissipation_time", Quantity::at_least_zero(&TIME), &mut it.dissipation_time);
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut it.tangential_damping);
}

fn compression(walk: &mut impl Visitor, it: &mut Compression) {
    let (time, pressure) = (Quantity::above_zero(&TIME), Quantity::above_zero(&PRESSURE));
    walk.quantity("substep", time, &mut it.substep);
    walk.number("thin", Range::AboveUpTo(0.0, 0.3), &mut it.thin);
    walk.quantity("drag_time", time, &mut it.drag_time);
    walk.quantity("pressure_first", pressure, &mut it.pressure_first);
    walk.quantity("pressure_last", pressure, &mut it.pressure_last);
    walk.quantity("pressure_high", pressure, &mut it.pressure_high);
    walk.quantity("pressure_low", pressure, &mut it.pressure_low);
    walk.number("share", Range::AboveUpTo(0.0, 0.9), &mut it.share);
    walk.quantity("ramp_time", time, &mut it.ramp_time);
    walk.quantity("rest_time_max", time, &mut it.rest_time_max);
}

fn confined(walk: &mut impl Visitor, it: &mut Confined) {
    schema::whole_usize(walk, "count", (50, 100_000), &mut it.count);
    walk.number("friction", Range::AtLeast(0.0), &mut it.friction);
    walk.quantity("pressure", Quantity::above_zero(&PRESSURE), &mut it.pressure);
    schema::whole_usize(walk, "frequency", (2, 64), &mut it.frequency);
    let thickness = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 0.1) };
    walk.quantity("thickness", thickness, &mut it.thickness);
    walk.quantity("youngs_modulus", Quantity::above_zero(&PRESSURE), &mut it.youngs_modulus);
    walk.number("friction_membrane", Range::AtLeast(0.0), &mut it.friction_membrane);
    walk.number("spring_damping", Range::AtLeast(0.0), &mut it.spring_damping);
    walk.quantity("bending_stiffness", Quantity::at_least_zero(&TORQUE), &mut it.bending_stiffness);
    walk.quantity("bending_damping", Quantity::at_least_zero(&IMPULSE), &mut it.bending_damping);
}
