//! Repetitions: each steps a copy of the same state by the same number of substeps.

use std::collections::BTreeMap;

use super::{
    BenchError, BenchResult, Case, Options,
    cases::Kind,
    prepare::{self, PreparedSystem},
    process,
    reference_codes::ReferenceCodes,
    result::Stage,
    sanity::StateSummary,
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

/// Minimum number of repetitions: a median needs three.
const N_REPETITIONS_MIN: usize = 3;

/// Work of a repetition.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work {
    /// Substeps until lists and caches are warm.
    pub(super) n_warm: u64,
    /// Substeps that are measured.
    pub(super) n_steps: u64,
}

/// One repetition.
#[derive(Clone, Copy, Debug)]
pub(super) struct Repetition {
    /// Wall-clock time of the measured substeps (s).
    pub(super) wall_s: Real,
    /// Processor time of all threads for them (s), if the system provides it.
    pub(super) processor_s: Option<Real>,
    /// Contacts between grains, the mean of those before and after.
    pub(super) n_contacts: Real,
    /// Number of times the neighbor lists were built.
    pub(super) n_builds: u64,
    /// Digest of the state at the end.
    digest: u64,
    /// Summary of the state at the end.
    summary: StateSummary,
}

/// A case that is being measured.
pub(super) struct Measurement<'a> {
    case: &'a Case,
    options: &'a Options,
    pub(super) subject: PreparedSystem,
    pool: parallel::ThreadPool,
    repetitions: Vec<Repetition>,
}

impl<'a> Measurement<'a> {
    /// Prepares the start state of `case`.
    pub(super) fn new(case: &'a Case, options: &'a Options) -> Result<Self, BenchError> {
        let pool = parallel::ThreadPool::new(options.n_threads)?;
        let subject = prepare::subject(case, options, &pool)?;
        process::reset_peak();
        Ok(Self { case, options, subject, pool, repetitions: Vec::new() })
    }

    /// The reference codes with the same packing, if they are requested and the case is a packing.
    pub(super) fn peers(&self) -> Result<Option<ReferenceCodes>, BenchError> {
        let Kind::Grains(boxed) = &self.case.kind else { return Ok(None) };
        if !self.options.with_peers {
            return Ok(None);
        }
        let of_case = (self.case.work, &self.case.limits);
        let peers =
            ReferenceCodes::new(boxed, &self.subject.system, of_case, self.options.n_threads);
        let error = |error| BenchError::Peer { case: self.case.name.to_owned(), error };
        peers.map(Some).map_err(error)
    }

    /// True if there are enough repetitions.
    pub(super) fn is_over(&self) -> bool {
        let measured: Real = self.repetitions.iter().map(|repetition| repetition.wall_s).sum();
        N_REPETITIONS_MIN <= self.repetitions.len() && self.options.seconds <= measured
    }

    /// One more repetition, which must end in the same state as the first one.
    pub(super) fn repetition(&mut self) -> Result<Repetition, BenchError> {
        let Self { case, subject, pool, .. } = &*self;
        let (repetition, end) = parallel::lead(pool, || repetition(subject, case.work, None));
        self.accept(&repetition, &end)?;
        self.repetitions.push(repetition);
        Ok(repetition)
    }

    /// Checks that the end state is valid and the same as that of the first repetition.
    fn accept(&self, repetition: &Repetition, end: &System) -> Result<(), BenchError> {
        let case = || self.case.name.to_owned();
        end.check(self.case.work.n_warm + self.case.work.n_steps)
            .map_err(|error| BenchError::Diverged { case: case(), error })?;
        repetition
            .summary
            .check(&self.case.limits)
            .map_err(|error| BenchError::InvalidState { case: case(), error })?;
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

    /// The result, after one more repetition for the shares of the stages.
    pub(super) fn result(self, peers: Option<&ReferenceCodes>) -> Result<BenchResult, BenchError> {
        let work = self.case.work;
        let mut times = vec![0.0; STAGES.len()];
        let (by_stages, end) =
            parallel::lead(&self.pool, || repetition(&self.subject, work, Some(&mut times)));
        self.accept(&by_stages, &end)?;
        let total: Real = times.iter().sum();
        let stages: Vec<Stage> = (STAGES.iter().zip(&times))
            .map(|((name, _), time)| Stage {
                name: (*name).to_owned(),
                share: time / total,
                ns_per_step: 1e9 * time / real_of(work.n_steps),
            })
            .collect();
        let system = &self.subject.system;
        let speeds = BenchResult::of_repetitions(&self.repetitions, work, self.options.n_threads);
        let ours = speeds.contact_steps_per_s_per_core;
        Ok(BenchResult {
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
            peers: peers.map_or_else(Vec::new, |it| it.results(ours)),
            peers_missing: peers.map_or_else(Vec::new, |it| it.missing.clone()),
            ..speeds
        }
        .with_real_time_factor()
        .with_state(&by_stages.summary))
    }
}

/// A repetition from the start; adds the time of each stage to `times`, if given.
fn repetition(
    subject: &PreparedSystem,
    work: Work,
    times: Option<&mut Vec<Real>>,
) -> (Repetition, System) {
    let mut system = subject.system.clone();
    let after = subject.after;
    for _ in 0..work.n_warm {
        system.step();
        after(&mut system);
    }
    let before = summary(&system);
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
    let after = summary(&system);
    let repetition = Repetition {
        wall_s,
        processor_s,
        n_contacts: 0.5 * (real(before.n_grain_contacts) + real(after.n_grain_contacts)),
        n_builds: system.scratch.neighbors.n_builds - n_builds,
        digest: digest(&system),
        summary: after,
    };
    (repetition, system)
}

fn summary(system: &System) -> StateSummary {
    StateSummary::of(&system.model, &system.state, &system.scratch)
}

/// Digest of a state.
fn digest(system: &System) -> u64 {
    let mut digest = Digest::new();
    system.state.digest(&mut digest);
    digest.finish()
}
