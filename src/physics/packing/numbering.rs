//! Numbers grains so that those close in space are close in memory.
//!
//! Grains are numbered along a Z-order curve through cubic cells. The data of the grains of nearby pairs then
//! lies in few cache lines, however large the packing. Grains that move away later only cost time.

use crate::base::{Real, Vec3, real::to_index};

/// Number of cells along each axis that the curve resolves.
const N_CELLS: Real = 1024.0;

/// Indices of `positions` (m) in their order along the curve, with cells of width `cell` (m).
pub fn along_curve(positions: &[Vec3], cell: Real) -> Vec<usize> {
    let low = positions.iter().fold(Vec3::repeat(Real::INFINITY), |low, it| low.inf(it));
    let code = |position: &Vec3| {
        let cells = (position - low).map(|x| to_index((x / cell).clamp(0.0, N_CELLS - 1.0)));
        interleaved(cells.x) | interleaved(cells.y) << 1 | interleaved(cells.z) << 2
    };
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by_cached_key(|&i| code(&positions[i]));
    order
}

/// Spreads the lowest ten bits, with two zeros between adjacent bits.
fn interleaved(number: usize) -> usize {
    (0..10).fold(0, |code, bit| code | (number >> bit & 1) << (3 * bit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::{Random, Stream};

    #[test]
    fn the_curve_visits_each_grain_once_and_keeps_close_ones_together() {
        let mut random = Random::new(8, Stream::Position);
        let positions: Vec<Vec3> =
            (0..4096).map(|_| Vec3::from_fn(|_, _| random.between(0.0, 16.0))).collect();
        let order = along_curve(&positions, 1.0);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        // Oracle: a permutation.
        assert!(sorted.into_iter().eq(0..4096));
        let step = |order: &[usize]| {
            order.windows(2).map(|it| (positions[it[0]] - positions[it[1]]).norm()).sum::<Real>()
        };
        // Oracle: the mean distance of two random points is 0.66 · 16 in the box and 0.66 in a cell. The
        // curve enters another cell at about every grain and jumps occasionally. A quarter is far from
        // both.
        let (random_order, curve): (Vec<usize>, _) = ((0..4096).collect(), step(&order));
        assert!(curve < 0.25 * step(&random_order), "{curve}");
    }

    #[test]
    fn bits_are_spread() {
        // Oracle: by hand.
        assert_eq!(interleaved(0b1011), 0b001_000_001_001);
    }
}
