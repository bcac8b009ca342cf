//! Meshes of spheres, half spheres and flat patches of nearly equilateral triangles.
//!
//! The icosahedron has a vertex at each pole. Its equator crosses the ten side faces along the lines
//! that bisect their edges. At an even frequency these are grid lines, so the ring of 5·frequency
//! vertices at z = 0 divides the sphere into two halves without dividing a triangle.
//!
//! Only square roots are used, no sines, so every machine computes the same bits.

use std::collections::BTreeMap;

use super::mesh::{Mesh, MeshError, index};
use crate::base::{Real, Vec3};

/// A point on a face of the icosahedron: corners with their integer weights, in ascending order.
type Weights = [(usize, usize); 3];

impl Mesh {
    /// The lower half (z ≤ 0) of the icosphere, its rim at z = 0. Frequency 16 gives 1321 vertices,
    /// 80 of them on the rim.
    ///
    /// # Errors
    /// If the frequency is odd or zero.
    pub fn half_icosphere(radius: Real, frequency: usize) -> Result<Self, MeshError> {
        if frequency == 0 || !frequency.is_multiple_of(2) {
            return Err(MeshError::Frequency { frequency });
        }
        let (positions, triangles) = geodesic(radius, frequency);
        let is_low = |triangle: &[u32; 3]| triangle.iter().all(|&v| positions[v as usize].z <= 0.0);
        let lower = triangles.iter().copied().filter(is_low).collect();
        let (positions, triangles) = coherent(&positions, lower);
        Self::new(positions, triangles)
    }

    /// The complete icosphere: 10·frequency² + 2 vertices.
    ///
    /// # Errors
    /// If the frequency is zero.
    pub fn icosphere(radius: Real, frequency: usize) -> Result<Self, MeshError> {
        if frequency == 0 {
            return Err(MeshError::Frequency { frequency });
        }
        let (positions, triangles) = geodesic(radius, frequency);
        let (positions, triangles) = coherent(&positions, triangles);
        Self::new(positions, triangles)
    }

    /// A flat hexagon of equilateral triangles with sides `edge`, with `rings` rings around its center,
    /// in the plane z = 0 with normals along +z.
    ///
    /// # Errors
    /// If `rings` is 0.
    pub fn hexagonal_patch(edge: Real, rings: usize) -> Result<Self, MeshError> {
        if rings == 0 {
            return Err(MeshError::Frequency { frequency: rings });
        }
        let rows = 2 * rings;
        let is_inside = |q: usize, r: usize| (rings..=3 * rings).contains(&(q + r));
        let mut number = BTreeMap::new();
        let mut positions = Vec::new();
        for r in 0..=rows {
            for q in (0..=rows).filter(|&q| is_inside(q, r)) {
                number.insert((q, r), index(positions.len()));
                let (x, y) = (q as Real - rings as Real, r as Real - rings as Real);
                positions.push(Vec3::new(x + 0.5 * y, 0.75_f64.sqrt() * y, 0.0) * edge);
            }
        }
        let mut triangles = Vec::new();
        for (&(q, r), &corner) in &number {
            let at = |q, r| number.get(&(q, r)).copied();
            if let (Some(right), Some(above)) = (at(q + 1, r), at(q, r + 1)) {
                triangles.push([corner, right, above]);
            }
            if q > 0
                && let (Some(above), Some(left)) = (at(q, r + 1), at(q - 1, r + 1))
            {
                triangles.push([corner, above, left]);
            }
        }
        Self::new(positions, triangles)
    }
}

/// Corners of the icosahedron on a unit sphere: north pole, upper ring, lower ring, south pole.
fn corners() -> [Vec3; 12] {
    let root5 = 5.0_f64.sqrt();
    // cos and sin of 36° and 72°.
    let (c36, s36) = ((1.0 + root5) / 4.0, (10.0 - 2.0 * root5).sqrt() / 4.0);
    let (c72, s72) = ((root5 - 1.0) / 4.0, (10.0 + 2.0 * root5).sqrt() / 4.0);
    let upper = [(1.0, 0.0), (c72, s72), (-c36, s36), (-c36, -s36), (c72, -s72)];
    let mut corners = [Vec3::zeros(); 12];
    corners[0] = Vec3::z();
    corners[11] = -Vec3::z();
    for (k, (x, y)) in upper.into_iter().enumerate() {
        let up = Vec3::new(2.0 * x, 2.0 * y, 1.0) / root5;
        corners[1 + k] = up;
        // The lower ring is the upper one reflected through the center: shifted by 2.5 vertices.
        corners[6 + (k + 2) % 5] = -up;
    }
    corners
}

