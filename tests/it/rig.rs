//! A bare model by hand: grains, a plate, and a sheet, without scene, fill or rigid world.

use jamgrip::{
    base::{Pose, Real, Vec3, real::Twist},
    physics::{
        Controls, Model, Scratch, State,
        boundary::{
            body::BodyMotion,
            wall::{WallModel, WallShape},
        },
        law::{PairLaw, Surface},
        membrane::{CARRIER_ID, MembraneModel, MembraneState, Sheet, mesh::Mesh},
        model::ChamberModel,
        state::{Grains, Springs},
        substep,
    },
    scene::Material,
};

/// The grain of the gripper's table: 5 MPa.
pub(crate) const GRAIN: Material =
    Material { youngs_modulus: 5e6, poisson_ratio: 0.245, density: 2000.0 };
/// Latex.
pub(crate) const LATEX: Material =
    Material { youngs_modulus: 1.25e6, poisson_ratio: 1.0 / 3.0, density: 2000.0 };
/// Gravity [m/s²].
pub(crate) const G: Real = 9.81;

/// One system with all that a substep needs.
pub(crate) struct Rig {
    pub(crate) model: Model,
    pub(crate) controls: Controls,
    pub(crate) state: State,
    pub(crate) scratch: Scratch,
}

impl Rig {
    /// Grains of `material` between a plate, which faces up at z = 0, and a sheet far away.
    pub(crate) fn on_plate(material: &Material, surface: Surface, dt: Real) -> Self {
        let far = Vec3::new(0.0, 0.0, -1.0);
        let corners = vec![far, far + Vec3::x() * 0.01, far + Vec3::y() * 0.01];
        let mesh = Mesh::new(corners, vec![[0, 1, 2]]).unwrap();
        // Turned over, the flange's plate faces up.
        let flange = Pose::rotation(Vec3::x() * std::f64::consts::PI);
        Self::new(material, surface, mesh, flange, dt)
    }

    /// Grains of `material` on `mesh`, all of whose vertices are held; the plate is far above.
    pub(crate) fn on_sheet(material: &Material, surface: Surface, mesh: Mesh, dt: Real) -> Self {
        let mut rig = Self::new(material, surface, mesh, Pose::translation(0.0, 0.0, 1.0), dt);
        rig.model.membrane.holders.fill(CARRIER_ID);
        rig
    }

    fn new(material: &Material, surface: Surface, mesh: Mesh, flange: Pose, dt: Real) -> Self {
        let sheet = Sheet {
            thickness: 3e-4,
            youngs_modulus: LATEX.youngs_modulus,
            density: LATEX.density,
            spring_damping: 0.3,
            bending_stiffness: 1e-5,
            bending_damping: 1e-7,
        };
        let state = State {
            grains: Grains::default(),
            membrane: MembraneState::at_rest(&mesh),
            springs: Springs::none(0, 0),
            pair_ids: Vec::new(),
            gauge: 0.0,
            walls: vec![BodyMotion { pose: flange, twist: Twist::zero() }],
        };
        let in_flange = flange.inverse();
        let of_vertex = |p: &Vec3| in_flange.rotation * p + in_flange.translation.vector;
        let model = Model {
            density_scaling: 1.0,
            gravity: Vec3::zeros(),
            substep: dt,
            radius_max: 0.0,
            radius_mean: 0.0,
            skin: 2e-4,
            period: None,
            grain_law: PairLaw::between(material, material, surface),
            membrane_law: PairLaw::between(material, &LATEX, surface),
            held_positions: mesh.positions.iter().map(of_vertex).collect(),
            membrane: MembraneModel::new(mesh, sheet),
            walls: vec![WallModel {
                shape: WallShape::Plane { normal: -Vec3::z() },
                law: PairLaw::against_rigid(material, surface),
            }],
            chamber: ChamberModel { lag_factor: 0.0, change_max: Real::INFINITY },
            table: Pose::identity(),
            bodies: Vec::new(),
        };
        let controls = Controls {
            gauge_setpoint: 0.0,
            walls: vec![BodyMotion { pose: flange, twist: Twist::zero() }],
            bodies: Vec::new(),
        };
        let scratch = Scratch::new(&model);
        Self { model, controls, state, scratch }
    }

    /// Adds a grain of `density` [kg/m³].
    pub(crate) fn add_grain(
        &mut self,
        position: Vec3,
        velocity: Vec3,
        radius: Real,
        density: Real,
    ) {
        let grains = &mut self.state.grains;
        grains.positions.push(position);
        grains.velocities.push(velocity);
        grains.angular_velocities.push(Vec3::zeros());
        grains.radii.push(radius);
        grains.masses.push(4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * density);
        self.model.radius_max = self.model.radius_max.max(radius);
        self.model.radius_mean = radius;
        self.state.springs = Springs::none(grains.positions.len(), 0);
        self.scratch = Scratch::new(&self.model);
    }

    /// One substep.
    pub(crate) fn step(&mut self) {
        substep(&self.model, &self.controls, &mut self.state, &mut self.scratch);
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

    /// Kinetic energy of the grains [J].
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

/// Two surfaces with Coulomb friction alone.
pub(crate) fn elastic(friction: Real) -> Surface {
    Surface { friction, dissipation_time: 0.0, tangential_damping: 0.0 }
}

/// k of F = k ξ^(3/2) [N/m^(3/2)].
pub(crate) fn hertz_constant(law: &PairLaw, radius: Real) -> Real {
    4.0 / 3.0 * law.modulus * radius.sqrt()
}
