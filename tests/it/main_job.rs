//! The pick-and-lift task, commanded from other processes over ROS 2 topics alone.

use std::{
    io::Write,
    path::Path,
    process::{Child, Command, Stdio},
    time::Duration,
};

use jamgrip::{
    ros::node::RosNode,
    scene::{Scene, Shape, load},
};
use serde_json::Value;

use crate::{
    by_tick::{N_GRAINS, N_VERTICES, example, main_scene},
    mock_run, peers,
    private_network::{cyclone_config, discovery_range, inside, inside_with_peers},
};

/// Oracle: the formulas of the mock plant; the peer has an independent controller on an independent DDS.
#[test]
fn an_independent_peer_picks_up_a_mock_object() {
    inside_with_peers("main_job::an_independent_peer_picks_up_a_mock_object", || {
        let folder = tempfile::tempdir().unwrap();
        let mut peer = start_peer(folder.path(), &["cylinder"]);
        let node = RosNode::join(&discovery_range()).unwrap();
        mock_run::run(&node, || peer.is_over());
        let measured = peer.report();
        check_lift(&measured);
        assert_eq!(
            (&measured["n_grains"], &measured["n_vertices"]),
            (&N_GRAINS.into(), &N_VERTICES.into())
        );
        let force = measured["hold_force_z_n"].as_f64().unwrap();
        assert!(
            (force + mock_run::WEIGHT).abs() < 1e-9,
            "the weight of the mock object, not {force} N"
        );
    });
}

/// Oracle: the lift printed by the example; the mock object rises exactly as far as the flange.
#[test]
fn the_example_controller_picks_up_a_mock_object() {
    inside("main_job::the_example_controller_picks_up_a_mock_object", || {
        let mut controller = Running::start(
            Command::new(example("pick_and_lift_controller"))
                .arg(main_scene())
                .env("ROS_DOMAIN_ID", discovery_range().domain_id.to_string()),
        );
        let node = RosNode::join(&discovery_range()).unwrap();
        mock_run::run(&node, || controller.is_over());
        let printed = controller.wait_for_success();
        let summary = printed.lines().last().unwrap().strip_prefix("lifted ").expect("a result");
        let (lifted_mm, held) = summary.split_once(" mm, held for ").unwrap();
        let held_s: f64 = held.trim_end_matches(" s").parse().unwrap();
        assert_eq!(lifted_mm, "100.0", "{printed}");
        // The scene holds for 1.5 s; on a busy machine the controller may notice the start late.
        assert!((1.0..=1.6).contains(&held_s), "{printed}");
    });
}

/// Oracle: the requirements of the pick-and-lift task, checked by an independent peer over ROS 2 topics alone, and
/// the summary that the node prints for the same run.
#[test]
fn an_independent_peer_commands_the_whole_job() {
    inside_with_peers("main_job::an_independent_peer_commands_the_whole_job", || {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        let mut node = Running::start(
            Command::new(env!("CARGO_BIN_EXE_jamgrip"))
                .args(["run", "launch_configs/pick_and_lift.yaml", "--json", "--bag"])
                .arg(&bag)
                .args(["--set", "controller=topics"])
                // The result does not depend on the load of the machine.
                .args(["--set", "topics.lockstep=wait_command"])
                .args(["--set", "topics.steps_per_command=10", "--cache"])
                .arg(concat!(env!("CARGO_TARGET_TMPDIR"), "/starts"))
                .current_dir(env!("CARGO_MANIFEST_DIR"))
                .env("ROS_DOMAIN_ID", discovery_range().domain_id.to_string())
                .env("JAMGRIP_STREAM_PREFIX", format!("jamgrip_test_{}", std::process::id())),
        );
        let mut peer = start_peer(folder.path(), &["cylinder", "--lockstep"]);
        while !peer.is_over() {
            assert!(!node.is_over(), "the run ended before its controller");
            std::thread::sleep(Duration::from_millis(20));
        }
        let measured = peer.report();
        node.interrupt();
        let summary = node.report();

        check_lift(&measured);
        let scene = load(&main_scene(), &[]).unwrap();
        assert_eq!(measured["n_grains"], scene.grains.count);
        assert_eq!(
            (&measured["n_grains"], &measured["n_vertices"]),
            (&summary["n_grains"], &summary["n_vertices"])
        );
        let weight = weight(&scene);
        let force = measured["hold_force_z_n"].as_f64().unwrap();
        // The object bounces a little on the jammed bag; the mean over several swings is compared.
        assert!((force + weight).abs() < 0.001 * weight, "{force} N under a weight of {weight} N");
        let (theirs, ours) = (&measured["lifted_m"], &summary["lift_height_m"]);
        let difference = theirs.as_f64().unwrap() - ours.as_f64().unwrap();
        // Theirs is the lowest height while holding, ours the highest reached.
        assert!(
            (-0.005..=0.0005).contains(&difference),
            "{theirs} m measured by the peer, {ours} m in the summary"
        );
        assert_eq!((&summary["held"], &summary["failed"]["ros"]), (&true.into(), &0.into()));
        check_recording(&bag, &summary);
    });
}

