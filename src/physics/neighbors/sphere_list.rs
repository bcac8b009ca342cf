//! Sorted list of the vertex spheres of the membrane that a grain may touch, with the springs of contacts that were
//! listed before.

use super::{
    cell_grid::{CellGrid, id},
    verlet_list::kept_springs,
};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{Model, State, scratch::Neighbors, state::ListedSprings},
};

/// Number of vertices in one parallel task.
const CHUNK: usize = 128;

/// Lists all spheres of `radius` (m) within contact plus skin of a grain. Springs of contacts that were listed
/// before are kept.
pub(super) fn build(
    model: &Model,
    radius: Real,
    grid: &CellGrid,
    state: &mut State,
    lists: &mut Neighbors,
) {
    let n_vertices = state.membrane.positions.len();
    let beyond = radius + lists.skin;
    let mut chunks = vec![Vec::new(); n_vertices.div_ceil(CHUNK)];
    parallel::for_each(&mut chunks, |chunk, found| {
        for v in chunk * CHUNK..n_vertices.min((chunk + 1) * CHUNK) {
            grains_near(model, beyond, grid, state, v, found);
        }
    });
    let mut ids = chunks.concat();
    ids.sort_unstable();
    let mut starts = vec![0_u32; state.grains.len() + 1];
    for [grain, _] in &ids {
        starts[*grain as usize + 1] += 1;
    }
    for i in 0..state.grains.len() {
        starts[i + 1] += starts[i];
    }
    lists.sphere_starts = starts;
    let before = &state.springs.spheres;
    let springs = kept_springs(&before.ids, &before.springs, &ids);
    state.springs.spheres = ListedSprings { ids, springs, memories: Vec::new() };
}

/// Empties the list.
pub(super) fn clear(state: &mut State, lists: &mut Neighbors) {
    state.springs.spheres = ListedSprings::default();
    lists.sphere_starts = vec![0; state.grains.len() + 1];
}

fn grains_near(
    model: &Model,
    beyond: Real,
    grid: &CellGrid,
    state: &State,
    vertex: usize,
    found: &mut Vec<[u32; 2]>,
) {
    let position = state.membrane.positions[vertex];
    let reach = Vec3::repeat(model.radius_max + beyond);
    grid.visit(&(position - reach), &(position + reach), |grain| {
        let i = grain as usize;
        let cut = state.grains.radii[i] + beyond;
        if (state.grains.positions[i] - position).norm_squared() < cut * cut {
            found.push([grain, id(vertex)]);
        }
    });
}
