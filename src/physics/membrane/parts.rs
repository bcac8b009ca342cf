//! Joins meshes and membranes, and turns meshes inside out.

use super::{
    Link, MembraneModel,
    mesh::{Mesh, MeshError, index},
};
use crate::base::Real;

impl Mesh {
    /// The same surface with inside and outside exchanged.
    ///
    /// # Errors
    /// None if the mesh is valid.
    pub fn inside_out(self) -> Result<Self, MeshError> {
        let flipped = self.triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect();
        Self::new(self.positions, flipped)
    }

    /// Joins two surfaces: the vertices of `self` come first, then those of `other`.
    ///
    /// # Errors
    /// None if the meshes are valid.
    pub fn joined(self, other: &Self) -> Result<Self, MeshError> {
        let first = index(self.n_vertices());
        let Self { mut positions, mut triangles, .. } = self;
        positions.extend_from_slice(&other.positions);
        triangles.extend(other.triangles.iter().map(|it| it.map(|vertex| vertex + first)));
        Self::new(positions, triangles)
    }
}

impl MembraneModel {
    /// Elastic (N m) and dissipative (N s) bending constant of a hinge.
    pub(super) fn bending_of(&self, hinge: usize) -> [Real; 2] {
        let of_all = [self.material.bending_stiffness, self.material.bending_damping];
        [0, 1].map(|k| self.bending[k].get(hinge).copied().unwrap_or(of_all[k]))
    }

    /// True if hinges use the areas of the reference shape.
    pub fn bends_by_first_areas(&self) -> bool {
        !self.reference_areas[0].is_empty()
    }

    /// Joins two membranes, each with its own material, rest lengths and holders. The vertices and facets of
    /// `self` come first, then those of `other`. Contact geometry, and whether hinges use the areas of the
    /// reference shape, are those of `self`.
    ///
    /// # Errors
    /// None if the meshes are valid.
    pub fn joined(mut self, other: &Self) -> Result<Self, MeshError> {
        let bends_by_first_areas = self.bends_by_first_areas();
        let constants = |of: &Self| {
            [of.material.bending_stiffness, of.material.bending_damping].map(Real::to_bits)
        };
        let is_alike = constants(&self) == constants(other);
        let n_hinges = [&self, other].map(|it| it.mesh.hinges.len());
        if !is_alike || !self.bending[0].is_empty() || !other.bending[0].is_empty() {
            let all = (0..n_hinges[0]).map(|k| self.bending_of(k));
            let all: Vec<_> = all.chain((0..n_hinges[1]).map(|k| other.bending_of(k))).collect();
            self.bending = [0, 1].map(|k| all.iter().map(|of_hinge| of_hinge[k]).collect());
        }
        let shift = [self.mesh.n_vertices(), self.mesh.triangles.len()].map(index);
        let mesh = self.mesh.joined(&other.mesh)?;
        // In the order of the edges of `Mesh`: hinges first, sorted by vertices, then boundary edges.
        let shifted = |link: &Link| {
            let moved = link.triangles.map(|t| t + shift[1]);
            let triangles = if link.is_hinge() { moved } else { link.triangles };
            Link { vertices: link.vertices.map(|v| v + shift[0]), triangles, ..*link }
        };
        let (hinges, boundary) = self.links.split_at(n_hinges[0]);
        let (other_hinges, other_boundary) = other.links.split_at(n_hinges[1]);
        let links = hinges.iter().copied().chain(other_hinges.iter().map(shifted));
        let links = links.chain(boundary.iter().copied());
        self.links = links.chain(other_boundary.iter().map(shifted)).collect();
        self.masses.extend(&other.masses);
        self.holders.extend(&other.holders);
        self.mesh = mesh;
        if bends_by_first_areas {
            self.bend_by_first_areas();
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{
        MembraneMaterial, MembraneModel, MembraneScratch, MembraneState,
        critical_step::critical_step, forces, mesh::Mesh, pressure,
    };
    use crate::base::Vec3;

    /// Oracle: each membrane alone. Joined, they have the same forces to the bit, because links are summed in
    /// the same order. The critical step is the smaller one. Tolerance: 1 % for power iteration.
    #[test]
    fn joined_membranes_have_the_same_forces_as_alone() {
        let material = MembraneMaterial {
            thickness: 3e-4,
            youngs_modulus: 1e6,
            density: 1e3,
            spring_damping: 0.2,
            bending_stiffness: 1e-4,
            bending_damping: 1e-7,
        };
        let stiffer = MembraneMaterial { youngs_modulus: 5e6, bending_stiffness: 3e-4, ..material };
        let dome = MembraneModel::new(Mesh::half_icosphere(0.02, 4).unwrap(), material);
        let mut disc = MembraneModel::new(Mesh::disc(0.015, 4).unwrap(), stiffer);
        disc.scale_rest_lengths(0.95);
        let both = dome.clone().joined(&disc).unwrap();
        let moved = |model: &MembraneModel| {
            let mut state = MembraneState::at_rest(&model.mesh);
            for (position, velocity) in state.positions.iter_mut().zip(&mut state.velocities) {
                // Any deformation that bends and stretches and depends only on the position.
                let p = *position * 200.0;
                *position +=
                    Vec3::new((p.y + p.z).sin(), (2.0 * p.x).cos(), (p.x * p.y).sin()) * 4e-4;
                *velocity = Vec3::new(p.z, p.x * p.y, p.y) * 0.1;
            }
            let mut scratch = MembraneScratch::new(model);
            forces(model, &state, -2e3, &mut scratch);
            scratch.forces
        };
        let alone: Vec<Vec3> = moved(&dome).into_iter().chain(moved(&disc)).collect();
        assert_eq!(moved(&both), alone);
        assert_eq!(both.mesh.edges.len(), dome.mesh.edges.len() + disc.mesh.edges.len());
        assert!((both.mass() - dome.mass() - disc.mass()).abs() < 1e-15);
        let steps = [&dome, &disc, &both].map(|model| critical_step(model, 0.0));
        assert!((steps[2] / steps[0].min(steps[1]) - 1.0).abs() < 0.01, "{steps:?}");
    }

    /// Oracle: the volumes of the two meshes alone; the pressure on a closed surface has no resultant.
    #[test]
    fn a_shell_between_two_spheres_encloses_the_difference() {
        let (outer, inner) = (Mesh::icosphere(0.04, 6).unwrap(), Mesh::icosphere(0.01, 2).unwrap());
        let alone = [&outer, &inner].map(|mesh| pressure::volume(mesh, &mesh.positions));
        let shell = outer.joined(&inner.inside_out().unwrap()).unwrap();
        let volume = pressure::volume(&shell, &shell.positions);
        assert!((volume - (alone[0] - alone[1])).abs() < 1e-12 * volume, "{volume}");
        assert!(shell.is_closed());
        let gradient = pressure::volume_gradient(&shell, &shell.positions);
        let sum: crate::base::Vec3 = gradient.iter().sum();
        assert!(sum.norm() < 1e-16, "{sum}: more than rounding of areas of 1e-6 m²");
    }
}
