//! The same bits every time: for any number of threads, for a run resumed at any tick, and whenever
//! the neighbor lists are built.

use std::{io::Write, process::Command as Process};

use jamgrip::{
    base::{
        Pose, Vec3,
        digest::Digest,
        lanes::{self, Kernel, Lanes, Width},
        parallel,
    },
    command::Command,
    cosim::{Coupled, Inputs},
    session::Session,
};

use crate::coarse;

const N_TICKS: usize = 120;

/// Pushes the bag over the object under growing vacuum; the digest after every tick.
fn script(session: &mut Session) -> Vec<u64> {
    let mut digests = vec![session.digest()];
    for tick in 0..N_TICKS {
        let commands = match tick {
            0 => vec![coarse::flange_to(0.078)],
            60 => vec![Command::Vacuum { gauge_pa: -60e3 }],
            _ => Vec::new(),
        };
        session.tick(&commands).unwrap();
        digests.push(session.digest());
    }
    digests
}

#[test]
fn one_two_and_seven_threads_give_the_same_bits_and_so_does_a_second_run() {
    let mut session = coarse::session(1, &[]);
    let expected = script(&mut session);
    // The script does something: the bag is on the object, and air is drawn.
    let push = session.means().membrane_on_objects[0].force.norm();
    assert!(push > 1.0, "pushed with {push} N");
    assert!(session.coupled().system.state.gauge < -50e3);
    assert!(session.coupled().system.scratch.neighbors.n_builds > 1, "lists were built again");
    for n_threads in [1, 2, 7] {
        // Oracle: the first run, to the last bit.
        assert_eq!(script(&mut coarse::session(n_threads, &[])), expected, "{n_threads} threads");
    }
}

/// Number of lanes that `lanes::widest` uses in this process.
fn lanes_used() -> usize {
    struct Probe<'a>(&'a mut usize);
    impl Kernel for Probe<'_> {
        #[inline(always)]
        fn run<L: Lanes>(self) {
            *self.0 = L::N;
        }
    }
    let mut n = 0;
    lanes::widest(Probe(&mut n));
    n
}

/// Set in the process that runs the script of the next test with at most this many lanes.
const LANES: &str = "JAMGRIP_TEST_LANES";
/// The settled start state, for that process.
const START: &str = "JAMGRIP_TEST_START";

/// Oracle: plain numbers, one at a time, to the last bit. The limit on the width holds for a whole
/// process, so each width runs in a separate process and does not affect other tests.
#[test]
#[cfg(target_arch = "x86_64")]
fn registers_of_any_width_give_the_same_bits() {
    if let Ok(limit) = std::env::var(LANES) {
        return print_script_with_lanes(&limit);
    }
    let has_four = is_x86_feature_detected!("avx2");
    let has_eight = is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl");
    let has = format!("this processor: AVX2 {has_four}, AVX-512 (F, DQ, VL) {has_eight}");
    let all = [(1, true), (4, has_four), (8, has_eight)];
    let (there, missing): (Vec<_>, Vec<_>) = all.into_iter().partition(|it| it.1);
    let mut out = std::io::stderr().lock();
    writeln!(out, "registers_of_any_width_give_the_same_bits: {has}").unwrap();
    for (width, _) in missing {
        writeln!(out, "NOT RUN: {width} lanes, which this processor does not have").unwrap();
    }
    drop(out);
    assert!(1 < there.len(), "NOT RUN: nothing to compare with one lane; {has}");

    let folder = tempfile::tempdir().unwrap();
    let start = folder.path().join("start");
    std::fs::write(&start, coarse::start_state()).unwrap();
    let runs: Vec<(usize, String)> = there
        .iter()
        .map(|(limit, _)| {
            let test = "determinism::registers_of_any_width_give_the_same_bits";
            let output = Process::new(std::env::current_exe().unwrap())
                .args(["--exact", test, "--nocapture"])
                .env(LANES, limit.to_string())
                .env(START, &start)
                .output()
                .unwrap();
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            assert!(output.status.success(), "{limit} lanes: {text}");
            let line = text.lines().find_map(|it| it.split_once("lanes used: "));
            let (n, digests) = line.unwrap().1.split_once("; ").unwrap();
            (n.parse().unwrap(), digests.to_owned())
        })
        .collect();
    let widths: Vec<usize> = runs.iter().map(|it| it.0).collect();
    let expected: Vec<usize> = there.iter().map(|it| it.0).collect();
    assert_eq!(widths, expected, "each run used the requested width; {has}");
    for (width, digests) in &runs {
        assert_eq!(digests.split(' ').count(), N_TICKS + 1);
        assert_eq!(*digests, runs[0].1, "{width} lanes against one");
    }
}

/// Runs the script in this process with a limit on the width, and prints what came out.
#[cfg(target_arch = "x86_64")]
fn print_script_with_lanes(limit: &str) {
    lanes::limit(match limit {
        "1" => Width::One,
        "4" => Width::Four,
        _ => Width::Eight,
    });
    let start = std::fs::read(std::env::var_os(START).unwrap()).unwrap();
    let mut session = Session::from_start_state(coarse::compiled(1, &[]), &start).unwrap();
    let digests: Vec<String> = script(&mut session).iter().map(|it| format!("{it:016x}")).collect();
    let n = lanes_used();
    writeln!(std::io::stdout().lock(), "\nlanes used: {n}; {}", digests.join(" ")).unwrap();
}

