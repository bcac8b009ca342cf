//! Coarse-grained fields: quantities of spheres, distributed to the cells of a grid by exact overlap.
//!
//! ```text
//! j_a = Σ_i G_i V_ia / (V_i V_a)                  density of an extensive quantity G      eq. 68
//! g_a = Σ_i w_i g_i V_ia / V_i  /  Σ_i w_i V_ia / V_i      mean of g with weights w        eq. 69
//! φ_a = Σ_i V_ia / V_a                            solid fraction
//!
//! V_ia  volume of sphere i in cell a              (m³)
//! V_i   volume of sphere i                        (m³)
//! V_a   volume of cell a                          (m³)
//! ```
//!
//! With G = m the density is the mass density (kg/m³), with G = m v the momentum density. The mean
//! velocity that belongs to the momentum has the masses as weights; eq. 69 has equal weights.
//!
//! The densities of all cells times their volume sum to the total of G, if the grid covers the spheres.
//! A mean has no value in a cell without spheres.
//!
//! Source: Götz (2024), appendix C; overlap volumes: `super::overlap`, checked against Strobl, Formella
//! & Pöschel, J. Comput. Phys. 311 (2016) 158.

use std::{
    f64::consts::PI,
    ops::{Add, Mul, Sub},
};

use super::{
    grid::{Grid, bounds, images},
    overlap::sphere_in_box,
};
use crate::base::{Mat3, Real, Vec3};

/// Fraction of a sphere below which its overlap with a cell is due to rounding.
const ROUNDING: Real = 1e-14;

/// A quantity that can be averaged; its default is zero.
pub trait Quantity:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Real, Output = Self>
{
}

impl<T> Quantity for T where
    T: Copy + Default + Add<Output = T> + Sub<Output = T> + Mul<Real, Output = T>
{
}

/// The overlap volumes of spheres and cells.
#[derive(Clone, Debug)]
pub struct Overlaps {
    n_cells: usize,
    cell_volume: Real,
    volumes: Vec<Real>,
    /// The entries of sphere i are `starts[i] .. starts[i + 1]`.
    starts: Vec<usize>,
    /// A cell, and the fraction of the sphere in it.
    entries: Vec<(usize, Real)>,
}

impl Overlaps {
    /// Overlaps of the cells of `grid` with spheres at `positions` (m), world frame, with `radii` (m).
    /// In a box that repeats with `period` (m) along the world axes, all images count.
    pub fn new(grid: &Grid, positions: &[Vec3], radii: &[Real], period: Option<&Vec3>) -> Self {
        let world = bounds(grid);
        let mut overlaps = Self {
            n_cells: grid.n_cells(),
            cell_volume: grid.cell_volume(),
            volumes: radii.iter().map(|r| 4.0 / 3.0 * PI * r.powi(3)).collect(),
            starts: Vec::with_capacity(positions.len() + 1),
            entries: Vec::new(),
        };
        overlaps.starts.push(0);
        for (position, &radius) in positions.iter().zip(radii) {
            let corners = [position.add_scalar(-radius), position.add_scalar(radius)];
            for shift in images(corners, world, period) {
                overlaps.add(grid, &grid.to_local(&(position + shift)), radius);
            }
            overlaps.starts.push(overlaps.entries.len());
        }
        overlaps
    }

    /// Adds the overlap of cells with the sphere at `center` (m), grid frame.
    fn add(&mut self, grid: &Grid, center: &Vec3, radius: Real) {
        let [x, y, z] =
            [0, 1, 2].map(|axis| grid.span(axis, center[axis] - radius, center[axis] + radius));
        let sphere_volume = 4.0 / 3.0 * PI * radius.powi(3);
        for z in z {
            for y in y.clone() {
                for x in x.clone() {
                    let [low, high] = grid.corners([x, y, z]);
                    let share = sphere_in_box(center, radius, &low, &high) / sphere_volume;
                    if ROUNDING < share {
                        self.entries.push((grid.index([x, y, z]), share));
                    }
                }
            }
        }
    }

    /// Cells that overlap sphere `i`, each with the fraction of the sphere's volume in it.
    pub fn of_sphere(&self, i: usize) -> &[(usize, Real)] {
        &self.entries[self.starts[i]..self.starts[i + 1]]
    }

