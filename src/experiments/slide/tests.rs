//! The experiment itself, over a shorter distance.

use super::{super::Size, cases::Direction, *};

fn plan(overrides: &[&str]) -> Box<dyn Plan> {
    let overrides: Vec<String> = overrides.iter().map(|it| (*it).to_owned()).collect();
    let (source, text) = Slide.scene();
    let scene = SceneText { text, source, overrides: &overrides, size: Size::Quick };
    Slide.read(&scene).unwrap_or_else(|error| panic!("{error}"))
}

fn finish(mut run: Box<dyn Run>) -> Record {
    while !run.advance().unwrap().is_done {}
    run.record()
}

/// Oracles: those of the rows. Every tolerance is theirs.
#[test]
fn every_row_of_a_short_slide_is_as_expected() {
    let plan = plan(&["length=14 mm"]);
    let records: Vec<Record> =
        plan.cases().iter().map(|case| finish(plan.start(case).unwrap())).collect();
    let findings = plan.evaluate(&records);
    assert_eq!(findings.rows.len(), 21, "rows of all cases");
    let failed: Vec<&str> =
        findings.rows.iter().filter(|row| !row.pass).map(|row| row.id.as_str()).collect();
    // A membrane that is free to bend forms facets: the only difference from the source.
    assert_eq!(failed, ["C8.framed_ripple"], "{:#?}", findings.rows);
    assert!(findings.notes.iter().all(|it| it.starts_with("triangles_heavy: overlap")));
    assert_eq!(findings.plots.len(), 8);
}

/// Oracle: the uninterrupted run, to the last bit. The interruption is after the ball was set back.
#[test]
fn a_resumed_run_equals_an_uninterrupted_one() {
    for case in ["spheres_skew", "triangles_framed"] {
        let plan = plan(&["length=14 mm"]);
        let uninterrupted = finish(plan.start(case).unwrap());
        let mut first = plan.start(case).unwrap();
        for _ in 0..4 {
            first.advance().unwrap();
        }
        let mut second = plan.start(case).unwrap();
        second.resume(&first.save()).unwrap();
        assert_eq!(finish(second), uninterrupted);
        let mut other = plan.start("triangles_rows").unwrap();
        assert!(other.resume(&first.save()).is_err(), "another case is rejected");
        assert!(other.resume(b"nothing").is_err());
    }
}

/// Oracle: the same path over a patch so long that nothing is set back. Tolerance: rounding of
/// positions of 10 mm, in forces from overlaps of 0.1 mm.
#[test]
fn setting_back_by_a_period_changes_nothing() {
    let overrides = ["length=14 mm".to_owned()];
    let (source, text) = Slide.scene();
    let text = SceneText { text, source, overrides: &overrides, size: Size::Quick };
    let scene: SlideScene = text::read(&text.layers(false)).unwrap();
    for (name, far) in [("spheres_rows", Direction(11, 0)), ("triangles_skew", Direction(8, 4))] {
        let case = cases(&scene).into_iter().find(|case| case.name == name).unwrap();
        let short = finish(Box::new(SlideRun::new(&scene, case).unwrap()));
        let long =
            finish(Box::new(SlideRun::new(&scene, Case { direction: far, ..case }).unwrap()));
        for (a, b) in short.columns.iter().zip(&long.columns).take(3) {
            let scale = a.values.iter().copied().fold(0.0, f64::max);
            for (a, b) in a.values.iter().zip(&b.values) {
                assert!((a - b).abs() < 1e-9 * scale, "{name}: {a} {b}");
            }
        }
    }
}

/// Oracle: the texts of the errors.
#[test]
fn impossible_scenes_are_rejected() {
    let overrides = ["frame.length=15 mm".to_owned(), "length=5 mm".to_owned()];
    let (source, text) = Slide.scene();
    let scene = SceneText { text, source, overrides: &overrides, size: Size::Quick };
    let error = Slide.read(&scene).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("frame.length") && error.contains("leaves the frame"), "{error}");
    assert!(error.contains("ten edges"), "{error}");
}
