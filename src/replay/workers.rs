//! Simulates segments of a recorded run in parallel.
//!
//! Several single-threaded simulations are faster than one simulation with several threads.
//! Segments are started in order and there are never more sessions than jobs, so memory does not
//! grow with the length of the recording.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use super::{
    recorded_run::{RecordedRun, ReplayError},
    segment::{Segment, SegmentResult},
};
use crate::{
    bag::source::Script,
    host::{clock::Stopwatch, job_queue::run_jobs, progress_bar::Progress, shutdown::Shutdown},
};

/// How to divide the processors among simulations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CpuBudget {
    /// Number of processors of the machine.
    pub n_processors: usize,
    /// Number of solver threads of each simulation; `None` for automatic.
    pub n_threads: Option<usize>,
    /// Number of parallel simulations; `None` for automatic.
    pub n_jobs: Option<usize>,
}

impl CpuBudget {
    /// The number of parallel simulations and the threads of each, for this many segments. Each
    /// simulation gets one thread unless there are fewer simulations than processors.
    pub fn jobs_and_threads(&self, n_segments: usize) -> (usize, usize) {
        let n_fitting = self.n_processors / self.n_threads.unwrap_or(1);
        let n_jobs = self.n_jobs.unwrap_or(n_fitting).clamp(1, n_segments.max(1));
        (n_jobs, self.n_threads.unwrap_or(self.n_processors / n_jobs).max(1))
    }
}

/// The data that all jobs share.
pub(super) struct Workers<'a> {
    pub(super) run: &'a RecordedRun,
    pub(super) script: Script,
    pub(super) n_jobs: usize,
    pub(super) n_threads: usize,
    pub(super) progress: &'a Progress,
    pub(super) shutdown: &'a Shutdown,
}

/// The progress of the jobs.
struct SharedProgress {
    /// Index of the first segment with a difference or an error; later segments no longer matter.
    first_failed: AtomicUsize,
    n_ticks: AtomicU64,
    stopwatch: Stopwatch,
}

impl Workers<'_> {
    /// Simulates all segments, up to the first difference.
    ///
    /// # Errors
    /// The first error, unless there is a difference before it.
    pub(super) fn simulate(&self, segments: &[Segment<'_>]) -> Result<SegmentResult, ReplayError> {
        let shared = SharedProgress {
            first_failed: AtomicUsize::new(usize::MAX),
            n_ticks: AtomicU64::new(0),
            stopwatch: Stopwatch::start(),
        };
        let queue: Vec<usize> = (0..segments.len()).collect();
        let results =
            run_jobs(self.n_jobs, &queue, |_, i| self.simulate_segment(segments, i, &shared));
        let mut all = SegmentResult {
            is_interrupted: self.shutdown.is_requested(),
            ..SegmentResult::default()
        };
        for result in results {
            all.append(result?);
            if all.first_difference.is_some() {
                break;
            }
        }
        Ok(all)
    }

    /// Simulates segment `i`; `None` if it no longer matters.
    fn simulate_segment(
        &self,
        segments: &[Segment<'_>],
        i: usize,
        shared: &SharedProgress,
    ) -> Option<Result<SegmentResult, ReplayError>> {
        let is_over =
            || self.shutdown.is_requested() || shared.first_failed.load(Ordering::SeqCst) < i;
        if is_over() {
            return None;
        }
        let first = segments[0].start.tick();
        let interrupts = || {
            self.report_progress(first, shared);
            is_over()
        };
        let result =
            segments[i].simulate(self.run, self.script.clone(), self.n_threads, &interrupts);
        if result.as_ref().map_or(true, |it| it.first_difference.is_some()) {
            shared.first_failed.fetch_min(i, Ordering::SeqCst);
        }
        Some(result)
    }

    /// Reports the progress of all segments together. It is called once for each tick of a segment.
    fn report_progress(&self, first: u64, shared: &SharedProgress) {
        let n_ticks = shared.n_ticks.fetch_add(1, Ordering::Relaxed);
        let tick_ns = self.run.scene.time.tick_ns;
        let simulated_s = super::seconds(n_ticks * tick_ns);
        let real_time_factor = simulated_s / shared.stopwatch.total_s().max(1e-9);
        self.progress.share((first + n_ticks) * tick_ns, real_time_factor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: assignments worked out by hand.
    #[test]
    fn processors_are_divided_among_segments_first() {
        let budget = |n_threads, n_jobs| CpuBudget { n_processors: 8, n_threads, n_jobs };
        assert_eq!(budget(None, None).jobs_and_threads(20), (8, 1));
        assert_eq!(
            budget(None, None).jobs_and_threads(3),
            (3, 2),
            "remaining processors become threads"
        );
        assert_eq!(budget(None, None).jobs_and_threads(1), (1, 8));
        assert_eq!(budget(Some(2), None).jobs_and_threads(20), (4, 2));
        assert_eq!(budget(Some(9), None).jobs_and_threads(20), (1, 9), "the requested number");
        assert_eq!(budget(None, Some(1)).jobs_and_threads(20), (1, 8));
        assert_eq!(budget(Some(3), Some(5)).jobs_and_threads(20), (5, 3));
        assert_eq!(budget(None, Some(100)).jobs_and_threads(20), (20, 1));
    }
}
