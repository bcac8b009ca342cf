//! The gripper experiment with an eighth of the grains: phases, holding force with and without vacuum,
//! and runs that are interrupted and resumed.

use std::sync::OnceLock;

use jamgrip::experiments::{
    Experiment, Plan, Run, SceneText, Size, findings::Findings, gripper::Gripper, record::Record,
};

/// Grains twice as large, a mesh twice as coarse, an object larger by half, and fast motions.
const COARSE: [&str; 14] = [
    "membrane.frequency=8",
    "grains.count=525",
    "grains.radius_min=3.8 mm",
    "grains.radius_max=4.2 mm",
    "grains.youngs_modulus=10 MPa",
    "object.radius=12 mm",
    "protocol.relax_time=30 ms",
    "protocol.pressure_steps=4",
    "sweep.moduli=[10 MPa]",
    "sweep.pressures=[0 kPa]",
    "sweep.frictions=[]",
    "sweep.radii=[]",
    "sweep.spring_dampings=[]",
    "sweep.slowdowns=[]",
];
const CASE: &str = "modulus_10MPa_filling_0";

fn plan() -> Box<dyn Plan> {
    let (source, text) = Gripper.scene();
    let overrides = COARSE.map(str::to_owned);
    let scene = SceneText { text, source, overrides: &overrides, size: Size::Quick };
    Gripper.read(&scene).unwrap()
}

/// Runs a case to its end. Whenever `is_break` is true after a slice, a new run resumes the case.
fn run(plan: &dyn Plan, mut is_break: impl FnMut(usize, &str) -> bool) -> Record {
    let mut run: Box<dyn Run> = plan.start(CASE).unwrap();
    for slice in 0.. {
        let progress = run.advance().unwrap();
        if progress.is_done {
            break;
        }
        if is_break(slice, progress.phase) {
            let bytes = run.save();
            run = plan.start(CASE).unwrap();
            run.resume(&bytes).unwrap();
        }
    }
    run.record()
}

/// The uninterrupted case, computed once.
fn uninterrupted() -> &'static Record {
    static RECORD: OnceLock<Record> = OnceLock::new();
    RECORD.get_or_init(|| run(&*plan(), |_, _| false))
}

fn column(name: &str) -> &'static [f64] {
    uninterrupted().column(name).unwrap()
}

#[test]
fn the_phases_are_in_order_and_the_object_moves_as_prescribed() {
    let (grip, phase) = (column("grip"), column("phase"));
    let of_first = grip.iter().filter(|it| **it < 0.5).count();
    assert!(phase[..of_first].is_sorted() && phase[of_first..].is_sorted());
    assert!(phase[0] < 0.5 && (phase[of_first - 1] - 4.0).abs() < 0.5, "insert to withdraw");
    assert!((phase[of_first] - 2.0).abs() < 0.5, "the second grip starts with the evacuation");
    // Oracle: the protocol's penetration; the pump's lag of 5 ms leaves e^(-42/5) of a step.
    let depth = column("penetration").iter().copied().fold(f64::MIN, f64::max);
    assert!((depth - 28e-3).abs() < 1e-9, "{depth}");
    let lowest = column("gauge").iter().copied().fold(f64::MAX, f64::min);
    assert!((lowest + 90e3).abs() < 10.0, "{lowest}");
}

#[test]
fn the_gripper_holds_only_with_vacuum() {
    let of = |grip: &str| uninterrupted().scalar(&format!("{grip}.holding_force")).unwrap();
    let (with, without) = (of("protocol"), of("pressure_0kPa"));
    // Oracle: the holding force of a jammed gripper against one that is not. A tenth, because the
    // pre-tension of the membrane is equivalent to about a tenth of the vacuum.
    assert!(with > 0.2, "{with}");
    assert!(without < 0.1 * with, "{without} of {with}");
    let push = uninterrupted().scalar("protocol.force_relaxed").unwrap();
    assert!(push < -5.0, "pushed down by the gripper: {push}");
}

#[test]
fn an_interrupted_and_resumed_case_gives_the_same_bits() {
    // Oracle: the uninterrupted case. Interrupted early in the filling, during it, and in every phase.
    let mut last = String::new();
    let mut n_breaks = 0;
    let resumed = run(&*plan(), |slice, stage| {
        let is_new = last != stage;
        stage.clone_into(&mut last);
        let is_break = is_new || slice == 7;
        n_breaks += usize::from(is_break);
        is_break
    });
    assert!(n_breaks >= 9, "{n_breaks}");
    assert_eq!(resumed.digest, uninterrupted().digest);
    assert!(resumed == *uninterrupted(), "the same record, not only the same final state");
}

#[test]
fn a_saved_case_is_rejected_by_another_one() {
    let plan = plan();
    let mut run = plan.start(CASE).unwrap();
    run.advance().unwrap();
    let bytes = run.save();
    let (source, text) = Gripper.scene();
    let mut overrides = COARSE.map(str::to_owned).to_vec();
    overrides.push("grains.count=500".to_owned());
    let scene = SceneText { text, source, overrides: &overrides, size: Size::Quick };
    let mut other = Gripper.read(&scene).unwrap().start(CASE).unwrap();
    assert!(other.resume(&bytes).unwrap_err().to_string().contains("another scene"));
    assert!(run.resume(&bytes[..bytes.len() / 2]).unwrap_err().to_string().contains("damaged"));
}

#[test]
fn findings_list_missing_cases_and_evaluate_the_others() {
    let findings: Findings = plan().evaluate(std::slice::from_ref(uninterrupted()));
    let row = |id: &str| findings.rows.iter().find(|row| row.id == id);
    assert!(row("C9.fig11_zero").unwrap().pass, "{:?}", row("C9.fig11_zero"));
    assert!(row("C9.no_vacuum").unwrap().pass, "{:?}", row("C9.no_vacuum"));
    assert!(findings.plots.iter().any(|plot| plot.title.contains("Fig. 11")));
    let nothing = plan().evaluate(&[]);
    assert!(nothing.rows.is_empty(), "{:?}", nothing.rows);
    assert!(nothing.notes.iter().any(|note| note.contains("C9.fig11_push is left out")));
}
