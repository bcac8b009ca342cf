//! The one way to fork: a team of solver threads, chunks of elements, and sums in a fixed order.
//!
//! Every parallel loop writes each element from read-only data, so the result cannot depend on
//! which thread did it.
//!
//! A substep has a dozen loops of some ten microseconds. Sending rayon's threads to sleep between
//! them and waking them again would cost more than the loops. So for the length of a tick
//! (`lead`) all threads of rayon's pool form a team: one leads, the others wait for its next loop,
//! first by spinning, then by giving their core away, and take chunks of it as they come free.
//! Between ticks they sleep. A core that is busy with something else only takes fewer chunks.

use std::{
    cell::Cell,
    ops::Range,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering},
    },
};

/// Chunks per thread: enough to even out what the threads get.
const CHUNKS_PER_THREAD: usize = 4;
/// Turns of a waiting loop before the core is given away.
const SPINS: u32 = 20_000;

/// Solver threads. Clones share the same threads, and several sessions may use one pool; they
/// then take turns. Results do not depend on the number of threads.
///
/// The threads run at lower priority than the threads that stream, because a solver that takes
/// every core would otherwise delay messages by tens of milliseconds.
#[derive(Clone, Debug)]
pub struct ThreadPool(Arc<rayon::ThreadPool>);

/// The operating system refused the solver threads.
#[derive(Debug, thiserror::Error)]
#[error("cannot start the solver threads: {0}; use fewer threads")]
pub struct ThreadPoolError(#[from] rayon::ThreadPoolBuildError);

impl ThreadPool {
    /// Starts `n_threads` solver threads; 0 means one per processor.
    ///
    /// # Errors
    /// If the operating system refuses the threads.
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

/// Ten steps nicer than the process; a refusal only costs latency, so it is not an error.
fn lower_priority() {
    // Miri, which checks the rest of this file, has no priorities.
    #[cfg(not(miri))]
    #[expect(unsafe_code, reason = "a libc call without a safe wrapper in std")]
    // SAFETY: `setpriority` takes plain integers; `0` names the calling thread.
    unsafe {
        libc::setpriority(libc::PRIO_PROCESS, 0, 10);
    }
}

/// A loop that the team works on: called with ranges of indices.
type Loop<'a> = &'a (dyn Fn(Range<usize>) + Sync);

/// Threads that share the loops of one leader.
struct Team {
    n_threads: usize,
    /// The present loop while it may be joined. Joining happens under its lock, so a helper that
    /// was away from its core for a while cannot mistake one loop for another.
    present: Mutex<Option<Job>>,
    /// Counts the loops; a change tells the helpers that there is a new one.
    turn: AtomicU64,
    /// First index of the present loop that nobody has taken yet.
    next: AtomicUsize,
    /// Helpers inside the present loop: those who are not cannot hold it up.
    n_inside: AtomicUsize,
    is_over: AtomicBool,
    has_panicked: AtomicBool,
}

#[derive(Clone, Copy)]
struct Job {
    /// Lives until the loop is closed and all helpers have left it: `Team::run` waits for that.
    work: Loop<'static>,
    n: usize,
    chunk: usize,
}

thread_local! {
    /// The team that this thread leads, if it leads one.
    static TEAM: Cell<Option<&'static Team>> = const { Cell::new(None) };
}

/// Runs `work` on one thread of `pool`, with the others as its team.
pub fn lead<R: Send>(pool: &ThreadPool, work: impl FnOnce() -> R + Send) -> R {
    let team = Team {
        n_threads: pool.n_threads(),
        present: Mutex::new(None),
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
        let _over = Leading::new(&team);
        work.map(|work| work())
    });
    results.into_iter().flatten().next().expect("the thread with index 0 has run the work")
}

/// Makes a thread the leader of its team until dropped, also by a panic.
struct Leading<'a>(&'a Team);

