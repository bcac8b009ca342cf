//! Summary of a run, as rows of text and as JSON.

use serde_json::{Map, Value, json};

use super::lift_monitor::LiftMetrics;
use crate::{
    command::CommandCounts,
    io::{sink::SinkCounters, source::SourceCounters},
};

/// Summary of a run.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Name of the scene.
    pub scene: String,
    /// Seed of the scene.
    pub seed: u64,
    /// Why it ended.
    pub ending: String,
    /// Metrics of the lift.
    pub metrics: LiftMetrics,
    /// Simulated over wall time.
    pub real_time_factor: f64,
    /// Wall time of all ticks (s).
    pub wall_time_s: f64,
    /// Wall time from the start of the program to the first tick (s).
    pub start_time_s: f64,
    /// Where the settled state came from: `cached` or `settled`.
    pub start_state: &'static str,
    /// Simulated time (s).
    pub sim_time_s: f64,
    /// Length of a substep (s).
    pub substep_s: f64,
    /// Number of grains.
    pub n_grains: usize,
    /// Number of vertices of the membrane.
    pub n_vertices: usize,
    /// Digest of the last state.
    pub state_digest: u64,
    /// Folder of the recording.
    pub bag: Option<String>,
    /// Counters of the outputs.
    pub sinks: Vec<SinkCounters>,
    /// Counters of the external sources, by name.
    pub sources: Vec<(&'static str, SourceCounters)>,
    /// Commands by outcome.
    pub commands: CommandCounts,
}

impl Summary {
    /// The summary as JSON. Numbers that are not finite become null.
    pub fn to_json(&self) -> Value {
        let of_sinks = |count: fn(&SinkCounters) -> u64| -> Map<String, Value> {
            self.sinks.iter().map(|it| (it.name.to_owned(), count(it).into())).collect()
        };
        let of_sources = |count: fn(&SourceCounters) -> u64| -> Map<String, Value> {
            self.sources.iter().map(|(name, it)| ((*name).to_owned(), count(it).into())).collect()
        };
        json!({
            "scene": self.scene,
            "seed": self.seed,
            "ending": self.ending,
            "lift_height_m": self.metrics.lift_height,
            "held": self.metrics.is_held(),
            "hold_time_s": self.metrics.hold_time,
            "peak_push_force_n": self.metrics.peak_push_force,
            "peak_pull_force_n": self.metrics.peak_pull_force,
            "real_time_factor": self.real_time_factor,
            "wall_time_s": self.wall_time_s,
            "start_time_s": self.start_time_s,
            "start_state": self.start_state,
            "sim_time_s": self.sim_time_s,
            "substep_s": self.substep_s,
            "n_grains": self.n_grains,
            "n_vertices": self.n_vertices,
            "state_digest": format!("{:016x}", self.state_digest),
            "bag": self.bag,
            "written": of_sinks(|it| it.n_written),
            "dropped": of_sinks(|it| it.n_dropped),
            "failed": of_sinks(|it| it.n_failed),
            "received": of_sources(|it| it.n_received),
            "malformed": of_sources(|it| it.n_malformed),
            "commands": {
                "applied": self.commands.n_applied,
                "limited": self.commands.n_limited,
                "refused": self.commands.n_rejected,
            },
            "validity": {
                "is_within_limits": self.metrics.is_valid(),
                "overlap_ratio_max": self.metrics.overlap_ratio_max,
                "overlap_ratio_limit": self.metrics.overlap_limit(),
                "membrane_overlap_ratio_max": self.metrics.membrane_overlap_ratio_max,
            },
        })
    }

    fn outcome(&self) -> &'static str {
        match (self.metrics.hold_time == 0.0, self.metrics.is_held()) {
            (true, _) => "never held up",
            (false, true) => "held",
            (false, false) => "dropped or not lifted",
        }
    }

    /// Name and value of the most important results, as text.
    pub fn rows(&self) -> Vec<[String; 2]> {
        let metrics = &self.metrics;
        let row = |name: &str, value: String| [name.to_owned(), value];
        let mut rows = vec![
            row("ended", self.ending.clone()),
            row("peak push force", format!("{:.2} N", metrics.peak_push_force)),
            row("lift height", format!("{:.1} mm", metrics.lift_height * 1e3)),
            row("object", self.outcome().to_owned()),
            row("simulated", format!("{:.3} s", self.sim_time_s)),
            row("real-time factor", format!("{:.3}", self.real_time_factor)),
            row(
                "grain overlap",
                format!(
                    "{:.1} % of the diameter, contact law good to {:.0} %",
                    metrics.overlap_ratio_max * 1e2,
                    metrics.overlap_limit() * 1e2
                ),
            ),
            row("state digest", format!("{:016x}", self.state_digest)),
        ];
        for sink in &self.sinks {
            let SinkCounters { n_written, n_dropped, n_failed, .. } = sink;
            let text = format!("{n_written} written, {n_dropped} dropped, {n_failed} failed");
            rows.push(row(sink.name, text));
        }
        rows.push(row("recorded in", self.bag.clone().unwrap_or_else(|| "none".to_owned())));
        rows
    }
}
