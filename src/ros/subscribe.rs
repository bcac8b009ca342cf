//! Commands from ROS 2 topics: subscriptions that fill the inbox, on their own thread.

use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};

use ros2_client::Subscription;
use serde::de::{DeserializeSeed, Deserializer};
use smol::{future, stream::StreamExt};

use crate::io::{
    inbox::Inbox,
    source::{Source, SourceCounters},
};
use crate::{
    command::Command,
    ros::{
        node::{RosError, RosNode},
        worker::Worker,
    },
    snapshot::Snapshot,
    wire::{
        messages::{
            RosMessage, geometry_msgs::PoseStamped, jamgrip_msgs::ObjectCommand,
            rosgraph_msgs::Clock, sensor_msgs::JointState, std_msgs::Float64,
        },
        to_ros::Encoder,
        topics::{Qos, Topic},
    },
};

/// The body of a received message, in little-endian CDR.
struct Received(Vec<u8>);

/// The subscriptions to all command topics.
pub struct RosSource {
    inbox: Arc<Mutex<Inbox>>,
    _worker: Worker,
    _node: Arc<RosNode>,
}

impl RosSource {
    /// Opens a subscription to every input topic.
    ///
    /// # Errors
    /// If a topic cannot be opened.
    pub fn new(node: &Arc<RosNode>, encoder: &Arc<Encoder>) -> Result<Self, RosError> {
        let topics = encoder.topics();
        let inbox = Arc::new(Mutex::new(Inbox::new(topics.len())));
        let mut tasks = Vec::new();
        for (index, topic) in topics.iter().enumerate().filter(|(_, it)| it.is_input) {
            let subscription = node.subscription::<Received>(topic)?;
            let encoder = Arc::clone(encoder);
            let recode = Recode { type_name: topic.message_type.name };
            tasks.push(SubscriptionTask {
                index,
                name: topic.name.clone(),
                recode,
                subscription,
                encoder,
            });
        }
        let shared = Arc::clone(&inbox);
        let worker = Worker::start("ros-commands", move |executor| {
            for task in tasks {
                executor.spawn(task.run(Arc::clone(&shared))).detach();
            }
            executor.spawn(log_malformed(shared)).detach();
        })?;
        Ok(Self { inbox, _worker: worker, _node: Arc::clone(node) })
    }
}

impl Source for RosSource {
    fn name(&self) -> &'static str {
        "ros"
    }

    fn drain(&mut self, _snapshot: &Snapshot) -> Vec<Command> {
        lock(&self.inbox).drain()
    }

    fn has_received(&self) -> bool {
        0 < lock(&self.inbox).counters().n_received
    }

    fn counters(&self) -> SourceCounters {
        lock(&self.inbox).counters()
    }
}

/// The clock of another simulator, for a run that follows it.
pub struct RosClock {
    time_ns: Arc<AtomicU64>,
    _worker: Worker,
    _node: Arc<RosNode>,
}

impl RosClock {
    /// Subscribes to the clock topic of this name.
    ///
    /// # Errors
    /// If it cannot be opened.
    pub fn new(node: &Arc<RosNode>, name: &str) -> Result<Self, RosError> {
        // Only the last message matters. Best effort matches any publisher.
        let qos = Qos { is_reliable: false, ..Qos::reliable(1) };
        let topic = Topic::input::<Clock>(name, qos);
        let subscription = node.subscription::<Clock>(&topic)?;
        let time_ns = Arc::new(AtomicU64::new(0));
        let received = Arc::clone(&time_ns);
        let worker = Worker::start("ros-clock", move |executor| {
            executor.spawn(follow_clock(subscription, received)).detach();
        })?;
        Ok(Self { time_ns, _worker: worker, _node: Arc::clone(node) })
    }

    /// The last time received (ns); it is updated as messages arrive.
    pub fn time_ns(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.time_ns)
    }
}

async fn follow_clock(subscription: Subscription<Clock>, last_ns: Arc<AtomicU64>) {
    let mut messages = std::pin::pin!(subscription.async_stream());
    while let Some(message) = messages.next().await {
        if let Ok((Clock { clock }, _)) = message
            && let Ok(seconds) = u64::try_from(clock.sec)
        {
            let time_ns = seconds * 1_000_000_000 + u64::from(clock.nanosec);
            last_ns.store(time_ns, Ordering::Release);
        }
    }
}

impl Source for RosClock {
    fn name(&self) -> &'static str {
        "clock"
    }

    fn drain(&mut self, _snapshot: &Snapshot) -> Vec<Command> {
        Vec::new()
    }

    fn has_received(&self) -> bool {
        0 < self.time_ns.load(Ordering::Acquire)
    }

    fn counters(&self) -> SourceCounters {
        SourceCounters::default()
    }
}

