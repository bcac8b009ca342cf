//! Where snapshots go.
//!
//! A sink runs on its own thread behind a bounded queue, so that a slow or dead reader never slows
//! or stops the physics. The encoding to ROS 2 messages is made once, by whichever sink asks first.

#[cfg(feature = "bag")]
pub mod bag; // recordings while they are made
pub mod fanout; // one thread and one queue per sink
pub mod reach;
#[cfg(feature = "ros")]
pub mod ros;
#[cfg(feature = "shm")]
pub mod shm;

use std::sync::OnceLock;

pub use crate::snapshot::run::{RunStatistics, SinkCounters};
use crate::{
    snapshot::{Snapshot, checkpoint::Checkpoint},
    wire::{to_ros::Encoder, topics::Message},
};

/// What a sink is given: a snapshot and its messages.
pub struct Packet {
    /// The system at the end of a tick.
    pub snapshot: Snapshot,
    /// How the run goes, in wall time; there when statistics are due.
    pub run: Option<RunStatistics>,
    /// All that is needed to go on, where it is due; the start's too with the first packet.
    pub checkpoints: Vec<Checkpoint>,
    /// The messages, once someone has asked for them.
    messages: OnceLock<Vec<Message>>,
}

impl Packet {
    /// A packet whose messages are not encoded yet.
    pub fn new(snapshot: Snapshot, run: Option<RunStatistics>) -> Self {
        Self { snapshot, run, checkpoints: Vec::new(), messages: OnceLock::new() }
    }

    /// The same with checkpoints.
    pub fn with_checkpoints(self, checkpoints: Vec<Checkpoint>) -> Self {
        Self { checkpoints, ..self }
    }

    /// The messages; `encoder` makes them if nobody has yet.
    pub fn messages(&self, encoder: &Encoder) -> &[Message] {
        self.messages.get_or_init(|| encoder.encode(&self.snapshot, self.run.as_ref()))
    }
}

/// A place where snapshots go. Runs on a thread of its own.
pub trait Sink: Send {
    /// Name for counters and messages.
    fn name(&self) -> &'static str;

    /// Takes one packet. An error is counted and shown; the run goes on.
    ///
    /// # Errors
    /// Whatever the place says; the text names place, value, limit and remedy.
    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;

    /// Called about once a second of wall time while no packets come.
    ///
    /// # Errors
    /// As for `write`.
    fn idle(&mut self) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        Ok(())
    }

    /// Completes what was written. Called once, after the last packet.
    ///
    /// # Errors
    /// As for `write`.
    fn close(&mut self) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;
}
