//! Recorded runs simulated again: verified, branched, and used as commands.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command as Process, Output},
    sync::{Arc, OnceLock},
};

use jamgrip::{
    bag::{
        recording::Recording,
        sink::{Bag, Format, RunDescription},
    },
    base::{Pose, real::Twist},
    command::{
        Command,
        change::{Change, Scope, TunableParameter},
    },
    io::sink::{Packet, Sink},
    node::plant::Plant,
    scene::{Object, Shape},
    session::Session,
    snapshot::Parts,
    wire::to_ros::Encoder,
};
use serde_json::Value;

use crate::coarse;

/// Length of the recorded run (ticks).
const N_TICKS: u64 = 300;

/// Runs the program, with start states shared between the tests.
fn jamgrip(arguments: &[&str]) -> Output {
    Process::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(arguments)
        .args(["--cache", concat!(env!("CARGO_TARGET_TMPDIR"), "/starts")])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

/// The last line of JSON that the program printed, and its exit code.
fn json_of(arguments: &[&str]) -> (Value, i32) {
    let output = jamgrip(arguments);
    let output_text = String::from_utf8_lossy(&output.stdout);
    let line = output_text.lines().last();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = line.unwrap_or_else(|| panic!("{arguments:?}: {errors}"));
    (serde_json::from_str(line).unwrap(), output.status.code().unwrap())
}

struct Recorded {
    folder: PathBuf,
    scene: String,
    summary: Value,
}

impl Recorded {
    fn bag(&self) -> &str {
        self.folder.to_str().unwrap()
    }
}

/// A coarse gripper that the built-in controller has pushed onto its object for 0.3 s.
fn recorded() -> &'static Recorded {
    static RECORDED: OnceLock<Recorded> = OnceLock::new();
    RECORDED.get_or_init(|| {
        let folder_path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("replays");
        // Left by an earlier run of the tests.
        drop(fs::remove_dir_all(&folder_path));
        fs::create_dir_all(&folder_path).unwrap();
        let scene = folder_path.join("coarse.yaml");
        fs::write(&scene, coarse::TEXT).unwrap();
        let (scene, folder) = (scene.to_str().unwrap().to_owned(), folder_path.join("bag"));
        let bag = folder.to_str().unwrap();
        let set = "outputs.bag.checkpoint_rate=10 Hz";
        let (summary, code) = json_of(&[
            "run",
            &scene,
            "--no-ros",
            "--no-stream",
            "--json",
            "--for",
            "0.3s",
            "--bag",
            bag,
            "--set",
            set,
        ]);
        assert_eq!(code, 0, "{summary}");
        assert!(
            1.0 < summary["peak_push_force_n"].as_f64().unwrap(),
            "something happens: {summary}"
        );
        Recorded { folder, scene, summary }
    })
}

#[test]
fn every_tick_is_verified_for_any_number_of_threads_and_lanes() {
    let bag = recorded();
    for threads in ["1", "2", "7"] {
        let (report, code) =
            json_of(&["replay", bag.bag(), "--verify", "--json", "--threads", threads]);
        // Oracle: the recording; the start counts as one comparison more.
        assert_eq!((code, &report["first_difference"]), (0, &Value::Null), "{report}");
        assert_eq!(
            (&report["ticks"], &report["compared"]),
            (&N_TICKS.into(), &(N_TICKS + 1).into())
        );
        assert_eq!(report["remarks"], serde_json::json!([]));
    }
    for (jobs, threads) in [("1", "1"), ("2", "1"), ("7", "2")] {
        let arguments = ["--jobs", jobs, "--threads", threads];
        let (report, code) =
            json_of(&[&["replay", bag.bag(), "--verify", "--json"][..], &arguments].concat());
        // Oracle: the recording, with checkpoints after 0, 100, 200 and 300 ticks. It starts at the
        // first; the others are compared with the whole state.
        assert_eq!((code, &report["first_difference"]), (0, &Value::Null), "{report}");
        assert_eq!(
            (&report["ticks"], &report["compared"], &report["checkpoints"]),
            (&N_TICKS.into(), &(N_TICKS + 1).into(), &3.into()),
            "{jobs} segments in parallel, {threads} threads each"
        );
    }
    for lanes in ["1", "4", "8"] {
        let (report, code) =
            json_of(&["replay", bag.bag(), "--verify", "--json", "--lanes", lanes]);
        assert_eq!((code, &report["first_difference"]), (0, &Value::Null), "{lanes}: {report}");
    }
    let (report, code) = json_of(&["replay", bag.bag(), "--verify", "--json", "--start", "0.25s"]);
    // From the checkpoint at 0.2 s.
    assert_eq!((code, &report["ticks"]), (0, &100.into()), "{report}");
    let (report, code) =
        json_of(&["replay", bag.bag(), "--verify", "--json", "--settle", "--end", "0.01s"]);
    assert_eq!((code, &report["compared"]), (0, &11.into()), "{report}");
}

