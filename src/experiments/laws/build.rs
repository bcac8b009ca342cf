//! One or two grains with a plane or a membrane, moved by the substeps of the simulation.

use crate::{
    base::{Real, Vec3, real::real},
    experiments::{oracles::impact::Collision, record::Record},
    physics::{
        System, SystemBuilder,
        builder::{Membrane, Vertices, Wall},
        law::{PairLaw, Surface},
        membrane::MembraneModel,
        state::Grains,
    },
    scene::Material,
};

/// Gravity (m/s²).
pub(super) const G: Real = 9.81;

/// Some grains with a wall or a membrane.
pub(super) struct TestSystem {
    pub(super) system: System,
}

/// Two surfaces with Coulomb friction only.
pub(super) const fn elastic(friction: Real) -> Surface {
    Surface { friction, dissipation_time: 0.0, tangential_damping: 0.0 }
}

/// Mass of a sphere (kg).
pub(super) fn mass(radius: Real, density: Real) -> Real {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * density
}

impl TestSystem {
    /// Grains of `material` over a rigid plane at z = 0.
    pub(super) fn on_plane(material: &Material, surface: Surface, dt: Real) -> Self {
        let mut builder = SystemBuilder::of_material(material, surface);
        builder.substep(dt).walls([Wall::floor(0.0)]);
        Self { system: builder.build().expect("a plane needs nothing else") }
    }

    /// Grains of `material` on a membrane whose vertices are all held.
    pub(super) fn on_membrane(
        material: &Material,
        surface: Surface,
        membrane: MembraneModel,
        dt: Real,
    ) -> Self {
        let latex = Material {
            youngs_modulus: membrane.material.youngs_modulus,
            poisson_ratio: 1.0 / 3.0,
            density: membrane.material.density,
        };
        let mut builder = SystemBuilder::of_material(material, surface);
        builder.substep(dt).membrane_law(PairLaw::between(material, &latex, surface));
        let frame = builder.wall(Wall::frame());
        builder.membrane(Membrane::of(membrane).hold(Vertices::All, frame));
        Self { system: builder.build().expect("a frame holds any membrane") }
    }

    /// Adds a grain at rest.
    pub(super) fn add_grain(&mut self, position: Vec3, radius: Real, density: Real) {
        self.system.add_grain(position, radius, mass(radius, density));
        self.system.model.skin = 0.1 * self.system.model.radius_max;
    }

    /// One substep.
    pub(super) fn step(&mut self) {
        self.system.step();
    }

    /// The grains.
    pub(super) fn grains(&self) -> &Grains {
        &self.system.state.grains
    }

    /// The grains, mutable.
    pub(super) fn grains_mut(&mut self) -> &mut Grains {
        &mut self.system.state.grains
    }

    /// Overlap of the first grain with the second, or with the plane if there is none (m).
    pub(super) fn overlap(&self) -> Real {
        let grains = self.grains();
        match grains.len() {
            1 => grains.radii[0] - grains.positions[0].z,
            _ => {
                let separation = grains.positions[0] - grains.positions[1];
                grains.radii[0] + grains.radii[1] - separation.norm()
            }
        }
    }

    /// Normal force between the grains, or of the plane (N).
    pub(super) fn normal_force(&self) -> Real {
        match self.grains().len() {
            1 => self.system.scratch.wall_forces.first().map_or(0.0, |wall| wall.normal),
            _ => self.system.scratch.pair_forces.first().map_or(0.0, |pair| pair.normal),
        }
    }

    /// Momentum, and angular momentum about the origin, of all grains.
    pub(super) fn momenta(&self) -> (Vec3, Vec3) {
        let grains = self.grains();
        let (mut linear, mut angular) = (Vec3::zeros(), Vec3::zeros());
        for i in 0..grains.len() {
            let momentum = grains.velocities[i] * grains.masses[i];
            linear += momentum;
            angular += grains.positions[i].cross(&momentum)
                + grains.angular_velocities[i] * (0.4 * grains.masses[i] * grains.radii[i].powi(2));
        }
        (linear, angular)
    }

    /// Kinetic energy of all grains (J).
    pub(super) fn kinetic_energy(&self) -> Real {
        let grains = self.grains();
        let of_grain = |i: usize| {
            let inertia = 0.4 * grains.masses[i] * grains.radii[i].powi(2);
            0.5 * grains.masses[i] * grains.velocities[i].norm_squared()
                + 0.5 * inertia * grains.angular_velocities[i].norm_squared()
        };
        (0..grains.len()).map(of_grain).sum()
    }

    /// Steps until the bodies, which touch and approach at the start, have separated.
    pub(super) fn collide(&mut self) -> CollisionExtremes {
        let mut extremes =
            CollisionExtremes { overlap_max: 0.0, force_max: 0.0, force_min: 0.0, duration: 0.0 };
        for step in 1..100_000_000 {
            self.step();
            let (overlap, force) = (self.overlap(), self.normal_force());
            extremes.overlap_max = extremes.overlap_max.max(overlap);
            extremes.force_max = extremes.force_max.max(force);
            extremes.force_min = extremes.force_min.min(force);
            if overlap <= 0.0 {
                extremes.duration = real(step) * self.system.model.substep;
                break;
            }
        }
        extremes
    }
}

