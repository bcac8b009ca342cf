//! Commands from ROS 2 topics: subscriptions that fill the inbox on a thread of their own.

use std::{
    fmt,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread::JoinHandle,
    time::Duration,
};

use ros2_client::Subscription;
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};
use smol::{LocalExecutor, channel, future, stream::StreamExt};

use super::{Source, SourceCounters, inbox::Inbox};
use crate::{
    command::Command,
    sinks::ros::{RosError, RosNode},
    snapshot::Snapshot,
    wire::topics::Topic,
};

/// Longest message that is read; every command is far shorter.
const BYTES_MAX: usize = 64 * 1024;

/// Reads a message that came on the topic with this index: a body of little-endian CDR.
pub type Decoder = Arc<
    dyn Fn(usize, &[u8]) -> Result<Command, Box<dyn std::error::Error + Send + Sync>> + Send + Sync,
>;

/// A message's body as it came.
pub struct Received(pub Vec<u8>);

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
    pub fn new(node: &Arc<RosNode>, topics: &[Topic], decode: Decoder) -> Result<Self, RosError> {
        let inbox = Arc::new(Mutex::new(Inbox::new(topics.len())));
        let mut ears = Vec::new();
        for (index, topic) in topics.iter().enumerate().filter(|(_, it)| it.is_input) {
            let subscription = node.subscription::<Received>(topic)?;
            let decode = Arc::clone(&decode);
            ears.push(Ear { index, name: topic.name.clone(), subscription, decode });
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

/// One subscription and what is done with its messages.
struct Ear {
    index: usize,
    name: String,
    subscription: Subscription<Received>,
    decode: Decoder,
}

impl Ear {
    async fn listen(self, inbox: &Mutex<Inbox>) {
        let mut messages = std::pin::pin!(self.subscription.async_stream());
        while let Some(message) = messages.next().await {
            let command = message
                .map_err(Into::into)
                .and_then(|(Received(cdr), _)| (self.decode)(self.index, &cdr));
            match command {
                Ok(command) => lock(inbox).offer(self.index, command),
                Err(error) => lock(inbox).refuse(format!("`{}`: {error}", self.name)),
            }
            // A flood on one topic lets the others have their turn.
            future::yield_now().await;
        }
    }
}

/// Listens to all topics until `stopped` closes.
fn listen(ears: Vec<Ear>, inbox: &Mutex<Inbox>, stopped: &channel::Receiver<()>) {
    let executor = LocalExecutor::new();
    for ear in ears {
        executor.spawn(ear.listen(inbox)).detach();
    }
    executor.spawn(complain(inbox)).detach();
    // The channel carries nothing: its only news is that it was closed.
    drop(smol::block_on(executor.run(stopped.recv())));
}

/// Says once a second what could not be read, if anything.
async fn complain(inbox: &Mutex<Inbox>) {
    let mut n_said = 0;
    loop {
        smol::Timer::after(Duration::from_secs(1)).await;
        let (n_malformed, fault) = {
            let mut inbox = lock(inbox);
            (inbox.counters().n_malformed, inbox.take_fault())
        };
        if let Some(fault) = fault {
            let n_new = n_malformed - n_said;
            log::warn!("{n_new} messages could not be read and were left out, the last on {fault}");
            n_said = n_malformed;
        }
    }
}

/// An inbox is whole between any two calls, so a panic elsewhere does not spoil it.
fn lock(inbox: &Mutex<Inbox>) -> MutexGuard<'_, Inbox> {
    inbox.lock().unwrap_or_else(PoisonError::into_inner)
}

/// CDR does not say where it ends: single bytes are read until there are none.
impl<'de> Deserialize<'de> for Received {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ToTheEnd;
        impl<'de> Visitor<'de> for ToTheEnd {
            type Value = Received;

            fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
                out.write_str("the bytes of a message")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut bytes: A) -> Result<Received, A::Error> {
                let mut body = Vec::new();
                while let Ok(Some(byte)) = bytes.next_element() {
                    body.push(byte);
                }
                Ok(Received(body))
            }
        }
        deserializer.deserialize_tuple(BYTES_MAX, ToTheEnd)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the identity, through the very deserializer that the middleware uses.
    #[test]
    fn a_body_is_read_as_it_is() {
        for length in [0, 1, 9, 1000] {
            let bytes = vec![7_u8; length];
            let (received, _) =
                cdr_encoding::from_bytes::<Received, byteorder::LittleEndian>(&bytes).unwrap();
            assert_eq!(received.0, bytes);
        }
    }
}
