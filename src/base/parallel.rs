//! Parallel loops over chunks of elements, run by a team of solver threads. No other file forks.
//!
//! Every loop computes each element from read-only data, so results do not depend on which thread
//! computes which element.
//!
//! A substep has about a dozen loops of about ten microseconds each. Putting rayon's threads to
//! sleep between loops and waking them again would take longer than the loops. Instead, all
//! threads of rayon's pool form a team for the duration of a tick (`lead`): one thread leads, and
//! the helpers wait for its next loop, first by spinning, then by yielding, and take chunks of it
//! as they become free. Between ticks the threads sleep. A thread whose core is busy with another
//! process takes fewer chunks.

use std::{
    cell::Cell,
    ops::Range,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering},
    },
};

/// Chunks per thread: enough to balance the load.
const CHUNKS_PER_THREAD: usize = 4;
/// Iterations of a waiting loop before it starts to yield.
const N_SPINS: u32 = 20_000;

/// The solver threads. Clones share the same threads. Several sessions may use one pool and then take turns. Results
/// do not depend on the number of threads.
///
/// The threads run at lower priority than the threads that publish, because a solver that occupies every core would
/// otherwise delay messages by tens of milliseconds.
#[derive(Clone, Debug)]
pub struct ThreadPool(Arc<rayon::ThreadPool>);

/// The operating system cannot start the solver threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start the solver threads: {0}; use fewer threads")]
pub struct ThreadPoolError(#[from] rayon::ThreadPoolBuildError);

impl ThreadPool {
    /// Starts `n_threads` solver threads; 0 means one per processor.
    ///
    /// # Errors
    /// If the operating system cannot start the threads.
    pub fn new(n_threads: usize) -> Result<Self, ThreadPoolError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .thread_name(|i| format!("solver-{i}"))
            .start_handler(|_| lower_priority())
            .build()?;
        Ok(Self(Arc::new(pool)))
    }

    /// Number of threads.
    pub fn n_threads(&self) -> usize {
        self.0.current_num_threads()
    }
}

/// Lowers the priority of the calling thread: 10 nicer than the process. A failure only costs latency, so it
/// is ignored.
fn lower_priority() {
    // Miri, which checks the rest of this file, does not support priorities.
    #[cfg(not(miri))]
    #[expect(unsafe_code, reason = "a libc call without a safe wrapper in std")]
    // SAFETY: `setpriority` takes plain integers; `0` names the calling thread.
    unsafe {
        libc::setpriority(libc::PRIO_PROCESS, 0, 10);
    }
}

/// The body of a parallel loop, called with ranges of indices.
type Loop<'a> = &'a (dyn Fn(Range<usize>) + Sync);

/// The threads that share the loops of one leader.
struct Team {
    n_threads: usize,
    /// The current loop, while helpers may join it. They join under the lock, so a helper that was
    /// descheduled for a while cannot mistake one loop for another.
    current: Mutex<Option<Job>>,
    /// Number of loops so far. Helpers wait for it to change.
    turn: AtomicU64,
    /// First index of the current loop that no thread has taken yet.
    next: AtomicUsize,
    /// Number of helpers that have joined the current loop. The leader waits only for these.
    n_inside: AtomicUsize,
    is_over: AtomicBool,
    has_panicked: AtomicBool,
}

#[derive(Clone, Copy)]
struct Job {
    /// Valid until the loop is closed and all helpers have left it; `Team::run` waits for that.
    work: Loop<'static>,
    n: usize,
    chunk: usize,
}

thread_local! {
    /// The team that this thread leads, if any.
    static TEAM: Cell<Option<&'static Team>> = const { Cell::new(None) };
}

/// Runs `work` on one thread of `pool`. Parallel loops in it are shared with the other threads.
pub fn lead<R: Send>(pool: &ThreadPool, work: impl FnOnce() -> R + Send) -> R {
    let team = Team {
        n_threads: pool.n_threads(),
        current: Mutex::new(None),
        turn: AtomicU64::new(0),
        next: AtomicUsize::new(0),
        n_inside: AtomicUsize::new(0),
        is_over: AtomicBool::new(false),
        has_panicked: AtomicBool::new(false),
    };
    let work = Mutex::new(Some(work));
    let results = pool.0.broadcast(|context| {
        if context.index() != 0 {
            team.help();
            return None;
        }
        let work = work.lock().ok().and_then(|mut work| work.take());
        let _guard = LeaderGuard::new(&team);
        work.map(|work| work())
    });
    results.into_iter().flatten().next().expect("the thread with index 0 has run the work")
}

/// Makes the current thread the leader of a team. Dropping it, also during a panic, ends the team.
struct LeaderGuard<'a>(&'a Team);

