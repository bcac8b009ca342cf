//! Is every tick as it was recorded? The run is simulated again, and every digest compared.

use super::{
    compatibility,
    recorded_run::{RecordedRun, ReplayError},
    segment::{self, Difference, Start},
    workers::{CpuBudget, Workers},
};
use crate::{
    bag::recording::Alteration,
    base::parallel,
    command::change::Change,
    cosim::compile::Compiled,
    host::{cache::Cache, clock::Stopwatch, progress_bar::Progress, shutdown::Shutdown},
    node::start::{self, StartError, Started},
    session::Session,
};

/// How to verify.
pub struct Options<'a> {
    /// How the machine is shared out; it does not change the result.
    pub hands: CpuBudget,
    /// True fills the bag anew from scene and seed; false takes the start that was recorded.
    pub settles: bool,
    /// Simulated time from which on to verify (ns); from the last checkpoint before it.
    pub from_ns: u64,
    /// Simulated time at which to end (ns).
    pub to_ns: Option<u64>,
    /// Where settled start states are kept, for recordings without checkpoints.
    pub cache: Cache,
    /// What a person sees.
    pub progress: &'a Progress,
    /// Whether someone asked to end.
    pub shutdown: &'a Shutdown,
}

/// What verification found.
#[derive(Clone, Debug)]
pub struct VerifyReport {
    /// Ticks that were simulated.
    pub n_ticks: u64,
    /// Digests that were compared.
    pub n_compared: u64,
    /// Checkpoints that were compared, all of the state to the bit.
    pub n_checkpoints: u64,
    /// The first that differed.
    pub first_difference: Option<Difference>,
    /// Simulated over wall time, of all parts together.
    pub real_time_factor: f64,
    /// Parts that were simulated at a time, and threads of each.
    pub shared_out: (usize, usize),
    /// The tick it began with.
    pub start_tick: u64,
    /// What is to be said about the recording, for people.
    pub remarks: Vec<String>,
    /// True if someone asked to end before the end.
    pub is_interrupted: bool,
}

impl VerifyReport {
    /// True if something was compared and all of it was equal.
    pub fn is_equal(&self) -> bool {
        self.first_difference.is_none() && 0 < self.n_compared && !self.is_interrupted
    }

    /// The verdict for machines.
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

/// Simulates a recording again.
///
/// # Errors
/// If it cannot be run again. A difference is no error.
pub fn verify(again: &RecordedRun, options: &Options<'_>) -> Result<VerifyReport, ReplayError> {
    let (course, tick_ns) = (&again.course, again.scene.time.tick_ns);
    let mut remarks = remarks(again);
    if options.settles {
        remarks.extend(again.course.changes.iter().filter_map(not_settled));
    }
    let start = start(again, options, &mut remarks)?;
    let start_tick = start.tick();
    // Beyond a gap commands are missing.
    let last = course.gap_after.unwrap_or(u64::MAX).min(course.last_tick());
    let last = options.to_ns.map_or(last, |end_ns| last.min(end_ns / tick_ns));
    let mut parts = segment::cut(start.clone(), last, &course.checkpoints);
    let (n_jobs, n_threads) = options.hands.shared_out(parts.len());
    if n_jobs == 1 {
        parts = segment::cut(start, last, &[]);
    }
    options.progress.running(Some(last * tick_ns));
    let stopwatch = Stopwatch::start();
    let (progress, shutdown) = (options.progress, options.shutdown);
    let workers = Workers { again, script: again.script()?, n_jobs, n_threads, progress, shutdown };
    let found = workers.simulate(&parts)?;
    options.progress.end();
    let wall_s = stopwatch.total_s();
    remarks.extend(found.remarks);
    if found.first_difference.is_some() {
        remarks.extend(blame(again));
    }
    Ok(VerifyReport {
        n_ticks: found.n_ticks,
        n_compared: found.n_compared,
        n_checkpoints: found.n_checkpoints,
        first_difference: found.first_difference,
        real_time_factor: super::seconds(found.n_ticks * tick_ns) / wall_s.max(1e-9),
        shared_out: (n_jobs, n_threads),
        start_tick,
        remarks,
        is_interrupted: found.is_left,
    })
}

/// What is to be said of a scene that was loaded later, when bags are filled anew.
fn not_settled(change: &Alteration) -> Option<String> {
    let Alteration { tick, what, .. } = change;
    matches!(Change::from_bytes(&change.change), Ok(Change::LoadScene(_))).then(|| {
        format!("after tick {tick}: {what}: it begins as recorded, only the first is filled anew")
    })
}

/// The start, or the checkpoint before the time asked for.
fn start<'a>(
    again: &'a RecordedRun,
    options: &Options<'_>,
    remarks: &mut Vec<String>,
) -> Result<Start<'a>, ReplayError> {
    // A run that branched off another begins later than at zero.
    let first = again.course.digests.first().map_or(0, |(tick, _)| *tick);
    let tick = first.max(options.from_ns / again.scene.time.tick_ns);
    let recorded = again.course.checkpoint_before(tick).filter(|_| !options.settles);
    if let Some(place) = recorded {
        return Ok(Start::Recorded(place));
    }
    if again.course.is_every_tick && 1 < first {
        return Err(ReplayError::NoStart { path: again.path.clone(), tick: first });
    }
    let (_, n_threads) = options.hands.shared_out(1);
    let pool = parallel::ThreadPool::new(n_threads).map_err(StartError::from)?;
    let compiled = Compiled::new(&again.scene, &pool)?;
    let session = if options.settles {
        let on_progress = &mut |it: crate::physics::fill::Progress| {
            options.progress.settling(it.stage, it.share);
        };
        Session::settle(compiled, on_progress)?
    } else {
        let started = start::start(compiled, &options.cache, options.progress);
        let Started { session, origin } = started.map_err(ReplayError::from)?;
        let start = format!("no checkpoint is recorded: the start was {origin} from the scene");
        remarks.push(start);
        session
    };
    let bytes = session.save().expect("a start has the scene's own objects");
    Ok(Start::Made(session.run_tick().0, bytes.into()))
}

/// What is wrong with a recording before anything is simulated.
fn remarks(again: &RecordedRun) -> Vec<String> {
    let course = &again.course;
    let mut remarks: Vec<String> = course
        .damages
        .iter()
        .map(|(file, damage)| format!("{}: {damage}", file.display()))
        .collect();
    if let Some(tick) = course.broken_at {
        remarks.push(format!(
            "the chain of digests is broken at tick {tick}: a command, a digest or the scene was \
             altered after it was recorded"
        ));
    }
    if let Some(tick) = course.gap_after {
        remarks.push(format!(
            "ticks after {tick} are missing (a queue that was full, or damage): \
             it can be verified up to there"
        ));
    }
    if !course.is_every_tick {
        let n = course.digests.len();
        remarks.push(format!(
            "recorded by jamgrip {}, before recordings held the digest of every tick: \
             only {n} digests, those of its statistics, can be compared",
            again.recording.version()
        ));
    }
    remarks
}

/// What may be the reason of a difference.
fn blame(again: &RecordedRun) -> Vec<String> {
    let version = again.recording.version();
    let mut found = vec![format!(
        "recorded by jamgrip {version} on {}, simulated again by {} on {} {}",
        again.recording.facts.get("machine").map_or("an unknown machine", String::as_str),
        env!("CARGO_PKG_VERSION"),
        std::env::consts::OS,
        std::env::consts::ARCH
    )];
    let changes = compatibility::changes_since(version);
    found.extend(changes.into_iter().map(|it| format!("what changed results since then: {it}")));
    found
}
