//! The ROS 2 node that plays a recording, with a publisher for each topic and the recorded quality
//! of service.

use std::{
    collections::BTreeMap,
    sync::{Arc, mpsc::Sender},
};

use super::{
    play::{CLOCK, PlayerOutput},
    player_command::CommandRequest,
    player_services::PlayerServices,
};
use crate::{
    bag::{
        metadata::qos_with_names,
        reader::{Channel, RecordedMessage},
        writer::CDR_HEADER,
    },
    ros::{
        discovery::DiscoveryRange,
        node::{Body, Publisher, RosError, RosNode},
    },
    wire::{
        messages::{MessageType, RosMessage, builtin_interfaces::Time, rosgraph_msgs::Clock},
        topics::{Qos, Topic},
    },
};

/// Name of the node, in the root namespace.
pub const NODE_NAME: &str = "jamgrip_player";
/// History depth of topics for which none was recorded, or that kept all samples.
const DEFAULT_DEPTH: u32 = 10;

/// A node with publishers of the recorded topics.
pub struct RosPlayerNode {
    node: Arc<RosNode>,
    publishers: BTreeMap<String, Publisher<Body>>,
    clock: Option<Publisher<Body>>,
    /// Number of messages that could not be published, and the last error.
    pub errors: (u64, Option<String>),
}

impl RosPlayerNode {
    /// Joins the graph. If `publishes_clock`, it opens `/clock`.
    ///
    /// # Errors
    /// If the node cannot join, or the topic cannot be opened.
    pub fn join(range: &DiscoveryRange, publishes_clock: bool) -> Result<Self, RosError> {
        let node = RosNode::join_as(NODE_NAME, range)?;
        let topic = || Topic::output::<Clock>(CLOCK, Qos::reliable(1));
        let clock = publishes_clock.then(|| node.publisher(&topic())).transpose()?;
        Ok(Self { node, publishers: BTreeMap::new(), clock, errors: (0, None) })
    }

    /// Opens the services that control the player.
    ///
    /// # Errors
    /// If a service cannot be opened.
    pub fn open_services(
        &self,
        commands: Sender<CommandRequest>,
    ) -> Result<PlayerServices, RosError> {
        PlayerServices::open(&self.node, NODE_NAME, commands)
    }

    fn fail(&mut self, error: String) {
        self.errors = (self.errors.0 + 1, Some(error));
    }
}

fn send(publisher: &Publisher<Body>, cdr: &[u8]) -> Result<(), String> {
    publisher.publish(Body::new(cdr.to_vec())).map_err(|error| error.to_string())
}

impl PlayerOutput for RosPlayerNode {
    fn open(&mut self, channel: &Channel) -> bool {
        if channel.encoding != "cdr" {
            return false;
        }
        let publisher = self.node.publisher(&topic(channel));
        match publisher {
            Ok(publisher) => {
                self.publishers.insert(channel.topic.clone(), publisher);
                true
            }
            Err(error) => {
                self.errors.1 = Some(error.to_string());
                false
            }
        }
    }

    fn publish(&mut self, message: &RecordedMessage) {
        let topic = &message.channel.topic;
        let Some(publisher) = self.publishers.get(topic) else { return };
        let result = match message.data.strip_prefix(&CDR_HEADER) {
            Some(cdr) => send(publisher, cdr),
            None => Err(format!("{topic}: not little-endian CDR")),
        };
        result.unwrap_or_else(|error| self.fail(error));
    }

    fn publish_clock(&mut self, time_ns: u64) {
        let Some(publisher) = &self.clock else { return };
        let sec = i32::try_from(time_ns / 1_000_000_000).unwrap_or(i32::MAX);
        let nanosec = u32::try_from(time_ns % 1_000_000_000).unwrap_or(0);
        let result = send(publisher, &Clock { clock: Time { sec, nanosec } }.to_cdr());
        result.unwrap_or_else(|error| self.fail(error));
    }
}

/// A topic with its recorded name, type and quality of service.
fn topic(channel: &Channel) -> Topic {
    // Type names live as long as the program. There are few, and each is leaked once.
    let type_name: &'static str = channel.type_name().to_owned().leak();
    let qos = qos_with_names(channel.metadata.get("offered_qos_profiles").map_or("", |it| it));
    let depth = |line: &str| line.trim_start().strip_prefix("depth: ")?.trim().parse().ok();
    let depth = qos.lines().find_map(depth).filter(|depth| *depth != 0).unwrap_or(DEFAULT_DEPTH);
    let message_type = MessageType { name: type_name, dds_name: "", type_hash: "", definition: "" };
    Topic {
        name: channel.topic.clone(),
        message_type,
        qos: Qos {
            is_reliable: !qos.contains("reliability: best_effort"),
            depth,
            is_latched: qos.contains("durability: transient_local"),
        },
        is_input: false,
    }
}
