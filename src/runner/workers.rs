//! Cases on threads: as many at a time as asked for, each on a single thread of its own pool, so
//! that what comes out does not depend on how many run side by side.

use std::sync::{
    Mutex,
    atomic::{AtomicUsize, Ordering},
};

use super::{
    case::{self, CaseEnd},
    folder::Folder,
};
use crate::runner::{experiment::LoadedExperiment, progress::ProgressBoard};
use crate::{base::parallel, host::shutdown::Shutdown};

/// One case to be carried out.
pub(super) struct Job<'a> {
    /// What it belongs to.
    pub(super) loaded: &'a LoadedExperiment<'a>,
    /// Where it is kept, if anywhere.
    pub(super) folder: Option<&'a Folder>,
    /// Its name.
    pub(super) case: &'a str,
}

impl Job<'_> {
    /// Experiment and case.
    pub(super) fn title(&self) -> String {
        format!("{} {}", self.loaded.identity.experiment, self.case)
    }

    /// Seconds that it is expected to take, if that is known.
    pub(super) fn expected_s(&self) -> Option<f64> {
        self.loaded.plan.expected_s(self.case)
    }
}

/// Carries out all jobs; returns how each ended, in their order.
pub(super) fn work(
    jobs: &[Job<'_>],
    n_threads: usize,
    shutdown: &Shutdown,
    progress: &ProgressBoard,
) -> Result<Vec<CaseEnd>, parallel::ThreadPoolError> {
    let n_threads = n_threads.clamp(1, jobs.len().max(1));
    let pools =
        (0..n_threads).map(|_| parallel::ThreadPool::new(1)).collect::<Result<Vec<_>, _>>()?;
    let (queue, next) = (queue(jobs), AtomicUsize::new(0));
    let ends: Vec<Mutex<Option<CaseEnd>>> = jobs.iter().map(|_| Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| {
                while let Some(&i) = queue.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let line = progress.begin(i);
                    let end = parallel::lead(pool, || case::carry_out(&jobs[i], shutdown, &line));
                    line.end(&end);
                    *ends[i].lock().expect("nothing panics under this lock") = Some(end);
                }
            });
        }
    });
    let end = |slot: Mutex<Option<CaseEnd>>| {
        let end = slot.into_inner().expect("nothing panics under this lock");
        end.expect("every job was taken from the queue")
    };
    Ok(ends.into_iter().map(end).collect())
}

/// The order in which jobs are begun: the longest first, those of unknown length as they come.
pub(super) fn queue(jobs: &[Job<'_>]) -> Vec<usize> {
    let mut queue: Vec<usize> = (0..jobs.len()).collect();
    let length = |i: usize| jobs[i].expected_s().unwrap_or(f64::INFINITY);
    queue.sort_by(|&a, &b| length(b).total_cmp(&length(a)));
    queue
}
