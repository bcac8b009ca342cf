//! Straight lines and power laws through points, by least squares.

use crate::base::{Real, real::real};

/// Number of onsets that are tried.
const N_TRIES: usize = 2000;

/// y = intercept + slope x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    pub(super) intercept: Real,
    pub(super) slope: Real,
}

/// The line through `points` (x, y); `None` for fewer than two.
pub(super) fn line(points: &[[Real; 2]]) -> Option<Line> {
    if points.len() < 2 {
        return None;
    }
    let n = real(points.len());
    let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<Real>() / n;
    let [x, y] = [mean(0), mean(1)];
    let (mut xx, mut xy) = (0.0, 0.0);
    for p in points {
        xx += (p[0] - x).powi(2);
        xy += (p[0] - x) * (p[1] - y);
    }
    let slope = xy / xx;
    Some(Line { intercept: y - slope * x, slope })
}

/// Exponent of a power law through `points` (x, y), all positive.
pub(super) fn exponent(points: &[[Real; 2]]) -> Option<Real> {
    let logs: Vec<[Real; 2]> = points.iter().map(|p| p.map(Real::ln)).collect();
    line(&logs).map(|it| it.slope)
}

/// Onset x₀ and exponent b of the power law y ~ (x − x₀)^b through `points` (x, y): of the onsets
/// up to `reach` below the smallest x, the one at which the logarithms fit a line best.
pub(super) fn onset(points: &[[Real; 2]], reach: Real) -> Option<(Real, Real)> {
    if points.len() < 3 {
        return None;
    }
    let lowest = points.iter().map(|p| p[0]).fold(Real::INFINITY, Real::min);
    let shifted = |x0: Real| -> Vec<[Real; 2]> {
        points.iter().map(|p| [(p[0] - x0).ln(), p[1].ln()]).collect()
    };
    let fit = |x0: Real| {
        let logs = shifted(x0);
        let fitted = line(&logs)?;
        let residuals =
            logs.iter().map(|p| (p[1] - fitted.intercept - fitted.slope * p[0]).powi(2));
        Some((residuals.sum::<Real>(), x0, fitted.slope))
    };
    let tries = (1..=N_TRIES).map(|k| lowest - reach * real(k) / real(N_TRIES));
    tries.filter_map(fit).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, x0, slope)| (x0, slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: points on a line and on a power law; to rounding.
    #[test]
    fn lines_and_power_laws_are_recovered() {
        let points: Vec<[Real; 2]> = (1..6).map(|k| [real(k), 3.0 - 2.0 * real(k)]).collect();
        let found = line(&points).unwrap();
        assert!((found.intercept - 3.0).abs() < 1e-13 && (found.slope + 2.0).abs() < 1e-13);
        let points: Vec<[Real; 2]> = (1..6).map(|k| [real(k), real(k).powf(1.5)]).collect();
        assert!((exponent(&points).unwrap() - 1.5).abs() < 1e-13);
        assert_eq!(line(&points[..1]), None);
        let points: Vec<[Real; 2]> =
            (1..6).map(|k| [0.64 + 1e-3 * real(k), 7.0 * real(k).powf(1.4)]).collect();
        let (x0, b) = onset(&points, 0.002).unwrap();
        assert!((x0 - 0.64).abs() < 1e-5 && (b - 1.4).abs() < 1e-3, "{x0} {b}");
    }
}
