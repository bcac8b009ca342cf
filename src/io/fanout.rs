//! One thread and one bounded queue per sink, so that no sink can block or slow the physics.
//!
//! The exception is explicit: a sink with `Delivery::Every` makes the run wait while its queue is
//! full. A sink that fails is counted and stays in use. A sink that panics is removed, and its
//! remaining packets count as failed. A sink that hangs is abandoned on close.

use std::{
    any::Any,
    collections::VecDeque,
    error::Error,
    panic::{AssertUnwindSafe, catch_unwind},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread::JoinHandle,
    time::Duration,
};

use crate::io::sink::{Packet, Sink, SinkCounters};

/// Most errors kept until they are taken; a sink that keeps failing reports little new.
const ERRORS_MAX: usize = 64;

/// What happens when a sink's queue is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delivery {
    /// The oldest packet is dropped and counted. Packets with changes or checkpoints are dropped
    /// only if there are no others.
    Latest {
        /// Capacity of the queue (packets), at least 1.
        depth: usize,
    },
    /// The run waits.
    Every {
        /// Capacity of the queue (packets), at least 1.
        depth: usize,
    },
}

impl Delivery {
    fn depth(self) -> usize {
        match self {
            Self::Latest { depth } | Self::Every { depth } => depth.max(1),
        }
    }
}

/// An error that a sink reported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SinkError {
    /// Name of the sink.
    pub sink: &'static str,
    /// The error message.
    pub text: String,
}

/// The final state of a sink.
#[derive(Clone, Debug)]
pub struct SinkEnd {
    /// Packets written, dropped and failed.
    pub counters: SinkCounters,
    /// False if the sink did not close in time.
    pub is_closed: bool,
}

/// Distributes packets to all sinks.
#[derive(Default)]
pub struct Fanout {
    queues: Vec<SinkQueue>,
}

impl Fanout {
    /// Creates a fanout without sinks.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sink and starts its thread.
    ///
    /// # Errors
    /// If the operating system cannot start the thread.
    pub fn add(&mut self, sink: Box<dyn Sink>, delivery: Delivery) -> std::io::Result<()> {
        self.queues.push(SinkQueue::start(sink, delivery)?);
        Ok(())
    }

    /// Queues a packet for every sink. Blocks only for sinks with `Delivery::Every`.
    pub fn publish(&self, packet: &Arc<Packet>) {
        for queue in &self.queues {
            queue.push(packet);
        }
    }

    /// Packet counters of every sink so far.
    pub fn counters(&self) -> Vec<SinkCounters> {
        self.queues.iter().map(|queue| queue.shared.lock().counters.clone()).collect()
    }

    /// Errors that the sinks reported since the last call. Repetitions of a sink's last error are
    /// left out.
    pub fn take_errors(&self) -> Vec<SinkError> {
        let take = |queue: &SinkQueue| std::mem::take(&mut queue.shared.lock().errors);
        self.queues.iter().flat_map(take).collect()
    }

    /// Lets the sinks write their queued packets and close, and waits for each at most `timeout`.
    /// Returns their final states and the errors reported since the last call.
    pub fn close(mut self, timeout: Duration) -> (Vec<SinkEnd>, Vec<SinkError>) {
        self.queues.iter().for_each(SinkQueue::request_close);
        let ends = self.queues.iter_mut().map(|queue| queue.join(timeout)).collect();
        (ends, self.take_errors())
    }
}

impl Drop for Fanout {
    fn drop(&mut self) {
        self.queues.iter().for_each(SinkQueue::request_close);
    }
}

