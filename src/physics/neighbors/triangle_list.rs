//! Lists of the triangles of the membrane that a grain may touch.

use super::cell_grid::{CellGrid, id};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{Model, State, membrane::contact_geometry::closest_on_triangle, scratch::Neighbors},
};

/// Number of triangles in one parallel task.
const CHUNK: usize = 128;

/// Lists, for each grain, the triangles within contact plus skin, ascending.
pub(super) fn build(model: &Model, grid: &CellGrid, state: &State, lists: &mut Neighbors) {
    let triangles = &model.membrane.mesh.triangles;
    let skin = lists.skin;
    let mut chunks = vec![Vec::new(); triangles.len().div_ceil(CHUNK)];
    parallel::for_each(&mut chunks, |chunk, found| {
        for t in chunk * CHUNK..triangles.len().min((chunk + 1) * CHUNK) {
            grains_near(model, skin, grid, state, t, found);
        }
    });
    let n_grains = state.grains.len();
    let mut starts = vec![0_u32; n_grains + 1];
    for [grain, _] in chunks.iter().flatten() {
        starts[*grain as usize + 1] += 1;
    }
    for i in 0..n_grains {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    lists.triangles = vec![0; starts[n_grains] as usize];
    lists.candidate_grains = lists.triangles.clone();
    // The chunks are in the order of triangles, so the triangles of each grain are ascending.
    for [grain, triangle] in chunks.iter().flatten() {
        let slot = &mut next[*grain as usize];
        lists.triangles[*slot as usize] = *triangle;
        lists.candidate_grains[*slot as usize] = *grain;
        *slot += 1;
    }
    lists.membrane_grains = (0..n_grains).filter(|&i| starts[i] < starts[i + 1]).map(id).collect();
    lists.wake_at = vec![0.0; lists.triangles.len()];
    lists.travel = 0.0;
    lists.triangle_starts = starts;
}

/// Empties the lists.
pub(super) fn clear(state: &State, lists: &mut Neighbors) {
    lists.triangles.clear();
    lists.candidate_grains.clear();
    lists.membrane_grains.clear();
    lists.wake_at.clear();
    lists.triangle_starts = vec![0; state.grains.len() + 1];
}

fn grains_near(
    model: &Model,
    skin: Real,
    grid: &CellGrid,
    state: &State,
    triangle: usize,
    found: &mut Vec<[u32; 2]>,
) {
    let corners = model.membrane.mesh.triangles[triangle]
        .map(|vertex| &state.membrane.positions[vertex as usize]);
    let reach = Vec3::repeat(model.radius_max + skin);
    let low = corners[0].inf(corners[1]).inf(corners[2]) - reach;
    let high = corners[0].sup(corners[1]).sup(corners[2]) + reach;
    grid.visit(&low, &high, |grain| {
        let i = grain as usize;
        let cut = state.grains.radii[i] + skin;
        let closest = closest_on_triangle(&state.grains.positions[i], corners);
        if (closest.point - state.grains.positions[i]).norm_squared() < cut * cut {
            found.push([grain, id(triangle)]);
        }
    });
}
