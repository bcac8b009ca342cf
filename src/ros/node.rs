//! ROS 2: the node `/jamgrip` and its publishers, which carry messages encoded once for all sinks.
//!
//! The node is made of ros2-client's parts, so that it is listed in `ros_discovery_info` with all
//! its topics. Two of them are left out on purpose. Its `Spinner` would subscribe to `/clock` under
//! a wrong type name, and tools refuse a topic that has two types; what it gives besides (the
//! parameter services, and match counts that never go down) is not needed here. And its typed
//! messages: a [`Body`] hands over bytes that are CDR already.
//!
//! No write waits for a reader. A reliable reader that stops acknowledging costs memory for some
//! seconds' worth of messages, then writes to it fail, are counted, and the run goes on.

use std::{
    net::Ipv4Addr,
    sync::{Arc, Mutex, PoisonError},
    time::Duration,
};

use ros2_client::{
    Context, MessageTypeName, Name, Node, NodeName, NodeOptions,
    qos::{Durability, History, QosProfile, Reliability, WhenFull},
};
pub use ros2_client::{Publisher, Subscription};
use rustdds::DomainParticipantBuilder;
use serde::{Serialize, Serializer, ser::SerializeTuple};

use crate::wire::{
    to_ros::Encoder,
    topics::{Common, Message, Qos, Topic, common},
};
use crate::{
    io::{
        published::PublishedUpTo,
        sink::{Packet, Sink},
    },
    ros::discovery::{DiscoveryExtent, DiscoveryRange},
};

/// What of the middleware's own log is worth a line, as a filter for `env_logger`: it warns about
/// every larger datagram, and reports an error when it leaves a multicast group that a loopback
/// interface never had.
pub const LOG_FILTER: &str = "rustdds=error,rustdds::network::udp_listener=off,ros2_client=error";

/// Why the node could not join, or a topic could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum RosError {
    /// Discovery is switched off; there is no graph to join.
    #[error(
        "ROS_AUTOMATIC_DISCOVERY_RANGE=OFF disables ROS 2: unset it, or disable ROS 2 in the scene"
    )]
    Off,
    /// The node could not be made.
    #[error(
        "the node could not join ROS 2 domain {domain_id}: {reason}; is there a network \
         interface, and are there fewer than 120 participants in this domain?"
    )]
    Join {
        /// The domain.
        domain_id: u16,
        /// What the middleware says.
        reason: String,
    },
    /// The thread that listens could not be started.
    #[error("no thread for ROS 2: {reason}; raise the process limit")]
    Thread {
        /// What the system says.
        reason: std::io::Error,
    },
    /// A topic could not be opened.
    #[error("topic `{topic}` of type `{type_name}` could not be opened: {reason}; rename it")]
    Topic {
        /// Name of the topic.
        topic: String,
        /// Type of the topic.
        type_name: String,
        /// What the middleware says.
        reason: String,
    },
    /// What never changes could not be published.
    #[error(transparent)]
    Write(#[from] WriteFault),
}

/// One or more writes of a packet failed.
#[derive(Debug, thiserror::Error)]
#[error(
    "{n_failed} of {n_messages} messages were not taken, first on `{topic}`: {reason}; is a reader \
     too slow or stopped?"
)]
pub struct WriteFault {
    /// How many were not taken.
    pub n_failed: usize,
    /// How many there were.
    pub n_messages: usize,
    /// Topic of the first.
    pub topic: String,
    /// What the middleware says.
    pub reason: String,
}

/// The node: one participant in the graph, shared by those who publish and those who listen.
pub struct RosNode {
    node: Mutex<Node>,
    context: Context,
}

/// A message body that is CDR already.
#[derive(Clone, Debug)]
pub struct Body(Vec<u8>);

/// The publishers of all topics that carry something out.
pub struct RosSink {
    publishers: Vec<Option<(String, Publisher<Body>)>>,
    encoder: Arc<Encoder>,
    published: Arc<PublishedUpTo>,
    /// The last clock message, repeated while time stands still.
    clock: Option<Message>,
    node: Arc<RosNode>,
}

impl RosNode {
    /// Joins the graph as far as `reach` says.
    ///
    /// # Errors
    /// When discovery is off, or there is no socket to be had.
    pub fn join(reach: &DiscoveryRange) -> Result<Arc<Self>, RosError> {
        Self::join_as("/jamgrip", reach)
    }

