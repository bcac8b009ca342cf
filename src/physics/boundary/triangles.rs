//! A rigid surface of triangles: what a wall is made of when it is neither plane nor round.
//!
//! A grain may touch several faces, edges and vertices of such a wall at once, so there is no
//! single distance. For each triangle there is the closest point and the feature it lies on;
//! `Triangles::within` keeps the local minima of the distance, each once. The surface may be open;
//! its triangles are touched from both sides, and the normal points towards the grain.

use std::sync::Arc;

use crate::{
    base::{Real, Vec3},
    physics::membrane::{
        contact_geometry::{Feature, closest_on_triangle},
        mesh::{Mesh, MeshError},
    },
};

/// The triangles of a wall in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    mesh: Arc<Mesh>,
    /// Center of a sphere around each triangle (m), and its radius (m).
    spheres: Vec<(Vec3, Real)>,
    bounding_radius: Real,
}

/// Where a triangle is closest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The triangle.
    pub triangle: u32,
    /// Face, edge or vertex of it.
    pub feature: Feature,
    /// Distance from the surface (m), never negative.
    pub distance: Real,
    /// Unit normal from the surface to the point, wall frame. On the surface itself it is the
    /// triangle's own.
    pub normal: Vec3,
}

impl Triangles {
    /// A surface with these vertices (m) and facets.
    ///
    /// # Errors
    /// If the facets are not a consistently oriented surface with rims that do not touch.
    pub fn new(vertices: Vec<Vec3>, facets: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        Ok(Self::of(Arc::new(Mesh::new(vertices, facets)?)))
    }

