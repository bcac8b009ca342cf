//! The scene of the triaxial test, key by key.

use crate::{
    base::Real,
    physics::membrane::MembraneMaterial,
    scene::{
        Material,
        keys::{Each, Flag, Inline, Map, MapOf, Text, scene_keys},
        quantity::{FREQUENCY, IMPULSE, LENGTH, PRESSURE, SPEED, TIME, TORQUE},
        text::Keys,
        visit::{Quantity, Range},
    },
};

/// A length of a plausible magnitude, so that a wrong unit is detected.
const SOME_LENGTH: Quantity = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 1.0) };

scene_keys! {
    /// The whole scene.
    pub(super) struct TriaxialScene {
        /// Name of the scene.
        name: String = Text,
        /// The grains; their number is that of the specimen.
        grains: Grains = Map,
        /// The plates.
        plates: Plates = Map,
        /// The membrane and its contacts.
        membrane: Membrane = Map,
        /// The two sizes of the source.
        cases: [Size; 2] = Each(["case1", "case2"], Map),
        /// Seeds of the initial states A and B.
        seeds: [u64; 2] = MapOf(["a", "b"], 0..=u64::MAX),
        /// How grains grow.
        growth: Growth = Map,
        /// How the specimen is put under pressure.
        confining: Confining = Map,
        /// How it is sheared.
        shear: Shear = Map,
        /// Which cases are run in addition to the first size.
        runs: Runs = Map,
        /// The substep.
        time: Time = Map,
    }

    /// The grains.
    pub(super) struct Grains {
        /// Smallest radius (m).
        radius_min: Real = SOME_LENGTH,
        /// Largest radius (m).
        radius_max: Real = SOME_LENGTH,
        /// Their material.
        material: Material = Inline,
        /// Coulomb friction between grains.
        friction: Real = Range::AtLeast(0.0),
        /// Dissipation time of the contacts (s).
        dissipation_time: Real = Quantity::at_least_zero(&TIME),
        /// Damping of the tangential springs.
        tangential_damping: Real = Range::AtLeast(0.0),
    }

    /// The plates.
    pub(super) struct Plates {
        /// Coulomb friction with grains.
        friction: Real = Range::AtLeast(0.0),
    }

    /// The membrane and its contacts with grains.
    pub(super) struct Membrane {
        /// Thickness (m).
        thickness: Real = SOME_LENGTH,
        /// Its material.
        material: Material = Inline,
        /// Coulomb friction with grains.
        friction: Real = Range::AtLeast(0.0),
        /// Damping ratio of the springs.
        spring_damping: Real = Range::AtLeast(0.0),
        /// Elastic constant of the hinges (N m).
        bending_stiffness: Real = Quantity::at_least_zero(&TORQUE),
        /// Damping constant of the hinges (N s).
        bending_damping: Real = Quantity::at_least_zero(&IMPULSE),
        /// The same for the fine mesh of the model with spheres (N s).
        bending_damping_spheres: Real = Quantity::at_least_zero(&IMPULSE),
        /// True if hinges use the triangle areas of the straight membrane.
        bends_by_first_areas: bool = Flag,
        /// Dissipation time of the contacts (s).
        dissipation_time: Real = Quantity::at_least_zero(&TIME),
        /// Damping of the tangential springs.
        tangential_damping: Real = Range::AtLeast(0.0),
    }

    /// A size of the specimen.
    pub(super) struct Size {
        /// Radius (m).
        radius: Real = SOME_LENGTH,
        /// Height (m).
        height: Real = SOME_LENGTH,
        /// Radius of the spheres on the vertices (m).
        sphere_radius: Real = SOME_LENGTH,
        /// Mesh and grains of the model with triangles.
        triangles: MeshSize = Map,
        /// Mesh and grains of the model with spheres on the vertices.
        spheres: MeshSize = Map,
    }

    /// A mesh, and the number of grains inside it in the initial states A and B.
    #[derive(Copy)]
    pub(super) struct MeshSize {
        /// Vertices in a ring.
        n_around: usize = 3..=10_000,
        /// Rings.
        n_rows: usize = 2..=10_000,
        /// Grains.
        n_grains: [usize; 2] = Each(["n_grains_a", "n_grains_b"], 1..=200_000),
    }

    /// Growth of the grains inside the held membrane.
    pub(super) struct Growth {
        /// Modulus while they grow (Pa): with their own, the short substep would make it take
        /// hours.
        youngs_modulus: Real = Quantity::above_zero(&PRESSURE),
        /// Coulomb friction of all contacts while they grow.
        friction: Real = Range::AtLeast(0.0),
        /// Dissipation time while they grow (s).
        dissipation_time: Real = Quantity::at_least_zero(&TIME),
        /// Solid fraction at which grains are scattered.
        first_solid_fraction: Real = Range::AboveUpTo(0.0, 0.3),
        /// Pressure at which growth ends (Pa).
        pressure_stop: Real = Quantity::above_zero(&PRESSURE),
    }

    /// From the held specimen to the isotropic state.
    #[derive(Copy)]
    pub(super) struct Confining {
        /// Confining pressure p_c (Pa).
        pressure: Real = Quantity::above_zero(&PRESSURE),
        /// Time in which pressure and stiffness rise (s).
        ramp: Real = Quantity::above_zero(&TIME),
        /// Speed of a plate per missing stress, times p_c (m/s).
        servo_speed: Real = Quantity::above_zero(&SPEED),
        /// Largest speed of a plate (m/s).
        servo_speed_max: Real = Quantity::above_zero(&SPEED),
        /// Rate at which velocities decay until the specimen is sheared (1/s).
        damping: Real = Quantity::at_least_zero(&FREQUENCY),
        /// Largest kinetic over elastic energy of a specimen at rest.
        rest_energy: Real = Range::Above(0.0),
        /// Largest difference between the plates' pressure and p_c at rest, over p_c.
        rest_stress: Real = Range::Above(0.0),
        /// Longest time to come to rest (s).
        rest_time_max: Real = Quantity::above_zero(&TIME),
    }

    /// Shearing at constant speed.
    pub(super) struct Shear {
        /// Relative speed of the plates as in the source (m/s).
        speed: Real = Quantity::above_zero(&SPEED),
        /// Factor by which they move faster.
        speed_factor: Real = Range::Above(0.0),
        /// Time in which they reach that speed (s).
        start_time: Real = Quantity::above_zero(&TIME),
        /// Strain at which shearing ends.
        strain: Real = Range::AboveUpTo(0.0, 0.5),
        /// Number of recorded points.
        n_points: usize = 2..=100_000,
    }

    /// Which cases are run.
    pub(super) struct Runs {
        /// True adds the larger size.
        case2: bool = Flag,
        /// Strain of a check with everything that `quick` speeds up at half or less; 0 for none.
        check_strain: Real = Range::Between(0.0, 0.5),
        /// Strain of a specimen with spheres that is filled less densely; 0 for none.
        loose_strain: Real = Range::Between(0.0, 0.5),
        /// Number of grains of that specimen.
        loose_grains: usize = 1..=200_000,
        /// Share of the Rayleigh time in the check.
        check_rayleigh_share: Real = Range::AboveUpTo(0.0, 1.0),
        /// Simulated time of the comparison of run times (s); 0 for none.
        timing: Real = Quantity::at_least_zero(&TIME),
    }

    /// How the substep is derived.
    pub(super) struct Time {
        /// Share of the smallest grain's Rayleigh time that is critical for the packing.
        rayleigh_share: Real = Range::AboveUpTo(0.0, 1.0),
        /// Share of the critical step that is taken.
        safety: Real = Range::AboveUpTo(0.0, 1.0),
    }
}

impl Membrane {
    /// Springs and hinges, with this damping of the hinges (N s).
    pub(super) fn material(&self, bending_damping: Real) -> MembraneMaterial {
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

impl Keys for TriaxialScene {
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
