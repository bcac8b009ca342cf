//! All that is needed to go on, as bytes that nobody outside reads.

use crate::base::Tick;

/// A run between two ticks.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    /// The tick of the run that ended.
    pub tick: Tick,
    /// Time of the run at its end (ns).
    pub time_ns: u64,
    /// Digest of the whole state.
    pub digest: u64,
    /// What `Session::resume` reads.
    pub bytes: Vec<u8>,
}
