//! Quantities from a record: without its first period, as means, ranges and over whole periods.

use super::{
    build::Patch,
    cases::Case,
    expected::{Bed, Rest},
    scene::SlideScene,
};
use crate::{base::Real, base::real::real, experiments::record::Record};

/// Points over one period at which the expected curve is computed.
const N_POINTS: usize = 400;

/// A case with its record after the first period, when the ball slides.
pub(super) struct CaseRecord<'a> {
    pub(super) case: &'a Case,
    pub(super) record: &'a Record,
    /// Index of the first row after the first period.
    first: usize,
}

/// Smallest, largest and mean value.
pub(super) struct Spread {
    pub(super) min: Real,
    pub(super) max: Real,
    pub(super) mean: Real,
}

impl Spread {
    fn of(values: impl Iterator<Item = Real>) -> Self {
        let (mut min, mut max, mut sum, mut n) = (Real::INFINITY, Real::NEG_INFINITY, 0.0, 0);
        for value in values {
            (min, max) = (min.min(value), max.max(value));
            (sum, n) = (sum + value, n + 1);
        }
        Self { min, max, mean: sum / real(n) }
    }

    pub(super) fn range(&self) -> Real {
        self.max - self.min
    }
}

impl<'a> CaseRecord<'a> {
    pub(super) fn new(case: &'a Case, record: &'a Record) -> Option<Self> {
        let period = case.period().norm();
        let first = record.column("distance")?.iter().position(|&it| it >= period)?;
        Some(Self { case, record, first })
    }

    /// A whole column.
    pub(super) fn all(&self, name: &str) -> &'a [Real] {
        self.record.column(name).unwrap_or_default()
    }

    /// A column after the first period.
    pub(super) fn column(&self, name: &str) -> &'a [Real] {
        &self.all(name)[self.first..]
    }

    /// A column after the first period, over as many whole periods as there are.
    pub(super) fn whole_periods(&self, name: &str) -> &'a [Real] {
        let distances = self.column("distance");
        let period = self.case.period().norm();
        let length = distances.last().zip(distances.first()).map_or(0.0, |(b, a)| b - a);
        let end = distances[0] + (length / period + 1e-6).floor() * period;
        let n = distances.iter().position(|&it| it > end).unwrap_or(distances.len());
        &self.column(name)[..n]
    }

    /// Spread of a column after the first period.
    pub(super) fn spread(&self, name: &str) -> Spread {
        Spread::of(self.column(name).iter().copied())
    }

    /// The expected curve over one period of spheres.
    pub(super) fn expected(&self, scene: &SlideScene) -> Vec<Rest> {
        let Ok(patch) = Patch::new(scene, self.case) else { return Vec::new() };
        let bed = Bed::new(scene, self.case, &patch.mesh.positions);
        bed.curve(self.case.period().norm(), N_POINTS)
    }

    /// The friction force at `share` of a period after a vertex, averaged over all periods.
    pub(super) fn friction_at(&self, share: Real) -> Real {
        let period = self.case.period().norm();
        let (distances, forces) = (self.column("distance"), self.column("friction_force"));
        let periods: Vec<Real> = distances.iter().map(|it| it / period - share).collect();
        let mut values = Vec::new();
        for k in 1..periods.len() {
            let next = periods[k].floor();
            if periods[k - 1] < next {
                let part = (next - periods[k - 1]) / (periods[k] - periods[k - 1]);
                values.push(forces[k - 1] + (forces[k] - forces[k - 1]) * part);
            }
        }
        Spread::of(values.into_iter()).mean
    }

    /// Mean distance (m) between two maxima of the height.
    pub(super) fn distance_of_maxima(&self) -> Real {
        let heights = self.column("height");
        let distances = self.column("distance");
        let spread = self.spread("height");
        let level = spread.max - 0.15 * spread.range();
        let rises: Vec<Real> = (1..heights.len())
            .filter(|&k| heights[k - 1] < level && heights[k] >= level)
            .map(|k| {
                let part = (level - heights[k - 1]) / (heights[k] - heights[k - 1]);
                distances[k - 1] + (distances[k] - distances[k - 1]) * part
            })
            .collect();
        let length = rises.last().zip(rises.first()).map_or(Real::NAN, |(b, a)| b - a);
        length / real(rises.len().saturating_sub(1))
    }

    /// Standard deviation of the friction force from a straight line, over its mean.
    pub(super) fn ripple(&self) -> Real {
        let (x, y) = (self.whole_periods("distance"), self.whole_periods("friction_force"));
        let mean = |values: &[Real]| values.iter().sum::<Real>() / real(values.len());
        let (mean_x, mean_y) = (mean(x), mean(y));
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for (x, y) in x.iter().zip(y) {
            let (x, y) = (x - mean_x, y - mean_y);
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        }
        ((yy - xy * xy / xx).max(0.0) / real(x.len())).sqrt() / mean_y
    }
}

/// Root-mean-square deviations of height and friction from the expected curve, over its ranges.
pub(super) fn deviations(measured: &CaseRecord<'_>, expected: &[Rest]) -> (Real, Real) {
    let period = measured.case.period().norm();
    let heights = Spread::of(expected.iter().map(|it| it.height)).range();
    let frictions = Spread::of(expected.iter().map(|it| it.friction)).range();
    let (mut height, mut friction, mut n) = (0.0, 0.0, 0);
    let (z, force) = (measured.column("height"), measured.column("friction_force"));
    for ((x, z), force) in measured.column("distance").iter().zip(z).zip(force) {
        let at = interpolate(expected, x / period);
        height += (z - at.height).powi(2);
        friction += (force - at.friction).powi(2);
        n += 1;
    }
    let rms = |sum: Real| (sum / real(n)).sqrt();
    (rms(height) / heights, rms(friction) / frictions)
}

/// The expected curve at a distance in periods, interpolated between its points.
pub(super) fn interpolate(curve: &[Rest], distance: Real) -> Rest {
    let position = (distance - distance.floor()) * real(curve.len());
    let part = position - position.floor();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a position on the curve"
    )]
    let k = position as usize % curve.len();
    let (a, b) = (&curve[k], &curve[(k + 1) % curve.len()]);
    Rest {
        height: a.height + (b.height - a.height) * part,
        friction: a.friction + (b.friction - a.friction) * part,
    }
}

/// The case with this name, if there is a record of it.
pub(super) fn named<'s, 'a>(
    records: &'s [CaseRecord<'a>],
    name: &str,
) -> Option<&'s CaseRecord<'a>> {
    records.iter().find(|it| it.case.name == name)
}
