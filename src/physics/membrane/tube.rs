//! Mesh of a straight tube with open ends, of nearly equilateral triangles.
//!
//! Rows of vertices run around the tube. Each is rotated by half a step against the one below:
//!
//! ```text
//!    row 2   o-----o-----o
//!           / \   / \   / \      edge around  2 R sin(π/n)
//!    row 1 o-----o-----o---      height of a row  H/(rows − 1), ideally 0.87 of the edge around
//!           \ /   \ /   \ /
//!    row 0   o-----o-----o
//! ```
//!
//! Sines and cosines are computed from their series, so every machine computes the same bits.

use super::icosphere::coherent;
use super::mesh::{Mesh, MeshError, index};
use crate::base::{Real, Vec3};

impl Mesh {
    /// A tube of `radius` and `height` (m) around the z axis, centered on the origin, with `n_rows`
    /// rows of `n_around` vertices. Both ends are open.
    ///
    /// # Errors
    /// If there are fewer than three vertices around or fewer than two rows.
    pub fn tube(
        radius: Real,
        height: Real,
        n_around: usize,
        n_rows: usize,
    ) -> Result<Self, MeshError> {
        if n_around < 3 || n_rows < 2 {
            return Err(MeshError::TooFew { n_around, n_rows });
        }
        let mut positions = Vec::with_capacity(n_around * n_rows);
        for row in 0..n_rows {
            let z = height * (row as Real / (n_rows - 1) as Real - 0.5);
            for k in 0..n_around {
                let part = (2 * k + row % 2) as Real / (2 * n_around) as Real;
                let (cosine, sine) = cosine_and_sine(part);
                positions.push(Vec3::new(radius * cosine, radius * sine, z));
            }
        }
        let at = |row: usize, k: usize| index(row * n_around + k % n_around);
        let mut triangles = Vec::with_capacity(2 * n_around * (n_rows - 1));
        for row in 0..n_rows - 1 {
            for k in 0..n_around {
                // The vertex of the row above that lies between vertices `k` and `k + 1`.
                let above = k + row % 2;
                triangles.push([at(row, k), at(row, k + 1), at(row + 1, above)]);
                triangles.push([at(row, k + 1), at(row + 1, above + 1), at(row + 1, above)]);
            }
        }
        let (positions, triangles) = coherent(&positions, triangles);
        Self::new(positions, triangles)
    }
}

/// Terms of the series, which is used for up to half a turn: the next one is below 10⁻¹⁶.
const N_TERMS: usize = 14;

/// Cosine and sine of an angle in turns, from 0 to 1.5.
pub(super) fn cosine_and_sine(mut turns: Real) -> (Real, Real) {
    if turns > 0.5 {
        turns -= 1.0;
    }
    let angle = 2.0 * std::f64::consts::PI * turns;
    let square = angle * angle;
    // From the smallest terms up: 1 − x²/(1·2) (1 − x²/(3·4) (1 − …)).
    let (mut cosine, mut sine) = (1.0, 1.0);
    for k in (1..=N_TERMS).rev() {
        let even = (2 * k) as Real;
        cosine = 1.0 - square / ((even - 1.0) * even) * cosine;
        sine = 1.0 - square / (even * (even + 1.0)) * sine;
    }
    (cosine, angle * sine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::membrane::pressure;

    /// Oracle: Götz (2024), table 3, and its spacings of 4.0 mm and 1.3 mm.
    #[test]
    fn the_tubes_of_the_source_have_the_published_vertices() {
        for (radius, height, n_around, n_rows, n_vertices, spacing) in [
            (0.025, 0.1, 39, 29, 1131, 4.0e-3),
            (0.035, 0.14, 54, 41, 2214, 4.0e-3),
            (0.025, 0.1, 120, 87, 10_440, 1.3e-3),
            (0.035, 0.14, 167, 122, 20_374, 1.3e-3),
        ] {
            let mesh = Mesh::tube(radius, height, n_around, n_rows).unwrap();
            assert_eq!(mesh.n_vertices(), n_vertices);
            assert_eq!(mesh.rims.len(), 2);
            assert_eq!(mesh.rims.iter().map(Vec::len).collect::<Vec<_>>(), [n_around, n_around]);
            // Oracle: Euler's formula for a surface with two rims, V − E + F = 0.
            assert_eq!(mesh.n_vertices() + mesh.triangles.len(), mesh.edges.len());
            for [a, b] in &mesh.edges {
                let edge = mesh.positions[*a as usize] - mesh.positions[*b as usize];
                // Tolerance: 4 %, because the numbers of rows and vertices are integers.
                assert!((edge.norm() / spacing - 1.0).abs() < 0.04, "{}", edge.norm());
            }
        }
    }

    /// Oracle: the volume of the cylinder, from below. A prism over the polygon of a row has n/2 R² sin(2π/n) H;
    /// rotated rows move the faces inward by at most the height of a chord. Outward normals give a
    /// positive sign.
    #[test]
    fn a_tube_has_the_volume_of_the_cylinder_and_outward_normals() {
        let (radius, height) = (0.025, 0.1);
        let mesh = Mesh::tube(radius, height, 120, 87).unwrap();
        let cylinder = std::f64::consts::PI * radius * radius * height;
        let volume = pressure::volume(&mesh, &mesh.positions);
        // Tolerance: chords of 1/120 of a turn lie π²/2/120² = 0.034 % inside; the area is too small by twice that.
        assert!(volume < cylinder && (volume / cylinder - 1.0).abs() < 1e-3, "{volume}");
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
            let outward = (a + b + c).component_mul(&Vec3::new(1.0, 1.0, 0.0));
            assert!((b - a).cross(&(c - a)).dot(&outward) > 0.0);
        }
    }

    /// Oracle: the platform's sine and cosine. Tolerance: a few roundings.
    #[test]
    fn the_series_match_sine_and_cosine() {
        for whole in [3, 39, 334] {
            for part in 0..2 * whole {
                let (cosine, sine) = cosine_and_sine(part as Real / (2 * whole) as Real);
                let angle = std::f64::consts::PI * part as Real / whole as Real;
                assert!((cosine - angle.cos()).abs() < 3e-15, "{part}/{whole}");
                assert!((sine - angle.sin()).abs() < 3e-15, "{part}/{whole}");
            }
        }
    }

    #[test]
    fn tubes_with_too_few_vertices_are_rejected() {
        assert!(Mesh::tube(1.0, 1.0, 2, 5).is_err());
        assert!(Mesh::tube(1.0, 1.0, 5, 1).is_err());
    }
}
