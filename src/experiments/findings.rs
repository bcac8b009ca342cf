//! What an experiment found: quantities with units, curves, plots, and rows that set a measured
//! value beside its oracle.

use serde::{Deserialize, Serialize};

use super::{number_format, record::Column};
use crate::base::real::real;

/// All that the records show.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// Named results.
    pub quantities: Vec<Quantity>,
    /// Tables, one CSV file each.
    pub curves: Vec<Curve>,
    /// Pictures of the report.
    pub plots: Vec<Plot>,
    /// Measured against expected.
    pub rows: Vec<Row>,
    /// What a reader must know.
    pub notes: Vec<String>,
}

/// A named result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// Name, `holding_force_5MPa`.
    pub name: String,
    /// What it is.
    pub meaning: String,
    /// Its value.
    #[serde(with = "number_format::one")]
    pub value: f64,
    /// Standard deviation over repetitions, if there are any.
    pub deviation: Option<f64>,
    /// Number of repetitions.
    pub n: usize,
    /// Unit, `1` without one.
    pub unit: String,
}

/// Mean, standard deviation if there are several, and number of values.
#[derive(Clone, Copy, Debug)]
pub struct Mean {
    /// The mean.
    pub value: f64,
    /// Standard deviation of the values.
    pub deviation: Option<f64>,
    /// How many there are.
    pub n: usize,
}

impl Mean {
    /// Of `values`; `None` without any.
    pub fn new(values: &[f64]) -> Option<Self> {
        let n = values.len();
        if n == 0 {
            return None;
        }
        let value = values.iter().sum::<f64>() / real(n);
        let squares: f64 = values.iter().map(|it| (it - value).powi(2)).sum();
        let deviation = (n > 1).then(|| (squares / real(n - 1)).sqrt());
        Some(Self { value, deviation, n })
    }

    /// Standard error of the mean; zero of a single value.
    pub fn error(&self) -> f64 {
        self.deviation.map_or(0.0, |it| it / real(self.n).sqrt())
    }
}

/// A table, one CSV file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name of the file without its ending.
    pub name: String,
    /// Columns of equal length.
    pub columns: Vec<Column>,
}

/// A picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// What the source shows here, in words.
    pub source_says: String,
    /// Label of the axis, with unit.
    pub x_label: String,
    /// Label of the axis, with unit.
    pub y_label: String,
    /// True for a logarithmic axis.
    pub log_x: bool,
    /// True for a logarithmic axis.
    pub log_y: bool,
    /// Curves and points.
    pub series: Vec<Series>,
}

/// One curve of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Its label.
    pub label: String,
    /// Where it comes from.
    pub kind: Kind,
    /// Points x, y.
    #[serde(with = "number_format::points")]
    pub points: Vec<[f64; 2]>,
    /// Standard deviation of each y; empty without.
    #[serde(with = "number_format::many")]
    pub deviations: Vec<f64>,
}

/// Where a curve comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Measured: a line.
    Line,
    /// Measured: points.
    Points,
    /// An analytic reference: dashed.
    Analytic,
    /// Read from the source: hollow points.
    Source,
}

/// A measured value beside its oracle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Stable name, `C9.holding_force_falls`.
    pub id: String,
    /// What is measured.
    pub quantity: String,
    /// Unit, `1` without one.
    pub unit: String,
    /// Expected value.
    #[serde(with = "number_format::one")]
    pub oracle: f64,
    /// Where it comes from: law, paper with figure or table, computation.
    pub oracle_source: String,
    /// How measured and oracle must relate.
    pub relation: Relation,
    /// Allowed distance from the oracle; 0 where the relation is a bound.
    #[serde(with = "number_format::one")]
    pub tolerance: f64,
    /// What came out.
    #[serde(with = "number_format::one")]
    pub measured: f64,
    /// True if the relation holds.
    pub pass: bool,
    /// Why the tolerance is what it is; where the row fails, the most likely cause.
    pub reason: String,
}

/// How a measured value must relate to its oracle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relation {
    /// Not further away than the tolerance.
    Within,
    /// Not below.
    AtLeast,
    /// Not above.
    AtMost,
}

/// What is expected of a quantity.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// The oracle.
    pub oracle: f64,
    /// How measured and oracle must relate.
    pub relation: Relation,
    /// Allowed distance.
    pub tolerance: f64,
}

impl Expected {
    /// `oracle` ± `tolerance`.
    pub const fn within(oracle: f64, tolerance: f64) -> Self {
        Self { oracle, relation: Relation::Within, tolerance }
    }

    /// Between two values.
    pub const fn between(low: f64, high: f64) -> Self {
        Self::within(0.5 * (low + high), 0.5 * (high - low))
    }

    /// At least `bound`.
    pub const fn at_least(bound: f64) -> Self {
        Self { oracle: bound, relation: Relation::AtLeast, tolerance: 0.0 }
    }

    /// At most `bound`.
    pub const fn at_most(bound: f64) -> Self {
        Self { oracle: bound, relation: Relation::AtMost, tolerance: 0.0 }
    }

    /// True if `measured` is as expected; never for what is no finite number.
    pub fn holds(&self, measured: f64) -> bool {
        let is_related = match self.relation {
            Relation::Within => (measured - self.oracle).abs() <= self.tolerance,
            Relation::AtLeast => measured >= self.oracle,
            Relation::AtMost => measured <= self.oracle,
        };
        measured.is_finite() && is_related
    }
}

/// The words of a row.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// Stable name.
    pub id: &'a str,
    /// What is measured.
    pub quantity: &'a str,
    /// Unit, `1` without one.
    pub unit: &'a str,
    /// Where the oracle comes from.
    pub oracle: &'a str,
    /// Why the tolerance is what it is.
    pub reason: &'a str,
}

impl Row {
    /// Judges `measured`.
    pub fn new(told: &Report<'_>, expected: Expected, measured: f64) -> Self {
        Self {
            id: told.id.to_owned(),
            quantity: told.quantity.to_owned(),
            unit: told.unit.to_owned(),
            oracle: expected.oracle,
            oracle_source: told.oracle.to_owned(),
            relation: expected.relation,
            tolerance: expected.tolerance,
            measured,
            pass: expected.holds(measured),
            reason: told.reason.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definitions of the relations.
    #[test]
    fn relations_judge_as_they_say_and_never_pass_what_is_no_number() {
        assert!(Expected::between(1.0, 2.0).holds(1.0) && Expected::between(1.0, 2.0).holds(2.0));
        assert!(!Expected::between(1.0, 2.0).holds(2.1));
        assert!(Expected::at_least(1.0).holds(1.0) && !Expected::at_least(1.0).holds(0.9));
        assert!(Expected::at_most(1.0).holds(1.0) && !Expected::at_most(1.0).holds(1.1));
        for expected in
            [Expected::within(0.0, 1.0), Expected::at_least(0.0), Expected::at_most(0.0)]
        {
            assert!(!expected.holds(f64::NAN) && !expected.holds(f64::INFINITY));
            assert!(!expected.holds(f64::NEG_INFINITY));
        }
    }
}
