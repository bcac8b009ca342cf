//! Complete runs of the program: which objects are lifted, and which are not.
//!
//! Each run uses one solver thread, because several run at the same time.

use std::process::Command;

use serde_json::Value;

/// Runs a scene with the built-in controller and returns its summary.
fn run(scene: &str, arguments: &[&str]) -> Value {
    let cache = concat!(env!("CARGO_TARGET_TMPDIR"), "/starts");
    let output = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["run", scene, "--json", "--no-ros", "--no-stream", "--no-bag"])
        .args(["--threads", "1", "--cache", cache])
        .args(arguments)
        .output()
        .unwrap();
    let stdout = String::from_utf8_lossy(&output.stdout);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{scene} {arguments:?}: {stdout}{stderr}");
    serde_json::from_str(stdout.lines().last().unwrap()).unwrap()
}

fn number(summary: &Value, key: &str) -> f64 {
    summary[key].as_f64().unwrap_or_else(|| panic!("no `{key}` in {summary}"))
}

/// By this time the flange is up, and an object that the grip does not carry has fallen.
const UNTIL_UP: &str = "2.6s";

#[test]
fn without_vacuum_the_cylinder_stays_on_the_table() {
    // Oracle: the pull-off force without vacuum is below the weight (README). If it were
    // raised by a tenth of the lift, it would count as lifted.
    let set = ["--set", "pick_and_lift.grip_pressure=0Pa", "--for", UNTIL_UP];
    let summary = run("launch_configs/pick_and_lift.yaml", &set);
    assert!(number(&summary, "lift_height_m") < 0.01, "{summary}");
    assert_eq!(summary["held"], false);
    assert!(5.0 < number(&summary, "peak_push_force_n"), "it was pushed: {summary}");
}

#[test]
fn without_friction_the_cylinder_stays_on_the_table() {
    // Oracle: its walls are vertical, so only friction can carry it.
    let set = ["--set", "object.friction=0", "--for", UNTIL_UP];
    let summary = run("launch_configs/pick_and_lift.yaml", &set);
    assert!(number(&summary, "lift_height_m") < 0.01, "{summary}");
    assert_eq!(summary["held"], false);
    assert!(5.0 < number(&summary, "peak_push_force_n"), "it was pushed: {summary}");
}

#[test]
fn the_sphere_of_the_source_is_lifted() {
    // Oracle: the controller's lift of 100 mm, minus the compliance of the gripper.
    let summary = run("launch_configs/pick_and_lift_sphere.yaml", &[]);
    assert!(0.090 <= number(&summary, "lift_height_m"), "{summary}");
    assert_eq!(summary["held"], true, "{summary}");
}

#[test]
fn a_free_form_mesh_is_lifted() {
    // Oracle: the controller's lift of 100 mm, minus the compliance of the gripper.
    let summary = run("launch_configs/pick_and_lift_mesh.yaml", &[]);
    assert!(0.090 <= number(&summary, "lift_height_m"), "{summary}");
    assert_eq!(summary["held"], true, "{summary}");
}

#[test]
fn the_real_time_scene_lifts_the_cylinder() {
    // Oracle: the controller's lift of 100 mm, minus the compliance of the gripper.
    let summary = run("launch_configs/pick_and_lift_realtime.yaml", &[]);
    assert!(0.090 <= number(&summary, "lift_height_m"), "{summary}");
    assert_eq!(summary["held"], true, "{summary}");
}