    /// The surface of a mesh.
    pub fn of(mesh: Arc<Mesh>) -> Self {
        let sphere = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
            let center = (a + b + c) / 3.0;
            let radius = [a, b, c].iter().map(|p| (p - center).norm()).fold(0.0, Real::max);
            (center, radius)
        };
        let spheres = mesh.triangles.iter().map(sphere).collect();
        let bounding_radius = mesh.positions.iter().map(|p| p.norm()).fold(0.0, Real::max);
        Self { mesh, spheres, bounding_radius }
    }

    /// Vertices and facets with their neighbors.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Nothing is further from the frame's origin than this (m).
    pub fn bounding_radius(&self) -> Real {
        self.bounding_radius
    }

    /// A sphere around a triangle: center (m) and radius (m), wall frame. For lists of candidates.
    pub fn sphere_around(&self, triangle: u32) -> (Vec3, Real) {
        self.spheres[triangle as usize]
    }

    /// Where `triangle` is closest to `point` (m), wall frame.
    pub fn nearest(&self, triangle: u32, point: &Vec3) -> Nearest {
        let corners = self.mesh.triangles[triangle as usize];
        let positions = corners.each_ref().map(|v| &self.mesh.positions[*v as usize]);
        let closest = closest_on_triangle(point, positions);
        let apart = point - closest.point;
        let distance = apart.norm();
        let normal = if distance > 0.0 {
            apart / distance
        } else {
            crate::physics::membrane::mesh::area_normal(&self.mesh.positions, &corners).normalize()
        };
        Nearest { triangle, feature: closest.feature, distance, normal }
    }

    /// The closest points within `reach` (m) of `point` (m), wall frame: one for each face, edge or
    /// vertex that is the closest part of all triangles around it. These are the contacts of a
    /// grain of that radius.
    pub fn within(&self, point: &Vec3, reach: Real) -> Vec<Nearest> {
        let is_close = |(center, radius): &(Vec3, Real)| (point - center).norm() < reach + radius;
        let candidates = (0..).zip(&self.spheres).filter(|(_, sphere)| is_close(sphere));
        let found: Vec<Nearest> = candidates
            .map(|(t, _)| self.nearest(t, point))
            .filter(|nearest| nearest.distance < reach)
            .collect();
        found.iter().filter(|it| self.is_local_minimum(it, point)).copied().collect()
    }

    /// True if no triangle around the feature comes nearer to `point`, and, of those that share
    /// the feature, this is the one with the lowest number.
    fn is_local_minimum(&self, nearest: &Nearest, point: &Vec3) -> bool {
        let mesh = &self.mesh;
        let corners = mesh.triangles[nearest.triangle as usize];
        let around: Vec<u32> = match nearest.feature {
            Feature::Face => Vec::new(),
            Feature::Edge(k) => {
                let edge = mesh.edges_of_triangle[nearest.triangle as usize][k as usize];
                let pair = mesh.triangles_of_edge[edge as usize];
                pair.into_iter().filter(|&t| t != crate::physics::membrane::mesh::NONE).collect()
            }
            Feature::Vertex(k) => {
                mesh.triangles_of_vertex.of(corners[k as usize] as usize).to_vec()
            }
        };
        // Two triangles give the distance of a common edge with relative rounding errors of 10⁻¹⁶.
        let is_nearer = |other: &Nearest| other.distance < nearest.distance * (1.0 - 1e-9);
        around.into_iter().filter(|&t| t != nearest.triangle).all(|t| {
            let other = self.nearest(t, point);
            let is_same = (other.distance - nearest.distance).abs() <= 1e-9 * nearest.distance;
            !is_nearer(&other) && (!is_same || nearest.triangle < t)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A floor of two triangles and a wall of two more at a right angle, along x.
    fn corner() -> Triangles {
        let vertices = vec![
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(1.0, 0.0, 0.0),
            Vec3::new(0.0, 1.0, 0.0),
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::new(0.0, 0.0, 1.0),
            Vec3::new(1.0, 0.0, 1.0),
        ];
        let facets = vec![[0, 1, 2], [1, 3, 2], [0, 4, 1], [4, 5, 1]];
        Triangles::new(vertices, facets).unwrap()
    }

    /// Oracle: the corner's own planes. A sphere in an inner corner touches both, however the
    /// planes are cut into triangles, and each of them once.
    #[test]
    fn a_sphere_in_a_corner_touches_both_planes_once() {
        let surface = corner();
        // Over the diagonals of both squares, where two triangles meet.
        for x in [0.5, 0.31] {
            let point = Vec3::new(x, 0.1, 0.12);
            let mut found = surface.within(&point, 0.15);
            found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            assert_eq!(found.len(), 2, "{found:?}");
            assert!((found[0].distance - 0.1).abs() < 1e-15);
            assert!((found[0].normal - Vec3::y()).norm() < 1e-14, "{found:?}");
            assert!((found[1].distance - 0.12).abs() < 1e-15);
            assert!((found[1].normal - Vec3::z()).norm() < 1e-14, "{found:?}");
        }
        assert!(surface.within(&Vec3::new(0.5, 0.5, 0.2), 0.15).is_empty());
    }

    /// Oracle: a point on the other side of the ridge is closest to the edge alone; distance by
    /// Pythagoras.
    #[test]
    fn outside_a_ridge_only_the_edge_is_touched() {
        let surface = corner();
        let found = surface.within(&Vec3::new(0.4, -0.03, -0.04), 0.1);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(matches!(found[0].feature, Feature::Edge(_)), "{found:?}");
        assert!((found[0].distance - 0.05).abs() < 1e-15);
        assert!((found[0].normal - Vec3::new(0.0, -0.6, -0.8)).norm() < 1e-13);
    }

    /// Oracle: a sphere over the middle of a square touches it once on its diagonal, and over a
    /// shared vertex once.
    #[test]
    fn a_sphere_on_a_diagonal_or_a_vertex_counts_once() {
        let mesh = Arc::new(Mesh::hexagonal_patch(1.0, 2).unwrap());
        let surface = Triangles::of(mesh);
        for place in [Vec3::new(0.0, 0.0, 0.2), Vec3::new(0.5, 0.0, 0.2), Vec3::new(0.3, 0.2, 0.2)]
        {
            let found = surface.within(&place, 0.3);
            assert_eq!(found.len(), 1, "{place:?}: {found:?}");
            assert!((found[0].distance - 0.2).abs() < 1e-15);
            assert!((found[0].normal - Vec3::z()).norm() < 1e-14);
        }
        assert!((surface.bounding_radius() - 2.0).abs() < 1e-14);
        let (center, radius) = surface.sphere_around(0);
        assert!(radius < 0.6 && center.z == 0.0);
    }
}
