//! Contacts of a sphere with a triangulated surface.
//!
//! A sphere touches the surface where the distance of its center has a local minimum. The closest point of a
//! triangle on an edge or a vertex counts only if no adjacent triangle has a closer point. Of adjacent triangles
//! with the same closest point, faces have priority over edges and edges over vertices, then the triangle with
//! the lowest index. A sphere on a flat surface therefore has one contact, however the surface is divided, and a
//! sphere in a corner has one contact with each side.
//!
//! When a sphere moves in a shallow valley, a minimum can vanish while the sphere still overlaps it. Its share of
//! the force must be zero by then:
//!
//! ```text
//! F_i = c_i F(ξ_i),   c_i = 1/(1 + Σ_(j≠i) g_ij r_ij)
//! r_ij = ξ_j w_ji / (ξ_i w_ij),   w_ij = √(b_ij² − d_i²),   g_ij = (R − b_ij)/(R − max(d_i, d_j))
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | F(ξ) | force of the contact law | N |
//! | c_i | share of minimum i, from 0 to 1 | – |
//! | R | reach: the radius plus the range of the law | m |
//! | d_i | distance of the center from minimum i | m |
//! | ξ_i | R − d_i | m |
//! | b_ij | height of the saddle between i and j: the smallest possible maximum of the distance along a path on the surface from i to j; R if every path leaves the sphere | m |
//! | w_ij | separation of minimum i from that saddle | m |
//! | g_ij | coupling: 0 for separate contacts, 1 for a very shallow valley | – |
//!
//! When minimum i is about to merge with j, w_ij = 0, so c_i = 0 and c_j = 1. When the sphere does not overlap
//! the saddle, g_ij = 0 and both have their full force, as with two separate walls; the rule of the membrane
//! (`contact::sharing`) would leave 1/1.05 of it. The shares of two minima in a very shallow valley add up
//! to 1. All quantities are continuous in the position of the sphere.
//!
//! Source: none; this rule was developed for jamgrip.

use super::triangles::{Nearest, Triangles};
use crate::{
    base::{Real, Vec3},
    physics::membrane::{contact_geometry::Feature, mesh::NONE},
};

/// Relative difference below which distances count as equal.
const EQUAL: Real = 1e-9;

/// A contact of a sphere with triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// The closest point.
    pub nearest: Nearest,
    /// Share of the force of a single contact.
    pub share: Real,
}

/// An edge between two triangles, which may be a saddle.
struct Crossing {
    /// Distance of the sphere's center from the edge (m).
    height: Real,
    /// Indices of both triangles in the list of triangles within reach.
    between: [usize; 2],
}

impl Triangles {
    /// The contacts of a sphere with the center `point` (m), wall frame, and the radius `reach` (m), in the order of
    /// triangles. `candidates` must contain every triangle within reach, ascending.
    pub fn touching(&self, candidates: &[u32], point: &Vec3, reach: Real) -> Vec<Touch> {
        let mut near = Vec::new();
        for &triangle in candidates {
            let (center, radius) = self.sphere_around(triangle);
            let limit = reach + radius;
            if (point - center).norm_squared() < limit * limit {
                let nearest = self.nearest(triangle, point);
                if nearest.distance < reach {
                    near.push(nearest);
                }
            }
        }
        let minima: Vec<usize> =
            (0..near.len()).filter(|&k| self.is_local_minimum(&near[k], &near)).collect();
        let shares = match minima.len() {
            0 | 1 => vec![1.0; minima.len()],
            _ => self.shares(&near, &minima, point, reach),
        };
        minima.iter().zip(shares).map(|(&k, share)| Touch { nearest: near[k], share }).collect()
    }

    /// True if no triangle at the feature is closer, or has the same closest point with higher priority.
    fn is_local_minimum(&self, nearest: &Nearest, near: &[Nearest]) -> bool {
        let mesh = self.mesh();
        let triangle = nearest.triangle as usize;
        let is_preceded = |other: u32| {
            let other = near.binary_search_by_key(&other, |it| it.triangle).ok();
            other.is_some_and(|k| near[k].precedes(nearest))
        };
        match nearest.feature {
            Feature::Face => true,
            Feature::Edge(k) => {
                let across = mesh.neighbors_of_triangle[triangle][usize::from(k)];
                across == NONE || !is_preceded(across)
            }
            Feature::Vertex(k) => {
                let vertex = mesh.triangles[triangle][usize::from(k)];
                !mesh.triangles_of_vertex.of(vertex as usize).iter().any(|&t| is_preceded(t))
            }
        }
    }

    /// Share c of each minimum; `minima` are indices in `near`.
    fn shares(&self, near: &[Nearest], minima: &[usize], point: &Vec3, reach: Real) -> Vec<Real> {
        let saddles = self.saddles(near, minima, point, reach);
        let distance = |i: usize| near[minima[i]].distance;
        let share = |i: usize| {
            let others = (0..minima.len()).filter(|&j| j != i).map(|j| {
                let saddle = saddles[i * minima.len() + j];
                let (own, other) = (distance(i), distance(j));
                let coupling = (reach - saddle) / (reach - own.max(other));
                if coupling <= 0.0 {
                    return 0.0;
                }
                let width = |d: Real| (saddle * saddle - d * d).max(0.0).sqrt();
                let weight = |d: Real| (reach - d) * width(d);
                // Two minima at the same point have equal shares.
                let ratio = if weight(own) > 0.0 || weight(other) > 0.0 {
                    weight(other) / weight(own)
                } else {
                    1.0
                };
                coupling.min(1.0) * ratio
            });
            1.0 / (1.0 + others.sum::<Real>())
        };
        (0..minima.len()).map(share).collect()
    }

