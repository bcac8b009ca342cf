//! Membranes as parts of a system.

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
    /// The vertices of all rims.
    Rims,
    /// The vertices of one rim, by its index in `Mesh::rims`.
    Rim(usize),
    /// The vertices with these indices.
    Group(Vec<u32>),
}

/// A membrane: its shape, its material, and the walls that hold it.
#[derive(Clone, Debug)]
pub struct Membrane {
    pub(super) model: MembraneModel,
    /// Initial positions of its vertices (m), world frame.
    pub(super) positions: Vec<Vec3>,
    held: Vec<(Vertices, WallId)>,
    has_free_rims: bool,
}

impl Membrane {
    /// A membrane of `material`, stress-free in `shape`, whose frame is the world frame.
    ///
    /// # Errors
    /// If the shape is not a valid surface.
    pub fn new(shape: &MembraneShape, material: MembraneMaterial) -> Result<Self, MeshError> {
        Ok(Self::of(MembraneModel::new(shape.mesh()?, material)))
    }

    /// A membrane of `material`, stress-free in `shape`, at `pose`.
    ///
    /// # Errors
    /// If the shape is not a valid surface.
    pub fn placed(
        shape: &MembraneShape,
        pose: &Pose,
        material: MembraneMaterial,
    ) -> Result<Self, MeshError> {
        let Mesh { mut positions, triangles, .. } = shape.mesh()?;
        positions.iter_mut().for_each(|p| *p = pose.rotation * *p + pose.translation.vector);
        Ok(Self::of(MembraneModel::new(Mesh::new(positions, triangles)?, material)))
    }

    /// A membrane from its model. Its holders are replaced by those set with `hold`.
    pub fn of(model: MembraneModel) -> Self {
        let positions = model.mesh.positions.clone();
        Self { model, positions, held: Vec::new(), has_free_rims: false }
    }

    /// Lets a wall hold `vertices` at their initial positions in its frame. If a vertex is given several times,
    /// the last wall holds it.
    #[must_use]
    pub fn hold(mut self, vertices: Vertices, wall: WallId) -> Self {
        self.held.push((vertices, wall));
        self
    }

    /// Allows rims that no wall holds.
    #[must_use]
    pub fn free_rims(mut self) -> Self {
        self.has_free_rims = true;
        self
    }

    /// Sets the initial positions of the vertices (m), world frame. The reference shape does not change.
    #[must_use]
    pub fn starting_at(mut self, positions: Vec<Vec3>) -> Self {
        self.positions = positions;
        self
    }

    /// Sets the contact geometry for grains.
    #[must_use]
    pub fn touched_at(mut self, contact: MembraneContact) -> Self {
        self.model.contact = contact;
        self
    }

    /// Determines the holder of each vertex.
    ///
    /// # Errors
    /// If vertices or walls do not exist, or a rim that must be held is not.
    pub(super) fn find_holders(
        &mut self,
        membrane: usize,
        n_walls: usize,
    ) -> Result<(), BuildError> {
        let mesh = &self.model.mesh;
        let n_vertices = mesh.n_vertices();
        if self.positions.len() != n_vertices {
            return Err(BuildError::Count {
                place: "initial positions of a membrane's vertices",
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
        let is_free_rim = |&v: &usize| mesh.is_on_rim[v] && holders[v] == FREE;
        match (0..n_vertices).find(is_free_rim).filter(|_| !self.has_free_rims) {
            Some(vertex) => Err(BuildError::FreeRim { membrane, vertex }),
            None => Ok(()),
        }
    }
}
