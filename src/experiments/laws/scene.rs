//! The scene of the laws: materials and set-ups, key by key.

use crate::{
    base::{Real, Vec3},
    physics::{law, membrane::MembraneMaterial},
    scene::{
        Material,
        quantity::{ANGLE, DENSITY, IMPULSE, LENGTH, PRESSURE, SPEED, TIME, TORQUE},
        schema,
        text::Keys,
        visit::{Quantity, Range, Visitor},
    },
};

/// All that the laws are measured with.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub(super) steps_per_contact: usize,
    pub(super) grain: Grain,
    pub(super) restitution: Restitution,
    pub(super) beam_grain: BeamGrain,
    pub(super) oblique: Oblique,
    pub(super) rolling: Rolling,
    /// Materials of Chung & Ooi, in the order of `MATERIALS`.
    pub(super) chung_ooi: [Material; 11],
    pub(super) membrane: Membrane,
    pub(super) laplace: Laplace,
    pub(super) crossing: Crossing,
}

/// The grain of the sources.
#[derive(Clone, Debug)]
pub(super) struct Grain {
    /// Radius (m).
    pub(super) radius: Real,
    pub(super) material: Material,
    pub(super) surface: law::Surface,
}

/// Collisions over speed and modulus.
#[derive(Clone, Debug)]
pub(super) struct Restitution {
    /// Young's moduli (Pa).
    pub(super) moduli: Vec3,
    /// (m/s)
    pub(super) speed_min: Real,
    /// (m/s)
    pub(super) speed_max: Real,
    pub(super) n_speeds: usize,
}

/// The grain whose restitution is published.
#[derive(Clone, Debug)]
pub(super) struct BeamGrain {
    /// (m)
    pub(super) radius: Real,
    /// (Pa)
    pub(super) youngs_modulus: Real,
    /// (s)
    pub(super) dissipation_time: Real,
    /// (m/s)
    pub(super) speed: Real,
}

/// Oblique impact.
#[derive(Clone, Debug)]
pub(super) struct Oblique {
    /// (Pa)
    pub(super) youngs_modulus: Real,
    /// (m/s)
    pub(super) speed: Real,
    /// (rad)
    pub(super) angle_step: Real,
}

/// Sliding and rolling.
#[derive(Clone, Debug)]
pub(super) struct Rolling {
    /// (m/s)
    pub(super) speed: Real,
    /// (s)
    pub(super) substep: Real,
    pub(super) n_creep_steps: usize,
}

/// The sheet.
#[derive(Clone, Debug)]
pub(super) struct Membrane {
    pub(super) sheet: MembraneMaterial,
    /// Edge of a flat patch (m).
    pub(super) edge: Real,
    /// Radius of a sphere (m).
    pub(super) radius: Real,
    pub(super) friction: Real,
}

/// Spheres under pressure.
#[derive(Clone, Debug)]
pub(super) struct Laplace {
    /// (Pa)
    pub(super) pressure_max: Real,
    pub(super) n_pressures: usize,
    pub(super) frequency: usize,
}

/// A grain that is moved over a sheet.
#[derive(Clone, Debug)]
pub(super) struct Crossing {
    pub(super) overlap_over_radius: Real,
    pub(super) dent_over_edge: Real,
    /// (m)
    pub(super) step: Real,
    pub(super) n_ways: usize,
}

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

impl Keys for Scene {
    fn walk(&mut self, walk: &mut impl Visitor) {
        schema::whole_usize(walk, "steps_per_contact", (50, 100_000), &mut self.steps_per_contact);
        walk.section("grain", |walk| grain(walk, &mut self.grain));
        walk.section("restitution", |walk| restitution(walk, &mut self.restitution));
        walk.section("beam_grain", |walk| beam_grain(walk, &mut self.beam_grain));
        walk.section("oblique", |walk| oblique(walk, &mut self.oblique));
        walk.section("rolling", |walk| rolling(walk, &mut self.rolling));
        walk.section("chung_ooi", |walk| {
            for (name, it) in MATERIALS.into_iter().zip(&mut self.chung_ooi) {
                walk.section(name, |walk| schema::material(walk, it));
            }
        });
        walk.section("membrane", |walk| membrane(walk, &mut self.membrane));
        walk.section("laplace", |walk| laplace(walk, &mut self.laplace));
        walk.section("crossing", |walk| crossing(walk, &mut self.crossing));
    }

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

fn grain(walk: &mut impl Visitor, it: &mut Grain) {
    walk.quantity("radius", Quantity::above_zero(&LENGTH), &mut it.radius);
    schema::material(walk, &mut it.material);
    walk.number("friction", Range::Above(0.0), &mut it.surface.friction);
    let time = Quantity::above_zero(&TIME);
    walk.quantity("dissipation_time", time, &mut it.surface.dissipation_time);
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut it.surface.tangential_damping);
}

