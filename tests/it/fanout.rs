//! Sinks behind their queues: order, drops, waiting, failures, panics, hanging, closing.

use std::{
    error::Error,
    sync::{
        Arc, Mutex,
        mpsc::{Receiver, Sender, channel},
    },
    time::Duration,
};

use jamgrip::io::{
    fanout::{Delivery, Fanout},
    sink::{Packet, Sink},
};

use crate::synthetic;

/// Longer than anything here takes; it only expires if a test fails.
const TIMEOUT: Duration = Duration::from_secs(60);

type WriteResult = Result<(), Box<dyn Error + Send + Sync>>;

/// The ticks that a memory sink has received.
#[derive(Clone, Default)]
struct Received(Arc<Mutex<Vec<u64>>>);

impl Received {
    fn ticks(&self) -> Vec<u64> {
        self.0.lock().unwrap().clone()
    }
}

/// Stores the ticks it receives; `at_write` and `at_close` determine its behavior.
struct Memory<W, C> {
    received: Received,
    at_write: W,
    at_close: C,
}

impl<W, C> Sink for Memory<W, C>
where
    W: FnMut(u64) -> WriteResult + Send,
    C: FnMut() -> WriteResult + Send,
{
    fn name(&self) -> &'static str {
        "memory"
    }

    fn write(&mut self, packet: &Packet) -> WriteResult {
        let tick = packet.snapshot.tick.0;
        (self.at_write)(tick)?;
        self.received.0.lock().unwrap().push(tick);
        Ok(())
    }

    fn close(&mut self) -> WriteResult {
        (self.at_close)()
    }
}

fn start<W>(delivery: Delivery, at_write: W) -> (Fanout, Received)
where
    W: FnMut(u64) -> WriteResult + Send + 'static,
{
    let (mut fanout, received) = (Fanout::new(), Received::default());
    let sink = Memory { received: received.clone(), at_write, at_close: || Ok(()) };
    fanout.add(Box::new(sink), delivery).unwrap();
    (fanout, received)
}

fn publish(fanout: &Fanout, ticks: std::ops::RangeInclusive<u64>) {
    for tick in ticks {
        fanout.publish(&synthetic::packet(tick));
    }
}

/// A sink that waits at each packet until it may continue, and reports that it waits.
fn gate() -> (impl FnMut(u64) -> WriteResult + Send, Receiver<u64>, Sender<()>) {
    let (arrived, arrivals) = channel();
    let (open, opened) = channel::<()>();
    let at_write = move |tick| {
        arrived.send(tick).unwrap();
        opened.recv()?;
        Ok(())
    };
    (at_write, arrivals, open)
}

#[test]
fn every_packet_arrives_in_order() {
    let (fanout, received) = start(Delivery::Every { depth: 4 }, |_| Ok(()));
    publish(&fanout, 1..=500);
    let (ends, errors) = fanout.close(TIMEOUT);
    // Oracle: what was published; `Every` may drop nothing.
    assert_eq!(received.ticks(), (1..=500).collect::<Vec<u64>>());
    assert!(ends[0].is_closed && errors.is_empty());
    let counters = &ends[0].counters;
    assert_eq!((counters.n_written, counters.n_dropped, counters.n_failed), (500, 0, 0));
}

#[test]
fn a_slow_sink_receives_the_latest_and_drops_are_counted() {
    let (at_write, arrivals, open) = gate();
    let (fanout, received) = start(Delivery::Latest { depth: 3 }, at_write);
    publish(&fanout, 1..=1);
    assert_eq!(arrivals.recv_timeout(TIMEOUT), Ok(1), "the sink is writing tick 1");
    // This returns although the sink is blocked: the physics is never slowed.
    publish(&fanout, 2..=10);
    assert_eq!(fanout.counters()[0].n_dropped, 6);
    (0..4).for_each(|_| open.send(()).unwrap());
    let (ends, _) = fanout.close(TIMEOUT);
    // Oracle: the packet being written, then the three latest of those that followed.
    assert_eq!(received.ticks(), [1, 8, 9, 10]);
    let counters = &ends[0].counters;
    assert_eq!((counters.n_written, counters.n_dropped, counters.n_failed), (4, 6, 0));
}