/// Copies a recording with one command changed. Returns the tick in which it takes effect.
fn copy_tampered(from: &Path, to: &Path) -> u64 {
    let mut altered_in = None;
    copy_with(from, to, &mut |_| {}, &mut |message| {
        let is_command = message.channel.topic == "/jamgrip/flange/pose_cmd";
        if is_command && 100_000_000 < message.log_time && altered_in.is_none() {
            // Move the flange pose by a micrometer. A pose ends with three numbers of position and
            // four of orientation.
            let mut data = message.data.to_vec();
            let x = data.len() - 7 * 8;
            data[x..x + 8].copy_from_slice(&1e-6_f64.to_le_bytes());
            message.data = data.into();
            altered_in = Some(message.log_time / 1_000_000 + 1);
        }
    });
    altered_in.unwrap()
}

/// Copies a recording to one file, with changed attachments and messages.
fn copy_with(
    from: &Path,
    to: &Path,
    alter_attachments: &mut dyn FnMut(&mut Vec<mcap::Attachment<'_>>),
    alter: &mut dyn FnMut(&mut mcap::Message<'_>),
) {
    let mut files = fs::read_dir(from).unwrap().map(|it| it.unwrap().path());
    let file = files.find(|it| it.extension().is_some_and(|it| it == "mcap")).unwrap();
    let bytes = fs::read(&file).unwrap();
    let mut out = mcap::Writer::new(fs::File::create(to).unwrap()).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    for index in &summary.metadata_indexes {
        out.write_metadata(&mcap::read::metadata(&bytes, index).unwrap()).unwrap();
    }
    let indexes = summary.attachment_indexes.iter();
    let mut attachments: Vec<_> =
        indexes.map(|it| mcap::read::attachment(&bytes, it).unwrap()).collect();
    alter_attachments(&mut attachments);
    attachments.iter().for_each(|it| out.attach(it).unwrap());
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let mut message = message.unwrap();
        alter(&mut message);
        out.write(&message).unwrap();
    }
    out.finish().unwrap();
}

#[test]
fn an_altered_command_is_found_in_its_tick() {
    let folder_path = tempfile::tempdir().unwrap();
    let copy = folder_path.path().join("copy.mcap");
    let tick = copy_tampered(&recorded().folder, &copy);
    for jobs in ["1", "3"] {
        let copy = copy.to_str().unwrap();
        let (report, code) = json_of(&["replay", copy, "--verify", "--json", "--jobs", jobs]);
        // Oracle: the tick whose command was altered. Later segments are as recorded.
        assert_eq!((code, &report["first_difference"]), (1, &tick.into()), "{report}");
        assert_eq!(report["ticks"], tick, "later segments do not count: {report}");
    }
    let (report, _) = json_of(&["replay", copy.to_str().unwrap(), "--verify", "--json"]);
    let remarks = report["remarks"].to_string();
    assert!(remarks.contains(&format!("broken at tick {tick}")), "{remarks}");
    let output = Process::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(["bag", "check", copy.to_str().unwrap()])
        .output()
        .unwrap();
    let output_text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{output_text}");
    assert!(output_text.contains(&format!("broken at tick {tick}")), "{output_text}");
}

/// Oracle: which checkpoint was replaced by which. The digests do not show it: segments that start
/// at forged checkpoints would all be verified on their own.
#[test]
fn a_forged_checkpoint_is_found() {
    let folder_path = tempfile::tempdir().unwrap();
    let copy = folder_path.path().join("copy.mcap");
    let bag = recorded();
    copy_with(
        &bag.folder,
        &copy,
        &mut |attachments| {
            let named = |name: &str| attachments.iter().position(|it| it.name == name).unwrap();
            let (at_100, at_200) = (named("checkpoint/000000100"), named("checkpoint/000000200"));
            attachments[at_200].data = attachments[at_100].data.clone();
        },
        &mut |_| {},
    );
    for jobs in ["1", "3"] {
        let output = jamgrip(&["replay", copy.to_str().unwrap(), "--verify", "--jobs", jobs]);
        let output_text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(1), "{output_text}");
        let expected = "checkpoint at tick 200 differs although the digests are equal: time";
        assert!(output_text.contains(expected), "{jobs}: {output_text}");
    }
}

