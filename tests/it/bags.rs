//! Recordings: the contents as read by other libraries, and full disks.

use std::{
    collections::BTreeMap, fs, io::Write, path::Path, process::Command as Process, sync::Arc,
    time::Duration,
};

use jamgrip::{
    bag::sink::{Bag, BagError, BagReport, Format, RunDescription},
    base::{
        Vec3,
        random::{Random, Stream},
    },
    io::{
        fanout::{Delivery, Fanout},
        sink::{Packet, Sink},
    },
    scene::BagCompression,
    snapshot::{GrainsSnapshot, MembraneSnapshot},
    wire::to_ros::Encoder,
};
use serde_json::Value;

use crate::{by_tick, peers, synthetic};

const SCENE_TEXT: &str = "name: synthetic\n";
/// Digest of the state after 1000 ticks, in `synthetic::snapshot`.
const DIGEST: u64 = 1000_u64.wrapping_mul(0x9e37_79b9_7f4a_7c15);

fn description() -> RunDescription {
    RunDescription {
        scene_text: SCENE_TEXT.to_owned(),
        scene_files: vec![("parameter.obj".to_owned(), b"v 0 0 0\n".to_vec())],
        facts: vec![("seed", "7".to_owned())],
        format: Format::default(),
    }
}

fn create(folder: &Path) -> Result<Bag, BagError> {
    Bag::create(folder, synthetic::encoder(), description())
}

/// Records a second of simulation time, as a run does.
fn record_second(folder: &Path) -> BagReport {
    let bag = create(folder).unwrap();
    let reporter = bag.reporter();
    let mut fanout = Fanout::new();
    fanout.add(Box::new(bag), Delivery::Every { depth: 64 }).unwrap();
    (1..=1000).for_each(|tick| fanout.publish(&synthetic::packet(tick)));
    let (ends, errors) = fanout.close(Duration::from_secs(60));
    assert!(ends[0].is_closed && errors.is_empty(), "{errors:?}");
    reporter.report()
}

/// The contents of a recording as read by `rosbags` and `mcap-ros2-support`.
fn read_back(folder: &Path) -> Value {
    let json = peers::run("read_bag.py", &[folder.to_str().unwrap()]);
    serde_json::from_str(&json).unwrap()
}

/// Number of messages on each topic in a second of the synthetic scene.
///
/// Oracle: the rates in `synthetic::outputs`, the ticks at which its snapshots have large parts,
/// and its five commands.
fn expected_counts() -> BTreeMap<String, u64> {
    let state = 100;
    let counts = [
        ("/clock", 1000),
        ("/jamgrip/wrench", state),
        ("/jamgrip/flange/pose", state),
        ("/jamgrip/flange/twist", state),
        ("/jamgrip/flange/wrench", state),
        ("/jamgrip/contacts", 20),
        ("/jamgrip/contact_markers", 20),
        ("/jamgrip/membrane", 20),
        ("/jamgrip/membrane/mesh", 1),
        ("/jamgrip/membrane/marker", 10),
        ("/jamgrip/grains", 10),
        ("/jamgrip/pressure", 50),
        ("/jamgrip/vacuum_state", 50),
        ("/jamgrip/object_detection_status", 50),
        ("/jamgrip/joint_states", state),
        ("/jamgrip/statistics", 5),
        ("/diagnostics", 1),
        ("/tf", state),
        ("/tf_static", 1),
        ("/jamgrip/vacuum_cmd", 1),
        ("/jamgrip/flange/pose_cmd", 1),
        // The command for an unknown object, and the release.
        ("/jamgrip/object_cmd", 2),
        // Not used in this second; readiness only concerns waiting subscribers.
        ("/jamgrip/joint_commands", 0),
        ("/jamgrip/ready", 0),
        ("/jamgrip/world_change", 0),
        ("/jamgrip/state_digest", 1000),
        ("/jamgrip/object/cylinder/contact_wrench", state),
        ("/jamgrip/object/cylinder/pose", state),
        ("/jamgrip/object/cylinder/twist", state),
        ("/jamgrip/object/cylinder/pose_cmd", 1),
    ];
    counts.map(|(name, count)| (name.to_owned(), count)).into()
}

#[test]
fn a_second_has_the_expected_counts() {
    let folder = tempfile::tempdir().unwrap();
    let report = record_second(&folder.path().join("bag"));
    let found: BTreeMap<String, u64> = report.message_counts.into_iter().collect();
    assert_eq!(found, expected_counts());
}

