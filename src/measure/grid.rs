//! A regular grid of cells in an oriented box, on which fields are measured.
//!
//! Cells are numbered with x fastest: `index = (z n_y + y) n_x + x`.

use crate::base::{Pose, Real, Vec3, real::real};

/// Equal hexahedral cells that fill an oriented box.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    frame: Pose,
    cell_size: Vec3,
    counts: [usize; 3],
}

/// Why a grid is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// There is no cell along an axis.
    #[error("the grid has {0:?} cells; it needs at least one along each axis")]
    NoCells([usize; 3]),
    /// A cell has no volume.
    #[error("the cells measure {0:?} m; each edge must be finite and positive")]
    NoVolume([Real; 3]),
}

impl Grid {
    /// `counts` cells with edges `cell_size` (m). The lowest corner is the origin of `frame`, and the
    /// edges run along its axes.
    ///
    /// # Errors
    /// If there is no cell, or if an edge is not finite and positive.
    pub fn new(frame: Pose, cell_size: Vec3, counts: [usize; 3]) -> Result<Self, GridError> {
        if counts.contains(&0) {
            return Err(GridError::NoCells(counts));
        }
        if cell_size.iter().any(|edge| !edge.is_finite() || *edge <= 0.0) {
            return Err(GridError::NoVolume(cell_size.into()));
        }
        Ok(Self { frame, cell_size, counts })
    }

    /// `counts` cells that divide the box from `low` to `high` (m), world axes.
    ///
    /// # Errors
    /// If there is no cell, or if the box has no volume.
    pub fn aligned(low: &Vec3, high: &Vec3, counts: [usize; 3]) -> Result<Self, GridError> {
        let divisors = Vec3::from(counts.map(|n| real(n.max(1))));
        let frame = Pose::translation(low.x, low.y, low.z);
        Self::new(frame, (high - low).component_div(&divisors), counts)
    }

    /// Cells along each axis.
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// Edges of a cell (m).
    pub fn cell_size(&self) -> Vec3 {
        self.cell_size
    }

    /// Pose of the lowest corner and of the axes.
    pub fn frame(&self) -> &Pose {
        &self.frame
    }

    /// Number of cells.
    pub fn n_cells(&self) -> usize {
        self.counts.iter().product()
    }

    /// Volume of a cell (m³).
    pub fn cell_volume(&self) -> Real {
        self.cell_size.product()
    }

    /// Index of the cell with these indices along the axes.
    pub fn index(&self, indices: [usize; 3]) -> usize {
        (indices[2] * self.counts[1] + indices[1]) * self.counts[0] + indices[0]
    }

    /// Indices along the axes of cell `index`.
    pub fn indices(&self, index: usize) -> [usize; 3] {
        let [n_x, n_y, _] = self.counts;
        [index % n_x, index / n_x % n_y, index / (n_x * n_y)]
    }

    /// Center of cell `index`, world frame (m).
    pub fn center(&self, index: usize) -> Vec3 {
        let indices = self.indices(index).map(|k| real(k) + 0.5);
        self.to_world(&Vec3::from(indices).component_mul(&self.cell_size))
    }

    /// The cell that contains `point`, world frame (m); `None` outside the grid.
    pub fn cell_at(&self, point: &Vec3) -> Option<usize> {
        let steps = self.to_local(point).component_div(&self.cell_size);
        let mut indices = [0; 3];
        for axis in 0..3 {
            if !(0.0..real(self.counts[axis])).contains(&steps[axis]) {
                return None;
            }
            indices[axis] = index_of(steps[axis]).min(self.counts[axis] - 1);
        }
        Some(self.index(indices))
    }

    /// Lowest and highest corner of the cell with these indices along the axes, grid frame (m).
    pub fn corners(&self, indices: [usize; 3]) -> [Vec3; 2] {
        let corner = |step: usize| {
            Vec3::from(indices.map(|k| real(k + step))).component_mul(&self.cell_size)
        };
        [corner(0), corner(1)]
    }

    /// Edge lengths of the grid (m).
    pub fn extent(&self) -> Vec3 {
        Vec3::from(self.counts.map(real)).component_mul(&self.cell_size)
    }

    /// `point` of the world frame in the grid frame (m).
    pub fn to_local(&self, point: &Vec3) -> Vec3 {
        self.frame.inverse_transform_point(&(*point).into()).coords
    }

    /// `point` of the grid frame in the world frame (m).
    pub fn to_world(&self, point: &Vec3) -> Vec3 {
        self.frame.transform_point(&(*point).into()).coords
    }

