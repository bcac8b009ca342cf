//! Snapshots to ROS 2 messages: determines which messages are due and encodes each of them once.
//!
//! The encoder has no mutable state, so packets may be encoded on any thread and in any order.
//! Whether a message is due follows from simulation time alone: a topic with rate r is due at a
//! tick that contains a multiple of 1/r.

mod bodies; // flange and objects: poses, velocities, wrenches, frames, joints
mod chamber; // pressure, vacuum, detection
mod clouds; // grains and membrane as point clouds and surfaces
mod contacts; // contacts and their arrows
mod parts; // common parts of messages
mod run; // clock, statistics, diagnostics

use std::sync::Arc;

use super::{
    from_ros::CommandCodec,
    messages::{RosMessage, std_msgs::Bool},
    topics::{
        CommonTopic, Message, ObjectTopic, Topic, common, object_topic, topics, topics_of_spawned,
    },
};
use crate::{
    base::Vec3,
    scene::{Controller, Scene},
    snapshot::{
        Snapshot,
        due::{is_due, is_first_of},
        run::RunStatistics,
    },
};

/// The default frame.
pub const WORLD: &str = "world";
/// The frame of the gripper's flange.
pub const FLANGE: &str = "gripper_flange";
/// The frame of the membrane at rest; it coincides with the flange frame.
pub const MEMBRANE: &str = "membrane";

/// Largest rate of the membrane surface, which is only for display (Hz).
const MARKER_RATE_MAX: f64 = 10.0;
/// Rate of `/diagnostics` (Hz).
const DIAGNOSTICS_RATE: f64 = 1.0;

/// Encodes snapshots as messages.
#[derive(Clone, Debug)]
pub struct Encoder {
    scene: Arc<Scene>,
    /// Objects with topics, and the index of the first topic of each.
    objects: Vec<(String, usize)>,
    triangles: Vec<[u32; 3]>,
    vertices: Vec<Vec3>,
    topics: Vec<Topic>,
    commands: CommandCodec,
}

impl Encoder {
    /// Creates an encoder for a scene and its membrane: vertex indices of each triangle, and the
    /// vertices (m) of the shape at rest, along the flange's axes.
    pub fn new(scene: &Arc<Scene>, triangles: &[[u32; 3]], vertices: &[Vec3]) -> Self {
        let topics = topics(scene);
        let objects: Vec<String> = scene.objects.iter().map(|it| it.name.clone()).collect();
        Self {
            scene: Arc::clone(scene),
            triangles: triangles.to_vec(),
            vertices: vertices.to_vec(),
            commands: CommandCodec::new(topics.clone(), objects.clone()),
            topics,
            objects: objects
                .into_iter()
                .enumerate()
                .map(|(i, name)| (name, object_topic(i, ObjectTopic::ContactWrench)))
                .collect(),
        }
    }

