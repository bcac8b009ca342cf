//! A synthetic scene and snapshots, for tests that do not need the physics.

use std::sync::Arc;

use jamgrip::{
    base::{
        Pose, Quat, Tick, Vec3,
        real::{Twist, Wrench},
    },
    command::{Command, CommandCounts, CommandError, CommandRecord, Outcome, PoseCommand},
    io::sink::{Packet, RunStatistics, SinkCounters},
    scene::{
        Bag, BagCompression, Chamber, Controller, Flange, Grains, Lockstep, Material, Membrane,
        Object, OnError, OnFull, Outputs, Ros, Scene, Shape, Table, Time,
    },
    snapshot::{
        BodySnapshot, ChamberSnapshot, ContactSnapshot, GrainsSnapshot, JammingSnapshot,
        MembraneSnapshot, ObjectSnapshot, Snapshot,
    },
    wire::to_ros::Encoder,
};

/// Length of a tick [ns].
pub(crate) const TICK_NS: u64 = 1_000_000;
/// Name of the only object.
pub(crate) const OBJECT: &str = "cylinder";

/// A scene with round rates: 100 Hz for states, 10 Hz for grains, and so on.
pub(crate) fn scene() -> Scene {
    let material = Material { youngs_modulus: 5e6, poisson_ratio: 0.3, density: 1000.0 };
    Scene {
        name: "synthetic".to_owned(),
        seed: 7,
        time: Time { tick_ns: TICK_NS, substep: None, safety: 0.2, density_scaling: 1.0 },
        gravity: Vec3::new(0.0, 0.0, -9.81),
        grains: Grains {
            count: 300,
            radius_min: 1.8e-3,
            radius_max: 2.2e-3,
            material,
            friction: 0.5,
            dissipation_time: 1e-5,
            tangential_damping: 0.1,
        },
        membrane: Membrane {
            radius: 0.04,
            frequency: 4,
            thickness: 5e-4,
            material,
            friction: 0.5,
            spring_damping: 0.1,
            bending_stiffness: 1e-5,
            bending_damping: 1e-8,
            rest_length_shrink: 0.1,
            fill_stretch: 1.1,
            dissipation_time: 1e-5,
            tangential_damping: 0.1,
        },
        chamber: Chamber {
            ambient: 101_325.0,
            gauge_min: -90_000.0,
            gauge_max: 5_000.0,
            lag: 0.05,
            rate_max: 2e6,
        },
        flange: Flange {
            pose: Pose::translation(0.0, 0.0, 0.2),
            speed_max: 0.2,
            acceleration_max: 2.0,
            angular_speed_max: 1.0,
            angular_acceleration_max: 10.0,
        },
        table: Table { height: 0.0, friction: 0.5 },
        objects: vec![Object {
            name: OBJECT.to_owned(),
            shape: Shape::Cylinder { radius: 0.01, height: 0.04 },
            material,
            friction: 0.5,
            pose: Pose::translation(0.0, 0.0, 0.02),
            drive_timeout: 0.5,
        }],
        controller: Controller::Topics { duration: None, lockstep: Lockstep::OFF },
        outputs: outputs(),
    }
}

fn outputs() -> Outputs {
    Outputs {
        state_rate: 100.0,
        pressure_rate: 50.0,
        membrane_rate: 20.0,
        grains_rate: 10.0,
        contacts_rate: 20.0,
        statistics_rate: 5.0,
        grains_count_max: 100,
        ros: Ros { node: "/jamgrip".to_owned(), ..Ros::OFF },
        stream: false,
        bag: Bag {
            enabled: true,
            folder: None,
            on_full: OnFull::Wait,
            on_error: OnError::Continue,
            checkpoint_rate: None,
            compression: BagCompression::Zstd,
            split_size: None,
            split_duration: None,
        },
        real_time: false,
    }
}

/// Two triangles.
pub(crate) const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

/// Their vertices.
pub(crate) fn corners() -> Vec<Vec3> {
    vec![
        Vec3::new(0.0, 0.0, -0.04),
        Vec3::new(0.04, 0.0, 0.0),
        Vec3::new(0.0, 0.04, 0.0),
        Vec3::new(-0.04, 0.0, 0.0),
    ]
}

/// The encoder of the scene.
pub(crate) fn encoder() -> Arc<Encoder> {
    Arc::new(Encoder::new(&Arc::new(scene()), &TRIANGLES, &corners()))
}

/// The packet of a tick, with large parts at their rates.
pub(crate) fn packet(tick: u64) -> Arc<Packet> {
    Arc::new(Packet::new(snapshot(tick), tick.is_multiple_of(200).then(|| run(tick))))
}

/// A packet with many grains whose numbers look random, so that recordings grow quickly.
#[cfg(feature = "bag")]
pub(crate) fn incompressible_packet(tick: u64) -> Arc<Packet> {
    let mut snapshot = snapshot(tick);
    let mut noise =
        jamgrip::base::random::Random::new(tick, jamgrip::base::random::Stream::Position);
    let mut vector = || Vec3::from_fn(|_, _| noise.between(-1.0, 1.0));
    snapshot.grains = Some(GrainsSnapshot {
        positions: (0..100).map(|_| vector()).collect(),
        velocities: (0..100).map(|_| vector()).collect(),
        radii: (0..100).map(|_| vector().x).collect(),
        normal_forces: (0..100).map(|_| vector().x).collect(),
    });
    Arc::new(Packet::new(snapshot, None))
}

