//! States to start from: made once, then kept in the cache of start states.

use super::{BenchError, Case, Options, beam, cases::Kind, packing::Boxed};
use crate::{
    base::{Real, digest::Digest, parallel},
    cosim::saved_state,
    experiments::{Run, SceneText, Size, StartError},
    host::{cache::Found, progress_bar::Progress},
    physics::{State, System, health::Diverged},
    runner::experiment::by_name,
};

/// A system that can be stepped, and what is done to it after each substep.
pub(super) struct Subject {
    /// The system.
    pub(super) system: System,
    /// What its experiment does to it.
    pub(super) after: fn(&mut System),
}

/// An experiment at some moment.
#[derive(Debug)]
pub(super) struct Spot {
    /// Its name.
    pub(super) experiment: &'static str,
    /// Which of its cases.
    pub(super) case: &'static str,
    /// What is changed in its scene.
    pub(super) overrides: &'static [&'static str],
    /// When.
    pub(super) moment: Moment,
}

/// A moment of an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    /// The bag is filled and vented, and nothing touches it.
    Free,
    /// Half the vacuum is reached.
    Jamming,
    /// All of it is, and nothing moves.
    Holding,
    /// The plates have come to their speed.
    Shearing,
}

/// Half of the grip's pressure (Pa).
const HALF_VACUUM: Real = -45e3;
/// Slices of shearing until the plates have come to their speed.
const N_SHEARING: usize = 20;
/// Changes whenever the same moment would be another state.
const VERSION: u64 = 1;

impl Moment {
    /// The moments of the same experiment, from the first to this one.
    fn until(self) -> &'static [Self] {
        const GRIP: [Moment; 3] = [Moment::Free, Moment::Jamming, Moment::Holding];
        match self {
            Self::Free => &GRIP[..1],
            Self::Jamming => &GRIP[..2],
            Self::Holding => &GRIP,
            Self::Shearing => &[Self::Shearing],
        }
    }

    /// True if a run has come to it; its last `n_slices` had this stage.
    fn is_reached(self, run: &dyn Run, stage: &str, n_slices: usize) -> bool {
        let Some(stepped) = run.stepped() else { return false };
        match self {
            Self::Free => true,
            Self::Jamming => stepped.system.state.gauge <= HALF_VACUUM,
            Self::Holding => stage == "holding",
            Self::Shearing => stage == "shearing" && N_SHEARING <= n_slices,
        }
    }
}

/// The state that is measured in `case`.
///
/// # Errors
/// If it cannot be made.
pub(super) fn subject(
    case: &Case,
    options: &Options,
    pool: &parallel::ThreadPool,
) -> Result<Subject, BenchError> {
    let maker = Maker { case, options, pool };
    match &case.kind {
        Kind::Grains(boxed) => {
            Ok(Subject { system: boxed.system(maker.boxed(boxed)?), after: |_| {} })
        }
        Kind::Beam => Ok(Subject { system: beam::system(maker.beam()?)?, after: |_| {} }),
        Kind::Experiment(spot) => maker.experiment(spot),
        _ => Err(maker.no_moment()),
    }
}

/// Makes what is not in the cache.
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
        self.tell();
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
        self.tell();
        let state = parallel::lead(self.pool, beam::grow)?;
        self.store(beam::KEY, &saved_state::write(&state));
        Ok(state)
    }

    fn load_state(&self, key: &str) -> Option<State> {
        saved_state::read(&self.load(key)?).ok()
    }

    fn experiment(&self, spot: &Spot) -> Result<Subject, BenchError> {
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
        let mut n_kept = 0;
        for (k, &moment) in moments.iter().enumerate().rev() {
            if let Some(bytes) = self.load(&key(moment)) {
                if run.resume(&bytes).is_ok() {
                    n_kept = k + 1;
                    break;
                }
                run = start()?;
            }
        }
        if n_kept < moments.len() {
            self.tell();
        }
        for &moment in &moments[n_kept..] {
            let is_reached = parallel::lead(self.pool, || advance(run.as_mut(), moment));
            if !is_reached.map_err(|fault| self.diverged(fault))? {
                return Err(self.no_moment());
            }
            let bytes = run.save();
            self.store(&key(moment), &bytes);
            // A resumed run and one that went through must be the same.
            run = start()?;
            run.resume(&bytes).map_err(|_| self.no_moment())?;
        }
        self.at(run.as_mut(), spot.moment)
    }

    /// The system of a run that has just been resumed.
    fn at(&self, run: &mut dyn Run, moment: Moment) -> Result<Subject, BenchError> {
        if moment != Moment::Free {
            // The run's own controls hold from its next slice on.
            parallel::lead(self.pool, || run.advance()).map_err(|fault| self.diverged(fault))?;
        }
        let stepped = run.stepped().ok_or_else(|| self.no_moment())?;
        let mut system = stepped.system.clone();
        if moment == Moment::Free {
            for body in &mut system.controls.bodies {
                // Far below the bag.
                body.pose.translation.z = -1.0;
            }
        }
        Ok(Subject { system, after: stepped.after })
    }

    fn diverged(&self, fault: Diverged) -> BenchError {
        BenchError::Diverged { case: self.case.name.to_owned(), fault }
    }

    fn no_moment(&self) -> BenchError {
        BenchError::NoMoment { case: self.case.name.to_owned() }
    }

    fn load(&self, key: &str) -> Option<Vec<u8>> {
        match self.options.cache.load(number(key)) {
            Found::State(bytes) => Some(bytes),
            // What is damaged is made anew, as what is missing.
            Found::Nothing | Found::Damaged(_) => None,
        }
    }

    fn store(&self, key: &str, bytes: &[u8]) {
        if let Err(error) = self.options.cache.store(number(key), bytes) {
            Progress::new(self.options.is_quiet).say(&error);
        }
    }

    fn tell(&self) {
        if !self.options.is_quiet {
            let name = self.case.name;
            let text = format!(
                "{name}: the state to start from is made ready, once; this may take minutes"
            );
            Progress::new(false).say(&text);
        }
    }
}

/// Goes on until `moment`; false if the end comes before.
fn advance(run: &mut dyn Run, moment: Moment) -> Result<bool, Diverged> {
    let (mut stage, mut n_slices) = ("", 0);
    loop {
        let progress = run.advance()?;
        n_slices = if progress.stage == stage { n_slices + 1 } else { 1 };
        stage = progress.stage;
        if moment.is_reached(run, stage, n_slices) {
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
