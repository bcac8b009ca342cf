//! Pairs of grains that may touch, sorted, with the springs of the pairs that go on.

use super::cell_grid::{CellGrid, id};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{Model, State, scratch::Neighbours},
};

/// Grains whose partners one thread looks up at a time.
const CHUNK: usize = 128;

/// The images of `positions` in the box from the origin to `period`.
pub(super) fn wrap(positions: &[Vec3], period: &Vec3) -> Vec<Vec3> {
    let into_box = |p: &Vec3| p - p.component_div(period).map(f64::floor).component_mul(period);
    positions.iter().map(into_box).collect()
}

/// Lists all pairs closer than contact plus skin; springs of pairs listed before are kept. The grains
/// are at `positions`, which are those of `grid`.
pub(super) fn build(
    model: &Model,
    grid: &CellGrid,
    positions: &[Vec3],
    state: &mut State,
    lists: &mut Neighbours,
) {
    let radii = &state.grains.radii;
    let search = Search { model, skin: lists.skin, grid, positions, radii };
    let mut chunks = vec![Vec::new(); radii.len().div_ceil(CHUNK)];
    parallel::for_each(&mut chunks, |chunk, found| {
        for i in chunk * CHUNK..radii.len().min((chunk + 1) * CHUNK) {
            search.partners(i, found);
        }
    });
    let ids = chunks.concat();
    let springs = carry_springs(&state.pair_ids, &state.springs.pairs, &ids);
    index_by_grain(&ids, radii.len(), lists);
    state.pair_ids = ids;
    state.springs.pairs = springs;
}

/// All that is needed to look for partners.
struct Search<'a> {
    model: &'a Model,
    /// Distance beyond contact [m].
    skin: Real,
    grid: &'a CellGrid,
    positions: &'a [Vec3],
    radii: &'a [Real],
}

impl Search<'_> {
    /// Partners of grain `i` with higher ids, ascending.
    fn partners(&self, i: usize, found: &mut Vec<[u32; 2]>) {
        let begin = found.len();
        let position = self.positions[i];
        match &self.model.period {
            None => self.around(i, &position, found),
            Some(period) => self.around_images(i, &position, period, found),
        }
        found[begin..].sort_unstable();
    }

    /// Those near `position`, where grain `i` or an image of it is.
    fn around(&self, i: usize, position: &Vec3, found: &mut Vec<[u32; 2]>) {
        let (model, radius) = (self.model, self.radii[i]);
        let reach = Vec3::repeat(radius + model.radius_max + self.skin);
        self.grid.visit(&(position - reach), &(position + reach), |other| {
            let j = other as usize;
            if j <= i {
                return;
            }
            let cut = radius + self.radii[j] + self.skin;
            if (self.positions[j] - position).norm_squared() < cut * cut {
                found.push([id(i), other]);
            }
        });
    }

    /// Those near the images of grain `i` that reach into the box. No partner is near two of them,
    /// since the box is wide enough.
    fn around_images(&self, i: usize, position: &Vec3, period: &Vec3, found: &mut Vec<[u32; 2]>) {
        let reach = self.radii[i] + self.model.radius_max + self.skin;
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
