//! Tests of meshes: published numbers, connectivity, invalid meshes.

use super::super::mesh::{Mesh, MeshError, NONE, area_normal};
use super::super::pressure;
use crate::base::{Real, Vec3};

#[test]
fn meshes_have_the_published_numbers_of_vertices() {
    let half = Mesh::half_icosphere(0.04, 16).unwrap();
    let whole = Mesh::icosphere(0.04, 16).unwrap();
    let inner = Mesh::icosphere(0.01, 4).unwrap();
    // Oracle: Götz (2024) section 4: 1321 vertices of the gripper, 162 and 2562 of the hollow
    // sphere; 5·16 = 80 on the equator; Euler's formula V − E + F = 1 for a disc, 2 for a sphere.
    assert_eq!((half.n_vertices(), half.rims[0].len()), (1321, 80));
    assert_eq!((whole.n_vertices(), inner.n_vertices()), (2562, 162));
    assert_eq!(half.n_vertices() + half.triangles.len(), half.edges.len() + 1);
    assert_eq!(whole.n_vertices() + whole.triangles.len(), whole.edges.len() + 2);
    assert_eq!(half.hinges.len() + half.rims[0].len(), half.edges.len());
    for (v, position) in half.positions.iter().enumerate() {
        // Oracle: construction. The rim lies exactly in the plane, all other vertices strictly below.
        assert!(if half.is_on_rim[v] { position.z.to_bits() == 0 } else { position.z < 0.0 });
        // Oracle: construction. Tolerance: rounding of a normalized vector.
        assert!((position.norm() - 0.04).abs() < 1e-16, "vertex {v} is not on the sphere");
    }
    let edge_mean =
        half.edges.iter().map(|e| length(&half, e)).sum::<Real>() / half.edges.len() as Real;
    // Oracle: section 4 gives 3.0 mm.
    assert!((edge_mean - 3.0e-3).abs() < 0.05e-3, "mean edge {edge_mean}");
}

fn length(mesh: &Mesh, edge: &[u32; 2]) -> Real {
    (mesh.positions[edge[0] as usize] - mesh.positions[edge[1] as usize]).norm()
}

#[test]
fn normals_point_outward_and_the_rim_is_right_handed() {
    let mesh = Mesh::half_icosphere(0.04, 8).unwrap();
    for triangle in &mesh.triangles {
        let center: Vec3 = triangle.iter().map(|&v| mesh.positions[v as usize]).sum();
        // Oracle: on a sphere around the origin, outward normals have the direction of the position.
        assert!(area_normal(&mesh.positions, triangle).dot(&center) > 0.0);
    }
    let lid = pressure::lid_area_vector(&mesh.rims[0], &mesh.positions);
    // Oracle: the area of the nearly regular polygon of the rim, little less than that of the circle.
    assert!(lid.z > 0.99 * std::f64::consts::PI * 0.04 * 0.04 * 0.99 && lid.xy().norm() < 1e-15);
    for k in 0..mesh.rims[0].len() {
        let (a, b) = (mesh.rims[0][k], mesh.rims[0][(k + 1) % mesh.rims[0].len()]);
        let is_edge = |e: &[u32; 2]| *e == [a, b] || *e == [b, a];
        assert!(
            mesh.edges[mesh.hinges.len()..].iter().any(is_edge),
            "{a}-{b} is not a boundary edge"
        );
    }
}

#[test]
fn connectivity_is_consistent() {
    let mesh = Mesh::half_icosphere(1.0, 4).unwrap();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            let edge = mesh.edges[mesh.edges_of_triangle[t][k] as usize];
            // Oracle: definition of edge k of a triangle and of the triangle across it.
            assert!(edge == [a, b] || edge == [b, a]);
            let across = mesh.neighbors_of_triangle[t][k];
            if across != NONE {
                let other = mesh.triangles[across as usize];
                assert!(other.contains(&a) && other.contains(&b) && across as usize != t);
            }
        }
    }
    for hinge in &mesh.hinges {
        let [r1, r2, r3, r4] = hinge.vertices;
        let is_rotation_of = |t: u32, expected: [u32; 3]| {
            let found = mesh.triangles[t as usize];
            (0..3).any(|s| [found[s], found[(s + 1) % 3], found[(s + 2) % 3]] == expected)
        };
        // Oracle: the figure at the top of mesh.rs, which defines the signs of eqs. 17, 18.
        assert!(is_rotation_of(hinge.triangles[0], [r1, r3, r4]));
        assert!(is_rotation_of(hinge.triangles[1], [r2, r4, r3]));
    }
}

#[test]
fn invalid_triangles_are_rejected() {
    let square = || vec![Vec3::zeros(), Vec3::x(), Vec3::new(1.0, 1.0, 0.0), Vec3::y()];
    let error = |triangles: Vec<[u32; 3]>| Mesh::new(square(), triangles).unwrap_err();
    // Oracle: the one error of each list.
    assert!(matches!(error(vec![[0, 1, 4]]), MeshError::NoSuchVertex { vertex: 4, .. }));
    assert!(matches!(error(vec![[0, 1, 1]]), MeshError::NoArea { triangle: 0 }));
    assert!(matches!(error(vec![[0, 1, 2]]), MeshError::Unused { vertex: 3 }));
    let flipped = error(vec![[0, 1, 2], [0, 3, 2]]);
    assert!(matches!(flipped, MeshError::Orientation { from: 0, to: 2, .. }), "{flipped}");
    let fan = error(vec![[0, 1, 2], [0, 2, 3], [0, 2, 1]]);
    assert!(matches!(fan, MeshError::Branching { count: 3, .. } | MeshError::Orientation { .. }));
    assert!(matches!(Mesh::half_icosphere(1.0, 3), Err(MeshError::Frequency { frequency: 3 })));
}
