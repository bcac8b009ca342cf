//! From a scene to a run and its summary.

use std::{path::PathBuf, sync::Arc, time::Duration};

use super::{
    Ending, Inputs, Report, RunContext, Supervision,
    command_sources::CommandSources,
    connect::{Connections, ExternalInputs, Sizes},
    loader::Loader,
    lockstep::Gate,
    outputs::Closed,
    start::{self, StartError, Started},
    summary::Summary,
};
use crate::{
    base::parallel::ThreadPool,
    cosim::compile::Compiled,
    host::{cache::Cache, clock::Pacer, progress_bar::Progress, shutdown::Shutdown},
    physics::health::Diverged,
    scene::{Controller, Lockstep, Scene},
    session::Session,
    wire::to_ros::Encoder,
};

/// How a scene is run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Number of solver threads; it does not change the result.
    pub n_threads: usize,
    /// Simulated time after which the run ends (s).
    pub duration: Option<f64>,
    /// The file of the scene.
    pub scene_file: PathBuf,
    /// Cache of settled states.
    pub cache: Cache,
    /// True hides the progress bar.
    pub is_quiet: bool,
    /// Ends the run when requested.
    pub shutdown: Shutdown,
    /// Additional metadata for the recording.
    pub facts: Vec<(&'static str, String)>,
}

/// Why a run could not begin or continue.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The session could not be created.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The simulation diverged. The recording is complete up to that tick.
    #[error(transparent)]
    Diverged(#[from] Diverged),
    /// The recording failed, and the scene says to stop then.
    #[error("{0}; with `outputs.bag.on_error: continue` the run continues without a recording")]
    Recording(String),
    /// The scene takes commands over ROS 2, which is not available.
    #[error("`controller: topics` needs ROS 2: {0}; enable it, or use `controller: builtin`")]
    NoTopics(String),
    /// The recording cannot be resumed.
    #[cfg(feature = "bag")]
    #[error(transparent)]
    Replay(Box<dyn std::error::Error + Send + Sync>),
}

/// A finished run. There is a summary even if it ended with an error.
#[derive(Debug)]
pub struct Finished {
    /// The summary.
    pub summary: Summary,
    /// Why it ended early, if it did.
    pub error: Option<RunError>,
}

/// Runs `scene` from its start to its end.
///
/// # Errors
/// If the run cannot begin.
pub fn launch(scene: &Scene, options: &Options) -> Result<Finished, RunError> {
    let begin = |compiled: Compiled, progress: &Progress| {
        Ok(start::start(compiled, &options.cache, progress)?)
    };
    launch_with(scene, options, begin, |inputs| external(scene, inputs))
}

/// Runs `scene` under the commands of `script` alone, to the end given by `options` or the scene.
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
    launch_with(scene, options, begin, |_| Inputs::of_script(script))
}

/// Runs `scene` to its end. `begin` creates the session of the compiled scene, and `select`
/// selects which external inputs may control the run; the others are read-only.
///
/// # Errors
/// If the run cannot begin.
pub fn launch_with(
    scene: &Scene,
    options: &Options,
    begin: impl FnOnce(Compiled, &Progress) -> Result<Started, RunError>,
    select: impl FnOnce(ExternalInputs) -> Inputs,
) -> Result<Finished, RunError> {
    let since_start = Pacer::start(false);
    let progress = Progress::new(options.is_quiet);
    let pool = ThreadPool::new(options.n_threads).map_err(StartError::from)?;
    let compiled = Compiled::new(scene, &pool).map_err(StartError::from)?;
    let scene = Arc::new(scene.clone());
    let substep_s = compiled.model.substep;
    let mesh = &compiled.model.membrane.mesh;
    let encoder = Arc::new(Encoder::new(&scene, &mesh.triangles, &mesh.positions));
    let sizes = Sizes { n_grains: scene.grains.count, n_vertices: mesh.n_vertices() };
    // Recording first: a folder that cannot be written is noticed before the membrane is filled.
    let Options { scene_file, facts, .. } = options;
    let connections = Connections {
        scene: &scene,
        scene_file,
        encoder: &encoder,
        progress: &progress,
        substep_s,
        facts,
    };
    let (mut outputs, external) = connections.open(sizes)?;
    let Started { mut session, origin } = begin(compiled, &progress)?;
    let end_ns = end_ns(&scene, options.duration);
    progress.running(end_ns);
    outputs.encoder = Some(encoder);
    let mut inputs = select(external);
    let loader = Loader::new(options.n_threads, options.cache.clone());
    inputs.server = inputs.server.map(|it| it.with_loader(loader));
    let supervision = Supervision { progress, shutdown: options.shutdown.clone(), end_ns };
    let mut context = RunContext::new(scene, inputs, outputs, supervision);
    let start_time_s = since_start.wall_time_s();
    let report = super::run(&mut session, &mut context);
    Ok(finish(&session, context, report, Known { origin, start_time_s }))
}

/// Inputs of a run that external commands and requests may control.
fn external(scene: &Scene, external: ExternalInputs) -> Inputs {
    let ExternalInputs { sources, server, clock } = external;
    let command_sources = CommandSources::new(scene, sources);
    // Only external controllers can be waited for.
    let gate = match server {
        Some(_) => Gate::new(lockstep(scene)).following(clock, scene.time.tick_ns),
        None => Gate::new(Lockstep::OFF),
    };
    Inputs { command_sources, gate, server }
}

/// How a run started.
struct Known {
    origin: &'static str,
    start_time_s: f64,
}

/// The earlier end of the scene and of the options (ns).
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
    session: &Session,
    context: RunContext,
    report: Report<Diverged>,
    known: Known,
) -> Finished {
    let sources = context.inputs.command_sources.counters();
    let bag = context.outputs.bag.as_ref().map(|folder| folder.display().to_string());
    let metrics = context.lift_monitor.metrics();
    let Closed { counters, .. } = context.close();
    let (ending, error) = match report.ending {
        Ok(Ending::RecordingFailed) => {
            let text = Ending::RecordingFailed.to_string();
            (text.clone(), Some(RunError::Recording(text)))
        }
        Ok(ending) => (ending.to_string(), None),
        Err(error) => ("diverged".to_owned(), Some(RunError::from(error))),
    };
    let (scene, model) = (session.scene(), &session.coupled().system.model);
    let last = &report.last.snapshot;
    let summary = Summary {
        scene: scene.name.clone(),
        seed: scene.seed,
        ending,
        metrics,
        real_time_factor: report.real_time_factor,
        wall_time_s: report.wall_time_s,
        start_time_s: known.start_time_s,
        start_state: known.origin,
        sim_time_s: Duration::from_nanos(last.time_ns).as_secs_f64(),
        substep_s: model.substep,
        n_grains: scene.grains.count,
        n_vertices: model.membrane.mesh.n_vertices(),
        state_digest: last.digest,
        bag,
        sinks: counters,
        sources,
        commands: last.command_counts,
    };
    Finished { summary, error }
}