#[test]
fn only_a_branch_with_changes_differs_from_the_recorded_run() {
    let bag = recorded();
    let folder_path = tempfile::tempdir().unwrap();
    let branch = |name: &str, set: &str| {
        let folder = folder_path.path().join(name);
        let folder = folder.to_str().unwrap();
        let (summary, code) = json_of(&[
            "replay",
            bag.bag(),
            "--from",
            "0.17s",
            "--json",
            "--bag",
            folder,
            "--set",
            set,
        ]);
        assert_eq!(code, 0, "{summary}");
        assert_eq!(summary["start_state"], "branched");
        let (report, code) = json_of(&["replay", folder, "--verify", "--json"]);
        assert_eq!((code, &report["ticks"]), (0, &(N_TICKS - 170).into()), "{report}");
        summary
    };
    // Oracle: the recorded run. Its friction is 0.6 by default, and outputs do not affect it.
    let same = branch("same", "outputs.state_rate=10 Hz");
    assert_eq!(same["state_digest"], bag.summary["state_digest"]);
    assert_eq!(same["sim_time_s"], bag.summary["sim_time_s"]);
    for (name, set) in [
        ("slippery", "object.friction=0.01"),
        ("heavy", "object.density=7800 kg/m^3"),
        ("table", "table.friction=0.01"),
        ("up", "gravity=[0 m/s^2, 0 m/s^2, 9.81 m/s^2]"),
    ] {
        let other = branch(name, set);
        assert_ne!(other["state_digest"], bag.summary["state_digest"], "{set}");
    }
}

#[test]
fn overrides_of_the_start_are_rejected() {
    let bag = recorded();
    for (set, expected) in [
        ("grains.count=281", "the recorded grains and membrane"),
        ("object.shape.cylinder.radius=13 mm", "the recorded object has this shape"),
        ("seed=2", "seed"),
        ("time.tick=2 ms", "counted in ticks"),
        ("object.fricton=1", "did you mean `friction`"),
    ] {
        let output = jamgrip(&["replay", bag.bag(), "--from", "0.1s", "--no-bag", "--set", set]);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{set}: {errors}");
        assert!(errors.contains(expected), "{set}: {errors}");
    }
    let output = jamgrip(&["replay", bag.bag(), "--from", "7s", "--no-bag"]);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(errors.contains("from 0 s to 0.3 s"), "{errors}");
}

#[test]
fn the_commands_of_a_recording_reproduce_its_run() {
    let bag = recorded();
    let (summary, code) = json_of(&[
        "run",
        &bag.scene,
        "--no-ros",
        "--no-stream",
        "--no-bag",
        "--json",
        "--for",
        "0.3s",
        "--commands",
        bag.bag(),
    ]);
    // Oracle: the recorded run, whose controller sent the commands.
    assert_eq!((code, &summary["state_digest"]), (0, &bag.summary["state_digest"]), "{summary}");
}