    /// Adds topics for spawned objects after all others. Topics are never removed.
    pub fn with_spawned<'a>(&self, names: impl Iterator<Item = &'a str>) -> Self {
        let mut all = self.clone();
        for name in names {
            if !all.objects.iter().any(|it| it.0 == name) {
                all.objects.push((name.to_owned(), all.topics.len()));
                all.topics.extend(topics_of_spawned(&all.scene.outputs.ros, name));
            }
        }
        all
    }

    /// Sets another scene in the same run. Topics and objects with topics are kept.
    pub fn with_scene(self, scene: Arc<Scene>) -> Self {
        Self { scene, ..self }
    }

    /// Sets another membrane; see `new`.
    pub fn with_membrane(self, triangles: &[[u32; 3]], vertices: &[Vec3]) -> Self {
        Self { triangles: triangles.to_vec(), vertices: vertices.to_vec(), ..self }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The list of topics that message indices refer to.
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// Length of a tick (ns).
    pub fn tick_ns(&self) -> u64 {
        self.scene.time.tick_ns
    }

    /// The codec of commands.
    pub fn commands(&self) -> &CommandCodec {
        &self.commands
    }

    /// True if `/clock` belongs to another simulator.
    pub fn follows_clock(&self) -> bool {
        matches!(self.scene.controller, Controller::Topics { lockstep, .. } if lockstep.follows_clock)
    }

    /// The constant messages, which are sent once before all others: static frames and the mesh.
    pub fn latched(&self, time_ns: u64) -> Vec<Message> {
        let mut out = Outbox { time_ns, messages: Vec::new() };
        out.common(CommonTopic::TfStatic, &bodies::static_frames(time_ns));
        out.common(CommonTopic::MembraneMesh, &clouds::mesh(&self.triangles, &self.vertices));
        out.messages
    }

    /// The messages that are sent once, after the first clock message.
    pub fn ready(&self, time_ns: u64) -> Vec<Message> {
        let mut out = Outbox { time_ns, messages: Vec::new() };
        out.common(CommonTopic::Ready, &Bool { data: true });
        out.messages
    }

    /// The messages that are due at the end of the snapshot's tick. Grains, membrane and contacts
    /// are due if the snapshot contains them, statistics if `run` is given.
    pub fn encode(&self, snapshot: &Snapshot, run: Option<&RunStatistics>) -> Vec<Message> {
        let mut out = Outbox { time_ns: snapshot.time_ns, messages: Vec::new() };
        out.common(CommonTopic::Clock, &run::clock(snapshot));
        let outputs = &self.scene.outputs;
        if is_due(outputs.state_rate, snapshot.time_ns, self.tick_ns()) {
            self.bodies(snapshot, &mut out);
        }
        if is_due(outputs.pressure_rate, snapshot.time_ns, self.tick_ns()) {
            self.chamber(snapshot, &mut out);
        }
        self.large_parts(snapshot, &mut out);
        if let Some(run) = run {
            out.common(CommonTopic::Statistics, &run::statistics(snapshot, run));
            if is_first_of(outputs.statistics_rate, DIAGNOSTICS_RATE, snapshot.time_ns) {
                out.common(CommonTopic::Diagnostics, &run::diagnostics(snapshot, run));
            }
        }
        out.messages
    }

    fn bodies(&self, snapshot: &Snapshot, out: &mut Outbox) {
        let time_ns = snapshot.time_ns;
        let flange = &snapshot.flange;
        out.common(CommonTopic::Wrench, &parts::wrench(&snapshot.contact_wrench, time_ns, FLANGE));
        out.common(CommonTopic::FlangePose, &parts::pose(&flange.pose, time_ns, WORLD));
        out.common(CommonTopic::FlangeTwist, &parts::twist(&flange.twist, time_ns, WORLD));
        out.common(
            CommonTopic::FlangeWrench,
            &parts::wrench(&snapshot.mount_wrench, time_ns, FLANGE),
        );
        for object in &snapshot.objects {
            let found = self.objects.iter().find(|it| it.0 == object.name);
            let Some(&(_, first)) = found else { continue };
            let wrench = parts::wrench(&object.contact_wrench, time_ns, WORLD);
            out.object(first, ObjectTopic::ContactWrench, &wrench);
            out.object(first, ObjectTopic::Pose, &parts::pose(&object.body.pose, time_ns, WORLD));
            let twist = parts::twist(&object.body.twist, time_ns, WORLD);
            out.object(first, ObjectTopic::Twist, &twist);
        }
        out.common(CommonTopic::JointStates, &bodies::joint_states(snapshot, &self.scene.chamber));
        out.common(CommonTopic::Tf, &bodies::frames(snapshot));
    }

    fn chamber(&self, snapshot: &Snapshot, out: &mut Outbox) {
        out.common(CommonTopic::Pressure, &chamber::pressure(snapshot));
        out.common(CommonTopic::VacuumState, &chamber::vacuum_state(snapshot));
        out.common(CommonTopic::ObjectDetectionStatus, &chamber::object_detection(snapshot));
    }

    fn large_parts(&self, snapshot: &Snapshot, out: &mut Outbox) {
        let (time_ns, outputs) = (snapshot.time_ns, &self.scene.outputs);
        if let Some(contacts) = &snapshot.contacts {
            let names: Vec<&str> = snapshot.objects.iter().map(|it| it.name.as_str()).collect();
            let array = contacts::array(contacts, &names, time_ns);
            out.sized(CommonTopic::Contacts, &array, 256 * contacts.len() + 64);
            let markers = contacts::markers(contacts, time_ns, outputs.contacts_rate);
            out.sized(CommonTopic::ContactMarkers, &markers, 256 * markers.markers.len() + 64);
        }
        if let Some(membrane) = &snapshot.membrane {
            let cloud = clouds::membrane(membrane, time_ns);
            out.sized(CommonTopic::Membrane, &cloud, cloud.data.len() + 512);
            if is_first_of(outputs.membrane_rate, MARKER_RATE_MAX, time_ns) {
                let marker = clouds::surface(membrane, &self.triangles, time_ns);
                out.sized(CommonTopic::MembraneMarker, &marker, 24 * marker.points.len() + 512);
            }
        }
        if let Some(grains) = &snapshot.grains {
            let cloud = clouds::grains(grains, outputs.grains_count_max, time_ns);
            out.sized(CommonTopic::Grains, &cloud, cloud.data.len() + 512);
        }
    }
}

/// Encoded messages with the same time.
struct Outbox {
    time_ns: u64,
    messages: Vec<Message>,
}

impl Outbox {
    fn common<T: RosMessage>(&mut self, topic: CommonTopic, message: &T) {
        self.push(common(topic), message.to_cdr());
    }

    fn sized<T: RosMessage>(&mut self, topic: CommonTopic, message: &T, n_bytes: usize) {
        self.push(common(topic), message.to_cdr_sized(n_bytes));
    }

    fn object<T: RosMessage>(&mut self, first: usize, topic: ObjectTopic, message: &T) {
        self.push(first + topic as usize, message.to_cdr());
    }

    fn push(&mut self, topic: usize, cdr: Vec<u8>) {
        self.messages.push(Message { topic, time_ns: self.time_ns, cdr });
    }
}
