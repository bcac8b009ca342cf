//! How far the packets of a run have been published, so that answers can stay behind them.

use std::{
    sync::{Condvar, Mutex, PoisonError},
    time::Duration,
};

/// Number of the last packet that was published. Packets count from 1.
#[derive(Debug, Default)]
pub struct PublishedUpTo {
    last: Mutex<u64>,
    changed: Condvar,
}

impl PublishedUpTo {
    /// The packet of this number has been published.
    pub fn note(&self, number: u64) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        *last = number.max(*last);
        self.changed.notify_all();
    }

    /// Number of the last packet that was published.
    pub fn last(&self) -> u64 {
        *self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a packet, at most `patience`: a publisher that died holds nobody up for ever.
    pub fn wait_for(&self, number: u64, patience: Duration) {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.changed.wait_timeout_while(last, patience, |last| *last < number);
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }
}