    /// Saddle heights b of all pairs of minima (m), row by row: basins are merged at edges in order of height.
    fn saddles(&self, near: &[Nearest], minima: &[usize], point: &Vec3, reach: Real) -> Vec<Real> {
        let n = minima.len();
        let mut saddles = vec![reach; n * n];
        let mut basins: Vec<usize> = (0..near.len()).collect();
        for Crossing { height, between } in self.crossings(near, point, reach) {
            let [a, b] = between.map(|k| basins[k]);
            if a == b {
                continue;
            }
            for (i, &one) in minima.iter().enumerate() {
                for (j, &other) in minima.iter().enumerate() {
                    if basins[one] == a && basins[other] == b {
                        saddles[i * n + j] = height;
                        saddles[j * n + i] = height;
                    }
                }
            }
            for basin in &mut basins {
                *basin = if *basin == b { a } else { *basin };
            }
        }
        saddles
    }

    /// Edges within reach between the triangles in `near`, sorted by distance.
    fn crossings(&self, near: &[Nearest], point: &Vec3, reach: Real) -> Vec<Crossing> {
        let mesh = self.mesh();
        let mut crossings = Vec::new();
        for (a, nearest) in near.iter().enumerate() {
            let corners = mesh.triangles[nearest.triangle as usize];
            for (k, &across) in
                mesh.neighbors_of_triangle[nearest.triangle as usize].iter().enumerate()
            {
                // Each edge once. `NONE` is never in the list.
                let Ok(b) = near.binary_search_by_key(&across, |it| it.triangle) else { continue };
                if a < b {
                    let [from, to] =
                        [k, (k + 1) % 3].map(|it| &mesh.positions[corners[it] as usize]);
                    let height = distance_from_edge(point, from, to);
                    if height < reach {
                        crossings.push(Crossing { height, between: [a, b] });
                    }
                }
            }
        }
        crossings.sort_by(|one, other| one.height.total_cmp(&other.height));
        crossings
    }
}

impl Nearest {
    /// True if this closest point is closer than `other`, that of an adjacent triangle, or the same with higher
    /// priority.
    fn precedes(&self, other: &Self) -> bool {
        let difference = self.distance - other.distance;
        let tolerance = EQUAL * other.distance;
        let (own, others) = (self.feature.priority(), other.feature.priority());
        difference < -tolerance
            || (difference <= tolerance
                && (own > others || (own == others && self.triangle < other.triangle)))
    }
}

fn distance_from_edge(point: &Vec3, from: &Vec3, to: &Vec3) -> Real {
    let side = to - from;
    let along = ((point - from).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
    (point - (from + side * along)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A valley of two planes that meet at the x axis and rise with `slope` on both sides, divided into triangles.
    fn valley(slope: Real) -> Triangles {
        let line = |y: Real| [-1.0, 0.1, 1.0].map(|x| Vec3::new(x, y, slope * y.abs()));
        let vertices = [-1.0, 0.0, 1.0].into_iter().flat_map(line).collect();
        let square = |k: u32| [[k, k + 1, k + 3], [k + 1, k + 4, k + 3]];
        Triangles::new(vertices, [0, 1, 3, 4].into_iter().flat_map(square).collect()).unwrap()
    }

    /// Sum of normals times overlaps times shares (m), the force of springs of unit stiffness.
    fn force(surface: &Triangles, point: &Vec3, reach: Real) -> Vec3 {
        let all: Vec<u32> = (0..8).collect();
        let touches = surface.touching(&all, point, reach);
        let of_one = |it: &Touch| it.nearest.normal * ((reach - it.nearest.distance) * it.share);
        touches.iter().map(of_one).sum()
    }

    /// Oracle: continuity. The largest jump of the force on a path across the valley is proportional to the
    /// length of a step, for a grain of radius 0.2 with an overlap of 5 %.
    #[test]
    fn the_force_is_continuous_in_a_shallow_valley() {
        for slope in [0.0, 1e-6, 0.01, 0.05, 0.1, 0.3] {
            let surface = valley(slope);
            let jump = |n: u32| {
                let force_at = |k: u32| {
                    let y = 0.06 * (2.0 * Real::from(k) / Real::from(n) - 1.0);
                    force(&surface, &Vec3::new(0.03 + y, y, 0.19 * (1.0 + slope * slope)), 0.2)
                };
                let steps = (0..n).map(|k| (force_at(k + 1) - force_at(k)).norm());
                steps.fold(0.0, Real::max)
            };
            let (coarse, fine) = (jump(1000), jump(64_000));
            if slope < 1e-3 {
                // One step crosses from one side to the other, whose normals hardly differ.
                assert!(coarse < 1e-7, "slope {slope}: {coarse}");
            } else {
                // The share varies like a square root where a minimum vanishes.
                assert!(fine <= coarse / 6.0, "slope {slope}: {coarse} {fine}");
            }
        }
    }

    /// Oracle: symmetry. In the middle of a very shallow valley both sides have half of the force; in a steep valley
    /// whose edge the sphere does not reach, all of it.
    #[test]
    fn two_sides_share_the_force_only_in_a_shallow_valley() {
        let all: Vec<u32> = (0..8).collect();
        let shares = |slope: Real, height: Real| -> Vec<Real> {
            let touches = valley(slope).touching(&all, &Vec3::new(0.03, 0.0, height), 0.2);
            touches.iter().map(|it| it.share).collect()
        };
        let shallow = shares(1e-3, 0.19);
        assert_eq!(shallow.len(), 2);
        assert!(shallow.iter().all(|share| (share - 0.5).abs() < 1e-4), "{shallow:?}");
        assert_eq!(shares(1.0, 0.27), [1.0, 1.0]);
    }
}
