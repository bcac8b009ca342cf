//! One thread and one bounded queue per sink, so that no sink can stop or slow the physics.
//!
//! The exception is a choice: a sink with `Delivery::Every` makes the run wait when its queue is
//! full. A sink that fails is counted and goes on; one that panics is out, and what it should
//! have got counts as failed; one that hangs is left behind at the end.

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

/// Most faults kept until someone takes them; a sink that fails on and on says little new.
const FAULTS_MAX: usize = 64;

/// What happens when a sink's queue is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delivery {
    /// The oldest packet is dropped and counted; one with a change of the world, or all that is
    /// needed to go on, only if there are no others.
    Latest {
        /// Packets that the queue holds, at least 1.
        depth: usize,
    },
    /// The run waits.
    Every {
        /// Packets that the queue holds, at least 1.
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

/// What a sink complained about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SinkFault {
    /// Name of the sink.
    pub sink: &'static str,
    /// What it said.
    pub text: String,
}

/// How a sink ended.
#[derive(Clone, Debug)]
pub struct SinkEnd {
    /// What became of the packets.
    pub counters: SinkCounters,
    /// False for a sink that did not end in the time it was given.
    pub is_closed: bool,
}

/// Gives packets to all sinks.
#[derive(Default)]
pub struct Fanout {
    lanes: Vec<Lane>,
}

impl Fanout {
    /// A fanout without sinks.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a sink and starts its thread.
    ///
    /// # Errors
    /// If the operating system refuses the thread.
    pub fn add(&mut self, sink: Box<dyn Sink>, delivery: Delivery) -> std::io::Result<()> {
        self.lanes.push(Lane::start(sink, delivery)?);
        Ok(())
    }

    /// Queues a packet for every sink. Waits only for sinks with `Delivery::Every`.
    pub fn publish(&self, packet: &Arc<Packet>) {
        for lane in &self.lanes {
            lane.push(packet);
        }
    }

    /// What became of the packets so far, sink by sink.
    pub fn counters(&self) -> Vec<SinkCounters> {
        self.lanes.iter().map(|lane| lane.shared.lock().counters.clone()).collect()
    }

    /// What the sinks complained about since the last call. A complaint that a sink repeats is
    /// there once.
    pub fn take_faults(&self) -> Vec<SinkFault> {
        let of_lane = |lane: &Lane| std::mem::take(&mut lane.shared.lock().faults);
        self.lanes.iter().flat_map(of_lane).collect()
    }

    /// Lets the sinks write what is queued and close, and waits for each at most `patience`.
    /// Returns how they ended and what they complained about.
    pub fn close(mut self, patience: Duration) -> (Vec<SinkEnd>, Vec<SinkFault>) {
        self.lanes.iter().for_each(Lane::ask_to_close);
        let ends = self.lanes.iter_mut().map(|lane| lane.join(patience)).collect();
        (ends, self.take_faults())
    }
}

impl Drop for Fanout {
    fn drop(&mut self) {
        self.lanes.iter().for_each(Lane::ask_to_close);
    }
}