    /// Solid fraction of each cell; 0 in a cell without spheres.
    pub fn solid_fraction(&self) -> Vec<Real> {
        self.density(&self.volumes)
    }

    /// Density in each cell of the extensive quantity `of_sphere`, per m³ (eq. 68).
    pub fn density<T: Quantity>(&self, of_sphere: &[T]) -> Vec<T> {
        let mut density = vec![T::default(); self.n_cells];
        for (i, &quantity) in of_sphere.iter().enumerate() {
            for &(cell, share) in self.of_sphere(i) {
                density[cell] = density[cell] + quantity * (share / self.cell_volume);
            }
        }
        density
    }

    /// Mean in each cell of the intensive quantity `of_sphere` with equal weights (eq. 69); `None` in a
    /// cell without spheres. If all spheres have the same value, the mean equals it to the last bit.
    pub fn mean<T: Quantity>(&self, of_sphere: &[T]) -> Vec<Option<T>> {
        self.mean_by(|_| 1.0, of_sphere)
    }

    /// The same with a weight for each sphere. With masses as weights, the mean of the velocities is the
    /// velocity that belongs to the momentum density.
    pub fn weighted_mean<T: Quantity>(&self, weights: &[Real], of_sphere: &[T]) -> Vec<Option<T>> {
        self.mean_by(|i| weights[i], of_sphere)
    }

    fn mean_by<T: Quantity>(&self, weight: impl Fn(usize) -> Real, of: &[T]) -> Vec<Option<T>> {
        // Sums of differences from the first value, so that equal values cause no rounding error.
        let mut sums: Vec<Option<(T, T, Real)>> = vec![None; self.n_cells];
        for (i, &value) in of.iter().enumerate() {
            for &(cell, share) in self.of_sphere(i) {
                let (first, sum, total) = sums[cell].get_or_insert((value, T::default(), 0.0));
                let part = weight(i) * share;
                *sum = *sum + (value - *first) * part;
                *total += part;
            }
        }
        let mean =
            |(first, sum, total): (T, T, Real)| (total > 0.0).then(|| first + sum * total.recip());
        sums.into_iter().map(|cell| cell.and_then(mean)).collect()
    }
}

/// Displacement (m) of each sphere from `before` to `after`. Divided by the time between, it is the
/// velocity of the fields in Götz (2024), chapter 6. Positions that are not wrapped need no period;
/// positions wrapped into a box that repeats with `period` (m) must move by less than half of it.
pub fn displacements(before: &[Vec3], after: &[Vec3], period: Option<&Vec3>) -> Vec<Vec3> {
    let closest = |delta: Vec3| match period {
        Some(period) => {
            delta - delta.zip_map(period, |delta, period| (delta / period).round() * period)
        }
        None => delta,
    };
    before.iter().zip(after).map(|(before, after)| closest(after - before)).collect()
}

/// Gradient ∂_j u_i in each cell of the vector field `values`, world axes (unit of the field per m):
/// central differences, or one-sided next to a cell without value; `None` if an axis allows neither.
pub fn gradient(grid: &Grid, values: &[Option<Vec3>]) -> Vec<Option<Mat3>> {
    let to_world = grid.frame().rotation.to_rotation_matrix();
    let of_cell = |index: usize| {
        let here = values[index]?;
        let mut columns = [Vec3::zeros(); 3];
        for axis in 0..3 {
            let indices = grid.indices(index);
            let beside = |step: Option<usize>| {
                let mut indices = indices;
                indices[axis] = step.filter(|k| *k < grid.counts()[axis])?;
                values[grid.index(indices)]
            };
            let below = beside(indices[axis].checked_sub(1));
            let above = beside(Some(indices[axis] + 1));
            let edge = grid.cell_size()[axis];
            columns[axis] = match (below, above) {
                (Some(below), Some(above)) => (above - below) / (2.0 * edge),
                (Some(below), None) => (here - below) / edge,
                (None, Some(above)) => (above - here) / edge,
                (None, None) => return None,
            };
        }
        Some(Mat3::from_columns(&columns) * to_world.matrix().transpose())
    };
    (0..grid.n_cells()).map(of_cell).collect()
}

#[cfg(test)]
mod tests;
