//! Search for points near a position, including their periodic images.

use crate::{
    base::{Real, Vec3},
    physics::neighbors::cell_grid::CellGrid,
};

/// Points sorted into cells.
pub(super) struct PointSearch<'a> {
    cells: CellGrid,
    period: Option<&'a Vec3>,
    /// The points; those of a periodic box in `[0, period)`.
    wrapped: Vec<Vec3>,
}

impl<'a> PointSearch<'a> {
    /// Sorts `points` (m) into cells of about `cell` (m); the box repeats with `period` (m), if any.
    pub(super) fn new(points: &[Vec3], cell: Real, period: Option<&'a Vec3>) -> Self {
        let wrapped: Vec<Vec3> = match period {
            Some(period) => points.iter().map(|point| wrap(point, period)).collect(),
            None => points.to_vec(),
        };
        Self { cells: CellGrid::new(&wrapped, cell), period, wrapped }
    }

    /// Position of point `i` (m), wrapped into the periodic box if there is one.
    pub(super) fn at(&self, i: usize) -> Vec3 {
        self.wrapped[i]
    }

    /// Calls `visitor` with the index and the position (m) of every point or image in the cube of half
    /// edge `reach` (m) around `center`, which must be in the box, and of some others.
    pub(super) fn visit(&self, center: &Vec3, reach: Real, mut visitor: impl FnMut(usize, Vec3)) {
        let (low, high) = (center.add_scalar(-reach), center.add_scalar(reach));
        let world = self.period.map_or([low, high], |period| [Vec3::zeros(), *period]);
        for shift in super::grid::images([low, high], world, self.period) {
            self.cells.visit(&(low + shift), &(high + shift), |j| {
                visitor(j as usize, self.wrapped[j as usize] - shift);
            });
        }
    }

    /// Calls `visitor` with the index of every point in the box from `low` to `high` (m), and of some
    /// others. Only without period.
    pub(super) fn visit_box(&self, low: &Vec3, high: &Vec3, mut visitor: impl FnMut(usize)) {
        self.cells.visit(low, high, |j| visitor(j as usize));
    }
}

/// The image of `point` in `[0, period)` (m).
fn wrap(point: &Vec3, period: &Vec3) -> Vec3 {
    point.zip_map(period, |x, period| {
        let wrapped = x - (x / period).floor() * period;
        // A tiny negative number is rounded up to the period itself.
        if wrapped < period { wrapped } else { 0.0 }
    })
}
