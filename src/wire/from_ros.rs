//! Commands from ROS 2 messages, and back: the commands that a bag records.
//!
//! Values are kept exactly as they arrived, senseless ones too: what is refused is recorded as well.

use super::{
    messages::{
        RosMessage, builtin_interfaces::Time, geometry_msgs::Pose, geometry_msgs::PoseStamped,
        geometry_msgs::Quaternion, jamgrip_msgs::ObjectCommand, sensor_msgs::JointState,
        std_msgs::Float64, std_msgs::Header,
    },
    topics::{Common, Message, OfObject, Place, Topic, common, of_object, place},
};
use crate::command::{Command, PoseCommand};

/// Why a message is no command. Nothing of it reaches the simulation.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotACommand {
    /// The bytes are not of the topic's type.
    #[error(
        "message on {topic}: its {n_bytes} bytes are no {type_name} ({fault}): \
         publish with that type"
    )]
    Malformed {
        /// Topic it came on.
        topic: String,
        /// Type of the topic.
        type_name: &'static str,
        /// Length of the message's body (bytes).
        n_bytes: usize,
        /// What the decoder says.
        fault: String,
    },
    /// The message asks for a mode that there is not.
    #[error(
        "message on {topic}: mode is {mode}, not MODE_DRIVE ({drive}) or MODE_RELEASE ({release})",
        drive = ObjectCommand::MODE_DRIVE,
        release = ObjectCommand::MODE_RELEASE
    )]
    UnknownMode {
        /// Topic it came on.
        topic: String,
        /// What was asked for.
        mode: u8,
    },
    /// The topic carries no commands.
    #[error("message on {topic}: this topic carries no commands")]
    NotAnInput {
        /// Topic it came on.
        topic: String,
    },
}

/// Reads commands from messages, and writes them as messages.
#[derive(Clone, Debug)]
pub struct CommandCodec {
    topics: Vec<Topic>,
    objects: Vec<String>,
}

impl CommandCodec {
    /// For the topics of a scene and the names of its objects, in the scene's order.
    pub fn new(topics: Vec<Topic>, objects: Vec<String>) -> Self {
        Self { topics, objects }
    }

    /// The command in a message's body, given the index of the topic that it came on.
    ///
    /// # Errors
    /// If the bytes are not of the topic's type, or the topic carries no commands.
    pub fn decode(&self, topic: usize, cdr: &[u8]) -> Result<Command, NotACommand> {
        match place(topic) {
            Place::Common(Common::VacuumCommand) => {
                let message: Float64 = self.read(topic, cdr)?;
                Ok(Command::Vacuum { gauge_pa: message.data })
            }
            Place::Common(Common::FlangePoseCommand) => {
                let message: PoseStamped = self.read(topic, cdr)?;
                Ok(Command::FlangePose(pose_command(message.header, &message.pose)))
            }
            Place::OfObject(object, OfObject::PoseCommand) => {
                let message: PoseStamped = self.read(topic, cdr)?;
                let pose = pose_command(message.header, &message.pose);
                Ok(Command::ObjectPose { object: self.objects[object].clone(), pose })
            }
            Place::Common(Common::ObjectCommand) => self.object_command(topic, cdr),
            Place::Common(Common::JointCommands) => {
                let message: JointState = self.read(topic, cdr)?;
                let stamp_ns = stamp_ns(&message.header);
                let (names, positions) = (message.name, message.position);
                Ok(Command::Joints { stamp_ns, names, positions })
            }
            _ => Err(NotACommand::NotAnInput { topic: self.topics[topic].name.clone() }),
        }
    }

    fn object_command(&self, topic: usize, cdr: &[u8]) -> Result<Command, NotACommand> {
        let message: ObjectCommand = self.read(topic, cdr)?;
        let object = message.object;
        match message.mode {
            ObjectCommand::MODE_DRIVE => Ok(Command::ObjectPose {
                object,
                pose: pose_command(message.header, &message.pose),
            }),
            ObjectCommand::MODE_RELEASE => Ok(Command::ObjectRelease { object }),
            mode => Err(NotACommand::UnknownMode { topic: self.topics[topic].name.clone(), mode }),
        }
    }

