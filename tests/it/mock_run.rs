//! A complete run with a mock plant instead of the physics: real topics, real commands, and a spring as
//! the gripper.
//!
//! It tests controllers in other processes within seconds; the real run takes minutes.

use std::{sync::Arc, time::Duration};

use jamgrip::{
    base::{Pose, Vec3},
    command::Command,
    io::{
        sink::{Packet, Sink},
        source::Source,
    },
    ros::{
        node::{RosNode, RosSink},
        subscribe::RosSource,
    },
    wire::to_ros::Encoder,
};

use crate::by_tick::{Synthetic, scene};

const GRIPPER_LENGTH: f64 = 0.04;
const OBJECT_REST: f64 = 0.035;
const OBJECT_TOP: f64 = 0.07;
const STIFFNESS: f64 = 500.0;
/// Weight of the mock plant's object [N].
pub(crate) const WEIGHT: f64 = 2.4;
const LAG: f64 = 0.05;
const GAUGE_HOLDING: f64 = -50e3;

struct MockPlant {
    flange: Vec3,
    object_z: f64,
    gauge: f64,
    setpoint: f64,
    /// Height of the flange above the object while it is gripped [m].
    grip: Option<f64>,
}

impl MockPlant {
    fn tick(&mut self, commands: &[Command]) {
        for command in commands {
            match command {
                Command::Vacuum { gauge_pa } => self.setpoint = *gauge_pa,
                Command::FlangePose(pose) => self.flange = Vec3::from(pose.position),
                _ => {}
            }
        }
        self.gauge += (self.setpoint - self.gauge) * 0.001 / LAG;
        let height = self.flange.z - self.object_z;
        self.grip = match self.grip {
            Some(height) if self.gauge < GAUGE_HOLDING => Some(height),
            None if self.gauge < GAUGE_HOLDING && height < GRIPPER_LENGTH + 0.025 => Some(height),
            _ => None,
        };
        self.object_z = self.grip.map_or(OBJECT_REST, |it| OBJECT_REST.max(self.flange.z - it));
    }

    /// Force of the object on the gripper [N].
    fn force(&self) -> f64 {
        if OBJECT_REST < self.object_z {
            return -WEIGHT;
        }
        STIFFNESS * (OBJECT_TOP - (self.flange.z - GRIPPER_LENGTH)).max(0.0)
    }
}

/// Runs until `is_over`. Waits for the first command, as a real run does.
pub(crate) fn run(node: &Arc<RosNode>, mut is_over: impl FnMut() -> bool) {
    let encoder = Arc::new(Encoder::new(&Arc::new(scene()), &[], &[]));
    let mut sink = RosSink::new(node, &encoder).unwrap();
    let mut source = RosSource::new(node, &encoder).unwrap();
    let mut system = Synthetic::new("cylinder");
    let flange = Vec3::new(0.0, 0.0, 0.15);
    let mut plant =
        MockPlant { flange, object_z: OBJECT_REST, gauge: 0.0, setpoint: 0.0, grip: None };
    let mut tick = 0;
    while !is_over() {
        std::thread::sleep(Duration::from_micros(300));
        if !source.has_received() {
            continue;
        }
        plant.tick(&source.drain(&system.snapshot));
        tick += 1;
        system.advance_to(tick);
        system.lift_lists_to(plant.flange.z);
        let snapshot = &mut system.snapshot;
        snapshot.flange.pose = Pose::from(plant.flange);
        snapshot.objects[0].body.pose = Pose::from(Vec3::new(0.0, 0.0, plant.object_z));
        snapshot.contact_wrench.force = Vec3::new(0.0, 0.0, plant.force());
        snapshot.chamber.gauge = plant.gauge;
        snapshot.chamber.gauge_setpoint = plant.setpoint;
        let is_due = tick % 33 == 0;
        let (grains, membrane) = (system.grains(), system.membrane());
        system.snapshot.grains = is_due.then_some(grains);
        system.snapshot.membrane = is_due.then_some(membrane);
        sink.write(&Packet::new(system.snapshot.clone(), None)).unwrap();
    }
    sink.close().unwrap();
}