/// Oracle: two independent libraries decode every message of the recording and count what
/// metadata.yaml lists; the summary of the node contains the numbers of packets and commands.
fn check_recording(bag: &Path, summary: &Value) {
    let json = peers::run("read_bag.py", &[bag.to_str().unwrap()]);
    let read: Value = serde_json::from_str(&json).unwrap();
    let count = |topic: &str| read["mcap"]["counts"][topic].as_u64().unwrap_or(0);
    // Every packet holds a clock message.
    assert_eq!(summary["written"]["bag"], count("/clock"));
    let commands = &summary["commands"];
    let n_commands: u64 =
        ["applied", "limited", "refused"].iter().map(|key| commands[key].as_u64().unwrap()).sum();
    let recorded = ["vacuum_cmd", "flange/pose_cmd", "joint_commands"];
    let n_recorded: u64 = recorded.iter().map(|it| count(&format!("/jamgrip/{it}"))).sum();
    assert_eq!(n_recorded, n_commands);
    for topic in ["grains", "membrane", "wrench", "vacuum_state", "object/cylinder/pose"] {
        assert!(10 < count(&format!("/jamgrip/{topic}")), "{topic} is recorded");
    }
    assert_eq!(read["mcap"]["metadata"]["jamgrip_end"]["state_digest"], summary["state_digest"]);
}

/// Weight of the scene's cylinder [N], from its dimensions.
fn weight(scene: &Scene) -> f64 {
    let object = &scene.objects[0];
    let Shape::Cylinder { radius, height } = object.shape else { panic!("not a cylinder") };
    let volume = std::f64::consts::PI * radius * radius * height;
    volume * object.material.density * scene.gravity.norm()
}

fn start_peer(folder: &Path, arguments: &[&str]) -> Running {
    Running::start(
        peers::script("pick_and_lift.py")
            .args(arguments)
            .env("ROS_DOMAIN_ID", discovery_range().domain_id.to_string())
            .env("CYCLONEDDS_URI", format!("file://{}", cyclone_config(folder).display())),
    )
}

/// A process that does not outlive its test.
struct Running(Option<Child>);

impl Running {
    fn start(command: &mut Command) -> Self {
        Self(Some(command.stdout(Stdio::piped()).spawn().unwrap()))
    }

    fn is_over(&mut self) -> bool {
        self.0.as_mut().unwrap().try_wait().unwrap().is_some()
    }

    /// Waits until it exits with success. Returns its standard output.
    fn wait_for_success(mut self) -> String {
        let output = self.0.take().unwrap().wait_with_output().unwrap();
        let printed = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{}: {printed}", output.status);
        printed
    }

    /// The last line that it printed.
    fn report(self) -> Value {
        let printed = self.wait_for_success();
        let line = printed.lines().last().expect("a report");
        // Visible with `--nocapture`.
        writeln!(std::io::stderr().lock(), "{line}").unwrap();
        serde_json::from_str(line).unwrap()
    }

    /// Ctrl-C.
    fn interrupt(&self) {
        let kill = format!("kill -INT {}", self.0.as_ref().unwrap().id());
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(mut process) = self.0.take() {
            // It may have ended already.
            let _killed = process.kill();
            let _reaped = process.wait();
        }
    }
}

/// Requirements: lifted at least 90 mm, held at least one second of simulated time, released.
fn check_lift(report: &Value) {
    let number = |key: &str| report[key].as_f64().unwrap_or_else(|| panic!("no `{key}`"));
    assert!(0.090 <= number("lifted_m"), "lifted {} m", number("lifted_m"));
    assert!(1.0 <= number("held_s"), "held {} s", number("held_s"));
    assert!(number("gauge_reached_pa") <= -0.95 * 90e3, "{} Pa", number("gauge_reached_pa"));
    // The grains rise with the flange; their topic is independent of the pose of the object.
    assert!((number("cloud_lifted_m") - 0.1).abs() < 0.005, "{} m", number("cloud_lifted_m"));
    assert!(number("let_go_n") < 0.1, "still touched with {} N", number("let_go_n"));
    assert!(10.0 <= number("n_clouds") && 10.0 <= number("n_membranes"), "clouds during the run");
}
