//! The scene of the laws, key by key.

use crate::{
    base::{Real, Vec3},
    physics::{law, membrane::MembraneMaterial},
    scene::{
        Material,
        keys::{Inline, Map, MapOf, Section, scene_keys},
        quantity::{ANGLE, DENSITY, IMPULSE, LENGTH, PRESSURE, SPEED, TIME, TORQUE},
        text::Keys,
        unset::Unset,
        visit::{Quantity, Range, Visitor},
    },
};

const SOME_LENGTH: Quantity = Quantity::above_zero(&LENGTH);
const SOME_PRESSURE: Quantity = Quantity::above_zero(&PRESSURE);
const SOME_SPEED: Quantity = Quantity::above_zero(&SPEED);
const SOME_TIME: Quantity = Quantity::above_zero(&TIME);

/// Names of the materials of Chung & Ooi.
pub(super) const MATERIALS: [&str; 11] = [
    "glass",
    "limestone",
    "aluminium_alloy",
    "magnesium_alloy",
    "aluminium_oxide",
    "cast_iron",
    "aluminium_alloy_of_test_4",
    "steel",
    "polyethylene",
    "copper",
    "nylon",
];

scene_keys! {
    /// The whole scene.
    pub(super) struct LawsScene {
        /// Substeps in the duration of an elastic contact.
        steps_per_contact: usize = 50..=100_000,
        /// The grain of the sources.
        grain: Grain = Map,
        /// Collisions over speed and modulus.
        restitution: Restitution = Map,
        /// The grain whose restitution is published.
        beam_grain: BeamGrain = Map,
        /// Oblique impact.
        oblique: Oblique = Map,
        /// Sliding and rolling.
        rolling: Rolling = Map,
        /// Materials of Chung & Ooi, in the order of `MATERIALS`.
        chung_ooi: [Material; 11] = MapOf(MATERIALS, Map),
        /// The membrane.
        membrane: Membrane = Map,
        /// Spheres under pressure.
        laplace: Laplace = Map,
        /// A grain that is moved over a membrane.
        crossing: Crossing = Map,
    }

    /// The grain of the sources.
    pub(super) struct Grain {
        /// Radius (m).
        radius: Real = SOME_LENGTH,
        /// Its material.
        material: Material = Inline,
        /// Friction and damping of its contacts.
        surface: law::Surface = Inline,
    }

    /// Collisions over speed and modulus.
    pub(super) struct Restitution {
        /// Young's moduli (Pa).
        moduli: Vec3 = SOME_PRESSURE,
        /// Lowest closing speed (m/s).
        speed_min: Real = SOME_SPEED,
        /// Highest closing speed (m/s).
        speed_max: Real = SOME_SPEED,
        /// Number of speeds.
        n_speeds: usize = 2..=1000,
    }

    /// The grain whose restitution is published.
    pub(super) struct BeamGrain {
        /// Radius (m).
        radius: Real = SOME_LENGTH,
        /// Young's modulus (Pa).
        youngs_modulus: Real = SOME_PRESSURE,
        /// Dissipation time (s).
        dissipation_time: Real = SOME_TIME,
        /// Closing speed (m/s).
        speed: Real = SOME_SPEED,
    }

    /// Oblique impact.
    pub(super) struct Oblique {
        /// Young's modulus (Pa).
        youngs_modulus: Real = SOME_PRESSURE,
        /// Speed of incidence (m/s).
        speed: Real = SOME_SPEED,
        /// Difference between two angles of incidence (rad).
        angle_step: Real = Quantity::between(&ANGLE, 0.001, 0.2),
    }

    /// Sliding and rolling.
    pub(super) struct Rolling {
        /// Initial speed (m/s).
        speed: Real = SOME_SPEED,
        /// Substep (s).
        substep: Real = SOME_TIME,
        /// Substeps in which a sticking grain must not creep.
        n_creep_steps: usize = 1000..=100_000_000,
    }

    /// The membrane.
    pub(super) struct Membrane {
        /// Springs and hinges.
        material: MembraneMaterial = Inline,
        /// Edge of a flat patch (m).
        edge: Real = SOME_LENGTH,
        /// Radius of a sphere (m).
        radius: Real = SOME_LENGTH,
        /// Coulomb friction with a grain.
        friction: Real = Range::Above(0.0),
    }

    /// Spheres under pressure.
    pub(super) struct Laplace {
        /// Highest pressure (Pa).
        pressure_max: Real = SOME_PRESSURE,
        /// Number of pressures.
        n_pressures: usize = 1..=100,
        /// Subdivision frequency of the icosphere.
        frequency: usize = 2..=64,
    }

    /// A grain that is moved over a membrane.
    pub(super) struct Crossing {
        /// Overlap over the grain's radius.
        overlap_over_radius: Real = Range::AboveUpTo(0.0, 0.5),
        /// Depth of the membrane's dents over its edge length.
        dent_over_edge: Real = Range::Between(0.0, 0.3),
        /// Distance between two positions (m).
        step: Real = SOME_LENGTH,
        /// Number of paths.
        n_paths ("n_ways"): usize = 1..=1000,
    }
}

impl Section for law::Surface {
    fn walk(&mut self, walk: &mut impl Visitor) {
        walk.number("friction", Range::Above(0.0), &mut self.friction);
        walk.quantity("dissipation_time", SOME_TIME, &mut self.dissipation_time);
        walk.number("tangential_damping", Range::AtLeast(0.0), &mut self.tangential_damping);
    }
}

impl Unset for law::Surface {
    fn unset() -> Self {
        let [friction, dissipation_time, tangential_damping] = Unset::unset();
        Self { friction, dissipation_time, tangential_damping }
    }
}

impl Section for MembraneMaterial {
    fn walk(&mut self, walk: &mut impl Visitor) {
        walk.quantity("thickness", SOME_LENGTH, &mut self.thickness);
        walk.quantity("youngs_modulus", SOME_PRESSURE, &mut self.youngs_modulus);
        walk.quantity("density", Quantity::above_zero(&DENSITY), &mut self.density);
        walk.number("spring_damping", Range::Between(0.0, 1.0), &mut self.spring_damping);
        let stiffness = Quantity::above_zero(&TORQUE);
        walk.quantity("bending_stiffness", stiffness, &mut self.bending_stiffness);
        let damping = Quantity::above_zero(&IMPULSE);
        walk.quantity("bending_damping", damping, &mut self.bending_damping);
    }
}

impl Unset for MembraneMaterial {
    fn unset() -> Self {
        let [thickness, youngs_modulus, density] = Unset::unset();
        let [spring_damping, bending_stiffness, bending_damping] = Unset::unset();
        Self {
            thickness,
            youngs_modulus,
            density,
            spring_damping,
            bending_stiffness,
            bending_damping,
        }
    }
}

impl LawsScene {
    /// A material of the benchmarks of Chung & Ooi.
    pub(super) fn material(&self, name: &str) -> Material {
        let index = MATERIALS.iter().position(|it| *it == name);
        self.chung_ooi[index.expect("the benchmarks name materials of the list")]
    }
}

impl Keys for LawsScene {
    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        let Restitution { speed_min, speed_max, .. } = self.restitution;
        if speed_max <= speed_min {
            let reason = "is not above restitution.speed_min".to_owned();
            unfit.push(("restitution.speed_max", reason, "make it larger"));
        }
        unfit
    }
}
