//! Mesh of a flat disc of nearly equilateral triangles: a center and rings around it.
//!
//! Ring k has 6 k vertices at the radius k R/n. In each sixth, ring k has k vertices and the next inner ring
//! has k − 1:
//!
//! ```text
//!   ring 2   o---o---o        edge along ring k    2 R k/n sin(π/6k)      1.00 to 1.05 R/n
//!             \ / \ /         edge across          R/n                    to 1.45 R/n
//!   ring 1     o---o          the longest connect large rings, at the ends of a sixth
//!               \ /
//!   center       o
//! ```

use super::icosphere::coherent;
use super::mesh::{Mesh, MeshError, index};
use super::tube::cosine_and_sine;
use crate::base::{Real, Vec3};

/// Vertices of the first ring.
const N_SIXTHS: usize = 6;

impl Mesh {
    /// A flat disc of `radius` (m) around the origin in the plane z = 0, with normals along z and
    /// `n_rings` rings of vertices around the center. For n rings it has 1 + 3 n (n + 1) vertices, 6 n of
    /// them on the rim, and 6 n² triangles.
    ///
    /// # Errors
    /// If `n_rings` is 0.
    pub fn disc(radius: Real, n_rings: usize) -> Result<Self, MeshError> {
        if n_rings == 0 {
            return Err(MeshError::TooFewRings { n_rings });
        }
        let mut positions = vec![Vec3::zeros()];
        for ring in 1..=n_rings {
            let from_center = radius * ring as Real / n_rings as Real;
            for vertex in 0..N_SIXTHS * ring {
                let (cosine, sine) = cosine_and_sine(vertex as Real / (N_SIXTHS * ring) as Real);
                positions.push(Vec3::new(from_center * cosine, from_center * sine, 0.0));
            }
        }
        // The rings inside this one have 6 (1 + 2 + …) vertices.
        let at = |ring: usize, vertex: usize| match ring {
            0 => 0,
            _ => index(1 + N_SIXTHS * ring * (ring - 1) / 2 + vertex % (N_SIXTHS * ring)),
        };
        let mut triangles = Vec::with_capacity(N_SIXTHS * n_rings * n_rings);
        for ring in 1..=n_rings {
            for vertex in 0..N_SIXTHS * ring {
                let (sixth, k) = (vertex / ring, vertex % ring);
                let inner = sixth * (ring - 1) + k;
                triangles.push([at(ring, vertex), at(ring, vertex + 1), at(ring - 1, inner)]);
                if k + 1 < ring {
                    let next = [at(ring - 1, inner), at(ring, vertex + 1), at(ring - 1, inner + 1)];
                    triangles.push(next);
                }
            }
        }
        let (positions, triangles) = coherent(&positions, triangles);
        Self::new(positions, triangles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::membrane::mesh::area_normal;

    /// Oracles: the numbers at the top of the file; V − E + F = 1 for a disc; the area of the regular
    /// polygon of the rim, half of 6 n R² sin(π/3n); one closed rim of 6 n vertices at R.
    #[test]
    fn a_disc_has_the_right_area_one_rim_and_even_edges() {
        let radius = 0.03;
        for n in [1, 2, 5, 12] {
            let mesh = Mesh::disc(radius, n).unwrap();
            assert_eq!(mesh.n_vertices(), 1 + 3 * n * (n + 1));
            assert_eq!(mesh.triangles.len(), 6 * n * n);
            assert_eq!(mesh.n_vertices() + mesh.triangles.len() - mesh.edges.len(), 1);
            let normals = mesh.triangles.iter().map(|it| area_normal(&mesh.positions, it));
            let area = normals.map(|normal| {
                assert!(
                    normal.z > 0.0 && normal.xy().norm() == 0.0,
                    "not flat, or the outside is not above"
                );
                0.5 * normal.z
            });
            let sides = 6.0 * n as Real;
            let polygon = 0.5 * sides * radius.powi(2) * (std::f64::consts::TAU / sides).sin();
            assert!((area.sum::<Real>() / polygon - 1.0).abs() < 1e-13);
            assert_eq!(mesh.rims.len(), 1);
            assert_eq!(mesh.rims[0].len(), 6 * n);
            for &v in &mesh.rims[0] {
                let position = mesh.positions[v as usize];
                assert!((position.norm() / radius - 1.0).abs() < 1e-14 && position.z == 0.0);
            }
            let length =
                |[a, b]: [u32; 2]| (mesh.positions[a as usize] - mesh.positions[b as usize]).norm();
            // Oracle: the law of cosines bounds the squared length of an edge between rings by
            // 1 + k (k − 1) (π/3k)².
            let longest = (1.0 + (std::f64::consts::PI / 3.0).powi(2)).sqrt();
            let spacing = radius / n as Real;
            for &edge in &mesh.edges {
                let share = length(edge) / spacing;
                assert!((1.0 - 1e-12..longest).contains(&share), "{n}: {share}");
            }
        }
        assert_eq!(Mesh::disc(1.0, 0), Err(MeshError::TooFewRings { n_rings: 0 }));
    }
}
