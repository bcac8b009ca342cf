//! Segments of a recorded run, simulated again from one checkpoint to the next.
//!
//! At the end of a segment, the whole simulated state is compared with the checkpoint at which the
//! next segment starts. Verified segments therefore prove the whole run from the start of the first
//! one.

use std::{borrow::Cow, mem};

use super::recorded_run::{RecordedRun, ReplayError};
use crate::{
    bag::{
        recording::{CheckpointLocation, RecordedChange},
        source::Script,
    },
    session::Session,
};

/// Segments shorter than this (ticks) are joined with the one before, because starting a segment
/// costs as much as a tick.
const N_TICKS_MIN: u64 = 100;

/// A difference from the recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The tick after which the states differ.
    pub tick: u64,
    /// The kind of difference.
    pub kind: DifferenceKind,
}

/// The kind of difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DifferenceKind {
    /// The digest of the state.
    Digest {
        /// The recorded digest.
        recorded: u64,
        /// The simulated digest.
        simulated: u64,
    },
    /// This part of the checkpoint differs, although the digests are equal.
    Checkpoint(&'static str),
}

/// The start of a segment.
#[derive(Clone)]
pub(super) enum Start<'a> {
    /// A recorded checkpoint.
    Recorded(&'a CheckpointLocation),
    /// A state saved after this tick in this process.
    Saved(u64, Cow<'a, [u8]>),
}

impl Start<'_> {
    pub(super) fn tick(&self) -> u64 {
        match self {
            Self::Recorded(checkpoint) => checkpoint.tick,
            Self::Saved(tick, _) => *tick,
        }
    }
}

/// A segment of a recorded run.
pub(super) struct Segment<'a> {
    pub(super) start: Start<'a>,
    /// The last tick.
    pub(super) end: u64,
    is_first: bool,
    is_last: bool,
}

/// Splits a recorded run at its checkpoints, from `start` to the tick `last`.
pub(super) fn split<'a>(
    start: Start<'a>,
    last: u64,
    checkpoints: &'a [CheckpointLocation],
) -> Vec<Segment<'a>> {
    let mut starts = vec![start];
    for checkpoint in checkpoints {
        let segment_start = starts.last().map_or(0, Start::tick);
        if segment_start + N_TICKS_MIN <= checkpoint.tick && checkpoint.tick + N_TICKS_MIN <= last {
            starts.push(Start::Recorded(checkpoint));
        }
    }
    let ends: Vec<u64> = starts[1..].iter().map(Start::tick).chain([last]).collect();
    let n = starts.len();
    let segments = starts.into_iter().zip(ends).enumerate();
    segments
        .map(|(i, (start, end))| Segment { start, end, is_first: i == 0, is_last: i + 1 == n })
        .collect()
}

/// The result of simulating one or more segments.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct SegmentResult {
    /// Number of simulated ticks.
    pub(super) n_ticks: u64,
    /// Number of compared digests.
    pub(super) n_compared: u64,
    /// Number of compared checkpoints.
    pub(super) n_checkpoints: u64,
    pub(super) first_difference: Option<Difference>,
    pub(super) remarks: Vec<String>,
    /// True if it was interrupted before its end.
    pub(super) is_interrupted: bool,
}

impl SegmentResult {
    /// Adds the result of the next segment.
    pub(super) fn append(&mut self, next: Self) {
        self.n_ticks += next.n_ticks;
        self.n_compared += next.n_compared;
        self.n_checkpoints += next.n_checkpoints;
        self.first_difference = self.first_difference.or(next.first_difference);
        self.remarks.extend(next.remarks);
        self.is_interrupted |= next.is_interrupted;
    }

    fn may_continue(&self) -> bool {
        self.first_difference.is_none() && !self.is_interrupted
    }

    /// Compares the state with its recorded digest, if there is one.
    fn compare(&mut self, recorded: Option<u64>, session: &Session) {
        let (Some(recorded), simulated) = (recorded, session.digest()) else { return };
        self.n_compared += 1;
        if recorded != simulated {
            let tick = session.run_tick().0;
            let kind = DifferenceKind::Digest { recorded, simulated };
            self.first_difference = self.first_difference.or(Some(Difference { tick, kind }));
        }
    }

    /// Compares the state after a change between two ticks.
    fn compare_after(&mut self, change: &RecordedChange, session: &Session) {
        let was_equal = self.first_difference.is_none();
        self.compare(change.digest, session);
        if was_equal && self.first_difference.is_some() {
            let RecordedChange { tick, what, .. } = change;
            self.remarks.push(format!("the difference follows a change after tick {tick}: {what}"));
        }
    }

    /// Compares the whole state with a checkpoint.
    fn compare_all(&mut self, checkpoint: &CheckpointLocation, session: &Session) {
        let tick = checkpoint.tick;
        let differs = checkpoint.read().map_err(|it| it.to_string());
        let differs =
            differs.and_then(|it| session.differs_from(&it).map_err(|error| error.to_string()));
        match differs {
            Ok(differs) => {
                self.n_checkpoints += 1;
                let difference =
                    differs.map(|it| Difference { tick, kind: DifferenceKind::Checkpoint(it) });
                self.first_difference = self.first_difference.or(difference);
            }
            Err(error) => {
                self.remarks
                    .push(format!("checkpoint at tick {tick} could not be compared: {error}"));
            }
        }
    }
}

impl Segment<'_> {
    /// Simulates the segment. `interrupts` is called before every tick; it returns true to stop.
    pub(super) fn simulate(
        &self,
        run: &RecordedRun,
        mut script: Script,
        n_threads: usize,
        interrupts: &dyn Fn() -> bool,
    ) -> Result<SegmentResult, ReplayError> {
        let mut session = match &self.start {
            Start::Recorded(checkpoint) => run.session_at(checkpoint, &run.scene, n_threads)?,
            Start::Saved(tick, bytes) => run.resume(*tick, bytes, &run.scene, n_threads)?,
        };
        let mut result = SegmentResult::default();
        // The segment before compares the state at which this one starts.
        let mut is_compared = !self.is_first;
        loop {
            let tick = session.run_tick().0;
            if !mem::take(&mut is_compared) {
                result.compare(run.history.digest_of(tick), &session);
                let checkpoint = run.history.checkpoint_at(tick).filter(|_| !self.starts_at(tick));
                if let Some(checkpoint) = checkpoint.filter(|_| result.may_continue()) {
                    result.compare_all(checkpoint, &session);
                }
            }
            result.is_interrupted = interrupts();
            if !result.may_continue() || (tick == self.end && !self.is_last) {
                return Ok(result);
            }
            for it in run.history.changes_after(tick) {
                run.change(&mut session, it)?;
                result.compare_after(it, &session);
            }
            if !result.may_continue() || self.end <= tick {
                return Ok(result);
            }
            session.tick(&script.commands_in(tick + 1))?;
            result.n_ticks += 1;
        }
    }

    /// True if the segment starts at the recorded checkpoint of this tick.
    fn starts_at(&self, tick: u64) -> bool {
        matches!(&self.start, Start::Recorded(checkpoint) if checkpoint.tick == tick)
    }
}
