//! A complete session: the default scene with the built-in controller, without outputs.

use std::{collections::BTreeMap, path::Path};

use super::{
    BenchError, BenchResult, Case, Options, process,
    result::{Stage, median, processor_share as share},
    sanity::{StateSummary, check_lift},
};
use crate::{
    base::{
        Real, lanes, parallel,
        real::{real, real_of},
    },
    cosim::compile::Compiled,
    host::{clock::Stopwatch, progress_bar::Progress},
    node::{
        command_sources::CommandSources,
        lift_monitor::LiftMonitor,
        schedule::Schedule,
        start::{self, Started},
    },
    physics::membrane::mesh::Mesh,
    scene::{self, Scene, SceneError},
    session::Session,
};

/// The default scene.
const SCENE: (&str, &str) =
    ("launch_configs/pick_and_lift.yaml", include_str!("../../launch_configs/pick_and_lift.yaml"));

/// One session from its first tick to its last.
struct Repetition {
    session: Session,
    /// Wall-clock time (s).
    wall_s: Real,
    /// Processor time (s), if the system provides it.
    processor_s: Option<Real>,
    /// Times of commands, ticks and snapshots (s).
    parts: [Real; 3],
    /// Wall-clock and simulated time of each phase (s).
    phases: BTreeMap<String, [Real; 2]>,
    /// Outcome of the lift.
    lift_monitor: LiftMonitor,
    /// Sum over all ticks of the contacts between grains.
    n_contact_ticks: Real,
}

/// Runs complete sessions, at least one.
pub(super) fn run(case: &Case, options: &Options) -> Result<BenchResult, BenchError> {
    let scene = scene(&[])?;
    let mut repetitions: Vec<Repetition> = Vec::new();
    let mut start_digest = 0;
    while repetitions.is_empty()
        || repetitions.iter().map(|repetition| repetition.wall_s).sum::<Real>() < options.seconds
    {
        let session = session(&scene, options)?;
        start_digest = session.digest();
        process::reset_peak();
        let repetition = repetition(case, &scene, session)?;
        let digests =
            (repetitions.first().map(|first| first.session.digest()), repetition.session.digest());
        if let (Some(expected), found) = digests
            && expected != found
        {
            let (case, repetition) = (case.name.to_owned(), repetitions.len() + 1);
            return Err(BenchError::Unequal { case, repetition, found, expected });
        }
        repetitions.push(repetition);
    }
    result(case, options, &repetitions, start_digest)
}

/// The default scene with these overrides.
pub(super) fn scene(overrides: &[String]) -> Result<Scene, SceneError> {
    scene::parse(SCENE.1, SCENE.0, Path::new("launch_configs"), overrides)
}

/// A session before its first tick.
pub(super) fn session(scene: &Scene, options: &Options) -> Result<Session, BenchError> {
    let pool = parallel::ThreadPool::new(options.n_threads)?;
    let compiled = Compiled::new(scene, &pool).map_err(start::StartError::from)?;
    let progress = Progress::new(options.is_quiet);
    let started = start::start(compiled, &options.cache, &progress);
    progress.end();
    let Started { session, .. } = started?;
    Ok(session)
}