/// One subscription and the decoding of its messages.
struct SubscriptionTask {
    index: usize,
    name: String,
    recode: Recode,
    subscription: Subscription<Received>,
    encoder: Arc<Encoder>,
}

impl SubscriptionTask {
    /// Decodes messages into the inbox.
    async fn run(self, inbox: Arc<Mutex<Inbox>>) {
        let mut messages = std::pin::pin!(self.subscription.async_stream_seed(self.recode));
        while let Some(message) = messages.next().await {
            let command = match message {
                Ok((Received(cdr), _)) => {
                    let command = self.encoder.commands().decode(self.index, &cdr);
                    command.map_err(|it| it.to_string())
                }
                Err(error) => Err(format!("`{}`: {error}", self.name)),
            };
            match command {
                Ok(command) => lock(&inbox).push(self.index, command),
                Err(error) => lock(&inbox).report_malformed(error),
            }
            // A flood on one topic must not starve the others.
            future::yield_now().await;
        }
    }
}

/// Logs the last malformed message, at most once a second.
async fn log_malformed(inbox: Arc<Mutex<Inbox>>) {
    let mut n_logged = 0;
    loop {
        smol::Timer::after(Duration::from_secs(1)).await;
        let (n_malformed, error) = {
            let mut inbox = lock(&inbox);
            (inbox.counters().n_malformed, inbox.take_error())
        };
        if let Some(error) = error {
            let n_new = n_malformed - n_logged;
            log::warn!("{n_new} malformed messages were dropped, the last: {error}");
            n_logged = n_malformed;
        }
    }
}

/// Locks the inbox. It stays usable after a panic, because every call leaves it consistent.
fn lock(inbox: &Mutex<Inbox>) -> MutexGuard<'_, Inbox> {
    inbox.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reads one of the command types in the sender's byte order and encodes it as little-endian, so
/// that later code only sees little-endian bytes.
#[derive(Clone, Copy)]
struct Recode {
    type_name: &'static str,
}

impl<'de> DeserializeSeed<'de> for Recode {
    type Value = Received;

    fn deserialize<D: Deserializer<'de>>(self, bytes: D) -> Result<Received, D::Error> {
        let name = self.type_name;
        if name == Float64::TYPE.name {
            recode::<Float64, D>(bytes)
        } else if name == PoseStamped::TYPE.name {
            recode::<PoseStamped, D>(bytes)
        } else if name == ObjectCommand::TYPE.name {
            recode::<ObjectCommand, D>(bytes)
        } else if name == JointState::TYPE.name {
            recode::<JointState, D>(bytes)
        } else {
            Err(serde::de::Error::custom(format_args!("no command has the type `{name}`")))
        }
    }
}

fn recode<'de, T: RosMessage, D: Deserializer<'de>>(bytes: D) -> Result<Received, D::Error> {
    T::deserialize(bytes).map(|it| Received(it.to_cdr()))
}

#[cfg(test)]
mod tests {
    use byteorder::{BigEndian, LittleEndian};
    use cdr_encoding::{CdrDeserializer, to_vec};

    use super::*;

    fn recoded<BO: byteorder::ByteOrder>(
        type_name: &'static str,
        bytes: &[u8],
    ) -> Result<Vec<u8>, String> {
        let mut reader = CdrDeserializer::<BO>::new(bytes);
        let received = Recode { type_name }.deserialize(&mut reader);
        received.map(|it| it.0).map_err(|it| it.to_string())
    }

    /// Oracle: the little-endian encoding of the same message.
    #[test]
    fn both_byte_orders_give_the_same_bytes() {
        let mut pose = PoseStamped::default();
        pose.header.frame_id = "world".to_owned();
        pose.pose.position.z = 0.25;
        let little = to_vec::<_, LittleEndian>(&pose).unwrap();
        let big = to_vec::<_, BigEndian>(&pose).unwrap();
        assert_ne!(little, big);
        let name = PoseStamped::TYPE.name;
        assert_eq!(recoded::<LittleEndian>(name, &little).as_ref(), Ok(&little));
        assert_eq!(recoded::<BigEndian>(name, &big).as_ref(), Ok(&little));
    }

    /// Oracle: a message that is too short, or not a command, is an error and not a panic.
    #[test]
    fn malformed_messages_are_errors() {
        for length in 0..40 {
            for name in [Float64::TYPE.name, PoseStamped::TYPE.name, ObjectCommand::TYPE.name] {
                let is_float = name == Float64::TYPE.name && 8 <= length;
                let read = recoded::<LittleEndian>(name, &vec![0xff; length]);
                assert_eq!(read.is_ok(), is_float, "{name}, {length} bytes");
            }
        }
        assert!(recoded::<LittleEndian>("std_msgs/msg/Empty", &[0; 8]).is_err());
    }
}
