//! Straight lines through points, by least squares.

use crate::{base::Real, physics::measure::real};

/// y = intercept + slope x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    pub(super) intercept: Real,
    pub(super) slope: Real,
}

/// The line through `points` (x, y); `None` for less than two.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: points on a line and on a power law; to rounding.
    #[test]
    fn lines_and_powers_are_found_back() {
        let points: Vec<[Real; 2]> = (1..6).map(|k| [real(k), 3.0 - 2.0 * real(k)]).collect();
        let found = line(&points).unwrap();
        assert!((found.intercept - 3.0).abs() < 1e-13 && (found.slope + 2.0).abs() < 1e-13);
        let points: Vec<[Real; 2]> = (1..6).map(|k| [real(k), real(k).powf(1.5)]).collect();
        assert!((exponent(&points).unwrap() - 1.5).abs() < 1e-13);
        assert_eq!(line(&points[..1]), None);
    }
}
