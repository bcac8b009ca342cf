//! Recordings that were killed, truncated, altered or written by other programs, and their repair.

use std::{
    fs,
    io::{BufRead, BufReader, Read, Write},
    path::{Path, PathBuf},
    process::{Command as Process, Stdio},
    time::Duration,
};

use jamgrip::{
    bag::{
        check,
        info::Info,
        reader::{Channel, Damage, Item, Reader},
        recording::Recording,
        recover,
        sink::{Bag, Format, RunDescription},
    },
    base::{
        Tick,
        random::{Random, Stream},
    },
    io::sink::{Packet, Sink},
    snapshot::checkpoint::Checkpoint,
};
use serde_json::Value;

use crate::{peers, synthetic};

fn description(format: Format) -> RunDescription {
    RunDescription {
        scene_text: "name: synthetic\n".to_owned(),
        scene_files: Vec::new(),
        facts: vec![("tick_ns", synthetic::TICK_NS.to_string())],
        format,
    }
}

fn create(folder: &Path) -> Bag {
    Bag::create(folder, synthetic::encoder(), description(Format::default())).unwrap()
}

fn packet(tick: u64) -> Packet {
    let snapshot = synthetic::snapshot(tick);
    let (time_ns, digest) = (snapshot.time_ns, snapshot.digest);
    let bytes = vec![7; 10_000];
    let checkpoint = Checkpoint { tick: Tick(tick), time_ns, digest, bytes };
    let checkpoints = tick.is_multiple_of(50).then_some(checkpoint);
    Packet::new(snapshot, None).with_checkpoints(checkpoints.into_iter().collect())
}

/// A recording of 200 ticks in about twenty chunks.
fn recording(folder: &Path) -> PathBuf {
    let mut bag = create(folder);
    for tick in 1..=200 {
        bag.write(&packet(tick)).unwrap();
        if tick.is_multiple_of(10) {
            bag.idle().unwrap();
        }
    }
    bag.close().unwrap();
    let name = folder.file_name().unwrap().to_str().unwrap();
    folder.join(format!("{name}_0.mcap"))
}

fn history(path: &Path) -> jamgrip::bag::recording::RunHistory {
    Recording::open(path).unwrap().history_without_scene(synthetic::TICK_NS).unwrap()
}

/// Messages, attachments and damaged parts in a prefix of a file.
fn count(bytes: &[u8]) -> (usize, usize, Vec<Damage>) {
    let (mut n_messages, mut n_attachments, mut damages) = (0, 0, Vec::new());
    for item in Reader::new(bytes, bytes.len() as u64) {
        match item {
            Item::Message(_) => n_messages += 1,
            Item::Attachment(_) => n_attachments += 1,
            Item::Damage(damage) => damages.push(damage),
            _ => {}
        }
    }
    (n_messages, n_attachments, damages)
}

/// Start, end and opcode of each record.
///
/// Oracle: the framing in the specification: one byte of opcode and eight of length.
fn records(bytes: &[u8]) -> Vec<(usize, usize, u8)> {
    let (mut at, mut found) = (8, Vec::new());
    while at + 9 <= bytes.len() - 8 {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap());
        let end = at + 9 + usize::try_from(length).unwrap();
        found.push((at, end, bytes[at]));
        at = end;
    }
    assert_eq!(at, bytes.len() - 8, "records fill the file");
    found
}

