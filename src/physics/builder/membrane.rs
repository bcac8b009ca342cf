//! Membranes as parts of a system to be built.

use super::{BuildError, WallId};
use crate::{
    base::{Pose, Vec3},
    physics::membrane::{
        FREE, MembraneContact, MembraneMaterial, MembraneModel,
        mesh::{Mesh, MeshError},
        shape::MembraneShape,
    },
};

/// Vertices of one membrane.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Vertices {
    /// All of them.
    All,
    /// Those of all rims.
    Rims,
    /// Those of one rim, by its number in `Mesh::rims`.
    Rim(usize),
    /// These.
    Group(Vec<u32>),
}

/// A membrane: shape, material, and the walls that hold it.
#[derive(Clone, Debug)]
pub struct Membrane {
    pub(super) model: MembraneModel,
    /// Where its vertices are at first (m), world frame.
    pub(super) positions: Vec<Vec3>,
    held: Vec<(Vertices, WallId)>,
    has_free_rims: bool,
}

impl Membrane {
    /// A membrane of `material` that is free of stress in `shape`, with its frame in the world's.
    ///
    /// # Errors
    /// If the shape is no surface.
    pub fn new(shape: &MembraneShape, material: MembraneMaterial) -> Result<Self, MeshError> {
        Ok(Self::of(MembraneModel::new(shape.mesh()?, material)))
    }

    /// The same at another pose.
    ///
    /// # Errors
    /// If the shape is no surface.
    pub fn placed(
        shape: &MembraneShape,
        pose: &Pose,
        material: MembraneMaterial,
    ) -> Result<Self, MeshError> {
        let Mesh { mut positions, triangles, .. } = shape.mesh()?;
        positions.iter_mut().for_each(|p| *p = pose.rotation * *p + pose.translation.vector);
        Ok(Self::of(MembraneModel::new(Mesh::new(positions, triangles)?, material)))
    }

    /// A membrane whose model is made already. Its holders are those named by `hold`.
    pub fn of(model: MembraneModel) -> Self {
        let positions = model.mesh.positions.clone();
        Self { model, positions, held: Vec::new(), has_free_rims: false }
    }

    /// The same with vertices held by a wall, fixed in its frame where they are at first. Of
    /// several calls for one vertex the last counts.
    #[must_use]
    pub fn hold(mut self, vertices: Vertices, wall: WallId) -> Self {
        self.held.push((vertices, wall));
        self
    }

    /// The same with rims that may hang free.
    #[must_use]
    pub fn free_rims(mut self) -> Self {
        self.has_free_rims = true;
        self
    }

    /// The same with its vertices at `positions` (m) at first, world frame; the reference shape
    /// stays.
    #[must_use]
    pub fn starting_at(mut self, positions: Vec<Vec3>) -> Self {
        self.positions = positions;
        self
    }

    /// The same with spheres around its vertices as what grains touch, or its triangles.
    #[must_use]
    pub fn touched_at(mut self, contact: MembraneContact) -> Self {
        self.model.contact = contact;
        self
    }

    /// Finds the holder of each vertex.
    ///
    /// # Errors
    /// If vertices or walls do not exist, or a rim is not held that should be.
    pub(super) fn find_holders(
        &mut self,
        membrane: usize,
        n_walls: usize,
    ) -> Result<(), BuildError> {
        let mesh = &self.model.mesh;
        let n_vertices = mesh.n_vertices();
        if self.positions.len() != n_vertices {
            return Err(BuildError::Count {
                place: "first positions of a membrane's vertices",
                found: self.positions.len(),
                expected: n_vertices,
            });
        }
        let holders = &mut self.model.holders;
        holders.fill(FREE);
        for (vertices, wall) in &self.held {
            if n_walls <= wall.index() {
                return Err(BuildError::NoSuchWall { membrane, wall: wall.index(), n_walls });
            }
            let mut hold = |vertex: usize| match holders.get_mut(vertex) {
                Some(holder) => {
                    *holder = wall.holder();
                    Ok(())
                }
                None => Err(BuildError::NoSuchVertices {
                    membrane,
                    what: "vertex",
                    index: vertex,
                    limit: n_vertices,
                }),
            };
            match vertices {
                Vertices::All => (0..n_vertices).try_for_each(&mut hold)?,
                Vertices::Rims => {
                    mesh.rims.iter().flatten().try_for_each(|&v| hold(v as usize))?;
                }
                Vertices::Rim(rim) => {
                    let missing = BuildError::NoSuchVertices {
                        membrane,
                        what: "rim",
                        index: *rim,
                        limit: mesh.rims.len(),
                    };
                    let rim = mesh.rims.get(*rim).ok_or(missing)?;
                    rim.iter().try_for_each(|&v| hold(v as usize))?;
                }
                Vertices::Group(group) => group.iter().try_for_each(|&v| hold(v as usize))?,
            }
        }
        let is_loose = |&v: &usize| mesh.is_on_rim[v] && holders[v] == FREE;
        match (0..n_vertices).find(is_loose).filter(|_| !self.has_free_rims) {
            Some(vertex) => Err(BuildError::FreeRim { membrane, vertex }),
            None => Ok(()),
        }
    }
}
