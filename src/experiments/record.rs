//! What a case leaves: columns of numbers over time, named numbers, and how far the run kept
//! within the validity of the model.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::number_format;

/// A list of numbers with a name and a unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Name, as in the head of a CSV file.
    pub name: String,
    /// Unit, `1` without one.
    pub unit: String,
    /// The numbers.
    #[serde(with = "number_format::many")]
    pub values: Vec<f64>,
}

impl Column {
    /// An empty column.
    pub fn new(name: &str, unit: &str) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), values: Vec::new() }
    }
}

/// A number with a name and a unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scalar {
    /// Its value.
    #[serde(with = "number_format::one")]
    pub value: f64,
    /// Its unit, `1` without one.
    pub unit: String,
}

/// The record of one case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Name of the case.
    pub case: String,
    /// Seed of its random numbers.
    pub seed: u64,
    /// Columns of equal length, the first is what the others are plotted over.
    pub columns: Vec<Column>,
    /// Further tables by name, each with columns of equal length.
    #[serde(default)]
    pub tables: BTreeMap<String, Vec<Column>>,
    /// Single numbers by name.
    pub scalars: BTreeMap<String, Scalar>,
    /// How far the run kept within the validity of the model.
    pub validity: Validity,
    /// Digest of the state at the end.
    pub digest: u64,
    /// Substeps of each stage.
    pub n_substeps: BTreeMap<String, u64>,
    /// Time on the clock of each stage, on one thread (s). Written by whoever runs the case.
    pub wall_s: BTreeMap<String, f64>,
}

impl Record {
    /// The column of this name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|it| it.name == name).map(|it| it.values.as_slice())
    }

    /// The column `name` of the further table `table`.
    pub fn table_column(&self, table: &str, name: &str) -> Option<&[f64]> {
        let columns = self.tables.get(table)?;
        columns.iter().find(|it| it.name == name).map(|it| it.values.as_slice())
    }

    /// The number of this name.
    pub fn scalar(&self, name: &str) -> Option<f64> {
        self.scalars.get(name).map(|it| it.value)
    }

    /// Adds `n` substeps of `stage`.
    pub fn count(&mut self, stage: &str, n: u64) {
        *self.n_substeps.entry(stage.to_owned()).or_default() += n;
    }

    /// Sets a number.
    pub fn set(&mut self, name: &str, value: f64, unit: &str) {
        self.scalars.insert(name.to_owned(), Scalar { value, unit: unit.to_owned() });
    }
}

/// Largest overlap over diameter at which the contact law is still believed.
pub const OVERLAP_LIMIT: f64 = 0.1;
/// Largest inertial number of a quasi-static stage.
pub const INERTIAL_LIMIT: f64 = 1e-3;
/// Largest unbalanced force over mean contact force of a state called at rest.
pub const UNBALANCED_LIMIT: f64 = 1e-2;

/// What a run saw of the limits of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Validity {
    /// Largest overlap between two grains over their mean diameter.
    #[serde(with = "number_format::one")]
    pub overlap_over_diameter_max: f64,
    /// Grains that left the membrane.
    pub n_leaked: u64,
    /// Mean unbalanced force over mean contact force where the run claims rest.
    #[serde(with = "number_format::one")]
    pub unbalanced_force: f64,
    /// Largest inertial number of the stages that claim to be quasi-static.
    #[serde(with = "number_format::one")]
    pub inertial_number_max: f64,
}

impl Validity {
    /// What left validity, in words; empty if nothing did.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut check = |value: f64, limit: f64, what: &str| {
            if value > limit || value.is_nan() {
                faults.push(format!("{what} reached {value:.2e}, beyond {limit:.0e}"));
            }
        };
        check(self.overlap_over_diameter_max, OVERLAP_LIMIT, "overlap over diameter");
        check(self.unbalanced_force, UNBALANCED_LIMIT, "unbalanced force");
        check(self.inertial_number_max, INERTIAL_LIMIT, "inertial number");
        if self.n_leaked > 0 {
            faults.push(format!("{} grains left the membrane", self.n_leaked));
        }
        faults
    }

    /// The worse of both in every respect.
    pub fn join(&mut self, other: &Self) {
        let worse = |a: &mut f64, b: f64| *a = if b > *a || b.is_nan() { b } else { *a };
        worse(&mut self.overlap_over_diameter_max, other.overlap_over_diameter_max);
        worse(&mut self.unbalanced_force, other.unbalanced_force);
        worse(&mut self.inertial_number_max, other.inertial_number_max);
        self.n_leaked = self.n_leaked.max(other.n_leaked);
    }
}