/// Faces of the icosahedron, counterclockwise seen from outside. Lower corner k lies half a step after upper
/// corner k.
fn faces() -> Vec<[usize; 3]> {
    let mut faces = Vec::with_capacity(20);
    for k in 0..5 {
        let (up, up_next) = (1 + k, 1 + (k + 1) % 5);
        let (low, low_next) = (6 + k, 6 + (k + 1) % 5);
        faces.push([0, up, up_next]);
        faces.push([up, low, up_next]);
        faces.push([up_next, low, low_next]);
        faces.push([11, low_next, low]);
    }
    faces
}

/// Divides every face into frequency² triangles and projects all vertices onto the sphere.
fn geodesic(radius: Real, frequency: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corners = corners();
    let mut number: BTreeMap<Weights, u32> = BTreeMap::new();
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for face in faces() {
        let mut at = |weights: [usize; 3]| {
            let mut key: Weights = std::array::from_fn(|k| (face[k], weights[k]));
            for entry in &mut key {
                // Corners without weight must not distinguish faces.
                if entry.1 == 0 {
                    entry.0 = usize::MAX;
                }
            }
            key.sort_unstable();
            *number.entry(key).or_insert_with(|| {
                positions.push(on_sphere(&corners, &key) * radius);
                index(positions.len() - 1)
            })
        };
        for i in 0..frequency {
            for j in 0..frequency - i {
                let k = frequency - 1 - i - j;
                triangles.push([at([i + 1, j, k]), at([i, j + 1, k]), at([i, j, k + 1])]);
                if k > 0 {
                    let k = k - 1;
                    triangles.push([
                        at([i, j + 1, k + 1]),
                        at([i + 1, j, k + 1]),
                        at([i + 1, j + 1, k]),
                    ]);
                }
            }
        }
    }
    (positions, triangles)
}

fn on_sphere(corners: &[Vec3; 12], weights: &Weights) -> Vec3 {
    let mut point = Vec3::zeros();
    let (mut above, mut below) = (0, 0);
    for &(corner, weight) in weights.iter().filter(|(_, weight)| *weight > 0) {
        point += corners[corner] * weight as Real;
        match corner {
            0..=5 => above += weight,
            _ => below += weight,
        }
    }
    // Equal weights above and below occur only on the side faces, on the equator: z is exactly 0.
    if above == below {
        point.z = 0.0;
    }
    point.normalize()
}

/// Renumbers vertices and triangles so that those close in space are close in memory, and drops vertices without
/// triangle.
pub(super) fn coherent(positions: &[Vec3], triangles: Vec<[u32; 3]>) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut order: Vec<u32> = triangles.iter().flatten().copied().collect();
    order.sort_unstable();
    order.dedup();
    let extent = positions.iter().map(|p| p.amax()).fold(0.0, Real::max);
    order.sort_by_cached_key(|&v| (morton(&(positions[v as usize] / extent)), v));

    let mut new_number = vec![0; positions.len()];
    for (new, &old) in order.iter().enumerate() {
        new_number[old as usize] = index(new);
    }
    let mut triangles: Vec<[u32; 3]> = triangles
        .into_iter()
        .map(|triangle| {
            let mut renumbered = triangle.map(|v| new_number[v as usize]);
            // The smallest number comes first; rotating preserves the orientation.
            while renumbered[0] > renumbered[1].min(renumbered[2]) {
                renumbered.rotate_left(1);
            }
            renumbered
        })
        .collect();
    triangles.sort_unstable();
    (order.iter().map(|&v| positions[v as usize]).collect(), triangles)
}

/// Index on the Z-order curve of a point in the cube \[−1, 1\]³, with 10 bits for each axis.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 10 bits")]
fn morton(point: &Vec3) -> u32 {
    let mut code = 0;
    for axis in 0..3 {
        let cell = ((point[axis] + 1.0) * 512.0).clamp(0.0, 1023.0) as u32;
        for bit in 0..10 {
            code |= ((cell >> bit) & 1) << (3 * bit + axis);
        }
    }
    code
}
