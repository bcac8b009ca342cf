//! Start states: prepared once, then kept in the cache of start states.

use super::{BenchError, Case, Options, beam, cases::Kind, packing::Boxed};
use crate::{
    base::{Real, digest::Digest, parallel},
    cosim::saved_state,
    experiments::{Run, SceneText, Size, StartError},
    host::{cache::Lookup, progress_bar::Progress},
    physics::{State, System, health::Diverged},
    runner::experiment::by_name,
};

/// A system to be stepped, and what is done after each substep.
pub(super) struct PreparedSystem {
    /// The system.
    pub(super) system: System,
    /// Called after each substep.
    pub(super) after: fn(&mut System),
}

/// An experiment at some moment.
#[derive(Debug)]
pub(super) struct ExperimentMoment {
    /// Name of the experiment.
    pub(super) experiment: &'static str,
    /// Name of the case.
    pub(super) case: &'static str,
    /// Overrides of the scene.
    pub(super) overrides: &'static [&'static str],
    /// The moment.
    pub(super) moment: Moment,
}

/// A moment of an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    /// The gripper is filled and vented, and nothing touches it.
    Free,
    /// Half of the vacuum is reached.
    Jamming,
    /// The full vacuum is reached, and nothing moves.
    Holding,
    /// The plates have reached their speed.
    Shearing,
}

/// Half of the grip's pressure (Pa).
const HALF_VACUUM: Real = -45e3;
/// Slices of shearing until the plates have reached their speed.
const N_SHEARING: usize = 20;
/// To be increased when the state of a moment changes.
const VERSION: u64 = 1;

impl Moment {
    /// The moments of the same experiment up to this one.
    fn until(self) -> &'static [Self] {
        const GRIP: [Moment; 3] = [Moment::Free, Moment::Jamming, Moment::Holding];
        match self {
            Self::Free => &GRIP[..1],
            Self::Jamming => &GRIP[..2],
            Self::Holding => &GRIP,
            Self::Shearing => &[Self::Shearing],
        }
    }

    /// True if a run has reached this moment; its last `n_slices` were in this phase.
    fn is_reached(self, run: &dyn Run, phase: &str, n_slices: usize) -> bool {
        let Some(stepped) = run.stepped() else { return false };
        match self {
            Self::Free => true,
            Self::Jamming => stepped.system.state.gauge <= HALF_VACUUM,
            Self::Holding => phase == "holding",
            Self::Shearing => phase == "shearing" && N_SHEARING <= n_slices,
        }
    }
}

/// The system to be measured in `case`.
///
/// # Errors
/// If it cannot be prepared.
pub(super) fn subject(
    case: &Case,
    options: &Options,
    pool: &parallel::ThreadPool,
) -> Result<PreparedSystem, BenchError> {
    let maker = Maker { case, options, pool };
    match &case.kind {
        Kind::Grains(boxed) => {
            Ok(PreparedSystem { system: boxed.system(maker.boxed(boxed)?), after: |_| {} })
        }
        Kind::Beam => Ok(PreparedSystem { system: beam::system(maker.beam()?)?, after: |_| {} }),
        Kind::Experiment(spot) => maker.experiment(spot),
        _ => Err(maker.no_moment()),
    }
}

/// Prepares states that are not in the cache.
struct Maker<'a> {
    case: &'a Case,
    options: &'a Options,
    pool: &'a parallel::ThreadPool,
}