#[test]
fn a_truncated_recording_is_read_up_to_the_cut() {
    const CHUNK: u8 = 6;
    let folder = tempfile::tempdir().unwrap();
    let bytes = fs::read(recording(&folder.path().join("bag"))).unwrap();
    let records = records(&bytes);
    let (n_all, _, damages) = count(&bytes);
    assert!(damages.is_empty(), "{damages:?}");
    let n_chunks = records.iter().filter(|(.., kind)| *kind == CHUNK).count();
    assert!(20 <= n_chunks, "{n_chunks} chunks");
    let mut n_before = 0;
    for &(begin, end, kind) in &records {
        // At a record boundary: everything before it and nothing else.
        let (n_found, _, damages) = count(&bytes[..begin]);
        assert_eq!(n_found, n_before, "cut at {begin}");
        let is_closed = n_found == n_all && damages.is_empty();
        assert!(is_closed || matches!(damages[..], [Damage::NotClosed { .. }]), "{damages:?}");
        let n_with = if kind == CHUNK { count(&bytes[..end]).0 } else { n_before };
        for cut in
            [begin + 1, begin + 9, begin + (end - begin) / 3, end - (end - begin) / 4, end - 1]
        {
            let cut = cut.clamp(begin + 1, end - 1);
            let (n_found, _, damages) = count(&bytes[..cut]);
            assert!((n_before..=n_with).contains(&n_found), "cut at {cut}: {n_found}");
            let n_cuts = damages.iter().filter(|it| matches!(it, Damage::Cut { .. })).count();
            assert!(n_cuts == 1 || is_closed, "cut at {cut}: {damages:?}");
        }
        n_before = n_with;
    }
    assert_eq!(n_before, n_all);
}

#[test]
fn an_altered_chunk_is_dropped_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(&folder.path().join("bag"));
    let bytes = fs::read(&path).unwrap();
    let (n_all, ..) = count(&bytes);
    let chunks: Vec<_> = records(&bytes).into_iter().filter(|(.., kind)| *kind == 6).collect();
    let (begin, end, _) = chunks[7];
    let n_of_chunk = count(&bytes[..end]).0 - count(&bytes[..begin]).0;
    let mut altered = bytes.clone();
    altered[(begin + end) / 2] ^= 0x10;
    let (n_found, _, damages) = count(&altered);
    assert_eq!(n_found, n_all - n_of_chunk, "all messages except those of the chunk");
    assert!(matches!(damages[..], [Damage::BadChunk { .. }]), "{damages:?}");
    fs::write(&path, &altered).unwrap();
    let findings = check::check(path.parent().unwrap()).unwrap();
    assert!(findings.iter().any(|it| it.is_error && it.text.contains("chunk at byte")));
    assert!(findings.iter().any(|it| it.text.contains("ticks after")), "{findings:?}");
}

#[test]
fn a_complete_recording_has_no_findings() {
    let folder = tempfile::tempdir().unwrap();
    recording(&folder.path().join("bag"));
    let findings = check::check(&folder.path().join("bag")).unwrap();
    assert!(findings.is_empty(), "{findings:?}");
    // metadata.yaml is compared: one message too many is reported, for the topic and in total.
    let metadata = folder.path().join("bag/metadata.yaml");
    let text = fs::read_to_string(&metadata).unwrap();
    fs::write(&metadata, text.replace("message_count: 200\n", "message_count: 201\n")).unwrap();
    let findings = check::check(&folder.path().join("bag")).unwrap();
    assert!(findings.iter().any(|it| it.text.contains("/clock: 201 messages")), "{findings:?}");
    fs::remove_file(&metadata).unwrap();
    let findings = check::check(&folder.path().join("bag")).unwrap();
    assert!(findings[0].text.contains("it is missing"), "{findings:?}");
}

