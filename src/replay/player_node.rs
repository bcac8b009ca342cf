//! The ROS 2 node that plays a recording: a publisher for each topic, with the recorded quality of
//! service.

use std::{
    collections::BTreeMap,
    sync::{Arc, mpsc::Sender},
};

use super::{
    play::{CLOCK, PlayerOutput},
    player_command::Asked,
    player_services::PlayerServices,
};
use crate::{
    bag::{
        metadata::qos_in_words,
        reader::{Channel, Recorded},
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
/// Depth of a history that was not recorded, or kept everything.
const DEPTH: u32 = 10;

/// A node with the publishers of a recording.
pub struct RosPlayerNode {
    node: Arc<RosNode>,
    publishers: BTreeMap<String, Publisher<Body>>,
    clock: Option<Publisher<Body>>,
    /// Messages that could not be published, and why the last could not.
    pub faults: (u64, Option<String>),
}

impl RosPlayerNode {
    /// Joins the graph; `tells_time` opens `/clock`.
    ///
    /// # Errors
    /// When there is no graph, or the topic cannot be opened.
    pub fn join(reach: &DiscoveryRange, tells_time: bool) -> Result<Self, RosError> {
        let node = RosNode::join_as(NODE_NAME, reach)?;
        let topic = || Topic::output::<Clock>(CLOCK, Qos::reliable(1));
        let clock = tells_time.then(|| node.publisher(&topic())).transpose()?;
        Ok(Self { node, publishers: BTreeMap::new(), clock, faults: (0, None) })
    }

    /// Opens the services by which others give cues.
    ///
    /// # Errors
    /// When one cannot be opened.
    pub fn prompted(&self, teller: Sender<Asked>) -> Result<PlayerServices, RosError> {
        PlayerServices::open(&self.node, NODE_NAME, teller)
    }

    fn fail(&mut self, fault: String) {
        self.faults = (self.faults.0 + 1, Some(fault));
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
                self.faults.1 = Some(error.to_string());
                false
            }
        }
    }

    fn publish(&mut self, message: &Recorded) {
        let topic = &message.channel.topic;
        let Some(publisher) = self.publishers.get(topic) else { return };
        let sent = match message.data.strip_prefix(&CDR_HEADER) {
            Some(cdr) => send(publisher, cdr),
            None => Err(format!("{topic}: not little-endian CDR")),
        };
        sent.unwrap_or_else(|fault| self.fail(fault));
    }

    fn clock(&mut self, time_ns: u64) {
        let Some(publisher) = &self.clock else { return };
        let sec = i32::try_from(time_ns / 1_000_000_000).unwrap_or(i32::MAX);
        let nanosec = u32::try_from(time_ns % 1_000_000_000).unwrap_or(0);
        let sent = send(publisher, &Clock { clock: Time { sec, nanosec } }.to_cdr());
        sent.unwrap_or_else(|fault| self.fail(fault));
    }
}

/// A topic as it was recorded.
fn topic(channel: &Channel) -> Topic {
    // Names of types live as long as the program; there are few, and each is opened once.
    let type_name: &'static str = channel.type_name().to_owned().leak();
    let qos = qos_in_words(channel.metadata.get("offered_qos_profiles").map_or("", |it| it));
    let depth = |line: &str| line.trim_start().strip_prefix("depth: ")?.trim().parse().ok();
    let depth = qos.lines().find_map(depth).filter(|depth| *depth != 0).unwrap_or(DEPTH);
    let no_details = MessageType { name: type_name, dds_name: "", type_hash: "", definition: "" };
    Topic {
        name: channel.topic.clone(),
        message_type: no_details,
        qos: Qos {
            is_reliable: !qos.contains("reliability: best_effort"),
            depth,
            is_latched: qos.contains("durability: transient_local"),
        },
        is_input: false,
    }
}
