//! A grid of cells that contain the grains, filled by counting sort.

use crate::base::{Real, Vec3};

/// Grains sorted into cubic cells.
pub(crate) struct CellGrid {
    low: Vec3,
    cell: Real,
    n_cells: [usize; 3],
    /// Grains of cell `c` are at `starts[c] .. starts[c + 1]` in `grains`.
    starts: Vec<u32>,
    /// Ids of grains, cell by cell; ascending in each cell.
    grains: Vec<u32>,
}

/// Largest number of cells along each axis; more would only cost memory.
const N_CELLS_MAX: Real = 128.0;

impl CellGrid {
    /// Sorts `positions` (m) into cells of at least the width `cell` (m).
    pub(crate) fn new(positions: &[Vec3], cell: Real) -> Self {
        let mut low = Vec3::repeat(Real::INFINITY);
        let mut high = Vec3::repeat(Real::NEG_INFINITY);
        for position in positions {
            low = low.inf(position);
            high = high.sup(position);
        }
        if positions.is_empty() {
            (low, high) = (Vec3::zeros(), Vec3::zeros());
        }
        let cell = cell.max((high - low).max() / N_CELLS_MAX);
        let n_cells = [0, 1, 2].map(|axis| index((high[axis] - low[axis]) / cell) + 1);
        let mut grid = Self { low, cell, n_cells, starts: Vec::new(), grains: Vec::new() };
        grid.sort(positions);
        grid
    }

    fn sort(&mut self, positions: &[Vec3]) {
        let n = self.n_cells.iter().product::<usize>();
        let cells: Vec<usize> =
            positions.iter().map(|position| self.flat(self.cell_of(position))).collect();
        self.starts = vec![0; n + 1];
        for &cell in &cells {
            self.starts[cell + 1] += 1;
        }
        for cell in 0..n {
            self.starts[cell + 1] += self.starts[cell];
        }
        let mut next = self.starts.clone();
        self.grains = vec![0; positions.len()];
        for (grain, &cell) in cells.iter().enumerate() {
            self.grains[next[cell] as usize] = id(grain);
            next[cell] += 1;
        }
    }

    fn cell_of(&self, position: &Vec3) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            index((position[axis] - self.low[axis]) / self.cell).min(self.n_cells[axis] - 1)
        })
    }

    fn flat(&self, cell: [usize; 3]) -> usize {
        (cell[2] * self.n_cells[1] + cell[1]) * self.n_cells[0] + cell[0]
    }

    /// Calls `visit` with every grain in the cells that the box from `low` to `high` (m) overlaps.
    pub(crate) fn visit(&self, low: &Vec3, high: &Vec3, mut visit: impl FnMut(u32)) {
        // A box outside the grid is clamped to the outer cells. This only costs time.
        let (from, to) = (self.cell_of(low), self.cell_of(high));
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                let row = self.flat([0, y, z]);
                let range = self.starts[row + from[0]]..self.starts[row + to[0] + 1];
                for &grain in &self.grains[range.start as usize..range.end as usize] {
                    visit(grain);
                }
            }
        }
    }
}

/// A non-negative real as an index; negative values and NaN give 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, as intended"
)]
fn index(value: Real) -> usize {
    value as usize
}

/// An index as the 32-bit id that lists store.
#[expect(clippy::cast_possible_truncation, reason = "scenes have far fewer than 2^32 grains")]
pub(crate) fn id(index: usize) -> u32 {
    index as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::{Random, Stream};

    #[test]
    fn every_grain_in_the_box_is_visited() {
        // Oracle: brute force over all grains.
        let mut random = Random::new(3, Stream::Position);
        let mut point = || Vec3::from_fn(|_, _| random.between(-1.0, 1.0));
        let positions: Vec<Vec3> = (0..500).map(|_| point()).collect();
        let grid = CellGrid::new(&positions, 0.17);
        for _ in 0..50 {
            let (a, b) = (point() * 1.5, point() * 1.5);
            let (low, high) = (a.inf(&b), a.sup(&b));
            let mut visited = vec![false; positions.len()];
            grid.visit(&low, &high, |grain| visited[grain as usize] = true);
            for (grain, position) in positions.iter().enumerate() {
                let inside = (0..3).all(|k| low[k] <= position[k] && position[k] <= high[k]);
                assert!(!inside || visited[grain], "grain {grain} was not visited");
            }
        }
    }
}