/// A sink's thread and queue, seen from the run.
struct Lane {
    delivery: Delivery,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Lane {
    fn start(sink: Box<dyn Sink>, delivery: Delivery) -> std::io::Result<Self> {
        let name = sink.name();
        let shared = Arc::new(Shared::new(name));
        let thread = std::thread::Builder::new().name(format!("sink-{name}")).spawn({
            let shared = Arc::clone(&shared);
            move || serve(sink, &shared)
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

    fn ask_to_close(&self) {
        self.shared.lock().is_closing = true;
        self.shared.for_sink.notify_one();
    }

    fn join(&mut self, patience: Duration) -> SinkEnd {
        let queue = self.shared.lock();
        let is_running = |queue: &mut Queue| !queue.is_ended;
        let (mut queue, _) =
            ignore_poison(self.shared.for_run.wait_timeout_while(queue, patience, is_running));
        if !queue.is_ended {
            let text = format!(
                "{}: still busy {} s after it was asked to close; \
                 left behind with {} results unwritten",
                queue.counters.name,
                patience.as_secs_f64(),
                queue.packets.len()
            );
            queue.report_malformed(text);
        }
        let end = SinkEnd { counters: queue.counters.clone(), is_closed: queue.is_ended };
        drop(queue);
        if end.is_closed
            && let Some(thread) = self.thread.take()
        {
            // The thread has nothing left to do but return; its panics were caught in `serve`.
            drop(thread.join());
        }
        end
    }
}

/// What a sink's thread does.
fn serve(mut sink: Box<dyn Sink>, shared: &Shared) {
    let work = AssertUnwindSafe(|| {
        loop {
            match shared.next(sink.idle_after()) {
                Work::Packet(packet) => {
                    let outcome = sink.write(&packet);
                    drop(packet);
                    shared.written(outcome);
                }
                Work::Idle => shared.complain_if_failed(sink.idle()),
                Work::Close => break shared.complain_if_failed(sink.close()),
            }
        }
        // Dropped here, so that a panic while dropping is caught as well.
        drop(sink);
    });
    let outcome = catch_unwind(work);
    shared.end(outcome.err().map(|panic| panic_text(&*panic)));
}

fn panic_text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|it| (*it).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// What a sink's thread has to do next.
enum Work {
    Packet(Arc<Packet>),
    Idle,
    Close,
}

/// What run and sink share.
struct Shared {
    queue: Mutex<Queue>,
    /// Tells the sink that there is work.
    for_sink: Condvar,
    /// Tells the run that there is room, or that the sink has ended.
    for_run: Condvar,
}

struct Queue {
    packets: VecDeque<Arc<Packet>>,
    counters: SinkCounters,
    faults: Vec<SinkFault>,
    fault_last: Option<String>,
    /// 1 while the sink works on a packet.
    in_hand: u64,
    is_closing: bool,
    is_ended: bool,
}

impl Queue {
    fn report_malformed(&mut self, text: String) {
        if self.fault_last.as_ref() != Some(&text) && self.faults.len() < FAULTS_MAX {
            self.faults.push(SinkFault { sink: self.counters.name, text: text.clone() });
            self.fault_last = Some(text);
        }
    }
}

impl Shared {
    fn new(name: &'static str) -> Self {
        let queue = Queue {
            packets: VecDeque::new(),
            counters: SinkCounters { name, ..SinkCounters::default() },
            faults: Vec::new(),
            fault_last: None,
            in_hand: 0,
            is_closing: false,
            is_ended: false,
        };
        Self { queue: Mutex::new(queue), for_sink: Condvar::new(), for_run: Condvar::new() }
    }

    /// Nothing panics while it holds the lock, so what is behind it is whole.
    fn lock(&self) -> MutexGuard<'_, Queue> {
        ignore_poison(self.queue.lock())
    }

    fn next(&self, patience: Duration) -> Work {
        let queue = self.lock();
        let is_empty = |queue: &mut Queue| queue.packets.is_empty() && !queue.is_closing;
        let waited = self.for_sink.wait_timeout_while(queue, patience, is_empty);
        let (mut queue, _) = ignore_poison(waited);
        match queue.packets.pop_front() {
            Some(packet) => {
                queue.in_hand = 1;
                self.for_run.notify_one();
                Work::Packet(packet)
            }
            None if queue.is_closing => Work::Close,
            None => Work::Idle,
        }
    }

    fn written(&self, outcome: Result<(), Box<dyn Error + Send + Sync>>) {
        let mut queue = self.lock();
        queue.in_hand = 0;
        match outcome {
            Ok(()) => queue.counters.n_written += 1,
            Err(error) => {
                queue.counters.n_failed += 1;
                queue.report_malformed(error.to_string());
            }
        }
    }

    fn complain_if_failed(&self, outcome: Result<(), Box<dyn Error + Send + Sync>>) {
        if let Err(error) = outcome {
            self.lock().report_malformed(error.to_string());
        }
    }

    fn end(&self, panic: Option<String>) {
        let mut queue = self.lock();
        queue.is_ended = true;
        if let Some(text) = panic {
            queue.counters.n_failed += queue.in_hand + queue.packets.len() as u64;
            let name = queue.counters.name;
            queue.report_malformed(format!(
                "{name}: broke off: {text}; nothing more is written there"
            ));
        }
        queue.packets.clear();
        self.for_run.notify_all();
    }
}

fn ignore_poison<T>(result: Result<T, PoisonError<T>>) -> T {
    result.unwrap_or_else(PoisonError::into_inner)
}
