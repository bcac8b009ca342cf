//! Commands and setpoints: which commands are rejected, limited and counted, and their effect.
#![expect(clippy::print_stderr, reason = "prints measured values")]

use jamgrip::{
    base::{Pose, Real, Vec3, random::Random, random::Stream, real::Twist},
    command::{
        Command, CommandCounts, CommandError, Limit, Outcome, PoseCommand,
        apply::{CommandProcessor, Frames},
    },
    cosim::{FLANGE, Inputs},
    session::Session,
};

use crate::coarse::{self, flange_to, pose};

const TICK_NS: u64 = 1_000_000;

/// Flange and object are rotated and away from the origin, so that frames matter.
fn frames() -> Frames {
    let object =
        Pose::new(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2));
    let flange = Pose::new(Vec3::new(0.0, 0.0, 0.101), Vec3::new(0.0, 0.7, 0.0));
    Frames { flange, objects: vec![object] }
}

fn processor() -> CommandProcessor {
    CommandProcessor::new(&coarse::scene(&[]))
}

/// Processes one command.
fn take(processor: &mut CommandProcessor, command: Command, now_ns: u64) -> (Inputs, Outcome) {
    let (inputs, records) = processor.take(std::slice::from_ref(&command), &frames(), now_ns);
    assert_eq!(records.len(), 1);
    // Debug text is equal for NaN too.
    assert_eq!(format!("{:?}", records[0].command), format!("{command:?}"), "recorded as received");
    (inputs, records[0].outcome.clone())
}

fn drive(object: &str, pose: PoseCommand) -> Command {
    Command::ObjectPose { object: object.to_owned(), pose }
}

/// Both kinds of pose commands.
fn both(pose: &PoseCommand) -> [Command; 2] {
    [Command::FlangePose(pose.clone()), drive("cylinder", pose.clone())]
}

/// Asserts that `rejected` is rejected for `reason`, is counted, and does not change the setpoints.
fn check_rejected(rejected: Command, reason: impl Fn(&CommandError) -> bool) {
    let mut processor = processor();
    let (before, _) = processor.take(&[], &frames(), TICK_NS);
    let (after, outcome) = take(&mut processor, rejected.clone(), 2 * TICK_NS);
    let Outcome::Rejected(why) = outcome else { panic!("{rejected:?}: {outcome:?}") };
    assert!(reason(&why), "{rejected:?}: {why}");
    let counts = CommandCounts { n_rejected: 1, ..CommandCounts::default() };
    assert_eq!(processor.counts(), counts, "{rejected:?}");
    assert_eq!(format!("{after:?}"), format!("{before:?}"), "{rejected:?} changed the setpoints");
    assert!(!processor.is_driven(0));
}

#[test]
fn numbers_that_are_not_finite_are_rejected() {
    for bad in [Real::NAN, Real::INFINITY, Real::NEG_INFINITY] {
        let finite = |why: &CommandError| matches!(why, CommandError::NotFinite { .. });
        check_rejected(Command::Vacuum { gauge_pa: bad }, finite);
        for k in 0..3 {
            let mut it = pose(Vec3::new(0.0, 0.0, 0.1));
            it.position[k] = bad;
            both(&it).into_iter().for_each(|command| check_rejected(command, finite));
        }
        for k in 0..4 {
            let mut it = pose(Vec3::new(0.0, 0.0, 0.1));
            it.orientation[k] = bad;
            both(&it).into_iter().for_each(|command| check_rejected(command, finite));
        }
    }
}

#[test]
fn numbers_that_overflow_in_world_coordinates_are_rejected() {
    for frame in ["world", "gripper_flange", "object/cylinder"] {
        for size in [1e160, 1.7e308] {
            let mut it = pose(Vec3::new(size, -size, size));
            it.frame_id = frame.to_owned();
            both(&it).into_iter().for_each(|command| {
                check_rejected(command, |why| matches!(why, CommandError::NotFinite { .. }));
            });
        }
    }
}

#[test]
fn quaternions_that_are_not_normalized_are_rejected() {
    for bad in [[0.0; 4], [0.0, 0.0, 0.0, 1.002], [0.0, 0.0, 0.0, 0.998], [1.0; 4], [1e200; 4]] {
        let it = PoseCommand { orientation: bad, ..pose(Vec3::zeros()) };
        both(&it).into_iter().for_each(|command| {
            check_rejected(command, |why| matches!(why, CommandError::NotNormalized { .. }));
        });
    }
    // A small deviation, as in single precision, is accepted and normalized.
    let it = PoseCommand { orientation: [0.0, 0.0, 0.0, 1.0005], ..pose(Vec3::z() * 0.101) };
    let (inputs, outcome) = take(&mut processor(), Command::FlangePose(it), TICK_NS);
    assert_eq!(outcome, Outcome::Applied);
    assert!((inputs.flange_target.rotation.coords.norm() - 1.0).abs() < 1e-15);
}

