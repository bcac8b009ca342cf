//! Where snapshots go.
//!
//! A sink runs on its own thread behind a bounded queue, so that a slow or dead reader never slows
//! or stops the physics. The encoding to ROS 2 messages is made once, by whichever sink asks first.

use std::{
    sync::{Arc, OnceLock},
    time::Duration,
};

pub use crate::snapshot::run::{RunStatistics, SinkCounters};
use crate::{
    command::change::Change,
    snapshot::{Snapshot, checkpoint::Checkpoint},
    wire::{
        to_ros::Encoder,
        topics::{Message, Topic},
    },
};

/// What a sink is given: a snapshot and its messages.
pub struct Packet {
    /// The system at the end of a tick.
    pub snapshot: Snapshot,
    /// How the run goes, in wall time; there when statistics are due.
    pub run: Option<RunStatistics>,
    /// All that is needed to go on, where it is due; the start's too with the first packet.
    pub checkpoints: Vec<Checkpoint>,
    /// How the world was changed since the packet before, if not by a tick.
    pub changes: Vec<Change>,
    /// Number of the packet in its run; 0 if nobody counts.
    pub number: u64,
    /// Who makes its messages, if not the one that a sink was opened with; its topics are the same, and
    /// perhaps more behind them.
    encoder: Option<Arc<Encoder>>,
    /// The messages, once someone has asked for them.
    messages: OnceLock<Vec<Message>>,
}

impl Packet {
    /// A packet whose messages are not encoded yet.
    pub fn new(snapshot: Snapshot, run: Option<RunStatistics>) -> Self {
        Self {
            snapshot,
            run,
            checkpoints: Vec::new(),
            changes: Vec::new(),
            number: 0,
            encoder: None,
            messages: OnceLock::new(),
        }
    }

    /// The same with checkpoints.
    pub fn with_checkpoints(self, checkpoints: Vec<Checkpoint>) -> Self {
        Self { checkpoints, ..self }
    }

    /// The same after changes of the world.
    pub fn with_changes(self, changes: Vec<Change>) -> Self {
        Self { changes, ..self }
    }

    /// True if nothing can be told without it of what comes after.
    pub fn is_required(&self) -> bool {
        !self.changes.is_empty() || !self.checkpoints.is_empty()
    }

    /// The same packet with a number.
    pub fn numbered(self, number: u64) -> Self {
        Self { number, ..self }
    }

    /// The same packet, whose messages are made by `encoder`.
    pub fn with_encoder(self, encoder: Option<Arc<Encoder>>) -> Self {
        Self { encoder, ..self }
    }

    /// Topics behind the first `n_known`, which have come later.
    pub fn topics_beyond(&self, n_known: usize) -> &[Topic] {
        self.encoder.as_ref().and_then(|it| it.topics().get(n_known..)).unwrap_or_default()
    }

    /// The messages; its own encoder or else `encoder` makes them if nobody has yet. After another
    /// scene was loaded they begin with what never changes in it.
    pub fn messages(&self, encoder: &Encoder) -> &[Message] {
        self.messages.get_or_init(|| {
            let encoder = self.encoder.as_deref().unwrap_or(encoder);
            let is_new = self.changes.iter().any(|it| matches!(it, Change::LoadScene(_)));
            let mut messages = match is_new {
                true => encoder.latched(self.snapshot.time_ns),
                false => Vec::new(),
            };
            messages.extend(encoder.encode(&self.snapshot, self.run.as_ref()));
            messages
        })
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

    /// Wall time without packets after which `idle` is called, again and again.
    fn idle_after(&self) -> Duration {
        Duration::from_secs(1)
    }

    /// Called while no packets come.
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