fn restitution(walk: &mut impl Visitor, it: &mut Restitution) {
    walk.vector("moduli", Quantity::above_zero(&PRESSURE), &mut it.moduli);
    walk.quantity("speed_min", Quantity::above_zero(&SPEED), &mut it.speed_min);
    walk.quantity("speed_max", Quantity::above_zero(&SPEED), &mut it.speed_max);
    schema::whole_usize(walk, "n_speeds", (2, 1000), &mut it.n_speeds);
}

fn beam_grain(walk: &mut impl Visitor, it: &mut BeamGrain) {
    walk.quantity("radius", Quantity::above_zero(&LENGTH), &mut it.radius);
    walk.quantity("youngs_modulus", Quantity::above_zero(&PRESSURE), &mut it.youngs_modulus);
    walk.quantity("dissipation_time", Quantity::above_zero(&TIME), &mut it.dissipation_time);
    walk.quantity("speed", Quantity::above_zero(&SPEED), &mut it.speed);
}

fn oblique(walk: &mut impl Visitor, it: &mut Oblique) {
    walk.quantity("youngs_modulus", Quantity::above_zero(&PRESSURE), &mut it.youngs_modulus);
    walk.quantity("speed", Quantity::above_zero(&SPEED), &mut it.speed);
    walk.quantity("angle_step", Quantity::between(&ANGLE, 0.001, 0.2), &mut it.angle_step);
}

fn rolling(walk: &mut impl Visitor, it: &mut Rolling) {
    walk.quantity("speed", Quantity::above_zero(&SPEED), &mut it.speed);
    walk.quantity("substep", Quantity::above_zero(&TIME), &mut it.substep);
    schema::whole_usize(walk, "n_creep_steps", (1000, 100_000_000), &mut it.n_creep_steps);
}

fn membrane(walk: &mut impl Visitor, it: &mut Membrane) {
    let sheet = &mut it.sheet;
    walk.quantity("thickness", Quantity::above_zero(&LENGTH), &mut sheet.thickness);
    walk.quantity("youngs_modulus", Quantity::above_zero(&PRESSURE), &mut sheet.youngs_modulus);
    walk.quantity("density", Quantity::above_zero(&DENSITY), &mut sheet.density);
    walk.number("spring_damping", Range::Between(0.0, 1.0), &mut sheet.spring_damping);
    walk.quantity("bending_stiffness", Quantity::above_zero(&TORQUE), &mut sheet.bending_stiffness);
    walk.quantity("bending_damping", Quantity::above_zero(&IMPULSE), &mut sheet.bending_damping);
    walk.quantity("edge", Quantity::above_zero(&LENGTH), &mut it.edge);
    walk.quantity("radius", Quantity::above_zero(&LENGTH), &mut it.radius);
    walk.number("friction", Range::Above(0.0), &mut it.friction);
}

fn laplace(walk: &mut impl Visitor, it: &mut Laplace) {
    walk.quantity("pressure_max", Quantity::above_zero(&PRESSURE), &mut it.pressure_max);
    schema::whole_usize(walk, "n_pressures", (1, 100), &mut it.n_pressures);
    schema::whole_usize(walk, "frequency", (2, 64), &mut it.frequency);
}

fn crossing(walk: &mut impl Visitor, it: &mut Crossing) {
    walk.number("overlap_over_radius", Range::AboveUpTo(0.0, 0.5), &mut it.overlap_over_radius);
    walk.number("dent_over_edge", Range::Between(0.0, 0.3), &mut it.dent_over_edge);
    walk.quantity("step", Quantity::above_zero(&LENGTH), &mut it.step);
    schema::whole_usize(walk, "n_ways", (1, 1000), &mut it.n_ways);
}

/// A scene before it is read.
pub(super) fn blank() -> Scene {
    let nan = Real::NAN;
    let material = Material { youngs_modulus: nan, poisson_ratio: nan, density: nan };
    let surface = law::Surface { friction: nan, dissipation_time: nan, tangential_damping: nan };
    let sheet = MembraneMaterial {
        thickness: nan,
        youngs_modulus: nan,
        density: nan,
        spring_damping: nan,
        bending_stiffness: nan,
        bending_damping: nan,
    };
    Scene {
        steps_per_contact: 0,
        grain: Grain { radius: nan, material, surface },
        restitution: Restitution {
            moduli: Vec3::repeat(nan),
            speed_min: nan,
            speed_max: nan,
            n_speeds: 0,
        },
        beam_grain: BeamGrain {
            radius: nan,
            youngs_modulus: nan,
            dissipation_time: nan,
            speed: nan,
        },
        oblique: Oblique { youngs_modulus: nan, speed: nan, angle_step: nan },
        rolling: Rolling { speed: nan, substep: nan, n_creep_steps: 0 },
        chung_ooi: [material; 11],
        membrane: Membrane { sheet, edge: nan, radius: nan, friction: nan },
        laplace: Laplace { pressure_max: nan, n_pressures: 0, frequency: 0 },
        crossing: Crossing { overlap_over_radius: nan, dent_over_edge: nan, step: nan, n_ways: 0 },
    }
}
