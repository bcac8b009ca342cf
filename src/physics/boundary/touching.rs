//! Where a sphere touches a surface of triangles.
//!
//! A sphere touches the surface where the distance of its center has a local minimum. On an edge or a
//! vertex the closest point of a triangle counts only if no triangle around it comes closer; of those
//! that give the same point a face counts before an edge and an edge before a vertex, and then the
//! triangle with the lowest number. A sphere on a flat surface therefore has one contact, however the
//! surface is divided, and a sphere in a corner has one with each side.
//!
//! A sphere that moves in a shallow valley can lose a minimum while it still overlaps it. Its share of
//! the force must be zero by then:
//!
//! ```text
//! F_i = c_i F(ξ_i),   c_i = 1/(1 + Σ_(j≠i) g_ij r_ij)
//! r_ij = ξ_j w_ji / (ξ_i w_ij),   w_ij = √(b_ij² − d_i²),   g_ij = (R − b_ij)/(R − max(d_i, d_j))
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | R | reach: the radius, and the range of the law | m |
//! | d_i | distance of the center from minimum i | m |
//! | ξ_i | R − d_i | m |
//! | b_ij | height of the saddle between i and j: the least that the largest distance on a way over the surface from i to j can be; R if every way leaves the sphere | m |
//! | w_ij | what separates i from that saddle | m |
//!
//! When i is about to be lost to j, w_ij = 0, so c_i = 0, and c_j = 1. When the sphere does not overlap
//! the saddle, g_ij = 0 and both have their full force, as on two separate walls: the rule of the membrane
//! (`contact::sharing`) would leave 1/1.05 of it. The shares of two minima in a very shallow valley add up
//! to 1. All quantities are continuous in the position of the sphere.

use super::triangles::{Nearest, Triangles};
use crate::{
    base::{Real, Vec3},
    physics::membrane::{contact_geometry::Feature, mesh::NONE},
};

/// Distances that differ by less than this share are equal.
const EQUAL: Real = 1e-9;

/// A contact of a sphere with triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Where it is.
    pub nearest: Nearest,
    /// Share of the force that a single contact would have.
    pub share: Real,
}

/// A way between two triangles across their common edge.
struct Crossing {
    /// Distance of the sphere's center from the edge (m).
    height: Real,
    /// Both triangles, as indices among those within reach.
    between: [usize; 2],
}

impl Triangles {
    /// The contacts of a sphere around `point` (m), wall frame, that reaches `reach` (m): ascending by
    /// triangle. `candidates`, ascending, must hold every triangle within reach.
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

    /// True if no triangle around the feature is closer, or gives the same point and counts before.
    fn is_local_minimum(&self, nearest: &Nearest, near: &[Nearest]) -> bool {
        let mesh = self.mesh();
        let triangle = nearest.triangle as usize;
        let is_beaten = |other: u32| {
            let other = near.binary_search_by_key(&other, |it| it.triangle).ok();
            other.is_some_and(|k| near[k].beats(nearest))
        };
        match nearest.feature {
            Feature::Face => true,
            Feature::Edge(k) => {
                let across = mesh.neighbours_of_triangle[triangle][usize::from(k)];
                across == NONE || !is_beaten(across)
            }
            Feature::Vertex(k) => {
                let vertex = mesh.triangles[triangle][usize::from(k)];
                !mesh.triangles_of_vertex.of(vertex as usize).iter().any(|&t| is_beaten(t))
            }
        }
    }

    /// c of each minimum; `minima` are indices in `near`.
    fn shares(&self, near: &[Nearest], minima: &[usize], point: &Vec3, reach: Real) -> Vec<Real> {
        let saddles = self.saddles(near, minima, point, reach);
        let distance = |i: usize| near[minima[i]].distance;
        let share = |i: usize| {
            let others = (0..minima.len()).filter(|&j| j != i).map(|j| {
                let saddle = saddles[i * minima.len() + j];
                let (own, other) = (distance(i), distance(j));
                let joined = (reach - saddle) / (reach - own.max(other));
                if joined <= 0.0 {
                    return 0.0;
                }
                let width = |d: Real| (saddle * saddle - d * d).max(0.0).sqrt();
                let weight = |d: Real| (reach - d) * width(d);
                // Two minima that have become one point share evenly.
                let ratio = if weight(own) > 0.0 || weight(other) > 0.0 {
                    weight(other) / weight(own)
                } else {
                    1.0
                };
                joined.min(1.0) * ratio
            });
            1.0 / (1.0 + others.sum::<Real>())
        };
        (0..minima.len()).map(share).collect()
    }

