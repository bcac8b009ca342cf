//! From a scene to a run and its summary.

use std::{path::PathBuf, sync::Arc, time::Duration};

use super::{
    Ending, Report, RunContext,
    command_sources::CommandSources,
    connect::{Connections, ExternalInputs, Sizes},
    lift_monitor::LiftMonitor,
    loader::Loader,
    lockstep::Gate,
    outputs::Closed,
    plant::Plant,
    schedule::Schedule,
    server::SimulationServer,
    start::{self, StartError, Started},
    summary::Summary,
};
use crate::host::{cache::Cache, clock::Pacer, progress_bar::Progress, shutdown::Shutdown};
use crate::{
    base::parallel,
    cosim::compile::Compiled,
    io::sink::RunStatistics,
    physics::health::Diverged,
    scene::{Controller, Lockstep, Scene},
    wire::to_ros::Encoder,
};

/// What the command line adds to a scene.
#[derive(Clone, Debug)]
pub struct Options {
    /// Solver threads; they do not change the result.
    pub n_threads: usize,
    /// Simulated time after which the run ends (s).
    pub duration: Option<f64>,
    /// The file that the scene is from.
    pub scene_file: PathBuf,
    /// Where settled start states are kept.
    pub cache: Cache,
    /// True shows no progress.
    pub is_quiet: bool,
    /// Ends the run when requested.
    pub shutdown: Shutdown,
    /// Additional metadata for the recording.
    pub facts: Vec<(&'static str, String)>,
}

/// Why a run could not begin or go on.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// There is no session.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The system cannot go on. What was recorded until then is complete.
    #[error(transparent)]
    Diverged(#[from] Diverged),
    /// The recording cannot begin, or failed, and the scene says to stop then.
    #[error("{0}\nthe scene says to stop then; --set outputs.bag.on_error=continue runs on")]
    Recording(String),
    /// Commands shall come over ROS 2, but there is no ROS 2.
    #[error(
        "controller: topics, but ROS 2 is not there: {0}; allow it, or choose controller=builtin"
    )]
    NoTopics(String),
    /// A recording that was to be taken up cannot be.
    #[cfg(feature = "bag")]
    #[error(transparent)]
    Replay(Box<dyn std::error::Error + Send + Sync>),
}

/// A finished run. There is a summary even if it ended in a fault.
#[derive(Debug)]
pub struct Finished {
    /// What came of it.
    pub summary: Summary,
    /// Why it ended early.
    pub fault: Option<RunError>,
}

/// Runs `scene` from its start to its end.
///
/// # Errors
/// If the run cannot begin.
pub fn launch(scene: &Scene, options: &Options) -> Result<Finished, RunError> {
    let begin = |compiled: Compiled, progress: &Progress| {
        Ok(start::start(compiled, &options.cache, progress)?)
    };
    launch_with(scene, options, begin, |outside| {
        (CommandSources::new(scene, outside.sources), outside.front)
    })
}

/// Runs `scene` under the commands of `script` alone, to the end that `options` or the scene name.
///
/// # Errors
/// If the run cannot begin.
#[cfg(feature = "bag")]
pub fn launch_by(
    scene: &Scene,
    options: &Options,
    script: crate::bag::source::Script,
) -> Result<Finished, RunError> {
    let begin = |compiled: Compiled, progress: &Progress| {
        Ok(start::start(compiled, &options.cache, progress)?)
    };
    launch_with(scene, options, begin, |_| {
        (CommandSources::from_outside(vec![Box::new(script)]), None)
    })
}

