//! A saved session with its tick.

use crate::base::Tick;

/// A saved session, between two ticks.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    /// Ticks since the start of the run.
    pub tick: Tick,
    /// Simulated time since the start of the run (ns).
    pub time_ns: u64,
    /// Digest of the whole state.
    pub digest: u64,
    /// The input of `Session::resume`.
    pub bytes: Vec<u8>,
}