#[test]
fn other_libraries_read_repaired_recordings() {
    let folder = tempfile::tempdir().unwrap();
    let path = recording(&folder.path().join("bag"));
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() * 2 / 3]).unwrap();
    fs::remove_file(folder.path().join("bag/metadata.yaml")).unwrap();
    let damaged = folder.path().join("bag");
    let output = recover::default_output(&damaged);
    let saved = recover::recover(&damaged, &output).unwrap();
    assert!(matches!(saved.damages[..], [(_, Damage::Cut { .. })]), "{:?}", saved.damages);
    let error = recover::recover(&damaged, &output).unwrap_err().to_string();
    assert!(error.contains("already exists"), "{error}");
    // Oracle: two independent libraries, and the damaged file itself.
    let read: Value =
        serde_json::from_str(&peers::run("read_bag.py", &[output.to_str().unwrap()])).unwrap();
    assert_eq!(read["rosbags"]["message_count"], saved.n_messages);
    assert_eq!(saved.n_messages, count(&bytes[..bytes.len() * 2 / 3]).0 as u64);
    let qos = read["mcap"]["qos"]["/tf_static"].as_str().unwrap();
    assert!(qos.contains("durability: transient_local"), "{qos}");
    assert_eq!(read["mcap"]["attachments"]["scene.yaml"], "name: synthetic\n");
    let (before, after) = (history(&damaged), history(&output));
    assert_eq!(before.digests, after.digests);
    assert_eq!(before.commands, after.commands);
    assert!(after.broken_at.is_none() && after.gap_after.is_none());
    assert!(!after.checkpoints.is_empty());
    for checkpoint in &after.checkpoints {
        assert_eq!(checkpoint.read().unwrap(), vec![7; 10_000]);
    }
    let findings = check::check(&output).unwrap();
    assert!(findings.is_empty(), "{findings:?}");
}

#[test]
fn recordings_of_other_programs_are_repaired() {
    let folder = tempfile::tempdir().unwrap();
    let foreign = folder.path().join("theirs");
    peers::run("write_bag.py", &[foreign.to_str().unwrap()]);
    let complete = Info::read(&foreign).unwrap();
    assert!(complete.is_undamaged(), "{complete}");
    assert_eq!(complete.topics["/numbers"].n_messages, 500);
    let errors: Vec<_> =
        check::check(&foreign).unwrap().into_iter().filter(|it| it.is_error).collect();
    assert!(errors.is_empty(), "{errors:?}");
    let file = complete.files[0].path.clone();
    let bytes = fs::read(&file).unwrap();
    fs::write(&file, &bytes[..bytes.len() / 3]).unwrap();
    for (path, output) in [(foreign.clone(), "folder"), (file, "file.mcap")] {
        let output = folder.path().join(output);
        let saved = recover::recover(&path, &output).unwrap();
        assert!(0 < saved.n_messages && saved.n_messages < 600, "{}", saved.n_messages);
        assert!(Info::read(&output).unwrap().is_undamaged());
    }
    let saved = folder.path().join("folder");
    let read: Value =
        serde_json::from_str(&peers::run("read_bag.py", &[saved.to_str().unwrap()])).unwrap();
    // Oracle: the first message as `write_bag.py` wrote it.
    assert_eq!(read["rosbags"]["topics"]["/numbers"]["first"]["data"], 0.0);
    assert_eq!(read["rosbags"]["start_ns"], 1_700_000_000_000_000_000_u64);
}

#[test]
fn files_that_are_not_recordings_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.mcap");
    for bytes in [&b""[..], b"\x89MCAP0\r\n", b"a letter to a friend, of some length"] {
        fs::write(&path, bytes).unwrap();
        let output = folder.path().join("saved.mcap");
        let error = recover::recover(&path, &output).unwrap_err().to_string();
        assert!(error.contains("contains no readable messages"), "{error}");
        assert!(!output.exists());
        assert!(check::check(&path).unwrap().iter().any(|it| it.is_error));
    }
}

/// Environment variable with the folder for the killed process, which then only records.
const KILLED: &str = "JAMGRIP_TEST_KILLED_RECORDING";
/// Number of recordings to kill.
const N_KILLS: u64 = 110;

/// Records until it is killed, and prints the last tick after each flush.
fn record_until_killed(folder: &Path) {
    let mut bag = create(folder);
    let mut out = std::io::stdout().lock();
    for tick in 1..u64::MAX {
        bag.write(&packet(tick)).unwrap();
        // From time to time, as happens once a second in a run.
        if tick.is_multiple_of(7) {
            bag.idle().unwrap();
            writeln!(out, "flushed {tick}").unwrap();
        }
    }
}

