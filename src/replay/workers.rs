//! Parts of a recording, simulated side by side.
//!
//! Several simulations on a thread each do more than one simulation on a team of threads. Parts are
//! begun in their order and there are never more sessions than jobs, so memory does not grow with the
//! recording.

use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicU64, AtomicUsize, Ordering},
};

use super::{
    recorded_run::{RecordedRun, ReplayError},
    segment::{Found, Segment},
};
use crate::{
    bag::source::Script,
    host::{clock::Stopwatch, progress_bar::Progress, shutdown::Shutdown},
};

/// How the machine is shared out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CpuBudget {
    /// Processors of the machine.
    pub n_processors: usize,
    /// Solver threads of each simulation, if someone wants to say.
    pub n_threads: Option<usize>,
    /// Simulations at a time, if someone wants to say.
    pub n_jobs: Option<usize>,
}

impl CpuBudget {
    /// Simulations at a time, and threads of each, for so many parts. Each gets one thread unless
    /// there are fewer simulations than processors.
    pub fn shared_out(&self, n_parts: usize) -> (usize, usize) {
        let fitting = self.n_processors / self.n_threads.unwrap_or(1);
        let n_jobs = self.n_jobs.unwrap_or(fitting).clamp(1, n_parts.max(1));
        (n_jobs, self.n_threads.unwrap_or(self.n_processors / n_jobs).max(1))
    }
}

/// All that the jobs share.
pub(super) struct Workers<'a> {
    pub(super) again: &'a RecordedRun,
    pub(super) script: Script,
    pub(super) n_jobs: usize,
    pub(super) n_threads: usize,
    pub(super) progress: &'a Progress,
    pub(super) shutdown: &'a Shutdown,
}

/// What is known while they work.
struct Board {
    /// The next part that nobody has taken.
    next: AtomicUsize,
    /// The first part in which something differs or fails: those behind do not matter any more.
    decided: AtomicUsize,
    n_ticks: AtomicU64,
    stopwatch: Stopwatch,
    results: Mutex<Vec<(usize, Result<Found, ReplayError>)>>,
}

impl Workers<'_> {
    /// Simulates all parts, up to the first difference.
    ///
    /// # Errors
    /// The first of the failures, unless something differs before it.
    pub(super) fn simulate(&self, parts: &[Segment<'_>]) -> Result<Found, ReplayError> {
        let board = Board {
            next: AtomicUsize::new(0),
            decided: AtomicUsize::new(usize::MAX),
            n_ticks: AtomicU64::new(0),
            stopwatch: Stopwatch::start(),
            results: Mutex::default(),
        };
        std::thread::scope(|scope| {
            for _ in 0..self.n_jobs {
                scope.spawn(|| self.work(parts, &board));
            }
        });
        let mut results = board.results.into_inner().unwrap_or_else(PoisonError::into_inner);
        results.sort_by_key(|(i, _)| *i);
        let mut all = Found { is_left: self.shutdown.is_requested(), ..Found::default() };
        for (_, found) in results {
            all.append(found?);
            if all.first_difference.is_some() {
                break;
            }
        }
        Ok(all)
    }

    fn work(&self, parts: &[Segment<'_>], board: &Board) {
        loop {
            let i = board.next.fetch_add(1, Ordering::SeqCst);
            let is_over =
                || self.shutdown.is_requested() || board.decided.load(Ordering::SeqCst) < i;
            let Some(part) = parts.get(i).filter(|_| !is_over()) else { return };
            let first = parts[0].start.tick();
            let leaves = || {
                self.tell(first, board);
                is_over()
            };
            let found = part.simulate(self.again, self.script.clone(), self.n_threads, &leaves);
            if found.as_ref().map_or(true, |it| it.first_difference.is_some()) {
                board.decided.fetch_min(i, Ordering::SeqCst);
            }
            board.results.lock().unwrap_or_else(PoisonError::into_inner).push((i, found));
        }
    }

    /// Tells how far all parts together have come, once for each tick and part.
    fn tell(&self, first: u64, board: &Board) {
        let n_ticks = board.n_ticks.fetch_add(1, Ordering::Relaxed);
        let tick_ns = self.again.scene.time.tick_ns;
        let simulated_s = super::seconds(n_ticks * tick_ns);
        let real_time_factor = simulated_s / board.stopwatch.total_s().max(1e-9);
        self.progress.share((first + n_ticks) * tick_ns, real_time_factor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: what a person would do with so many processors.
    #[test]
    fn processors_are_shared_out_among_parts_first() {
        let hands = |n_threads, n_jobs| CpuBudget { n_processors: 8, n_threads, n_jobs };
        assert_eq!(hands(None, None).shared_out(20), (8, 1));
        assert_eq!(hands(None, None).shared_out(3), (3, 2), "what is left goes into each");
        assert_eq!(hands(None, None).shared_out(1), (1, 8));
        assert_eq!(hands(Some(2), None).shared_out(20), (4, 2));
        assert_eq!(hands(Some(9), None).shared_out(20), (1, 9), "as many as were asked for");
        assert_eq!(hands(None, Some(1)).shared_out(20), (1, 8));
        assert_eq!(hands(Some(3), Some(5)).shared_out(20), (5, 3));
        assert_eq!(hands(None, Some(100)).shared_out(20), (20, 1));
    }
}
