//! Picks up and lifts an object from another process: a ROS 2 node that only uses topics.
//!
//!     cargo run --release -- run launch_configs/pick_and_lift.yaml --set controller=topics
//!     cargo run --release --example pick_and_lift_controller
//!
//! The decisions are those of the built-in controller, with the parameters of the scene file given
//! as first argument and of the `key=value` overrides after it. This file adds what a controller in
//! another process needs: it waits until the simulation is discovered, sends a first command to
//! start the run, keeps the newest message of each topic, and uses the simulation's `/clock`
//! instead of its own.

use std::{
    error::Error,
    io::Write,
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

use jamgrip::{
    base::{Pose, Quat, Vec3},
    command::Command,
    controller::{Observation, Phase, PickAndLift},
    ros::{
        discovery::DiscoveryRange,
        node::{Body, LOG_FILTER, Publisher, RosError, RosNode, Subscription},
    },
    scene::{self, Controller, Scene},
    wire::{
        from_ros::CommandCodec,
        messages::{
            geometry_msgs::{self, PoseStamped, WrenchStamped},
            jamgrip_msgs::VacuumState,
            rosgraph_msgs::Clock,
        },
        topics::{CommonTopic, ObjectTopic, Topic, common, object_topic, topics},
    },
};

/// Wall-clock time without a clock message after which the simulation is assumed to have ended.
const TIMEOUT: Duration = Duration::from_secs(30);
/// Wall-clock time between two attempts to start the run.
const START_PERIOD: Duration = Duration::from_millis(500);
/// Wall-clock time between two polls of the topics; the clock ticks at most once a millisecond.
const POLL_PERIOD: Duration = Duration::from_micros(500);

fn main() -> Result<(), Box<dyn Error>> {
    env_logger::Builder::new().parse_filters(LOG_FILTER).parse_default_env().init();
    let scene = read_scene()?;
    let Controller::Builtin(parameters) = &scene.controller else {
        return Err(
            "this example needs `controller: builtin`, because it uses its parameters".into()
        );
    };
    let range = DiscoveryRange::choose(&scene.outputs.ros, |name| std::env::var(name).ok())?;
    let node = RosNode::join_as("pick_and_lift_controller", &range)?;
    let topics = topics(&scene);
    let mut inputs = Inputs::open(&node, &topics)?;
    let commands = Commands::open(&node, &scene, &topics)?;
    let mut out = std::io::stdout().lock();

    writeln!(out, "waiting for the simulation in domain {}", range.domain_id)?;
    while !commands.are_matched(&node) {
        std::thread::sleep(Duration::from_millis(10));
    }
    let mut controller = PickAndLift::new(parameters);
    let mut log = Log::default();
    let mut received_at = now();
    let mut started_at = None;
    while !controller.is_done() {
        // The simulation may discover this node later than the reverse: repeat a first command
        // until it arrives.
        if !inputs.are_complete() && started_at.is_none_or(|it| START_PERIOD < now() - it) {
            commands.send(&[Command::Vacuum { gauge_pa: 0.0 }])?;
            started_at = Some(now());
        }
        std::thread::sleep(POLL_PERIOD);
        if let Some(observation) = inputs.read()? {
            received_at = now();
            commands.send(&controller.decide(&observation))?;
            log.update(controller.phase(), &observation, &mut out)?;
        } else if TIMEOUT < now() - received_at {
            return Err(format!("no clock message for {TIMEOUT:?}: did the simulation end?").into());
        }
    }
    writeln!(out, "lifted {:.1} mm, held for {:.2} s", log.lifted * 1e3, log.held_s)?;
    Ok(())
}

/// The scene named on the command line, with its overrides.
fn read_scene() -> Result<Scene, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or_else(|| "launch_configs/pick_and_lift.yaml".to_owned());
    Ok(scene::load(&PathBuf::from(file), &arguments.collect::<Vec<_>>())?)
}

#[expect(clippy::disallowed_methods, reason = "timeouts need wall-clock time")]
fn now() -> Instant {
    Instant::now()
}

/// The subscribed topics, and the newest value of each.
struct Inputs {
    clock: Subscription<Clock>,
    wrench: Subscription<WrenchStamped>,
    flange: Subscription<PoseStamped>,
    object: Subscription<PoseStamped>,
    vacuum: Subscription<VacuumState>,
    contact_force: Option<Vec3>,
    flange_pose: Option<Pose>,
    object_pose: Option<Pose>,
    gauge_pa: Option<f64>,
}

impl Inputs {
    fn open(node: &Arc<RosNode>, topics: &[Topic]) -> Result<Self, RosError> {
        Ok(Self {
            clock: node.subscription(&topics[common(CommonTopic::Clock)])?,
            wrench: node.subscription(&topics[common(CommonTopic::Wrench)])?,
            flange: node.subscription(&topics[common(CommonTopic::FlangePose)])?,
            object: node.subscription(&topics[object_topic(0, ObjectTopic::Pose)])?,
            vacuum: node.subscription(&topics[common(CommonTopic::VacuumState)])?,
            contact_force: None,
            flange_pose: None,
            object_pose: None,
            gauge_pa: None,
        })
    }