impl<'a> Leading<'a> {
    fn new(team: &'a Team) -> Self {
        #[expect(unsafe_code, reason = "a thread-local cannot hold a borrowed reference")]
        // SAFETY: `drop` takes the reference away before the team's borrow ends.
        let forever: &'static Team = unsafe { std::mem::transmute::<&Team, &'static Team>(team) };
        TEAM.set(Some(forever));
        Self(team)
    }
}

impl Drop for Leading<'_> {
    fn drop(&mut self) {
        TEAM.set(None);
        self.0.is_over.store(true, Ordering::Release);
    }
}

/// Counts a helper out of a loop, also when its chunk panics.
struct Leaving<'a>(&'a Team);

impl Drop for Leaving<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.has_panicked.store(true, Ordering::Relaxed);
        }
        self.0.n_inside.fetch_sub(1, Ordering::Release);
    }
}

impl Team {
    /// Works on the leader's loops until it is over.
    fn help(&self) {
        let mut turn = 0;
        loop {
            wait(|| self.turn.load(Ordering::Acquire) != turn || self.is_over());
            if self.is_over() {
                return;
            }
            turn = self.turn.load(Ordering::Acquire);
            if let Some(job) = self.join() {
                let _leaving = Leaving(self);
                self.take_chunks(&job);
            }
        }
    }

    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Acquire)
    }

    /// The present loop, if it is still open; the helper is then inside.
    fn join(&self) -> Option<Job> {
        let present = self.present.lock().ok()?;
        let job = (*present)?;
        self.n_inside.fetch_add(1, Ordering::Relaxed);
        Some(job)
    }

    /// Runs `work` over `0..n`, with all threads of the team that have time.
    fn run(&self, n: usize, chunk: usize, work: Loop<'_>) {
        #[expect(unsafe_code, reason = "helpers outlive the loop, but not its work")]
        // SAFETY: helpers use `work` only while they are inside; this function returns, or
        // unwinds through `Closing`, only after the loop is closed and nobody is inside.
        let work: Loop<'static> = unsafe { std::mem::transmute::<Loop<'_>, Loop<'static>>(work) };
        let job = Job { work, n, chunk };
        {
            let mut present = self.present.lock().expect("nothing panics under this lock");
            self.next.store(0, Ordering::Relaxed);
            *present = Some(job);
        }
        let closing = Closing(self);
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

/// Closes the loop and waits for those inside, also when the leader's chunk panics.
struct Closing<'a>(&'a Team);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        let team = self.0;
        *team.present.lock().expect("nothing panics under this lock") = None;
        wait(|| team.n_inside.load(Ordering::Acquire) == 0);
    }
}

/// Spins for a while, then gives the core away between looks.
fn wait(is_done: impl Fn() -> bool) {
    let mut turns = 0;
    while !is_done() {
        if turns < SPINS {
            turns += 1;
            std::hint::spin_loop();
        } else {
            std::thread::yield_now();
        }
    }
}

/// Calls `work` with ranges that cover `0..n`, on the team that this thread leads or alone.
fn split(n: usize, work: Loop<'_>) {
    match TEAM.get() {
        Some(team) if team.n_threads > 1 && n > 1 => {
            let chunk = n.div_ceil(team.n_threads * CHUNKS_PER_THREAD);
            team.run(n, chunk, work);
        }
        _ => work(0..n),
    }
}

/// A slice whose elements are written by different threads, each element by one.
struct Shared<T>(*mut T);

#[expect(unsafe_code, reason = "the pointer is shared so that disjoint elements can be written")]
// SAFETY: `element` is only called with indices that no other thread holds, and `T` may be sent.
unsafe impl<T: Send> Sync for Shared<T> {}

impl<T> Shared<T> {
    fn new(slice: &mut [T]) -> Self {
        Self(slice.as_mut_ptr())
    }

