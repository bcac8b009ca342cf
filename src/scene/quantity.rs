//! Numbers with units: "2 mm", "-90 kPa", "7 us". A number without its unit is rejected.
//!
//! Decimal prefixes are applied to the written digits, not to the parsed number. Thus `2 mm` is
//! exactly the double `0.002`, and printing and parsing a quantity gives the same bits.

use std::f64::consts::PI;

use crate::base::Real;

/// A unit of a dimension: the written number times `factor` times ten to the power `exponent` is
/// the value in SI.
#[derive(Debug, PartialEq)]
pub struct Unit {
    /// Symbol, as written in scenes.
    pub name: &'static str,
    /// Decimal exponent.
    pub exponent: i32,
    /// Factor besides the power of ten.
    pub factor: Real,
    /// True if quantities are printed in this unit; others are only parsed.
    pub is_printed: bool,
}

/// A physical dimension and its units; the first one is SI.
#[derive(Debug, PartialEq)]
pub struct Dimension {
    /// Name, used in messages.
    pub name: &'static str,
    /// Accepted units.
    pub units: &'static [Unit],
}

const fn ten(name: &'static str, exponent: i32) -> Unit {
    Unit { name, exponent, factor: 1.0, is_printed: true }
}

const fn only_read(name: &'static str, exponent: i32) -> Unit {
    Unit { name, exponent, factor: 1.0, is_printed: false }
}

const fn scaled(name: &'static str, factor: Real) -> Unit {
    Unit { name, exponent: 0, factor, is_printed: true }
}

const DEGREE: Real = PI / 180.0;

/// Lengths (m).
pub static LENGTH: Dimension = Dimension {
    name: "length",
    units: &[ten("m", 0), only_read("cm", -2), ten("mm", -3), ten("um", -6)],
};
/// Times (s).
pub static TIME: Dimension =
    Dimension { name: "time", units: &[ten("s", 0), ten("ms", -3), ten("us", -6), ten("ns", -9)] };
/// Pressures and moduli (Pa).
pub static PRESSURE: Dimension = Dimension {
    name: "pressure",
    units: &[
        ten("Pa", 0),
        ten("kPa", 3),
        ten("MPa", 6),
        ten("GPa", 9),
        only_read("mbar", 2),
        only_read("bar", 5),
    ],
};
/// Rates of pressure (Pa/s).
pub static PRESSURE_RATE: Dimension = Dimension {
    name: "pressure rate",
    units: &[ten("Pa/s", 0), ten("kPa/s", 3), ten("MPa/s", 6), only_read("bar/s", 5)],
};
/// Mass densities (kg/m³).
pub static DENSITY: Dimension =
    Dimension { name: "density", units: &[ten("kg/m^3", 0), only_read("g/cm^3", 3)] };
/// Speeds (m/s).
pub static SPEED: Dimension =
    Dimension { name: "speed", units: &[ten("m/s", 0), only_read("cm/s", -2), ten("mm/s", -3)] };
/// Accelerations (m/s²).
pub static ACCELERATION: Dimension =
    Dimension { name: "acceleration", units: &[ten("m/s^2", 0), ten("mm/s^2", -3)] };
/// Angles (rad).
pub static ANGLE: Dimension =
    Dimension { name: "angle", units: &[ten("rad", 0), scaled("deg", DEGREE)] };
/// Angular speeds (rad/s).
pub static ANGULAR_SPEED: Dimension =
    Dimension { name: "angular speed", units: &[ten("rad/s", 0), scaled("deg/s", DEGREE)] };
/// Angular accelerations (rad/s²).
pub static ANGULAR_ACCELERATION: Dimension = Dimension {
    name: "angular acceleration",
    units: &[ten("rad/s^2", 0), scaled("deg/s^2", DEGREE)],
};
/// Forces (N).
pub static FORCE: Dimension =
    Dimension { name: "force", units: &[ten("N", 0), ten("mN", -3), ten("kN", 3)] };
/// Bending stiffnesses of hinges (N m).
pub static TORQUE: Dimension =
    Dimension { name: "torque", units: &[ten("N m", 0), ten("mN m", -3), ten("uN m", -6)] };
/// Bending dampings of hinges (N s).
pub static IMPULSE: Dimension =
    Dimension { name: "impulse", units: &[ten("N s", 0), ten("mN s", -3), ten("uN s", -6)] };
/// Frequencies (Hz).
pub static FREQUENCY: Dimension =
    Dimension { name: "frequency", units: &[ten("Hz", 0), ten("kHz", 3)] };

