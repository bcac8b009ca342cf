//! The hollow sphere, coarse: pressure on the object, and a run that is interrupted and resumed.

use jamgrip::{
    base::parallel,
    experiments::{Experiment, Plan, Record, Run, SceneText, Size, hollow_sphere::HollowSphere},
};

/// A shell of large grains between coarse membranes.
const COARSE: &[&str] = &[
    "grains.count=590",
    "grains.radius_min=3.8 mm",
    "grains.radius_max=4.2 mm",
    "membrane.frequency=8",
    "inner.frequency=3",
    "inner.clearance=0.3 mm",
    "protocol.n_levels=2",
    "protocol.close_time=80 ms",
    "protocol.rest_time=10 ms",
    "protocol.level_time=20 ms",
    "sweep.youngs_moduli=[5 MPa]",
    "sweep.frictionless=[]",
];

fn plan() -> Box<dyn Plan> {
    let (source, text) = HollowSphere.scene();
    let overrides: Vec<String> = COARSE.iter().map(|it| (*it).to_owned()).collect();
    HollowSphere
        .read(&SceneText { text, source, overrides: &overrides, size: Size::Quick })
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Advances up to `n_slices`; true at the end.
fn advance(run: &mut Box<dyn Run>, n_slices: usize) -> bool {
    let pool = parallel::ThreadPool::new(1).unwrap();
    (0..n_slices).any(|_| parallel::lead(&pool, || run.advance()).unwrap().is_done)
}

fn end(mut run: Box<dyn Run>) -> Record {
    assert!(advance(&mut run, 1_000_000));
    run.record()
}

#[test]
fn a_vacuum_presses_on_the_object_and_an_interruption_changes_no_bit() {
    let plan = plan();
    assert_eq!(plan.cases(), ["5MPa_packing_1"]);
    let uninterrupted = end(plan.start("5MPa_packing_1").unwrap());

    // Interrupted three times: during growth, during closing, and while the vacuum increases.
    let mut run = plan.start("5MPa_packing_1").unwrap();
    for n_slices in [3, 40, 60] {
        assert!(!advance(&mut run, n_slices), "the run is longer than its parts");
        let bytes = run.save();
        run = plan.start("5MPa_packing_1").unwrap();
        run.resume(&bytes).unwrap();
    }
    let resumed = end(run);
    assert_eq!(resumed.digest, uninterrupted.digest, "oracle: the uninterrupted run, bit for bit");
    assert_eq!(resumed, uninterrupted);

    // Oracle: balance of forces. The force of the vacuum on the outer sphere exceeds that on the inner one.
    // The object carries at most the difference.
    let pressure = uninterrupted.column("object_pressure").unwrap();
    let (first, last) = (pressure[0], pressure[2]);
    let spread = 90e3 * (4.0_f64.powi(2) - 1.0);
    assert!(first < 0.2 * last && 2e3 < last && last < spread, "{pressure:?}");
    let solid = uninterrupted.column("solid_fraction").unwrap();
    // Oracle: random packings of spheres: 0.55 (loose) to 0.64 (dense). In such a small shell, the layers
    // at the membranes reduce the average by a few hundredths.
    assert!(0.5 < solid[0] && solid[0] < 0.64 && solid[0] < solid[2], "{solid:?}");
    assert_eq!(uninterrupted.validity.n_leaked, 0);
}

#[test]
fn a_saved_run_of_another_case_is_rejected() {
    let plan = plan();
    let mut run = plan.start("5MPa_packing_1").unwrap();
    assert!(run.resume(b"nonsense").is_err());
    let error = plan.start("9MPa").err().map(|it| it.to_string()).unwrap_or_default();
    assert!(error.contains("5MPa_packing_1"), "{error}");
}
