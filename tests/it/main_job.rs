//! The main job, commanded from other processes over ROS 2 topics alone.

use std::{
    path::Path,
    process::{Child, Command, Stdio},
};

use jamgrip::sinks::ros::RosNode;
use serde_json::Value;

use crate::{
    by_tick::{N_GRAINS, N_VERTICES, example, main_scene},
    peers,
    private_network::{cyclone_config, inside, inside_with_peers, reach},
    toy_run,
};

/// Oracle: the toy's own formulas; the peer has an independent controller on an independent DDS.
#[test]
fn an_independent_peer_picks_up_a_toy() {
    inside_with_peers("main_job::an_independent_peer_picks_up_a_toy", || {
        let folder = tempfile::tempdir().unwrap();
        let mut peer = start_peer(folder.path(), &["cylinder"]);
        let node = RosNode::join(&reach()).unwrap();
        toy_run::run(&node, || is_over(&mut peer));
        let seen = report_of(peer);
        check_lift(&seen);
        assert_eq!(
            (&seen["n_grains"], &seen["n_vertices"]),
            (&N_GRAINS.into(), &N_VERTICES.into())
        );
        let force = seen["hold_force_z_n"].as_f64().unwrap();
        assert!((force + toy_run::WEIGHT).abs() < 1e-9, "the toy's weight, not {force} N");
    });
}

/// Oracle: the example's own account of the toy, which lifts exactly as far as the flange.
#[test]
fn the_example_controller_picks_up_a_toy() {
    inside("main_job::the_example_controller_picks_up_a_toy", || {
        let mut controller = Command::new(example("pick_and_lift_controller"))
            .arg(main_scene())
            .env("ROS_DOMAIN_ID", reach().domain_id.to_string())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let node = RosNode::join(&reach()).unwrap();
        toy_run::run(&node, || is_over(&mut controller));
        let output = controller.wait_with_output().unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{said}");
        assert!(said.contains("lifted 100.0 mm, held for 1.5"), "{said}");
    });
}

fn start_peer(folder: &Path, arguments: &[&str]) -> Child {
    peers::script("pick_and_lift.py")
        .args(arguments)
        .env("ROS_DOMAIN_ID", reach().domain_id.to_string())
        .env("CYCLONEDDS_URI", format!("file://{}", cyclone_config(folder).display()))
        .stdout(Stdio::piped())
        .spawn()
        .unwrap()
}

fn is_over(process: &mut Child) -> bool {
    process.try_wait().unwrap().is_some()
}

/// The last line of what a process printed.
fn report_of(process: Child) -> Value {
    let output = process.wait_with_output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "the peer failed: {said}");
    let line = said.lines().last().expect("a report");
    eprintln!("{line}");
    serde_json::from_str(line).unwrap()
}

/// The acceptance: lifted at least 90 mm, held at least one second of simulated time, let go.
fn check_lift(seen: &Value) {
    let number = |key: &str| seen[key].as_f64().unwrap_or_else(|| panic!("no `{key}`"));
    assert!(0.090 <= number("lifted_m"), "lifted {} m", number("lifted_m"));
    assert!(1.0 <= number("held_s"), "held {} s", number("held_s"));
    assert!(number("gauge_reached_pa") <= -0.95 * 90e3, "{} Pa", number("gauge_reached_pa"));
    // The grains go up with the flange, by another path of data than the object's pose.
    assert!((number("cloud_lifted_m") - 0.1).abs() < 0.005, "{} m", number("cloud_lifted_m"));
    assert!(number("let_go_n") < 0.1, "still touched with {} N", number("let_go_n"));
    assert!(10.0 <= number("n_clouds") && 10.0 <= number("n_sheets"), "clouds while it ran");
}
