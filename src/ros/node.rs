//! The ROS 2 node `/jamgrip` and its publishers. Messages are encoded once for all sinks.
//!
//! The node is built from ros2-client's parts, so that it is listed in `ros_discovery_info` with
//! all its topics. Two parts are deliberately not used. Its `Spinner` would subscribe to `/clock`
//! under a wrong type name, and tools reject a topic that has two types; its other features
//! (parameter services, and match counts that never decrease) are not needed here. Its typed
//! messages are replaced by [`Body`], which passes on bytes that are already CDR.
//!
//! Writes never wait for a reader. A reliable reader that stops acknowledging costs memory for the
//! messages of a few seconds. After that, writes to it fail and are counted, and the run continues.

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
    topics::{CommonTopic, Message, Qos, Topic, common},
};
use crate::{
    io::{
        published::PublishedUpTo,
        sink::{Packet, Sink},
    },
    ros::discovery::{DiscoveryExtent, DiscoveryRange},
};

/// Filter for `env_logger` that hides useless messages of the middleware: it warns about every
/// larger datagram, and reports an error when it leaves a multicast group that a loopback interface
/// never had.
pub const LOG_FILTER: &str = "rustdds=error,rustdds::network::udp_listener=off,ros2_client=error";

/// Why the node could not join the graph, or a topic could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum RosError {
    /// Discovery is off, so there is no graph to join.
    #[error(
        "ROS_AUTOMATIC_DISCOVERY_RANGE=OFF disables ROS 2: unset it, or disable ROS 2 in the scene"
    )]
    Off,
    /// The node could not be created.
    #[error(
        "the node could not join ROS 2 domain {domain_id}: {reason}; is there a network \
        interface, and are there fewer than 120 participants in this domain?"
    )]
    Join {
        /// ID of the domain.
        domain_id: u16,
        /// Reason given by the middleware.
        reason: String,
    },
    /// A thread could not be started.
    #[error("no thread for ROS 2: {reason}; raise the process limit")]
    Thread {
        /// Reason given by the operating system.
        reason: std::io::Error,
    },
    /// A topic could not be opened.
    #[error("topic `{topic}` of type `{type_name}` could not be opened: {reason}; rename it")]
    Topic {
        /// Name of the topic.
        topic: String,
        /// Type of the topic.
        type_name: String,
        /// Reason given by the middleware.
        reason: String,
    },
    /// The constant messages could not be published.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// One or more messages of a packet could not be written.
#[derive(Debug, thiserror::Error)]
#[error(
    "{n_failed} of {n_messages} messages could not be written, first on `{topic}`: {reason}; is a \
    reader too slow or stopped?"
)]
pub struct WriteError {
    /// Number of messages that could not be written.
    pub n_failed: usize,
    /// Number of messages in the packet.
    pub n_messages: usize,
    /// Topic of the first failed message.
    pub topic: String,
    /// Reason given by the middleware.
    pub reason: String,
}

/// The node: one participant in the graph, shared by publishers, subscriptions and services.
pub struct RosNode {
    node: Mutex<Node>,
    context: Context,
}

/// A message body that is already CDR.
#[derive(Clone, Debug)]
pub struct Body(Vec<u8>);

/// The publishers of all output topics.
pub struct RosSink {
    publishers: Vec<Option<(String, Publisher<Body>)>>,
    encoder: Arc<Encoder>,
    published: Arc<PublishedUpTo>,
    /// The last clock message, repeated while simulation time does not advance.
    clock: Option<Message>,
    node: Arc<RosNode>,
}

impl RosNode {
    /// Joins the graph as `/jamgrip` with this discovery range.
    ///
    /// # Errors
    /// If discovery is off or no socket can be opened.
    pub fn join(range: &DiscoveryRange) -> Result<Arc<Self>, RosError> {
        Self::join_as("/jamgrip", range)
    }

    /// Joins under another name, with or without a namespace.
    ///
    /// # Errors
    /// As for [`RosNode::join`].
    pub fn join_as(name: &str, range: &DiscoveryRange) -> Result<Arc<Self>, RosError> {
        let to_error = |it: &dyn std::fmt::Display| RosError::Join {
            domain_id: range.domain_id,
            reason: it.to_string(),
        };
        let builder = DomainParticipantBuilder::new(range.domain_id);
        let builder = match range.extent {
            DiscoveryExtent::Off => return Err(RosError::Off),
            DiscoveryExtent::Host => builder.with_only_networks([Ipv4Addr::LOCALHOST]),
            DiscoveryExtent::Lan => builder,
        };
        let participant = builder.build().map_err(|it| to_error(&it))?;
        let context = Context::from_domain_participant(participant).map_err(|it| to_error(&it))?;
        let (namespace, name) = name.rsplit_once('/').unwrap_or(("", name));
        let namespace = if namespace.is_empty() { "/" } else { namespace };
        let name = NodeName::new(namespace, name).map_err(|it| to_error(&format!("{it:?}")))?;
        let options = NodeOptions::new().enable_rosout(true).start_parameter_services(false);
        let node = context.new_node(name, options).map_err(|it| to_error(&format!("{it:?}")))?;
        Ok(Arc::new(Self { node: Mutex::new(node), context }))
    }

    /// Number of discovered readers of a topic, without those of this participant.
    pub fn n_readers(&self, topic: &str) -> usize {
        let name = dds_name(topic);
        let readers = self.context.domain_participant().discovered_readers();
        readers.iter().filter(|it| it.subscription_topic_data.topic_name == name).count()
    }

    /// Number of discovered writers of a topic, without those of this participant.
    pub fn n_writers(&self, topic: &str) -> usize {
        let name = dds_name(topic);
        let writers = self.context.domain_participant().discovered_writers();
        writers.iter().filter(|it| it.publication_topic_data.topic_name == name).count()
    }

