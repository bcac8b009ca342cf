//! A record as the rows need it: without its first period, in means, ranges and whole periods.

use super::{expected::Rest, run::Case, scene::Scene};
use crate::{
    base::{Real, real::real},
    experiments::record::Record,
};

/// Places over one period at which the expected curve is known.
const N_PLACES: usize = 400;

/// A case with its record, after the first period: the ball has come to slide by then.
pub(super) struct Seen<'a> {
    pub(super) case: &'a Case,
    pub(super) record: &'a Record,
    /// First entry that counts.
    begin: usize,
}

/// Largest and smallest value, and the mean.
pub(super) struct Spread {
    pub(super) least: Real,
    pub(super) most: Real,
    pub(super) mean: Real,
}

impl Spread {
    fn of(values: impl Iterator<Item = Real>) -> Self {
        let (mut least, mut most, mut sum, mut n) = (Real::INFINITY, Real::NEG_INFINITY, 0.0, 0);
        for value in values {
            (least, most) = (least.min(value), most.max(value));
            (sum, n) = (sum + value, n + 1);
        }
        Self { least, most, mean: sum / real(n) }
    }

    pub(super) fn range(&self) -> Real {
        self.most - self.least
    }
}

impl<'a> Seen<'a> {
    pub(super) fn new(case: &'a Case, record: &'a Record) -> Option<Self> {
        let period = case.period().norm();
        let begin = record.column("distance")?.iter().position(|&it| it >= period)?;
        Some(Self { case, record, begin })
    }

    /// All of a column, from the start.
    pub(super) fn all(&self, name: &str) -> &'a [Real] {
        self.record.column(name).unwrap_or_default()
    }

    /// A column after the first period.
    pub(super) fn column(&self, name: &str) -> &'a [Real] {
        &self.all(name)[self.begin..]
    }

    /// The same, over as many whole periods as there are.
    pub(super) fn whole_periods(&self, name: &str) -> &'a [Real] {
        let distances = self.column("distance");
        let period = self.case.period().norm();
        let length = distances.last().zip(distances.first()).map_or(0.0, |(b, a)| b - a);
        let end = distances[0] + (length / period + 1e-6).floor() * period;
        let n = distances.iter().position(|&it| it > end).unwrap_or(distances.len());
        &self.column(name)[..n]
    }

    pub(super) fn spread(&self, name: &str) -> Spread {
        Spread::of(self.column(name).iter().copied())
    }

    /// What geometry and Hertz say over one period of spheres.
    pub(super) fn expected(&self, scene: &Scene) -> Vec<Rest> {
        let Ok(patch) = self.case.patch(scene) else { return Vec::new() };
        let bed = self.case.bed(scene, &patch.mesh.positions);
        bed.curve(self.case.period().norm(), N_PLACES)
    }

    /// The friction force where the way is `share` of a period after a vertex, averaged over periods.
    pub(super) fn friction_at(&self, share: Real) -> Real {
        let period = self.case.period().norm();
        let (distances, forces) = (self.column("distance"), self.column("friction_force"));
        let phases: Vec<Real> = distances.iter().map(|it| it / period - share).collect();
        let mut values = Vec::new();
        for k in 1..phases.len() {
            let next = phases[k].floor();
            if phases[k - 1] < next {
                let part = (next - phases[k - 1]) / (phases[k] - phases[k - 1]);
                values.push(forces[k - 1] + (forces[k] - forces[k - 1]) * part);
            }
        }
        Spread::of(values.into_iter()).mean
    }

    /// Mean distance (m) between the places where the ball comes up to near its highest.
    pub(super) fn ups(&self) -> Real {
        let heights = self.column("height");
        let distances = self.column("distance");
        let spread = self.spread("height");
        let level = spread.most - 0.15 * spread.range();
        let ups: Vec<Real> = (1..heights.len())
            .filter(|&k| heights[k - 1] < level && heights[k] >= level)
            .map(|k| {
                let part = (level - heights[k - 1]) / (heights[k] - heights[k - 1]);
                distances[k - 1] + (distances[k] - distances[k - 1]) * part
            })
            .collect();
        let length = ups.last().zip(ups.first()).map_or(Real::NAN, |(b, a)| b - a);
        length / real(ups.len().saturating_sub(1))
    }

    /// Standard deviation of the friction force about a straight line, over its mean.
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

/// Rms deviations of height and friction from the expected curve, over the ranges of the latter.
pub(super) fn deviations(seen: &Seen<'_>, expected: &[Rest]) -> (Real, Real) {
    let period = seen.case.period().norm();
    let heights = Spread::of(expected.iter().map(|it| it.height)).range();
    let frictions = Spread::of(expected.iter().map(|it| it.friction)).range();
    let (mut height, mut friction, mut n) = (0.0, 0.0, 0);
    let (z, force) = (seen.column("height"), seen.column("friction_force"));
    for ((x, z), force) in seen.column("distance").iter().zip(z).zip(force) {
        let there = at_phase(expected, x / period);
        height += (z - there.height).powi(2);
        friction += (force - there.friction).powi(2);
        n += 1;
    }
    let rms = |sum: Real| (sum / real(n)).sqrt();
    (rms(height) / heights, rms(friction) / frictions)
}

/// The curve at a place counted in periods, between its points.
pub(super) fn at_phase(curve: &[Rest], phase: Real) -> Rest {
    let place = (phase - phase.floor()) * real(curve.len());
    let part = place - place.floor();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place on the curve"
    )]
    let k = place as usize % curve.len();
    let (a, b) = (&curve[k], &curve[(k + 1) % curve.len()]);
    Rest {
        height: a.height + (b.height - a.height) * part,
        friction: a.friction + (b.friction - a.friction) * part,
    }
}
