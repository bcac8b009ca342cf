//! Snapshots to ROS 2 messages: decides what is due and has it encoded, each message once.
//!
//! The encoder keeps no state, so packets may be encoded by any thread and in any order. What is
//! due follows from simulated time alone: a topic with rate r is due at a tick in which a
//! multiple of 1/r lies.

mod bodies; // flange and objects: poses, velocities, wrenches, frames, joints
mod chamber; // pressure, vacuum, detection
mod clouds; // grains and membrane as point clouds and surfaces
mod contacts; // contacts and their arrows
mod parts; // the small messages that others are made of
mod run; // clock, statistics, diagnostics

use std::sync::Arc;

use super::{
    from_ros::CommandCodec,
    messages::{RosMessage, std_msgs::Bool},
    topics::{Common, Message, OfObject, Topic, common, of_object, topics, topics_of_guest},
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

/// The frame of everything that says nothing else.
pub const WORLD: &str = "world";
/// The frame of the gripper's flange.
pub const FLANGE: &str = "gripper_flange";
/// The frame of the membrane at rest; it lies in the flange's.
pub const MEMBRANE: &str = "membrane";

/// Largest rate of the membrane's surface, which is there to be looked at (Hz).
const MARKER_RATE_MAX: f64 = 10.0;
/// Rate of `/diagnostics` (Hz).
const DIAGNOSTICS_RATE: f64 = 1.0;

/// Makes messages of snapshots.
#[derive(Clone, Debug)]
pub struct Encoder {
    scene: Arc<Scene>,
    /// Objects that have topics, and the first one of each.
    objects: Vec<(String, usize)>,
    triangles: Vec<[u32; 3]>,
    vertices: Vec<Vec3>,
    topics: Vec<Topic>,
    commands: CommandCodec,
}

impl Encoder {
    /// For a scene and its membrane: vertex indices of each triangle, and the vertices (m) of the
    /// shape at rest in the flange's axes.
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
                .map(|(i, name)| (name, of_object(i, OfObject::ContactWrench)))
                .collect(),
        }
    }

    /// The same with topics for objects that came later, behind all others. Topics never go.
    pub fn with_spawned<'a>(&self, names: impl Iterator<Item = &'a str>) -> Self {
        let mut all = self.clone();
        for name in names {
            if !all.objects.iter().any(|it| it.0 == name) {
                all.objects.push((name.to_owned(), all.topics.len()));
                all.topics.extend(topics_of_guest(&all.scene.outputs.ros, name));
            }
        }
        all
    }

    /// The same for another scene, or for the same scene with other values. Topics stay.
    pub fn with_scene(self, scene: Arc<Scene>) -> Self {
        Self { scene, ..self }
    }

    /// The same for another membrane; see `new`.
    pub fn with_membrane(self, triangles: &[[u32; 3]], vertices: &[Vec3]) -> Self {
        Self { triangles: triangles.to_vec(), vertices: vertices.to_vec(), ..self }
    }

    /// The scene that is told of.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The list of topics that the messages' indices mean.
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// Length of a tick (ns).
    pub fn tick_ns(&self) -> u64 {
        self.scene.time.tick_ns
    }

    /// Messages to commands and back.
    pub fn commands(&self) -> &CommandCodec {
        &self.commands
    }

    /// True if `/clock` is another simulator's.
    pub fn follows_clock(&self) -> bool {
        matches!(self.scene.controller, Controller::Topics { lockstep, .. } if lockstep.follows_clock)
    }

    /// What never changes and is sent once, before all else: frames that stay, the mesh.
    pub fn latched(&self, time_ns: u64) -> Vec<Message> {
        let mut out = Outbox { time_ns, messages: Vec::new() };
        out.common(Common::TfStatic, &bodies::static_frames(time_ns));
        out.common(Common::MembraneMesh, &clouds::mesh(&self.triangles, &self.vertices));
        out.messages
    }

    /// What is said once, when the first clock is out.
    pub fn ready(&self, time_ns: u64) -> Vec<Message> {
        let mut out = Outbox { time_ns, messages: Vec::new() };
        out.common(Common::Ready, &Bool { data: true });
        out.messages
    }

    /// What is due at the end of the snapshot's tick. Grains, membrane and contacts are due when
    /// the snapshot has them, statistics when `run` is given.
    pub fn encode(&self, snapshot: &Snapshot, run: Option<&RunStatistics>) -> Vec<Message> {
        let mut out = Outbox { time_ns: snapshot.time_ns, messages: Vec::new() };
        out.common(Common::Clock, &run::clock(snapshot));
        let outputs = &self.scene.outputs;
        if is_due(outputs.state_rate, snapshot.time_ns, self.tick_ns()) {
            self.bodies(snapshot, &mut out);
        }
        if is_due(outputs.pressure_rate, snapshot.time_ns, self.tick_ns()) {
            self.chamber(snapshot, &mut out);
        }
        self.heavy(snapshot, &mut out);
        if let Some(run) = run {
            out.common(Common::Statistics, &run::statistics(snapshot, run));
            if is_first_of(outputs.statistics_rate, DIAGNOSTICS_RATE, snapshot.time_ns) {
                out.common(Common::Diagnostics, &run::diagnostics(snapshot, run));
            }
        }
        out.messages
    }

    fn bodies(&self, snapshot: &Snapshot, out: &mut Outbox) {
        let time_ns = snapshot.time_ns;
        let flange = &snapshot.flange;
        out.common(Common::Wrench, &parts::wrench(&snapshot.contact_wrench, time_ns, FLANGE));
        out.common(Common::FlangePose, &parts::pose(&flange.pose, time_ns, WORLD));
        out.common(Common::FlangeTwist, &parts::twist(&flange.twist, time_ns, WORLD));
        out.common(Common::FlangeWrench, &parts::wrench(&snapshot.mount_wrench, time_ns, FLANGE));
        for object in &snapshot.objects {
            let found = self.objects.iter().find(|it| it.0 == object.name);
            let Some(&(_, first)) = found else { continue };
            let wrench = parts::wrench(&object.contact_wrench, time_ns, WORLD);
            out.of_object(first, OfObject::ContactWrench, &wrench);
            out.of_object(first, OfObject::Pose, &parts::pose(&object.body.pose, time_ns, WORLD));
            let twist = parts::twist(&object.body.twist, time_ns, WORLD);
            out.of_object(first, OfObject::Twist, &twist);
        }
        out.common(Common::JointStates, &bodies::joint_states(snapshot, &self.scene.chamber));
        out.common(Common::Tf, &bodies::frames(snapshot));
    }

    fn chamber(&self, snapshot: &Snapshot, out: &mut Outbox) {
        out.common(Common::Pressure, &chamber::pressure(snapshot));
        out.common(Common::VacuumState, &chamber::vacuum_state(snapshot));
        out.common(Common::ObjectDetectionStatus, &chamber::object_detection(snapshot));
    }

    fn heavy(&self, snapshot: &Snapshot, out: &mut Outbox) {
        let (time_ns, outputs) = (snapshot.time_ns, &self.scene.outputs);
        if let Some(contacts) = &snapshot.contacts {
            let names: Vec<&str> = snapshot.objects.iter().map(|it| it.name.as_str()).collect();
            let array = contacts::array(contacts, &names, time_ns);
            out.sized(Common::Contacts, &array, 256 * contacts.len() + 64);
            let markers = contacts::markers(contacts, time_ns, outputs.contacts_rate);
            out.sized(Common::ContactMarkers, &markers, 256 * markers.markers.len() + 64);
        }
        if let Some(membrane) = &snapshot.membrane {
            let cloud = clouds::membrane(membrane, time_ns);
            out.sized(Common::Membrane, &cloud, cloud.data.len() + 512);
            if is_first_of(outputs.membrane_rate, MARKER_RATE_MAX, time_ns) {
                let marker = clouds::surface(membrane, &self.triangles, time_ns);
                out.sized(Common::MembraneMarker, &marker, 24 * marker.points.len() + 512);
            }
        }
        if let Some(grains) = &snapshot.grains {
            let cloud = clouds::grains(grains, outputs.grains_count_max, time_ns);
            out.sized(Common::Grains, &cloud, cloud.data.len() + 512);
        }
    }
}

/// Messages on their way out, all with the same time.
struct Outbox {
    time_ns: u64,
    messages: Vec<Message>,
}

impl Outbox {
    fn common<T: RosMessage>(&mut self, topic: Common, message: &T) {
        self.push(common(topic), message.to_cdr());
    }

    fn sized<T: RosMessage>(&mut self, topic: Common, message: &T, n_bytes: usize) {
        self.push(common(topic), message.to_cdr_sized(n_bytes));
    }

    fn of_object<T: RosMessage>(&mut self, first: usize, topic: OfObject, message: &T) {
        self.push(first + topic as usize, message.to_cdr());
    }

    fn push(&mut self, topic: usize, cdr: Vec<u8>) {
        self.messages.push(Message { topic, time_ns: self.time_ns, cdr });
    }
}
