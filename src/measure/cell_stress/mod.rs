//! Stress in each cell of a grid: each contact is divided among the cells that its branch crosses.
//!
//! ```text
//! σ_a = 1/V_a Σ_c f_c ⊗ l_c s_ca
//!
//! f_c   force of contact c on a grain             (N)
//! l_c   branch vector, to that grain's center     (m)
//! s_ca  fraction of the branch's length in cell a
//! V_a   volume of cell a                          (m³)
//! ```
//!
//! Pressure is positive. The cells' σ_a V_a sum to the V σ of `super::stress::contact_stress` if the grid
//! covers all branches. The kinetic part m v'⊗v' is not included.
//!
//! Source: Weber (1966); the division along the branch: Goldhirsch, Granular Matter 12 (2010) 239, with the
//! indicator function of the cell as coarse-graining function.

use super::{
    grid::{Grid, bounds, images, index_of},
    stress::Branch,
};
use crate::base::{Mat3, Real, Vec3, real::real};

/// Stress (Pa), world axes, in each cell of `grid`; `None` in a cell that no branch crosses. In a box
/// that repeats with `period` (m) along the world axes, all images count. A branch within the face
/// between two cells is assigned to one of them.
pub fn cell_stress(grid: &Grid, branches: &[Branch], period: Option<&Vec3>) -> Vec<Option<Mat3>> {
    let world = bounds(grid);
    let mut stress = vec![None; grid.n_cells()];
    for Branch { end, branch, force } in branches {
        let start = end - branch;
        let moment = force * branch.transpose() / grid.cell_volume();
        for shift in images([start.inf(end), start.sup(end)], world, period) {
            let ends = [start + shift, end + shift].map(|it| grid.to_local(&it));
            each_share(grid, &ends, |cell, share| {
                *stress[cell].get_or_insert(Mat3::zeros()) += moment * share;
            });
        }
    }
    stress
}

/// Calls `visit` with each cell that the segment between `ends` (m), grid frame, crosses, and the
/// fraction of its length in that cell.
fn each_share(grid: &Grid, ends: &[Vec3; 2], mut visit: impl FnMut(usize, Real)) {
    let [from, to] = ends.map(|it| it.component_div(&grid.cell_size()));
    let along = to - from;
    // Positions at which the segment enters a cell, as fractions of its length.
    let mut cuts = vec![0.0, 1.0];
    for axis in 0..3 {
        let (low, high) = (from[axis].min(to[axis]), from[axis].max(to[axis]));
        let mut plane = low.ceil().max(0.0);
        let last = high.min(real(grid.counts()[axis]));
        while plane <= last && 0.0 < high - low {
            cuts.push(((plane - from[axis]) / along[axis]).clamp(0.0, 1.0));
            plane += 1.0;
        }
    }
    cuts.sort_by(Real::total_cmp);
    for pair in cuts.windows(2) {
        let share = pair[1] - pair[0];
        let middle = from + along * (0.5 * (pair[0] + pair[1]));
        let is_inside = (0..3).all(|axis| (0.0..real(grid.counts()[axis])).contains(&middle[axis]));
        if share > 0.0 && is_inside {
            visit(grid.index([0, 1, 2].map(|axis| index_of(middle[axis]))), share);
        }
    }
}

#[cfg(test)]
mod tests;