    /// Joins under another name, with or without a namespace.
    ///
    /// # Errors
    /// As for `join`.
    pub fn join_as(name: &str, reach: &DiscoveryRange) -> Result<Arc<Self>, RosError> {
        let refused = |it: &dyn std::fmt::Display| RosError::Join {
            domain_id: reach.domain_id,
            reason: it.to_string(),
        };
        let builder = DomainParticipantBuilder::new(reach.domain_id);
        let builder = match reach.extent {
            DiscoveryExtent::Off => return Err(RosError::Off),
            DiscoveryExtent::Host => builder.with_only_networks([Ipv4Addr::LOCALHOST]),
            DiscoveryExtent::Lan => builder,
        };
        let participant = builder.build().map_err(|it| refused(&it))?;
        let context = Context::from_domain_participant(participant).map_err(|it| refused(&it))?;
        let (namespace, name) = name.rsplit_once('/').unwrap_or(("", name));
        let namespace = if namespace.is_empty() { "/" } else { namespace };
        let name = NodeName::new(namespace, name).map_err(|it| refused(&format!("{it:?}")))?;
        let options = NodeOptions::new().enable_rosout(true).start_parameter_services(false);
        let node = context.new_node(name, options).map_err(|it| refused(&format!("{it:?}")))?;
        Ok(Arc::new(Self { node: Mutex::new(node), context }))
    }

    /// Readers of a topic elsewhere in the graph, as far as discovered.
    pub fn n_readers(&self, topic: &str) -> usize {
        let name = dds_name(topic);
        let readers = self.context.domain_participant().discovered_readers();
        readers.iter().filter(|it| it.subscription_topic_data.topic_name == name).count()
    }

    /// Writers of a topic elsewhere in the graph, as far as discovered.
    pub fn n_writers(&self, topic: &str) -> usize {
        let name = dds_name(topic);
        let writers = self.context.domain_participant().discovered_writers();
        writers.iter().filter(|it| it.publication_topic_data.topic_name == name).count()
    }

    /// Opens a topic for writing. The port is good for as long as the node is kept.
    ///
    /// # Errors
    /// When its name or type is not one of ROS 2.
    pub fn publisher(&self, topic: &Topic) -> Result<Publisher<Body>, RosError> {
        self.open(topic, |node, it| node.create_publisher(it, None))
    }

    /// Opens a topic for reading. The port is good for as long as the node is kept.
    ///
    /// # Errors
    /// When its name or type is not one of ROS 2.
    pub fn subscription<M: 'static>(&self, topic: &Topic) -> Result<Subscription<M>, RosError> {
        self.open(topic, |node, it| node.create_subscription(it, None))
    }

    /// Says something on `/rosout`, as a warning.
    pub fn say(&self, text: &str) {
        let node = self.node.lock().unwrap_or_else(PoisonError::into_inner);
        ros2_client::rosout!((*node), ros2_client::ros2::LogLevel::Warn, "{text}");
    }

    /// What ros2-client knows of the graph.
    pub(crate) fn context(&self) -> Context {
        self.context.clone()
    }

    /// The participant itself, for services.
    pub fn participant(&self) -> rustdds::DomainParticipant {
        self.context.domain_participant()
    }

    fn open<Port>(
        &self,
        topic: &Topic,
        make: impl FnOnce(&mut Node, &rustdds::Topic) -> ros2_client::CreateResult<Port>,
    ) -> Result<Port, RosError> {
        let refused = |reason: String| RosError::Topic {
            topic: topic.name.clone(),
            type_name: topic.message_type.name.to_owned(),
            reason,
        };
        let (namespace, base) =
            topic.name.rsplit_once('/').ok_or_else(|| refused("no leading `/`".to_owned()))?;
        let namespace = if namespace.is_empty() { "/" } else { namespace };
        let name = Name::new(namespace, base).map_err(|it| refused(format!("{it:?}")))?;
        let (package, rest) = topic
            .message_type
            .name
            .split_once("/msg/")
            .ok_or_else(|| refused("the type is not `package/msg/Type`".to_owned()))?;
        // A panic while another port was opened leaves the node as it was before that port.
        let mut node = self.node.lock().unwrap_or_else(PoisonError::into_inner);
        let port = node
            .create_topic(&name, MessageTypeName::new(package, rest), &profile(topic.qos))
            .and_then(|it| make(&mut node, &it));
        port.map_err(|it| refused(it.to_string()))
    }
}

impl Body {
    /// A body of little-endian CDR, without the four bytes that name the encoding.
    pub fn new(cdr: Vec<u8>) -> Self {
        Self(cdr)
    }
}