#[test]
fn recordings_of_other_programs_can_command_a_run() {
    let bag = recorded();
    let folder_path = tempfile::tempdir().unwrap();
    let foreign = folder_path.path().join("theirs");
    crate::peers::run("write_bag.py", &[foreign.to_str().unwrap()]);
    let folder = folder_path.path().join("bag");
    let (summary, code) = json_of(&[
        "run",
        &bag.scene,
        "--no-ros",
        "--no-stream",
        "--json",
        "--for",
        "0.12s",
        "--commands",
        foreign.to_str().unwrap(),
        "--bag",
        folder.to_str().unwrap(),
    ]);
    // Oracle: `write_bag.py`: a command every 50 ms, the third at 100 ms after the first message.
    assert_eq!((code, &summary["commands"]["applied"]), (0, &3.into()), "{summary}");
    let recording = jamgrip::bag::recording::Recording::open(&folder).unwrap();
    let history = recording.history_without_scene(1_000_000).unwrap();
    let ticks: Vec<u64> = history.commands.iter().map(|it| it.tick).collect();
    assert_eq!(ticks, [1, 51, 101]);
    assert_eq!(history.commands[2].cdr, (-2000.0_f64).to_le_bytes());
}

/// The changes of the world after a tick of the run.
fn changes_after(tick: u64, session: &Session) -> Vec<Change> {
    let object = || "cylinder".to_owned();
    let ball = || {
        let pose = Pose::translation(0.1, 0.0, 0.02);
        let shape = Shape::Sphere { radius: 0.01 };
        let like = session.scene().objects[0].clone();
        Change::Insert(Box::new(Object { name: "ball".to_owned(), shape, pose, ..like }))
    };
    match tick {
        0 => {
            let pose = Pose::translation(0.002, 0.0, 0.025);
            vec![Change::PlaceObject { object: object(), pose, twist: Twist::zero() }]
        }
        30 => vec![ball(), Change::PlaceFlange { pose: Pose::translation(0.001, 0.0, 0.11) }],
        50 => vec![Change::Reset(Scope { time: false, state: true, spawned: true })],
        55 => vec![
            Change::SetParameter { parameter: TunableParameter::ObjectFriction, value: 0.3 },
            Change::ZeroForceSensor,
            Change::PlaceFlange { pose: Pose::translation(0.0, 0.001, 0.11) },
        ],
        70 => vec![Change::Reset(Scope { time: true, state: false, spawned: false })],
        90 => vec![Change::Remove { object: object() }, ball()],
        100 => vec![Change::Reset(Scope::ALL)],
        _ => Vec::new(),
    }
}

/// Records 130 ticks of a world that changes several times. Changes after the tick `forgets` are
/// left out of the recording.
fn record_changes(folder: &Path, forgets: Option<u64>) {
    let scene = coarse::scene(&[]);
    let mut session = coarse::session(1, &[]);
    let mesh = &session.coupled().system.model.membrane.mesh;
    let encoder =
        Arc::new(Encoder::new(&Arc::new(scene.clone()), &mesh.triangles, &mesh.positions));
    let facts = vec![("tick_ns", "1000000".to_owned())];
    let scene_text = jamgrip::scene::to_yaml(&scene);
    let description =
        RunDescription { scene_text, scene_files: vec![], facts, format: Format::default() };
    let mut bag = Bag::create(folder, encoder, description).unwrap();
    let packet = |session: &Session| Packet::new(session.snapshot(Parts::default()), None);
    for tick in 0..=130 {
        let is_due = tick % 20 == 0;
        let checkpoints = is_due.then(|| session.checkpoint()).flatten().into_iter().collect();
        bag.write(&packet(&session).with_checkpoints(checkpoints)).unwrap();
        let changes = changes_after(tick, &session);
        if !changes.is_empty() {
            changes.iter().for_each(|it| session.change(it).unwrap());
            let recorded = if forgets == Some(tick) { Vec::new() } else { changes };
            bag.write(&packet(&session).with_changes(recorded)).unwrap();
        }
        let commands = match session.now().0 {
            0 => vec![coarse::flange_to(0.09)],
            10 => vec![Command::Vacuum { gauge_pa: -40e3 }],
            _ => Vec::new(),
        };
        session.tick(&commands).unwrap();
    }
    assert_eq!(
        (session.now().0, session.run_tick().0),
        (31, 131),
        "the last reset of time was after tick 100"
    );
    bag.close().unwrap();
}