#[test]
fn the_mcap_crate_reads_the_encoded_messages() {
    let folder = tempfile::tempdir().unwrap();
    record_second(&folder.path().join("bag"));
    let bytes = fs::read(folder.path().join("bag/bag_0.mcap")).unwrap();
    let encoder: Arc<Encoder> = synthetic::encoder();
    // Oracle: the encoder's messages, in the order of ticks, by topic.
    let mut expected: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
    let mut expect = |message: &jamgrip::wire::topics::Message| {
        let topic = &encoder.topics()[message.topic].name;
        expected.entry(topic.clone()).or_default().push(message.cdr.clone());
    };
    encoder.latched(0).iter().for_each(&mut expect);
    for packet in (1..=1000).map(synthetic::packet) {
        for record in &packet.snapshot.commands {
            expect(&encoder.commands().encode(&record.command, 0));
        }
        packet.messages(&encoder).iter().for_each(&mut expect);
    }
    let mut found: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        assert_eq!(message.data[..4], [0, 1, 0, 0], "CDR, little endian");
        if message.channel.topic == "/jamgrip/state_digest" {
            continue;
        }
        found.entry(message.channel.topic.clone()).or_default().push(message.data[4..].to_vec());
    }
    assert!(found == expected);
}

#[test]
fn other_libraries_read_every_topic() {
    let folder = tempfile::tempdir().unwrap();
    // A name with characters that are special in YAML.
    let bag = folder.path().join("bag: 'first', #1");
    record_second(&bag);
    let read = read_back(&bag);
    let topics = read["rosbags"]["topics"].as_object().unwrap();
    let counts: BTreeMap<String, u64> =
        topics.iter().map(|(name, it)| (name.clone(), it["count"].as_u64().unwrap())).collect();
    assert_eq!(counts, expected_counts());
    // The first messages are logged at the start of the first tick, the last at the end of the
    // last.
    assert_eq!(read["rosbags"]["start_ns"], 0);
    assert_eq!(read["rosbags"]["end_ns"].as_u64().unwrap() / 1000, 1_000_000);
    let mcap = &read["mcap"];
    assert_eq!(mcap["profile"], "ros2");
    assert!(mcap["library"].as_str().unwrap().starts_with("jamgrip "));
    assert_eq!(mcap["compressions"], serde_json::json!(["zstd"]));
    assert_eq!(mcap["attachments"]["scene.yaml"], SCENE_TEXT);
    assert_eq!(mcap["attachments"]["scene_file/parameter.obj"], "v 0 0 0\n");
    assert_eq!(mcap["metadata"]["jamgrip"]["seed"], "7");
    assert_eq!(mcap["metadata"]["jamgrip_end"]["state_digest"], format!("{DIGEST:016x}"));
    let metadata = mcap["metadata"]["rosbag2"]["serialized_metadata"].as_str().unwrap();
    assert!(metadata.starts_with("version: 9\nstorage_identifier: mcap\n"));
    let qos = mcap["qos"]["/tf_static"].as_str().unwrap();
    assert!(qos.contains("durability: transient_local") && qos.contains("depth: 1\n"), "{qos}");
}

#[test]
fn values_arrive_in_other_libraries() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    record_second(&bag);
    let read = read_back(&bag);
    let first = |topic: &str| read["rosbags"]["topics"][topic]["first"].clone();
    // Oracle: the numbers of `synthetic::snapshot` at the first tick at which each is due.
    assert_eq!(first("/jamgrip/wrench")["wrench"]["force"]["z"], -9.81);
    assert_eq!(first("/jamgrip/wrench")["header"]["frame_id"], "gripper_flange");
    assert_eq!(first("/jamgrip/pressure")["fluid_pressure"], 101_325.0 - 40_000.02);
    assert_eq!(first("/jamgrip/vacuum_state")["object_detection"]["status"], 1);
    assert_eq!(first("/jamgrip/statistics")["tick"], 200);
    assert_eq!(first("/jamgrip/statistics")["sinks"][0]["name"], "bag");
    assert_eq!(first("/jamgrip/statistics")["phase"], "lift");
    assert_eq!(first("/jamgrip/contacts")["contacts"][0]["object"], "cylinder");
    assert_eq!(first("/jamgrip/contacts")["contacts"][0]["tangential_force"]["y"], 0.3);
    // 250 grains, at most 100 in a message: every third.
    let grains = first("/jamgrip/grains");
    assert_eq!((grains["width"].as_u64(), grains["point_step"].as_u64()), (Some(84), Some(36)));
    assert_eq!(grains["fields"][8]["name"], "id");
    assert_eq!(first("/jamgrip/membrane")["point_step"], 32);
    assert_eq!(first("/jamgrip/membrane/mesh")["triangles"].as_array().unwrap().len(), 2);
    assert_eq!(first("/jamgrip/membrane/marker")["points"].as_array().unwrap().len(), 6);
    let frames = first("/tf")["transforms"].clone();
    assert_eq!(frames[0]["child_frame_id"], "gripper_flange");
    assert_eq!(frames[1]["child_frame_id"], "object/cylinder");
    // Rejected commands are recorded as received.
    assert_eq!(first("/jamgrip/flange/pose_cmd")["pose"]["position"]["z"], "nan");
    assert_eq!(first("/jamgrip/flange/pose_cmd")["header"]["stamp"]["nanosec"], 123);
    assert_eq!(first("/jamgrip/object_cmd")["object"], "ghost");
}

