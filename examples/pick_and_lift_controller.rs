//! Picks up and lifts from another process: a ROS 2 node that sees and commands topics only.
//!
//!     cargo run --release -- run launch_configs/pick_and_lift.yaml --set controller=topics
//!     cargo run --release --example pick_and_lift_controller
//!
//! The decisions are those of the built-in controller, with the same parameters: those of the
//! scene file given as first argument, and of `key=value` overrides behind it. All that this file
//! adds is what a controller on the other side of a wire needs: it waits for the simulation to
//! listen, says a first command so that the run begins, keeps the newest of each topic, and goes
//! by the simulation's `/clock` instead of its own.

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

/// Wall time without a clock after which the simulation is taken for gone.
const TIMEOUT: Duration = Duration::from_secs(30);
/// Wall time between two tries to begin the run.
const CALL_PERIOD: Duration = Duration::from_millis(500);
/// Wall time between two looks at the topics; the clock ticks once a millisecond at best.
const PAUSE: Duration = Duration::from_micros(500);

fn main() -> Result<(), Box<dyn Error>> {
    env_logger::Builder::new().parse_filters(LOG_FILTER).parse_default_env().init();
    let scene = read_scene()?;
    let Controller::Builtin(parameters) = &scene.controller else {
        return Err("leave `controller: builtin` here: its parameters are ours".into());
    };
    let reach = DiscoveryRange::choose(&scene.outputs.ros, |name| std::env::var(name).ok())?;
    let node = RosNode::join_as("pick_and_lift_controller", &reach)?;
    let topics = topics(&scene);
    let mut eyes = Eyes::open(&node, &topics)?;
    let hands = Hands::open(&node, &scene, &topics)?;
    let mut out = std::io::stdout().lock();

    writeln!(out, "waiting for the simulation in domain {}", reach.domain_id)?;
    while !hands.are_felt(&node) {
        std::thread::sleep(Duration::from_millis(10));
    }
    let mut machine = PickAndLift::new(parameters);
    let mut tale = Tale::default();
    let mut heard_at = now();
    let mut called_at = None;
    while !machine.is_done() {
        // The other side may find us later than we find it: a first command is said until heard.
        if !eyes.are_open() && called_at.is_none_or(|it| CALL_PERIOD < now() - it) {
            hands.carry_out(&[Command::Vacuum { gauge_pa: 0.0 }])?;
            called_at = Some(now());
        }
        std::thread::sleep(PAUSE);
        if let Some(seen) = eyes.look()? {
            heard_at = now();
            hands.carry_out(&machine.decide(&seen))?;
            tale.go_on(machine.phase(), &seen, &mut out)?;
        } else if TIMEOUT < now() - heard_at {
            return Err(format!("no news for {TIMEOUT:?}: did the simulation end?").into());
        }
    }
    writeln!(out, "lifted {:.1} mm, held for {:.2} s", tale.lifted * 1e3, tale.held_s)?;
    Ok(())
}

/// The scene named on the command line, with its overrides.
fn read_scene() -> Result<Scene, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().unwrap_or_else(|| "launch_configs/pick_and_lift.yaml".to_owned());
    Ok(scene::load(&PathBuf::from(file), &arguments.collect::<Vec<_>>())?)
}

#[expect(clippy::disallowed_methods, reason = "whether anyone is there shows in wall time only")]
fn now() -> Instant {
    Instant::now()
}

/// The topics that are seen, and the newest of each.
struct Eyes {
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

impl Eyes {
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

    /// True once every topic has been heard of.
    fn are_open(&self) -> bool {
        self.contact_force.is_some()
            && self.flange_pose.is_some()
            && self.object_pose.is_some()
            && self.gauge_pa.is_some()
    }

    /// What is to be seen, if time has gone on and every topic has been heard of.
    fn look(&mut self) -> Result<Option<Observation>, Box<dyn Error>> {
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

/// The last of the messages that wait.
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

/// The topics that are commanded.
struct Hands {
    codec: CommandCodec,
    publishers: Vec<Option<(String, Publisher<Body>)>>,
}

impl Hands {
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

    /// True when someone listens to every command.
    fn are_felt(&self, node: &RosNode) -> bool {
        self.publishers.iter().flatten().all(|(topic, _)| 0 < node.n_readers(topic))
    }

    fn carry_out(&self, commands: &[Command]) -> Result<(), Box<dyn Error>> {
        for command in commands {
            let message = self.codec.encode(command, 0);
            if let Some((_, publisher)) = &self.publishers[message.topic] {
                publisher.publish(Body::new(message.cdr))?;
            }
        }
        Ok(())
    }
}

/// What happened, for people to read.
#[derive(Default)]
struct Tale {
    phase: Option<Phase>,
    rest_height: f64,
    lifted: f64,
    held_since: f64,
    held_s: f64,
}

impl Tale {
    fn go_on(
        &mut self,
        phase: Phase,
        seen: &Observation,
        out: &mut impl Write,
    ) -> std::io::Result<()> {
        let height = seen.object_pose.translation.z;
        if self.phase != Some(phase) {
            match phase {
                Phase::Lift => self.rest_height = height,
                Phase::Hold => self.held_since = seen.time_s,
                _ => {}
            }
            self.phase = Some(phase);
            writeln!(
                out,
                "{:8.3} s  {:<9} flange {:.1} mm, object {:.1} mm, push {:.2} N, {:.1} kPa",
                seen.time_s,
                phase.name(),
                seen.flange_pose.translation.z * 1e3,
                height * 1e3,
                seen.contact_force.norm(),
                seen.gauge_pa * 1e-3,
            )?;
            out.flush()?;
        }
        if (Phase::Lift..=Phase::Hold).contains(&phase) {
            self.lifted = self.lifted.max(height - self.rest_height);
        }
        if phase == Phase::Hold && 0.5 * self.lifted < height - self.rest_height {
            self.held_s = seen.time_s - self.held_since;
        }
        Ok(())
    }
}