/// Oracle: the recorded session, and the list of its changes.
#[test]
fn changes_between_ticks_are_recorded_and_verified() {
    let folder_path = tempfile::tempdir().unwrap();
    let folder = folder_path.path().join("bag");
    record_changes(&folder, None);
    let bag = folder.to_str().unwrap();
    let (report, code) = json_of(&["replay", bag, "--verify", "--json"]);
    assert_eq!((code, &report["ticks"]), (0, &130.into()), "{report}");
    // 130 ticks, the start, and seven ticks with changes.
    assert_eq!(report["compared"], 138, "{report}");
    assert_eq!(report["remarks"], serde_json::json!([]));
    // From checkpoints after changes, to where a reset needs the start.
    for (start, n_ticks) in [("30ms", 110), ("60ms", 70), ("99ms", 50), ("125ms", 10)] {
        let (report, code) = json_of(&["replay", bag, "--verify", "--json", "--start", start]);
        assert_eq!((code, &report["ticks"]), (0, &n_ticks.into()), "{start}: {report}");
    }
    let checked = jamgrip::bag::check::check(&folder).unwrap();
    assert!(!checked.iter().any(|it| it.is_error), "{checked:?}");
    let history = Recording::open(&folder).unwrap().history_without_scene(1_000_000).unwrap();
    let what: Vec<_> = history.changes.iter().map(|it| (it.tick, it.what.as_str())).collect();
    assert_eq!(what[1], (30, "object `ball` added"));
    assert_eq!(what[10], (100, "reset of time, state, added objects"));
    // No checkpoints while the objects are not those of the scene: after 100 it was not yet reset.
    let ticks: Vec<u64> = history.checkpoints.iter().map(|it| it.tick).collect();
    assert_eq!(ticks, [0, 20, 60, 80, 120]);
    let commands: Vec<u64> = history.commands.iter().map(|it| it.tick).collect();
    assert_eq!(commands, [1, 11, 71, 81, 101, 111], "ticks of the run, also after resets of time");
}

/// Oracle: the tick of the change that is missing in the recording.
#[test]
fn a_change_that_is_not_recorded_is_a_difference() {
    let folder_path = tempfile::tempdir().unwrap();
    let folder = folder_path.path().join("bag");
    record_changes(&folder, Some(50));
    let (report, code) = json_of(&["replay", folder.to_str().unwrap(), "--verify", "--json"]);
    assert_eq!((code, &report["first_difference"]), (1, &51.into()), "{report}");
}

/// Oracle: the list of changes: the last one is the reset after 100 ms.
#[test]
fn a_branch_names_the_changes_that_it_cannot_repeat() {
    let folder_path = tempfile::tempdir().unwrap();
    let folder = folder_path.path().join("bag");
    record_changes(&folder, None);
    let bag = folder.to_str().unwrap();
    let branch = |arguments: &[&str]| {
        let all = [&["replay", bag, "--json", "--no-bag"], arguments];
        let output = jamgrip(&all.concat());
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), errors)
    };
    for (arguments, expected) in [
        (&["--from", "40ms"][..], "world was changed at 0.05 s (reset of state, added objects)"),
        (&["--from", "40ms", "--end", "45ms"], "at tick 40 the objects are not those of the scene"),
        (&["--from", "100ms"], "world was changed at 0.1 s (reset of time, state, added"),
    ] {
        let (code, errors) = branch(arguments);
        assert_eq!(code, Some(2), "{arguments:?}: {errors}");
        assert!(errors.contains(expected), "{arguments:?}: {errors}");
    }
    for arguments in [&["--from", "60ms", "--end", "70ms"][..], &["--from", "110ms"]] {
        let (code, errors) = branch(arguments);
        assert_eq!(code, Some(0), "{arguments:?}: {errors}");
    }
}

/// Oracle: the recording: made by 0.1.0, an older version; the changelog lists the changes of results since then.
#[test]
fn verifying_a_recording_of_the_first_release_names_the_causes() {
    let (report, code) =
        json_of(&["replay", "bags/pick_and_lift", "--verify", "--json", "--end", "3ms"]);
    assert_eq!((code, &report["first_difference"]), (1, &1.into()), "{report}");
    let remarks = report["remarks"].to_string();
    for expected in [
        "recorded by jamgrip 0.1.0, which did not record the digest of every tick: only the 10 digests",
        "the recording has no checkpoint: the start was",
        "results have changed since: ",
        "distributes its force by the saddles",
    ] {
        assert!(remarks.contains(expected), "{expected}: {remarks}");
    }
}
