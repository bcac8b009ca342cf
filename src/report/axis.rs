//! An axis of a plot: the positions of values, and the tick labels.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use crate::report::format::number;

/// Space beyond the outermost points, as a fraction of the axis.
const MARGIN: f64 = 0.04;
/// Approximate number of ticks on an axis.
const N_TICKS: f64 = 6.0;

/// An axis, linear or logarithmic.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    is_log: bool,
}

impl Axis {
    /// An axis that covers all of `values` that it can show.
    pub(super) fn around(values: impl Iterator<Item = f64>, is_log: bool) -> Self {
        let mut axis = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, is_log };
        for value in values {
            let position = axis.position(value);
            if position.is_finite() {
                axis.low = axis.low.min(position);
                axis.high = axis.high.max(position);
            }
        }
        if axis.high < axis.low {
            (axis.low, axis.high) = (0.0, 1.0);
        }
        // A linear axis that starts near zero is extended to zero.
        let touches_zero = !is_log && 0.0 <= axis.low && axis.low <= 0.3 * axis.high;
        let mut margin = MARGIN * (axis.high - axis.low);
        if margin <= 1e-9 * axis.high.abs() {
            margin = if axis.high == 0.0 { 0.5 } else { 0.1 * axis.high.abs() };
        }
        axis.low = if touches_zero { 0.0 } else { axis.low - margin };
        axis.high += margin;
        axis
    }

    /// True if the axis can show `value`.
    pub(super) fn can_show(&self, value: f64) -> bool {
        self.position(value).is_finite()
    }

    /// The smallest value on the axis.
    pub(super) fn lowest(&self) -> f64 {
        self.value(self.low)
    }

    /// The position of a value on the axis, before scaling.
    fn position(&self, value: f64) -> f64 {
        if self.is_log { if 0.0 < value { value.log10() } else { f64::NAN } } else { value }
    }

    fn value(&self, position: f64) -> f64 {
        if self.is_log { 10_f64.powf(position) } else { position }
    }

    /// The values of the ticks.
    fn ticks(&self) -> Vec<f64> {
        let decades = self.high - self.low;
        if !self.is_log || decades < 0.7 {
            let (low, high) = (self.value(self.low), self.value(self.high));
            return round_numbers(low, high);
        }
        let factors: &[f64] = match decades {
            it if it < 1.6 => &[1.0, 2.0, 5.0],
            it if it < 3.0 => &[1.0, 3.0],
            _ => &[1.0],
        };
        let step = (decades / N_TICKS).ceil().max(1.0);
        let mut ticks = Vec::new();
        let mut decade = (self.low.floor() / step).floor() * step;
        while decade <= self.high {
            ticks.extend(factors.iter().map(|factor| factor * 10_f64.powf(decade)));
            decade += step;
        }
        ticks.retain(|tick| (self.low..=self.high).contains(&self.position(*tick)));
        ticks
    }
}

/// Multiples of 1, 2 or 5 times a power of ten, between `low` and `high`.
fn round_numbers(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / N_TICKS;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| rough <= *step)
        .unwrap_or(10.0 * power);
    let mut ticks = Vec::new();
    let mut k = (low / step).ceil();
    while k * step <= high + 1e-9 * step && ticks.len() < 20 {
        ticks.push(k * step);
        k += 1.0;
    }
    ticks
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let fraction = (self.position(*value) - self.low) / (self.high - self.low);
        let (from, to) = (f64::from(limit.0), f64::from(limit.1));
        #[expect(clippy::cast_possible_truncation, reason = "pixels; the cast saturates")]
        let pixel = (from + fraction * (to - from)).round() as i32;
        pixel
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        self.value(self.low)..self.value(self.high)
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let text = if self.is_log && !(1e-2..1e4).contains(value) {
            superscript(&format!("{value:.0e}"))
        } else if value.abs() < 1e-9 * (self.high - self.low) {
            "0".to_owned()
        } else if 1e3 <= value.abs() && self.high.abs().max(self.low.abs()) < 1e6 {
            grouped(*value)
        } else {
            superscript(&number(*value))
        };
        text.replace('-', "−")
    }
}

/// `80000` as `80 000`.
fn grouped(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let (thousands, rest) = digits.split_at(digits.len() - 3);
    format!("{}{thousands}\u{202f}{rest}", if value < 0.0 { "-" } else { "" })
}

/// `2.5e-4` as `2.5·10⁻⁴`, `1e6` as `10⁶`.
fn superscript(text: &str) -> String {
    let Some((mantissa, exponent)) = text.split_once('e') else { return text.to_owned() };
    let raised: String = exponent
        .chars()
        .map(|c| match c.to_digit(10) {
            Some(digit) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize],
            None => '⁻',
        })
        .collect();
    if mantissa == "1" { format!("10{raised}") } else { format!("{mantissa}·10{raised}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(values: &[f64], is_log: bool) -> Vec<String> {
        let axis = Axis::around(values.iter().copied(), is_log);
        axis.ticks().iter().map(|tick| axis.format_ext(tick)).collect()
    }

    /// Oracle: ticks chosen by hand.
    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(labels(&[0.0, 1.0], false), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(labels(&[-3.0, 4.0], false), ["−2", "0", "2", "4"]);
        assert_eq!(labels(&[0.0, 1e5], false)[4..], ["80\u{202f}000", "100\u{202f}000"]);
        assert_eq!(labels(&[5e6, 1e10], true), ["10⁷", "10⁸", "10⁹", "10¹⁰"]);
        assert_eq!(labels(&[3e4, 4e5], true), ["5·10⁴", "10⁵", "2·10⁵"]);
        assert_eq!(labels(&[1e-12, 1.0], true).len(), 5);
        assert_eq!(labels(&[100.0, 102.0], false), ["100", "100.5", "101", "101.5", "102"]);
    }

    /// Oracle: the axis itself: it can be drawn for any input.
    #[test]
    fn every_axis_has_an_extent() {
        for is_log in [false, true] {
            for values in
                [&[][..], &[0.0], &[7.0], &[-7.0, f64::NAN], &[0.0, f64::INFINITY], &[1e-300, 2.0]]
            {
                let axis = Axis::around(values.iter().copied(), is_log);
                assert!(axis.low < axis.high, "{values:?} {axis:?}");
                assert!(axis.ticks().len() < 21);
            }
        }
    }
}