impl<'a> LeaderGuard<'a> {
    fn new(team: &'a Team) -> Self {
        #[expect(unsafe_code, reason = "a thread-local cannot hold a borrowed reference")]
        // SAFETY: `drop` removes the reference before the team's borrow ends.
        let team_static: &'static Team =
            unsafe { std::mem::transmute::<&Team, &'static Team>(team) };
        TEAM.set(Some(team_static));
        Self(team)
    }
}

impl Drop for LeaderGuard<'_> {
    fn drop(&mut self) {
        TEAM.set(None);
        self.0.is_over.store(true, Ordering::Release);
    }
}

/// Signs a helper out of a loop when dropped, also during a panic.
struct HelperGuard<'a>(&'a Team);

impl Drop for HelperGuard<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.has_panicked.store(true, Ordering::Relaxed);
        }
        self.0.n_inside.fetch_sub(1, Ordering::Release);
    }
}

impl Team {
    /// Helps with the leader's loops until the team ends.
    fn help(&self) {
        let mut turn = 0;
        loop {
            wait(|| self.turn.load(Ordering::Acquire) != turn || self.is_over());
            if self.is_over() {
                return;
            }
            turn = self.turn.load(Ordering::Acquire);
            if let Some(job) = self.join() {
                let _guard = HelperGuard(self);
                self.take_chunks(&job);
            }
        }
    }

    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Acquire)
    }

    /// Joins the current loop, if it is still open.
    fn join(&self) -> Option<Job> {
        let current = self.current.lock().ok()?;
        let job = (*current)?;
        self.n_inside.fetch_add(1, Ordering::Relaxed);
        Some(job)
    }

    /// Runs `work` over `0..n` on the leader and all helpers that are free.
    fn run(&self, n: usize, chunk: usize, work: Loop<'_>) {
        #[expect(
            unsafe_code,
            reason = "the helpers' type cannot hold the lifetime of a single loop"
        )]
        // SAFETY: helpers use `work` only while they are inside the loop. This function returns, or
        // unwinds through `CloseGuard`, only after the loop is closed and all helpers have left.
        let work: Loop<'static> = unsafe { std::mem::transmute::<Loop<'_>, Loop<'static>>(work) };
        let job = Job { work, n, chunk };
        {
            let mut current = self.current.lock().expect("nothing panics under this lock");
            self.next.store(0, Ordering::Relaxed);
            *current = Some(job);
        }
        let closing = CloseGuard(self);
        self.turn.fetch_add(1, Ordering::Release);
        self.take_chunks(&job);
        drop(closing);
        assert!(!self.has_panicked.load(Ordering::Relaxed), "a solver thread has panicked");
    }

    fn take_chunks(&self, job: &Job) {
        loop {
            let start = self.next.fetch_add(job.chunk, Ordering::Relaxed);
            if start >= job.n {
                return;
            }
            (job.work)(start..job.n.min(start + job.chunk));
        }
    }
}

/// Closes the loop and waits until all helpers have left it, also during a panic of the leader.
struct CloseGuard<'a>(&'a Team);

impl Drop for CloseGuard<'_> {
    fn drop(&mut self) {
        let team = self.0;
        *team.current.lock().expect("nothing panics under this lock") = None;
        wait(|| team.n_inside.load(Ordering::Acquire) == 0);
    }
}

/// Waits by spinning at first, later by yielding.
fn wait(is_done: impl Fn() -> bool) {
    let mut turns = 0;
    while !is_done() {
        if turns < N_SPINS {
            turns += 1;
            std::hint::spin_loop();
        } else {
            std::thread::yield_now();
        }
    }
}

/// Calls `work` with ranges that cover `0..n`, on the team that this thread leads, or on this thread alone.
fn split(n: usize, work: Loop<'_>) {
    match TEAM.get() {
        Some(team) if team.n_threads > 1 && n > 1 => {
            let chunk = n.div_ceil(team.n_threads * CHUNKS_PER_THREAD);
            team.run(n, chunk, work);
        }
        _ => work(0..n),
    }
}

/// A slice whose elements are written by several threads, each element by only one.
struct SharedSlice<T>(*mut T);

#[expect(unsafe_code, reason = "the pointer is shared so that disjoint elements can be written")]
// SAFETY: no two threads access the same element at the same time, and `T` is `Send`.
unsafe impl<T: Send> Sync for SharedSlice<T> {}

impl<T> SharedSlice<T> {
    fn new(slice: &mut [T]) -> Self {
        Self(slice.as_mut_ptr())
    }

