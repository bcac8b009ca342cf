//! Verification: simulates a recorded run again and compares every digest.

use super::{
    compatibility,
    recorded_run::{RecordedRun, ReplayError},
    segment::{self, Difference, Start},
    workers::{CpuBudget, Workers},
};
use crate::{
    bag::recording::RecordedChange,
    base::parallel,
    command::change::Change,
    cosim::compile::Compiled,
    host::{cache::Cache, clock::Stopwatch, progress_bar::Progress, shutdown::Shutdown},
    node::start::{self, StartError, Started},
    session::Session,
};

/// Options of the verification.
pub struct Options<'a> {
    /// How to divide the processors; it does not affect the result.
    pub cpu_budget: CpuBudget,
    /// True to settle a new start state from scene and seed; false to start from the recorded one.
    pub settles: bool,
    /// Simulation time from which to verify (ns); it starts at the last checkpoint before.
    pub from_ns: u64,
    /// Simulation time at which to end (ns).
    pub to_ns: Option<u64>,
    /// Cache of settled start states, for recordings without checkpoints.
    pub cache: Cache,
    /// Receives the progress.
    pub progress: &'a Progress,
    /// Set when the user requests to stop.
    pub shutdown: &'a Shutdown,
}

/// The result of the verification.
#[derive(Clone, Debug)]
pub struct VerifyReport {
    /// Number of simulated ticks.
    pub n_ticks: u64,
    /// Number of compared digests.
    pub n_compared: u64,
    /// Number of checkpoints whose whole state was compared.
    pub n_checkpoints: u64,
    /// The first difference.
    pub first_difference: Option<Difference>,
    /// Simulation time over wall-clock time, of all segments together.
    pub real_time_factor: f64,
    /// Number of parallel simulations, and threads of each.
    pub jobs_and_threads: (usize, usize),
    /// The first tick.
    pub start_tick: u64,
    /// Remarks about the recording, for the user.
    pub remarks: Vec<String>,
    /// True if the user stopped the verification.
    pub is_interrupted: bool,
}

impl VerifyReport {
    /// True if at least one digest was compared and everything was equal.
    pub fn is_equal(&self) -> bool {
        self.first_difference.is_none() && 0 < self.n_compared && !self.is_interrupted
    }

    /// The report as JSON.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "ticks": self.n_ticks,
            "first_difference": self.first_difference.map(|it| it.tick),
            "real_time_factor": self.real_time_factor,
            "compared": self.n_compared,
            "checkpoints": self.n_checkpoints,
            "remarks": self.remarks,
        })
    }
}

/// Verifies a recorded run.
///
/// # Errors
/// If the run cannot be simulated again. A difference is not an error.
pub fn verify(run: &RecordedRun, options: &Options<'_>) -> Result<VerifyReport, ReplayError> {
    let (history, tick_ns) = (&run.history, run.scene.time.tick_ns);
    let mut remarks = remarks(run);
    if options.settles {
        remarks.extend(run.history.changes.iter().filter_map(not_settled));
    }
    let start = start(run, options, &mut remarks)?;
    let start_tick = start.tick();
    // After a gap, commands are missing.
    let last = history.gap_after.unwrap_or(u64::MAX).min(history.last_tick());
    let last = options.to_ns.map_or(last, |end_ns| last.min(end_ns / tick_ns));
    let mut segments = segment::split(start.clone(), last, &history.checkpoints);
    let (n_jobs, n_threads) = options.cpu_budget.jobs_and_threads(segments.len());
    if n_jobs == 1 {
        segments = segment::split(start, last, &[]);
    }
    options.progress.running(Some(last * tick_ns));
    let stopwatch = Stopwatch::start();
    let (progress, shutdown) = (options.progress, options.shutdown);
    let workers = Workers { run, script: run.script()?, n_jobs, n_threads, progress, shutdown };
    let result = workers.simulate(&segments)?;
    options.progress.end();
    let wall_s = stopwatch.total_s();
    remarks.extend(result.remarks);
    if result.first_difference.is_some() {
        remarks.extend(possible_causes(run));
    }
    Ok(VerifyReport {
        n_ticks: result.n_ticks,
        n_compared: result.n_compared,
        n_checkpoints: result.n_checkpoints,
        first_difference: result.first_difference,
        real_time_factor: super::seconds(result.n_ticks * tick_ns) / wall_s.max(1e-9),
        jobs_and_threads: (n_jobs, n_threads),
        start_tick,
        remarks,
        is_interrupted: result.is_interrupted,
    })
}

