//! Rigid triangulated surfaces, for walls that are neither plane nor round.
//!
//! A grain may touch several faces, edges and vertices of such a wall at the same time, so there is no
//! single distance. Each triangle has a closest point and the feature on which it lies;
//! `Triangles::touching` selects the local minima of the distance, each once. The surface may be open.
//! Grains touch its triangles from both sides, and the normal points toward the grain.

use std::sync::Arc;

use crate::{
    base::{Real, Vec3},
    physics::membrane::{
        contact_geometry::{Feature, closest_on_triangle},
        mesh::{Mesh, MeshError},
    },
};

/// A triangulated surface, in the frame of its wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangles {
    mesh: Arc<Mesh>,
    /// Center (m) and radius (m) of a sphere around each triangle.
    spheres: Vec<(Vec3, Real)>,
    bounding_radius: Real,
}

/// The point of a triangle that is closest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The triangle.
    pub triangle: u32,
    /// Its face, edge or vertex on which the closest point lies.
    pub feature: Feature,
    /// Distance (m), never negative.
    pub distance: Real,
    /// Unit normal from the closest point to the given one, wall frame. On the surface it is the normal of the
    /// triangle.
    pub normal: Vec3,
}

impl Triangles {
    /// A surface with these vertices (m) and facets.
    ///
    /// # Errors
    /// If the facets do not form a consistently oriented surface whose rims do not touch.
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

    /// Vertices and facets with their connectivity.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Radius of a sphere around the frame's origin that contains the surface (m).
    pub fn bounding_radius(&self) -> Real {
        self.bounding_radius
    }

    /// Center (m) and radius (m) of a sphere around a triangle, wall frame. It is used to find candidates.
    pub fn sphere_around(&self, triangle: u32) -> (Vec3, Real) {
        self.spheres[triangle as usize]
    }

    /// The point of `triangle` that is closest to `point` (m), wall frame.
    pub fn nearest(&self, triangle: u32, point: &Vec3) -> Nearest {
        let corners = self.mesh.triangles[triangle as usize];
        let positions = corners.each_ref().map(|v| &self.mesh.positions[*v as usize]);
        let closest = closest_on_triangle(point, positions);
        let separation = point - closest.point;
        let distance = separation.norm();
        let normal = if distance > 0.0 {
            separation / distance
        } else {
            crate::physics::membrane::mesh::area_normal(&self.mesh.positions, &corners).normalize()
        };
        Nearest { triangle, feature: closest.feature, distance, normal }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A floor and a vertical wall along x, of two triangles each.
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

    /// The contacts of a sphere among all triangles.
    fn within(surface: &Triangles, point: &Vec3, reach: Real) -> Vec<Nearest> {
        let all: Vec<u32> = (0..).zip(&surface.mesh().triangles).map(|(t, _)| t).collect();
        let touches = surface.touching(&all, point, reach);
        // None of the contacts below overlaps a saddle.
        assert!(touches.iter().all(|it| it.share.to_bits() == 1.0_f64.to_bits()), "{touches:?}");
        touches.into_iter().map(|it| it.nearest).collect()
    }

    /// Oracle: the planes of the corner. A sphere in a corner touches each of them once, however they are divided
    /// into triangles.
    #[test]
    fn a_sphere_in_a_corner_touches_both_planes_once() {
        let surface = corner();
        // Above the diagonals of both squares, where two triangles meet.
        for x in [0.5, 0.31] {
            let point = Vec3::new(x, 0.1, 0.12);
            let mut found = within(&surface, &point, 0.15);
            found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            assert_eq!(found.len(), 2, "{found:?}");
            assert!((found[0].distance - 0.1).abs() < 1e-15);
            assert!((found[0].normal - Vec3::y()).norm() < 1e-14, "{found:?}");
            assert!((found[1].distance - 0.12).abs() < 1e-15);
            assert!((found[1].normal - Vec3::z()).norm() < 1e-14, "{found:?}");
        }
        assert!(within(&surface, &Vec3::new(0.5, 0.5, 0.2), 0.15).is_empty());
    }

    /// Oracle: a point outside the ridge is closest to the edge; distance by Pythagoras.
    #[test]
    fn outside_a_ridge_only_the_edge_is_touched() {
        let surface = corner();
        let found = within(&surface, &Vec3::new(0.4, -0.03, -0.04), 0.1);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(matches!(found[0].feature, Feature::Edge(_)), "{found:?}");
        assert!((found[0].distance - 0.05).abs() < 1e-15);
        assert!((found[0].normal - Vec3::new(0.0, -0.6, -0.8)).norm() < 1e-13);
    }

    /// Oracle: a sphere above an edge or a vertex of a flat surface touches it once.
    #[test]
    fn a_sphere_on_a_diagonal_or_a_vertex_counts_once() {
        let mesh = Arc::new(Mesh::hexagonal_patch(1.0, 2).unwrap());
        let surface = Triangles::of(mesh);
        for point in [Vec3::new(0.0, 0.0, 0.2), Vec3::new(0.5, 0.0, 0.2), Vec3::new(0.3, 0.2, 0.2)]
        {
            let found = within(&surface, &point, 0.3);
            assert_eq!(found.len(), 1, "{point:?}: {found:?}");
            assert!((found[0].distance - 0.2).abs() < 1e-15);
            assert!((found[0].normal - Vec3::z()).norm() < 1e-14);
        }
        assert!((surface.bounding_radius() - 2.0).abs() < 1e-14);
        let (center, radius) = surface.sphere_around(0);
        assert!(radius < 0.6 && center.z == 0.0);
    }
}
