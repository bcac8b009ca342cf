//! The closed list of topics, and messages encoded once for all who carry them.
//!
//! First come the topics that every scene has, in the order of `Common`, then those of each
//! object, in the order of `OfObject`. So the index of a topic is known without looking it up.

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

/// Name of the ROS 2 node if the scene gives it no other.
pub const NODE: &str = "/jamgrip";

/// A ROS 2 topic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Full name, such as `/jamgrip/wrench`.
    pub name: String,
    /// Its type.
    pub message_type: MessageType,
    /// How it is offered.
    pub qos: Qos,
    /// True for topics that carry commands to us.
    pub is_input: bool,
}

/// Quality of service, as far as we use it. History is always keep-last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Qos {
    /// Reliable, else best effort.
    pub is_reliable: bool,
    /// Depth of the history.
    pub depth: u32,
    /// Transient local (latched), else volatile.
    pub is_latched: bool,
}

impl Topic {
    /// A topic that we publish, if messages `M` go by `qos` on it.
    pub fn output<M: RosMessage>(name: &str, qos: Qos) -> Self {
        Self { name: name.to_owned(), message_type: M::TYPE, qos, is_input: false }
    }

    /// The same, if we listen there.
    pub fn input<M: RosMessage>(name: &str, qos: Qos) -> Self {
        Self { is_input: true, ..Self::output::<M>(name, qos) }
    }
}

impl Qos {
    /// Reliable, volatile.
    pub const fn reliable(depth: u32) -> Self {
        Self { is_reliable: true, depth, is_latched: false }
    }

    /// Reliable, transient local: who comes late gets the last one.
    pub const fn latched() -> Self {
        Self { is_reliable: true, depth: 1, is_latched: true }
    }
}

/// One message, encoded once: ROS 2 and bags carry the same bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Index into the list of topics.
    pub topic: usize,
    /// Simulated time (ns).
    pub time_ns: u64,
    /// The body in CDR, little endian, without the four bytes that name the encoding.
    pub cdr: Vec<u8>,
}

/// The topics that every scene has. The value is the index into the list of topics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Common {
    /// Simulated time, each tick.
    Clock,
    /// Force of the objects on the gripper, at the flange, in its axes.
    Wrench,
    /// Pose of the flange in the world.
    FlangePose,
    /// Velocity of the flange, world axes.
    FlangeTwist,
    /// What the gripper puts on its mount, as a wrist sensor reads it.
    FlangeWrench,
    /// Contacts between membrane and objects.
    Contacts,
    /// The same as arrows.
    ContactMarkers,
    /// Vertices of the membrane.
    Membrane,
    /// Triangles of the membrane, once.
    MembraneMesh,
    /// The membrane as a surface to look at.
    MembraneMarker,
    /// The grains.
    Grains,
    /// Absolute pressure in the membrane.
    Pressure,
    /// Pressure, volume, jamming.
    VacuumState,
    /// Whether something is held.
    ObjectDetectionStatus,
    /// Vacuum and flange as joints.
    JointStates,
    /// How the run goes.
    Statistics,
    /// The same for the diagnostics tools of ROS.
    Diagnostics,
    /// Moving frames.
    Tf,
    /// Frames that stay.
    TfStatic,
    /// Command: gauge pressure.
    VacuumCommand,
    /// Command: pose of the flange.
    FlangePoseCommand,
    /// Command: drive or release an object.
    ObjectCommand,
    /// Command: set-points of vacuum and flange as joints.
    JointCommands,
    /// True once the node is ready.
    Ready,
}

/// The topics of each object. The value is the place among the object's topics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfObject {
    /// Total contact wrench about the centre of mass, world axes, gravity excluded.
    ContactWrench,
    /// Pose of the body frame in the world.
    Pose,
    /// Velocity of the body frame, world axes.
    Twist,
    /// Command: pose that drives the object.
    PoseCommand,
}

