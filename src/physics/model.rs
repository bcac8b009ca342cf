//! Model: what the system is made of. Fixed during a run.

use super::{
    boundary::{shape::Surface, wall::WallModel},
    law::PairLaw,
    membrane::MembraneModel,
};
use crate::base::{Pose, Real, Vec3};

/// Everything that does not change. `SystemBuilder` makes one.
#[derive(Clone, Debug)]
pub struct Model {
    /// Inertia of grains and membrane over their real one, 1 as a rule.
    pub density_scaling: Real,
    /// Gravity as grains and membrane feel it (m/s²): the real one over `density_scaling`.
    pub gravity: Vec3,
    /// Length of a substep (s).
    pub substep: Real,
    /// Largest radius of a grain (m).
    pub radius_max: Real,
    /// Mean radius of the grains (m).
    pub radius_mean: Real,
    /// Distance beyond contact within which neighbours are listed (m).
    pub skin: Real,
    /// Edges of a periodic box (m); each at least twice as long as
    /// a largest grain's reach, diameter and skin. Only for grains alone. Positions are never wrapped:
    /// two grains meet by the image that is closest.
    pub period: Option<Vec3>,
    /// Law between grains.
    pub grain_law: PairLaw,
    /// Law between grains and membrane.
    pub membrane_law: PairLaw,
    /// The membranes, as one mesh of several parts; without any vertex where there are none.
    pub membrane: MembraneModel,
    /// Where each vertex is if a wall holds it, in that wall's frame (m).
    pub held_positions: Vec<Vec3>,
    /// What grains meet besides each other and the membrane, in the order of `Controls::walls`. The
    /// first is the carrier, see `boundary::wall::CARRIER`.
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
    /// Number of samples of the membrane that one body can touch: its vertices and facets.
    pub fn n_samples(&self) -> usize {
        self.membrane.mesh.n_vertices() + self.membrane.mesh.triangles.len()
    }
}

/// The pump and its line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberModel {
    /// Share of the way to the set-point that is left after one substep.
    pub lag_factor: Real,
    /// Largest change of pressure in one substep (Pa).
    pub change_max: Real,
}

/// A rigid body seen from the membrane.
#[derive(Clone, Debug)]
pub struct BodyModel {
    /// Its surface.
    pub surface: BodySurface,
    /// Contact law with the membrane.
    pub law: PairLaw,
    /// Effective radius R* of a membrane sample on it (m).
    pub contact_radius: Real,
    /// Nothing of it is further than this from its frame's origin (m).
    pub bounding_radius: Real,
}

/// The surface of a body, in its own frame.
#[derive(Clone, Debug)]
pub enum BodySurface {
    /// A closed shape about the center of mass.
    Shape(Box<Surface>),
    /// Everything below z = 0.
    HalfSpace,
}
