//! The scene of the hollow sphere, key by key.

use crate::{
    base::{Real, real::real},
    scene::{
        Grains, Material, Membrane,
        quantity::{LENGTH, PRESSURE, TIME},
        schema,
        text::Keys,
        unset,
        visit::{Quantity, Range, Visitor},
    },
};

/// All that the experiment is made of.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub(super) name: String,
    pub(super) seed: u64,
    /// Packings of each case.
    pub(super) n_fillings: usize,
    /// The modulus is that of the sweep.
    pub(super) grains: Grains,
    /// The outer membrane.
    pub(super) membrane: Membrane,
    /// Subdivision frequency of the inner membrane.
    pub(super) inner_frequency: usize,
    /// How far the inner membrane's vertices are from the object (m).
    pub(super) inner_clearance: Real,
    pub(super) object: Object,
    pub(super) protocol: Protocol,
    pub(super) sweep: Sweep,
}

/// The object in the middle.
#[derive(Clone, Debug)]
pub(super) struct Object {
    /// Radius (m).
    pub(super) radius: Real,
    pub(super) material: Material,
    /// With the membrane.
    pub(super) friction: Real,
}

/// What is done.
#[derive(Clone, Debug)]
pub(super) struct Protocol {
    /// (s)
    pub(super) close_time: Real,
    /// (s)
    pub(super) rest_time: Real,
    /// Last vacuum, positive (Pa).
    pub(super) vacuum: Real,
    pub(super) n_levels: usize,
    /// (s)
    pub(super) level_time: Real,
    /// Share of the critical step.
    pub(super) safety: Real,
    /// Modulus above which grains are made heavier (Pa).
    pub(super) mass_scaled_above: Real,
}

/// Which cases there are.
#[derive(Clone, Debug)]
pub(super) struct Sweep {
    /// (Pa)
    pub(super) youngs_moduli: Vec<Real>,
    /// (Pa)
    pub(super) frictionless: Vec<Real>,
    /// (Pa)
    pub(super) unscaled: Vec<Real>,
    /// (Pa)
    pub(super) stiff_contacts: Vec<Real>,
}

impl Scene {
    /// Before it is read.
    pub(super) fn blank() -> Self {
        let nan = Real::NAN;
        let gripper = unset::scene();
        Self {
            name: String::new(),
            seed: 0,
            n_fillings: 0,
            grains: gripper.grains,
            membrane: gripper.membrane,
            inner_frequency: 0,
            inner_clearance: nan,
            object: Object { radius: nan, material: gripper.grains.material, friction: nan },
            protocol: Protocol {
                close_time: nan,
                rest_time: nan,
                vacuum: nan,
                n_levels: 0,
                level_time: nan,
                safety: nan,
                mass_scaled_above: nan,
            },
            sweep: Sweep {
                youngs_moduli: vec![],
                frictionless: vec![],
                unscaled: vec![],
                stiff_contacts: vec![],
            },
        }
    }
}

impl Keys for Scene {
    fn walk(&mut self, walk: &mut impl Visitor) {
        walk.text("name", &mut self.name);
        walk.whole("seed", 0, u64::MAX, &mut self.seed);
        schema::whole_usize(walk, "n_fillings", (1, 100), &mut self.n_fillings);
        walk.section("grains", |walk| schema::grains(walk, &mut self.grains));
        walk.section("membrane", |walk| schema::membrane(walk, &mut self.membrane));
        walk.section("inner", |walk| {
            schema::whole_usize(walk, "frequency", (1, 64), &mut self.inner_frequency);
            walk.quantity("clearance", Quantity::at_least_zero(&LENGTH), &mut self.inner_clearance);
        });
        walk.section("object", |walk| {
            walk.quantity("radius", Quantity::above_zero(&LENGTH), &mut self.object.radius);
            schema::material(walk, &mut self.object.material);
            walk.number("friction", Range::AtLeast(0.0), &mut self.object.friction);
        });
        walk.section("protocol", |walk| self.protocol.walk(walk));
        walk.section("sweep", |walk| {
            let modulus = Quantity::above_zero(&PRESSURE);
            walk.quantities("youngs_moduli", modulus, &mut self.sweep.youngs_moduli);
            walk.quantities("frictionless", modulus, &mut self.sweep.frictionless);
            walk.quantities("unscaled", modulus, &mut self.sweep.unscaled);
            walk.quantities("stiff_contacts", modulus, &mut self.sweep.stiff_contacts);
        });
    }

    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        let inside = self.object.radius + self.inner_clearance + 4.0 * self.grains.radius_max;
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
    /// From the closing to the last level (s).
    pub(super) fn total_time(&self) -> Real {
        self.close_time + self.rest_time + real(self.n_levels) * self.level_time
    }

    fn walk(&mut self, walk: &mut impl Visitor) {
        let time = Quantity::above_zero(&TIME);
        walk.quantity("close_time", time, &mut self.close_time);
        walk.quantity("rest_time", time, &mut self.rest_time);
        walk.quantity("vacuum", Quantity::above_zero(&PRESSURE), &mut self.vacuum);
        schema::whole_usize(walk, "n_levels", (1, 100), &mut self.n_levels);
        walk.quantity("level_time", time, &mut self.level_time);
        walk.number("safety", Range::AboveUpTo(0.0, 1.0), &mut self.safety);
        let modulus = Quantity::above_zero(&PRESSURE);
        walk.quantity("mass_scaled_above", modulus, &mut self.mass_scaled_above);
    }
}
