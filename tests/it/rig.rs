//! A bare system of grains, a plate and a membrane, without scene, filling or rigid-body world.

use std::ops::{Deref, DerefMut};

use jamgrip::{
    base::{Pose, Real, Vec3},
    physics::{
        System, SystemBuilder,
        boundary::wall::WallShape,
        builder::{Membrane, Vertices, Wall},
        law::{PairLaw, Surface},
        membrane::{MembraneMaterial, MembraneModel, mesh::Mesh},
    },
    scene::Material,
};

/// The grain of table 5 of the source: 5 MPa.
pub(crate) const GRAIN: Material =
    Material { youngs_modulus: 5e6, poisson_ratio: 0.245, density: 2000.0 };
/// Latex.
pub(crate) const LATEX: Material =
    Material { youngs_modulus: 1.25e6, poisson_ratio: 1.0 / 3.0, density: 2000.0 };
/// Gravity (m/s²).
pub(crate) const G: Real = 9.81;

/// A system of one plate and one membrane.
pub(crate) struct Rig(System);

impl Deref for Rig {
    type Target = System;

    fn deref(&self) -> &System {
        &self.0
    }
}

impl DerefMut for Rig {
    fn deref_mut(&mut self) -> &mut System {
        &mut self.0
    }
}

impl Rig {
    /// Grains of `material` above a plate that faces up at z = 0; the membrane is far away.
    pub(crate) fn on_plate(material: &Material, surface: Surface, dt: Real) -> Self {
        let far = Vec3::new(0.0, 0.0, -1.0);
        let corners = vec![far, far + Vec3::x() * 0.01, far + Vec3::y() * 0.01];
        let mesh = Mesh::new(corners, vec![[0, 1, 2]]).unwrap();
        // Upside down, so that the plate of the flange faces up.
        let flange = Pose::rotation(Vec3::x() * std::f64::consts::PI);
        Self::new(material, surface, (mesh, Vertices::Rims), flange, dt)
    }

    /// Grains of `material` on a membrane with `mesh`, whose vertices are fixed; the plate is far above.
    pub(crate) fn on_membrane(material: &Material, surface: Surface, mesh: Mesh, dt: Real) -> Self {
        let flange = Pose::translation(0.0, 0.0, 1.0);
        Self::new(material, surface, (mesh, Vertices::All), flange, dt)
    }

    fn new(
        material: &Material,
        surface: Surface,
        (mesh, held): (Mesh, Vertices),
        flange: Pose,
        dt: Real,
    ) -> Self {
        let latex = MembraneMaterial {
            thickness: 3e-4,
            youngs_modulus: LATEX.youngs_modulus,
            density: LATEX.density,
            spring_damping: 0.3,
            bending_stiffness: 1e-5,
            bending_damping: 1e-7,
        };
        let mut builder = SystemBuilder::of_material(material, surface);
        builder.substep(dt).skin(2e-4);
        builder.membrane_law(PairLaw::between(material, &LATEX, surface));
        let plate = builder.wall(Wall::new(WallShape::Plane { normal: -Vec3::z() }).at(flange));
        builder.membrane(Membrane::of(MembraneModel::new(mesh, latex)).hold(held, plate));
        Self(builder.build().unwrap())
    }

    /// Adds a grain of `density` (kg/m³).
    pub(crate) fn add_grain(
        &mut self,
        position: Vec3,
        velocity: Vec3,
        radius: Real,
        density: Real,
    ) {
        let mass = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * density;
        let grain = self.0.add_grain(position, radius, mass);
        self.0.state.grains.velocities[grain] = velocity;
    }

    /// Momentum, and angular momentum about the origin, of all grains.
    pub(crate) fn momenta(&self) -> (Vec3, Vec3) {
        let grains = &self.state.grains;
        let (mut linear, mut angular) = (Vec3::zeros(), Vec3::zeros());
        for i in 0..grains.len() {
            let momentum = grains.velocities[i] * grains.masses[i];
            linear += momentum;
            angular += grains.positions[i].cross(&momentum)
                + grains.angular_velocities[i] * (0.4 * grains.masses[i] * grains.radii[i].powi(2));
        }
        (linear, angular)
    }

    /// Kinetic energy of the grains (J).
    pub(crate) fn kinetic_energy(&self) -> Real {
        let grains = &self.state.grains;
        let of_grain = |i: usize| {
            let inertia = 0.4 * grains.masses[i] * grains.radii[i].powi(2);
            0.5 * grains.masses[i] * grains.velocities[i].norm_squared()
                + 0.5 * inertia * grains.angular_velocities[i].norm_squared()
        };
        (0..grains.len()).map(of_grain).sum()
    }
}

/// A surface with Coulomb friction but without dissipation.
pub(crate) fn elastic(friction: Real) -> Surface {
    Surface { friction, dissipation_time: 0.0, tangential_damping: 0.0 }
}

/// k of F = k ξ^(3/2) [N/m^(3/2)].
pub(crate) fn hertz_constant(law: &PairLaw, radius: Real) -> Real {
    4.0 / 3.0 * law.modulus * radius.sqrt()
}
