//! The scene of the triaxial test, key by key.

use crate::{
    base::Real,
    physics::membrane::MembraneMaterial,
    scene::{
        Grains, Material,
        quantity::{FREQUENCY, IMPULSE, LENGTH, PRESSURE, SPEED, TIME, TORQUE},
        schema::{self, whole_usize},
        text::Keys,
        unset,
        visit::{Quantity, Range, Visitor},
    },
};

/// All that a scene says.
#[derive(Clone, Debug)]
pub(super) struct Setup {
    /// Grains; their number is the case's.
    pub(super) grains: Grains,
    /// Coulomb friction of grains on the plates.
    pub(super) plate_friction: Real,
    /// The membrane and its contacts.
    pub(super) membrane: Membrane,
    /// The two sizes of the source.
    pub(super) cases: [Size; 2],
    /// Seeds of the initial states A and B.
    pub(super) seeds: [u64; 2],
    /// How grains grow.
    pub(super) growth: Growth,
    /// How the specimen is put under pressure.
    pub(super) confining: Confining,
    /// How it is sheared.
    pub(super) shear: Shear,
    /// Which cases are run besides the first size.
    pub(super) runs: Runs,
    /// The substep.
    pub(super) time: Time,
}

/// How the substep is derived.
#[derive(Clone, Copy, Debug)]
pub(super) struct Time {
    /// Share of the Rayleigh time of the smallest grain at which the packing is taken to ring.
    pub(super) rayleigh_share: Real,
    /// Share of the critical step that is taken.
    pub(super) safety: Real,
}

/// The sheet and its contacts with grains.
#[derive(Clone, Copy, Debug)]
pub(super) struct Membrane {
    pub(super) material: Material,
    pub(super) thickness: Real,
    pub(super) friction: Real,
    pub(super) spring_damping: Real,
    pub(super) bending_stiffness: Real,
    pub(super) bending_damping: Real,
    /// The same for the fine mesh of the model with spheres.
    pub(super) bending_damping_spheres: Real,
    /// True if hinges take the areas of the straight membrane.
    pub(super) bends_by_first_areas: bool,
    pub(super) dissipation_time: Real,
    pub(super) tangential_damping: Real,
}

impl Membrane {
    /// What a mesh is made of whose hinges have a damping (N s).
    pub(super) fn sheet(&self, bending_damping: Real) -> MembraneMaterial {
        MembraneMaterial {
            thickness: self.thickness,
            youngs_modulus: self.material.youngs_modulus,
            density: self.material.density,
            spring_damping: self.spring_damping,
            bending_stiffness: self.bending_stiffness,
            bending_damping,
        }
    }
}

/// A size of the specimen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) radius: Real,
    pub(super) height: Real,
    /// Mesh and grains of the model with triangles.
    pub(super) triangles: Net,
    /// Mesh and grains of the model with spheres on the vertices.
    pub(super) spheres: Net,
    /// Radius of those spheres (m).
    pub(super) sphere_radius: Real,
}

/// A mesh, and how many grains it holds in the initial states A and B.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Net {
    pub(super) n_around: usize,
    pub(super) n_rows: usize,
    pub(super) n_grains: [usize; 2],
}

/// Growth of the grains in the held membrane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    /// Softer than the grains are: a short substep would make growth take hours.
    pub(super) youngs_modulus: Real,
    pub(super) friction: Real,
    pub(super) dissipation_time: Real,
    /// Solid fraction at which grains are scattered.
    pub(super) first_solid_fraction: Real,
    /// Pressure at which nothing more fits.
    pub(super) pressure_stop: Real,
}

/// From the held specimen to the isotropic state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Confining {
    /// Confining pressure p_c.
    pub(super) pressure: Real,
    /// Time in which pressure and stiffness climb.
    pub(super) ramp: Real,
    /// Speed of a plate per missing stress, times p_c.
    pub(super) servo_speed: Real,
    /// Largest speed of a plate.
    pub(super) servo_speed_max: Real,
    /// Rate at which speeds decay, until the specimen is sheared.
    pub(super) damping: Real,
    /// Kinetic over elastic energy of a specimen at rest.
    pub(super) rest_energy: Real,
    /// Distance of the plates' pressure from p_c, over p_c, at rest.
    pub(super) rest_stress: Real,
    /// Longest time to come to rest.
    pub(super) rest_time_max: Real,
}

/// Shearing at constant speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shear {
    /// Relative speed of the plates as in the source.
    pub(super) speed: Real,
    /// How many times faster they go.
    pub(super) speed_factor: Real,
    /// Time in which they get up to speed.
    pub(super) start_time: Real,
    /// Strain at which it ends.
    pub(super) strain: Real,
    /// Number of recorded points.
    pub(super) n_points: usize,
}

