//! Detects grains whose center has crossed the membrane.
//!
//! The check runs at every build of the lists, for grains whose center is closer to the membrane than the skin.
//! Between two builds grain and membrane together move by less than the skin, so no grain can cross the membrane
//! undetected. The sign of the distance to the closest point follows from the normal of
//! the face, the mean normal at an edge, or the angle-weighted mean normal at a vertex (Bærentzen & Aanæs 2005),
//! which is exact for every closed surface. Grains next to a rim are not checked.

use std::collections::BTreeMap;

use super::cell_grid::CellGrid;
use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Model, State,
        membrane::{
            contact_geometry::{Feature, closest_on_triangle},
            mesh::{NONE, area_normal},
        },
    },
};

/// Number of triangles in one parallel task.
const CHUNK: usize = 128;

/// A grain near the membrane.
struct Near {
    grain: u32,
    distance_squared: Real,
    is_outside: bool,
}

/// The first grain whose center is on the outer side of the membrane.
pub(super) fn first(model: &Model, grid: &CellGrid, state: &State) -> Option<usize> {
    let n_triangles = model.membrane.mesh.triangles.len();
    let mut chunks: Vec<Vec<Near>> = Vec::new();
    chunks.resize_with(n_triangles.div_ceil(CHUNK), Vec::new);
    parallel::for_each(&mut chunks, |chunk, found| {
        for t in chunk * CHUNK..n_triangles.min((chunk + 1) * CHUNK) {
            near_triangle(model, grid, state, t, found);
        }
    });
    let mut nearest = BTreeMap::<u32, &Near>::new();
    for near in chunks.iter().flatten() {
        let best = nearest.entry(near.grain).or_insert(near);
        if near.distance_squared < best.distance_squared {
            *best = near;
        }
    }
    nearest.values().find(|near| near.is_outside).map(|near| near.grain as usize)
}

fn near_triangle(
    model: &Model,
    grid: &CellGrid,
    state: &State,
    triangle: usize,
    found: &mut Vec<Near>,
) {
    let corners = model.membrane.mesh.triangles[triangle]
        .map(|vertex| &state.membrane.positions[vertex as usize]);
    let reach = Vec3::repeat(model.skin);
    let low = corners[0].inf(corners[1]).inf(corners[2]) - reach;
    let high = corners[0].sup(corners[1]).sup(corners[2]) + reach;
    grid.visit(&low, &high, |grain| {
        let position = &state.grains.positions[grain as usize];
        let is_in_box = (0..3).all(|k| low[k] <= position[k] && position[k] <= high[k]);
        if !is_in_box {
            return;
        }
        let closest = closest_on_triangle(position, corners);
        let from_membrane = position - closest.point;
        let distance_squared = from_membrane.norm_squared();
        if distance_squared < model.skin * model.skin {
            let normal = outward(model, &state.membrane.positions, triangle, closest.feature);
            let is_outside = normal.is_some_and(|normal| normal.dot(&from_membrane) > 0.0);
            found.push(Near { grain, distance_squared, is_outside });
        }
    });
}

/// A normal whose sign decides on which side of the feature a grain is; `None` on a rim.
fn outward(model: &Model, positions: &[Vec3], triangle: usize, feature: Feature) -> Option<Vec3> {
    let mesh = &model.membrane.mesh;
    let unit = |t: u32| area_normal(positions, &mesh.triangles[t as usize]).normalize();
    match feature {
        Feature::Face => Some(area_normal(positions, &mesh.triangles[triangle])),
        Feature::Edge(k) => {
            let edge = mesh.edges_of_triangle[triangle][usize::from(k)];
            let sides = mesh.triangles_of_edge[edge as usize];
            (!sides.contains(&NONE)).then(|| unit(sides[0]) + unit(sides[1]))
        }
        Feature::Vertex(k) => {
            let vertex = mesh.triangles[triangle][usize::from(k)];
            let weighted = |sum: Vec3, &t: &u32| {
                sum + unit(t) * angle_at(vertex, positions, &mesh.triangles[t as usize])
            };
            let around = mesh.triangles_of_vertex.of(vertex as usize);
            (!mesh.is_on_rim[vertex as usize]).then(|| around.iter().fold(Vec3::zeros(), weighted))
        }
    }
}

/// Angle of a triangle at one of its vertices (rad).
fn angle_at(vertex: u32, positions: &[Vec3], triangle: &[u32; 3]) -> Real {
    let at = |id: u32| positions[id as usize];
    let sides: Vec<Vec3> =
        triangle.iter().filter(|&&it| it != vertex).map(|&it| at(it) - at(vertex)).collect();
    sides[0].angle(&sides[1])
}
