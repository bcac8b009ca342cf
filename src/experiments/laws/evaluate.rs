//! Evaluation of the laws: rows, tables and plots.

use super::{LAWS, scene::LawsScene};
use crate::experiments::{
    findings::{Curve, Expected, Findings, Row, RowText},
    record::Record,
};

/// A row that compares the scalar with its id: id, quantity, oracle, what is expected, reason.
pub(super) type RowSpec = (&'static str, &'static str, &'static str, Expected, &'static str);

/// All findings.
pub(super) fn findings(scene: &LawsScene, records: &[Record]) -> Findings {
    let mut findings = Findings::default();
    for law in LAWS {
        let Some(record) = records.iter().find(|record| record.case == law.name()) else {
            findings.notes.push(format!("{}: no record, so no rows", law.name()));
            continue;
        };
        let mut complete = record.clone();
        law.complete(scene, &mut complete);
        for (id, quantity, oracle, expected, reason) in law.rows() {
            let text = RowText { id, quantity, unit: "1", oracle, reason };
            let measured = complete.scalar(id).unwrap_or(f64::NAN);
            findings.rows.push(Row::new(&text, *expected, measured));
        }
        let columns = || record.columns.clone();
        let table = law.table().map(|name| Curve { name: name.to_owned(), columns: columns() });
        findings.curves.extend(table);
        findings.plots.extend(law.plot(scene, record));
    }
    findings
}