/// Extremes of a collision.
#[derive(Clone, Copy, Debug)]
pub(super) struct CollisionExtremes {
    /// Largest overlap (m).
    pub(super) overlap_max: Real,
    /// Largest normal force (N).
    pub(super) force_max: Real,
    /// Smallest normal force (N).
    pub(super) force_min: Real,
    /// Duration (s).
    pub(super) duration: Real,
}

/// A sphere that flies onto a rigid plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    /// Radius (m).
    pub(super) radius: Real,
    pub(super) material: Material,
    pub(super) surface: Surface,
    /// Velocity before the impact (m/s); down is −z.
    pub(super) velocity: Vec3,
    /// Angular velocity before the impact (rad/s).
    pub(super) spin: Vec3,
}

impl Flight {
    /// The numbers of the collision.
    pub(super) fn collision(&self) -> Collision {
        Collision {
            modulus: PairLaw::against_rigid(&self.material, self.surface).modulus,
            radius: self.radius,
            mass: mass(self.radius, self.material.density),
            speed: -self.velocity.z,
        }
    }

    /// Simulates the impact, with `steps_per_contact` in the duration of the elastic contact.
    pub(super) fn land(
        &self,
        steps_per_contact: usize,
        record: &mut Record,
    ) -> (TestSystem, CollisionExtremes) {
        let dt = self.collision().duration() / real(steps_per_contact);
        let mut test = TestSystem::on_plane(&self.material, self.surface, dt);
        test.add_grain(Vec3::z() * self.radius, self.radius, self.material.density);
        test.grains_mut().velocities[0] = self.velocity;
        test.grains_mut().angular_velocities[0] = self.spin;
        let extremes = test.collide();
        note_overlap(record, extremes.overlap_max / (2.0 * self.radius));
        (test, extremes)
    }
}

/// Two spheres of one material that fly toward each other along x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Encounter {
    /// Radii (m).
    pub(super) radii: [Real; 2],
    pub(super) material: Material,
    /// Densities (kg/m³).
    pub(super) densities: [Real; 2],
    pub(super) surface: Surface,
    /// Speeds along x (m/s).
    pub(super) speeds: [Real; 2],
    /// Angular velocities (rad/s).
    pub(super) spins: [Vec3; 2],
}

impl Encounter {
    /// Equal grains with half of the closing speed each.
    pub(super) fn equal(
        radius: Real,
        material: Material,
        surface: Surface,
        closing_speed: Real,
    ) -> Self {
        Self {
            radii: [radius; 2],
            material,
            densities: [material.density; 2],
            surface,
            speeds: [0.5 * closing_speed, -0.5 * closing_speed],
            spins: [Vec3::zeros(); 2],
        }
    }

    /// The numbers of the collision.
    pub(super) fn collision(&self) -> Collision {
        let half = |[a, b]: [Real; 2]| a * b / (a + b);
        let masses = [0, 1].map(|i| mass(self.radii[i], self.densities[i]));
        Collision {
            modulus: PairLaw::between(&self.material, &self.material, self.surface).modulus,
            radius: half(self.radii),
            mass: half(masses),
            speed: self.speeds[0] - self.speeds[1],
        }
    }

    /// Simulates the collision, with `steps_per_contact` in the duration of the elastic contact.
    pub(super) fn meet(
        &self,
        steps_per_contact: usize,
        record: &mut Record,
    ) -> (TestSystem, CollisionExtremes) {
        let dt = self.collision().duration() / real(steps_per_contact);
        let mut test = TestSystem::on_plane(&self.material, self.surface, dt);
        let high = Vec3::z() * (10.0 * (self.radii[0] + self.radii[1]));
        for (i, x) in [-self.radii[0], self.radii[1]].into_iter().enumerate() {
            test.add_grain(high + Vec3::x() * x, self.radii[i], self.densities[i]);
            test.grains_mut().velocities[i] = Vec3::x() * self.speeds[i];
            test.grains_mut().angular_velocities[i] = self.spins[i];
        }
        let extremes = test.collide();
        note_overlap(record, extremes.overlap_max / (self.radii[0] + self.radii[1]));
        (test, extremes)
    }

    /// Restitution after the collision.
    pub(super) fn restitution(&self, test: &TestSystem) -> Real {
        let velocities = &test.grains().velocities;
        (velocities[1].x - velocities[0].x) / self.collision().speed
    }
}

/// Keeps the largest overlap for the record's validity.
fn note_overlap(record: &mut Record, overlap_over_diameter: Real) {
    let largest = &mut record.validity.overlap_over_diameter_max;
    *largest = largest.max(overlap_over_diameter);
}