/// Runs `scene` to its end from a session that `begin` makes of the compiled scene, under the
/// orders that `command` makes of those outside. Whoever it leaves out can only look.
///
/// # Errors
/// If the run cannot begin.
pub fn launch_with(
    scene: &Scene,
    options: &Options,
    begin: impl FnOnce(Compiled, &Progress) -> Result<Started, RunError>,
    command: impl FnOnce(ExternalInputs) -> (CommandSources, Option<SimulationServer>),
) -> Result<Finished, RunError> {
    let since_start = Pacer::start(false);
    let progress = Progress::new(options.is_quiet);
    let pool = parallel::ThreadPool::new(options.n_threads).map_err(StartError::from)?;
    let compiled = Compiled::new(scene, &pool).map_err(StartError::from)?;
    let substep_s = compiled.model.substep;
    let mesh = &compiled.model.membrane.mesh;
    let encoder = Arc::new(Encoder::new(scene, &mesh.triangles, &mesh.positions));
    let sizes = Sizes { n_grains: scene.grains.count, n_vertices: mesh.n_vertices() };
    // Recording first: a folder that cannot be written is noticed before the bag is filled.
    let (mut outputs, outside) = {
        let Options { scene_file, facts, .. } = options;
        Connections { scene, scene_file, encoder: &encoder, progress: &progress, substep_s, facts }
            .open(sizes)?
    };
    let Started { mut session, origin } = begin(compiled, &progress)?;
    let end_ns = end_ns(scene, options.duration);
    progress.running(end_ns);
    let clock = outside.clock.clone();
    outputs.encoder = Some(Arc::clone(&encoder));
    let (command_sources, front) = command(outside);
    let loader = || Loader::new(options.n_threads, options.cache.clone());
    let front = front.map(|it| it.with_loader(loader()));
    // Only who commands from outside can be waited for; a script knows its ticks.
    let in_step = if front.is_some() { lockstep(scene) } else { Lockstep::OFF };
    let gate = Gate::new(in_step);
    let gate = if front.is_some() { gate.following(clock, scene.time.tick_ns) } else { gate };
    let mut context = RunContext {
        command_sources,
        gate,
        front,
        checkpoints: Vec::new(),
        outputs,
        schedule: Schedule::new(&scene.outputs, scene.time.tick_ns),
        lift_monitor: LiftMonitor::default(),
        progress,
        shutdown: options.shutdown.clone(),
        tick_ns: scene.time.tick_ns,
        end_ns,
        is_real_time: scene.outputs.real_time,
        n_packets: 0,
        has_missed: false,
        about: RunStatistics { substep_s, seed: scene.seed, ..RunStatistics::default() },
    };
    let start_time_s = since_start.wall_time_s();
    let report = super::run(&mut session, &mut context);
    let mesh = &session.coupled().system.model.membrane.mesh;
    let sizes = Sizes { n_grains: session.scene().grains.count, n_vertices: mesh.n_vertices() };
    let substep_s = session.substep_s();
    Ok(finish(session.scene(), context, report, Known { sizes, substep_s, origin, start_time_s }))
}

/// What is known besides what was seen of the run.
struct Known {
    sizes: Sizes,
    substep_s: f64,
    origin: &'static str,
    start_time_s: f64,
}

/// The earlier of the scene's and the command line's end (ns).
fn end_ns(scene: &Scene, duration: Option<f64>) -> Option<u64> {
    let of_scene = match scene.controller {
        Controller::Topics { duration, .. } => duration,
        Controller::Builtin(_) => None,
    };
    let ends = duration.into_iter().chain(of_scene).map(Duration::from_secs_f64);
    ends.min().map(|end| u64::try_from(end.as_nanos()).unwrap_or(u64::MAX))
}

/// Whether ticks wait for commands.
fn lockstep(scene: &Scene) -> Lockstep {
    match scene.controller {
        Controller::Topics { lockstep, .. } => lockstep,
        Controller::Builtin(_) => Lockstep::OFF,
    }
}

fn finish(
    scene: &Scene,
    context: RunContext,
    report: Report<<crate::session::Session as Plant>::Fault>,
    known: Known,
) -> Finished {
    let RunContext { command_sources, outputs, lift_monitor, progress, .. } = context;
    let bag = outputs.bag.as_ref().map(|folder| folder.display().to_string());
    let sources = command_sources.counters();
    drop(command_sources);
    let Closed { counters, faults } = outputs.close();
    faults.iter().for_each(|fault| progress.say(fault));
    let (ending, fault) = match report.ending {
        Ok(Ending::RecordingFailed) => {
            let text = Ending::RecordingFailed.to_string();
            (text.clone(), Some(RunError::Recording(text)))
        }
        Ok(ending) => (ending.to_string(), None),
        Err(fault) => ("diverged".to_owned(), Some(RunError::from(fault))),
    };
    let last = &report.last.snapshot;
    let summary = Summary {
        scene: scene.name.clone(),
        seed: scene.seed,
        ending,
        verdict: lift_monitor.verdict(),
        real_time_factor: report.real_time_factor,
        wall_time_s: report.wall_time_s,
        start_time_s: known.start_time_s,
        start_state: known.origin,
        sim_time_s: Duration::from_nanos(last.time_ns).as_secs_f64(),
        substep_s: known.substep_s,
        n_grains: known.sizes.n_grains,
        n_vertices: known.sizes.n_vertices,
        state_digest: last.digest,
        bag,
        sinks: counters,
        sources,
        commands: last.command_counts,
    };
    Finished { summary, fault }
}
