//! Statistics of a run in wall time, published with the snapshots.

/// Statistics of a run.
#[derive(Clone, Debug, Default)]
pub struct RunStatistics {
    /// Wall time since the first tick (s).
    pub wall_time_s: f64,
    /// Simulated over wall time, over the last second of wall time.
    pub real_time_factor: f64,
    /// Simulated over wall time, since the first tick.
    pub real_time_factor_mean: f64,
    /// Length of a substep (s).
    pub substep_s: f64,
    /// Seed of the scene.
    pub seed: u64,
    /// Phase of the built-in controller; empty without one.
    pub phase: String,
    /// Counters of the sinks.
    pub sinks: Vec<SinkCounters>,
}

/// Counters of a sink.
#[derive(Clone, Debug, Default)]
pub struct SinkCounters {
    /// Name of the sink.
    pub name: &'static str,
    /// Packets written.
    pub n_written: u64,
    /// Packets dropped by its queue.
    pub n_dropped: u64,
    /// Packets that could not be written.
    pub n_failed: u64,
}