    /// Opens a publisher of a topic. It is valid as long as the node exists.
    ///
    /// # Errors
    /// If the name or the type is not valid in ROS 2.
    pub fn publisher(&self, topic: &Topic) -> Result<Publisher<Body>, RosError> {
        self.open(topic, |node, it| node.create_publisher(it, None))
    }

    /// Opens a subscription to a topic. It is valid as long as the node exists.
    ///
    /// # Errors
    /// If the name or the type is not valid in ROS 2.
    pub fn subscription<M: 'static>(&self, topic: &Topic) -> Result<Subscription<M>, RosError> {
        self.open(topic, |node, it| node.create_subscription(it, None))
    }

    /// Publishes a warning on `/rosout`.
    pub fn warn(&self, text: &str) {
        let node = self.node.lock().unwrap_or_else(PoisonError::into_inner);
        ros2_client::rosout!((*node), ros2_client::ros2::LogLevel::Warn, "{text}");
    }

    /// The context of ros2-client.
    pub(crate) fn context(&self) -> Context {
        self.context.clone()
    }

    /// The DDS participant, for services.
    pub fn participant(&self) -> rustdds::DomainParticipant {
        self.context.domain_participant()
    }

    fn open<Entity>(
        &self,
        topic: &Topic,
        make: impl FnOnce(&mut Node, &rustdds::Topic) -> ros2_client::CreateResult<Entity>,
    ) -> Result<Entity, RosError> {
        let to_error = |reason: String| RosError::Topic {
            topic: topic.name.clone(),
            type_name: topic.message_type.name.to_owned(),
            reason,
        };
        let (namespace, base) =
            topic.name.rsplit_once('/').ok_or_else(|| to_error("no leading `/`".to_owned()))?;
        let namespace = if namespace.is_empty() { "/" } else { namespace };
        let name = Name::new(namespace, base).map_err(|it| to_error(format!("{it:?}")))?;
        let (package, rest) = topic
            .message_type
            .name
            .split_once("/msg/")
            .ok_or_else(|| to_error("the type is not `package/msg/Type`".to_owned()))?;
        // A panic while another topic was opened leaves the node as it was before that topic.
        let mut node = self.node.lock().unwrap_or_else(PoisonError::into_inner);
        let entity = node
            .create_topic(&name, MessageTypeName::new(package, rest), &profile(topic.qos))
            .and_then(|it| make(&mut node, &it));
        entity.map_err(|it| to_error(it.to_string()))
    }
}

impl Body {
    /// A body of little-endian CDR, without the encapsulation header of four bytes.
    pub fn new(cdr: Vec<u8>) -> Self {
        Self(cdr)
    }
}

/// Writes the bytes unchanged. CDR aligns an integer to its size, counted from the start of the
/// body, so a series of 16-byte integers followed by single bytes is written without padding.
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
    /// Opens a publisher for every topic that is not an input, and publishes the constant messages.
    ///
    /// # Errors
    /// If a topic cannot be opened.
    pub fn new(node: &Arc<RosNode>, encoder: &Arc<Encoder>) -> Result<Self, RosError> {
        let open = |(index, topic): (usize, &Topic)| {
            let is_external = index == common(CommonTopic::Clock) && encoder.follows_clock();
            if topic.is_input || is_external {
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

    /// Reports published packets to `published`, so that responses can wait for them.
    pub fn reporting_to(self, published: &Arc<PublishedUpTo>) -> Self {
        Self { published: Arc::clone(published), ..self }
    }

    /// Tries to publish all messages, even if one fails.
    fn send(&self, messages: &[Message]) -> Result<(), WriteError> {
        let mut n_failed = 0;
        let mut first = None;
        for message in messages {
            // Inputs are in the list only because bags record them; they are not published again.
            let Some(Some((topic, publisher))) = self.publishers.get(message.topic) else {
                continue;
            };
            if let Err(error) = publisher.publish(Body::new(message.cdr.clone())) {
                n_failed += 1;
                first.get_or_insert_with(|| (topic.clone(), error.to_string()));
            }
        }
        let Some((topic, reason)) = first else { return Ok(()) };
        Err(WriteError { n_failed, n_messages: messages.len(), topic, reason })
    }
}

impl Sink for RosSink {
    fn name(&self) -> &'static str {
        "ros"
    }

    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        for topic in packet.topics_beyond(self.publishers.len()) {
            // A topic that cannot be opened is skipped; the others continue.
            let opened = self.node.publisher(topic);
            let opened = opened.inspect_err(|error| log::warn!("{error}"));
            self.publishers.push(opened.ok().map(|it| (topic.name.clone(), it)));
        }
        let messages = packet.messages(&self.encoder);
        let sent = self.send(messages);
        if self.clock.is_none() {
            self.send(&self.encoder.ready(packet.snapshot.time_ns))?;
        }
        self.published.report(packet.number);
        self.clock = messages.iter().find(|it| it.topic == common(CommonTopic::Clock)).cloned();
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

/// The DDS policies of a topic.
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

/// The DDS name of a ROS 2 topic.
fn dds_name(topic: &str) -> String {
    format!("rt{topic}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the identity, through the serializer that the middleware uses.
    #[test]
    fn a_body_is_written_unchanged() {
        for length in [0, 1, 8, 15, 16, 17, 31, 32, 33, 1000] {
            let bytes: Vec<u8> = (0..length).map(|i| u8::try_from(i % 251).unwrap()).collect();
            let written =
                cdr_encoding::to_vec::<_, byteorder::LittleEndian>(&Body::new(bytes.clone()));
            assert_eq!(written.unwrap(), bytes, "length {length}");
        }
    }
}
