//! Tests of surfaces against finite differences, parry and each other.

use rapier3d_f64::parry;

use parry::shape::{Ball, Capsule, Cuboid, Cylinder, Shape};

use super::shape::{ShapeError, SignedDistance, Surface};
use crate::base::random::{Random, Stream};
use crate::base::{Real, Vec3};
use crate::physics::membrane::mesh::Mesh;

fn closed_forms() -> Vec<Surface> {
    vec![
        Surface::Sphere { radius: 0.02 },
        Surface::cuboid(&Vec3::new(0.03, 0.05, 0.02)),
        Surface::cylinder(0.015, 0.04),
        Surface::cylinder(0.02, 0.01),
        Surface::capsule(0.01, 0.05),
    ]
}

fn points(n: usize, size: Real) -> Vec<Vec3> {
    let mut random = Random::new(5, Stream::Position);
    (0..n).map(|_| Vec3::from_fn(|_, _| random.between(-size, size))).collect()
}

/// A cube with edge `size` around `center`, with outward normals.
fn cube(size: Real, center: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corner = |k: u32| {
        let side = |bit: u32| if k >> bit & 1 == 1 { 0.5 * size } else { -0.5 * size };
        center + Vec3::new(side(0), side(1), side(2))
    };
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    ((0..8).map(corner).collect(), faces.into_iter().flat_map(halves).collect())
}

/// Oracle: the normal is the gradient of the distance, by central differences; the closest point lies on the
/// surface. Skips points within one step of a ridge of the distance.
fn check_gradient(surface: &Surface, p: &Vec3) {
    let h = 1e-8;
    let here = surface.distance(p);
    let near: [SignedDistance; 6] = std::array::from_fn(|k| {
        let step = if k % 2 == 0 { h } else { -h };
        surface.distance(&(p + Vec3::ith(k / 2, step)))
    });
    if near.iter().any(|there| (there.normal - here.normal).norm() > 1e-4) {
        return;
    }
    for axis in 0..3 {
        let slope = (near[2 * axis].distance - near[2 * axis + 1].distance) / (2.0 * h);
        // Tolerance: rounding of 10⁻¹⁸ m over 2h, and curvature within h of a vertex or an axis.
        assert!((slope - here.normal[axis]).abs() < 1e-4, "{surface:?} at {p}: {slope} {here:?}");
    }
    // Tolerance: rounding.
    assert!((here.normal.norm() - 1.0).abs() < 1e-14);
    let error = surface.distance(&here.surface_point(p)).distance;
    assert!(error.abs() < 1e-15, "{surface:?}: the closest point is {error} m off the surface");
}

#[test]
fn normals_are_gradients() {
    for surface in closed_forms() {
        for p in points(3000, 0.06) {
            check_gradient(&surface, &p);
        }
    }
    let (vertices, triangles) = cube(0.03, Vec3::zeros());
    let cube = Surface::mesh(&vertices, &triangles).unwrap();
    for p in points(500, 0.04) {
        check_gradient(&cube, &p);
    }
}

#[test]
fn closed_forms_agree_with_parry() {
    // The axes of parry's cylinder and capsule are along y: map (x, y, z) to (y, z, x).
    let permuted = |p: &Vec3| Vec3::new(p.y, p.z, p.x);
    let same = |p: &Vec3| *p;
    let half = parry::math::Vector::new(0.015, 0.025, 0.01);
    let axis = parry::math::Vector::new(0.0, 0.015, 0.0);
    type Map = fn(&Vec3) -> Vec3;
    let oracles: [(Box<dyn Shape>, Map); 5] = [
        (Box::new(Ball::new(0.02)), same),
        (Box::new(Cuboid::new(half)), same),
        (Box::new(Cylinder::new(0.02, 0.015)), permuted),
        (Box::new(Cylinder::new(0.005, 0.02)), permuted),
        (Box::new(Capsule::new(-axis, axis, 0.01)), permuted),
    ];
    for (surface, (oracle, map)) in closed_forms().iter().zip(&oracles) {
        for p in points(3000, 0.06) {
            let q = map(&p);
            let projection = oracle.project_local_point(q.into(), false);
            let distance = (q - Vec3::from(projection.point)).norm();
            let signed = if projection.is_inside { -distance } else { distance };
            let found = surface.distance(&p).distance;
            // Oracle: parry's projection. Tolerance: rounding of coordinates of 6 cm.
            assert!((found - signed).abs() < 1e-15, "{surface:?} at {p}: {found} for {signed}");
        }
    }
}

