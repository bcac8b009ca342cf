//! Where commands wait for the next tick: a short queue per topic, the oldest goes first.
//!
//! One queue for all would let a flood on one topic push out a lone command on another.

use std::collections::VecDeque;

use crate::command::Command;
use crate::io::source::SourceCounters;

/// Commands of one topic that can wait; commands are set-points, so the newest matter.
pub const DEPTH: usize = 64;

/// Waiting commands and what was counted.
#[derive(Debug, Default)]
pub struct Inbox {
    queues: Vec<VecDeque<(u64, Command)>>,
    n_arrivals: u64,
    counters: SourceCounters,
    last_fault: Option<String>,
}

impl Inbox {
    /// Empty queues for `n_topics` topics.
    pub fn new(n_topics: usize) -> Self {
        Self { queues: vec![VecDeque::new(); n_topics], ..Self::default() }
    }

    /// Keeps a command that came on `topic`; the topic's oldest goes if its queue is full.
    pub fn offer(&mut self, topic: usize, command: Command) {
        let queue = &mut self.queues[topic];
        if queue.len() == DEPTH {
            queue.pop_front();
            self.counters.n_dropped += 1;
        }
        queue.push_back((self.n_arrivals, command));
        self.n_arrivals += 1;
        self.counters.n_received += 1;
    }

    /// Counts a message that could not be read.
    pub fn refuse(&mut self, fault: String) {
        self.counters.n_malformed += 1;
        self.last_fault = Some(fault);
    }

    /// Everything that waits, in the order of arrival.
    pub fn drain(&mut self) -> Vec<Command> {
        let mut waiting: Vec<_> = self.queues.iter_mut().flat_map(|it| it.drain(..)).collect();
        waiting.sort_by_key(|(arrival, _)| *arrival);
        waiting.into_iter().map(|(_, command)| command).collect()
    }

    /// What was counted so far.
    pub fn counters(&self) -> SourceCounters {
        self.counters
    }

    /// What was wrong with the last message that could not be read; asking clears it.
    pub fn take_fault(&mut self) -> Option<String> {
        self.last_fault.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vacuum(gauge_pa: f64) -> Command {
        Command::Vacuum { gauge_pa }
    }

    /// Oracle: the order in which they were offered.
    #[test]
    fn commands_leave_in_the_order_they_came() {
        let mut inbox = Inbox::new(2);
        for (topic, value) in [(0, 1.0), (1, 2.0), (0, 3.0), (1, 4.0)] {
            inbox.offer(topic, vacuum(value));
        }
        assert_eq!(inbox.drain(), [1.0, 2.0, 3.0, 4.0].map(vacuum));
        assert!(inbox.drain().is_empty());
    }

    /// Oracle: the contract: a flood loses its own oldest, is counted, and harms no other topic.
    #[test]
    fn a_flood_pushes_out_only_its_own_oldest() {
        let mut inbox = Inbox::new(2);
        inbox.offer(1, vacuum(-80e3));
        for i in 0..10_000_u32 {
            inbox.offer(0, vacuum(f64::from(i)));
        }
        let left = inbox.drain();
        assert_eq!(left.len(), 1 + DEPTH);
        assert_eq!((left.first(), left.last()), (Some(&vacuum(-80e3)), Some(&vacuum(9999.0))));
        let counters = inbox.counters();
        assert_eq!((counters.n_received, counters.n_dropped), (10_001, 10_000 - DEPTH as u64));
    }
}
