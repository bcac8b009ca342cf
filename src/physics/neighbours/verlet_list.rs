//! Pairs of grains that may touch, sorted, with the springs of the pairs that go on.

use super::cell_grid::{CellGrid, id};
use crate::{
    base::{Vec3, parallel},
    physics::{Model, State, scratch::Neighbours, state::Grains},
};

/// Grains whose partners one thread looks up at a time.
const CHUNK: usize = 128;

/// Lists all pairs closer than contact plus skin; springs of pairs listed before are kept.
pub(super) fn build(model: &Model, grid: &CellGrid, state: &mut State, lists: &mut Neighbours) {
    let grains = &state.grains;
    let mut chunks = vec![Vec::new(); grains.len().div_ceil(CHUNK)];
    parallel::for_each(&mut chunks, |chunk, found| {
        for i in chunk * CHUNK..grains.len().min((chunk + 1) * CHUNK) {
            partners(model, grid, grains, i, found);
        }
    });
    let ids = chunks.concat();
    let springs = carry_springs(&state.pair_ids, &state.springs.pairs, &ids);
    index_by_grain(&ids, grains.len(), lists);
    state.pair_ids = ids;
    state.springs.pairs = springs;
}

/// Partners of grain `i` with higher ids, ascending.
fn partners(model: &Model, grid: &CellGrid, grains: &Grains, i: usize, found: &mut Vec<[u32; 2]>) {
    let (position, radius) = (grains.positions[i], grains.radii[i]);
    let reach = Vec3::repeat(radius + model.radius_max + model.skin);
    let begin = found.len();
    grid.visit(&(position - reach), &(position + reach), |other| {
        let j = other as usize;
        if j <= i {
            return;
        }
        let cut = radius + grains.radii[j] + model.skin;
        if (grains.positions[j] - position).norm_squared() < cut * cut {
            found.push([id(i), other]);
        }
    });
    found[begin..].sort_unstable();
}

/// Springs for the new list: both lists are sorted, so one walk over both finds them.
pub(super) fn carry_springs(old_ids: &[[u32; 2]], old: &[Vec3], ids: &[[u32; 2]]) -> Vec<Vec3> {
    let mut k = 0;
    ids.iter()
        .map(|pair| {
            while k < old_ids.len() && old_ids[k] < *pair {
                k += 1;
            }
            if k < old_ids.len() && old_ids[k] == *pair { old[k] } else { Vec3::zeros() }
        })
        .collect()
}

/// For each grain: its pairs as first, which are contiguous, and as second.
fn index_by_grain(ids: &[[u32; 2]], n_grains: usize, lists: &mut Neighbours) {
    let mut starts = [vec![0_u32; n_grains + 1], vec![0_u32; n_grains + 1]];
    for pair in ids {
        for side in 0..2 {
            starts[side][pair[side] as usize + 1] += 1;
        }
    }
    for side in &mut starts {
        for i in 0..n_grains {
            side[i + 1] += side[i];
        }
    }
    let [first_starts, second_starts] = starts;
    let mut next = second_starts.clone();
    lists.second_pairs = vec![0; ids.len()];
    for (k, pair) in ids.iter().enumerate() {
        let slot = &mut next[pair[1] as usize];
        lists.second_pairs[*slot as usize] = id(k);
        *slot += 1;
    }
    lists.first_starts = first_starts;
    lists.second_starts = second_starts;
}
