//! Formats numbers and durations for people.

/// Number of significant digits.
const DIGITS: usize = 4;

/// A number with four significant digits, in scientific notation if it is very large or small.
pub fn number(value: f64) -> String {
    if !value.is_finite() || value == 0.0 {
        return if value.is_nan() { "none".to_owned() } else { format!("{value}") };
    }
    let scientific = format!("{value:.*e}", DIGITS - 1);
    let (mantissa, exponent) = scientific.split_once('e').expect("`{:e}` writes an exponent");
    let exponent: i32 = exponent.parse().expect("`{:e}` writes an integer exponent");
    if (-3..5).contains(&exponent) {
        let decimals = usize::try_from(3 - exponent).unwrap_or(0);
        return trimmed(&format!("{value:.decimals$}"));
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// A number with its unit; the unit `1` is left out.
pub fn with_unit(value: f64, unit: &str) -> String {
    if unit == "1" { number(value) } else { format!("{} {unit}", number(value)) }
}

/// A text on one line, with single spaces.
pub fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn trimmed(text: &str) -> String {
    if text.contains('.') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text.to_owned()
}

/// A duration in its two largest units.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "an unknown time".to_owned();
    }
    if seconds < 9.95 {
        return format!("{:.1} s", seconds.max(0.0));
    }
    #[expect(clippy::cast_possible_truncation, reason = "saturates, after millions of years")]
    #[expect(clippy::cast_sign_loss, reason = "above zero")]
    let seconds = seconds.round() as u64;
    let (minutes, hours, days) = (seconds / 60, seconds / 3600, seconds / 86_400);
    match (days, hours, minutes) {
        (0, 0, 0) => format!("{seconds} s"),
        (0, 0, _) if minutes < 10 => format!("{minutes} min {} s", seconds % 60),
        (0, 0, _) => format!("{minutes} min"),
        (0, _, _) => format!("{hours} h {} min", minutes % 60),
        _ => format!("{days} d {} h", hours % 24),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: written by hand.
    #[test]
    fn numbers_keep_four_digits_and_no_trailing_zeros() {
        let expected = [
            (0.0, "0"),
            (1.0, "1"),
            (-12.5, "-12.5"),
            (12345.6, "12346"),
            (123_456.0, "1.235e5"),
            (0.012_345_6, "0.01235"),
            (0.000_25, "2.5e-4"),
            (99_999.9, "1e5"),
            (5e6, "5e6"),
            (100.0, "100"),
            (f64::NAN, "none"),
            (f64::NEG_INFINITY, "-inf"),
        ];
        for (value, text) in expected {
            assert_eq!(number(value), text);
        }
        assert_eq!(with_unit(2.0, "N"), "2 N");
        assert_eq!(with_unit(0.3, "1"), "0.3");
    }

    /// Oracle: written by hand.
    #[test]
    fn durations_have_at_most_two_units() {
        let expected = [
            (0.04, "0.0 s"),
            (9.9, "9.9 s"),
            (9.97, "10 s"),
            (61.0, "1 min 1 s"),
            (700.0, "11 min"),
            (7260.0, "2 h 1 min"),
            (100_000.0, "1 d 3 h"),
            (f64::INFINITY, "an unknown time"),
        ];
        for (seconds, text) in expected {
            assert_eq!(duration(seconds), text);
        }
    }
}
