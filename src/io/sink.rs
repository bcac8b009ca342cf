//! The interface of sinks, which receive the snapshots of a run.
//!
//! A sink runs on its own thread behind a bounded queue, so that a slow or dead reader never slows
//! or stops the physics. Snapshots are encoded as ROS 2 messages once, for the first sink that
//! needs them.

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

/// The input of a sink: a snapshot and its messages.
pub struct Packet {
    /// The system at the end of a tick.
    pub snapshot: Snapshot,
    /// Wall-clock statistics of the run, when they are due.
    pub run: Option<RunStatistics>,
    /// Checkpoints that are due; the first packet also carries the one of the start.
    pub checkpoints: Vec<Checkpoint>,
    /// Changes since the previous packet that were not made by a tick.
    pub changes: Vec<Change>,
    /// Sequence number in the run; 0 if unnumbered.
    pub number: u64,
    /// Encoder of the messages, if it is not the one that the sinks were opened with. It has the
    /// same topics, and possibly more after them.
    encoder: Option<Arc<Encoder>>,
    /// The encoded messages, once a sink has needed them.
    messages: OnceLock<Vec<Message>>,
}

impl Packet {
    /// Creates a packet without encoding its messages.
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

    /// Adds checkpoints.
    pub fn with_checkpoints(self, checkpoints: Vec<Checkpoint>) -> Self {
        Self { checkpoints, ..self }
    }

    /// Adds changes.
    pub fn with_changes(self, changes: Vec<Change>) -> Self {
        Self { changes, ..self }
    }

    /// True if later packets depend on this one, so it must not be dropped.
    pub fn is_required(&self) -> bool {
        !self.changes.is_empty() || !self.checkpoints.is_empty()
    }

    /// Sets the sequence number.
    pub fn numbered(self, number: u64) -> Self {
        Self { number, ..self }
    }

    /// Sets the encoder of the messages.
    pub fn with_encoder(self, encoder: Option<Arc<Encoder>>) -> Self {
        Self { encoder, ..self }
    }

    /// The topics after the first `n_known`, which were added during the run.
    pub fn topics_beyond(&self, n_known: usize) -> &[Topic] {
        self.encoder.as_ref().and_then(|it| it.topics().get(n_known..)).unwrap_or_default()
    }

    /// The messages. The first call encodes them, with the packet's own encoder or else with
    /// `encoder`. If a scene was loaded, they begin with the constant messages of the new scene.
    pub fn messages(&self, encoder: &Encoder) -> &[Message] {
        self.messages.get_or_init(|| {
            let encoder = self.encoder.as_deref().unwrap_or(encoder);
            let has_new_scene = self.changes.iter().any(|it| matches!(it, Change::LoadScene(_)));
            let mut messages = match has_new_scene {
                true => encoder.latched(self.snapshot.time_ns),
                false => Vec::new(),
            };
            messages.extend(encoder.encode(&self.snapshot, self.run.as_ref()));
            messages
        })
    }
}

/// A receiver of snapshots. Runs on its own thread.
pub trait Sink: Send {
    /// Name for counters and messages.
    fn name(&self) -> &'static str;

    /// Writes one packet. An error is counted and shown; the run continues.
    ///
    /// # Errors
    /// Errors of the receiver; the text names place, value, limit and remedy.
    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;

    /// Wall-clock time without packets after which `idle` is called, repeatedly.
    fn idle_after(&self) -> Duration {
        Duration::from_secs(1)
    }

    /// Called while no packets arrive.
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
