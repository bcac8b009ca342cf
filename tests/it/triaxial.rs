//! A small triaxial specimen: isotropic under the confining pressure, stiffer when sheared, and the
//! same bits after an interruption.
#![expect(clippy::print_stderr, reason = "prints measured values")]

use jamgrip::experiments::{
    Experiment, Plan, Run, SceneText, Size, record::Record, triaxial::Triaxial,
};

/// 205 grains in a tube of half the radius and half the height of the source, sheared five times as fast.
const SMALL: [&str; 12] = [
    "case1.radius=12.5 mm",
    "case1.height=50 mm",
    "case1.triangles.n_around=20",
    "case1.triangles.n_rows=15",
    "case1.triangles.n_grains_a=205",
    "case1.spheres.n_around=60",
    "case1.spheres.n_rows=44",
    "case1.spheres.n_grains_a=190",
    "shear.speed_factor=5",
    "shear.strain=0.02",
    "shear.n_points=20",
    "runs.timing=0.1 ms",
];

fn plan(overrides: &[&str]) -> Box<dyn Plan> {
    let overrides: Vec<String> = SMALL.iter().chain(overrides).map(|it| (*it).to_owned()).collect();
    let (source, text) = Triaxial.scene();
    Triaxial
        .read(&SceneText { text, source, overrides: &overrides, size: Size::Quick })
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Runs to the end.
fn finish(run: &mut dyn Run) -> Record {
    while !run.advance().unwrap().is_done {}
    run.record()
}

/// Runs to the end. After the third slice of each stage, the run is saved and resumed by another one.
fn finish_with_breaks(plan: &dyn Plan, case: &str) -> (Record, usize) {
    let mut run = plan.start(case).unwrap();
    let (mut last, mut n_slices, mut n_breaks) = ("", 0, 0);
    loop {
        let progress = run.advance().unwrap();
        n_slices = if progress.phase == last { n_slices + 1 } else { 1 };
        last = progress.phase;
        if progress.is_done {
            return (run.record(), n_breaks);
        }
        if n_slices == 3 {
            let bytes = run.save();
            run = plan.start(case).unwrap();
            run.resume(&bytes).unwrap();
            n_breaks += 1;
        }
    }
}

#[test]
fn a_small_specimen_is_isotropic_stiffens_and_can_be_resumed_with_the_same_bits() {
    let plan = plan(&[]);
    let case = "case1_triangles_A";
    let record = finish(plan.start(case).unwrap().as_mut());
    let (resumed, n_breaks) = finish_with_breaks(plan.as_ref(), case);
    assert!(n_breaks >= 3, "growing, confining, shearing: {n_breaks}");
    // Oracle: the uninterrupted run.
    assert_eq!(resumed.digest, record.digest);
    assert_eq!(resumed, record);

    let first = |name: &str| record.column(name).unwrap()[0];
    let pressure = 1e5;
    eprintln!(
        "σ_d {:.0} Pa, hoop {:.0} Pa, lateral {:.0} Pa, axial {:.0} Pa, {:?}",
        first("stress_difference"),
        first("hoop_pressure"),
        first("lateral_stress"),
        first("axial_stress"),
        record.validity
    );
    // Oracle: p_plate = p_c. Tolerance 1 %: the servo stops within 0.5 %, and the area is current.
    assert!(first("stress_difference").abs() < 0.01 * pressure);
    let applied = pressure + first("hoop_pressure");
    // Oracle: U22, σ = 1/V Σ f l is the applied pressure: that of the air minus that carried by the
    // membrane's springs. Tolerance 4 %: the ends of the middle half cut about sixty contacts of this small
    // specimen, which causes a scatter of 2 %; large specimens must meet the 2 % of U22.
    assert!((first("lateral_stress") / applied - 1.0).abs() < 0.04);
    let stress = record.column("stress_difference").unwrap();
    // Oracle: Mohr–Coulomb; 20° would be 104 kPa. At 2 % strain at least a quarter of it is reached.
    assert!(stress[stress.len() - 1] > 0.25 * pressure, "{stress:?}");
    assert_eq!(record.validity.n_leaked, 0);
}

#[test]
fn spheres_carry_the_same_pressure_as_triangles_and_both_are_timed() {
    let plan = plan(&["shear.strain=0.01", "shear.n_points=5"]);
    let record = finish(plan.start("case1_spheres_A").unwrap().as_mut());
    let stress = record.column("stress_difference").unwrap();
    eprintln!("spheres: {stress:?} {:?}", record.validity);
    // Oracle and tolerance as above.
    assert!(stress[0].abs() < 1e3);
    assert!(stress[stress.len() - 1] > 1e4, "{stress:?}");

    let timed = finish(plan.start("case1_timing").unwrap().as_mut());
    for kind in ["triangles", "spheres"] {
        assert!(timed.n_substeps[kind] > 0);
        // Oracle: 0.1 ms from the scene, plus at most one slice of substeps.
        let time = timed.scalar(&format!("time_{kind}")).unwrap();
        assert!((1e-4..5e-3).contains(&time), "{time}");
    }
    let mut other = plan.start("case1_timing").unwrap();
    other.advance().unwrap();
    let bytes = plan.start("case1_spheres_A").unwrap().save();
    assert!(other.resume(&bytes).is_err(), "bytes of another case");
}
