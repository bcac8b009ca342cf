//! Laps: each steps a copy of the same state by the same number of substeps.

use std::collections::BTreeMap;

use super::{
    BenchError, Case, Figures, Options,
    cases::Kind,
    prepare::{self, Subject},
    process,
    reference_codes::Peers,
    result::Stage,
    sanity::Seen,
};
use crate::{
    base::{
        Real,
        digest::Digest,
        lanes, parallel,
        real::{real, real_of},
    },
    host::clock::Stopwatch,
    physics::{System, substep::STAGES},
};

/// Laps that are run however long they take: a median needs three.
const N_LAPS_MIN: usize = 3;

/// How much is done in a lap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work {
    /// Substeps until lists and caches are warm.
    pub(super) n_warm: u64,
    /// Substeps that are measured.
    pub(super) n_steps: u64,
}

/// One lap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Repetition {
    /// Time on the clock for the measured substeps [s].
    pub(super) wall_s: Real,
    /// Processor time of all threads for them [s], if the system tells it.
    pub(super) processor_s: Option<Real>,
    /// Contacts between grains, the mean of before and after.
    pub(super) n_contacts: Real,
    /// How often the lists were built.
    pub(super) n_builds: u64,
    /// Digest of the state at the end.
    digest: u64,
    /// The state at the end.
    seen: Seen,
}

/// A case that is being measured.
pub(super) struct Course<'a> {
    case: &'a Case,
    options: &'a Options,
    pub(super) subject: Subject,
    pool: rayon::ThreadPool,
    repetitions: Vec<Repetition>,
}

impl<'a> Course<'a> {
    /// Makes the state of `case` ready.
    pub(super) fn new(case: &'a Case, options: &'a Options) -> Result<Self, BenchError> {
        let pool = parallel::pool(options.n_threads)?;
        let subject = prepare::subject(case, options, &pool)?;
        process::forget_peak();
        Ok(Self { case, options, subject, pool, repetitions: Vec::new() })
    }

    /// The other codes on the same packing, if they are wanted and it is one.
    pub(super) fn peers(&self) -> Result<Option<Peers>, BenchError> {
        let Kind::Grains(boxed) = &self.case.kind else { return Ok(None) };
        if !self.options.with_peers {
            return Ok(None);
        }
        let of_case = (self.case.work, &self.case.limits);
        let peers = Peers::new(boxed, &self.subject.system, of_case, self.options.n_threads);
        let fault = |fault| BenchError::Peer { case: self.case.name.to_owned(), fault };
        peers.map(Some).map_err(fault)
    }

    /// True when there are enough laps.
    pub(super) fn is_over(&self) -> bool {
        let measured: Real = self.repetitions.iter().map(|repetition| repetition.wall_s).sum();
        N_LAPS_MIN <= self.repetitions.len() && self.options.seconds <= measured
    }

    /// One more lap, which must end as the first did.
    pub(super) fn repetition(&mut self) -> Result<Repetition, BenchError> {
        let Self { case, subject, pool, .. } = &*self;
        let (repetition, end) = parallel::lead(pool, || repetition(subject, case.work, None));
        self.accept(&repetition, &end)?;
        self.repetitions.push(repetition);
        Ok(repetition)
    }

    /// Sound, and the same as the first.
    fn accept(&self, repetition: &Repetition, end: &System) -> Result<(), BenchError> {
        let case = || self.case.name.to_owned();
        end.check(self.case.work.n_warm + self.case.work.n_steps)
            .map_err(|fault| BenchError::Diverged { case: case(), fault })?;
        repetition
            .seen
            .check(&self.case.limits)
            .map_err(|fault| BenchError::Unsound { case: case(), fault })?;
        match self.repetitions.first() {
            Some(first) if first.digest != repetition.digest => Err(BenchError::Unequal {
                case: case(),
                repetition: self.repetitions.len() + 1,
                found: repetition.digest,
                expected: first.digest,
            }),
            _ => Ok(()),
        }
    }

    /// What came out, with one more lap for the shares of the stages.
    pub(super) fn figures(self, peers: Option<&Peers>) -> Result<Figures, BenchError> {
        let work = self.case.work;
        let mut times = vec![0.0; STAGES.len()];
        let (by_stages, end) =
            parallel::lead(&self.pool, || repetition(&self.subject, work, Some(&mut times)));
        self.accept(&by_stages, &end)?;
        let whole: Real = times.iter().sum();
        let stages: Vec<Stage> = (STAGES.iter().zip(&times))
            .map(|((name, _), time)| Stage {
                name: (*name).to_owned(),
                share: time / whole,
                ns_per_step: 1e9 * time / real_of(work.n_steps),
            })
            .collect();
        let system = &self.subject.system;
        let speeds = Figures::of_laps(&self.repetitions, work, self.options.n_threads);
        let ours = speeds.contact_steps_per_s_per_core;
        Ok(Figures {
            case: self.case.name.to_owned(),
            n_grains: system.state.grains.len(),
            n_vertices: system.state.membrane.positions.len(),
            threads: self.options.n_threads,
            lanes: lanes::width() as u8,
            substep_s: system.model.substep,
            digest: format!("{:016x}", by_stages.digest),
            digest_after_steps: work.n_warm + work.n_steps,
            start_digest: format!("{:016x}", digest(system)),
            n_warm_steps: work.n_warm,
            n_lap_steps: work.n_steps,
            stages,
            phases: BTreeMap::new(),
            peak_rss_bytes: process::peak(),
            peers: peers.map_or_else(Vec::new, |it| it.figures(ours)),
            peers_missing: peers.map_or_else(Vec::new, |it| it.missing.clone()),
            ..speeds
        }
        .with_speed_of_time()
        .seeing(&by_stages.seen))
    }
}

/// A lap from the start; into `times` goes the time of each stage, if that is wanted.
fn repetition(
    subject: &Subject,
    work: Work,
    times: Option<&mut Vec<Real>>,
) -> (Repetition, System) {
    let mut system = subject.system.clone();
    let after = subject.after;
    for _ in 0..work.n_warm {
        system.step();
        after(&mut system);
    }
    let before = look(&system);
    let n_builds = system.scratch.neighbors.n_builds;
    let processor = process::processor_s();
    let mut watch = Stopwatch::start();
    if let Some(times) = times {
        for _ in 0..work.n_steps {
            watch.lap_s();
            system.step_by_stages(|k| times[k] += watch.lap_s());
            after(&mut system);
        }
    } else {
        for _ in 0..work.n_steps {
            system.step();
            after(&mut system);
        }
    }
    let wall_s = watch.total_s();
    let processor_s = process::processor_s().zip(processor).map(|(after, before)| after - before);
    let seen = look(&system);
    let repetition = Repetition {
        wall_s,
        processor_s,
        n_contacts: 0.5 * (real(before.n_grain_contacts) + real(seen.n_grain_contacts)),
        n_builds: system.scratch.neighbors.n_builds - n_builds,
        digest: digest(&system),
        seen,
    };
    (repetition, system)
}

fn look(system: &System) -> Seen {
    Seen::of(&system.model, &system.state, &system.scratch)
}

/// Digest of a state.
fn digest(system: &System) -> u64 {
    let mut digest = Digest::new();
    system.state.digest(&mut digest);
    digest.finish()
}
