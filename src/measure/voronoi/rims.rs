//! Closes open surfaces with lids, so that they bound a volume.

use std::collections::BTreeMap;

use crate::base::{Real, Vec3, real::real};

/// The vertices (m) and triangles of a surface with a lid on each rim: triangles from the rim to its
/// centroid, which is a new vertex. A closed surface is not changed. No vertex may be on two rims.
pub fn with_lids(positions: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut vertices, mut closed) = (positions.to_vec(), triangles.to_vec());
    let mut rim = rim_edges(triangles);
    while let Some((&first, _)) = rim.first_key_value() {
        let center = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
        let (mut sum, mut n, mut at) = (Vec3::zeros(), 0, first);
        while let Some(next) = rim.remove(&at) {
            // Opposite to the edge of the adjacent triangle.
            closed.push([next, at, center]);
            sum += positions[at as usize];
            n += 1;
            at = next;
        }
        let count: Real = real(n);
        vertices.push(sum / count);
    }
    (vertices, closed)
}

/// Edges with a triangle on one side only: from the first vertex to the second.
fn rim_edges(triangles: &[[u32; 3]]) -> BTreeMap<u32, u32> {
    let directed = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(directed).collect();
    edges.sort_unstable();
    let is_open = |[a, b]: &&[u32; 2]| edges.binary_search(&[*b, *a]).is_err();
    edges.iter().filter(is_open).map(|[a, b]| (*a, *b)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        measure::voronoi::Container,
        physics::membrane::{mesh::Mesh, pressure},
    };

    /// Oracle: the volume enclosed by the membrane for the pressure, which closes the rim in the same way.
    #[test]
    fn a_membrane_with_a_lid_has_its_volume() {
        let mesh = Mesh::half_icosphere(0.04, 6).unwrap();
        assert!(Container::surface(&mesh.positions, &mesh.triangles).is_err());
        let (vertices, triangles) = with_lids(&mesh.positions, &mesh.triangles);
        assert!(Container::surface(&vertices, &triangles).is_ok());
        let volume: Real = triangles
            .iter()
            .map(|t| t.map(|v| vertices[v as usize]))
            .map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0)
            .sum();
        let expected = pressure::volume(&mesh, &mesh.positions);
        assert!((volume / expected - 1.0).abs() < 1e-12, "{volume} {expected}");
        let (again, same) = with_lids(&vertices, &triangles);
        assert_eq!((again, same), (vertices, triangles));
    }
}
