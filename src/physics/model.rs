//! Model: what the system consists of. It does not change during a run.

use super::{
    boundary::{
        shape::Surface,
        triangles::Triangles,
        wall::{WallModel, WallShape},
    },
    law::PairLaw,
    membrane::{MembraneModel, mesh::MeshError},
};
use crate::base::{Pose, Real, Vec3};

/// Everything that does not change during a run. `SystemBuilder` creates it.
#[derive(Clone, Debug)]
pub struct Model {
    /// Ratio of the inertia of grains and membrane to their real inertia; 1 without density scaling.
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

    /// Number of surfaces: walls and bodies.
    pub fn n_surfaces(&self) -> usize {
        self.walls.len() + self.bodies.len()
    }

    /// A surface whose contacts with grains belong to `contact::surfaces`, and its law: a wall of triangles, or a
    /// body. Walls come first, then bodies. `None` for other walls, whose contacts belong to `contact::walls`, and
    /// for bodies that grains do not touch.
    pub fn surface(&self, index: usize) -> Option<(TouchedSurface<'_>, &PairLaw)> {
        if let Some(wall) = self.walls.get(index) {
            return match &wall.shape {
                WallShape::Triangles(triangles) => {
                    Some((TouchedSurface::Triangles(triangles), &wall.law))
                }
                _ => None,
            };
        }
        let body = self.bodies.get(index - self.walls.len())?;
        let of_grains = body.of_grains.as_ref()?;
        let surface = match &of_grains.triangles {
            Some(triangles) => TouchedSurface::Triangles(triangles),
            None => TouchedSurface::Body(body),
        };
        Some((surface, &of_grains.law))
    }
}

/// How the closest points of a surface are found.
#[derive(Clone, Copy, Debug)]
pub enum TouchedSurface<'a> {
    /// Among triangles.
    Triangles(&'a Triangles),
    /// By the signed distance from a body.
    Body(&'a BodyModel),
}

impl TouchedSurface<'_> {
    /// Radius of a sphere around the frame's origin that contains the surface (m).
    pub fn bounding_radius(&self) -> Real {
        match self {
            Self::Triangles(triangles) => triangles.bounding_radius(),
            Self::Body(body) => body.bounding_radius,
        }
    }
}

/// Pump and line, for one length of substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberModel {
    /// Fraction of the distance to the setpoint that remains after one substep, e^(−dt/τ).
    pub lag_factor: Real,
    /// Largest change of the pressure in one substep (Pa).
    pub change_max: Real,
}

/// A rigid body that the membrane, and optionally the grains, can touch.
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
    /// Contacts with grains; `None` if grains do not touch it.
    pub of_grains: Option<Box<GrainsOnBody>>,
}

/// Contacts of grains with a body.
#[derive(Clone, Debug)]
pub struct GrainsOnBody {
    /// Contact law; the body is rigid.
    pub law: PairLaw,
    /// The triangles, if the body is a polyhedron.
    pub triangles: Option<Triangles>,
}

impl BodyModel {
    /// A body of this shape, with the frame at its center of mass, that membranes touch with `law`.
    /// The effective radius of its contacts is its bounding radius.
    pub fn of_shape(surface: Surface, law: PairLaw) -> Self {
        let radius = surface.bounding_radius();
        Self {
            surface: BodySurface::Shape(Box::new(surface)),
            law,
            contact_radius: radius,
            bounding_radius: radius,
            of_grains: None,
        }
    }

    /// The same body, which grains touch with `law`.
    ///
    /// # Errors
    /// If the triangles of a polyhedron do not form a valid surface, see `Mesh::new`.
    pub fn touches_grains(mut self, law: PairLaw) -> Result<Self, MeshError> {
        let triangles = match &self.surface {
            BodySurface::Shape(surface) => match &**surface {
                Surface::Polyhedron(it) => {
                    Some(Triangles::new(it.vertices().collect(), it.triangles().to_vec())?)
                }
                _ => None,
            },
            BodySurface::HalfSpace => None,
        };
        self.of_grains = Some(Box::new(GrainsOnBody { law, triangles }));
        Ok(self)
    }
}

/// The surface of a body, in its own frame.
#[derive(Clone, Debug)]
pub enum BodySurface {
    /// A closed surface, with the origin at the center of mass.
    Shape(Box<Surface>),
    /// Everything below z = 0.
    HalfSpace,
}
