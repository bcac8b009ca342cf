//! Model: what the system consists of. It does not change during a run.

use super::{
    boundary::{shape::Surface, wall::WallModel},
    law::PairLaw,
    membrane::MembraneModel,
};
use crate::base::{Pose, Real, Vec3};

/// Everything that does not change during a run. `SystemBuilder` creates it.
#[derive(Clone, Debug)]
pub struct Model {
    /// Inertia of grains and membrane divided by their real inertia; 1 without density scaling.
    pub density_scaling: Real,
    /// Gravity acting on grains and membrane (m/s²): real gravity divided by `density_scaling`.
    pub gravity: Vec3,
    /// Length of a substep (s).
    pub substep: Real,
    /// Largest radius of a grain (m).
    pub radius_max: Real,
    /// Mean radius of the grains (m).
    pub radius_mean: Real,
    /// Distance beyond contact within which possible contacts are listed (m).
    pub skin: Real,
    /// Edges of a periodic box (m), for systems of grains only. Each must be at least twice as long as the
    /// reach of the largest grain: its diameter, the range of the law and the skin. Positions are never
    /// wrapped; pairs interact through their closest images.
    pub period: Option<Vec3>,
    /// Contact law between grains.
    pub grain_law: PairLaw,
    /// Contact law between grains and membrane.
    pub membrane_law: PairLaw,
    /// All membranes, as the parts of one mesh; the mesh is empty if there are none.
    pub membrane: MembraneModel,
    /// Position of each vertex in the frame of the wall that holds it (m). For free vertices: where the carrier
    /// would hold it.
    pub held_positions: Vec<Vec3>,
    /// The walls, in the order of `Controls::walls`. The first is the carrier, see
    /// `boundary::wall::CARRIER`.
    pub walls: Vec<WallModel>,
    /// The air inside the membranes.
    pub chamber: ChamberModel,
    /// Pose of the table: its surface is z = 0 of this frame.
    pub table: Pose,
    /// The rigid bodies that the membrane can touch, in the order of `Controls::bodies`; the table
    /// is last.
    pub bodies: Vec<BodyModel>,
}

impl Model {
    /// Number of sample points of the membrane for each body: its vertices and facets.
    pub fn n_samples(&self) -> usize {
        self.membrane.mesh.n_vertices() + self.membrane.mesh.triangles.len()
    }
}

/// Pump and line, for one length of substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberModel {
    /// Fraction of the distance to the set-point that remains after one substep, e^(−dt/τ).
    pub lag_factor: Real,
    /// Largest change of the pressure in one substep (Pa).
    pub change_max: Real,
}

/// A rigid body that the membrane can touch.
#[derive(Clone, Debug)]
pub struct BodyModel {
    /// Its surface.
    pub surface: BodySurface,
    /// Contact law with the membrane.
    pub law: PairLaw,
    /// Effective radius R* of its contacts with sample points of the membrane (m).
    pub contact_radius: Real,
    /// Radius of a sphere around the frame's origin that contains the body (m).
    pub bounding_radius: Real,
}

/// The surface of a body, in its own frame.
#[derive(Clone, Debug)]
pub enum BodySurface {
    /// A closed surface, with the origin at the center of mass.
    Shape(Box<Surface>),
    /// Everything below z = 0.
    HalfSpace,
}
