//! ROS 2 messages to commands, and back for recordings.
//!
//! Values are kept exactly as received, even invalid ones, because rejected commands are recorded
//! as well.

use super::{
    messages::{
        RosMessage, builtin_interfaces::Time, geometry_msgs::Pose, geometry_msgs::PoseStamped,
        geometry_msgs::Quaternion, jamgrip_msgs::ObjectCommand, sensor_msgs::JointState,
        std_msgs::Float64, std_msgs::Header,
    },
    topics::{CommonTopic, Message, ObjectTopic, Topic, TopicId, common, object_topic, topic_id},
};
use crate::command::{Command, PoseCommand};

/// Why a message is not a command. Such a message does not affect the simulation.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CommandDecodeError {
    /// The bytes are not a message of the topic's type.
    #[error(
        "message on {topic}: its {n_bytes} bytes are not a {type_name} ({reason}): \
         publish with that type"
    )]
    Malformed {
        /// The topic.
        topic: String,
        /// Type of the topic.
        type_name: &'static str,
        /// Length of the message body (bytes).
        n_bytes: usize,
        /// Reason given by the decoder.
        reason: String,
    },
    /// The mode of the message does not exist.
    #[error(
        "message on {topic}: mode is {mode}, not MODE_DRIVE ({drive}) or MODE_RELEASE ({release})",
        drive = ObjectCommand::MODE_DRIVE,
        release = ObjectCommand::MODE_RELEASE
    )]
    UnknownMode {
        /// The topic.
        topic: String,
        /// The mode.
        mode: u8,
    },
    /// The topic carries no commands.
    #[error("message on {topic}: this topic carries no commands")]
    NotAnInput {
        /// The topic.
        topic: String,
    },
}

/// Decodes commands from messages, and encodes them as messages.
#[derive(Clone, Debug)]
pub struct CommandCodec {
    topics: Vec<Topic>,
    objects: Vec<String>,
}

impl CommandCodec {
    /// Creates a codec for the topics of a scene and the names of its objects, in the order of the
    /// scene.
    pub fn new(topics: Vec<Topic>, objects: Vec<String>) -> Self {
        Self { topics, objects }
    }

    /// Decodes the command in a message body from the topic with this index.
    ///
    /// # Errors
    /// If the bytes are not a message of the topic's type, or the topic carries no commands.
    pub fn decode(&self, topic: usize, cdr: &[u8]) -> Result<Command, CommandDecodeError> {
        match topic_id(topic) {
            TopicId::Common(CommonTopic::VacuumCommand) => {
                let message: Float64 = self.read(topic, cdr)?;
                Ok(Command::Vacuum { gauge_pa: message.data })
            }
            TopicId::Common(CommonTopic::FlangePoseCommand) => {
                let message: PoseStamped = self.read(topic, cdr)?;
                Ok(Command::FlangePose(pose_command(message.header, &message.pose)))
            }
            TopicId::Object(object, ObjectTopic::PoseCommand) => {
                let message: PoseStamped = self.read(topic, cdr)?;
                let pose = pose_command(message.header, &message.pose);
                Ok(Command::ObjectPose { object: self.objects[object].clone(), pose })
            }
            TopicId::Common(CommonTopic::ObjectCommand) => self.object_command(topic, cdr),
            TopicId::Common(CommonTopic::JointCommands) => {
                let message: JointState = self.read(topic, cdr)?;
                let stamp_ns = stamp_ns(&message.header);
                let (names, positions) = (message.name, message.position);
                Ok(Command::Joints { stamp_ns, names, positions })
            }
            _ => Err(CommandDecodeError::NotAnInput { topic: self.topics[topic].name.clone() }),
        }
    }

    fn object_command(&self, topic: usize, cdr: &[u8]) -> Result<Command, CommandDecodeError> {
        let message: ObjectCommand = self.read(topic, cdr)?;
        let object = message.object;
        match message.mode {
            ObjectCommand::MODE_DRIVE => Ok(Command::ObjectPose {
                object,
                pose: pose_command(message.header, &message.pose),
            }),
            ObjectCommand::MODE_RELEASE => Ok(Command::ObjectRelease { object }),
            mode => Err(CommandDecodeError::UnknownMode {
                topic: self.topics[topic].name.clone(),
                mode,
            }),
        }
    }

    fn read<T: RosMessage>(&self, topic: usize, cdr: &[u8]) -> Result<T, CommandDecodeError> {
        T::from_cdr(cdr).map_err(|error| CommandDecodeError::Malformed {
            topic: self.topics[topic].name.clone(),
            type_name: self.topics[topic].message_type.name,
            n_bytes: cdr.len(),
            reason: error.to_string(),
        })
    }

    /// Encodes a command as a message. Poses of the scene's own objects go to the object's
    /// `pose_cmd`; releases, and poses of other objects, go to `~/object_cmd`.
    pub fn encode(&self, command: &Command, time_ns: u64) -> Message {
        let (topic, cdr) = match command {
            Command::Vacuum { gauge_pa } => {
                (common(CommonTopic::VacuumCommand), Float64 { data: *gauge_pa }.to_cdr())
            }
            Command::FlangePose(pose) => {
                (common(CommonTopic::FlangePoseCommand), pose_stamped(pose).to_cdr())
            }
            Command::ObjectPose { object, pose } => {
                match self.objects.iter().position(|name| name == object) {
                    Some(index) => {
                        (object_topic(index, ObjectTopic::PoseCommand), pose_stamped(pose).to_cdr())
                    }
                    None => {
                        let PoseStamped { header, pose } = pose_stamped(pose);
                        let (object, mode) = (object.clone(), ObjectCommand::MODE_DRIVE);
                        let message = ObjectCommand { header, object, mode, pose };
                        (common(CommonTopic::ObjectCommand), message.to_cdr())
                    }
                }
            }
            Command::Joints { stamp_ns, names, positions } => {
                let header = Header { stamp: stamp(*stamp_ns), frame_id: String::new() };
                let (name, position) = (names.clone(), positions.clone());
                let message = JointState { header, name, position, ..Default::default() };
                (common(CommonTopic::JointCommands), message.to_cdr())
            }
            Command::ObjectRelease { object } => {
                let (object, mode) = (object.clone(), ObjectCommand::MODE_RELEASE);
                let message = ObjectCommand { object, mode, ..Default::default() };
                (common(CommonTopic::ObjectCommand), message.to_cdr())
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

/// A ROS time. Times outside the range of its 32-bit seconds are clamped.
fn stamp(time_ns: i64) -> Time {
    let sec = time_ns.div_euclid(1_000_000_000).clamp(i32::MIN.into(), i32::MAX.into());
    #[expect(clippy::cast_possible_truncation, reason = "clamped to 32 bits above")]
    Time { sec: sec as i32, nanosec: time_ns.rem_euclid(1_000_000_000) as u32 }
}