impl Maker<'_> {
    fn boxed(&self, boxed: &Boxed) -> Result<State, BenchError> {
        if let Some(state) = self.load_state(&boxed.key()) {
            return Ok(state);
        }
        self.announce();
        let tile = match self.load_state(&boxed.tile_key()) {
            Some(tile) => tile,
            None => {
                let tile = parallel::lead(self.pool, || boxed.closed_tile().grow())?;
                self.store(&boxed.tile_key(), &saved_state::write(&tile));
                tile
            }
        };
        if boxed.is_tile() {
            return Ok(tile);
        }
        let state = parallel::lead(self.pool, || boxed.of_tile(&tile));
        self.store(&boxed.key(), &saved_state::write(&state));
        Ok(state)
    }

    fn beam(&self) -> Result<State, BenchError> {
        if let Some(state) = self.load_state(beam::KEY) {
            return Ok(state);
        }
        self.announce();
        let state = parallel::lead(self.pool, beam::grow)?;
        self.store(beam::KEY, &saved_state::write(&state));
        Ok(state)
    }

    fn load_state(&self, key: &str) -> Option<State> {
        saved_state::read(&self.load(key)?).ok()
    }

    fn experiment(&self, spot: &ExperimentMoment) -> Result<PreparedSystem, BenchError> {
        let experiment = by_name(spot.experiment)?;
        let (source, text) = experiment.scene();
        let overrides: Vec<String> = spot.overrides.iter().map(|&it| it.to_owned()).collect();
        let scene = SceneText { text, source, overrides: &overrides, size: Size::Quick };
        let plan = experiment.read(&scene)?;
        let key = |moment: Moment| {
            format!("experiment {VERSION} {text} {overrides:?} {} {moment:?}", spot.case)
        };
        let start = || -> Result<Box<dyn Run>, StartError> { plan.start(spot.case) };
        let moments = spot.moment.until();
        let mut run = start()?;
        let mut n_cached = 0;
        for (k, &moment) in moments.iter().enumerate().rev() {
            if let Some(bytes) = self.load(&key(moment)) {
                if run.resume(&bytes).is_ok() {
                    n_cached = k + 1;
                    break;
                }
                run = start()?;
            }
        }
        if n_cached < moments.len() {
            self.announce();
        }
        for &moment in &moments[n_cached..] {
            let is_reached = parallel::lead(self.pool, || advance(run.as_mut(), moment));
            if !is_reached.map_err(|error| self.diverged(error))? {
                return Err(self.no_moment());
            }
            let bytes = run.save();
            self.store(&key(moment), &bytes);
            // Always continue from a resumed run, so that cached and new states are the same.
            run = start()?;
            run.resume(&bytes).map_err(|_| self.no_moment())?;
        }
        self.at(run.as_mut(), spot.moment)
    }

    /// The system of a run that was just resumed.
    fn at(&self, run: &mut dyn Run, moment: Moment) -> Result<PreparedSystem, BenchError> {
        if moment != Moment::Free {
            // The run sets its controls in its next slice.
            parallel::lead(self.pool, || run.advance()).map_err(|error| self.diverged(error))?;
        }
        let stepped = run.stepped().ok_or_else(|| self.no_moment())?;
        let mut system = stepped.system.clone();
        if moment == Moment::Free {
            for body in &mut system.controls.bodies {
                // Far below the gripper.
                body.pose.translation.z = -1.0;
            }
        }
        Ok(PreparedSystem { system, after: stepped.after })
    }

    fn diverged(&self, error: Diverged) -> BenchError {
        BenchError::Diverged { case: self.case.name.to_owned(), error }
    }

    fn no_moment(&self) -> BenchError {
        BenchError::NoMoment { case: self.case.name.to_owned() }
    }

    fn load(&self, key: &str) -> Option<Vec<u8>> {
        match self.options.cache.load(number(key)) {
            Lookup::State(bytes) => Some(bytes),
            // A damaged state is prepared again, like a missing one.
            Lookup::Missing | Lookup::Damaged(_) => None,
        }
    }

    fn store(&self, key: &str, bytes: &[u8]) {
        if let Err(error) = self.options.cache.store(number(key), bytes) {
            Progress::new(self.options.is_quiet).say(&error);
        }
    }

    fn announce(&self) {
        if !self.options.is_quiet {
            let name = self.case.name;
            let text = format!(
                "{name}: preparing the start state; this happens once and may take minutes"
            );
            Progress::new(false).say(&text);
        }
    }
}

/// Advances until `moment`; returns false if the run ends before.
fn advance(run: &mut dyn Run, moment: Moment) -> Result<bool, Diverged> {
    let (mut phase, mut n_slices) = ("", 0);
    loop {
        let progress = run.advance()?;
        n_slices = if progress.phase == phase { n_slices + 1 } else { 1 };
        phase = progress.phase;
        if moment.is_reached(run, phase, n_slices) {
            return Ok(true);
        }
        if progress.is_done {
            return Ok(false);
        }
    }
}

/// A key of the cache.
fn number(key: &str) -> u64 {
    let mut digest = Digest::new();
    digest.bytes(b"bench ");
    digest.bytes(key.as_bytes());
    digest.finish()
}
