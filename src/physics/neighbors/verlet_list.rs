//! Sorted list of the pairs of grains that may be in contact, with the history of pairs that were listed before.

use super::cell_grid::{CellGrid, id};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{Model, State, scratch::Neighbors},
};

/// Number of grains in one parallel task.
const CHUNK: usize = 128;

/// The images of `positions` in the box from the origin to `period`.
pub(super) fn wrap(positions: &[Vec3], period: &Vec3) -> Vec<Vec3> {
    let into_box = |p: &Vec3| p - p.component_div(period).map(f64::floor).component_mul(period);
    positions.iter().map(into_box).collect()
}

/// Lists all pairs within contact plus the range of their law plus the skin. The history of pairs that were listed
/// before is kept. `positions` (m) are those of the grains in `grid`.
pub(super) fn build(
    model: &Model,
    grid: &CellGrid,
    positions: &[Vec3],
    state: &mut State,
    lists: &mut Neighbors,
) {
    let radii = &state.grains.radii;
    let beyond = model.grain_law.range() + lists.skin;
    let search = Search { model, beyond, grid, positions, radii };
    let mut chunks = vec![Vec::new(); radii.len().div_ceil(CHUNK)];
    parallel::for_each(&mut chunks, |chunk, found| {
        for i in chunk * CHUNK..radii.len().min((chunk + 1) * CHUNK) {
            search.partners(i, found);
        }
    });
    let ids = chunks.concat();
    let springs = &mut state.springs;
    springs.pairs = kept_springs(&state.pair_ids, &springs.pairs, &ids);
    springs.pair_memories = kept_memories(&state.pair_ids, &springs.pair_memories, &ids);
    index_by_grain(&ids, radii.len(), lists);
    state.pair_ids = ids;
}

/// Search for the partners of grains.
struct Search<'a> {
    model: &'a Model,
    /// Distance beyond contact up to which pairs are listed (m).
    beyond: Real,
    grid: &'a CellGrid,
    positions: &'a [Vec3],
    radii: &'a [Real],
}

impl Search<'_> {
    /// Adds the pairs of grain `i` with partners of higher ids, ascending.
    fn partners(&self, i: usize, found: &mut Vec<[u32; 2]>) {
        let begin = found.len();
        let position = self.positions[i];
        match &self.model.period {
            None => self.around(i, &position, found),
            Some(period) => self.around_images(i, &position, period, found),
        }
        found[begin..].sort_unstable();
    }

    /// Adds partners near `position`, which is that of grain `i` or of one of its images.
    fn around(&self, i: usize, position: &Vec3, found: &mut Vec<[u32; 2]>) {
        let (model, radius) = (self.model, self.radii[i]);
        let reach = Vec3::repeat(radius + model.radius_max + self.beyond);
        self.grid.visit(&(position - reach), &(position + reach), |other| {
            let j = other as usize;
            if j <= i {
                return;
            }
            let cut = radius + self.radii[j] + self.beyond;
            if (self.positions[j] - position).norm_squared() < cut * cut {
                found.push([id(i), other]);
            }
        });
    }

    /// Adds partners near the images of grain `i` that reach into the box. No partner is near two of them, because
    /// the box is wide enough.
    fn around_images(&self, i: usize, position: &Vec3, period: &Vec3, found: &mut Vec<[u32; 2]>) {
        let reach = self.radii[i] + self.model.radius_max + self.beyond;
        let shifts = [0, 1, 2].map(|k| {
            let back = position[k] + reach > period[k];
            let ahead = position[k] < reach;
            [Some(0.0), back.then(|| -period[k]), ahead.then_some(period[k])]
        });
        for &x in shifts[0].iter().flatten() {
            for &y in shifts[1].iter().flatten() {
                for &z in shifts[2].iter().flatten() {
                    self.around(i, &(position + Vec3::new(x, y, z)), found);
                }
            }
        }
    }
}

/// Indices of the contacts `ids` in `old_ids`. Both lists are sorted, so one pass over both finds them.
fn old_indices(old_ids: &[[u32; 2]], ids: &[[u32; 2]]) -> impl Iterator<Item = Option<usize>> {
    let mut k = 0;
    ids.iter().map(move |pair| {
        while k < old_ids.len() && old_ids[k] < *pair {
            k += 1;
        }
        (k < old_ids.len() && old_ids[k] == *pair).then_some(k)
    })
}

/// Springs of the contacts `ids`, zero for new ones.
pub(super) fn kept_springs(old_ids: &[[u32; 2]], old: &[Vec3], ids: &[[u32; 2]]) -> Vec<Vec3> {
    old_indices(old_ids, ids).map(|k| k.map_or_else(Vec3::zeros, |k| old[k])).collect()
}

/// Other history of the contacts `ids`, zero for new ones.
pub(super) fn kept_memories(old_ids: &[[u32; 2]], old: &[Real], ids: &[[u32; 2]]) -> Vec<Real> {
    let width = old.len() / old_ids.len().max(1);
    let mut memories = vec![0.0; width * ids.len()];
    if width > 0 {
        for (memory, k) in memories.chunks_exact_mut(width).zip(old_indices(old_ids, ids)) {
            if let Some(k) = k {
                memory.copy_from_slice(&old[k * width..(k + 1) * width]);
            }
        }
    }
    memories
}

/// Indexes the pairs of each grain: as first grain, which are contiguous, and as second grain.
fn index_by_grain(ids: &[[u32; 2]], n_grains: usize, lists: &mut Neighbors) {
    lists.first_starts = starts(ids.iter().map(|pair| pair[0]), n_grains);
    (lists.second_starts, lists.second_pairs) = index_by_second(ids, n_grains);
}

/// Start of the entries of each grain in a list sorted by grain, and the end of the last ones.
fn starts(grains: impl Iterator<Item = u32>, n_grains: usize) -> Vec<u32> {
    let mut starts = vec![0_u32; n_grains + 1];
    for grain in grains {
        starts[grain as usize + 1] += 1;
    }
    for i in 0..n_grains {
        starts[i + 1] += starts[i];
    }
    starts
}

/// Sorts the contacts `ids` by their second id. Returns the start of the contacts of each grain, and their indices,
/// ascending for each grain.
pub(super) fn index_by_second(ids: &[[u32; 2]], n_grains: usize) -> (Vec<u32>, Vec<u32>) {
    let starts = starts(ids.iter().map(|pair| pair[1]), n_grains);
    let mut next = starts.clone();
    let mut indices = vec![0; ids.len()];
    for (k, pair) in ids.iter().enumerate() {
        let slot = &mut next[pair[1] as usize];
        indices[*slot as usize] = id(k);
        *slot += 1;
    }
    (starts, indices)
}
