//! The list of topics, and encoded messages.
//!
//! First come the topics that every scene has, in the order of [`CommonTopic`], then those of each
//! object, in the order of [`ObjectTopic`]. The index of a topic is therefore known without a
//! search.

use super::messages::{
    MessageType, RosMessage, diagnostic_msgs::DiagnosticArray, geometry_msgs::PoseStamped,
    geometry_msgs::TwistStamped, geometry_msgs::WrenchStamped, jamgrip_msgs::ContactArray,
    jamgrip_msgs::ObjectCommand, jamgrip_msgs::ObjectDetectionStatus, jamgrip_msgs::Statistics,
    jamgrip_msgs::VacuumState, rosgraph_msgs::Clock, sensor_msgs::FluidPressure,
    sensor_msgs::JointState, sensor_msgs::PointCloud2, shape_msgs::Mesh, std_msgs::Bool,
    std_msgs::Float64, tf2_msgs::TFMessage, visualization_msgs::Marker,
    visualization_msgs::MarkerArray,
};
use crate::scene::{Ros, Scene};

/// Name of the ROS 2 node unless the scene sets another.
pub const NODE: &str = "/jamgrip";

/// A ROS 2 topic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Full name, such as `/jamgrip/wrench`.
    pub name: String,
    /// Type of the messages.
    pub message_type: MessageType,
    /// Quality of service.
    pub qos: Qos,
    /// True for topics that carry commands to the node.
    pub is_input: bool,
}

/// The quality of service settings in use. The history is always keep-last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Qos {
    /// True for reliable, false for best effort.
    pub is_reliable: bool,
    /// Depth of the history.
    pub depth: u32,
    /// True for transient local (latched), false for volatile.
    pub is_latched: bool,
}

impl Topic {
    /// A topic that the node publishes, with messages `M`.
    pub fn output<M: RosMessage>(name: &str, qos: Qos) -> Self {
        Self { name: name.to_owned(), message_type: M::TYPE, qos, is_input: false }
    }

    /// A topic that the node subscribes to, with messages `M`.
    pub fn input<M: RosMessage>(name: &str, qos: Qos) -> Self {
        Self { is_input: true, ..Self::output::<M>(name, qos) }
    }
}

impl Qos {
    /// Reliable, volatile.
    pub const fn reliable(depth: u32) -> Self {
        Self { is_reliable: true, depth, is_latched: false }
    }

    /// Reliable and transient local: late joiners receive the last message.
    pub const fn latched() -> Self {
        Self { is_reliable: true, depth: 1, is_latched: true }
    }
}

/// An encoded message. ROS 2 and recordings use the same bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Index into the list of topics.
    pub topic: usize,
    /// Simulation time (ns).
    pub time_ns: u64,
    /// The body in CDR, little endian, without the encapsulation header of four bytes.
    pub cdr: Vec<u8>,
}

/// The topics that every scene has. The value is the index in the list of topics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommonTopic {
    /// Simulation time, after every tick.
    Clock,
    /// Contact force of the objects on the gripper, at the flange and along its axes.
    Wrench,
    /// Pose of the flange in the world.
    FlangePose,
    /// Velocity of the flange, along world axes.
    FlangeTwist,
    /// Force of the gripper on its mount, as a wrist sensor measures it.
    FlangeWrench,
    /// Contacts between membrane and objects.
    Contacts,
    /// The contacts as arrows.
    ContactMarkers,
    /// Vertices of the membrane.
    Membrane,
    /// Triangles of the membrane; published once.
    MembraneMesh,
    /// The membrane as a surface for display.
    MembraneMarker,
    /// The grains.
    Grains,
    /// Absolute pressure inside the membrane.
    Pressure,
    /// Pressure, volume, jamming.
    VacuumState,
    /// Whether an object is held.
    ObjectDetectionStatus,
    /// Vacuum and flange as joints.
    JointStates,
    /// Statistics of the run.
    Statistics,
    /// The statistics as ROS diagnostics.
    Diagnostics,
    /// Moving frames.
    Tf,
    /// Static frames.
    TfStatic,
    /// Command: gauge pressure.
    VacuumCommand,
    /// Command: pose of the flange.
    FlangePoseCommand,
    /// Command: drive or release an object.
    ObjectCommand,
    /// Command: setpoints of vacuum and flange as joints.
    JointCommands,
    /// True once the node is ready.
    Ready,
}