#[test]
fn a_full_queue_with_every_delivery_makes_the_run_wait() {
    let (at_write, arrivals, open) = gate();
    let (fanout, received) = start(Delivery::Every { depth: 2 }, at_write);
    let (sent, published) = channel();
    let run = std::thread::spawn(move || {
        for tick in 1..=6 {
            fanout.publish(&synthetic::packet(tick));
            sent.send(tick).unwrap();
        }
        fanout.close(TIMEOUT)
    });
    assert_eq!(arrivals.recv_timeout(TIMEOUT), Ok(1));
    // One packet is being written and two are queued; the fourth waits until the gate opens.
    for tick in 1..=3 {
        assert_eq!(published.recv_timeout(TIMEOUT), Ok(tick));
    }
    assert!(published.try_recv().is_err(), "the fourth packet must wait");
    (0..6).for_each(|_| open.send(()).unwrap());
    let (ends, _) = run.join().unwrap();
    assert_eq!(received.ticks(), [1, 2, 3, 4, 5, 6]);
    assert_eq!(ends[0].counters.n_dropped, 0);
}

#[test]
fn a_failing_sink_is_counted_and_stays_in_use() {
    let at_write = |tick| if tick % 2 == 0 { Err("disk on fire".into()) } else { Ok(()) };
    let (fanout, received) = start(Delivery::Every { depth: 8 }, at_write);
    publish(&fanout, 1..=10);
    let (ends, errors) = fanout.close(TIMEOUT);
    assert_eq!(received.ticks(), [1, 3, 5, 7, 9]);
    let counters = &ends[0].counters;
    assert_eq!((counters.n_written, counters.n_failed), (5, 5));
    // The same error five times is reported once.
    assert_eq!(errors.len(), 1);
    assert_eq!((errors[0].sink, errors[0].text.as_str()), ("memory", "disk on fire"));
}

#[test]
fn a_sink_that_panics_is_removed_and_the_others_continue() {
    let at_write = |tick| {
        assert!(tick < 3, "bug at tick {tick}");
        Ok(())
    };
    let (mut fanout, broken) = start(Delivery::Every { depth: 2 }, at_write);
    let healthy = Received::default();
    let sink = Memory { received: healthy.clone(), at_write: |_| Ok(()), at_close: || Ok(()) };
    fanout.add(Box::new(sink), Delivery::Every { depth: 2 }).unwrap();
    // `Every` must not wait for a sink that has panicked: this returns.
    publish(&fanout, 1..=20);
    let (ends, errors) = fanout.close(TIMEOUT);
    assert_eq!(broken.ticks(), [1, 2]);
    assert_eq!(healthy.ticks().len(), 20);
    assert_eq!((ends[0].counters.n_written, ends[0].counters.n_failed), (2, 18));
    assert_eq!(errors.len(), 1);
    assert!(errors[0].text.contains("bug at tick 3"), "{}", errors[0].text);
}

#[test]
fn a_sink_that_hangs_is_abandoned() {
    let (at_write, arrivals, open) = gate();
    let (fanout, _) = start(Delivery::Latest { depth: 4 }, at_write);
    publish(&fanout, 1..=3);
    arrivals.recv_timeout(TIMEOUT).unwrap();
    let (ends, errors) = fanout.close(Duration::from_millis(50));
    assert!(!ends[0].is_closed);
    assert!(errors[0].text.contains("abandoned with 2 results unwritten"), "{}", errors[0].text);
    drop(open); // lets its thread end
}

#[test]
fn an_error_while_closing_is_reported() {
    let mut fanout = Fanout::new();
    let at_close = || Err("no room for the index".into());
    let sink = Memory { received: Received::default(), at_write: |_| Ok(()), at_close };
    fanout.add(Box::new(sink), Delivery::Latest { depth: 4 }).unwrap();
    publish(&fanout, 1..=1);
    let (ends, errors) = fanout.close(TIMEOUT);
    assert!(ends[0].is_closed);
    assert_eq!(errors[0].text, "no room for the index");
}

#[test]
fn queued_packets_are_written_before_closing() {
    let (at_write, arrivals, open) = gate();
    let (fanout, received) = start(Delivery::Latest { depth: 8 }, at_write);
    publish(&fanout, 1..=5);
    arrivals.recv_timeout(TIMEOUT).unwrap();
    (0..5).for_each(|_| open.send(()).unwrap());
    fanout.close(TIMEOUT);
    assert_eq!(received.ticks(), [1, 2, 3, 4, 5]);
}
