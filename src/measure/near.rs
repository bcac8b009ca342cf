//! Points near a place, with their periodic images.

use crate::{
    base::{Real, Vec3},
    physics::neighbors::cell_grid::CellGrid,
};

/// Points sorted into cells, for searches.
pub(super) struct Near<'a> {
    cells: CellGrid,
    period: Option<&'a Vec3>,
    /// The points; those of a periodic box in `[0, period)`.
    wrapped: Vec<Vec3>,
}

impl<'a> Near<'a> {
    /// Sorts `points` (m) into cells of about `cell` (m); the box repeats with `period` (m), if any.
    pub(super) fn new(points: &[Vec3], cell: Real, period: Option<&'a Vec3>) -> Self {
        let wrapped: Vec<Vec3> = match period {
            Some(period) => points.iter().map(|point| wrap(point, period)).collect(),
            None => points.to_vec(),
        };
        Self { cells: CellGrid::new(&wrapped, cell), period, wrapped }
    }

    /// Where point `i` is, wrapped into the periodic box if there is one (m).
    pub(super) fn at(&self, i: usize) -> Vec3 {
        self.wrapped[i]
    }

    /// Calls `see` with the index and the position (m) of every point or image in the cube of half edge
    /// `reach` (m) around `place`, which lies in the box, and of some others.
    pub(super) fn visit(&self, place: &Vec3, reach: Real, mut see: impl FnMut(usize, Vec3)) {
        let (low, high) = (place.add_scalar(-reach), place.add_scalar(reach));
        let world = self.period.map_or([low, high], |period| [Vec3::zeros(), *period]);
        for shift in super::grid::images([low, high], world, self.period) {
            self.cells.visit(&(low + shift), &(high + shift), |j| {
                see(j as usize, self.wrapped[j as usize] - shift);
            });
        }
    }

    /// Calls `see` with the index of every point in the box from `low` to `high` (m), and of some others.
    /// For points without period.
    pub(super) fn visit_box(&self, low: &Vec3, high: &Vec3, mut see: impl FnMut(usize)) {
        self.cells.visit(low, high, |j| see(j as usize));
    }
}

/// `point` by its image in `[0, period)` (m).
fn wrap(point: &Vec3, period: &Vec3) -> Vec3 {
    point.zip_map(period, |x, period| {
        let wrapped = x - (x / period).floor() * period;
        // A tiny negative number is rounded up to the whole period.
        if wrapped < period { wrapped } else { 0.0 }
    })
}
