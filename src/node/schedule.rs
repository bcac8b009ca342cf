//! What is due at which tick.

pub use crate::snapshot::Parts;
use crate::{scene::Outputs, snapshot::due};

/// Rates in simulated time, rounded to ticks.
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    membrane: Interval,
    grains: Interval,
    contacts: Interval,
    statistics: Interval,
    /// Rate of checkpoints (Hz), and the length of a tick (ns).
    checkpoints: Option<(f64, u64)>,
}

impl Schedule {
    /// The rates of `outputs` for ticks of `tick_ns` (ns).
    pub fn new(outputs: &Outputs, tick_ns: u64) -> Self {
        let interval = |rate| Interval::new(rate, tick_ns);
        Self {
            membrane: interval(outputs.membrane_rate),
            grains: interval(outputs.grains_rate),
            contacts: interval(outputs.contacts_rate),
            statistics: interval(outputs.statistics_rate),
            checkpoints: outputs.bag.checkpoint_rate.map(|rate| (rate, tick_ns)),
        }
    }

    /// Parts due at `time_ns`, the end of a tick (ns).
    pub fn parts(&self, time_ns: u64) -> Parts {
        Parts {
            membrane: self.membrane.is_due(time_ns),
            grains: self.grains.is_due(time_ns),
            contacts: self.contacts.is_due(time_ns),
        }
    }

    /// True if a checkpoint is due at `time_ns`, in addition to the one at the start.
    pub fn checkpoint(&self, time_ns: u64) -> bool {
        self.checkpoints.is_some_and(|(rate, tick_ns)| due::is_due(rate, time_ns, tick_ns))
    }

    /// True if statistics are due at `time_ns`.
    pub fn statistics(&self, time_ns: u64) -> bool {
        self.statistics.is_due(time_ns)
    }
}

#[derive(Clone, Copy, Debug)]
struct Interval {
    period_ns: u64,
    tick_ns: u64,
}

impl Interval {
    fn new(rate: f64, tick_ns: u64) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "it saturates: slower than ever snapshot"
        )]
        #[expect(clippy::cast_sign_loss, reason = "rates are checked to be positive")]
        let period_ns = (1e9 / rate).round() as u64;
        Self { period_ns: period_ns.max(tick_ns), tick_ns }
    }

    /// Due in the first tick, then in the first tick of each period.
    fn is_due(self, time_ns: u64) -> bool {
        let Some(start_ns) = time_ns.checked_sub(self.tick_ns) else { return true };
        start_ns % self.period_ns < self.tick_ns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: counting. 30 Hz over 10 s are 300 times, although 33.3 ms is not a whole number of ticks.
    #[test]
    fn rates_are_kept_on_average() {
        let count = |rate| {
            let interval = Interval::new(rate, 1_000_000);
            (1..=10_000_u64).filter(|tick| interval.is_due(tick * 1_000_000)).count()
        };
        assert_eq!(count(30.0), 300);
        assert_eq!(count(1000.0), 10_000);
        assert_eq!(count(2.0), 20);
        assert_eq!(count(0.01), 1);
    }
}