/// Oracle: the ticks that the killed process reported as flushed, and the chain of digests.
#[test]
fn flushed_data_survive_a_hundred_kills() {
    if let Some(folder) = std::env::var_os(KILLED) {
        return record_until_killed(Path::new(&folder));
    }
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random::new(1, Stream::Position);
    let (mut n_flushed, mut n_cut) = (0, 0);
    for i in 0..N_KILLS {
        let bag = folder.path().join(format!("bag{i}"));
        let mut child = Process::new(std::env::current_exe().unwrap())
            .args(["--exact", "bags_damaged::flushed_data_survive_a_hundred_kills"])
            .arg("--nocapture")
            .env(KILLED, &bag)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        let mut flushed = read_flushed(&mut output);
        std::thread::sleep(Duration::from_secs_f64(random.between(0.0, 0.02)));
        child.kill().unwrap();
        child.wait().unwrap();
        let mut rest = String::new();
        output.read_to_string(&mut rest).unwrap();
        // The kill may truncate the last line.
        let complete = rest.rfind('\n').map_or("", |end| &rest[..end]);
        let later = complete.lines().filter_map(|it| it.strip_prefix("flushed ")?.parse().ok());
        flushed = later.max().unwrap_or(flushed).max(flushed);
        let output = folder.path().join("saved");
        let saved = recover::recover(&bag, &output).unwrap();
        n_cut += u64::from(saved.damages.iter().any(|(_, it)| matches!(it, Damage::Cut { .. })));
        let history = history(&output);
        assert!(flushed <= history.last_tick(), "{flushed} flushed, {} saved", history.last_tick());
        assert!(history.broken_at.is_none() && history.gap_after.is_none(), "kill {i}");
        assert_eq!(history.digests[0].0, 1, "kill {i}");
        assert!(Info::read(&output).unwrap().is_undamaged());
        fs::remove_dir_all(&output).unwrap();
        fs::remove_dir_all(&bag).unwrap();
        n_flushed += flushed;
    }
    // Shown with `--nocapture`.
    writeln!(std::io::stderr().lock(), "{N_KILLS} kills, {n_cut} in mid-record").unwrap();
    assert!(N_KILLS * 7 <= n_flushed, "every recording was flushed at least once: {n_flushed}");
}

/// Waits for the first flush.
fn read_flushed(output: &mut impl BufRead) -> u64 {
    for line in output.lines() {
        // The test harness may have written to the same line.
        if let Some((_, tick)) = line.unwrap().split_once("flushed ") {
            return tick.trim().parse().unwrap();
        }
    }
    panic!("the recording ended early");
}

/// Oracle: `write_variants.py`, which uses the library of the format's authors.
#[test]
fn every_variant_of_the_format_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let n_files: usize =
        peers::run("write_variants.py", &[folder.path().to_str().unwrap()]).trim().parse().unwrap();
    let files: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|it| it.unwrap().path()).collect();
    assert_eq!((n_files, files.len()), (384, 384));
    for file in files {
        let name = file.file_name().unwrap().to_str().unwrap().to_owned();
        let (mut messages, mut n_attached, mut n_metadata) = (Vec::new(), 0, 0);
        for item in Reader::open(&file).unwrap() {
            match item {
                Item::Message(it) => {
                    let (topic, type_name) = (it.channel.topic.clone(), it.channel.type_name());
                    let type_name = type_name.to_owned();
                    messages.push((topic, type_name, it.log_time, it.publish_time, it.data));
                }
                Item::Attachment(it) => {
                    assert_eq!((it.name.as_str(), it.times), ("file", (2, 1)), "{name}");
                    assert_eq!(it.data, b"contents", "{name}");
                    n_attached += 1;
                }
                Item::Metadata(it) => {
                    assert_eq!((it.name.as_str(), it.metadata["a"].as_str()), ("notes", "b"));
                    n_metadata += 1;
                }
                Item::Damage(damage) => panic!("{name}: {damage}"),
                _ => {}
            }
        }
        assert_eq!((messages.len(), n_attached, n_metadata), (5, 1, 1), "{name}");
        for (i, (topic, type_name, log_time, publish_time, data)) in
            messages.into_iter().enumerate()
        {
            let is_even = i.is_multiple_of(2);
            let expected = if is_even { ("/with", "pkg/msg/T") } else { ("/without", "") };
            assert_eq!((topic.as_str(), type_name.as_str()), expected, "{name}");
            assert_eq!((log_time, publish_time), (i as u64, 10 + i as u64), "{name}");
            assert_eq!(data, vec![u8::try_from(i).unwrap(); 40], "{name}");
        }
        // The repaired file has the same contents.
        let saved = folder.path().join("saved.mcap");
        assert_eq!(recover::recover(&file, &saved).unwrap().n_messages, 5, "{name}");
        fs::remove_file(&saved).unwrap();
    }
}