/// The topics of each object. The value is the index among the object's topics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectTopic {
    /// Total contact wrench about the center of mass, along world axes, without gravity.
    ContactWrench,
    /// Pose of the body frame in the world.
    Pose,
    /// Velocity of the body frame, along world axes.
    Twist,
    /// Command: pose that drives the object.
    PoseCommand,
}

/// An entry of the list: topic, name, type, quality of service, and whether it is an input.
type Entry<T> = (T, &'static str, MessageType, Qos, bool);

const COMMON: [Entry<CommonTopic>; 24] = [
    (CommonTopic::Clock, "/clock", Clock::TYPE, Qos::reliable(1), false),
    (CommonTopic::Wrench, "~/wrench", WrenchStamped::TYPE, Qos::reliable(10), false),
    (CommonTopic::FlangePose, "~/flange/pose", PoseStamped::TYPE, Qos::reliable(10), false),
    (CommonTopic::FlangeTwist, "~/flange/twist", TwistStamped::TYPE, Qos::reliable(10), false),
    (CommonTopic::FlangeWrench, "~/flange/wrench", WrenchStamped::TYPE, Qos::reliable(10), false),
    (CommonTopic::Contacts, "~/contacts", ContactArray::TYPE, Qos::reliable(5), false),
    (CommonTopic::ContactMarkers, "~/contact_markers", MarkerArray::TYPE, Qos::reliable(1), false),
    (CommonTopic::Membrane, "~/membrane", PointCloud2::TYPE, Qos::reliable(5), false),
    (CommonTopic::MembraneMesh, "~/membrane/mesh", Mesh::TYPE, Qos::latched(), false),
    (CommonTopic::MembraneMarker, "~/membrane/marker", Marker::TYPE, Qos::reliable(1), false),
    (CommonTopic::Grains, "~/grains", PointCloud2::TYPE, Qos::reliable(1), false),
    (CommonTopic::Pressure, "~/pressure", FluidPressure::TYPE, Qos::reliable(10), false),
    (CommonTopic::VacuumState, "~/vacuum_state", VacuumState::TYPE, Qos::reliable(10), false),
    (
        CommonTopic::ObjectDetectionStatus,
        "~/object_detection_status",
        ObjectDetectionStatus::TYPE,
        Qos::latched(),
        false,
    ),
    (CommonTopic::JointStates, "~/joint_states", JointState::TYPE, Qos::reliable(10), false),
    (CommonTopic::Statistics, "~/statistics", Statistics::TYPE, Qos::reliable(1), false),
    (CommonTopic::Diagnostics, "/diagnostics", DiagnosticArray::TYPE, Qos::reliable(10), false),
    (CommonTopic::Tf, "/tf", TFMessage::TYPE, Qos::reliable(100), false),
    (CommonTopic::TfStatic, "/tf_static", TFMessage::TYPE, Qos::latched(), false),
    (CommonTopic::VacuumCommand, "~/vacuum_cmd", Float64::TYPE, Qos::reliable(1), true),
    (
        CommonTopic::FlangePoseCommand,
        "~/flange/pose_cmd",
        PoseStamped::TYPE,
        Qos::reliable(1),
        true,
    ),
    // Two commands in a row, such as release and drive, must both arrive.
    (CommonTopic::ObjectCommand, "~/object_cmd", ObjectCommand::TYPE, Qos::reliable(10), true),
    (CommonTopic::JointCommands, "~/joint_commands", JointState::TYPE, Qos::reliable(1), true),
    (CommonTopic::Ready, "~/ready", Bool::TYPE, Qos::latched(), false),
];

/// Names are relative to `~/object/<name>/`.
const PER_OBJECT: [Entry<ObjectTopic>; 4] = [
    (ObjectTopic::ContactWrench, "contact_wrench", WrenchStamped::TYPE, Qos::reliable(10), false),
    (ObjectTopic::Pose, "pose", PoseStamped::TYPE, Qos::reliable(10), false),
    (ObjectTopic::Twist, "twist", TwistStamped::TYPE, Qos::reliable(10), false),
    (ObjectTopic::PoseCommand, "pose_cmd", PoseStamped::TYPE, Qos::reliable(1), true),
];

/// All topics of a scene, inputs and outputs.
pub fn topics(scene: &Scene) -> Vec<Topic> {
    let common = COMMON.iter().map(|&(_, name, message_type, qos, is_input)| Topic {
        name: full_name(&scene.outputs.ros, name),
        message_type,
        qos,
        is_input,
    });
    let of_objects = scene.objects.iter().flat_map(|object| {
        PER_OBJECT.iter().map(|&(_, name, message_type, qos, is_input)| Topic {
            name: full_name(&scene.outputs.ros, &format!("~/object/{}/{name}", object.name)),
            message_type,
            qos,
            is_input,
        })
    });
    common.chain(of_objects).collect()
}

/// The output topics of a spawned object, in the order of [`ObjectTopic`]. Commands for it go to
/// `~/object_cmd`.
pub fn topics_of_spawned(ros: &Ros, object: &str) -> Vec<Topic> {
    let outputs = PER_OBJECT.iter().filter(|it| !it.4);
    let topic = |&(_, name, message_type, qos, is_input): &Entry<ObjectTopic>| Topic {
        name: full_name(ros, &format!("~/object/{object}/{name}")),
        message_type,
        qos,
        is_input,
    };
    outputs.map(topic).collect()
}

/// The full name of a topic or service: `~` is replaced by the node, and remappings are applied.
pub fn full_name(ros: &Ros, name: &str) -> String {
    let namespace = ros.node.rsplit_once('/').map_or("", |(namespace, _)| namespace);
    let full = |name: &str| match name.strip_prefix('~') {
        Some(rest) => format!("{}{rest}", ros.node),
        None if name.starts_with('/') => name.to_owned(),
        None => format!("{namespace}/{name}"),
    };
    let expanded = full(name);
    let remapped = ros.remaps.iter().find(|(from, _)| full(from) == expanded);
    remapped.map_or(expanded, |(_, to)| full(to))
}

/// Index of a topic that every scene has.
pub fn common(topic: CommonTopic) -> usize {
    topic as usize
}

/// Index of a topic of the object with this index in the scene.
pub fn object_topic(object: usize, topic: ObjectTopic) -> usize {
    COMMON.len() + object * PER_OBJECT.len() + topic as usize
}

/// The topic with this index.
pub fn topic_id(topic: usize) -> TopicId {
    match COMMON.get(topic) {
        Some(&(common, ..)) => TopicId::Common(common),
        None => {
            let offset = topic - COMMON.len();
            let (kind, ..) = PER_OBJECT[offset % PER_OBJECT.len()];
            TopicId::Object(offset / PER_OBJECT.len(), kind)
        }
    }
}

/// A topic, identified by its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TopicId {
    /// One that every scene has.
    Common(CommonTopic),
    /// A topic of the object with this index in the scene.
    Object(usize, ObjectTopic),
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the rules of ROS 2 for private, relative and full names, and for remapping.
    #[test]
    fn names_are_expanded_and_remapped() {
        let to = |from: &str, to: &str| (from.to_owned(), to.to_owned());
        let remaps = vec![to("~/wrench", "/ft"), to("/clock", "sim/clock"), to("pose", "~/p")];
        let ros = Ros { node: "/left/grip".to_owned(), remaps, ..Ros::OFF };
        for (name, expected) in [
            ("~/wrench", "/ft"),
            ("/clock", "/left/sim/clock"),
            ("~/pose", "/left/grip/pose"),
            ("/left/pose", "/left/grip/p"),
            ("/tf", "/tf"),
        ] {
            assert_eq!(full_name(&ros, name), expected, "{name}");
        }
    }

    #[test]
    fn entries_are_at_their_index() {
        // Oracle: `common` and `topic_id` are inverse to each other; an entry out of order breaks
        // that.
        for (index, (topic, ..)) in COMMON.iter().enumerate() {
            assert_eq!(common(*topic), index);
            assert_eq!(topic_id(index), TopicId::Common(*topic));
        }
        for object in 0..3 {
            for (topic, ..) in PER_OBJECT {
                assert_eq!(topic_id(object_topic(object, topic)), TopicId::Object(object, topic));
            }
        }
    }
}
