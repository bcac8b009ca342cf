//! Simulated time, counted in ticks instead of summed in seconds, so it cannot drift.

/// A number of whole ticks since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tick(pub u64);

impl Tick {
    /// The tick after this one.
    pub fn next(self) -> Self {
        Self(self.0 + 1)
    }

    /// Simulated time (ns) at the end of this tick, for ticks of `tick_ns` nanoseconds.
    pub fn time_ns(self, tick_ns: u64) -> u64 {
        self.0 * tick_ns
    }
}
