//! Recordings simulated again: proved, branched off, taken as commands.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command as Process, Output},
    sync::{Arc, OnceLock},
};

use jamgrip::{
    bag::{
        recording::Recording,
        sink::{Bag, Format, Subject},
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

/// How long the recorded run is.
const N_TICKS: u64 = 300;

/// The program, with start states shared between the tests.
fn jamgrip(arguments: &[&str]) -> Output {
    Process::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(arguments)
        .args(["--cache", concat!(env!("CARGO_TARGET_TMPDIR"), "/starts")])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

/// The line of JSON that a program ended with, and its exit code.
fn told(arguments: &[&str]) -> (Value, i32) {
    let output = jamgrip(arguments);
    let said = String::from_utf8_lossy(&output.stdout);
    let line = said.lines().last();
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = line.unwrap_or_else(|| panic!("{arguments:?}: {complaint}"));
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

/// A coarse gripper that the built-in controller has pushed on its object for 0.3 s.
fn recorded() -> &'static Recorded {
    static RECORDED: OnceLock<Recorded> = OnceLock::new();
    RECORDED.get_or_init(|| {
        let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("replays");
        // Left behind by an earlier run of the tests.
        drop(fs::remove_dir_all(&place));
        fs::create_dir_all(&place).unwrap();
        let scene = place.join("coarse.yaml");
        fs::write(&scene, coarse::TEXT).unwrap();
        let (scene, folder) = (scene.to_str().unwrap().to_owned(), place.join("bag"));
        let bag = folder.to_str().unwrap();
        let set = "outputs.bag.checkpoint_rate=10 Hz";
        let (summary, code) = told(&[
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
fn every_tick_comes_out_as_recorded_for_any_number_of_threads_and_lanes() {
    let bag = recorded();
    for threads in ["1", "2", "7"] {
        let (verdict, code) =
            told(&["replay", bag.bag(), "--verify", "--json", "--threads", threads]);
        // Oracle: the recording; the start counts as one more.
        assert_eq!((code, &verdict["first_difference"]), (0, &Value::Null), "{verdict}");
        assert_eq!(
            (&verdict["ticks"], &verdict["compared"]),
            (&N_TICKS.into(), &(N_TICKS + 1).into())
        );
        assert_eq!(verdict["remarks"], serde_json::json!([]));
    }
    for (jobs, threads) in [("1", "1"), ("2", "1"), ("7", "2")] {
        let arguments = ["--jobs", jobs, "--threads", threads];
        let (verdict, code) =
            told(&[&["replay", bag.bag(), "--verify", "--json"][..], &arguments].concat());
        // Oracle: the recording, whose checkpoints are after 0, 100, 200 and 300 ticks. The first is
        // where it begins; every other is compared as a whole.
        assert_eq!((code, &verdict["first_difference"]), (0, &Value::Null), "{verdict}");
        assert_eq!(
            (&verdict["ticks"], &verdict["compared"], &verdict["checkpoints"]),
            (&N_TICKS.into(), &(N_TICKS + 1).into(), &3.into()),
            "{jobs} segments in parallel, {threads} threads each"
        );
    }
    for lanes in ["1", "4", "8"] {
        let (verdict, code) = told(&["replay", bag.bag(), "--verify", "--json", "--lanes", lanes]);
        assert_eq!((code, &verdict["first_difference"]), (0, &Value::Null), "{lanes}: {verdict}");
    }
    let (verdict, code) = told(&["replay", bag.bag(), "--verify", "--json", "--start", "0.25s"]);
    // From the checkpoint at 0.2 s on.
    assert_eq!((code, &verdict["ticks"]), (0, &100.into()), "{verdict}");
    let (verdict, code) =
        told(&["replay", bag.bag(), "--verify", "--json", "--settle", "--end", "0.01s"]);
    assert_eq!((code, &verdict["compared"]), (0, &11.into()), "{verdict}");
}

/// Copies a recording and changes one command; says in which tick it takes effect.
fn tampered(from: &Path, to: &Path) -> u64 {
    let mut altered_in = None;
    copied(from, to, &mut |_| {}, &mut |message| {
        let is_command = message.channel.topic == "/jamgrip/flange/pose_cmd";
        if is_command && 100_000_000 < message.log_time && altered_in.is_none() {
            // The flange shall go a micrometre to the side. A pose ends with three numbers of
            // position and four of orientation.
            let mut data = message.data.to_vec();
            let x = data.len() - 7 * 8;
            data[x..x + 8].copy_from_slice(&1e-6_f64.to_le_bytes());
            message.data = data.into();
            altered_in = Some(message.log_time / 1_000_000 + 1);
        }
    });
    altered_in.unwrap()
}

/// Copies a recording into one file, with its attachments and messages altered.
fn copied(
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
fn one_altered_command_is_found_in_its_tick() {
    let place = tempfile::tempdir().unwrap();
    let copy = place.path().join("copy.mcap");
    let tick = tampered(&recorded().folder, &copy);
    for jobs in ["1", "3"] {
        let copy = copy.to_str().unwrap();
        let (verdict, code) = told(&["replay", copy, "--verify", "--json", "--jobs", jobs]);
        // Oracle: the tick whose command was altered. Parts behind it are as they were recorded.
        assert_eq!((code, &verdict["first_difference"]), (1, &tick.into()), "{verdict}");
        assert_eq!(verdict["ticks"], tick, "parts behind do not count: {verdict}");
    }
    let (verdict, _) = told(&["replay", copy.to_str().unwrap(), "--verify", "--json"]);
    let remarks = verdict["remarks"].to_string();
    assert!(remarks.contains(&format!("broken at tick {tick}")), "{remarks}");
    let output = Process::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(["bag", "check", copy.to_str().unwrap()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains(&format!("broken at tick {tick}")), "{said}");
}

/// Oracle: which checkpoint was put in the place of which. No digest tells that: parts that begin at
/// forged checkpoints would all be proved on their own.
#[test]
fn a_checkpoint_that_is_not_the_state_before_it_is_found() {
    let place = tempfile::tempdir().unwrap();
    let copy = place.path().join("copy.mcap");
    let bag = recorded();
    copied(
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
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(1), "{said}");
        let expected = "checkpoint at tick 200 differs, although the digests do not: time";
        assert!(said.contains(expected), "{jobs}: {said}");
    }
}

#[test]
fn a_branch_without_changes_is_the_same_run_and_one_with_changes_is_not() {
    let bag = recorded();
    let place = tempfile::tempdir().unwrap();
    let branch = |name: &str, set: &str| {
        let folder = place.path().join(name);
        let folder = folder.to_str().unwrap();
        let (summary, code) = told(&[
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
        let (verdict, code) = told(&["replay", folder, "--verify", "--json"]);
        assert_eq!((code, &verdict["ticks"]), (0, &(N_TICKS - 170).into()), "{verdict}");
        summary
    };
    // Oracle: the recorded run. Its friction is 0.6 by default, and outputs change nothing.
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
fn what_cannot_change_after_the_start_is_refused() {
    let bag = recorded();
    for (set, expected) in [
        ("grains.count=281", "the grains and the membrane that were recorded"),
        ("object.shape.cylinder.radius=13 mm", "the recorded object has this shape"),
        ("seed=2", "seed"),
        ("time.tick=2 ms", "counted in ticks"),
        ("object.fricton=1", "did you mean `friction`"),
    ] {
        let output = jamgrip(&["replay", bag.bag(), "--from", "0.1s", "--no-bag", "--set", set]);
        let complaint = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{set}: {complaint}");
        assert!(complaint.contains(expected), "{set}: {complaint}");
    }
    let output = jamgrip(&["replay", bag.bag(), "--from", "7s", "--no-bag"]);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(complaint.contains("from 0 s to 0.3 s"), "{complaint}");
}

#[test]
fn a_recording_commands_a_run_of_its_scene() {
    let bag = recorded();
    let (summary, code) = told(&[
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
    // Oracle: the recorded run, whose controller gave the commands.
    assert_eq!((code, &summary["state_digest"]), (0, &bag.summary["state_digest"]), "{summary}");
}

#[test]
fn recordings_of_others_command_a_run() {
    let bag = recorded();
    let place = tempfile::tempdir().unwrap();
    let theirs = place.path().join("theirs");
    crate::peers::run("write_bag.py", &[theirs.to_str().unwrap()]);
    let folder = place.path().join("bag");
    let (summary, code) = told(&[
        "run",
        &bag.scene,
        "--no-ros",
        "--no-stream",
        "--json",
        "--for",
        "0.12s",
        "--commands",
        theirs.to_str().unwrap(),
        "--bag",
        folder.to_str().unwrap(),
    ]);
    // Oracle: `write_bag.py`: a command every 50 ms from the first message on, the third at 100 ms.
    assert_eq!((code, &summary["commands"]["applied"]), (0, &3.into()), "{summary}");
    let recording = jamgrip::bag::recording::Recording::open(&folder).unwrap();
    let course = recording.course_of_all(1_000_000).unwrap();
    let ticks: Vec<u64> = course.commands.iter().map(|it| it.tick).collect();
    assert_eq!(ticks, [1, 51, 101]);
    assert_eq!(course.commands[2].cdr, (-2000.0_f64).to_le_bytes());
}

/// What was done to the world after a tick of the run.
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

/// A recording of 130 ticks of a world that is changed now and then; `forgets` leaves the changes
/// after this tick out of it.
fn record_changes(folder: &Path, forgets: Option<u64>) {
    let scene = coarse::scene(&[]);
    let mut session = coarse::session(1, &[]);
    let mesh = &session.coupled().system.model.membrane.mesh;
    let encoder =
        Arc::new(Encoder::new(&Arc::new(scene.clone()), &mesh.triangles, &mesh.positions));
    let facts = vec![("tick_ns", "1000000".to_owned())];
    let scene_text = jamgrip::scene::to_yaml(&scene);
    let subject = Subject { scene_text, scene_files: vec![], facts, format: Format::default() };
    let mut bag = Bag::create(folder, encoder, subject).unwrap();
    let packet = |session: &Session| Packet::new(session.snapshot(Parts::default()), None);
    for tick in 0..=130 {
        let is_due = tick % 20 == 0;
        let kept = is_due.then(|| session.checkpoint()).flatten().into_iter().collect();
        bag.write(&packet(&session).with_checkpoints(kept)).unwrap();
        let changes = changes_after(tick, &session);
        if !changes.is_empty() {
            changes.iter().for_each(|it| session.change(it).unwrap());
            let told = if forgets == Some(tick) { Vec::new() } else { changes };
            bag.write(&packet(&session).with_changes(told)).unwrap();
        }
        let commands = match session.now().0 {
            0 => vec![coarse::flange_to(0.09)],
            10 => vec![Command::Vacuum { gauge_pa: -40e3 }],
            _ => Vec::new(),
        };
        session.tick(&commands).unwrap();
    }
    assert_eq!((session.now().0, session.run_tick().0), (31, 131), "time was reset last after 100");
    bag.close().unwrap();
}

/// Oracle: the session that was recorded, and the list of what was done to it.
#[test]
fn what_is_done_to_the_world_between_ticks_is_recorded_and_done_again() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("bag");
    record_changes(&folder, None);
    let bag = folder.to_str().unwrap();
    let (verdict, code) = told(&["replay", bag, "--verify", "--json"]);
    assert_eq!((code, &verdict["ticks"]), (0, &130.into()), "{verdict}");
    // 130 ticks, the start, and seven times something was changed.
    assert_eq!(verdict["compared"], 138, "{verdict}");
    assert_eq!(verdict["remarks"], serde_json::json!([]));
    // From checkpoints behind changes, to where a reset needs the start.
    for (start, n_ticks) in [("30ms", 110), ("60ms", 70), ("99ms", 50), ("125ms", 10)] {
        let (verdict, code) = told(&["replay", bag, "--verify", "--json", "--start", start]);
        assert_eq!((code, &verdict["ticks"]), (0, &n_ticks.into()), "{start}: {verdict}");
    }
    let checked = jamgrip::bag::check::check(&folder).unwrap();
    assert!(!checked.iter().any(|it| it.is_error), "{checked:?}");
    let course = Recording::open(&folder).unwrap().course_of_all(1_000_000).unwrap();
    let what: Vec<_> = course.changes.iter().map(|it| (it.tick, it.what.as_str())).collect();
    assert_eq!(what[1], (30, "object `ball` added"));
    assert_eq!(what[10], (100, "reset of time, state, added objects"));
    // No checkpoints while there are other objects than the scene's: after 100 it was not yet reset.
    let ticks: Vec<u64> = course.checkpoints.iter().map(|it| it.tick).collect();
    assert_eq!(ticks, [0, 20, 60, 80, 120]);
    let commands: Vec<u64> = course.commands.iter().map(|it| it.tick).collect();
    assert_eq!(commands, [1, 11, 71, 81, 101, 111], "ticks of the run, whatever became of time");
}

/// Oracle: the tick of the change that is not in the recording.
#[test]
fn a_change_that_is_not_recorded_shows_as_a_difference() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("bag");
    record_changes(&folder, Some(50));
    let (verdict, code) = told(&["replay", folder.to_str().unwrap(), "--verify", "--json"]);
    assert_eq!((code, &verdict["first_difference"]), (1, &51.into()), "{verdict}");
}

/// Oracle: the list of changes: the reset after 100 ms is the last.
#[test]
fn a_branch_says_which_changes_it_cannot_repeat() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("bag");
    record_changes(&folder, None);
    let bag = folder.to_str().unwrap();
    let branch = |arguments: &[&str]| {
        let all = [&["replay", bag, "--json", "--no-bag"], arguments];
        let output = jamgrip(&all.concat());
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), complaint)
    };
    for (arguments, expected) in [
        (&["--from", "40ms"][..], "changed from outside at 0.05 s (reset of state, added objects)"),
        (&["--from", "40ms", "--end", "45ms"], "at tick 40 there are other objects"),
        (&["--from", "100ms"], "changed from outside at 0.1 s (reset of time, state, added"),
    ] {
        let (code, complaint) = branch(arguments);
        assert_eq!(code, Some(2), "{arguments:?}: {complaint}");
        assert!(complaint.contains(expected), "{arguments:?}: {complaint}");
    }
    for arguments in [&["--from", "60ms", "--end", "70ms"][..], &["--from", "110ms"]] {
        let (code, complaint) = branch(arguments);
        assert_eq!(code, Some(0), "{arguments:?}: {complaint}");
    }
}

/// Oracle: what is known of the recording: made by 0.1.0, whose results the changelog says changed.
#[test]
fn a_recording_of_the_first_release_says_why_it_cannot_be_proved() {
    let (verdict, code) =
        told(&["replay", "bags/pick_and_lift", "--verify", "--json", "--end", "3ms"]);
    assert_eq!((code, &verdict["first_difference"]), (1, &1.into()), "{verdict}");
    let remarks = verdict["remarks"].to_string();
    for told in [
        "recorded by jamgrip 0.1.0, before recordings held the digest of every tick: only 10 digests",
        "no checkpoint is recorded: the start was",
        "what changed results since then: ",
        "shares out its force by the mountain passes",
    ] {
        assert!(remarks.contains(told), "{told}: {remarks}");
    }
}