    /// True once every topic has been received.
    fn are_complete(&self) -> bool {
        self.contact_force.is_some()
            && self.flange_pose.is_some()
            && self.object_pose.is_some()
            && self.gauge_pa.is_some()
    }

    /// The current observation, if time has advanced and every topic has been received.
    fn read(&mut self) -> Result<Option<Observation>, Box<dyn Error>> {
        let time_s = newest(&self.clock)?
            .map(|it| f64::from(it.clock.sec) + 1e-9 * f64::from(it.clock.nanosec));
        if let Some(message) = newest(&self.wrench)? {
            let force = message.wrench.force;
            self.contact_force = Some(Vec3::new(force.x, force.y, force.z));
        }
        if let Some(message) = newest(&self.flange)? {
            self.flange_pose = Some(pose(&message.pose));
        }
        if let Some(message) = newest(&self.object)? {
            self.object_pose = Some(pose(&message.pose));
        }
        if let Some(message) = newest(&self.vacuum)? {
            self.gauge_pa = Some(message.gauge);
        }
        let (
            Some(time_s),
            Some(contact_force),
            Some(flange_pose),
            Some(object_pose),
            Some(gauge_pa),
        ) = (time_s, self.contact_force, self.flange_pose, self.object_pose, self.gauge_pa)
        else {
            return Ok(None);
        };
        Ok(Some(Observation { time_s, flange_pose, contact_force, gauge_pa, object_pose }))
    }
}

/// The newest of the waiting messages.
fn newest<M>(subscription: &Subscription<M>) -> Result<Option<M>, Box<dyn Error>>
where
    M: serde::de::DeserializeOwned + 'static,
{
    let mut newest = None;
    while let Some((message, _)) = subscription.take()? {
        newest = Some(message);
    }
    Ok(newest)
}

fn pose(message: &geometry_msgs::Pose) -> Pose {
    let (p, q) = (&message.position, &message.orientation);
    let rotation = Quat::new_normalize(nalgebra::Quaternion::new(q.w, q.x, q.y, q.z));
    Pose::from_parts(Vec3::new(p.x, p.y, p.z).into(), rotation)
}

/// The publishers of the commands.
struct Commands {
    codec: CommandCodec,
    publishers: Vec<Option<(String, Publisher<Body>)>>,
}

impl Commands {
    fn open(node: &Arc<RosNode>, scene: &Scene, topics: &[Topic]) -> Result<Self, RosError> {
        let needed = [common(CommonTopic::VacuumCommand), common(CommonTopic::FlangePoseCommand)];
        let open = |(index, topic): (usize, &Topic)| {
            if needed.contains(&index) {
                node.publisher(topic).map(|it| Some((topic.name.clone(), it)))
            } else {
                Ok(None)
            }
        };
        let publishers = topics.iter().enumerate().map(open).collect::<Result<_, _>>()?;
        let objects = scene.objects.iter().map(|it| it.name.clone()).collect();
        Ok(Self { codec: CommandCodec::new(topics.to_vec(), objects), publishers })
    }

    /// True once every command topic has a reader.
    fn are_matched(&self, node: &RosNode) -> bool {
        self.publishers.iter().flatten().all(|(topic, _)| 0 < node.n_readers(topic))
    }

    fn send(&self, commands: &[Command]) -> Result<(), Box<dyn Error>> {
        for command in commands {
            let message = self.codec.encode(command, 0);
            if let Some((_, publisher)) = &self.publishers[message.topic] {
                publisher.publish(Body::new(message.cdr))?;
            }
        }
        Ok(())
    }
}

/// Prints what happens.
#[derive(Default)]
struct Log {
    phase: Option<Phase>,
    rest_height: f64,
    lifted: f64,
    held_since: f64,
    held_s: f64,
}

impl Log {
    fn update(
        &mut self,
        phase: Phase,
        observation: &Observation,
        out: &mut impl Write,
    ) -> std::io::Result<()> {
        let height = observation.object_pose.translation.z;
        if self.phase != Some(phase) {
            match phase {
                Phase::Lift => self.rest_height = height,
                Phase::Hold => self.held_since = observation.time_s,
                _ => {}
            }
            self.phase = Some(phase);
            writeln!(
                out,
                "{:8.3} s  {:<9} flange {:.1} mm, object {:.1} mm, push {:.2} N, {:.1} kPa",
                observation.time_s,
                phase.name(),
                observation.flange_pose.translation.z * 1e3,
                height * 1e3,
                observation.contact_force.norm(),
                observation.gauge_pa * 1e-3,
            )?;
            out.flush()?;
        }
        if (Phase::Lift..=Phase::Hold).contains(&phase) {
            self.lifted = self.lifted.max(height - self.rest_height);
        }
        if phase == Phase::Hold && 0.5 * self.lifted < height - self.rest_height {
            self.held_s = observation.time_s - self.held_since;
        }
        Ok(())
    }
}