#[test]
fn unknown_frames_and_objects_are_rejected_and_known_ones_listed() {
    let it = PoseCommand { frame_id: "moon".to_owned(), ..pose(Vec3::zeros()) };
    both(&it).into_iter().for_each(|command| {
        check_rejected(command, |why| {
            why.to_string()
                == "unknown frame `moon`: use one of world, gripper_flange, object/cylinder"
        });
    });
    let unknown =
        |why: &CommandError| why.to_string() == "unknown object `ball`: the scene has cylinder";
    check_rejected(drive("ball", pose(Vec3::zeros())), unknown);
    check_rejected(Command::ObjectRelease { object: "ball".to_owned() }, unknown);
}

#[test]
fn poses_are_interpreted_in_their_frame() {
    // Oracle: rigid motions by hand; the object's frame is rotated by 90° about z.
    for (frame, expected) in [
        ("", Vec3::new(0.01, 0.0, 0.0)),
        ("world", Vec3::new(0.01, 0.0, 0.0)),
        ("object/cylinder", Vec3::new(0.1, 0.21, 0.3)),
        ("gripper_flange", Vec3::new(0.01 * Real::cos(0.7), 0.0, 0.101 - 0.01 * Real::sin(0.7))),
    ] {
        let it = PoseCommand { frame_id: frame.to_owned(), ..pose(Vec3::x() * 0.01) };
        let (inputs, _) = take(&mut processor(), Command::FlangePose(it), TICK_NS);
        let found = inputs.flange_target.translation.vector;
        assert!((found - expected).norm() < 1e-15, "{frame}: {found:?}");
    }
}

#[test]
fn pressure_out_of_the_pump_range_is_clamped_and_counted() {
    for (requested_pa, set_pa) in [(-200e3, -95e3), (1e9, 20e3)] {
        let mut processor = processor();
        let (inputs, outcome) =
            take(&mut processor, Command::Vacuum { gauge_pa: requested_pa }, TICK_NS);
        assert_eq!(outcome, Outcome::Limited(Limit::PumpRange { requested_pa, set_pa }));
        assert!(inputs.gauge_setpoint.to_bits() == set_pa.to_bits(), "{}", inputs.gauge_setpoint);
        assert_eq!(processor.counts(), CommandCounts { n_limited: 1, ..CommandCounts::default() });
    }
    for gauge_pa in [-95e3, 0.0, 20e3] {
        let (_, outcome) = take(&mut processor(), Command::Vacuum { gauge_pa }, TICK_NS);
        assert_eq!(outcome, Outcome::Applied, "{gauge_pa} Pa is within the range");
    }
}

#[test]
fn a_pose_jump_is_limited_and_counted() {
    let mut processor = processor();
    // Half a millimeter per millisecond is the speed limit of the flange, 500 mm/s.
    for tick in 1..=100_u32 {
        let z = 0.101 - 0.5e-3 * f64::from(tick);
        let (_, outcome) = take(&mut processor, flange_to(z), u64::from(tick) * TICK_NS);
        assert_eq!(outcome, Outcome::Applied, "tick {tick}");
    }
    let (inputs, outcome) = take(&mut processor, flange_to(0.101), 101 * TICK_NS);
    let Outcome::Limited(Limit::PoseJump { distance_m, allowed_m }) = outcome else {
        panic!("{outcome:?}")
    };
    assert!((distance_m - 0.05).abs() < 1e-12 && allowed_m < 0.01, "{distance_m} {allowed_m}");
    // The target is approached within the limits.
    assert!((inputs.flange_target.translation.z - 0.101).abs() < 1e-15);
    let counts = CommandCounts { n_applied: 100, n_limited: 1, n_rejected: 0 };
    assert_eq!(processor.counts(), counts);
}

#[test]
fn timeout_and_release_end_a_drive() {
    let mut processor = processor();
    let near = pose(Vec3::new(0.1, 0.2, 0.3));
    let (inputs, outcome) = take(&mut processor, drive("cylinder", near.clone()), TICK_NS);
    assert_eq!(outcome, Outcome::Applied);
    assert!(inputs.drives[0].is_some() && processor.is_driven(0));
    // Oracle: the timeout of the scene, 500 ms after the last command.
    processor.take(&[], &frames(), 501 * TICK_NS);
    assert!(processor.is_driven(0), "still within the timeout");
    let (inputs, _) = processor.take(&[], &frames(), 502 * TICK_NS);
    assert!(inputs.drives[0].is_none() && !processor.is_driven(0));
    take(&mut processor, drive("cylinder", near), 600 * TICK_NS);
    let release = Command::ObjectRelease { object: "cylinder".to_owned() };
    let (inputs, outcome) = take(&mut processor, release, 601 * TICK_NS);
    assert_eq!(outcome, Outcome::Applied);
    assert!(inputs.drives[0].is_none() && !processor.is_driven(0));
}

