//! Runs jobs from a queue on several threads.

use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicUsize, Ordering},
};

/// Runs the jobs in `queue`, given by their indices, in this order on `n_threads` threads.
///
/// `run` receives the index of the thread and of the job. A thread ends when the queue is empty or
/// `run` returns `None`. Returns the results sorted by job.
pub fn run_jobs<T: Send>(
    n_threads: usize,
    queue: &[usize],
    run: impl Fn(usize, usize) -> Option<T> + Sync,
) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let results: Mutex<Vec<(usize, T)>> = Mutex::default();
    let work = |thread: usize| {
        while let Some(&job) = queue.get(next.fetch_add(1, Ordering::SeqCst)) {
            let Some(result) = run(thread, job) else { return };
            results.lock().unwrap_or_else(PoisonError::into_inner).push((job, result));
        }
    };
    std::thread::scope(|scope| {
        for thread in 0..n_threads {
            let work = &work;
            scope.spawn(move || work(thread));
        }
    });
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(job, _)| *job);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the same jobs in a loop.
    #[test]
    fn results_are_sorted_by_job() {
        let queue: Vec<usize> = (0..100).rev().collect();
        let expected: Vec<usize> = (0..100).map(|job| job * job).collect();
        for n_threads in [1, 2, 7] {
            assert_eq!(run_jobs(n_threads, &queue, |_, job| Some(job * job)), expected);
        }
        let first_ten = run_jobs(1, &queue, |_, job| (90 <= job).then_some(job));
        assert_eq!(first_ten, (90..100).collect::<Vec<_>>());
    }
}