    /// Cells along `axis` that the interval from `low` to `high` (m), grid frame, can touch.
    pub(super) fn span(&self, axis: usize, low: Real, high: Real) -> std::ops::Range<usize> {
        let (edge, n) = (self.cell_size[axis], self.counts[axis]);
        if high < 0.0 || real(n) * edge < low {
            return 0..0;
        }
        index_of(low / edge)..(index_of(high / edge) + 1).min(n)
    }
}

/// A real as an index: negative values and NaN give 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, as intended"
)]
pub(super) fn index_of(value: Real) -> usize {
    value as usize
}

/// The translations (m) by integer multiples of the period that bring a copy of the interval from
/// `low` to `high` (m) into the interval from 0 to `extent` (m).
fn shifts_along(low: Real, high: Real, extent: Real, period: Real) -> Vec<Real> {
    let first = (-high / period).ceil();
    let n = ((extent - low) / period).floor() - first + 1.0;
    (0..index_of(n.max(0.0))).map(|k| (first + real(k)) * period).collect()
}

/// The translations (m), world axes, of the periodic images of a box, from `low` to `high` (m), that
/// can touch the world box from `from` to `to` (m). Without a period: none but zero.
pub(super) fn images(
    [low, high]: [Vec3; 2],
    [from, to]: [Vec3; 2],
    period: Option<&Vec3>,
) -> Vec<Vec3> {
    let Some(period) = period else { return vec![Vec3::zeros()] };
    let [x, y, z] = [0, 1, 2]
        .map(|k| shifts_along(low[k] - from[k], high[k] - from[k], to[k] - from[k], period[k]));
    let mut images = Vec::with_capacity(x.len() * y.len() * z.len());
    for &z in &z {
        for &y in &y {
            images.extend(x.iter().map(|&x| Vec3::new(x, y, z)));
        }
    }
    images
}

/// Lowest and highest corner of the axis-aligned box around `grid`, world frame (m).
pub(super) fn bounds(grid: &Grid) -> [Vec3; 2] {
    let extent = grid.extent();
    let mut bounds = [Vec3::repeat(Real::INFINITY), Vec3::repeat(Real::NEG_INFINITY)];
    for corner in 0..8_u32 {
        let local =
            Vec3::from_fn(|axis, _| if corner >> axis & 1 == 1 { extent[axis] } else { 0.0 });
        let corner = grid.to_world(&local);
        bounds = [bounds[0].inf(&corner), bounds[1].sup(&corner)];
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Quat;

    #[test]
    fn index_place_and_position_belong_together() {
        let frame = Pose::from_parts(
            Vec3::new(1.0, -2.0, 0.5).into(),
            Quat::from_euler_angles(0.3, -0.7, 1.1),
        );
        let grid = Grid::new(frame, Vec3::new(0.1, 0.2, 0.3), [4, 3, 5]).unwrap();
        for index in 0..grid.n_cells() {
            assert_eq!(grid.index(grid.indices(index)), index);
            assert_eq!(grid.cell_at(&grid.center(index)), Some(index));
        }
        assert_eq!(grid.cell_at(&grid.to_world(&Vec3::new(-0.01, 0.1, 0.1))), None);
        assert_eq!(grid.cell_at(&grid.to_world(&Vec3::new(0.41, 0.1, 0.1))), None);
        assert!((grid.cell_volume() - 0.006).abs() < 1e-17);
    }

    #[test]
    fn a_grid_without_cells_or_volume_is_an_error() {
        let low = Vec3::zeros();
        assert_eq!(
            Grid::aligned(&low, &Vec3::repeat(1.0), [1, 0, 2]),
            Err(GridError::NoCells([1, 0, 2]))
        );
        let flat = Vec3::new(1.0, 0.0, 1.0);
        assert!(matches!(Grid::aligned(&low, &flat, [1, 1, 1]), Err(GridError::NoVolume(_))));
    }

    /// Oracle: by hand. A sphere at the corner of a periodic box has eight images there.
    #[test]
    fn images_are_those_that_touch_the_box() {
        let period = Vec3::repeat(1.0);
        let at = |center: Real| {
            let corners = [Vec3::repeat(center - 0.1), Vec3::repeat(center + 0.1)];
            images(corners, [Vec3::zeros(), period], Some(&period)).len()
        };
        assert_eq!((at(0.05), at(0.5), at(7.5), at(-3.98)), (8, 1, 1, 8));
    }
}
