//! Commands that wait for the next tick: one short queue per topic, which drops its oldest command.
//!
//! With a single queue, a flood on one topic would displace the only command of another.

use std::collections::VecDeque;

use crate::command::Command;
use crate::io::source::SourceCounters;

/// Capacity of a topic's queue. Commands are setpoints, so the newest ones matter.
pub const DEPTH: usize = 64;

/// Waiting commands, and counters.
#[derive(Debug, Default)]
pub struct Inbox {
    queues: Vec<VecDeque<(u64, Command)>>,
    n_arrivals: u64,
    counters: SourceCounters,
    last_error: Option<String>,
}

impl Inbox {
    /// Creates empty queues for `n_topics` topics.
    pub fn new(n_topics: usize) -> Self {
        Self { queues: vec![VecDeque::new(); n_topics], ..Self::default() }
    }

    /// Adds a command received on `topic`. If the topic's queue is full, its oldest command is
    /// dropped.
    pub fn push(&mut self, topic: usize, command: Command) {
        let queue = &mut self.queues[topic];
        if queue.len() == DEPTH {
            queue.pop_front();
            self.counters.n_dropped += 1;
        }
        queue.push_back((self.n_arrivals, command));
        self.n_arrivals += 1;
        self.counters.n_received += 1;
    }

    /// Counts a message that could not be decoded.
    pub fn report_malformed(&mut self, error: String) {
        self.counters.n_malformed += 1;
        self.last_error = Some(error);
    }

    /// Takes all waiting commands, in the order of arrival.
    pub fn drain(&mut self) -> Vec<Command> {
        let mut waiting: Vec<_> = self.queues.iter_mut().flat_map(|it| it.drain(..)).collect();
        waiting.sort_by_key(|(arrival, _)| *arrival);
        waiting.into_iter().map(|(_, command)| command).collect()
    }

    /// The counters so far.
    pub fn counters(&self) -> SourceCounters {
        self.counters
    }

    /// Takes the error of the last message that could not be decoded, if any since the last call.
    pub fn take_error(&mut self) -> Option<String> {
        self.last_error.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vacuum(gauge_pa: f64) -> Command {
        Command::Vacuum { gauge_pa }
    }

    /// Oracle: the order in which they were added.
    #[test]
    fn commands_are_drained_in_the_order_of_arrival() {
        let mut inbox = Inbox::new(2);
        for (topic, value) in [(0, 1.0), (1, 2.0), (0, 3.0), (1, 4.0)] {
            inbox.push(topic, vacuum(value));
        }
        assert_eq!(inbox.drain(), [1.0, 2.0, 3.0, 4.0].map(vacuum));
        assert!(inbox.drain().is_empty());
    }

    /// Oracle: a flood drops only its own oldest commands, is counted, and affects no other topic.
    #[test]
    fn a_flood_drops_only_its_own_oldest() {
        let mut inbox = Inbox::new(2);
        inbox.push(1, vacuum(-80e3));
        for i in 0..10_000_u32 {
            inbox.push(0, vacuum(f64::from(i)));
        }
        let left = inbox.drain();
        assert_eq!(left.len(), 1 + DEPTH);
        assert_eq!((left.first(), left.last()), (Some(&vacuum(-80e3)), Some(&vacuum(9999.0))));
        let counters = inbox.counters();
        assert_eq!((counters.n_received, counters.n_dropped), (10_001, 10_000 - DEPTH as u64));
    }
}
