//! Where questions wait for the time between two ticks.

use std::collections::VecDeque;

use crate::io::server::{ServerCounters, ServiceRequest};

/// Questions that can wait. A client asks again; one that floods hurts itself.
pub const DEPTH: usize = 256;

/// Waiting questions and what was counted.
#[derive(Debug, Default)]
pub struct Queue {
    calls: VecDeque<ServiceRequest>,
    counters: ServerCounters,
    last_fault: Option<String>,
}

impl Queue {
    /// Keeps a question if there is room.
    pub fn offer(&mut self, call: ServiceRequest) {
        self.counters.n_received += 1;
        if self.calls.len() < DEPTH {
            self.calls.push_back(call);
        } else {
            self.counters.n_rejected += 1;
        }
    }

    /// At most `most` questions, oldest first.
    pub fn take(&mut self, most: usize) -> Vec<ServiceRequest> {
        let n = most.min(self.calls.len());
        self.calls.drain(..n).collect()
    }

    /// True if nothing waits.
    pub fn is_empty(&self) -> bool {
        self.calls.is_empty()
    }

    /// Counts a question that could not be read.
    pub fn report_malformed(&mut self, fault: String) {
        self.counters.n_malformed += 1;
        self.last_fault = Some(fault);
    }

    /// What was counted so far.
    pub fn counters(&self) -> ServerCounters {
        self.counters
    }

    /// What was wrong with the last question that could not be read; asking clears it.
    pub fn take_fault(&mut self) -> Option<String> {
        self.last_fault.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{io::server::RequestId, wire::cdr::Cdr};

    fn call(number: i64) -> ServiceRequest {
        let asker = RequestId { offer: 0, writer: [0; 16], number, header: None };
        ServiceRequest { asker, body: Cdr::of(&number) }
    }

    /// Oracle: the contract. The first that came are answered, in order; the flood is counted.
    #[test]
    fn a_flood_pushes_out_nobody_who_waits() {
        let mut queue = Queue::default();
        (0..10_000).for_each(|number| queue.offer(call(number)));
        let first: Vec<i64> = queue.take(3).iter().map(|it| it.asker.number).collect();
        assert_eq!(first, [0, 1, 2]);
        assert_eq!(queue.take(usize::MAX).len(), DEPTH - 3);
        let counters = queue.counters();
        assert_eq!((counters.n_received, counters.n_rejected), (10_000, 10_000 - DEPTH as u64));
    }
}