/// The snapshot of a tick. Its numbers depend on the tick, and none is zero.
pub(crate) fn snapshot(tick: u64) -> Snapshot {
    let t = tick as f64 * 1e-3;
    let wrench = |scale: f64| Wrench {
        force: Vec3::new(0.1, 0.2, -9.81) * scale,
        torque: Vec3::new(0.01, 0.02, 0.03) * scale,
    };
    let body = |z: f64| BodySnapshot {
        pose: Pose::from_parts(
            Vec3::new(0.01, 0.02, z + 0.1 * t).into(),
            Quat::from_euler_angles(0.1, 0.2, 0.3 + t),
        ),
        twist: Twist { linear: Vec3::new(0.0, 0.0, 0.1), angular: Vec3::new(0.0, 0.0, 1.0) },
    };
    Snapshot {
        tick: Tick(tick),
        time_ns: tick * TICK_NS,
        run_tick: Tick(tick),
        flange: body(0.2),
        objects: vec![ObjectSnapshot {
            name: OBJECT.to_owned(),
            body: body(0.02),
            contact_wrench: wrench(-1.0),
            membrane_wrench: wrench(-0.5),
            is_driven: false,
        }],
        contact_wrench: wrench(1.0),
        mount_wrench: wrench(2.0),
        chamber: ChamberSnapshot {
            gauge_setpoint: -80_000.0,
            gauge: -40_000.0 - t,
            ambient: 101_325.0,
            volume: 1.3e-4,
        },
        jamming: jamming(),
        membrane: tick.is_multiple_of(50).then(membrane),
        grains: tick.is_multiple_of(100).then(grains),
        contacts: tick.is_multiple_of(50).then(contacts),
        commands: commands(tick),
        command_counts: CommandCounts { n_applied: tick, n_limited: 2, n_rejected: 1 },
        digest: tick.wrapping_mul(0x9e37_79b9_7f4a_7c15),
    }
}

fn jamming() -> JammingSnapshot {
    JammingSnapshot {
        n_grain_contacts: 900,
        n_membrane_contacts: 120,
        n_object_contacts: 2,
        coordination_number: 5.5,
        jammed_fraction: 0.93,
        solid_fraction: 0.58,
        sliding_fraction: 0.1,
        kinetic_energy: 1e-6,
        overlap_ratio_max: 0.04,
        membrane_overlap_ratio_max: 0.12,
    }
}

fn membrane() -> MembraneSnapshot {
    MembraneSnapshot {
        positions: corners(),
        normals: vec![-Vec3::z(); 4],
        contact_pressures: vec![100.0, 200.0, 300.0, 400.0],
        strains: vec![0.01, 0.02, 0.03, 0.04],
    }
}

fn grains() -> GrainsSnapshot {
    let position = |i: u32| Vec3::new(f64::from(i) * 1e-3, 1e-3, -1e-3);
    GrainsSnapshot {
        positions: (0..250).map(position).collect(),
        radii: vec![2e-3; 250],
        velocities: vec![Vec3::new(1e-3, 2e-3, 3e-3); 250],
        normal_forces: (0..250).map(f64::from).collect(),
    }
}

fn contacts() -> Vec<ContactSnapshot> {
    let contact = |x: f64, normal_force: f64| ContactSnapshot {
        object: 0,
        point: Vec3::new(x, 0.0, 0.04),
        normal: Vec3::x(),
        force: Vec3::new(-normal_force, 0.3, 0.0),
        normal_force,
        overlap: 1e-5,
    };
    vec![contact(0.01, 1.0), contact(-0.01, 2.0)]
}

/// One command of each kind at tick 10, one of them rejected.
fn commands(tick: u64) -> Vec<CommandRecord> {
    if tick != 10 {
        return Vec::new();
    }
    let pose = PoseCommand {
        frame_id: "world".to_owned(),
        stamp_ns: 5_000_000_123,
        position: [0.0, 0.1, f64::NAN],
        orientation: [0.0, 0.0, 0.0, 1.0],
    };
    let reason = CommandError::NotFinite { field: "position.z", value: f64::NAN };
    let applied = |command| CommandRecord { command, outcome: Outcome::Applied };
    vec![
        applied(Command::Vacuum { gauge_pa: -80_000.0 }),
        CommandRecord {
            command: Command::FlangePose(pose.clone()),
            outcome: Outcome::Rejected(reason),
        },
        applied(Command::ObjectPose { object: OBJECT.to_owned(), pose: pose.clone() }),
        applied(Command::ObjectPose { object: "ghost".to_owned(), pose }),
        applied(Command::ObjectRelease { object: OBJECT.to_owned() }),
    ]
}

fn run(tick: u64) -> RunStatistics {
    RunStatistics {
        wall_time_s: tick as f64 * 1e-2,
        real_time_factor: 0.1,
        real_time_factor_mean: 0.11,
        substep_s: 2e-6,
        seed: 7,
        phase: "lift".to_owned(),
        sinks: vec![SinkCounters { name: "bag", n_written: tick, n_dropped: 0, n_failed: 0 }],
    }
}