#[test]
fn a_run_continues_from_a_saved_start_state_with_the_same_bits() {
    let mut settled = Session::settle(coarse::compiled(1, &[]), &mut |_| {}).unwrap();
    let bytes = settled.start_state();
    // Oracle: settling on two threads gave the same bytes.
    assert!(bytes == coarse::start_state(), "settling depends on the number of threads");
    let mut read = Session::from_start_state(coarse::compiled(1, &[]), &bytes).unwrap();
    for _ in 0..20 {
        assert_eq!(read.digest(), settled.digest(), "tick {}", read.now().0);
        for session in [&mut read, &mut settled] {
            session.tick(&[coarse::flange_to(0.09)]).unwrap();
        }
    }
}

#[test]
fn another_seed_gives_another_packing() {
    let other = Session::settle(coarse::compiled(2, &["seed=2"]), &mut |_| {}).unwrap();
    assert_ne!(other.digest(), coarse::session(1, &[]).digest());
}

/// The digest of everything after each tick, and how often lists were built.
fn coupled_script(mut coupled: Coupled) -> (Vec<u64>, u64) {
    let mut digests = Vec::new();
    let inputs = Inputs {
        gauge_setpoint: -30e3,
        flange_target: Pose::translation(0.0, 0.0, 0.08),
        drives: vec![None],
    };
    parallel::lead(&parallel::ThreadPool::new(1).unwrap(), || {
        for _ in 0..80 {
            coupled.advance(&inputs);
            let mut digest = Digest::new();
            coupled.system.state.digest(&mut digest);
            coupled.world.digest(&mut digest);
            digests.push(digest.finish());
        }
    });
    (digests, coupled.system.scratch.neighbors.n_builds)
}

#[test]
fn results_do_not_depend_on_when_the_neighbor_lists_are_built() {
    let (expected, n_builds) = coupled_script(coarse::coupled(|_| {}));
    for share in [0.2, 3.0] {
        let other = coarse::coupled(|model| model.skin *= share);
        let (digests, n_builds_now) = coupled_script(other);
        assert_ne!(n_builds_now, n_builds, "the lists were built at other times");
        // Oracle: the run with the usual skin, to the last bit.
        assert_eq!(digests, expected, "skin × {share}: {n_builds_now} builds, not {n_builds}");
    }
}

#[test]
fn the_filling_does_not_depend_on_it_either() {
    let fill = |share: f64| {
        let mut compiled = coarse::compiled(2, &[]);
        compiled.model.skin *= share;
        Session::settle(compiled, &mut |_| {}).unwrap().digest()
    };
    // Oracle: lists that reach far, so that no contact can be missed between two builds.
    assert_eq!(fill(1.0), fill(3.0), "contacts were missed between two builds");
}

/// Pushes, evacuates, lifts, and drives the object for a while, so that all saved quantities change.
fn eventful(tick: usize) -> Vec<Command> {
    let object = || "cylinder".to_owned();
    match tick {
        0 => vec![coarse::flange_to(0.078)],
        40 => vec![Command::Vacuum { gauge_pa: -60e3 }],
        60 => vec![coarse::flange_to(0.12)],
        100..130 if tick.is_multiple_of(10) => {
            let pose = coarse::pose(Vec3::new(0.001, 0.0, 0.035));
            vec![Command::ObjectPose { object: object(), pose }]
        }
        140 => vec![Command::ObjectRelease { object: object() }],
        _ => Vec::new(),
    }
}

#[test]
fn a_run_resumed_at_any_tick_continues_with_the_same_bits() {
    const N_TICKS: usize = 170;
    let mut session = coarse::session(1, &[]);
    let (mut digests, mut saved) = (vec![session.digest()], Vec::new());
    let mut touched_table = false;
    for tick in 0..N_TICKS {
        if tick.is_multiple_of(28) {
            saved.push((tick, session.save().unwrap()));
        }
        session.tick(&eventful(tick)).unwrap();
        digests.push(session.digest());
        touched_table |= session.coupled().world.motion(0).pose.translation.z < 0.0251;
    }
    assert!(touched_table, "the object stood on the table, so that rapier had contacts to save");
    for (start, bytes) in saved {
        let mut resumed = Session::resume(coarse::compiled(2, &[]), &bytes).unwrap();
        // Oracle: the run that never stopped, to the last bit.
        assert_eq!(resumed.digest(), digests[start], "resumed at tick {start}");
        assert!(
            resumed.save().unwrap() == bytes,
            "tick {start}: saved again, the bytes are the same"
        );
        for tick in start..N_TICKS {
            resumed.tick(&eventful(tick)).unwrap();
            let expected = digests[tick + 1];
            assert_eq!(resumed.digest(), expected, "from tick {start}, after tick {tick}");
        }
        assert_eq!(resumed.processor().counts(), session.processor().counts());
    }
}

#[test]
fn bytes_of_another_scene_and_truncated_bytes_are_rejected() {
    let bytes = coarse::session(1, &[]).save().unwrap();
    for n in [0, 7, bytes.len() / 2, bytes.len() - 1] {
        assert!(Session::resume(coarse::compiled(1, &[]), &bytes[..n]).is_err(), "{n} bytes");
    }
    let other = coarse::compiled(1, &["grains.count=281"]);
    let error = Session::resume(other, &bytes).err().unwrap().to_string();
    assert!(error.contains("280 grains, but the scene has 281"), "{error}");
}
