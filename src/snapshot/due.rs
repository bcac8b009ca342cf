//! What is due at which tick. It depends on simulated time alone, so nothing can drift.

/// True if a multiple of 1/rate lies in the tick of `tick_ns` nanoseconds that ends at `time_ns`.
pub fn is_due(rate_hz: f64, time_ns: u64, tick_ns: u64) -> bool {
    count(rate_hz, time_ns.saturating_sub(tick_ns) as f64) < count(rate_hz, time_ns as f64)
}

/// True for the first instant of `rate_hz` after each multiple of 1/`slower_hz`.
pub fn is_first_of(rate_hz: f64, slower_hz: f64, time_ns: u64) -> bool {
    let (period_ns, instant) = (1e9 / rate_hz, count(rate_hz, time_ns as f64));
    let count_at = |instant: f64| count(slower_hz, instant * period_ns);
    rate_hz <= slower_hz || count_at(instant - 1.0) < count_at(instant)
}

/// Number of multiples of 1/rate in (0, time]. A tolerance of a nanosecond keeps multiples that
/// rounding put just above.
fn count(rate_hz: f64, time_ns: f64) -> f64 {
    ((time_ns + 1.0) * rate_hz * 1e-9).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK_NS: u64 = 1_000_000;

    /// How often in ten seconds something is due.
    fn n_due(is_due: impl Fn(u64) -> bool) -> usize {
        (1..=10_000).filter(|tick| is_due(tick * TICK_NS)).count()
    }

    #[test]
    fn rate_is_kept_over_ten_seconds() {
        for (rate, expected) in [(1000.0, 10_000), (333.0, 3330), (30.0, 300), (7.5, 75), (0.3, 3)]
        {
            // Oracle: rate times time.
            assert_eq!(n_due(|time_ns| is_due(rate, time_ns, TICK_NS)), expected, "{rate} Hz");
        }
    }

    #[test]
    fn slower_rate_selects_its_share() {
        for (rate, slower, expected) in [(30.0, 10.0, 100), (25.0, 10.0, 100), (5.0, 10.0, 50)] {
            let is_picked =
                |time_ns| is_due(rate, time_ns, TICK_NS) && is_first_of(rate, slower, time_ns);
            // Oracle: the smaller of the two rates, times time.
            assert_eq!(n_due(is_picked), expected, "{slower} Hz of {rate} Hz");
        }
    }
}