/// A remark about a scene that was loaded later, when start states are settled again.
fn not_settled(change: &RecordedChange) -> Option<String> {
    let RecordedChange { tick, what, .. } = change;
    matches!(Change::from_bytes(&change.change), Ok(Change::LoadScene(_))).then(|| {
        format!("after tick {tick}: {what}: this scene starts as recorded; only the first scene is settled again")
    })
}

/// The start of the verification: the checkpoint before the requested time, or a settled start.
fn start<'a>(
    run: &'a RecordedRun,
    options: &Options<'_>,
    remarks: &mut Vec<String>,
) -> Result<Start<'a>, ReplayError> {
    // A run that branched from another one does not start at tick 0.
    let first = run.history.digests.first().map_or(0, |(tick, _)| *tick);
    let tick = first.max(options.from_ns / run.scene.time.tick_ns);
    let recorded = run.history.checkpoint_before(tick).filter(|_| !options.settles);
    if let Some(checkpoint) = recorded {
        return Ok(Start::Recorded(checkpoint));
    }
    if run.history.is_every_tick && 1 < first {
        return Err(ReplayError::NoStart { path: run.path.clone(), tick: first });
    }
    let (_, n_threads) = options.cpu_budget.jobs_and_threads(1);
    let pool = parallel::ThreadPool::new(n_threads).map_err(StartError::from)?;
    let compiled = Compiled::new(&run.scene, &pool)?;
    let session = if options.settles {
        let on_progress = &mut |it: crate::physics::fill::Progress| {
            options.progress.settling(it.stage, it.share);
        };
        Session::settle(compiled, on_progress)?
    } else {
        let started = start::start(compiled, &options.cache, options.progress);
        let Started { session, origin } = started.map_err(ReplayError::from)?;
        let start =
            format!("the recording has no checkpoint: the start was {origin} from the scene");
        remarks.push(start);
        session
    };
    let bytes = session.save().expect("a start has the scene's own objects");
    Ok(Start::Saved(session.run_tick().0, bytes.into()))
}

/// Problems of the recording that are known before the simulation.
fn remarks(run: &RecordedRun) -> Vec<String> {
    let history = &run.history;
    let mut remarks: Vec<String> = history
        .damages
        .iter()
        .map(|(file, damage)| format!("{}: {damage}", file.display()))
        .collect();
    if let Some(tick) = history.broken_at {
        remarks.push(format!(
            "the chain of digests is broken at tick {tick}: a command, a digest or the scene was \
             altered after it was recorded"
        ));
    }
    if let Some(tick) = history.gap_after {
        remarks.push(format!(
            "ticks after {tick} are missing (because of a full queue or damage): \
             the run can be verified up to there"
        ));
    }
    if !history.is_every_tick {
        let n = history.digests.len();
        remarks.push(format!(
            "recorded by jamgrip {}, which did not record the digest of every tick: \
             only the {n} digests in its statistics can be compared",
            run.recording.version()
        ));
    }
    remarks
}

/// Possible causes of a difference.
fn possible_causes(run: &RecordedRun) -> Vec<String> {
    let version = run.recording.version();
    let mut result = vec![format!(
        "recorded by jamgrip {version} on {}, simulated by {} on {} {}",
        run.recording.facts.get("machine").map_or("an unknown machine", String::as_str),
        env!("CARGO_PKG_VERSION"),
        std::env::consts::OS,
        std::env::consts::ARCH
    )];
    let changes = compatibility::changes_since(version);
    result.extend(changes.into_iter().map(|it| format!("results have changed since: {it}")));
    result
}
