//! Model: what the system is made of. Fixed during a run.

use super::{
    boundary::{
        shape::Surface,
        triangles::Triangles,
        wall::{WallModel, WallShape},
    },
    law::PairLaw,
    membrane::{MembraneModel, mesh::MeshFault},
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

    /// Number of surfaces: walls and bodies.
    pub fn n_surfaces(&self) -> usize {
        self.walls.len() + self.bodies.len()
    }

    /// A surface that grains may touch in several places or that belongs to a body: walls come first, then
    /// bodies. `None` for the others, whose contacts are those of `contact::walls`, and for bodies that
    /// touch no grain.
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

/// Where the closest points of a surface are looked for.
#[derive(Clone, Copy, Debug)]
pub enum TouchedSurface<'a> {
    /// On triangles.
    Triangles(&'a Triangles),
    /// By the signed distance from a body.
    Body(&'a BodyModel),
}

impl TouchedSurface<'_> {
    /// Nothing of it is further than this from its frame's origin (m).
    pub fn bounding_radius(&self) -> Real {
        match self {
            Self::Triangles(triangles) => triangles.bounding_radius(),
            Self::Body(body) => body.bounding_radius,
        }
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

/// A rigid body seen from the membrane and from the grains.
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
    /// How grains touch it; `None` if they do not.
    pub of_grains: Option<Box<GrainsOnBody>>,
}

/// Contacts of grains with a body.
#[derive(Clone, Debug)]
pub struct GrainsOnBody {
    /// Their law; the body is rigid.
    pub law: PairLaw,
    /// The triangles of a polyhedron.
    pub triangles: Option<Triangles>,
}

impl BodyModel {
    /// A body of this shape, with the frame at its center of mass, that membranes touch under `law`.
    /// The effective radius of a membrane sample on it is its bounding radius.
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

    /// The same body, touched by grains under `law`.
    ///
    /// # Errors
    /// If the triangles of a polyhedron are not a surface in which each vertex has one fan of triangles.
    pub fn touches_grains(mut self, law: PairLaw) -> Result<Self, MeshFault> {
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
    /// A closed shape about the centre of mass.
    Shape(Box<Surface>),
    /// Everything below z = 0.
    HalfSpace,
}