/// A sink's thread and queue, as the run uses them.
struct SinkQueue {
    delivery: Delivery,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl SinkQueue {
    fn start(sink: Box<dyn Sink>, delivery: Delivery) -> std::io::Result<Self> {
        let name = sink.name();
        let shared = Arc::new(Shared::new(name));
        let thread = std::thread::Builder::new().name(format!("sink-{name}")).spawn({
            let shared = Arc::clone(&shared);
            move || run_sink(sink, &shared)
        })?;
        Ok(Self { delivery, shared, thread: Some(thread) })
    }

    fn push(&self, packet: &Arc<Packet>) {
        let is_full = |queue: &mut Queue| {
            queue.packets.len() >= self.delivery.depth() && !queue.is_ended && !queue.is_closing
        };
        let mut queue = self.shared.lock();
        match self.delivery {
            Delivery::Every { .. } => {
                queue = ignore_poison(self.shared.for_run.wait_while(queue, is_full));
            }
            Delivery::Latest { .. } if is_full(&mut queue) => {
                let oldest = queue.packets.iter().position(|it| !it.is_required()).unwrap_or(0);
                queue.packets.remove(oldest);
                queue.counters.n_dropped += 1;
            }
            Delivery::Latest { .. } => {}
        }
        if queue.is_ended {
            queue.counters.n_failed += 1;
        } else {
            queue.packets.push_back(Arc::clone(packet));
            self.shared.for_sink.notify_one();
        }
    }

    fn request_close(&self) {
        self.shared.lock().is_closing = true;
        self.shared.for_sink.notify_one();
    }

    fn join(&mut self, timeout: Duration) -> SinkEnd {
        let queue = self.shared.lock();
        let is_running = |queue: &mut Queue| !queue.is_ended;
        let (mut queue, _) =
            ignore_poison(self.shared.for_run.wait_timeout_while(queue, timeout, is_running));
        if !queue.is_ended {
            let text = format!(
                "{}: did not close within {} s; abandoned with {} results unwritten",
                queue.counters.name,
                timeout.as_secs_f64(),
                queue.packets.len()
            );
            queue.report_error(text);
        }
        let end = SinkEnd { counters: queue.counters.clone(), is_closed: queue.is_ended };
        drop(queue);
        if end.is_closed
            && let Some(thread) = self.thread.take()
        {
            // The thread only has to return; its panics were caught in `run_sink`.
            drop(thread.join());
        }
        end
    }
}

/// The body of a sink's thread.
fn run_sink(mut sink: Box<dyn Sink>, shared: &Shared) {
    let work = AssertUnwindSafe(|| {
        loop {
            match shared.next(sink.idle_after()) {
                Work::Packet(packet) => {
                    let result = sink.write(&packet);
                    drop(packet);
                    shared.finish_write(result);
                }
                Work::Idle => shared.report_if_failed(sink.idle()),
                Work::Close => break shared.report_if_failed(sink.close()),
            }
        }
        // Dropped here, so that a panic during the drop is also caught.
        drop(sink);
    });
    let result = catch_unwind(work);
    shared.end(result.err().map(|panic| panic_text(&*panic)));
}

fn panic_text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|it| (*it).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// The next job of a sink's thread.
enum Work {
    Packet(Arc<Packet>),
    Idle,
    Close,
}

/// State shared by the run and a sink's thread.
struct Shared {
    queue: Mutex<Queue>,
    /// Notifies the sink that there is work.
    for_sink: Condvar,
    /// Notifies the run that there is space, or that the sink has ended.
    for_run: Condvar,
}

struct Queue {
    packets: VecDeque<Arc<Packet>>,
    counters: SinkCounters,
    errors: Vec<SinkError>,
    last_error: Option<String>,
    /// Number of packets that the sink is writing, 0 or 1.
    n_in_progress: u64,
    is_closing: bool,
    is_ended: bool,
}

impl Queue {
    fn report_error(&mut self, text: String) {
        if self.last_error.as_ref() != Some(&text) && self.errors.len() < ERRORS_MAX {
            self.errors.push(SinkError { sink: self.counters.name, text: text.clone() });
            self.last_error = Some(text);
        }
    }
}

impl Shared {
    fn new(name: &'static str) -> Self {
        let queue = Queue {
            packets: VecDeque::new(),
            counters: SinkCounters { name, ..SinkCounters::default() },
            errors: Vec::new(),
            last_error: None,
            n_in_progress: 0,
            is_closing: false,
            is_ended: false,
        };
        Self { queue: Mutex::new(queue), for_sink: Condvar::new(), for_run: Condvar::new() }
    }

    /// Nothing panics while it holds the lock, so the queue is always consistent.
    fn lock(&self) -> MutexGuard<'_, Queue> {
        ignore_poison(self.queue.lock())
    }

    fn next(&self, timeout: Duration) -> Work {
        let queue = self.lock();
        let is_empty = |queue: &mut Queue| queue.packets.is_empty() && !queue.is_closing;
        let waited = self.for_sink.wait_timeout_while(queue, timeout, is_empty);
        let (mut queue, _) = ignore_poison(waited);
        match queue.packets.pop_front() {
            Some(packet) => {
                queue.n_in_progress = 1;
                self.for_run.notify_one();
                Work::Packet(packet)
            }
            None if queue.is_closing => Work::Close,
            None => Work::Idle,
        }
    }

    fn finish_write(&self, result: Result<(), Box<dyn Error + Send + Sync>>) {
        let mut queue = self.lock();
        queue.n_in_progress = 0;
        match result {
            Ok(()) => queue.counters.n_written += 1,
            Err(error) => {
                queue.counters.n_failed += 1;
                queue.report_error(error.to_string());
            }
        }
    }

    fn report_if_failed(&self, result: Result<(), Box<dyn Error + Send + Sync>>) {
        if let Err(error) = result {
            self.lock().report_error(error.to_string());
        }
    }

    fn end(&self, panic: Option<String>) {
        let mut queue = self.lock();
        queue.is_ended = true;
        if let Some(text) = panic {
            queue.counters.n_failed += queue.n_in_progress + queue.packets.len() as u64;
            let name = queue.counters.name;
            queue.report_error(format!("{name}: panicked: {text}; it receives no more results"));
        }
        queue.packets.clear();
        self.for_run.notify_all();
    }
}

fn ignore_poison<T>(result: Result<T, PoisonError<T>>) -> T {
    result.unwrap_or_else(PoisonError::into_inner)
}
