//! Pressure on the membrane, and the enclosed volume.
//!
//! ```text
//! F_i = Σ_a p A_a n̂_a / 3           over the triangles a at vertex i
//! V   = 1/6 Σ_a r_1 · (r_2 × r_3)   over the triangles of membrane and lids
//! dV  = Σ_i g_i · dr_i,   so the load p g_i has the power p dV/dt
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | F_i | force of the air on vertex i | N |
//! | p | gauge pressure inside, negative under vacuum | Pa |
//! | A_a, n̂_a | area and outward unit normal of triangle a | m², – |
//! | V | enclosed volume | m³ |
//! | r_1, r_2, r_3 | corners of triangle a | m |
//! | g_i | gradient of the volume with respect to vertex i | m² |
//!
//! Source: Götz (2024), eqs. 30, 31. The load follows the deformed surface. Each rim is closed by a lid: a
//! fan of triangles from the rim to the mean of its vertices. The origin is the mean of the first rim, so
//! its lid does not contribute to the sum for V. Valid for uniform pressure and closed or lidded surfaces.

use super::mesh::{Mesh, area_normal};
use crate::base::{Real, Vec3};

/// Volume enclosed by membrane and lids (m³).
pub fn volume(mesh: &Mesh, positions: &[Vec3]) -> Real {
    let origin = mesh.rims.first().map_or(positions[0], |rim| lid_center(rim, positions));
    let mut six_volumes = 0.0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| positions[v as usize] - origin);
        six_volumes += a.dot(&b.cross(&c));
    }
    for rim in mesh.rims.iter().skip(1) {
        let height = lid_center(rim, positions) - origin;
        six_volumes += 2.0 * height.dot(&lid_area_vector(rim, positions));
    }
    six_volumes / 6.0
}

/// Derivative of the volume with respect to each vertex (m²). Away from rims it is the load per unit pressure; at
/// a rim it includes the contribution of the lid.
pub fn volume_gradient(mesh: &Mesh, positions: &[Vec3]) -> Vec<Vec3> {
    let mut gradient = vec![Vec3::zeros(); positions.len()];
    for triangle in &mesh.triangles {
        let sixth = area_normal(positions, triangle) / 6.0;
        for &vertex in triangle {
            gradient[vertex as usize] += sixth;
        }
    }
    for rim in &mesh.rims {
        let center = lid_center(rim, positions);
        let per_vertex = lid_area_vector(rim, positions) / (3.0 * rim.len() as Real);
        for (from, to) in rim_edges(rim) {
            let sixth = (positions[from] - center).cross(&(positions[to] - center)) / 6.0;
            gradient[from] += sixth;
            gradient[to] += sixth;
            // The third of the lid's center is distributed over the rim, because the center is its mean.
            gradient[from] += per_vertex;
        }
    }
    gradient
}

/// Area of the membrane without its lids (m²).
pub fn area(mesh: &Mesh, positions: &[Vec3]) -> Real {
    mesh.triangles.iter().map(|triangle| 0.5 * area_normal(positions, triangle).norm()).sum()
}

/// Outward area vector of the lid on a rim (m²). Times the gauge pressure it is the force of the air on the lid.
pub fn lid_area_vector(rim: &[u32], positions: &[Vec3]) -> Vec3 {
    let center = lid_center(rim, positions);
    let mut twice = Vec3::zeros();
    for (from, to) in rim_edges(rim) {
        twice += (positions[from] - center).cross(&(positions[to] - center));
    }
    0.5 * twice
}

/// Mean of a rim's vertices (m).
pub fn lid_center(rim: &[u32], positions: &[Vec3]) -> Vec3 {
    let sum: Vec3 = rim.iter().map(|&v| positions[v as usize]).sum();
    sum / rim.len() as Real
}

fn rim_edges(rim: &[u32]) -> impl Iterator<Item = (usize, usize)> {
    let n = rim.len();
    (0..n).map(move |k| (rim[k] as usize, rim[(k + 1) % n] as usize))
}
