//! Tests against voro++, closed forms, and sums.

use super::*;
use crate::base::{
    Quat,
    random::{Random, Stream},
};

fn scattered(n: usize, low: &Vec3, high: &Vec3, radii: [Real; 2]) -> (Vec<Vec3>, Vec<Real>) {
    let mut random = Random::new(21, Stream::Position);
    let positions = (0..n).map(|_| Vec3::from_fn(|k, _| random.between(low[k], high[k]))).collect();
    (positions, (0..n).map(|_| random.between(radii[0], radii[1])).collect())
}

fn total(cells: &[Cell]) -> Real {
    cells.iter().map(|cell| cell.volume).sum()
}

/// Oracle: pyvoro2, which wraps voro++ (tests/golden/measure/make.py): equal and unequal spheres, with walls
/// and periodic, and a channel in which one sphere is hidden. Tolerance 1e-10 of the volume: both round.
#[test]
fn volumes_and_faces_are_those_of_voro_plus_plus() {
    let text = include_str!("../../../tests/golden/measure/voronoi.json");
    let packings: Vec<serde_json::Value> = serde_json::from_str(text).unwrap();
    assert_eq!(packings.len(), 4);
    for packing in packings {
        let reals =
            |key: &str| -> Vec<Real> { serde_json::from_value(packing[key].clone()).unwrap() };
        let positions: Vec<[Real; 3]> =
            serde_json::from_value(packing["positions"].clone()).unwrap();
        let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from).collect();
        let corner = |key: &str| Vec3::from_column_slice(&reals(key));
        let (low, high) = (corner("low"), corner("high"));
        let is_periodic = packing["periodic"] == true;
        let container =
            if is_periodic { Container::periodic(high) } else { Container::cuboid(low, high) };
        let cells = laguerre_cells(&positions, &reals("radii"), &container);
        let name = &packing["name"];
        let n_faces: Vec<usize> = serde_json::from_value(packing["n_faces"].clone()).unwrap();
        for (i, volume) in reals("volumes").into_iter().enumerate() {
            let found = cells[i].volume;
            assert!((found - volume).abs() <= 1e-10 * volume, "{name} {i}: {found} {volume}");
            assert_eq!(cells[i].faces.len(), n_faces[i], "{name} {i}");
        }
        assert!((total(&cells) / (high - low).product() - 1.0).abs() < 1e-10);
    }
}

