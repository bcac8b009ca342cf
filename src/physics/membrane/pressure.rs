//! The air's load on the membrane, and the volume it encloses.
//!
//! ```text
//! F_i = Σ_a p A_a n̂_a / 3        over the triangles a at vertex i
//! V   = 1/6 Σ_a r_a · (r_b × r_c)  over the triangles of membrane and lid
//! dV  = Σ_i g_i · dr_i,   so the load p g_i has the power p dV/dt
//!
//! p   gauge pressure inside, negative under vacuum   (Pa)
//! n̂_a outward unit normal
//! ```
//!
//! Source: Götz (2024) eqs. 30, 31. The load follows the surface. Each rim is closed by a lid: a fan
//! of triangles from the rim to the mean of its vertices. The mean of the first rim is taken as the
//! origin, so its lid adds nothing to the sum for V.

use super::mesh::{Mesh, area_normal};
use crate::base::{Real, Vec3};

/// Volume inside membrane and lids (m³).
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

/// Derivative of the volume with respect to each vertex (m²). Inside the membrane it is the load per
/// unit pressure; at a rim it has the lid's share as well.
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
        let to_each = lid_area_vector(rim, positions) / (3.0 * rim.len() as Real);
        for (from, to) in rim_edges(rim) {
            let sixth = (positions[from] - center).cross(&(positions[to] - center)) / 6.0;
            gradient[from] += sixth;
            gradient[to] += sixth;
            // The center's own third is carried by the rim, whose mean it is.
            gradient[from] += to_each;
        }
    }
    gradient
}

/// Area of the membrane without its lids (m²).
pub fn area(mesh: &Mesh, positions: &[Vec3]) -> Real {
    mesh.triangles.iter().map(|triangle| 0.5 * area_normal(positions, triangle).norm()).sum()
}

/// Area vector of the lid on a rim, outward (m²): times the gauge pressure, the air's force on it.
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
