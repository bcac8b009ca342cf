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
pub(super) struct Bench {
    pub(super) system: System,
}

/// Two surfaces with Coulomb friction alone.
pub(super) const fn elastic(friction: Real) -> Surface {
    Surface { friction, dissipation_time: 0.0, tangential_damping: 0.0 }
}

/// Mass of a sphere (kg).
pub(super) fn mass(radius: Real, density: Real) -> Real {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * density
}

impl Bench {
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

    /// The grains, to be moved.
    pub(super) fn grains_mut(&mut self) -> &mut Grains {
        &mut self.system.state.grains
    }

    /// Overlap of the first grain with the second, or with the plane if there is none (m).
    pub(super) fn overlap(&self) -> Real {
        let grains = self.grains();
        match grains.len() {
            1 => grains.radii[0] - grains.positions[0].z,
            _ => {
                let apart = grains.positions[0] - grains.positions[1];
                grains.radii[0] + grains.radii[1] - apart.norm()
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

    /// Steps until the bodies, which just touch and approach, have parted again.
    pub(super) fn collide(&mut self) -> Met {
        let mut met = Met { overlap_max: 0.0, force_max: 0.0, force_min: 0.0, duration: 0.0 };
        for step in 1..100_000_000 {
            self.step();
            let (overlap, force) = (self.overlap(), self.normal_force());
            met.overlap_max = met.overlap_max.max(overlap);
            met.force_max = met.force_max.max(force);
            met.force_min = met.force_min.min(force);
            if overlap <= 0.0 {
                met.duration = real(step) * self.system.model.substep;
                break;
            }
        }
        met
    }
}

/// What was seen of a collision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    /// (m)
    pub(super) overlap_max: Real,
    /// (N)
    pub(super) force_max: Real,
    /// (N)
    pub(super) force_min: Real,
    /// (s)
    pub(super) duration: Real,
}

/// A sphere that flies onto a rigid plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    /// (m)
    pub(super) radius: Real,
    pub(super) material: Material,
    pub(super) surface: Surface,
    /// Down is −z (m/s).
    pub(super) velocity: Vec3,
    /// (rad/s)
    pub(super) spin: Vec3,
}

impl Flight {
    /// The collision by its numbers.
    pub(super) fn collision(&self) -> Collision {
        Collision {
            modulus: PairLaw::against_rigid(&self.material, self.surface).modulus,
            radius: self.radius,
            mass: mass(self.radius, self.material.density),
            speed: -self.velocity.z,
        }
    }

    /// Flies until it has left the plane, with so many steps per elastic contact.
    pub(super) fn land(&self, steps_per_contact: usize, record: &mut Record) -> (Bench, Met) {
        let dt = self.collision().duration() / real(steps_per_contact);
        let mut bench = Bench::on_plane(&self.material, self.surface, dt);
        bench.add_grain(Vec3::z() * self.radius, self.radius, self.material.density);
        bench.grains_mut().velocities[0] = self.velocity;
        bench.grains_mut().angular_velocities[0] = self.spin;
        let met = bench.collide();
        note_overlap(record, met.overlap_max / (2.0 * self.radius));
        (bench, met)
    }
}

/// Two spheres of one material that fly towards each other along x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Encounter {
    /// (m)
    pub(super) radii: [Real; 2],
    pub(super) material: Material,
    /// Of each (kg/m³).
    pub(super) densities: [Real; 2],
    pub(super) surface: Surface,
    /// Of each along x (m/s).
    pub(super) speeds: [Real; 2],
    /// Of each (rad/s).
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

    /// The collision by its numbers.
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

    /// Meets and parts, with so many steps per elastic contact.
    pub(super) fn meet(&self, steps_per_contact: usize, record: &mut Record) -> (Bench, Met) {
        let dt = self.collision().duration() / real(steps_per_contact);
        let mut bench = Bench::on_plane(&self.material, self.surface, dt);
        let high = Vec3::z() * (10.0 * (self.radii[0] + self.radii[1]));
        for (i, x) in [-self.radii[0], self.radii[1]].into_iter().enumerate() {
            bench.add_grain(high + Vec3::x() * x, self.radii[i], self.densities[i]);
            bench.grains_mut().velocities[i] = Vec3::x() * self.speeds[i];
            bench.grains_mut().angular_velocities[i] = self.spins[i];
        }
        let met = bench.collide();
        note_overlap(record, met.overlap_max / (self.radii[0] + self.radii[1]));
        (bench, met)
    }

    /// Restitution of a meeting that is over.
    pub(super) fn restitution(&self, bench: &Bench) -> Real {
        let velocities = &bench.grains().velocities;
        (velocities[1].x - velocities[0].x) / self.collision().speed
    }
}

/// Keeps the largest overlap for the record's validity.
fn note_overlap(record: &mut Record, overlap_over_diameter: Real) {
    let largest = &mut record.validity.overlap_over_diameter_max;
    *largest = largest.max(overlap_over_diameter);
}