/// Oracle: π/√18 for touching spheres on the face-centered lattice, and the rhombic dodecahedron: twelve
/// faces of area √2/4 for diameter 1. Four of its faces meet in one point.
#[test]
fn a_lattice_has_its_exact_cells() {
    let (n, edge) = (4_usize, 2.0_f64.sqrt());
    let basis = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
    let mut positions = Vec::new();
    for cell in 0..n * n * n {
        let corner = Vec3::new(real(cell % n), real(cell / n % n), real(cell / n / n));
        positions.extend(basis.map(|b| (corner + Vec3::from(b)) * edge));
    }
    let radii = vec![0.5; positions.len()];
    let container = Container::periodic(Vec3::repeat(real(n) * edge));
    let cells = laguerre_cells(&positions, &radii, &container);
    for (cell, fraction) in cells.iter().zip(local_solid_fractions(&cells, &radii)) {
        assert!((fraction.unwrap() - PI / 18.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(cell.faces.len(), 12);
        assert!(cell.faces.iter().all(|face| (face.area - edge / 4.0).abs() < 1e-12));
    }
    // Simple cubic: unit cubes, six faces.
    let positions: Vec<Vec3> =
        (0..64).map(|k| Vec3::new(real(k % 4), real(k / 4 % 4), real(k / 16))).collect();
    let container = Container::periodic(Vec3::repeat(4.0));
    for cell in laguerre_cells(&positions, &[0.3; 64], &container) {
        assert!((cell.volume - 1.0).abs() < 1e-12 && cell.faces.len() == 6, "{cell:?}");
    }
}

/// Oracle: the container's volume and symmetry. Radii that differ by a factor of ten, positions at
/// random: many cells are empty, many do not contain their own center. Faces have the same area
/// from both sides.
#[test]
fn cells_fill_the_box_and_share_their_faces() {
    let (low, high) = (Vec3::new(-1.0, 2.0, 0.0), Vec3::new(1.0, 3.0, 0.7));
    let (positions, radii) = scattered(2000, &low, &high, [0.02, 0.2]);
    let cells = laguerre_cells(&positions, &radii, &Container::cuboid(low, high));
    assert!((total(&cells) / (high - low).product() - 1.0).abs() < 1e-10);
    assert!(cells.iter().any(|cell| cell.faces.is_empty() && cell.volume == 0.0));
    let mut sides = [0.0; 6];
    for (i, cell) in cells.iter().enumerate() {
        for face in &cell.faces {
            match face.neighbor {
                Neighbor::Sphere(j) => {
                    let back = cells[j].faces.iter().find(|it| it.neighbor == Neighbor::Sphere(i));
                    let area = back.map_or(0.0, |it| it.area);
                    assert!((area - face.area).abs() < 1e-11, "{i} {j}: {area} {}", face.area);
                }
                Neighbor::Side(side) => sides[side] += face.area,
                other => panic!("{other:?} in a box"),
            }
        }
    }
    for (side, area) in sides.into_iter().enumerate() {
        let edges = high - low;
        let expected = edges.product() / edges[side / 2];
        assert!((area / expected - 1.0).abs() < 1e-10, "{side}: {area}");
    }
}

/// Oracle: by hand. A small sphere inside a large one has no cell; a center outside its own cell is valid; of
/// two spheres at the same position the first has the cell.
#[test]
fn a_hidden_sphere_has_an_empty_cell() {
    let cuboid = Container::cuboid(Vec3::repeat(-1.0), Vec3::repeat(1.0));
    let hidden = [Vec3::zeros(), Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.9, 0.0, 0.0)];
    let cells = laguerre_cells(&hidden, &[0.5, 0.01, 0.5], &cuboid);
    assert_eq!(cells[1], Cell::default());
    assert_eq!(local_solid_fractions(&cells, &[0.5, 0.01, 0.5])[1], None);
    assert!((total(&cells) - 8.0).abs() < 1e-13);
    let twice = [Vec3::zeros(), Vec3::zeros()];
    let cells = laguerre_cells(&twice, &[0.2, 0.2], &cuboid);
    assert_eq!((cells[0].volume, cells[1].volume), (8.0, 0.0));
    assert!(laguerre_cells(&[], &[], &cuboid).is_empty());
    let flat = Container::cuboid(Vec3::repeat(-1.0), Vec3::new(1.0, 1.0, -1.0));
    assert!(total(&laguerre_cells(&hidden, &[0.1; 3], &flat)).abs() < 1e-15);
}

/// Oracle: the box minus the corner of volume 1/6 that the wall cuts off, and the wall's triangle
/// of area √3/2.
#[test]
fn walls_cut_cells() {
    let (low, high) = (Vec3::zeros(), Vec3::repeat(2.0));
    let (positions, radii) = scattered(300, &low, &high, [0.05, 0.1]);
    let normal = Vec3::repeat(1.0).normalize();
    let planes = [Plane { point: Vec3::x(), normal }];
    let container = Container::cuboid(low, high).with_planes(&planes);
    let cells = laguerre_cells(&positions, &radii, &container);
    assert!((total(&cells) / (8.0 - 1.0 / 6.0) - 1.0).abs() < 1e-10);
    let faces = cells.iter().flat_map(|cell| &cell.faces);
    let wall: Real =
        faces.filter(|face| face.neighbor == Neighbor::Plane(0)).map(|face| face.area).sum();
    assert!((wall - 0.75_f64.sqrt()).abs() < 1e-10, "{wall}");
}

/// A ring of `n` by `m` quads around z, each of two triangles, counterclockwise seen from outside.
fn ring(n: u32, m: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let at = |k: u32, n: u32| f64::from(k) / f64::from(n) * 2.0 * PI;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for k in 0..n {
        for l in 0..m {
            let (turn, tilt) = (at(k, n) + 0.1, at(l, m) + 0.07);
            let radius = 1.0 + 0.4 * tilt.cos();
            positions.push(Vec3::new(radius * turn.cos(), radius * turn.sin(), 0.4 * tilt.sin()));
            let id = |k: u32, l: u32| k % n * m + l % m;
            let [a, b, c, d] = [id(k, l), id(k + 1, l), id(k + 1, l + 1), id(k, l + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (positions, triangles)
}

/// Oracle: the volume and the facets of the surface itself, a ring, which is not convex. Half of the centers
/// are outside. Tolerance 1e-10.
#[test]
fn cells_fill_a_closed_surface_that_is_not_convex() {
    let (vertices, triangles) = ring(24, 12);
    let (low, high) = (Vec3::new(-1.4, -1.4, -0.4), Vec3::new(1.4, 1.4, 0.4));
    let (positions, radii) = scattered(400, &low, &high, [0.02, 0.1]);
    let container = Container::surface(&vertices, &triangles).unwrap();
    let cells = laguerre_cells(&positions, &radii, &container);
    let volume: Real = triangles
        .iter()
        .map(|t| t.map(|v| vertices[v as usize]))
        .map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0)
        .sum();
    assert!((total(&cells) / volume - 1.0).abs() < 1e-10, "{} {volume}", total(&cells));
    let mut areas = vec![0.0; triangles.len()];
    for face in cells.iter().flat_map(|cell| &cell.faces) {
        assert!(face.area > 0.0 && !matches!(face.neighbor, Neighbor::Side(_)), "{face:?}");
        if let Neighbor::Facet(f) = face.neighbor {
            areas[f] += face.area;
        }
    }
    for (area, triangle) in areas.iter().zip(&triangles) {
        let [a, b, c] = triangle.map(|v| vertices[v as usize]);
        let expected = (b - a).cross(&(c - a)).norm() / 2.0;
        assert!((area / expected - 1.0).abs() < 1e-8, "{area} {expected}");
    }
    assert!(matches!(Container::surface(&vertices, &triangles[1..]), Err(OpenSurface(..))));
}

/// Oracle: the same cells cut by six walls. A rotated cube of twelve triangles, whose center is not in line
/// with an edge.
#[test]
fn a_cube_of_triangles_cuts_as_six_walls_do() {
    let rotation = Quat::from_euler_angles(0.3, 0.4, 0.5);
    let vertices: Vec<Vec3> = (0..8_u32)
        .map(|k| rotation * Vec3::from_fn(|axis, _| if k >> axis & 1 == 1 { 0.5 } else { -0.5 }))
        .collect();
    let quads: [[u32; 4]; 6] =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles: Vec<[u32; 3]> =
        quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let planes: Vec<Plane> = (0..6)
        .map(|k| {
            let normal = rotation * Vec3::ith(k / 2, if k % 2 == 0 { 1.0 } else { -1.0 });
            Plane { point: normal * -0.5, normal }
        })
        .collect();
    let (low, high) = (Vec3::repeat(-0.87), Vec3::repeat(0.87));
    let (mut positions, mut radii) = scattered(300, &low, &high, [0.02, 0.1]);
    // On edges, on corners, in the planes of facets, and at the center.
    positions.extend(&vertices);
    positions.extend([Vec3::zeros(), (vertices[0] + vertices[6]) / 2.0, vertices[0] * 1.2]);
    radii.resize(positions.len(), 0.05);
    let by_planes = Container::cuboid(low, high).with_planes(&planes);
    let expected = laguerre_cells(&positions, &radii, &by_planes);
    let surface = Container::surface(&vertices, &triangles).unwrap();
    let found = laguerre_cells(&positions, &radii, &surface);
    for (i, (a, b)) in found.iter().zip(&expected).enumerate() {
        assert!((a.volume - b.volume).abs() < 1e-12, "{i}: {} {}", a.volume, b.volume);
    }
    assert!((total(&found) - 1.0).abs() < 1e-10);
}
