//! How a measured point enters the record.

use crate::experiments::record::{Column, Record};

/// Adds a value to the column `name`.
pub(super) fn push(record: &mut Record, name: &str, unit: &str, value: f64) {
    let index = record.columns.iter().position(|it| it.name == name).unwrap_or_else(|| {
        record.columns.push(Column::new(name, unit));
        record.columns.len() - 1
    });
    record.columns[index].values.push(value);
}

/// Sets the scalar `name` to the absolute `deviation` if that is larger; NaN is larger than any
/// number.
pub(super) fn worst(record: &mut Record, name: &str, deviation: f64) {
    let so_far = record.scalar(name).unwrap_or(0.0);
    let is_larger = deviation.abs() > so_far || deviation.is_nan();
    record.set(name, if is_larger { deviation.abs() } else { so_far }, "1");
}