    /// Element `i`.
    ///
    /// # Safety
    /// `i` is inside the slice, the slice is still borrowed, and no one else has a reference to element `i`.
    #[expect(unsafe_code, reason = "several threads write disjoint elements of one slice")]
    #[expect(clippy::mut_from_ref, reason = "each index is given out once")]
    #[inline(always)]
    unsafe fn element(&self, i: usize) -> &mut T {
        // SAFETY: guaranteed by the caller.
        unsafe { &mut *self.0.add(i) }
    }

    /// Elements `range`.
    ///
    /// # Safety
    /// The range is inside the slice, the slice is still borrowed, and no one else has a reference to any of its
    /// elements.
    #[expect(unsafe_code, reason = "several threads write disjoint parts of one slice")]
    #[expect(clippy::mut_from_ref, reason = "each part is given out once")]
    #[inline(always)]
    unsafe fn part(&self, range: &Range<usize>) -> &mut [T] {
        // SAFETY: guaranteed by the caller.
        unsafe { std::slice::from_raw_parts_mut(self.0.add(range.start), range.len()) }
    }
}

/// Calls `write(i, &mut out[i])` for every element.
pub fn for_each<T: Send>(out: &mut [T], write: impl Fn(usize, &mut T) + Sync) {
    let n = out.len();
    let out = SharedSlice::new(out);
    split(n, &|range| {
        for i in range {
            #[expect(unsafe_code, reason = "see `SharedSlice`")]
            // SAFETY: `split` gives out each index below `n` once, while `out` is borrowed.
            let element = unsafe { out.element(i) };
            write(i, element);
        }
    });
}

/// Number of elements of a part, a multiple of the widest registers.
pub const PART: usize = 64;

/// Calls `write(start, part of out)` for parts that cover the slice and begin at multiples of `PART`.
pub fn for_parts<T: Send>(out: &mut [T], write: impl Fn(usize, &mut [T]) + Sync) {
    let n = out.len();
    let out = SharedSlice::new(out);
    split(n.div_ceil(PART), &|parts| {
        let range = parts.start * PART..n.min(parts.end * PART);
        #[expect(unsafe_code, reason = "see `SharedSlice`")]
        // SAFETY: `split` gives out each part once, while `out` is borrowed.
        let part = unsafe { out.part(&range) };
        write(range.start, part);
    });
}

/// Calls `write(start, part of a, part of b)` for parts that cover two slices of the same length and begin at
/// multiples of `PART`.
pub fn for_parts_of_two<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    write: impl Fn(usize, &mut [A], &mut [B]) + Sync,
) {
    assert_eq!(a.len(), b.len(), "the slices must have the same length");
    let n = a.len();
    let (a, b) = (SharedSlice::new(a), SharedSlice::new(b));
    split(n.div_ceil(PART), &|parts| {
        let range = parts.start * PART..n.min(parts.end * PART);
        #[expect(unsafe_code, reason = "see `SharedSlice`")]
        // SAFETY: `split` gives out each part once, while both are borrowed.
        let (a, b) = unsafe { (a.part(&range), b.part(&range)) };
        write(range.start, a, b);
    });
}

/// Calls `write(start, part of each)` for parts that cover four slices of the same length and begin at
/// multiples of `PART`.
pub fn for_parts_of_four<A: Send, B: Send, C: Send, D: Send>(
    (a, b, c, d): (&mut [A], &mut [B], &mut [C], &mut [D]),
    write: impl Fn(usize, &mut [A], &mut [B], &mut [C], &mut [D]) + Sync,
) {
    let n = a.len();
    assert!([b.len(), c.len(), d.len()] == [n; 3], "the slices must have the same length");
    let (a, b, c, d) =
        (SharedSlice::new(a), SharedSlice::new(b), SharedSlice::new(c), SharedSlice::new(d));
    split(n.div_ceil(PART), &|parts| {
        let range = parts.start * PART..n.min(parts.end * PART);
        #[expect(unsafe_code, reason = "see `SharedSlice`")]
        // SAFETY: `split` gives out each part once, while all are borrowed.
        let (a, b, c, d) =
            unsafe { (a.part(&range), b.part(&range), c.part(&range), d.part(&range)) };
        write(range.start, a, b, c, d);
    });
}

/// Calls `write(i, &mut a[i], &mut b[i])` for every element of two slices of the same length.
pub fn for_each_of_two<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    write: impl Fn(usize, &mut A, &mut B) + Sync,
) {
    assert_eq!(a.len(), b.len(), "the slices must have the same length");
    let n = a.len();
    let (a, b) = (SharedSlice::new(a), SharedSlice::new(b));
    split(n, &|range| {
        for i in range {
            #[expect(unsafe_code, reason = "see `SharedSlice`")]
            // SAFETY: `split` gives out each index below `n` once, while both are borrowed.
            let (a, b) = unsafe { (a.element(i), b.element(i)) };
            write(i, a, b);
        }
    });
}

