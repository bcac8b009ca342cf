//! Findings of an experiment: quantities with units, curves, plots, and rows that compare a
//! measured value with its oracle, the value it must have.

use serde::{Deserialize, Serialize};

use super::{number_format, record::Column};
use crate::base::real::real;

/// All findings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// Named results.
    pub quantities: Vec<Quantity>,
    /// Tables, one CSV file each.
    pub curves: Vec<Curve>,
    /// Plots of the report.
    pub plots: Vec<Plot>,
    /// Measured values compared with expected ones.
    pub rows: Vec<Row>,
    /// Notes for the reader.
    pub notes: Vec<String>,
}

impl Findings {
    /// Compares `measured` with what is expected; `None` adds a note instead of a row.
    pub fn check(&mut self, text: &RowText<'_>, expected: Expected, measured: Option<f64>) {
        match measured {
            Some(measured) => self.rows.push(Row::new(text, expected, measured)),
            None => {
                self.notes
                    .push(format!("{} is left out: its cases were not run or failed", text.id));
            }
        }
    }
}

/// A named result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// Name, `holding_force_5MPa`.
    pub name: String,
    /// What it means.
    pub meaning: String,
    /// Its value.
    #[serde(with = "number_format::one")]
    pub value: f64,
    /// Standard deviation over repetitions, if there are any.
    pub deviation: Option<f64>,
    /// Number of repetitions.
    pub n: usize,
    /// Unit, `1` if dimensionless.
    pub unit: String,
}

impl Quantity {
    /// A single value.
    pub fn new(name: &str, meaning: &str, value: f64, unit: &str) -> Self {
        let (name, meaning, unit) = (name.to_owned(), meaning.to_owned(), unit.to_owned());
        Self { name, meaning, value, deviation: None, n: 1, unit }
    }
}

/// Mean, standard deviation and number of values.
#[derive(Clone, Copy, Debug)]
pub struct Mean {
    /// The mean.
    pub value: f64,
    /// Standard deviation of the values; `None` of a single one.
    pub deviation: Option<f64>,
    /// Number of values.
    pub n: usize,
}

impl Mean {
    /// Mean of `values`; `None` if there are none.
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

    /// Standard error of the mean; zero for a single value.
    pub fn error(&self) -> f64 {
        self.deviation.map_or(0.0, |it| it / real(self.n).sqrt())
    }
}

/// A table, one CSV file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name of the file without its extension.
    pub name: String,
    /// Columns of equal length.
    pub columns: Vec<Column>,
}

/// A plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// What the source shows here.
    pub source_says: String,
    /// Label of the x axis, with unit.
    pub x_label: String,
    /// Label of the y axis, with unit.
    pub y_label: String,
    /// True if the x axis is logarithmic.
    pub log_x: bool,
    /// True if the y axis is logarithmic.
    pub log_y: bool,
    /// Curves and points.
    pub series: Vec<Series>,
}

impl Plot {
    /// A plot with linear axes; `labels` are those of x and y, with units.
    pub fn new(title: &str, source_says: &str, labels: [&str; 2], series: Vec<Series>) -> Self {
        let [x_label, y_label] = labels.map(str::to_owned);
        let (title, source_says) = (title.to_owned(), source_says.to_owned());
        Self { title, source_says, x_label, y_label, log_x: false, log_y: false, series }
    }

    /// The same plot with logarithmic axes where `log_x`, `log_y` are true.
    #[must_use]
    pub fn with_logs(self, [log_x, log_y]: [bool; 2]) -> Self {
        Self { log_x, log_y, ..self }
    }
}

/// One curve of a plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Its label.
    pub label: String,
    /// Where its points come from.
    pub kind: Kind,
    /// Points x, y.
    #[serde(with = "number_format::points")]
    pub points: Vec<[f64; 2]>,
    /// Standard deviation of each y; may be empty.
    #[serde(with = "number_format::many")]
    pub deviations: Vec<f64>,
}

impl Series {
    /// Points without standard deviations.
    pub fn new(label: &str, kind: Kind, points: Vec<[f64; 2]>) -> Self {
        Self { label: label.to_owned(), kind, points, deviations: Vec::new() }
    }
}

/// Where the points of a series come from, and how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Measured, drawn as a line.
    Line,
    /// Measured, drawn as points.
    Points,
    /// An analytic reference, drawn dashed.
    Analytic,
    /// Read from the source, drawn as hollow points.
    Source,
}

/// A measured value and its oracle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Stable name, `C9.holding_force_falls`.
    pub id: String,
    /// What is measured.
    pub quantity: String,
    /// Unit, `1` if dimensionless.
    pub unit: String,
    /// Expected value.
    #[serde(with = "number_format::one")]
    pub oracle: f64,
    /// Where the expected value comes from: law, paper with figure or table, computation.
    pub oracle_source: String,
    /// How the measured value must relate to the oracle.
    pub relation: Relation,
    /// Allowed difference from the oracle; 0 if the relation is a bound.
    #[serde(with = "number_format::one")]
    pub tolerance: f64,
    /// Measured value.
    #[serde(with = "number_format::one")]
    pub measured: f64,
    /// True if the relation holds.
    pub pass: bool,
    /// Why the tolerance has its value; if the row fails, the most likely cause.
    pub reason: String,
}

/// How a measured value must relate to its oracle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Relation {
    /// Differs by at most the tolerance.
    Within,
    /// Is not below.
    AtLeast,
    /// Is not above.
    AtMost,
}

/// What is expected of a quantity.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// The oracle.
    pub oracle: f64,
    /// How the measured value must relate to the oracle.
    pub relation: Relation,
    /// Allowed difference.
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

    /// True if `measured` is as expected; never true of NaN or infinity.
    pub fn holds(&self, measured: f64) -> bool {
        let is_related = match self.relation {
            Relation::Within => (measured - self.oracle).abs() <= self.tolerance,
            Relation::AtLeast => measured >= self.oracle,
            Relation::AtMost => measured <= self.oracle,
        };
        measured.is_finite() && is_related
    }
}

/// The texts of a row.
#[derive(Clone, Copy, Debug)]
pub struct RowText<'a> {
    /// Stable name.
    pub id: &'a str,
    /// What is measured.
    pub quantity: &'a str,
    /// Unit, `1` if dimensionless.
    pub unit: &'a str,
    /// Where the oracle comes from.
    pub oracle: &'a str,
    /// Why the tolerance has its value.
    pub reason: &'a str,
}

impl Row {
    /// Compares `measured` with what is expected.
    pub fn new(text: &RowText<'_>, expected: Expected, measured: f64) -> Self {
        Self {
            id: text.id.to_owned(),
            quantity: text.quantity.to_owned(),
            unit: text.unit.to_owned(),
            oracle: expected.oracle,
            oracle_source: text.oracle.to_owned(),
            relation: expected.relation,
            tolerance: expected.tolerance,
            measured,
            pass: expected.holds(measured),
            reason: text.reason.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definitions of the relations.
    #[test]
    fn relations_hold_as_defined_and_never_for_nan_or_infinity() {
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
