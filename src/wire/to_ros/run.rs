//! Status of the run: clock, statistics, diagnostics.

use super::{WORLD, parts};
use crate::{
    snapshot::{Snapshot, run::RunStatistics, run::SinkCounters},
    wire::messages::{
        diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue},
        jamgrip_msgs::{SinkStatistics, Statistics},
        rosgraph_msgs::Clock,
    },
};

/// Overlap of grains over their diameter, above which the contact law is inaccurate.
const OVERLAP_RATIO_MAX: f64 = 0.1;

/// Simulation time.
pub(super) fn clock(snapshot: &Snapshot) -> Clock {
    Clock { clock: parts::time(snapshot.time_ns) }
}

/// All counters and statistics.
pub(super) fn statistics(snapshot: &Snapshot, run: &RunStatistics) -> Statistics {
    let (jamming, commands) = (&snapshot.jamming, &snapshot.command_counts);
    let sink = |it: &SinkCounters| SinkStatistics {
        name: it.name.to_owned(),
        n_written: it.n_written,
        n_dropped: it.n_dropped,
        n_failed: it.n_failed,
    };
    Statistics {
        header: parts::header(snapshot.time_ns, WORLD),
        sim_time: snapshot.time_ns as f64 * 1e-9,
        wall_time: run.wall_time_s,
        real_time_factor: run.real_time_factor,
        real_time_factor_mean: run.real_time_factor_mean,
        tick: snapshot.tick.0,
        substep: run.substep_s,
        kinetic_energy: jamming.kinetic_energy,
        n_grain_contacts: count(jamming.n_grain_contacts),
        n_membrane_contacts: count(jamming.n_membrane_contacts),
        n_object_contacts: count(jamming.n_object_contacts),
        state_digest: snapshot.digest,
        seed: run.seed,
        n_commands_applied: commands.n_applied,
        n_commands_limited: commands.n_limited,
        n_commands_refused: commands.n_rejected,
        sinks: run.sinks.iter().map(sink).collect(),
        overlap_ratio_max: jamming.overlap_ratio_max,
        membrane_overlap_ratio_max: jamming.membrane_overlap_ratio_max,
        is_valid: is_valid(snapshot),
        phase: run.phase.clone(),
    }
}

fn is_valid(snapshot: &Snapshot) -> bool {
    snapshot.jamming.overlap_ratio_max <= OVERLAP_RATIO_MAX
}

fn count(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// Diagnostics for ROS tools, with a level for each part.
pub(super) fn diagnostics(snapshot: &Snapshot, run: &RunStatistics) -> DiagnosticArray {
    let mut status = vec![simulation(snapshot, run), model(snapshot), commands(snapshot)];
    status.extend(run.sinks.iter().map(sink));
    DiagnosticArray { header: parts::header(snapshot.time_ns, WORLD), status }
}

fn simulation(snapshot: &Snapshot, run: &RunStatistics) -> DiagnosticStatus {
    let values = [
        ("simulation time [s]", format!("{:.3}", snapshot.time_ns as f64 * 1e-9)),
        ("wall time [s]", format!("{:.3}", run.wall_time_s)),
        ("real-time factor", format!("{:.4}", run.real_time_factor)),
        ("phase", run.phase.clone()),
    ];
    diagnostic_status("simulation", DiagnosticStatus::OK, "running", &values)
}

fn model(snapshot: &Snapshot) -> DiagnosticStatus {
    let jamming = &snapshot.jamming;
    let values = [
        ("largest grain overlap / diameter", format!("{:.4}", jamming.overlap_ratio_max)),
        (
            "largest membrane overlap / diameter",
            format!("{:.4}", jamming.membrane_overlap_ratio_max),
        ),
        ("kinetic energy [J]", format!("{:.3e}", jamming.kinetic_energy)),
    ];
    let (level, message) = if is_valid(snapshot) {
        (DiagnosticStatus::OK, "valid")
    } else {
        (DiagnosticStatus::WARN, "grains overlap too much: lower the vacuum or stiffen the grains")
    };
    diagnostic_status("model", level, message, &values)
}

fn commands(snapshot: &Snapshot) -> DiagnosticStatus {
    let counts = &snapshot.command_counts;
    let values = [
        ("applied", counts.n_applied.to_string()),
        ("limited", counts.n_limited.to_string()),
        ("refused", counts.n_rejected.to_string()),
    ];
    let (level, message) = match counts.n_rejected {
        0 => (DiagnosticStatus::OK, "none rejected"),
        _ => (DiagnosticStatus::WARN, "some rejected"),
    };
    diagnostic_status("commands", level, message, &values)
}

fn sink(counters: &SinkCounters) -> DiagnosticStatus {
    let values = [
        ("written", counters.n_written.to_string()),
        ("dropped", counters.n_dropped.to_string()),
        ("failed", counters.n_failed.to_string()),
    ];
    let (level, message) = match (counters.n_failed, counters.n_dropped) {
        (0, 0) => (DiagnosticStatus::OK, "complete"),
        (0, _) => (DiagnosticStatus::WARN, "too slow: results were dropped"),
        _ => (DiagnosticStatus::ERROR, "failed to write"),
    };
    diagnostic_status(counters.name, level, message, &values)
}

fn diagnostic_status(
    part: &str,
    level: u8,
    message: &str,
    values: &[(&str, String)],
) -> DiagnosticStatus {
    let value =
        |(key, value): &(&str, String)| KeyValue { key: (*key).to_owned(), value: value.clone() };
    DiagnosticStatus {
        level,
        name: format!("jamgrip: {part}"),
        message: message.to_owned(),
        hardware_id: "simulation".to_owned(),
        values: values.iter().map(value).collect(),
    }
}
