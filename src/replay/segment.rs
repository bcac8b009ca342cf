//! A part of a recording, simulated again from one checkpoint to the next.
//!
//! At its end the whole simulated state is compared with the checkpoint from which the next part
//! begins, so parts that are proved one by one prove the run from the start of the first.

use std::{borrow::Cow, mem};

use super::recorded_run::{RecordedRun, ReplayError};
use crate::{
    bag::{
        recording::{Alteration, Place},
        source::Script,
    },
    session::Session,
};

/// Shorter parts are simulated with the one before (ticks): to begin one costs as much as a tick.
const SHORTEST: u64 = 100;

/// Something that did not come out as recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The tick.
    pub tick: u64,
    /// What differs.
    pub kind: Kind,
}

/// What differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The digest of the state.
    Digest {
        /// In the recording.
        recorded: u64,
        /// Found.
        simulated: u64,
    },
    /// This part of the checkpoint, although the digests are equal.
    Checkpoint(&'static str),
}

/// Where a part begins.
#[derive(Clone)]
pub(super) enum Start<'a> {
    /// At a recorded checkpoint.
    Recorded(&'a Place),
    /// At a state that was made now, after this tick.
    Made(u64, Cow<'a, [u8]>),
}

impl Start<'_> {
    pub(super) fn tick(&self) -> u64 {
        match self {
            Self::Recorded(place) => place.tick,
            Self::Made(tick, _) => *tick,
        }
    }
}

/// A part of a recording.
pub(super) struct Segment<'a> {
    pub(super) start: Start<'a>,
    /// Its last tick.
    pub(super) end: u64,
    is_first: bool,
    is_last: bool,
}

/// Cuts a recording, from `start` to the tick `last`, at its checkpoints.
pub(super) fn cut<'a>(start: Start<'a>, last: u64, checkpoints: &'a [Place]) -> Vec<Segment<'a>> {
    let mut starts = vec![start];
    for place in checkpoints {
        let begun = starts.last().map_or(0, Start::tick);
        if begun + SHORTEST <= place.tick && place.tick + SHORTEST <= last {
            starts.push(Start::Recorded(place));
        }
    }
    let ends: Vec<u64> = starts[1..].iter().map(Start::tick).chain([last]).collect();
    let n = starts.len();
    let parts = starts.into_iter().zip(ends).enumerate();
    parts
        .map(|(i, (start, end))| Segment { start, end, is_first: i == 0, is_last: i + 1 == n })
        .collect()
}

/// What was found in parts of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Found {
    /// Ticks that were simulated.
    pub(super) n_ticks: u64,
    /// Digests that were compared.
    pub(super) n_compared: u64,
    /// Checkpoints that were compared.
    pub(super) n_checkpoints: u64,
    pub(super) first_difference: Option<Difference>,
    pub(super) remarks: Vec<String>,
    /// True if it was left before its end.
    pub(super) is_left: bool,
}

impl Found {
    /// Adds what was found in the part behind.
    pub(super) fn append(&mut self, behind: Self) {
        self.n_ticks += behind.n_ticks;
        self.n_compared += behind.n_compared;
        self.n_checkpoints += behind.n_checkpoints;
        self.first_difference = self.first_difference.or(behind.first_difference);
        self.remarks.extend(behind.remarks);
        self.is_left |= behind.is_left;
    }

    fn goes_on(&self) -> bool {
        self.first_difference.is_none() && !self.is_left
    }

    /// Compares the state with what is recorded of it, if anything is.
    fn compare(&mut self, recorded: Option<u64>, session: &Session) {
        let (Some(recorded), simulated) = (recorded, session.digest()) else { return };
        self.n_compared += 1;
        if recorded != simulated {
            let tick = session.run_tick().0;
            let kind = Kind::Digest { recorded, simulated };
            self.first_difference = self.first_difference.or(Some(Difference { tick, kind }));
        }
    }

    /// The same after a change between two ticks.
    fn compare_after(&mut self, change: &Alteration, session: &Session) {
        let was_equal = self.first_difference.is_none();
        self.compare(change.digest, session);
        if was_equal && self.first_difference.is_some() {
            let Alteration { tick, what, .. } = change;
            self.remarks
                .push(format!("the difference is behind a change after tick {tick}: {what}"));
        }
    }

    /// Compares everything with a checkpoint.
    fn compare_all(&mut self, place: &Place, session: &Session) {
        let tick = place.tick;
        let differs = place.read().map_err(|it| it.to_string());
        let differs =
            differs.and_then(|it| session.differs_from(&it).map_err(|fault| fault.to_string()));
        match differs {
            Ok(differs) => {
                self.n_checkpoints += 1;
                let difference = differs.map(|it| Difference { tick, kind: Kind::Checkpoint(it) });
                self.first_difference = self.first_difference.or(difference);
            }
            Err(fault) => {
                self.remarks.push(format!("checkpoint at tick {tick} not compared: {fault}"));
            }
        }
    }
}

impl Segment<'_> {
    /// Simulates the part; `leaves` is asked before every tick whether to leave it.
    pub(super) fn simulate(
        &self,
        again: &RecordedRun,
        mut script: Script,
        n_threads: usize,
        leaves: &dyn Fn() -> bool,
    ) -> Result<Found, ReplayError> {
        let mut session = match &self.start {
            Start::Recorded(place) => again.session_at(place, &again.scene, n_threads)?,
            Start::Made(tick, bytes) => again.resume(*tick, bytes, &again.scene, n_threads)?,
        };
        let mut found = Found::default();
        // The part before ends where this one begins, and says what there is to say.
        let mut is_told = !self.is_first;
        loop {
            let tick = session.run_tick().0;
            if !mem::take(&mut is_told) {
                found.compare(again.course.digest_of(tick), &session);
                let place = again.course.checkpoint_at(tick).filter(|_| !self.is_from(tick));
                if let Some(place) = place.filter(|_| found.goes_on()) {
                    found.compare_all(place, &session);
                }
            }
            found.is_left = leaves();
            if !found.goes_on() || (tick == self.end && !self.is_last) {
                return Ok(found);
            }
            for it in again.course.changes_after(tick) {
                again.change(&mut session, it)?;
                found.compare_after(it, &session);
            }
            if !found.goes_on() || self.end <= tick {
                return Ok(found);
            }
            session.tick(&script.of(tick + 1))?;
            found.n_ticks += 1;
        }
    }

    /// True if the part began at the recorded checkpoint of this tick.
    fn is_from(&self, tick: u64) -> bool {
        matches!(&self.start, Start::Recorded(place) if place.tick == tick)
    }
}