    /// Element `i`.
    ///
    /// # Safety
    /// `i` is inside the slice, the slice is still borrowed, and nobody else has element `i`.
    #[expect(unsafe_code, reason = "disjoint elements of one slice for several threads")]
    #[expect(clippy::mut_from_ref, reason = "each index is given out once")]
    #[inline(always)]
    unsafe fn element(&self, i: usize) -> &mut T {
        // SAFETY: as the caller promises.
        unsafe { &mut *self.0.add(i) }
    }

    /// Elements `range`.
    ///
    /// # Safety
    /// The range is inside the slice, the slice is still borrowed, and nobody else has any of them.
    #[expect(unsafe_code, reason = "disjoint parts of one slice for several threads")]
    #[expect(clippy::mut_from_ref, reason = "each part is given out once")]
    #[inline(always)]
    unsafe fn part(&self, range: &Range<usize>) -> &mut [T] {
        // SAFETY: as the caller promises.
        unsafe { std::slice::from_raw_parts_mut(self.0.add(range.start), range.len()) }
    }
}

/// `write(i, &mut out[i])` for every element.
pub fn for_each<T: Send>(out: &mut [T], write: impl Fn(usize, &mut T) + Sync) {
    let n = out.len();
    let out = Shared::new(out);
    split(n, &|range| {
        for i in range {
            #[expect(unsafe_code, reason = "see `Shared`")]
            // SAFETY: `split` gives out each index below `n` once, while `out` is borrowed.
            let element = unsafe { out.element(i) };
            write(i, element);
        }
    });
}

/// Parts of this many elements keep the widest registers full.
pub const PART: usize = 64;

/// `write(start, part of out)` for parts that cover a slice; they begin at multiples of `PART`.
pub fn for_parts<T: Send>(out: &mut [T], write: impl Fn(usize, &mut [T]) + Sync) {
    let n = out.len();
    let out = Shared::new(out);
    split(n.div_ceil(PART), &|parts| {
        let range = parts.start * PART..n.min(parts.end * PART);
        #[expect(unsafe_code, reason = "see `Shared`")]
        // SAFETY: `split` gives out each part once, while `out` is borrowed.
        let part = unsafe { out.part(&range) };
        write(range.start, part);
    });
}

/// `write(start, part of a, part of b)` for parts that cover two slices of the same length; they begin
/// at multiples of `PART`.
pub fn for_parts_of_two<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    write: impl Fn(usize, &mut [A], &mut [B]) + Sync,
) {
    assert_eq!(a.len(), b.len(), "the slices belong together");
    let n = a.len();
    let (a, b) = (Shared::new(a), Shared::new(b));
    split(n.div_ceil(PART), &|parts| {
        let range = parts.start * PART..n.min(parts.end * PART);
        #[expect(unsafe_code, reason = "see `Shared`")]
        // SAFETY: `split` gives out each part once, while both are borrowed.
        let (a, b) = unsafe { (a.part(&range), b.part(&range)) };
        write(range.start, a, b);
    });
}

/// `write(start, part of each)` for parts that cover four slices of the same length; they begin at
/// multiples of `PART`.
pub fn for_parts_of_four<A: Send, B: Send, C: Send, D: Send>(
    (a, b, c, d): (&mut [A], &mut [B], &mut [C], &mut [D]),
    write: impl Fn(usize, &mut [A], &mut [B], &mut [C], &mut [D]) + Sync,
) {
    let n = a.len();
    assert!([b.len(), c.len(), d.len()] == [n; 3], "the slices belong together");
    let (a, b, c, d) = (Shared::new(a), Shared::new(b), Shared::new(c), Shared::new(d));
    split(n.div_ceil(PART), &|parts| {
        let range = parts.start * PART..n.min(parts.end * PART);
        #[expect(unsafe_code, reason = "see `Shared`")]
        // SAFETY: `split` gives out each part once, while all are borrowed.
        let (a, b, c, d) =
            unsafe { (a.part(&range), b.part(&range), c.part(&range), d.part(&range)) };
        write(range.start, a, b, c, d);
    });
}