    fn read<T: RosMessage>(&self, topic: usize, cdr: &[u8]) -> Result<T, NotACommand> {
        T::from_cdr(cdr).map_err(|fault| NotACommand::Malformed {
            topic: self.topics[topic].name.clone(),
            type_name: self.topics[topic].message_type.name,
            n_bytes: cdr.len(),
            fault: fault.to_string(),
        })
    }

    /// The message that asks for a command. Poses of the scene's own objects go to the object's
    /// `pose_cmd`; releases, and objects that do not exist, have no topic but `~/object_cmd`.
    pub fn encode(&self, command: &Command, time_ns: u64) -> Message {
        let (topic, cdr) = match command {
            Command::Vacuum { gauge_pa } => {
                (common(Common::VacuumCommand), Float64 { data: *gauge_pa }.to_cdr())
            }
            Command::FlangePose(pose) => {
                (common(Common::FlangePoseCommand), pose_stamped(pose).to_cdr())
            }
            Command::ObjectPose { object, pose } => {
                match self.objects.iter().position(|name| name == object) {
                    Some(index) => {
                        (of_object(index, OfObject::PoseCommand), pose_stamped(pose).to_cdr())
                    }
                    None => {
                        let PoseStamped { header, pose } = pose_stamped(pose);
                        let (object, mode) = (object.clone(), ObjectCommand::MODE_DRIVE);
                        let message = ObjectCommand { header, object, mode, pose };
                        (common(Common::ObjectCommand), message.to_cdr())
                    }
                }
            }
            Command::Joints { stamp_ns, names, positions } => {
                let header = Header { stamp: stamp(*stamp_ns), frame_id: String::new() };
                let (name, position) = (names.clone(), positions.clone());
                let message = JointState { header, name, position, ..Default::default() };
                (common(Common::JointCommands), message.to_cdr())
            }
            Command::ObjectRelease { object } => {
                let (object, mode) = (object.clone(), ObjectCommand::MODE_RELEASE);
                let message = ObjectCommand { object, mode, ..Default::default() };
                (common(Common::ObjectCommand), message.to_cdr())
            }
        };
        Message { topic, time_ns, cdr }
    }
}

fn pose_command(header: Header, pose: &Pose) -> PoseCommand {
    let (position, orientation) = (&pose.position, &pose.orientation);
    PoseCommand {
        stamp_ns: stamp_ns(&header),
        position: [position.x, position.y, position.z],
        orientation: [orientation.x, orientation.y, orientation.z, orientation.w],
        frame_id: header.frame_id,
    }
}

fn stamp_ns(header: &Header) -> i64 {
    i64::from(header.stamp.sec) * 1_000_000_000 + i64::from(header.stamp.nanosec)
}

fn pose_stamped(command: &PoseCommand) -> PoseStamped {
    let [x, y, z] = command.position;
    let position = super::messages::geometry_msgs::Point { x, y, z };
    let [x, y, z, w] = command.orientation;
    PoseStamped {
        header: Header { stamp: stamp(command.stamp_ns), frame_id: command.frame_id.clone() },
        pose: Pose { position, orientation: Quaternion { x, y, z, w } },
    }
}

/// A ROS time; what its 32 bits of seconds cannot hold is set to the nearest they can.
fn stamp(time_ns: i64) -> Time {
    let sec = time_ns.div_euclid(1_000_000_000).clamp(i32::MIN.into(), i32::MAX.into());
    #[expect(clippy::cast_possible_truncation, reason = "clamped to 32 bits above")]
    Time { sec: sec as i32, nanosec: time_ns.rem_euclid(1_000_000_000) as u32 }
}
