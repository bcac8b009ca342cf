//! How far the packets of a run have been published, so that responses can wait for them.

use std::{
    sync::{Condvar, Mutex, PoisonError},
    time::Duration,
};

/// Number of the last published packet. Packets count from 1.
#[derive(Debug, Default)]
pub struct PublishedUpTo {
    last: Mutex<u64>,
    changed: Condvar,
}

impl PublishedUpTo {
    /// Reports that packet `number` has been published.
    pub fn report(&self, number: u64) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        *last = number.max(*last);
        self.changed.notify_all();
    }

    /// Number of the last published packet.
    pub fn last(&self) -> u64 {
        *self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until packet `number` is published, at most `timeout`, in case its publisher has died.
    pub fn wait_for(&self, number: u64, timeout: Duration) {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.changed.wait_timeout_while(last, timeout, |last| *last < number);
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }
}