    /// b between all pairs of minima (m), row by row: edges are opened from the nearest on, and what they
    /// join is one basin.
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

    /// Edges within reach between the triangles in `near`, the nearest first.
    fn crossings(&self, near: &[Nearest], point: &Vec3, reach: Real) -> Vec<Crossing> {
        let mesh = self.mesh();
        let mut crossings = Vec::new();
        for (a, nearest) in near.iter().enumerate() {
            let corners = mesh.triangles[nearest.triangle as usize];
            for (k, &across) in
                mesh.neighbours_of_triangle[nearest.triangle as usize].iter().enumerate()
            {
                // Each edge once; `NONE` is in no list.
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
    /// True if this closest point of a neighbor is closer than `other`, or the same and counts before.
    fn beats(&self, other: &Self) -> bool {
        let difference = self.distance - other.distance;
        let tolerance = EQUAL * other.distance;
        let (mine, yours) = (self.feature.priority(), other.feature.priority());
        difference < -tolerance
            || (difference <= tolerance
                && (mine > yours || (mine == yours && self.triangle < other.triangle)))
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

    /// Two planes that meet on the x axis and rise by `slope` on both sides, cut into triangles.
    fn valley(slope: Real) -> Triangles {
        let line = |y: Real| [-1.0, 0.1, 1.0].map(|x| Vec3::new(x, y, slope * y.abs()));
        let vertices = [-1.0, 0.0, 1.0].into_iter().flat_map(line).collect();
        let square = |k: u32| [[k, k + 1, k + 3], [k + 1, k + 4, k + 3]];
        Triangles::new(vertices, [0, 1, 3, 4].into_iter().flat_map(square).collect()).unwrap()
    }

    /// Force of a spring with overlaps as lengths, with the shares (m).
    fn force(surface: &Triangles, point: &Vec3, reach: Real) -> Vec3 {
        let all: Vec<u32> = (0..8).collect();
        let touches = surface.touching(&all, point, reach);
        let of_one = |it: &Touch| it.nearest.normal * ((reach - it.nearest.distance) * it.share);
        touches.iter().map(of_one).sum()
    }

    /// Oracle: continuity. The largest jump on a way across the valley, which a grain of radius 0.2 crosses at an
    /// overlap of 5 %, is proportional to the length of a step.
    #[test]
    fn the_force_has_no_jump_in_a_shallow_valley() {
        for slope in [0.0, 1e-6, 0.01, 0.05, 0.1, 0.3] {
            let surface = valley(slope);
            let jump = |n: u32| {
                let place = |k: u32| {
                    let y = 0.06 * (2.0 * Real::from(k) / Real::from(n) - 1.0);
                    force(&surface, &Vec3::new(0.03 + y, y, 0.19 * (1.0 + slope * slope)), 0.2)
                };
                let steps = (0..n).map(|k| (place(k + 1) - place(k)).norm());
                steps.fold(0.0, Real::max)
            };
            let (coarse, fine) = (jump(1000), jump(64_000));
            if slope < 1e-3 {
                // One step passes from one side to the other, whose normals hardly differ.
                assert!(coarse < 1e-7, "slope {slope}: {coarse}");
            } else {
                // The share varies as a root where a minimum ends.
                assert!(fine <= coarse / 6.0, "slope {slope}: {coarse} {fine}");
            }
        }
    }

    /// Oracle: symmetry. In the middle of a very shallow valley both sides have half of the force; in a
    /// steep one, whose edge the sphere does not reach, all of it.
    #[test]
    fn two_sides_share_in_a_shallow_valley_only() {
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
