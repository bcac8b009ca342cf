//! The interface of sources, which provide commands.
//!
//! A source never blocks and never slows a tick: commands that arrive during a tick are kept for
//! the next one, in the order of arrival.

use crate::{command::Command, snapshot::Snapshot};

/// A provider of commands.
pub trait Source: Send {
    /// Name for counters and messages.
    fn name(&self) -> &'static str;

    /// Takes all commands that arrived since the last call, oldest first. `snapshot` is the system
    /// at the end of the last tick, for sources whose commands depend on it. Never blocks.
    fn drain(&mut self, snapshot: &Snapshot) -> Vec<Command>;

    /// True once a command has arrived, drained or not.
    fn has_received(&self) -> bool;

    /// The counters so far.
    fn counters(&self) -> SourceCounters;
}

/// Counters of a source's messages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SourceCounters {
    /// Commands that were received and decoded.
    pub n_received: u64,
    /// Commands that were displaced by newer ones before a tick took them.
    pub n_dropped: u64,
    /// Messages that could not be decoded.
    pub n_malformed: u64,
}