/// Which cases are run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs {
    /// The larger size too.
    pub(super) case2: bool,
    /// Strain to which a specimen is sheared with all that `quick` speeds up at half or less.
    pub(super) check_strain: Real,
    /// Strain to which a specimen with spheres is sheared that is filled less densely; 0 for none.
    pub(super) loose_strain: Real,
    /// How many grains it has.
    pub(super) loose_grains: usize,
    /// The share of the Rayleigh time in that check.
    pub(super) check_rayleigh_share: Real,
    /// Simulated time of the comparison of run times; 0 for none.
    pub(super) timing: Real,
}

/// Before it is read: every number is NaN, so that nothing forgotten can pass for a value.
pub(super) fn blank() -> Setup {
    const NAN: Real = Real::NAN;
    let size = Size {
        radius: NAN,
        height: NAN,
        triangles: Net::default(),
        spheres: Net::default(),
        sphere_radius: NAN,
    };
    Setup {
        grains: unset::GRAINS,
        plate_friction: NAN,
        membrane: Membrane {
            material: unset::MATERIAL,
            thickness: NAN,
            friction: NAN,
            spring_damping: NAN,
            bending_stiffness: NAN,
            bending_damping: NAN,
            bending_damping_spheres: NAN,
            bends_by_first_areas: false,
            dissipation_time: NAN,
            tangential_damping: NAN,
        },
        cases: [size; 2],
        seeds: [0; 2],
        growth: Growth {
            youngs_modulus: NAN,
            friction: NAN,
            dissipation_time: NAN,
            first_solid_fraction: NAN,
            pressure_stop: NAN,
        },
        confining: Confining {
            pressure: NAN,
            ramp: NAN,
            servo_speed: NAN,
            servo_speed_max: NAN,
            damping: NAN,
            rest_energy: NAN,
            rest_stress: NAN,
            rest_time_max: NAN,
        },
        shear: Shear { speed: NAN, speed_factor: NAN, start_time: NAN, strain: NAN, n_points: 0 },
        runs: Runs {
            case2: false,
            check_strain: NAN,
            loose_strain: NAN,
            loose_grains: 0,
            check_rayleigh_share: NAN,
            timing: NAN,
        },
        time: Time { rayleigh_share: NAN, safety: NAN },
    }
}

impl Keys for Setup {
    fn walk(&mut self, walk: &mut impl Visitor) {
        let mut name = String::new();
        walk.text("name", &mut name);
        walk.section("grains", |walk| grains(walk, &mut self.grains));
        walk.section("plates", |walk| {
            walk.number("friction", Range::AtLeast(0.0), &mut self.plate_friction);
        });
        walk.section("membrane", |walk| membrane(walk, &mut self.membrane));
        let [case1, case2] = &mut self.cases;
        walk.section("case1", |walk| size(walk, case1));
        walk.section("case2", |walk| size(walk, case2));
        walk.section("seeds", |walk| {
            let [a, b] = &mut self.seeds;
            walk.whole("a", 0, u64::MAX, a);
            walk.whole("b", 0, u64::MAX, b);
        });
        walk.section("growth", |walk| growth(walk, &mut self.growth));
        walk.section("confining", |walk| confining(walk, &mut self.confining));
        walk.section("shear", |walk| shear(walk, &mut self.shear));
        walk.section("runs", |walk| {
            walk.flag("case2", &mut self.runs.case2);
            let Runs { check_strain, check_rayleigh_share, loose_strain, loose_grains, .. } =
                &mut self.runs;
            walk.number("check_strain", Range::Between(0.0, 0.5), check_strain);
            walk.number("loose_strain", Range::Between(0.0, 0.5), loose_strain);
            whole_usize(walk, "loose_grains", (1, 200_000), loose_grains);
            walk.number("check_rayleigh_share", Range::AboveUpTo(0.0, 1.0), check_rayleigh_share);
            walk.quantity("timing", Quantity::at_least_zero(&TIME), &mut self.runs.timing);
        });
        walk.section("time", |walk| {
            let share = Range::AboveUpTo(0.0, 1.0);
            walk.number("rayleigh_share", share, &mut self.time.rayleigh_share);
            walk.number("safety", share, &mut self.time.safety);
        });
    }

    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        let Grains { radius_min, radius_max, material, .. } = &self.grains;
        if radius_min > radius_max {
            unfit.push((
                "grains.radius_min",
                "is larger than grains.radius_max".to_owned(),
                "exchange the two",
            ));
        }
        if self.growth.youngs_modulus > material.youngs_modulus {
            unfit.push((
                "growth.youngs_modulus",
                "is stiffer than the grains are in the end".to_owned(),
                "take at most grains.youngs_modulus",
            ));
        }
        unfit
    }
}

