//! How the run goes in wall time; measured outside the core, published with the snapshots.

/// How a run goes, seen from outside.
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
    /// What the controller is doing, if the built-in one runs.
    pub phase: String,
    /// Per sink: name, packets written, packets dropped, errors.
    pub sinks: Vec<SinkCounters>,
}

/// What became of the packets given to a sink.
#[derive(Clone, Debug, Default)]
pub struct SinkCounters {
    /// Name of the sink.
    pub name: &'static str,
    /// Packets it wrote.
    pub n_written: u64,
    /// Packets its queue dropped.
    pub n_dropped: u64,
    /// Packets it failed on.
    pub n_failed: u64,
}
