//! Shapes of membranes.

use super::{
    bar::Bar,
    mesh::{Mesh, MeshError},
};
use crate::base::{Real, Vec3};

/// The reference shape of a membrane, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum MembraneShape {
    /// The lower half of an icosphere around the origin, its rim in the plane z = 0.
    HalfIcosphere {
        /// Radius (m).
        radius: Real,
        /// Number of parts into which each edge of the icosahedron is divided; must be even.
        frequency: usize,
    },
    /// A closed icosphere around the origin.
    Icosphere {
        /// Radius (m).
        radius: Real,
        /// Number of parts into which each edge of the icosahedron is divided.
        frequency: usize,
    },
    /// A cylinder around z, centered on the origin, with two rims.
    Tube {
        /// Radius (m).
        radius: Real,
        /// Height (m).
        height: Real,
        /// Number of vertices in a row.
        n_around: usize,
        /// Number of rows.
        n_rows: usize,
    },
    /// A closed bar along z with a square cross-section, centered on the origin.
    Bar(Bar),
    /// A flat disc around the origin with its normal along z and one rim.
    Disc {
        /// Radius (m).
        radius: Real,
        /// Number of rings of vertices around the center.
        n_rings: usize,
    },
    /// A triangle mesh, for example from a file.
    Mesh {
        /// Position of each vertex (m).
        vertices: Vec<Vec3>,
        /// Vertices of each facet, counterclockwise seen from outside.
        facets: Vec<[u32; 3]>,
    },
}

impl MembraneShape {
    /// Creates the mesh of the shape.
    ///
    /// # Errors
    /// If there are too few vertices, or the triangles do not form a surface.
    pub fn mesh(&self) -> Result<Mesh, MeshError> {
        match self {
            Self::HalfIcosphere { radius, frequency } => Mesh::half_icosphere(*radius, *frequency),
            Self::Icosphere { radius, frequency } => Mesh::icosphere(*radius, *frequency),
            Self::Tube { radius, height, n_around, n_rows } => {
                Mesh::tube(*radius, *height, *n_around, *n_rows)
            }
            Self::Bar(bar) => Mesh::bar(bar),
            Self::Disc { radius, n_rings } => Mesh::disc(*radius, *n_rings),
            Self::Mesh { vertices, facets } => Mesh::new(vertices.clone(), facets.clone()),
        }
    }
}