#[test]
fn metadata_is_written_from_the_beginning() {
    let folder = tempfile::tempdir().unwrap();
    let bag = create(folder.path()).unwrap();
    let text = fs::read_to_string(folder.path().join("metadata.yaml")).unwrap();
    assert!(text.starts_with("rosbag2_bagfile_information:\n  version: 9\n"), "{text}");
    drop(bag);
}

#[test]
fn a_folder_in_use_is_rejected_and_unchanged() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("thesis.tex"), "years of work").unwrap();
    let error = create(folder.path()).err().unwrap();
    assert!(matches!(error, BagError::FolderInUse { .. }), "{error}");
    assert!(error.to_string().contains("choose another folder"), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_folder_that_cannot_be_created_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let error = create(&file.join("bag")).err().unwrap();
    assert!(matches!(error, BagError::CannotCreate { .. }), "{error}");
}

/// Set only inside the mount namespace that the next test creates; there it is the whole test.
const SMALL_DISK: &str = "JAMGRIP_TEST_SMALL_DISK";

/// Oracle: the counts that the recording reported. Incompressible data fill a disk of 12 MB.
#[test]
fn a_recording_on_a_full_disk_stays_readable() {
    if let Some(disk) = std::env::var_os(SMALL_DISK) {
        return fill(Path::new(&disk));
    }
    let output_folder = tempfile::tempdir().unwrap();
    let myself = std::env::current_exe().unwrap();
    let test = "bags::a_recording_on_a_full_disk_stays_readable";
    // The disk is only visible to this process and ends with it, so the recording is copied.
    let script = "mkdir \"$0/disk\" && mount -t tmpfs -o size=12m none \"$0/disk\" && \
                  env \"$1=$0/disk\" \"$2\" --exact \"$3\" --nocapture && cp -r \"$0/disk/bag\" \"$0/\"";
    let output = Process::new("unshare")
        .args(["--mount", "--map-root-user", "sh", "-ec", script])
        .arg(output_folder.path())
        .args([SMALL_DISK.as_ref(), myself.as_os_str(), test.as_ref()])
        .output()
        .unwrap();
    let output_text = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{output_text}");
    let bag = output_folder.path().join("bag");
    let read = read_back(&bag);
    // Oracle: the counts that the recording itself reported, written by `fill`.
    let reported: BTreeMap<String, u64> =
        serde_json::from_str(&fs::read_to_string(bag.join("reported.json")).unwrap()).unwrap();
    for (topic, count) in &reported {
        assert_eq!(read["rosbags"]["topics"][topic]["count"], *count, "{topic}");
    }
    assert!(100 < reported["/jamgrip/grains"], "megabytes were recorded");
}

/// Records until the disk is full, and checks the error messages.
fn fill(disk: &Path) {
    let folder = disk.join("bag");
    fs::write(disk.join("other"), vec![0; 9 << 20]).unwrap();
    let error = create(&folder).err().unwrap();
    assert!(error.to_string().contains("at least 4 MiB of free space"), "{error}");
    fs::remove_file(disk.join("other")).unwrap();
    let mut bag = create(&folder).unwrap();
    let reporter = bag.reporter();
    let error = (1..100_000)
        .find_map(|tick| bag.write(&synthetic::incompressible_packet(tick)).err())
        .unwrap();
    let text = error.to_string();
    assert!(text.contains("the disk is full after") && text.contains("free some space"), "{text}");
    // The same error for every packet from now on; closing has nothing left to do.
    assert_eq!(bag.write(&synthetic::packet(100_000)).unwrap_err().to_string(), text);
    bag.close().unwrap();
    let counts: BTreeMap<String, u64> = reporter.report().message_counts.into_iter().collect();
    fs::write(folder.join("reported.json"), serde_json::to_string(&counts).unwrap()).unwrap();
}

