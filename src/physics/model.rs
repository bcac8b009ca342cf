//! Model: what the system is made of. Fixed during a run.

use super::{
    boundary::{shape::Surface, wall::WallModel},
    law::PairLaw,
    membrane::{MembraneModel, Sheet, mesh::Mesh},
};
use crate::base::{Pose, Real, Vec3};

/// Everything that does not change.
#[derive(Clone)]
pub struct Model {
    /// Inertia of grains and membrane over their real one, 1 as a rule [-].
    pub density_scaling: Real,
    /// Gravity as grains and membrane feel it [m/s²]: the real one over `density_scaling`.
    pub gravity: Vec3,
    /// Length of a substep [s].
    pub substep: Real,
    /// Largest radius of a grain [m].
    pub radius_max: Real,
    /// Mean radius of the grains [m].
    pub radius_mean: Real,
    /// Distance beyond contact within which neighbours are listed [m].
    pub skin: Real,
    /// Edges of the box that goes on periodically in all directions [m]; each at least twice as long as
    /// a largest grain's reach, diameter and skin. Only for grains alone. Positions are never wrapped:
    /// two grains meet by the image that is closest.
    pub period: Option<Vec3>,
    /// Law between grains.
    pub grain_law: PairLaw,
    /// Law between grains and membrane.
    pub membrane_law: PairLaw,
    /// The bag.
    pub membrane: MembraneModel,
    /// Where each vertex is if a wall holds it, in that wall's frame [m].
    pub held_positions: Vec<Vec3>,
    /// What grains meet besides each other and the membrane, in the order of `Controls::walls`.
    pub walls: Vec<WallModel>,
    /// The air.
    pub chamber: ChamberModel,
    /// Pose of the table: its surface is z = 0 of this frame.
    pub table: Pose,
    /// The rigid bodies that the membrane can touch, in the order of `Controls::bodies`; the table
    /// is last.
    pub bodies: Vec<BodyModel>,
}

impl Model {
    /// Grains alone, all under one `law`: without gravity, walls, membrane, air or bodies.
    pub fn of_grains(law: PairLaw, substep: Real, radius_max: Real, radius_mean: Real) -> Self {
        let mesh = Mesh::new(Vec::new(), Vec::new()).expect("nothing is no bad surface");
        let sheet = Sheet {
            thickness: 0.0,
            youngs_modulus: 0.0,
            density: 0.0,
            spring_damping: 0.0,
            bending_stiffness: 0.0,
            bending_damping: 0.0,
        };
        Self {
            density_scaling: 1.0,
            gravity: Vec3::zeros(),
            substep,
            radius_max,
            radius_mean,
            skin: 0.25 * radius_max,
            period: None,
            grain_law: law,
            membrane_law: law,
            membrane: MembraneModel::new(mesh, sheet),
            held_positions: Vec::new(),
            walls: Vec::new(),
            chamber: ChamberModel { lag_factor: 0.0, change_max: Real::INFINITY },
            table: Pose::identity(),
            bodies: Vec::new(),
        }
    }
}

/// The pump and its line.
#[derive(Clone, Copy, Debug)]
pub struct ChamberModel {
    /// Share of the way to the set-point that is left after one substep.
    pub lag_factor: Real,
    /// Largest change of pressure in one substep [Pa].
    pub change_max: Real,
}

/// A rigid body seen from the membrane.
#[derive(Clone)]
pub struct BodyModel {
    /// Its surface.
    pub surface: BodySurface,
    /// Contact law with the membrane.
    pub law: PairLaw,
    /// Effective radius R* of a membrane sample on it [m].
    pub contact_radius: Real,
    /// Nothing of it is further than this from its frame's origin [m].
    pub bounding_radius: Real,
}

/// The surface of a body, in its own frame.
#[derive(Clone)]
pub enum BodySurface {
    /// A closed shape about the centre of mass.
    Shape(Box<Surface>),
    /// Everything below z = 0.
    HalfSpace,
}
