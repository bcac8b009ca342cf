//! Where commands come from.
//!
//! A source never waits and never slows a tick: what arrives while a tick runs is kept for the
//! next one, in the order of arrival.

use crate::{command::Command, snapshot::Snapshot};

/// A place where commands come from.
pub trait Source: Send {
    /// Name for counters and messages.
    fn name(&self) -> &'static str;

    /// Everything that came since the last call, oldest first. `seen` is the system at the end of
    /// the last tick, for sources that decide by it. Never waits.
    fn drain(&mut self, seen: &Snapshot) -> Vec<Command>;

    /// True once a first command was there, drained or not.
    fn has_heard(&self) -> bool;

    /// What became of the messages so far.
    fn counters(&self) -> SourceCounters;
}

/// What became of the messages of a source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SourceCounters {
    /// Commands that arrived and could be read.
    pub n_received: u64,
    /// Commands that newer ones pushed out before a tick could take them.
    pub n_dropped: u64,
    /// Messages that could not be read.
    pub n_malformed: u64,
}
