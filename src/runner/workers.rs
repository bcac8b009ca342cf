//! Runs cases in parallel. Each case runs on a single thread with its own pool, so that the results
//! do not depend on how many run at the same time.

use super::{
    case::{self, CaseEnd},
    folder::Folder,
};
use crate::runner::{experiment::LoadedExperiment, progress::ProgressDisplay};
use crate::{
    base::parallel,
    host::{job_queue::run_jobs, shutdown::Shutdown},
};

/// A case to run.
pub(super) struct Job<'a> {
    /// Its experiment.
    pub(super) loaded: &'a LoadedExperiment<'a>,
    /// Its folder, if any.
    pub(super) folder: Option<&'a Folder>,
    /// Its name.
    pub(super) case: &'a str,
}

impl Job<'_> {
    /// Names of experiment and case.
    pub(super) fn title(&self) -> String {
        format!("{} {}", self.loaded.identity.experiment, self.case)
    }

    /// Expected run time (s), if known.
    pub(super) fn expected_s(&self) -> Option<f64> {
        self.loaded.plan.expected_s(self.case)
    }
}

/// Runs all jobs. Returns how each of them ended, in their order.
pub(super) fn run_all(
    jobs: &[Job<'_>],
    n_threads: usize,
    shutdown: &Shutdown,
    progress: &ProgressDisplay,
) -> Result<Vec<CaseEnd>, parallel::ThreadPoolError> {
    let n_threads = n_threads.clamp(1, jobs.len().max(1));
    let pools =
        (0..n_threads).map(|_| parallel::ThreadPool::new(1)).collect::<Result<Vec<_>, _>>()?;
    let ends = run_jobs(n_threads, &queue(jobs), |thread, i| {
        let line = progress.begin(i);
        let end = parallel::lead(&pools[thread], || case::run_case(&jobs[i], shutdown, &line));
        line.end(&end);
        Some(end)
    });
    Ok(ends)
}

/// The order in which jobs are started: the longest first; jobs of unknown length come before.
pub(super) fn queue(jobs: &[Job<'_>]) -> Vec<usize> {
    let mut queue: Vec<usize> = (0..jobs.len()).collect();
    let length = |i: usize| jobs[i].expected_s().unwrap_or(f64::INFINITY);
    queue.sort_by(|&a, &b| length(b).total_cmp(&length(a)));
    queue
}
