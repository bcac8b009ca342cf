//! Requests that wait until the next tick is over.

use std::collections::VecDeque;

use crate::io::server::{ServerCounters, ServiceRequest};

/// Capacity of the queue. Clients can retry; a client that floods the queue only hurts itself.
pub const DEPTH: usize = 256;

/// Waiting requests, and counters.
#[derive(Debug, Default)]
pub struct RequestQueue {
    requests: VecDeque<ServiceRequest>,
    counters: ServerCounters,
    last_error: Option<String>,
}

impl RequestQueue {
    /// Adds a request, or counts it as rejected if the queue is full.
    pub fn push(&mut self, request: ServiceRequest) {
        self.counters.n_received += 1;
        if self.requests.len() < DEPTH {
            self.requests.push_back(request);
        } else {
            self.counters.n_rejected += 1;
        }
    }

    /// Takes at most `n_max` requests, oldest first.
    pub fn take(&mut self, n_max: usize) -> Vec<ServiceRequest> {
        let n = n_max.min(self.requests.len());
        self.requests.drain(..n).collect()
    }

    /// True if no request waits.
    pub fn is_empty(&self) -> bool {
        self.requests.is_empty()
    }

    /// Counts a request that could not be decoded.
    pub fn report_malformed(&mut self, error: String) {
        self.counters.n_malformed += 1;
        self.last_error = Some(error);
    }

    /// The counters so far.
    pub fn counters(&self) -> ServerCounters {
        self.counters
    }

    /// Takes the error of the last request that could not be decoded, if any since the last call.
    pub fn take_error(&mut self) -> Option<String> {
        self.last_error.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{io::server::RequestId, wire::cdr::Cdr};

    fn request(number: i64) -> ServiceRequest {
        let id = RequestId { service: 0, writer: [0; 16], number, header: None };
        ServiceRequest { id, body: Cdr::of(&number) }
    }

    /// Oracle: the first requests are served in order; the flood is counted.
    #[test]
    fn a_flood_displaces_no_waiting_request() {
        let mut queue = RequestQueue::default();
        (0..10_000).for_each(|number| queue.push(request(number)));
        let first: Vec<i64> = queue.take(3).iter().map(|it| it.id.number).collect();
        assert_eq!(first, [0, 1, 2]);
        assert_eq!(queue.take(usize::MAX).len(), DEPTH - 3);
        let counters = queue.counters();
        assert_eq!((counters.n_received, counters.n_rejected), (10_000, 10_000 - DEPTH as u64));
    }
}
