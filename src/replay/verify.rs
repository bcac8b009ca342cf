//! Is every tick as it was recorded? The run is simulated again, and every digest compared.

use super::{
    again::{Again, ReplayError},
    history,
};
use crate::{
    bag::recording::Alteration,
    command::change::Change,
    cosim::compile::Compiled,
    node::{
        cache::Cache,
        pacer::Stopwatch,
        progress::Progress,
        shutdown::Shutdown,
        start::{self, Started},
    },
    session::Session,
};

/// How to verify.
pub struct Options<'a> {
    /// Solver threads; they do not change the result.
    pub n_threads: usize,
    /// True fills the bag anew from scene and seed; false takes the start that was recorded.
    pub settles: bool,
    /// Simulated time from which on to verify [ns]; from the last checkpoint before it.
    pub from_ns: u64,
    /// Simulated time at which to end [ns].
    pub to_ns: Option<u64>,
    /// Where settled start states are kept, for recordings without checkpoints.
    pub cache: Cache,
    /// What a person sees.
    pub progress: &'a Progress,
    /// Whether someone asked to end.
    pub shutdown: &'a Shutdown,
}

/// A tick that did not come out as recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The tick.
    pub tick: u64,
    /// The digest in the recording.
    pub recorded: u64,
    /// The digest found.
    pub simulated: u64,
}

/// What verification found.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Ticks that were simulated.
    pub n_ticks: u64,
    /// Digests that were compared.
    pub n_compared: u64,
    /// The first that differed.
    pub first_difference: Option<Difference>,
    /// Simulated over wall time.
    pub real_time_factor: f64,
    /// The tick it began with.
    pub start_tick: u64,
    /// What is to be said about the recording, for people.
    pub remarks: Vec<String>,
    /// True if someone asked to end before the end.
    pub is_interrupted: bool,
}

impl Verdict {
    /// True if something was compared and all of it was equal.
    pub fn is_equal(&self) -> bool {
        self.first_difference.is_none() && 0 < self.n_compared && !self.is_interrupted
    }

    fn goes_on(&self) -> bool {
        self.first_difference.is_none() && !self.is_interrupted
    }

    /// Compares the state with what is recorded of it, if anything is.
    fn compare(&mut self, recorded: Option<u64>, session: &Session) {
        let (Some(recorded), simulated) = (recorded, session.digest()) else { return };
        self.n_compared += 1;
        if recorded != simulated && self.first_difference.is_none() {
            let tick = session.run_tick().0;
            self.first_difference = Some(Difference { tick, recorded, simulated });
        }
    }

    /// The same after a change between two ticks.
    fn compare_after(&mut self, change: &Alteration, session: &Session) {
        let was_equal = self.first_difference.is_none();
        self.compare(change.digest, session);
        if was_equal && self.first_difference.is_some() {
            let Alteration { tick, what, .. } = change;
            self.remarks
                .push(format!("the difference is behind a change after tick {tick}: {what}"));
        }
    }

    /// The verdict for machines.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "ticks": self.n_ticks,
            "first_difference": self.first_difference.map(|it| it.tick),
            "real_time_factor": self.real_time_factor,
            "compared": self.n_compared,
            "remarks": self.remarks,
        })
    }
}

/// Simulates a recording again.
///
/// # Errors
/// If it cannot be run again. A difference is no error.
pub fn verify(again: &Again, options: &Options<'_>) -> Result<Verdict, ReplayError> {
    let mut verdict = Verdict {
        n_ticks: 0,
        n_compared: 0,
        first_difference: None,
        real_time_factor: 0.0,
        start_tick: 0,
        remarks: remarks(again),
        is_interrupted: false,
    };
    let tick_ns = again.scene.time.tick_ns;
    let mut session = session(again, options, &mut verdict)?;
    verdict.start_tick = session.run_tick().0;
    let mut script = again.script()?;
    // Beyond a gap commands are missing.
    let last = again.course.gap_after.unwrap_or(u64::MAX).min(again.course.last_tick());
    let last = options.to_ns.map_or(last, |end_ns| last.min(end_ns / tick_ns));
    options.progress.running(Some(last * tick_ns));
    let stopwatch = Stopwatch::start();
    loop {
        let tick = session.run_tick().0;
        verdict.compare(again.course.digest_of(tick), &session);
        verdict.is_interrupted = options.shutdown.is_requested();
        if !verdict.goes_on() {
            break;
        }
        for it in again.course.changes_after(tick) {
            let change = again.change(&mut session, it)?;
            if options.settles && matches!(change, Change::LoadScene(_)) {
                let what = &it.what;
                verdict.remarks.push(format!(
                    "after tick {tick}: {what}: it began as recorded, only the first was filled anew"
                ));
            }
            verdict.compare_after(it, &session);
        }
        if !verdict.goes_on() || last <= tick {
            break;
        }
        session.tick(&script.of(tick + 1))?;
        verdict.n_ticks += 1;
        let simulated_s = seconds(verdict.n_ticks * tick_ns);
        options.progress.share(session.run_time_ns(), simulated_s / stopwatch.total_s());
    }
    options.progress.end();
    let wall_s = stopwatch.total_s();
    verdict.real_time_factor = seconds(verdict.n_ticks * tick_ns) / wall_s.max(1e-9);
    if verdict.first_difference.is_some() {
        verdict.remarks.extend(blame(again));
    }
    Ok(verdict)
}

fn seconds(time_ns: u64) -> f64 {
    std::time::Duration::from_nanos(time_ns).as_secs_f64()
}

/// A session at the start, or at the checkpoint before the time asked for.
fn session(
    again: &Again,
    options: &Options<'_>,
    verdict: &mut Verdict,
) -> Result<Session, ReplayError> {
    // A run that branched off another begins later than at zero.
    let first = again.course.digests.first().map_or(0, |(tick, _)| *tick);
    let tick = first.max(options.from_ns / again.scene.time.tick_ns);
    if !options.settles
        && let Some(session) = again.session_before(tick, &again.scene, options.n_threads)?
    {
        return Ok(session);
    }
    if again.course.is_every_tick && 1 < first {
        return Err(ReplayError::NoStart { path: again.path.clone(), tick: first });
    }
    let compiled = Compiled::new(&again.scene, options.n_threads)?;
    if options.settles {
        let on_progress = &mut |it: crate::physics::fill::Progress| {
            options.progress.settling(it.stage, it.share);
        };
        return Ok(Session::settle(compiled, on_progress)?);
    }
    let started = start::start(compiled, options.n_threads, &options.cache, options.progress);
    let Started { session, origin } = started.map_err(ReplayError::from)?;
    let start = format!("no checkpoint is recorded: the start was {origin} from the scene");
    verdict.remarks.push(start);
    Ok(session)
}

/// What is wrong with a recording before anything is simulated.
fn remarks(again: &Again) -> Vec<String> {
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
fn blame(again: &Again) -> Vec<String> {
    let version = again.recording.version();
    let mut found = vec![format!(
        "recorded by jamgrip {version} on {}, simulated again by {} on {} {}",
        again.recording.facts.get("machine").map_or("an unknown machine", String::as_str),
        env!("CARGO_PKG_VERSION"),
        std::env::consts::OS,
        std::env::consts::ARCH
    )];
    let changes = history::changes_since(version);
    found.extend(changes.into_iter().map(|it| format!("what changed results since then: {it}")));
    found
}
