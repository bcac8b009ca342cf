//! Commands from ROS 2 topics: subscriptions that fill the inbox on a thread of their own.

use std::{
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    thread::JoinHandle,
    time::Duration,
};

use ros2_client::Subscription;
use serde::de::{DeserializeSeed, Deserializer};
use smol::{LocalExecutor, channel, future, stream::StreamExt};

use crate::io::{
    inbox::Inbox,
    source::{Source, SourceCounters},
};
use crate::{
    command::Command,
    ros::node::{RosError, RosNode},
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

/// A message's body as it came.
struct Received(Vec<u8>);

/// The subscriptions of all topics that carry commands.
pub struct RosSource {
    inbox: Arc<Mutex<Inbox>>,
    stop: channel::Sender<()>,
    listener: Option<JoinHandle<()>>,
    _node: Arc<RosNode>,
}

impl RosSource {
    /// Opens a subscription for every topic that is an input and listens from now on.
    ///
    /// # Errors
    /// When a topic cannot be opened.
    pub fn new(node: &Arc<RosNode>, encoder: &Arc<Encoder>) -> Result<Self, RosError> {
        let topics = encoder.topics();
        let inbox = Arc::new(Mutex::new(Inbox::new(topics.len())));
        let mut ears = Vec::new();
        for (index, topic) in topics.iter().enumerate().filter(|(_, it)| it.is_input) {
            let subscription = node.subscription::<Received>(topic)?;
            let encoder = Arc::clone(encoder);
            let recode = Recode { type_name: topic.message_type.name };
            ears.push(SubscriptionTask {
                index,
                name: topic.name.clone(),
                recode,
                subscription,
                encoder,
            });
        }
        let (stop, stopped) = channel::bounded(1);
        let kept = Arc::clone(&inbox);
        let listener = std::thread::Builder::new()
            .name("ros-commands".to_owned())
            .spawn(move || listen(ears, &kept, &stopped))
            .map_err(|it| RosError::Thread { reason: it })?;
        Ok(Self { inbox, stop, listener: Some(listener), _node: Arc::clone(node) })
    }
}

impl Source for RosSource {
    fn name(&self) -> &'static str {
        "ros"
    }

    fn drain(&mut self, _seen: &Snapshot) -> Vec<Command> {
        lock(&self.inbox).drain()
    }

    fn has_heard(&self) -> bool {
        0 < lock(&self.inbox).counters().n_received
    }

    fn counters(&self) -> SourceCounters {
        lock(&self.inbox).counters()
    }
}

impl Drop for RosSource {
    fn drop(&mut self) {
        self.stop.close();
        if let Some(listener) = self.listener.take() {
            // A listener that panicked has nothing left to stop.
            drop(listener.join());
        }
    }
}

/// The clock of another simulator, for a run that follows it.
pub struct RosClock {
    time_ns: Arc<AtomicU64>,
    stop: channel::Sender<()>,
    listener: Option<JoinHandle<()>>,
    _node: Arc<RosNode>,
}

impl RosClock {
    /// Listens to the clock of this name from now on.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn new(node: &Arc<RosNode>, name: &str) -> Result<Self, RosError> {
        // Only the last one matters, and any publisher will do.
        let qos = Qos { is_reliable: false, ..Qos::reliable(1) };
        let topic = Topic::input::<Clock>(name, qos);
        let subscription = node.subscription::<Clock>(&topic)?;
        let time_ns = Arc::new(AtomicU64::new(0));
        let (stop, stopped) = channel::bounded(1);
        let heard = Arc::clone(&time_ns);
        let listener = std::thread::Builder::new()
            .name("ros-clock".to_owned())
            .spawn(move || {
                let executor = LocalExecutor::new();
                executor.spawn(hear_clock(subscription, heard)).detach();
                // The channel carries nothing: its only news is that it was closed.
                let _closed = smol::block_on(executor.run(stopped.recv()));
            })
            .map_err(|it| RosError::Thread { reason: it })?;
        Ok(Self { time_ns, stop, listener: Some(listener), _node: Arc::clone(node) })
    }

    /// Its time, as it goes on (ns).
    pub fn time_ns(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.time_ns)
    }
}

async fn hear_clock(subscription: Subscription<Clock>, heard: Arc<AtomicU64>) {
    let mut messages = std::pin::pin!(subscription.async_stream());
    while let Some(message) = messages.next().await {
        if let Ok((Clock { clock }, _)) = message
            && let Ok(seconds) = u64::try_from(clock.sec)
        {
            let time_ns = seconds * 1_000_000_000 + u64::from(clock.nanosec);
            heard.store(time_ns, Ordering::Release);
        }
    }
}

impl Source for RosClock {
    fn name(&self) -> &'static str {
        "clock"
    }

    fn drain(&mut self, _seen: &Snapshot) -> Vec<Command> {
        Vec::new()
    }

    fn has_heard(&self) -> bool {
        0 < self.time_ns.load(Ordering::Acquire)
    }

    fn counters(&self) -> SourceCounters {
        SourceCounters::default()
    }
}

impl Drop for RosClock {
    fn drop(&mut self) {
        self.stop.close();
        if let Some(listener) = self.listener.take() {
            // A listener that panicked has nothing left to stop.
            drop(listener.join());
        }
    }
}

/// One subscription and what is done with its messages.
struct SubscriptionTask {
    index: usize,
    name: String,
    recode: Recode,
    subscription: Subscription<Received>,
    encoder: Arc<Encoder>,
}

impl SubscriptionTask {
    async fn listen(self, inbox: &Mutex<Inbox>) {
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
                Ok(command) => lock(inbox).offer(self.index, command),
                Err(fault) => lock(inbox).refuse(fault),
            }
            // A flood on one topic lets the others have their turn.
            future::yield_now().await;
        }
    }
}

/// Listens to all topics until `stopped` closes.
fn listen(ears: Vec<SubscriptionTask>, inbox: &Mutex<Inbox>, stopped: &channel::Receiver<()>) {
    let executor = LocalExecutor::new();
    for ear in ears {
        executor.spawn(ear.listen(inbox)).detach();
    }
    executor.spawn(report_malformed(inbox)).detach();
    // The channel carries nothing: its only news is that it was closed.
    let _closed = smol::block_on(executor.run(stopped.recv()));
}

/// Says once a second what could not be read, if anything.
async fn report_malformed(inbox: &Mutex<Inbox>) {
    let mut n_said = 0;
    loop {
        smol::Timer::after(Duration::from_secs(1)).await;
        let (n_malformed, fault) = {
            let mut inbox = lock(inbox);
            (inbox.counters().n_malformed, inbox.take_fault())
        };
        if let Some(fault) = fault {
            let n_new = n_malformed - n_said;
            log::warn!("{n_new} messages could not be read and were left out, the last: {fault}");
            n_said = n_malformed;
        }
    }
}

/// An inbox is whole between any two calls, so a panic elsewhere does not spoil it.
fn lock(inbox: &Mutex<Inbox>) -> MutexGuard<'_, Inbox> {
    inbox.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reads one of the command types in the sender's byte order and keeps it in ours, so that all
/// behind it sees little-endian bytes only.
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
            Err(serde::de::Error::custom(format_args!("no command is a `{name}`")))
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

    /// Oracle: the other byte order's own encoding of the same message.
    #[test]
    fn both_byte_orders_arrive_as_one() {
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

    /// Oracle: the contract: what is too short, or no command, is an error and not a panic.
    #[test]
    fn nonsense_is_an_error() {
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