/// The loop of `node::run`, without ROS 2 and recordings.
fn repetition(case: &Case, scene: &Scene, mut session: Session) -> Result<Repetition, BenchError> {
    let mut command_sources = CommandSources::new(scene, Vec::new());
    let schedule = Schedule::new(&scene.outputs, scene.time.tick_ns);
    let tick_s = std::time::Duration::from_nanos(scene.time.tick_ns).as_secs_f64();
    let mut snapshot = session.snapshot(schedule.parts(0));
    let (mut parts, mut phases) = ([0.0; 3], BTreeMap::<String, [Real; 2]>::new());
    let (mut lift_monitor, mut n_contact_ticks) = (LiftMonitor::default(), 0.0);
    let processor = process::processor_s();
    let total = Stopwatch::start();
    let mut watch = Stopwatch::start();
    while !command_sources.is_done() {
        let commands = command_sources.drain(&snapshot);
        let drained = watch.lap_s();
        session
            .tick(&commands)
            .map_err(|error| BenchError::Diverged { case: case.name.to_owned(), error })?;
        let ticked = watch.lap_s();
        snapshot = session.snapshot(schedule.parts(snapshot.time_ns + scene.time.tick_ns));
        lift_monitor.update(&snapshot, tick_s);
        n_contact_ticks += real(snapshot.jamming.n_grain_contacts);
        let taken = watch.lap_s();
        for (sum, time) in parts.iter_mut().zip([drained, ticked, taken]) {
            *sum += time;
        }
        let name = command_sources.phase().map_or("none", |phase| phase.name());
        let phase = phases.entry(name.to_owned()).or_default();
        phase[0] += drained + ticked + taken;
        phase[1] += tick_s;
    }
    let processor_s = process::processor_s().zip(processor).map(|(after, before)| after - before);
    Ok(Repetition {
        session,
        wall_s: total.total_s(),
        processor_s,
        parts,
        phases,
        lift_monitor,
        n_contact_ticks,
    })
}

fn result(
    case: &Case,
    options: &Options,
    repetitions: &[Repetition],
    start_digest: u64,
) -> Result<BenchResult, BenchError> {
    let last = repetitions.last().expect("there is at least one repetition");
    let coupled = last.session.coupled();
    let summary =
        StateSummary::of(&coupled.system.model, &coupled.system.state, &coupled.system.scratch);
    summary
        .check(&case.limits)
        .and_then(|()| check_lift(&last.lift_monitor.metrics()))
        .map_err(|error| BenchError::InvalidState { case: case.name.to_owned(), error })?;
    let mut times: Vec<Real> = repetitions.iter().map(|repetition| repetition.wall_s).collect();
    times.sort_by(Real::total_cmp);
    let n_ticks = last.session.now().0;
    let n_steps = n_ticks * coupled.plan.n_substeps as u64;
    let steps_per_s = real_of(n_steps) / median(&times);
    let n_contacts = last.n_contact_ticks / real_of(n_ticks);
    let contact_steps = n_contacts * steps_per_s / real(options.n_threads);
    let total: Real = last.parts.iter().sum();
    let stage = |(name, time): (&str, &Real)| Stage {
        name: name.to_owned(),
        share: time / total,
        ns_per_step: 1e9 * time / real_of(n_steps),
    };
    let mesh: &Mesh = &coupled.system.model.membrane.mesh;
    Ok(BenchResult {
        case: case.name.to_owned(),
        n_grains: coupled.system.state.grains.len(),
        n_vertices: mesh.n_vertices(),
        threads: options.n_threads,
        lanes: lanes::width() as u8,
        substep_s: coupled.system.model.substep,
        steps_per_s,
        steps_per_s_best: real_of(n_steps) / times[0],
        spread: times[times.len() - 1] / times[0] - 1.0,
        processor_share: share(
            repetitions.iter().map(|repetition| (repetition.wall_s, repetition.processor_s)),
            options.n_threads,
        ),
        contact_steps_per_s_per_core: contact_steps,
        ns_per_contact_step: 1e9 / contact_steps,
        digest: format!("{:016x}", last.session.digest()),
        digest_after_steps: n_steps,
        start_digest: format!("{start_digest:016x}"),
        n_lap_steps: n_steps,
        n_laps: repetitions.len(),
        n_builds_per_lap: coupled.system.scratch.neighbors.n_builds,
        peak_rss_bytes: process::peak(),
        stages: ["commands", "ticks", "snapshots"]
            .into_iter()
            .zip(&last.parts)
            .map(stage)
            .collect(),
        phases: last.phases.iter().map(|(name, it)| (name.clone(), it[1] / it[0])).collect(),
        ..BenchResult::default()
    }
    .with_real_time_factor()
    .with_state(&summary))
}