/// The contents of a file of the conformance data: messages as sequence and times, attachments,
/// metadata.
type FileContents = (Vec<(u32, u64, u64)>, usize, usize);

fn contents_of(file: &Path) -> FileContents {
    let (mut messages, mut n_attached, mut n_metadata) = (Vec::new(), 0, 0);
    for item in Reader::open(file).unwrap() {
        match item {
            Item::Message(it) => {
                let Channel { id, topic, metadata, .. } = &*it.channel;
                assert_eq!((*id, topic.as_str(), &it.data[..]), (1, "example", &[1, 2, 3][..]));
                let value = metadata.get("foo").map(String::as_str);
                match (&it.channel.schema, it.channel.encoding.as_str()) {
                    (Some(schema), "a") => {
                        assert_eq!((schema.name.as_str(), value), ("Example", Some("bar")));
                        assert_eq!(
                            (schema.encoding.as_str(), &schema.data[..]),
                            ("c", &[4, 5, 6][..])
                        );
                    }
                    (None, "text") => assert_eq!(value, None),
                    other => panic!("{other:?}"),
                }
                messages.push((it.sequence, it.log_time, it.publish_time));
            }
            Item::Attachment(it) => {
                assert_eq!(
                    (it.name.as_str(), it.times, &it.data[..]),
                    ("myFile", (2, 1), &[1, 2, 3][..])
                );
                assert_eq!(it.media_type, "application/octet-stream");
                n_attached += 1;
            }
            // A repaired file has an additional metadata record.
            Item::Metadata(it) if it.name == "myMetadata" => {
                assert_eq!(it.metadata["foo"], "bar");
                n_metadata += 1;
            }
            Item::Damage(damage) => panic!("{}: {damage}", file.display()),
            _ => {}
        }
    }
    (messages, n_attached, n_metadata)
}

/// Oracle: the inputs of the format's public conformance tests. `write_conformance.py` writes the
/// files and checks itself against published checksums.
#[test]
fn the_public_conformance_data_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let output = peers::run("write_conformance.py", &[folder.path().to_str().unwrap()]);
    assert_eq!(output.trim(), "416 7", "files, and how many have published checksums");
    let times = [0, 2, 1, 3, 3, 5, 4, 7, 8, 9];
    let ten = || (0..).zip(times).map(|(i, time)| (i, time, time)).collect();
    let files: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|it| it.unwrap().path()).collect();
    for file in files {
        let name = file.file_stem().unwrap().to_str().unwrap().to_owned();
        let expected: FileContents = match name.split('-').next().unwrap() {
            "NoData" => (vec![], 0, 0),
            "OneMessage" | "OneSchemalessMessage" => (vec![(10, 2, 1)], 0, 0),
            "OneAttachment" => (vec![], 1, 0),
            "OneMetadata" => (vec![], 0, 1),
            "TenMessages" => (ten(), 0, 0),
            other => panic!("{other}"),
        };
        assert_eq!(contents_of(&file), expected, "{name}");
        // The repaired file has the same contents; without messages, there is nothing to repair.
        if expected.0.is_empty() {
            continue;
        }
        let saved = folder.path().join("saved.mcap");
        recover::recover(&file, &saved).unwrap();
        assert_eq!(contents_of(&saved), expected, "{name}, saved");
        fs::remove_file(&saved).unwrap();
    }
}
