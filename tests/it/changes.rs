//! Changes of the world between ticks: reset, insert, remove, teleport.

use jamgrip::{
    base::{Pose, Real, Vec3, real::Twist},
    command::{
        Command,
        change::{Change, Scope, SettledScene},
    },
    cosim::{FLANGE, change_error::ChangeError},
    scene::{Object, Shape},
    session::Session,
};

use crate::coarse;

/// Runs `n` ticks with a vacuum while the flange moves down.
fn run(session: &mut Session, n: u32) -> u64 {
    for i in 0..n {
        let down = coarse::flange_to(0.101 - 0.0002 * Real::from(i));
        session.tick(&[Command::Vacuum { gauge_pa: -50e3 }, down]).unwrap();
    }
    session.digest()
}

/// A ball of the object's material at `position` [m].
fn ball(session: &Session, name: &str, position: Vec3) -> Change {
    let own = session.scene().objects[0].clone();
    Change::Insert(Box::new(Object {
        name: name.to_owned(),
        shape: Shape::Sphere { radius: 0.02 },
        pose: Pose::from(position),
        ..own
    }))
}

fn height(session: &Session, i: usize) -> Real {
    session.coupled().world.motion(i).pose.translation.z
}

/// Oracle: the bits of the first run.
#[test]
fn a_reset_restores_every_bit() {
    let mut session = coarse::session(1, &[]);
    let start = session.digest();
    let first = run(&mut session, 40);
    session.change(&ball(&session, "ball", Vec3::new(0.3, 0.0, 0.2))).unwrap();
    session.change(&Change::Remove { object: "cylinder".to_owned() }).unwrap();
    session.tick(&[]).unwrap();
    session.change(&Change::Reset(Scope::ALL)).unwrap();
    assert_eq!(session.digest(), start, "the start");
    assert_eq!(run(&mut session, 40), first, "the run after it");
}

/// Oracle: the documented effect of each part of a reset.
#[test]
fn time_state_and_spawned_objects_are_reset_separately() {
    let mut session = coarse::session(1, &[]);
    session.change(&ball(&session, "ball", Vec3::new(0.3, 0.0, 0.2))).unwrap();
    run(&mut session, 20);
    let fallen = height(&session, 1);
    session.change(&Change::Reset(Scope { time: true, ..Scope::default() })).unwrap();
    assert_eq!((session.time_ns(), session.scene().objects.len()), (0, 2));
    assert_eq!(height(&session, 1).to_bits(), fallen.to_bits(), "resetting time moves nothing");
    run(&mut session, 20);
    session.change(&Change::Reset(Scope { state: true, ..Scope::default() })).unwrap();
    assert_eq!(session.time_ns(), 20_000_000, "resetting the state keeps time");
    assert_eq!(height(&session, 1).to_bits(), 0.2_f64.to_bits(), "its initial height");
    session.change(&Change::Reset(Scope { spawned: true, ..Scope::default() })).unwrap();
    let names: Vec<&str> = session.scene().objects.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(names, ["cylinder"]);
}

/// Oracle: Galileo, h = g t²/2. Tolerance: the rigid-body steps of 0.1 ms cause an error of
/// g t dt/2 = 15 µm in 30 ms.
#[test]
fn an_inserted_object_falls() {
    let mut session = coarse::session(1, &[]);
    session.change(&ball(&session, "ball", Vec3::new(0.3, 0.0, 0.2))).unwrap();
    run(&mut session, 30);
    let distance = 0.2 - height(&session, 1);
    assert!((distance - 9.81 * 0.03 * 0.03 / 2.0).abs() < 2e-5, "{distance} m");
}

/// Oracle: the run without the object, which never touches anything.
#[test]
fn an_object_that_was_inserted_and_removed_leaves_no_trace() {
    let mut session = coarse::session(1, &[]);
    let undisturbed = run(&mut session, 20);
    session.change(&Change::Reset(Scope::ALL)).unwrap();
    session.change(&ball(&session, "ball", Vec3::new(0.3, 0.0, 0.2))).unwrap();
    session.change(&Change::Remove { object: "ball".to_owned() }).unwrap();
    assert_eq!(run(&mut session, 20), undisturbed);
}