#[test]
fn a_killed_recording_keeps_flushed_data() {
    let folder = tempfile::tempdir().unwrap();
    let mut bag = create(folder.path()).unwrap();
    (1..=300).for_each(|tick| bag.write(&synthetic::packet(tick)).unwrap());
    bag.idle().unwrap(); // as happens every second
    let report = bag.reporter().report();
    let name = folder.path().file_name().unwrap().to_str().unwrap().to_owned();
    // The present contents of the file are what a killed process leaves.
    let bytes = fs::read(folder.path().join(format!("{name}_0.mcap"))).unwrap();
    let options = mcap::read::Options::IgnoreEndMagic.into();
    let found = mcap::MessageStream::new_with_options(&bytes, options).unwrap();
    let n_found = found.take_while(Result::is_ok).count() as u64;
    let n_reported: u64 = report.message_counts.iter().map(|(_, count)| count).sum();
    // Oracle: the counts that the recording reported when it flushed.
    assert_eq!(n_found, n_reported);
    assert!(300 < n_found);
}

/// Oracle: the number of ticks over the length of a file; two independent libraries read all files,
/// and each file begins with the latched messages.
#[test]
fn a_long_recording_is_split_into_self_contained_files() {
    let folder = tempfile::tempdir().unwrap();
    for (name, format, n_files) in [
        ("by_time", Format { split_ns: Some(250_000_000), ..Format::default() }, 4),
        ("by_size", Format { split_bytes: Some(1), ..Format::default() }, 0),
        ("lz4", Format { compression: BagCompression::Lz4, ..Format::default() }, 1),
        ("none", Format { compression: BagCompression::Uncompressed, ..Format::default() }, 1),
    ] {
        let bag_folder = folder.path().join(name);
        let mut bag = Bag::create(
            &bag_folder,
            synthetic::encoder(),
            RunDescription { format, ..description() },
        )
        .unwrap();
        for tick in 1..=1000 {
            bag.write(&synthetic::packet(tick)).unwrap();
            if tick == 100 {
                bag.idle().unwrap();
            }
            if name == "by_size" && tick == 5 {
                break;
            }
        }
        bag.close().unwrap();
        let read = read_back(&bag_folder);
        let n_found = read["mcap"]["files"].as_u64().unwrap();
        assert!(n_found == n_files || n_files == 0, "{name}: {n_found} files");
        let counts = &read["mcap"]["counts"];
        let n_ticks = if name == "by_size" { 5 } else { 1000 };
        assert_eq!(counts["/jamgrip/state_digest"], n_ticks, "{name}");
        assert_eq!(counts["/tf_static"].as_u64(), Some(n_found), "{name}: repeated in each file");
        assert_eq!(counts["/jamgrip/membrane/mesh"].as_u64(), Some(n_found), "{name}");
        for first in read["mcap"]["first_topics"].as_array().unwrap() {
            let first: Vec<&str> =
                first.as_array().unwrap().iter().filter_map(Value::as_str).collect();
            assert!(first.contains(&"/tf_static"), "{name}: {first:?}");
            assert!(first.contains(&"/jamgrip/membrane/mesh"), "{name}: {first:?}");
        }
        let expected = match name {
            "lz4" => "lz4",
            "none" => "",
            _ => "zstd",
        };
        assert_eq!(read["mcap"]["compressions"], serde_json::json!([expected]), "{name}");
        let findings = jamgrip::bag::check::check(&bag_folder).unwrap();
        assert!(findings.is_empty(), "{name}: {findings:?}");
    }
}

/// Oracle: the numbers of `synthetic::snapshot`, and an independent HTML parser.
#[test]
fn a_page_shows_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    record_second(&bag);
    let page = jamgrip::replay::page::html(&bag).unwrap();
    let file = folder.path().join("report.html");
    fs::write(&file, &page).unwrap();
    let read = peers::run("read_page.py", &[file.to_str().unwrap()]);
    assert!(!read.is_empty());
    for expected in [
        "Force on the gripper",
        "Gauge pressure in the gripper",
        "Heights",
        "command: gauge pressure -80 kPa",
        "command: release cylinder",
        "object detected, vacuum builds up",
        "phase lift",
    ] {
        assert!(page.contains(expected), "{expected}");
    }
    assert_eq!(page.matches("<figure>").count(), 6);
}