/// Lifts the object off the table with up to 100 mm/s, but not up to the gripper.
fn driven(overrides: &[&str]) -> Session {
    let mut session = coarse::session(1, overrides);
    for tick in 0..80_u32 {
        let z = 0.025 + 1e-4 * f64::from(tick);
        let command = drive("cylinder", pose(Vec3::new(0.0, 0.0, z)));
        session.tick(&[command]).unwrap();
    }
    assert!(session.processor().is_driven(0));
    session
}

fn twist(session: &Session) -> Twist {
    session.coupled().world.motion(0).twist
}

#[test]
fn a_released_object_keeps_its_velocity() {
    let g = 9.81;
    let mut session = driven(&[]);
    let before = twist(&session).linear;
    assert!(before.z > 0.05, "driven at {before:?}");
    session.tick(&[Command::ObjectRelease { object: "cylinder".to_owned() }]).unwrap();
    // Oracle: free flight, v − g t. Tolerance: rounding.
    let after = twist(&session).linear;
    let expected = before - Vec3::z() * g * 1e-3;
    eprintln!("released at {}, then {}", before.z, after.z);
    assert!((after - expected).norm() < 1e-9, "{after:?} instead of {expected:?}");
}

#[test]
fn a_driven_object_falls_after_the_timeout() {
    let mut session = driven(&["object.drive_timeout=20 ms"]);
    for _ in 0..20 {
        session.tick(&[]).unwrap();
        assert!(session.processor().is_driven(0));
    }
    let held = twist(&session).linear;
    session.tick(&[]).unwrap();
    assert!(!session.processor().is_driven(0), "free after 20 ms without commands");
    // Oracle: free flight. Tolerance: rounding.
    let gained = twist(&session).linear - held;
    assert!((gained + Vec3::z() * 9.81e-3).norm() < 1e-9, "{gained:?}");
}

#[test]
fn the_flange_keeps_its_limits_for_any_command() {
    let mut session =
        coarse::session(1, &["flange.speed_max=250 mm/s", "flange.acceleration_max=2 m/s^2"]);
    let flange = session.scene().flange;
    let mut random = Random::new(5, Stream::Position);
    let tick = 1e-3;
    let (mut fastest, mut strongest) = (0.0_f64, 0.0_f64);
    for step in 0..120 {
        let mut commands = Vec::new();
        if step % 7 == 0 {
            let position = Vec3::from_fn(|_, _| random.between(-0.3, 0.3)) + Vec3::z() * 0.5;
            let turn = Vec3::from_fn(|_, _| random.between(-0.5, 0.5));
            let q = Pose::new(position, turn).rotation.coords;
            let orientation = [q.x, q.y, q.z, q.w];
            commands.push(Command::FlangePose(PoseCommand { orientation, ..pose(position) }));
        }
        let flange_of = |session: &Session| session.coupled().system.state.walls[FLANGE];
        let (pose_before, before) = (flange_of(&session).pose, flange_of(&session).twist);
        session.tick(&commands).unwrap();
        let (pose_after, after) = (flange_of(&session).pose, flange_of(&session).twist);
        // Oracle: the scene's limits. Tolerance: rounding.
        let slack = 1.0 + 1e-9;
        assert!(after.linear.norm() <= flange.speed_max * slack);
        assert!(after.angular.norm() <= flange.angular_speed_max * slack);
        let change = (after.linear - before.linear).norm() / tick;
        let turn_change = (after.angular - before.angular).norm() / tick;
        assert!(change <= flange.acceleration_max * slack, "{change} m/s²");
        assert!(turn_change <= flange.angular_acceleration_max * slack, "{turn_change} rad/s²");
        // The pose must be consistent with the velocity.
        let distance = (pose_after.translation.vector - pose_before.translation.vector).norm();
        assert!(distance <= flange.speed_max * tick * slack, "{distance} m in a tick");
        let angle = pose_after.rotation.angle_to(&pose_before.rotation);
        assert!(angle <= flange.angular_speed_max * tick * slack, "{angle} rad in a tick");
        (fastest, strongest) = (fastest.max(after.linear.norm()), strongest.max(change));
    }
    // The limits are reached, so the test can fail.
    eprintln!("fastest {fastest} m/s, strongest {strongest} m/s²");
    assert!(strongest > 0.99 * flange.acceleration_max && fastest > 0.1);
}