/// Calls `write(k, &mut a[i], &mut b[i])` for the `k`-th index `i` of an ascending list.
pub fn for_listed_of_two<A: Send, B: Send>(
    list: &[u32],
    a: &mut [A],
    b: &mut [B],
    write: impl Fn(usize, &mut A, &mut B) + Sync,
) {
    assert_eq!(a.len(), b.len(), "the slices must have the same length");
    assert!(list.is_sorted_by(|i, j| i < j), "the indices must ascend strictly");
    assert!(
        list.last().is_none_or(|&i| (i as usize) < a.len()),
        "the indices must be inside the slices"
    );
    let (a, b) = (SharedSlice::new(a), SharedSlice::new(b));
    split(list.len(), &|range| {
        for k in range {
            let i = list[k] as usize;
            #[expect(unsafe_code, reason = "see `SharedSlice`")]
            // SAFETY: `split` gives out each `k` once, the list has each index once and below the
            // slices' length, and both are borrowed.
            let (a, b) = unsafe { (a.element(i), b.element(i)) };
            write(k, a, b);
        }
    });
}

/// Calls `write(start, part of a, part of b, part of c)` for parts of at most `PART` elements that cover
/// three slices of the same length. Returns the maximum of each of the `N` non-negative numbers that `write`
/// returns, or 0 for empty slices.
pub fn largest_of_three<A: Send, B: Send, C: Send, const N: usize>(
    a: &mut [A],
    b: &mut [B],
    c: &mut [C],
    write: impl Fn(usize, &mut [A], &mut [B], &mut [C]) -> [f64; N] + Sync,
) -> [f64; N] {
    // The bits of non-negative doubles are ordered like the numbers; NaN is the largest.
    let largest = [const { AtomicU64::new(0) }; N];
    assert!(a.len() == b.len() && b.len() == c.len(), "the slices must have the same length");
    let n = a.len();
    let (a, b, c) = (SharedSlice::new(a), SharedSlice::new(b), SharedSlice::new(c));
    split(n.div_ceil(PART), &|parts| {
        let mut local = [0; N];
        for part in parts {
            let range = part * PART..n.min((part + 1) * PART);
            #[expect(unsafe_code, reason = "see `SharedSlice`")]
            // SAFETY: `split` gives out each part once, while all are borrowed.
            let (a, b, c) = unsafe { (a.part(&range), b.part(&range), c.part(&range)) };
            for (local, found) in local.iter_mut().zip(write(range.start, a, b, c)) {
                *local = found.to_bits().max(*local);
            }
        }
        for (largest, local) in largest.iter().zip(local) {
            largest.fetch_max(local, Ordering::Relaxed);
        }
    });
    largest.map(|it| f64::from_bits(it.into_inner()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn teams_of_any_size_write_every_element_once() {
        // Oracle: counting. A thousand loops of irregular lengths on teams of 1, 2 and 5; fewer under Miri,
        // which is thousands of times slower.
        let n_loops = if cfg!(miri) { 8 } else { 1000 };
        for n_threads in [1, 2, 5] {
            let pool = ThreadPool::new(n_threads).unwrap();
            lead(&pool, || {
                for n in (0..n_loops).map(|k| k * 7 % 311) {
                    let mut a = vec![0_usize; n];
                    let mut b = vec![0_usize; n];
                    for_each(&mut a, |i, a| *a += i + 1);
                    let mut c = vec![(); n];
                    let [largest] = largest_of_three(&mut a, &mut b, &mut c, |start, a, b, _| {
                        b.copy_from_slice(a);
                        [f64::from(u32::try_from(start + a.len() - 1).unwrap())]
                    });
                    assert!((0..n).all(|i| a[i] == i + 1 && b[i] == i + 1), "{n_threads} {n}");
                    let last = f64::from(u32::try_from(n.max(1) - 1).unwrap());
                    assert!((largest - last).abs() < 0.5, "{largest} of {n}");
                }
            });
        }
    }

    #[test]
    fn a_panic_in_a_loop_propagates_to_the_leader() {
        // Oracle: the panic itself. If it were not propagated, the team would wait forever.
        let pool = ThreadPool::new(2).unwrap();
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            lead(&pool, || {
                let mut out = vec![0_u8; 1000];
                for_each(&mut out, |i, _| assert!(i != 700, "expected panic"));
            });
        }));
        assert!(result.is_err());
    }
}