fn grains(walk: &mut impl Visitor, it: &mut Grains) {
    let radius = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 1.0) };
    walk.quantity("radius_min", radius, &mut it.radius_min);
    walk.quantity("radius_max", radius, &mut it.radius_max);
    schema::material(walk, &mut it.material);
    walk.number("friction", Range::AtLeast(0.0), &mut it.friction);
    walk.quantity("dissipation_time", Quantity::at_least_zero(&TIME), &mut it.dissipation_time);
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut it.tangential_damping);
}

fn membrane(walk: &mut impl Visitor, it: &mut Membrane) {
    let length = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 1.0) };
    walk.quantity("thickness", length, &mut it.thickness);
    schema::material(walk, &mut it.material);
    walk.number("friction", Range::AtLeast(0.0), &mut it.friction);
    walk.number("spring_damping", Range::AtLeast(0.0), &mut it.spring_damping);
    let stiffness = Quantity::at_least_zero(&TORQUE);
    walk.quantity("bending_stiffness", stiffness, &mut it.bending_stiffness);
    let damping = Quantity::at_least_zero(&IMPULSE);
    walk.quantity("bending_damping", damping, &mut it.bending_damping);
    walk.quantity("bending_damping_spheres", damping, &mut it.bending_damping_spheres);
    walk.flag("bends_by_first_areas", &mut it.bends_by_first_areas);
    walk.quantity("dissipation_time", Quantity::at_least_zero(&TIME), &mut it.dissipation_time);
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut it.tangential_damping);
}

fn size(walk: &mut impl Visitor, it: &mut Size) {
    let length = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 1.0) };
    walk.quantity("radius", length, &mut it.radius);
    walk.quantity("height", length, &mut it.height);
    walk.quantity("sphere_radius", length, &mut it.sphere_radius);
    walk.section("triangles", |walk| net(walk, &mut it.triangles));
    walk.section("spheres", |walk| net(walk, &mut it.spheres));
}

fn net(walk: &mut impl Visitor, it: &mut Net) {
    whole_usize(walk, "n_around", (3, 10_000), &mut it.n_around);
    whole_usize(walk, "n_rows", (2, 10_000), &mut it.n_rows);
    let [a, b] = &mut it.n_grains;
    whole_usize(walk, "n_grains_a", (1, 200_000), a);
    whole_usize(walk, "n_grains_b", (1, 200_000), b);
}

fn growth(walk: &mut impl Visitor, it: &mut Growth) {
    let modulus = Quantity::above_zero(&PRESSURE);
    walk.quantity("youngs_modulus", modulus, &mut it.youngs_modulus);
    walk.number("friction", Range::AtLeast(0.0), &mut it.friction);
    walk.quantity("dissipation_time", Quantity::at_least_zero(&TIME), &mut it.dissipation_time);
    walk.number("first_solid_fraction", Range::AboveUpTo(0.0, 0.3), &mut it.first_solid_fraction);
    walk.quantity("pressure_stop", modulus, &mut it.pressure_stop);
}

fn confining(walk: &mut impl Visitor, it: &mut Confining) {
    walk.quantity("pressure", Quantity::above_zero(&PRESSURE), &mut it.pressure);
    walk.quantity("ramp", Quantity::above_zero(&TIME), &mut it.ramp);
    walk.quantity("servo_speed", Quantity::above_zero(&SPEED), &mut it.servo_speed);
    walk.quantity("servo_speed_max", Quantity::above_zero(&SPEED), &mut it.servo_speed_max);
    walk.quantity("damping", Quantity::at_least_zero(&FREQUENCY), &mut it.damping);
    walk.number("rest_energy", Range::Above(0.0), &mut it.rest_energy);
    walk.number("rest_stress", Range::Above(0.0), &mut it.rest_stress);
    walk.quantity("rest_time_max", Quantity::above_zero(&TIME), &mut it.rest_time_max);
}

fn shear(walk: &mut impl Visitor, it: &mut Shear) {
    walk.quantity("speed", Quantity::above_zero(&SPEED), &mut it.speed);
    walk.number("speed_factor", Range::Above(0.0), &mut it.speed_factor);
    walk.quantity("start_time", Quantity::above_zero(&TIME), &mut it.start_time);
    walk.number("strain", Range::AboveUpTo(0.0, 0.5), &mut it.strain);
    whole_usize(walk, "n_points", (2, 100_000), &mut it.n_points);
}
