//! The same bits every time: whatever the number of threads, wherever a run is taken up, whenever
//! the neighbour lists are built.

use jamgrip::{
    base::{Pose, digest::Digest, parallel},
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
    assert!(session.coupled().state.gauge < -50e3);
    assert!(session.coupled().scratch.neighbours.n_builds > 1, "lists were built again");
    for n_threads in [1, 2, 7] {
        // Oracle: the first run, to the last bit.
        assert_eq!(script(&mut coarse::session(n_threads, &[])), expected, "{n_threads} threads");
    }
}

#[test]
fn a_run_goes_on_from_its_start_state_as_if_it_had_just_settled() {
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
    parallel::lead(&parallel::pool(1).unwrap(), || {
        for _ in 0..80 {
            coupled.advance(&inputs);
            let mut digest = Digest::new();
            coupled.state.digest(&mut digest);
            coupled.world.digest(&mut digest);
            digests.push(digest.finish());
        }
    });
    (digests, coupled.scratch.neighbours.n_builds)
}

#[test]
fn it_does_not_matter_when_the_neighbour_lists_are_built() {
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
fn it_does_not_matter_for_the_filling_either() {
    let fill = |share: f64| {
        let mut compiled = coarse::compiled(2, &[]);
        compiled.model.skin *= share;
        Session::settle(compiled, &mut |_| {}).unwrap().digest()
    };
    // Oracle: lists that reach far, so that no contact can be missed between two builds.
    assert_eq!(fill(1.0), fill(3.0), "contacts were missed between two builds");
}