/// Why a text is not a quantity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuantityError {
    /// The unit is missing.
    #[error("`{value}` has no unit; use one of: {units}")]
    NoUnit {
        /// The value as written.
        value: String,
        /// Accepted units.
        units: String,
    },
    /// The unit belongs to another dimension.
    #[error(
        "`{value}` has the unit `{unit}`, which is not a unit of {dimension}; use one of: {units}"
    )]
    UnknownUnit {
        /// The value as written.
        value: String,
        /// The unit found.
        unit: String,
        /// The expected dimension.
        dimension: &'static str,
        /// Accepted units.
        units: String,
    },
    /// The text does not start with a number.
    #[error("`{value}` is not a quantity of {dimension}; write a number and one of: {units}")]
    NotANumber {
        /// The value as written.
        value: String,
        /// The expected dimension.
        dimension: &'static str,
        /// Accepted units.
        units: String,
    },
}

impl Dimension {
    /// Parses a quantity of this dimension; the result is in SI.
    ///
    /// # Errors
    /// If the number or the unit is missing, or the unit belongs to another dimension.
    pub fn parse(&self, text: &str) -> Result<Real, QuantityError> {
        let value = || text.trim().to_owned();
        let plain = in_plain_letters(text.trim());
        let Some((number, unit)) = split_number(&plain) else {
            let (dimension, units) = (self.name, self.unit_names());
            return Err(QuantityError::NotANumber { value: value(), dimension, units });
        };
        if unit.is_empty() {
            return Err(QuantityError::NoUnit { value: value(), units: self.unit_names() });
        }
        let Some(unit) = self.units.iter().find(|known| known.name == unit) else {
            return Err(QuantityError::UnknownUnit {
                value: value(),
                unit: unit.to_owned(),
                dimension: self.name,
                units: self.unit_names(),
            });
        };
        Ok(unit.to_si(number))
    }

    /// The shortest text that parses to exactly `value`. Of equally short texts, one whose number is
    /// from 1 to 1000.
    pub fn print(&self, value: Real) -> String {
        let printed = self.units.iter().filter(|unit| unit.is_printed);
        let candidates = printed.filter_map(|unit| unit.print(value));
        let effort = |(text, is_handy): &(String, bool)| (text.len(), !is_handy);
        candidates.min_by_key(effort).expect("the first unit is SI and prints any number").0
    }

    /// Accepted units, for messages.
    pub fn unit_names(&self) -> String {
        self.units.iter().map(|unit| unit.name).collect::<Vec<_>>().join(", ")
    }
}

impl Unit {
    fn to_si(&self, number: &str) -> Real {
        shifted(number, self.exponent) * self.factor
    }

    /// The text, and whether its number is from 1 to 1000.
    fn print(&self, value: Real) -> Option<(String, bool)> {
        let number = value / self.factor;
        if !number.is_finite() {
            return None;
        }
        let written = decimal(number, -self.exponent);
        let is_exact = self.to_si(&written).to_bits() == value.to_bits();
        let is_handy = (1.0..1000.0).contains(&shifted(&written, 0).abs());
        is_exact.then(|| (format!("{written} {}", self.name), is_handy))
    }
}

/// Replaces special characters in units by the spelling of the tables above.
fn in_plain_letters(text: &str) -> String {
    text.replace(['µ', 'μ'], "u")
        .replace('³', "^3")
        .replace('²', "^2")
        .replace('°', "deg")
        .replace(['·', '*'], " ")
}

/// The longest prefix of `text` that is a decimal number, and the rest.
fn split_number(text: &str) -> Option<(&str, &str)> {
    let is_part = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let longest = text.find(|c| !is_part(c)).unwrap_or(text.len());
    let is_number = |end: &usize| text[..*end].parse::<Real>().is_ok_and(Real::is_finite);
    let end = (1..=longest).rev().find(is_number)?;
    Some((&text[..end], text[end..].trim()))
}

/// Parses a decimal number times ten to the power `exponent`, rounded once.
fn shifted(number: &str, exponent: i32) -> Real {
    let (mantissa, own) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let own: i32 = own.parse().unwrap_or(0);
    let shifted = format!("{mantissa}e{}", own.saturating_add(exponent));
    shifted.parse().expect("a decimal number with another exponent is one")
}

/// The shortest decimal digits of `value`, times ten to the power `exponent`.
fn decimal(value: Real, exponent: i32) -> String {
    let text = format!("{value:e}");
    let (mantissa, own) = text.split_once('e').expect("`{:e}` writes an exponent");
    let own: i32 = own.parse().expect("`{:e}` writes an integer exponent");
    let total = own + exponent;
    if (-5..=8).contains(&total) {
        place_point(mantissa, total)
    } else {
        format!("{mantissa}e{total}")
    }
}

