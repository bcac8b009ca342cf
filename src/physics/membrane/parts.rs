//! Surfaces put together from parts, and turned inside out.

use super::mesh::{Mesh, MeshFault, index};

impl Mesh {
    /// The same surface with its outside where the inside was.
    ///
    /// # Errors
    /// None that the mesh did not have before.
    pub fn inside_out(self) -> Result<Self, MeshFault> {
        let turned = self.triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect();
        Self::new(self.positions, turned)
    }

    /// Both surfaces as one: the vertices of `self` first, then those of `other`.
    ///
    /// # Errors
    /// None that the meshes did not have before.
    pub fn joined(self, other: &Self) -> Result<Self, MeshFault> {
        let first = index(self.n_vertices());
        let Self { mut positions, mut triangles, .. } = self;
        positions.extend_from_slice(&other.positions);
        triangles.extend(other.triangles.iter().map(|it| it.map(|vertex| vertex + first)));
        Self::new(positions, triangles)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{mesh::Mesh, pressure};

    /// Oracle: the volumes of the two meshes alone; the air's load on a closed surface has no sum.
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
        assert!(sum.norm() < 1e-16, "{sum}: rounding of areas of 1e-6 m²");
    }
}
