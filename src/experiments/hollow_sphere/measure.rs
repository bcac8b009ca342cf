//! Quantities of a packing: while it runs, and from the records of a kind of packing.

use super::{
    cases::{self, Case},
    scene::HollowSphereScene,
};
use crate::{
    base::Real,
    experiments::{
        findings::{Mean, Quantity},
        record::Record,
    },
    physics::System,
};

/// Pressure of the membrane on the object: the sum of its radial forces over the surface (Pa).
pub(super) fn object_pressure(system: &System, radius: Real) -> Real {
    let radial: Real = (system.scratch.sample_forces.iter())
        .filter(|sample| sample.flags.touches())
        .map(|sample| sample.force.dot(&sample.point.normalize()))
        .sum();
    radial / (4.0 * std::f64::consts::PI * radius.powi(2))
}

/// A kind of packing with the records of its repetitions.
pub(super) struct Group<'a> {
    pub(super) case: Case,
    pub(super) records: Vec<&'a Record>,
}

/// The records, grouped by kind of packing.
pub(super) fn groups<'a>(scene: &HollowSphereScene, records: &'a [Record]) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    for case in cases::cases(scene) {
        let Some(record) = records.iter().find(|it| it.case == case.name) else { continue };
        let same = |it: &&mut Group<'_>| {
            Case { filling: 0, name: String::new(), ..it.case.clone() }
                == Case { filling: 0, name: String::new(), ..case.clone() }
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.records.push(record),
            None => groups.push(Group { case, records: vec![record] }),
        }
    }
    groups
}

impl Group<'_> {
    /// Mean of the pressure on the object under full vacuum, and its standard deviation (Pa).
    pub(super) fn pressure(&self) -> (f64, f64) {
        self.of(|record| last(record, "object_pressure"))
    }

    /// Mean and standard deviation of `value` over the repetitions.
    pub(super) fn of(&self, value: impl Fn(&Record) -> f64) -> (f64, f64) {
        let values: Vec<f64> = self.records.iter().map(|it| value(it)).collect();
        let mean = Mean::new(&values);
        mean.map_or((f64::NAN, 0.0), |it| (it.value, it.deviation.unwrap_or(0.0)))
    }

    /// Description of the grains.
    pub(super) fn label(&self) -> String {
        cases::modulus_text(self.case.modulus) + self.case.kind.description()
    }

    /// The pressure on the object as a quantity.
    pub(super) fn quantity(&self) -> Quantity {
        let (value, deviation) = self.pressure();
        let modulus = cases::modulus_text(self.case.modulus);
        Quantity {
            name: format!("object_pressure_{modulus}{}", self.case.kind.suffix()),
            meaning: format!(
                "pressure on the object under full vacuum, grains of {}",
                self.label()
            ),
            value,
            deviation: (self.records.len() > 1).then_some(deviation),
            n: self.records.len(),
            unit: "Pa".to_owned(),
        }
    }
}

/// The last value of a column.
pub(super) fn last(record: &Record, column: &str) -> f64 {
    record.column(column).and_then(|it| it.last().copied()).unwrap_or(f64::NAN)
}
