//! The experiment `laws`: every row passes, and a resumed case continues with the same bits.
#![expect(clippy::print_stderr, reason = "measured values are shown with the result")]

use super::super::{EXPERIMENTS, Plan, SceneText, Size, record::Record};

/// The plan of the built-in scene.
fn plan() -> Box<dyn Plan> {
    let laws = EXPERIMENTS.iter().find(|it| it.name() == "laws").unwrap();
    let (source, text) = laws.scene();
    laws.read(&SceneText { text, source, overrides: &[], size: Size::Quick }).unwrap()
}

fn run(plan: &dyn Plan, case: &str) -> Record {
    let mut run = plan.start(case).unwrap();
    while !run.advance().unwrap().is_done {}
    run.record()
}

#[test]
fn every_law_matches_its_closed_form() {
    let plan = plan();
    let mut records = Vec::new();
    for case in plan.cases() {
        records.push(run(&*plan, &case));
    }
    let findings = plan.evaluate(&records);
    for row in &findings.rows {
        let (measured, oracle, tolerance) = (row.measured, row.oracle, row.tolerance);
        let verdict = if row.pass { "ok " } else { "FAIL" };
        eprintln!("{verdict} {}: {measured:.6e}, {oracle:.6e} ± {tolerance:.1e}", row.id);
    }
    // Oracle and reason of each tolerance are in the rows.
    let failed: Vec<&str> =
        findings.rows.iter().filter(|row| !row.pass).map(|row| row.id.as_str()).collect();
    assert!(failed.is_empty(), "{failed:?}");
    assert!(findings.rows.len() > 40 && findings.notes.is_empty(), "{:?}", findings.notes);
}

#[test]
fn a_resumed_case_continues_with_the_same_bits() {
    let plan = plan();
    let uninterrupted = run(&*plan, "inflation");
    let mut first = plan.start("inflation").unwrap();
    first.advance().unwrap();
    first.advance().unwrap();
    let saved = first.save();
    let mut second = plan.start("inflation").unwrap();
    second.resume(&saved).unwrap();
    while !second.advance().unwrap().is_done {}
    // Oracle: the uninterrupted run, bit for bit.
    assert_eq!(second.record(), uninterrupted);
    assert!(
        plan.start("impact").unwrap().resume(&saved).is_err(),
        "a saved run of another case is rejected"
    );
}