#[test]
fn normals_are_accurate_at_zero_distance() {
    for surface in closed_forms() {
        for p in points(300, 0.06) {
            let far = surface.distance(&p);
            let closest = far.surface_point(&p);
            for distance in [1e-9, -1e-9, 1e-13, 0.0] {
                let near = surface.distance(&(closest + far.normal * distance));
                let is_smooth =
                    !matches!(surface, Surface::Cuboid { .. } | Surface::Cylinder { .. });
                if is_smooth || near.distance.abs() > 1e-10 && far.distance < 0.0 {
                    // Oracle: the normal at the same closest point, from far away. Tolerance: rounding
                    // of that point divided by the radius of curvature, or by the distance near an axis.
                    assert!((near.normal - far.normal).norm() < 1e-9, "{surface:?} {p} {distance}");
                }
                assert!((near.normal.norm() - 1.0).abs() < 1e-14);
            }
        }
        // Oracle: even at the center there is a unit normal.
        assert!((surface.distance(&Vec3::zeros()).normal.norm() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn a_mesh_has_stable_normals_on_faces_edges_and_vertices() {
    let (vertices, triangles) = cube(0.03, Vec3::new(0.1, 0.2, 0.3));
    let surface = Surface::mesh(&vertices, &triangles).unwrap();
    for distance in [1e-4, 1e-12, 0.0, -1e-12, -1e-4] {
        let found = surface.distance(&Vec3::new(0.004, 0.003, 0.015 + distance));
        // Oracle: a cube, its upper face. Tolerance: rounding.
        assert!((found.normal - Vec3::z()).norm() < 1e-14, "{found:?}");
        assert!((found.distance - distance).abs() < 1e-16, "{found:?}");
    }
    let diagonal = Vec3::new(0.0, 1.0, 1.0).normalize();
    let on_edge = surface.distance(&Vec3::new(0.004, 0.015, 0.015));
    // Oracle: on an edge, any normal between those of the adjacent faces. Their mean is the diagonal, 45° from
    // each.
    assert!(on_edge.normal.dot(&diagonal) > 0.7 && on_edge.distance.abs() < 1e-16, "{on_edge:?}");
    let at_vertex = surface.distance(&(Vec3::repeat(0.015) + Vec3::repeat(1e-3)));
    // Oracle: Pythagoras. Tolerance: rounding.
    assert!((at_vertex.distance - 1e-3 * 3.0_f64.sqrt()).abs() < 1e-16);
    assert!((at_vertex.normal - Vec3::repeat(1.0).normalize()).norm() < 1e-12);
}

#[test]
fn a_fine_mesh_approximates_its_sphere() {
    let mesh = Mesh::icosphere(0.02, 8).unwrap();
    let sphere = Surface::Sphere { radius: 0.02 };
    let by_mesh = Surface::mesh(&mesh.positions, &mesh.triangles).unwrap();
    let by_hull = Surface::convex_hull(&mesh.positions).unwrap();
    for surface in [&by_mesh, &by_hull] {
        for p in points(400, 0.04).iter().filter(|p| p.norm() > 0.005) {
            let (found, oracle) = (surface.distance(p), sphere.distance(p));
            // Oracle: the sphere. Tolerance: facets with sides up to a = 3.5 mm lie up to
            // a²/(6R) = 102 µm below it, and none above; normals deviate by up to
            // a/(√3 R) = 0.1, more far inside.
            let difference = found.distance - oracle.distance;
            assert!((-1e-15..1.02e-4).contains(&difference), "{difference} at {}", p.norm());
            assert!(found.normal.dot(&oracle.normal) > 0.98 || p.norm() < 0.015, "{found:?}");
        }
        let (found, oracle) = (surface.bulk(1200.0), sphere.bulk(1200.0));
        // Oracle: closed forms. Tolerance: the volume is too small by up to 3·102 µm/R = 1.5 %, the inertia by
        // 5/3 of that; the center is exact by symmetry.
        assert!((found.mass / oracle.mass - 1.0).abs() < 0.015, "{found:?}");
        let ratio = found.principal_inertia.component_div(&oracle.principal_inertia);
        assert!((ratio - Vec3::repeat(1.0)).amax() < 0.026, "{ratio}");
        assert!(found.center_of_mass.norm() < 1e-15);
        assert!((surface.bounding_radius() - 0.02).abs() < 1e-12);
    }
}

#[test]
fn mass_properties_match_parry() {
    let density = 1100.0;
    // Oracle: parry's mass properties; its cylinder and capsule have their axes along y. Tolerance: rounding.
    let half = parry::math::Vector::new(0.015, 0.025, 0.01);
    let oracles = [
        Ball::new(0.02).mass_properties(density),
        Cuboid::new(half).mass_properties(density),
        Cylinder::new(0.02, 0.015).mass_properties(density),
        Cylinder::new(0.005, 0.02).mass_properties(density),
        Capsule::new_y(0.015, 0.01).mass_properties(density),
    ];
    for (k, (surface, oracle)) in closed_forms().iter().zip(&oracles).enumerate() {
        let found = surface.bulk(density);
        let i = Vec3::from(oracle.principal_inertia());
        let expected = if k >= 2 { Vec3::new(i.z, i.x, i.y) } else { i };
        assert!((found.mass / oracle.mass() - 1.0).abs() < 1e-12, "{surface:?}");
        let ratio = found.principal_inertia.component_div(&expected);
        assert!((ratio - Vec3::repeat(1.0)).amax() < 1e-12, "{surface:?}: {ratio}");
    }
}

#[test]
fn a_rotated_and_shifted_box_has_the_same_inertia() {
    let size = Vec3::new(0.03, 0.05, 0.02);
    let rotation = crate::base::Quat::from_euler_angles(0.4, -0.7, 1.1);
    let center = Vec3::new(0.3, -0.1, 0.2);
    let (corners, triangles) = cube(1.0, Vec3::zeros());
    let corners: Vec<Vec3> =
        corners.iter().map(|c| rotation * c.component_mul(&size) + center).collect();
    let found = Surface::mesh(&corners, &triangles).unwrap().bulk(700.0);
    let oracle = Surface::cuboid(&size).bulk(700.0);
    let tensor = |rotation: crate::base::Quat, i: &Vec3| {
        let r = rotation.to_rotation_matrix().into_inner();
        r * crate::base::Mat3::from_diagonal(i) * r.transpose()
    };
    let expected = tensor(rotation, &oracle.principal_inertia);
    let difference = tensor(found.principal_axes, &found.principal_inertia) - expected;
    // Oracle: the closed form of the box, rotated. Tolerance: rounding, with cancellation of the shift.
    assert!((found.mass / oracle.mass - 1.0).abs() < 1e-12);
    assert!(difference.amax() < 1e-12 * expected.amax(), "{difference}");
    assert!((found.center_of_mass - center).norm() < 1e-14);
}

#[test]
fn invalid_solids_are_rejected() {
    let (vertices, mut triangles) = cube(1.0, Vec3::zeros());
    let error = |triangles: &[[u32; 3]]| Surface::mesh(&vertices, triangles).unwrap_err();
    // Oracle: the one error of each list.
    let flipped: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert_eq!(error(&flipped), ShapeError::InsideOut);
    assert!(matches!(error(&[[0, 1, 9]]), ShapeError::NoSuchVertex { vertex: 9, .. }));
    assert!(matches!(error(&[]), ShapeError::NotClosed { .. }));
    triangles.pop();
    assert_eq!(error(&triangles), ShapeError::NotClosed { n_open: 3, n_edges: 33 });
    let flat: Vec<Vec3> = vertices.iter().map(|v| Vec3::new(v.x, v.y, 0.0)).collect();
    assert_eq!(Surface::convex_hull(&flat).unwrap_err(), ShapeError::NoHull { n_points: 8 });
    assert!(matches!(Surface::convex_hull(&[]).unwrap_err(), ShapeError::NoHull { .. }));
}

#[test]
fn separate_triangles_are_merged() {
    let (vertices, triangles) = cube(0.03, Vec3::zeros());
    let separate: Vec<Vec3> = triangles.iter().flatten().map(|&v| vertices[v as usize]).collect();
    let each: Vec<[u32; 3]> = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let surface = Surface::mesh(&separate, &each).unwrap();
    // Oracle: the volume of the cube. Tolerance: rounding.
    assert!((surface.bulk(1.0).volume / 2.7e-5 - 1.0).abs() < 1e-14);
}