/// Writes `d.ddd` times ten to the power `exponent` without an exponent.
fn place_point(mantissa: &str, exponent: i32) -> String {
    let (sign, digits) = match mantissa.strip_prefix('-') {
        Some(rest) => ("-", rest.replace('.', "")),
        None => ("", mantissa.replace('.', "")),
    };
    let point = exponent + 1;
    if point <= 0 {
        let zeros = "0".repeat(point.unsigned_abs() as usize);
        return format!("{sign}0.{zeros}{digits}");
    }
    let point = point.unsigned_abs() as usize;
    if digits.len() <= point {
        let zeros = "0".repeat(point - digits.len());
        return format!("{sign}{digits}{zeros}");
    }
    format!("{sign}{}.{}", &digits[..point], &digits[point..])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Oracle: the double that Rust's own parser gives for the SI value, bit for bit.
    #[test]
    fn parsed_quantities_are_the_nearest_doubles() {
        let cases: [(&Dimension, &str, Real); 14] = [
            (&LENGTH, "2 mm", 0.002),
            (&LENGTH, "1.9mm", 0.0019),
            (&LENGTH, "12 µm", 12e-6),
            (&PRESSURE, "5 MPa", 5e6),
            (&PRESSURE, "-90 kPa", -90e3),
            (&PRESSURE, "1.25e6 Pa", 1.25e6),
            (&PRESSURE, "1.01325 bar", 101_325.0),
            (&TIME, "7 us", 7e-6),
            (&DENSITY, "7.85 g/cm³", 7850.0),
            (&DENSITY, "2000 kg/m^3", 2000.0),
            (&SPEED, "10 mm/s", 0.01),
            (&ANGLE, "90 deg", 90.0 * DEGREE),
            (&TORQUE, "1e-3 N*m", 1e-3),
            (&ACCELERATION, "-9.81 m/s²", -9.81),
        ];
        for (dimension, text, expected) in cases {
            let found = dimension.parse(text).expect(text);
            assert_eq!(found.to_bits(), expected.to_bits(), "{text}: {found} != {expected}");
        }
    }

    /// Oracle: the usual way to write each value.
    #[test]
    fn quantities_are_printed_in_the_shortest_form() {
        let cases: [(&Dimension, Real, &str); 9] = [
            (&PRESSURE, 1.25e6, "1.25 MPa"),
            (&LENGTH, 0.0019, "1.9 mm"),
            (&LENGTH, 0.0, "0 m"),
            (&LENGTH, 0.04, "40 mm"),
            (&PRESSURE, -90e3, "-90 kPa"),
            (&PRESSURE, 5e6, "5 MPa"),
            (&TIME, 7e-6, "7 us"),
            (&ANGLE, 90.0 * DEGREE, "90 deg"),
            (&ACCELERATION, -9.81, "-9.81 m/s^2"),
        ];
        for (dimension, value, expected) in cases {
            assert_eq!(dimension.print(value), expected);
        }
    }

    #[test]
    fn errors_list_the_accepted_units() {
        let message = |text: &str| LENGTH.parse(text).expect_err(text).to_string();
        assert_eq!(message("2"), "`2` has no unit; use one of: m, cm, mm, um");
        assert_eq!(
            message("2 kPa"),
            "`2 kPa` has the unit `kPa`, which is not a unit of length; use one of: m, cm, mm, um"
        );
        for not_a_number in ["mm", "", "inf m", "nan mm", "two mm", "1e999 m"] {
            assert!(
                message(not_a_number).contains("write a number and one of")
                    || message(not_a_number).contains("has the unit"),
                "{not_a_number}: {}",
                message(not_a_number)
            );
        }
    }

    /// In degrees this value exceeds the largest double.
    #[test]
    fn numbers_that_overflow_in_a_unit_are_printed_in_another() {
        assert_eq!(ANGLE.print(7.5e307), "7.5e307 rad");
    }

    proptest! {
        /// Printing and parsing gives the same bits for any finite number.
        #[test]
        fn print_and_parse_are_inverse(value in prop::num::f64::NORMAL | prop::num::f64::ZERO) {
            for dimension in [&LENGTH, &PRESSURE, &ANGLE, &DENSITY] {
                let text = dimension.print(value);
                let back = dimension.parse(&text).expect("printed text is a quantity");
                prop_assert_eq!(back.to_bits(), value.to_bits(), "{}", text);
            }
        }
    }
}
