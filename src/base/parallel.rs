//! The one way to fork: a pool of solver threads, fixed chunks, and sums in a fixed order.
//!
//! Every parallel loop writes each element from read-only data, so the result cannot depend on
//! which thread did it. Sums are taken over chunks of fixed length and then over the chunks in
//! order, so they have the same bits on any number of threads.

use rayon::prelude::*;

/// Elements a thread takes at a time: large enough to hide the cost of taking them.
const CHUNK: usize = 256;

/// Starts the solver's threads. They run at lower priority than the threads that stream, because
/// a solver that takes every core would otherwise delay messages by tens of milliseconds.
///
/// # Errors
/// If the operating system refuses the threads.
pub fn pool(n_threads: usize) -> Result<rayon::ThreadPool, rayon::ThreadPoolBuildError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(n_threads)
        .thread_name(|i| format!("solver-{i}"))
        .start_handler(|_| lower_priority())
        .build()
}

/// Ten steps nicer than the process; a refusal only costs latency, so it is not an error.
fn lower_priority() {
    #[expect(unsafe_code, reason = "a libc call without a safe wrapper in std")]
    // SAFETY: `setpriority` takes plain integers; `0` names the calling thread.
    unsafe {
        libc::setpriority(libc::PRIO_PROCESS, 0, 10);
    }
}

/// `write(i, &mut out[i])` for every element.
pub fn for_each<T: Send>(out: &mut [T], write: impl Fn(usize, &mut T) + Sync + Send) {
    if out.len() <= CHUNK {
        for (i, element) in out.iter_mut().enumerate() {
            write(i, element);
        }
        return;
    }
    out.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, elements)| {
        for (k, element) in elements.iter_mut().enumerate() {
            write(chunk * CHUNK + k, element);
        }
    });
}

/// The sum of `term(i)` for `i < n`, by chunks in order.
pub fn sum<T>(n: usize, zero: T, term: impl Fn(usize) -> T + Sync + Send) -> T
where
    T: Copy + Send + Sync + std::ops::Add<Output = T>,
{
    let of_chunk = |chunk: usize| {
        let mut total = zero;
        for i in chunk * CHUNK..n.min((chunk + 1) * CHUNK) {
            total = total + term(i);
        }
        total
    };
    let sums: Vec<T> = (0..n.div_ceil(CHUNK)).into_par_iter().map(of_chunk).collect();
    sums.into_iter().fold(zero, |total, part| total + part)
}

/// `write(i, &mut a[i], &mut b[i])` for every element of two slices of the same length.
pub fn for_each_of_two<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    write: impl Fn(usize, &mut A, &mut B) + Sync + Send,
) {
    debug_assert_eq!(a.len(), b.len(), "the slices belong together");
    let chunks = a.par_chunks_mut(CHUNK).zip(b.par_chunks_mut(CHUNK));
    chunks.enumerate().for_each(|(chunk, (a, b))| {
        for (k, (a, b)) in a.iter_mut().zip(b).enumerate() {
            write(chunk * CHUNK + k, a, b);
        }
    });
}