/// Oracle: invalid changes are rejected with a reason and change nothing.
#[test]
fn overlapping_and_unknown_objects_are_rejected() {
    let mut session = coarse::session(1, &[]);
    let before = session.digest();
    for (what, position, with) in [
        ("in the table", Vec3::new(0.3, 0.0, 0.0), "the table"),
        ("in the cylinder", Vec3::new(0.0, 0.0, 0.04), "`cylinder`"),
        ("in the gripper", Vec3::new(0.0, 0.0, 0.085), "the gripper"),
    ] {
        let rejected = session.change(&ball(&session, "ball", position)).unwrap_err();
        let ChangeError::Overlap { with: found, .. } = rejected else { panic!("{rejected}") };
        assert_eq!(found, with, "{what}");
    }
    let taken = session.change(&ball(&session, "cylinder", Vec3::new(0.3, 0.0, 0.2)));
    assert!(matches!(taken, Err(ChangeError::NameTaken { .. })));
    let into_table = Change::PlaceFlange { pose: Pose::translation(0.2, 0.0, 0.01) };
    assert!(matches!(session.change(&into_table), Err(ChangeError::Overlap { .. })));
    let unknown = Change::Remove { object: "ball".to_owned() };
    assert!(matches!(session.change(&unknown), Err(ChangeError::UnknownObject { .. })));
    assert_eq!(session.digest(), before);
}

/// Oracle: a rigid motion. Every grain and vertex keeps its position in the flange's frame; the flange
/// stops, and no grain leaks. Tolerance: round-off of one rotation.
#[test]
fn the_gripper_moves_as_one_body() {
    let mut session = coarse::session(1, &[]);
    run(&mut session, 20);
    let local = |session: &Session| -> Vec<Vec3> {
        let state = &session.coupled().system.state;
        let flange = state.walls[FLANGE].pose;
        let points = state.grains.positions.iter().chain(&state.membrane.positions);
        points.map(|p| flange.inverse_transform_point(&(*p).into()).coords).collect()
    };
    let before = local(&session);
    let pose = Pose::new(Vec3::new(0.3, 0.1, 0.2), Vec3::new(0.0, 0.3, 1.0));
    session.change(&Change::PlaceFlange { pose }).unwrap();
    let after = local(&session);
    let moved = before.iter().zip(&after).map(|(a, b)| (a - b).norm()).fold(0.0, Real::max);
    assert!(moved < 1e-13, "{moved} m");
    assert_eq!(session.coupled().system.state.walls[FLANGE].twist, Twist::zero());
    // It stays at this pose, and nothing leaks: a tick would fail.
    for _ in 0..20 {
        session.tick(&[]).unwrap();
    }
    let now = session.coupled().system.state.walls[FLANGE].pose;
    assert!((now.translation.vector - pose.translation.vector).norm() < 1e-12);
}

/// Oracle: a run that starts with the same scene, bit for bit; also after a reset. The tick count of the
/// run continues.
#[test]
fn a_loaded_scene_runs_like_an_initial_scene() {
    let other = ["object.shape.sphere.radius=20 mm", "object.position=[0 mm, 0 mm, 20 mm]"];
    let mut first = coarse::session(1, &other);
    let start = first.digest();
    let expected = run(&mut first, 30);

    let mut session = coarse::session(1, &[]);
    run(&mut session, 10);
    let (scene, start_state) = (coarse::scene(&other), coarse::start_state().to_vec());
    let settled = SettledScene { scene, start: start_state, keeps_time: false };
    let load = Change::LoadScene(Box::new(settled.clone()));
    // As stored in a recording.
    session.change(&Change::from_bytes(&load.to_bytes()).unwrap()).unwrap();
    assert_eq!((session.digest(), session.time_ns(), session.run_tick().0), (start, 0, 10));
    assert_eq!(run(&mut session, 30), expected);
    assert_eq!(session.processor().counts().n_applied + session.processor().counts().n_limited, 80);
    assert!(session.save().is_none(), "a checkpoint would belong to the first scene");
    session.change(&Change::Reset(Scope::ALL)).unwrap();
    assert_eq!(run(&mut session, 30), expected);

    let keeps = SettledScene { keeps_time: true, ..settled.clone() };
    session.change(&Change::LoadScene(Box::new(keeps))).unwrap();
    assert_eq!(session.time_ns(), 30_000_000, "time continues");
    run(&mut session, 1);
    let now = session.digest();
    let corrupt = SettledScene { start: vec![1, 2, 3], ..settled.clone() };
    let scene = coarse::scene(&["time.tick=2 ms", "outputs.state_rate=100 Hz"]);
    for wrong in [corrupt, SettledScene { scene, ..settled }] {
        let rejected = session.change(&Change::LoadScene(Box::new(wrong)));
        assert!(matches!(rejected, Err(ChangeError::Unusable(_))), "{rejected:?}");
        assert_eq!(session.digest(), now, "nothing has changed");
    }
}
