//! Where snapshots go.
//!
//! A sink runs on its own thread behind a bounded queue, so that a slow or dead reader never slows
//! or stops the physics. The encoding to ROS 2 messages is made once, by whichever sink asks first.

pub mod reach;
#[cfg(feature = "ros")]
pub mod ros;
#[cfg(feature = "shm")]
pub mod shm;

use std::sync::OnceLock;

use crate::{snapshot::Snapshot, wire::topics::Message};

/// What a sink is given: a snapshot and its messages.
pub struct Packet {
    /// The system at the end of a tick.
    pub snapshot: Snapshot,
    /// How the run goes, in wall time; there when statistics are due.
    pub run: Option<RunStatistics>,
    /// The messages, once someone has asked for them.
    messages: OnceLock<Vec<Message>>,
}

impl Packet {
    /// A packet whose messages are not encoded yet.
    pub fn new(snapshot: Snapshot, run: Option<RunStatistics>) -> Self {
        Self { snapshot, run, messages: OnceLock::new() }
    }

    /// The messages; `encode` makes them if nobody has yet.
    pub fn messages(&self, encode: impl FnOnce(&Self) -> Vec<Message>) -> &[Message] {
        self.messages.get_or_init(|| encode(self))
    }
}

/// How a run goes, seen from outside.
#[derive(Clone, Debug, Default)]
pub struct RunStatistics {
    /// Wall time since the first tick [s].
    pub wall_time_s: f64,
    /// Simulated over wall time, over the last second of wall time.
    pub real_time_factor: f64,
    /// Simulated over wall time, since the first tick.
    pub real_time_factor_mean: f64,
    /// Length of a substep [s].
    pub substep_s: f64,
    /// Seed of the scene.
    pub seed: u64,
    /// What the controller is doing, if the built-in one runs.
    pub phase: String,
    /// Per sink: name, packets written, packets dropped, errors.
    pub sinks: Vec<SinkCounters>,
}

/// What became of the packets given to a sink.
#[derive(Clone, Debug, Default)]
pub struct SinkCounters {
    /// Name of the sink.
    pub name: &'static str,
    /// Packets it wrote.
    pub n_written: u64,
    /// Packets its queue dropped.
    pub n_dropped: u64,
    /// Packets it failed on.
    pub n_failed: u64,
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

    /// Completes what was written. Called once, after the last packet.
    ///
    /// # Errors
    /// As for `write`.
    fn close(&mut self) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;
}