/// A row of the list: what, name, type, quality of service, whether it carries commands to us.
type Row<T> = (T, &'static str, MessageType, Qos, bool);

const COMMON: [Row<Common>; 24] = [
    (Common::Clock, "/clock", Clock::TYPE, Qos::reliable(1), false),
    (Common::Wrench, "~/wrench", WrenchStamped::TYPE, Qos::reliable(10), false),
    (Common::FlangePose, "~/flange/pose", PoseStamped::TYPE, Qos::reliable(10), false),
    (Common::FlangeTwist, "~/flange/twist", TwistStamped::TYPE, Qos::reliable(10), false),
    (Common::FlangeWrench, "~/flange/wrench", WrenchStamped::TYPE, Qos::reliable(10), false),
    (Common::Contacts, "~/contacts", ContactArray::TYPE, Qos::reliable(5), false),
    (Common::ContactMarkers, "~/contact_markers", MarkerArray::TYPE, Qos::reliable(1), false),
    (Common::Membrane, "~/membrane", PointCloud2::TYPE, Qos::reliable(5), false),
    (Common::MembraneMesh, "~/membrane/mesh", Mesh::TYPE, Qos::latched(), false),
    (Common::MembraneMarker, "~/membrane/marker", Marker::TYPE, Qos::reliable(1), false),
    (Common::Grains, "~/grains", PointCloud2::TYPE, Qos::reliable(1), false),
    (Common::Pressure, "~/pressure", FluidPressure::TYPE, Qos::reliable(10), false),
    (Common::VacuumState, "~/vacuum_state", VacuumState::TYPE, Qos::reliable(10), false),
    (
        Common::ObjectDetectionStatus,
        "~/object_detection_status",
        ObjectDetectionStatus::TYPE,
        Qos::latched(),
        false,
    ),
    (Common::JointStates, "~/joint_states", JointState::TYPE, Qos::reliable(10), false),
    (Common::Statistics, "~/statistics", Statistics::TYPE, Qos::reliable(1), false),
    (Common::Diagnostics, "/diagnostics", DiagnosticArray::TYPE, Qos::reliable(10), false),
    (Common::Tf, "/tf", TFMessage::TYPE, Qos::reliable(100), false),
    (Common::TfStatic, "/tf_static", TFMessage::TYPE, Qos::latched(), false),
    (Common::VacuumCommand, "~/vacuum_cmd", Float64::TYPE, Qos::reliable(1), true),
    (Common::FlangePoseCommand, "~/flange/pose_cmd", PoseStamped::TYPE, Qos::reliable(1), true),
    // Two commands in a row, such as release and drive, must both arrive.
    (Common::ObjectCommand, "~/object_cmd", ObjectCommand::TYPE, Qos::reliable(10), true),
    (Common::JointCommands, "~/joint_commands", JointState::TYPE, Qos::reliable(1), true),
    (Common::Ready, "~/ready", Bool::TYPE, Qos::latched(), false),
];

/// Names are below `~/object/<name>/`.
const OF_OBJECT: [Row<OfObject>; 4] = [
    (OfObject::ContactWrench, "contact_wrench", WrenchStamped::TYPE, Qos::reliable(10), false),
    (OfObject::Pose, "pose", PoseStamped::TYPE, Qos::reliable(10), false),
    (OfObject::Twist, "twist", TwistStamped::TYPE, Qos::reliable(10), false),
    (OfObject::PoseCommand, "pose_cmd", PoseStamped::TYPE, Qos::reliable(1), true),
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
        OF_OBJECT.iter().map(|&(_, name, message_type, qos, is_input)| Topic {
            name: full_name(&scene.outputs.ros, &format!("~/object/{}/{name}", object.name)),
            message_type,
            qos,
            is_input,
        })
    });
    common.chain(of_objects).collect()
}

/// What is published of an object that is not the scene's own, in the order of `OfObject`. It is
/// commanded on `~/object_cmd`.
pub fn topics_of_guest(ros: &Ros, object: &str) -> Vec<Topic> {
    let outputs = OF_OBJECT.iter().filter(|it| !it.4);
    let topic = |&(_, name, message_type, qos, is_input): &Row<OfObject>| Topic {
        name: full_name(ros, &format!("~/object/{object}/{name}")),
        message_type,
        qos,
        is_input,
    };
    outputs.map(topic).collect()
}

/// A name as others see it: `~` is the node, and names that are to be replaced are.
pub fn full_name(ros: &Ros, name: &str) -> String {
    let namespace = ros.node.rsplit_once('/').map_or("", |(namespace, _)| namespace);
    let full = |name: &str| match name.strip_prefix('~') {
        Some(rest) => format!("{}{rest}", ros.node),
        None if name.starts_with('/') => name.to_owned(),
        None => format!("{namespace}/{name}"),
    };
    let wanted = full(name);
    let replaced = ros.remaps.iter().find(|(from, _)| full(from) == wanted);
    replaced.map_or(wanted, |(_, to)| full(to))
}

/// Index of a topic that every scene has.
pub fn common(topic: Common) -> usize {
    topic as usize
}

/// Index of a topic of the object with this place in the scene.
pub fn of_object(object: usize, topic: OfObject) -> usize {
    COMMON.len() + object * OF_OBJECT.len() + topic as usize
}

/// What the topic with this index is: one that every scene has, or one of an object.
pub fn place(topic: usize) -> Place {
    match COMMON.get(topic) {
        Some(&(common, ..)) => Place::Common(common),
        None => {
            let beyond = topic - COMMON.len();
            let (of_object, ..) = OF_OBJECT[beyond % OF_OBJECT.len()];
            Place::OfObject(beyond / OF_OBJECT.len(), of_object)
        }
    }
}

/// Where a topic stands in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// One that every scene has.
    Common(Common),
    /// One of the object with this place in the scene.
    OfObject(usize, OfObject),
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: ROS 2's rules for private, relative and full names, and for their replacement.
    #[test]
    fn names_are_full_and_replaced() {
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
    fn rows_stand_where_their_index_says() {
        // Oracle: `common` and `place` are inverse to each other; a row out of order breaks that.
        for (index, (topic, ..)) in COMMON.iter().enumerate() {
            assert_eq!(common(*topic), index);
            assert_eq!(place(index), Place::Common(*topic));
        }
        for object in 0..3 {
            for (topic, ..) in OF_OBJECT {
                assert_eq!(place(of_object(object, topic)), Place::OfObject(object, topic));
            }
        }
    }
}
