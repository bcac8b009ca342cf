//! The record of a case: columns of numbers over time, named numbers, and whether the run stayed
//! within the validity of the model.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::number_format;

/// A list of numbers with a name and a unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Name, as in the header of a CSV file.
    pub name: String,
    /// Unit, `1` if dimensionless.
    pub unit: String,
    /// The values.
    #[serde(with = "number_format::many")]
    pub values: Vec<f64>,
}

impl Column {
    /// Creates an empty column.
    pub fn new(name: &str, unit: &str) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), values: Vec::new() }
    }
}

/// A number with a name and a unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scalar {
    /// Value.
    #[serde(with = "number_format::one")]
    pub value: f64,
    /// Unit, `1` if dimensionless.
    pub unit: String,
}

/// The record of one case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name of the case.
    pub case: String,
    /// Seed of its random numbers.
    pub seed: u64,
    /// Columns of equal length; the others are plotted over the first.
    pub columns: Vec<Column>,
    /// Further tables by name, each with columns of equal length.
    #[serde(default)]
    pub tables: BTreeMap<String, Vec<Column>>,
    /// Single numbers by name.
    pub scalars: BTreeMap<String, Scalar>,
    /// Extremes that decide whether the run stayed within the validity of the model.
    pub validity: Validity,
    /// Digest of the state at the end.
    pub digest: u64,
    /// Number of substeps of each phase.
    pub n_substeps: BTreeMap<String, u64>,
    /// Wall-clock time of each phase on one thread (s), set by the runner.
    pub wall_s: BTreeMap<String, f64>,
}

impl Record {
    /// Values of the column with this name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|it| it.name == name).map(|it| it.values.as_slice())
    }

    /// Values of the column `name` of the further table `table`.
    pub fn table_column(&self, table: &str, name: &str) -> Option<&[f64]> {
        let columns = self.tables.get(table)?;
        columns.iter().find(|it| it.name == name).map(|it| it.values.as_slice())
    }

    /// Adds a row: one value for each column.
    pub fn push_row(&mut self, row: &[f64]) {
        for (column, &value) in self.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
    }

    /// Points (x, y) from two columns; none if one of them is missing.
    pub fn points(&self, x: &str, y: &str) -> Vec<[f64; 2]> {
        let (x, y) = (self.column(x).unwrap_or_default(), self.column(y).unwrap_or_default());
        x.iter().zip(y).map(|(&x, &y)| [x, y]).collect()
    }

    /// The number with this name.
    pub fn scalar(&self, name: &str) -> Option<f64> {
        self.scalars.get(name).map(|it| it.value)
    }

    /// Adds `n` substeps of `phase`.
    pub fn count(&mut self, phase: &str, n: u64) {
        *self.n_substeps.entry(phase.to_owned()).or_default() += n;
    }

    /// Sets a number.
    pub fn set(&mut self, name: &str, value: f64, unit: &str) {
        self.scalars.insert(name.to_owned(), Scalar { value, unit: unit.to_owned() });
    }
}

/// Largest overlap over diameter at which the contact law is valid.
pub const OVERLAP_LIMIT: f64 = 0.1;
/// Largest inertial number of a quasi-static phase.
pub const INERTIAL_LIMIT: f64 = 1e-3;
/// Largest unbalanced force over mean contact force of a state at rest.
pub const UNBALANCED_LIMIT: f64 = 1e-2;

/// Extremes of a run, to be compared with the limits of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Validity {
    /// Largest overlap between two grains over their mean diameter.
    #[serde(with = "number_format::one")]
    pub overlap_over_diameter_max: f64,
    /// Grains that left the membrane.
    pub n_leaked: u64,
    /// Mean unbalanced force over mean contact force in states at rest.
    #[serde(with = "number_format::one")]
    pub unbalanced_force: f64,
    /// Largest inertial number of the quasi-static phases.
    #[serde(with = "number_format::one")]
    pub inertial_number_max: f64,
}

impl Validity {
    /// Descriptions of all exceeded limits.
    pub fn violations(&self) -> Vec<String> {
        let mut violations = Vec::new();
        let mut check = |value: f64, limit: f64, what: &str| {
            if value > limit || value.is_nan() {
                violations.push(format!("{what} reached {value:.2e}, above the limit {limit:.0e}"));
            }
        };
        check(self.overlap_over_diameter_max, OVERLAP_LIMIT, "overlap over diameter");
        check(self.unbalanced_force, UNBALANCED_LIMIT, "unbalanced force");
        check(self.inertial_number_max, INERTIAL_LIMIT, "inertial number");
        if self.n_leaked > 0 {
            violations.push(format!("{} grains left the membrane", self.n_leaked));
        }
        violations
    }

    /// Takes the worse value of both for each extreme.
    pub fn join(&mut self, other: &Self) {
        let worse = |a: &mut f64, b: f64| *a = if b > *a || b.is_nan() { b } else { *a };
        worse(&mut self.overlap_over_diameter_max, other.overlap_over_diameter_max);
        worse(&mut self.unbalanced_force, other.unbalanced_force);
        worse(&mut self.inertial_number_max, other.inertial_number_max);
        self.n_leaked = self.n_leaked.max(other.n_leaked);
    }
}