/// Processor time of this process's thread with this name (s).
fn thread_time_s(name: &str) -> f64 {
    for task in fs::read_dir("/proc/self/task").unwrap().map(|it| it.unwrap().path()) {
        let read = |file: &str| fs::read_to_string(task.join(file)).unwrap_or_default();
        if read("comm").trim() != name {
            continue;
        }
        // After the name in parentheses, the 12th and 13th fields are in hundredths of a second.
        let stat = read("stat");
        let fields: Vec<&str> = stat.rsplit(") ").next().unwrap().split(' ').collect();
        let ticks: f64 = fields[11..13].iter().map(|it| it.parse::<f64>().unwrap()).sum();
        return ticks / 100.0;
    }
    panic!("no thread {name}");
}

/// Records 1 kHz of states and 100 Hz of all grains and vertices in real time, with incompressible
/// numbers, for two seconds or `JAMGRIP_RECORD_SECONDS`. Oracles: all messages are recorded;
/// writing takes less processor time than the recorded time, however busy the machine is.
#[test]
fn a_recording_keeps_up_with_real_time() {
    let seconds = std::env::var("JAMGRIP_RECORD_SECONDS").ok().and_then(|it| it.parse().ok());
    let n_ticks: u64 = 1000 * seconds.unwrap_or(2);
    let mut scene = by_tick::scene();
    scene.outputs.state_rate = 1000.0;
    scene.outputs.pressure_rate = 1000.0;
    let encoder = Arc::new(Encoder::new(&Arc::new(scene.clone()), &[], &[]));
    let mut noise = Random::new(1, Stream::Position);
    let mut vectors = |n: usize| -> Vec<Vec3> {
        (0..n).map(|_| Vec3::from_fn(|_, _| noise.between(-1.0, 1.0))).collect()
    };
    let lists: Vec<(Vec<Vec3>, Vec<Vec3>)> =
        (0..8).map(|_| (vectors(by_tick::N_GRAINS), vectors(by_tick::N_VERTICES))).collect();
    let folder = tempfile::tempdir().unwrap();
    let bag_folder = folder.path().join("bag");
    let bag = Bag::create(&bag_folder, encoder, description()).unwrap();
    let reporter = bag.reporter();
    let mut fanout = Fanout::new();
    let depth = usize::try_from(n_ticks).unwrap();
    fanout.add(Box::new(bag), Delivery::Latest { depth }).unwrap();
    let mut system = by_tick::Synthetic::new("cylinder");
    let (grains, membrane) = (system.grains(), system.membrane());
    #[expect(clippy::disallowed_methods, reason = "the test runs in real time")]
    let start = std::time::Instant::now();
    for tick in 1..=n_ticks {
        system.snapshot.tick = jamgrip::base::Tick(tick);
        system.snapshot.time_ns = tick * 1_000_000;
        let mut snapshot = system.snapshot.clone();
        if tick.is_multiple_of(10) {
            let (of_grains, of_vertices) = &lists[usize::try_from(tick / 10 % 8).unwrap()];
            snapshot.grains =
                Some(GrainsSnapshot { positions: of_grains.clone(), ..grains.clone() });
            let positions = of_vertices.clone();
            snapshot.membrane = Some(MembraneSnapshot { positions, ..membrane.clone() });
        }
        fanout.publish(&Arc::new(Packet::new(snapshot, None)));
        let due = Duration::from_millis(tick);
        std::thread::sleep(due.saturating_sub(start.elapsed()));
    }
    while fanout.counters()[0].n_written < n_ticks {
        assert!(start.elapsed() < Duration::from_millis(n_ticks) + Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(1));
    }
    let load = thread_time_s("sink-bag") / Duration::from_millis(n_ticks).as_secs_f64();
    assert!(load < 1.0, "{load} s of processor time for each recorded second");
    let (ends, errors) = fanout.close(Duration::from_secs(60));
    assert!(errors.is_empty(), "{errors:?}");
    let counters = &ends[0].counters;
    assert_eq!((counters.n_dropped, counters.n_written), (0, n_ticks));
    let counts: BTreeMap<String, u64> = reporter.report().message_counts.into_iter().collect();
    assert_eq!((counts["/jamgrip/wrench"], counts["/jamgrip/grains"]), (n_ticks, n_ticks / 10));
    assert_eq!(counts["/jamgrip/membrane"], n_ticks / 10);
    let n_bytes = fs::metadata(bag_folder.join("bag_0.mcap")).unwrap().len();
    // Shown with `--nocapture`.
    let text = format!("{n_ticks} ticks, {n_bytes} bytes, {:.1} % of a processor", 100.0 * load);
    writeln!(std::io::stderr().lock(), "{text}").unwrap();
}