/// `write(i, &mut a[i], &mut b[i])` for every element of two slices of the same length.
pub fn for_each_of_two<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    write: impl Fn(usize, &mut A, &mut B) + Sync,
) {
    assert_eq!(a.len(), b.len(), "the slices belong together");
    let n = a.len();
    let (a, b) = (Shared::new(a), Shared::new(b));
    split(n, &|range| {
        for i in range {
            #[expect(unsafe_code, reason = "see `Shared`")]
            // SAFETY: `split` gives out each index below `n` once, while both are borrowed.
            let (a, b) = unsafe { (a.element(i), b.element(i)) };
            write(i, a, b);
        }
    });
}

/// `write(k, &mut a[i], &mut b[i])` for the `k`-th index `i` of an ascending list.
pub fn for_listed_of_two<A: Send, B: Send>(
    list: &[u32],
    a: &mut [A],
    b: &mut [B],
    write: impl Fn(usize, &mut A, &mut B) + Sync,
) {
    assert_eq!(a.len(), b.len(), "the slices belong together");
    assert!(list.is_sorted_by(|i, j| i < j), "each index once");
    assert!(list.last().is_none_or(|&i| (i as usize) < a.len()), "indices of elements");
    let (a, b) = (Shared::new(a), Shared::new(b));
    split(list.len(), &|range| {
        for k in range {
            let i = list[k] as usize;
            #[expect(unsafe_code, reason = "see `Shared`")]
            // SAFETY: `split` gives out each `k` once, the list has each index once and below the
            // slices' length, and both are borrowed.
            let (a, b) = unsafe { (a.element(i), b.element(i)) };
            write(k, a, b);
        }
    });
}

/// `write(start, part of a, part of b, part of c)` for parts, of at most `PART` elements, that cover
/// three slices of the same length; returns the largest of each of the non-negative numbers that it
/// gives, or 0.
pub fn largest_of_three<A: Send, B: Send, C: Send, const N: usize>(
    a: &mut [A],
    b: &mut [B],
    c: &mut [C],
    write: impl Fn(usize, &mut [A], &mut [B], &mut [C]) -> [f64; N] + Sync,
) -> [f64; N] {
    // The bits of non-negative doubles are ordered like the numbers; NaN is larger than all.
    let largest = [const { AtomicU64::new(0) }; N];
    assert!(a.len() == b.len() && b.len() == c.len(), "the slices belong together");
    let n = a.len();
    let (a, b, c) = (Shared::new(a), Shared::new(b), Shared::new(c));
    split(n.div_ceil(PART), &|parts| {
        let mut here = [0; N];
        for part in parts {
            let range = part * PART..n.min((part + 1) * PART);
            #[expect(unsafe_code, reason = "see `Shared`")]
            // SAFETY: `split` gives out each part once, while all are borrowed.
            let (a, b, c) = unsafe { (a.part(&range), b.part(&range), c.part(&range)) };
            for (here, found) in here.iter_mut().zip(write(range.start, a, b, c)) {
                *here = found.to_bits().max(*here);
            }
        }
        for (largest, here) in largest.iter().zip(here) {
            largest.fetch_max(here, Ordering::Relaxed);
        }
    });
    largest.map(|it| f64::from_bits(it.into_inner()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_is_written_once_by_any_team() {
        // Oracle: counting. A thousand loops of awkward lengths on teams of 1, 2 and 5; fewer under Miri,
        // which takes thousands of times as long.
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
    fn a_panic_in_a_loop_reaches_the_leader() {
        // Oracle: the panic itself; without care the team would wait for ever.
        let pool = ThreadPool::new(2).unwrap();
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            lead(&pool, || {
                let mut out = vec![0_u8; 1000];
                for_each(&mut out, |i, _| assert!(i != 700, "on purpose"));
            });
        }));
        assert!(outcome.is_err());
    }
}