/// Bytes in, the same bytes out. CDR aligns whole numbers to their size, counted from the start
/// of the body, so a run of 16-byte numbers and then single bytes is written without padding.
impl Serialize for Body {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (blocks, rest) = self.0.as_chunks::<16>();
        let mut out = serializer.serialize_tuple(blocks.len() + rest.len())?;
        for block in blocks {
            out.serialize_element(&u128::from_le_bytes(*block))?;
        }
        for byte in rest {
            out.serialize_element(byte)?;
        }
        out.end()
    }
}

impl RosSink {
    /// Opens a publisher for every topic that is not an input, and publishes what never changes.
    ///
    /// # Errors
    /// When a topic cannot be opened.
    pub fn new(node: &Arc<RosNode>, encoder: &Arc<Encoder>) -> Result<Self, RosError> {
        let open = |(index, topic): (usize, &Topic)| {
            let is_others = index == common(Common::Clock) && encoder.follows_clock();
            if topic.is_input || is_others {
                return Ok(None);
            }
            node.publisher(topic).map(|it| Some((topic.name.clone(), it)))
        };
        let publishers = encoder.topics().iter().enumerate().map(open).collect::<Result<_, _>>()?;
        let sink = Self {
            publishers,
            encoder: Arc::clone(encoder),
            published: Arc::default(),
            clock: None,
            node: Arc::clone(node),
        };
        sink.send(&encoder.latched(0))?;
        Ok(sink)
    }

    /// Notes what has been published, for answers that must stay behind it.
    pub fn announcing(self, published: &Arc<PublishedUpTo>) -> Self {
        Self { published: Arc::clone(published), ..self }
    }

    /// Tries all messages, also behind one that fails.
    fn send(&self, messages: &[Message]) -> Result<(), WriteFault> {
        let mut n_failed = 0;
        let mut first = None;
        for message in messages {
            // Inputs are recorded by bags; here they would echo what was heard.
            let Some(Some((topic, publisher))) = self.publishers.get(message.topic) else {
                continue;
            };
            if let Err(error) = publisher.publish(Body::new(message.cdr.clone())) {
                n_failed += 1;
                first.get_or_insert_with(|| (topic.clone(), error.to_string()));
            }
        }
        let Some((topic, reason)) = first else { return Ok(()) };
        Err(WriteFault { n_failed, n_messages: messages.len(), topic, reason })
    }
}

impl Sink for RosSink {
    fn name(&self) -> &'static str {
        "ros"
    }

    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        for topic in packet.topics_beyond(self.publishers.len()) {
            // One that cannot be opened is left out; the others go on.
            let opened = self.node.publisher(topic);
            let opened = opened.inspect_err(|fault| log::warn!("{fault}"));
            self.publishers.push(opened.ok().map(|it| (topic.name.clone(), it)));
        }
        let messages = packet.messages(&self.encoder);
        let sent = self.send(messages);
        if self.clock.is_none() {
            self.send(&self.encoder.ready(packet.snapshot.time_ns))?;
        }
        self.published.note(packet.number);
        self.clock = messages.iter().find(|it| it.topic == common(Common::Clock)).cloned();
        sent.map_err(Into::into)
    }

    fn idle_after(&self) -> Duration {
        Duration::from_millis(100)
    }

    fn idle(&mut self) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        self.send(self.clock.as_slice()).map_err(Into::into)
    }

    fn close(&mut self) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        self.publishers.clear();
        Ok(())
    }
}

/// The same for ports on bare DDS.
pub fn policies(qos: Qos) -> rustdds::QosPolicies {
    profile(qos).into()
}

fn profile(qos: Qos) -> QosProfile {
    let reliable = Reliability::Reliable { when_full: WhenFull::Fail };
    QosProfile::publisher_default()
        .reliability(if qos.is_reliable { reliable } else { Reliability::BestEffort })
        .durability(if qos.is_latched { Durability::TransientLocal } else { Durability::Volatile })
        .history(History::KeepLast { depth: qos.depth as usize })
}

/// ROS 2's name of a topic on the DDS side.
fn dds_name(topic: &str) -> String {
    format!("rt{topic}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the identity, through the very serializer that the middleware uses.
    #[test]
    fn a_body_is_written_as_it_is() {
        for length in [0, 1, 8, 15, 16, 17, 31, 32, 33, 1000] {
            let bytes: Vec<u8> = (0..length).map(|i| u8::try_from(i % 251).unwrap()).collect();
            let written =
                cdr_encoding::to_vec::<_, byteorder::LittleEndian>(&Body::new(bytes.clone()));
            assert_eq!(written.unwrap(), bytes, "length {length}");
        }
    }
}
