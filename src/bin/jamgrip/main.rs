//! The program `jamgrip`: parses the command line and runs the library.

mod args;
#[cfg(feature = "bag")]
mod args_bag;
#[cfg(feature = "bag")]
mod bag;
mod bench;
mod experiment;
mod remedy;
mod ros_args;
mod summary;

use std::{
    error::Error,
    io::{self, Write},
    process::ExitCode,
};

use args::{Action, Cli};
use clap::Parser;
use jamgrip::{
    base::lanes,
    benchmarks::BenchError,
    host::{cache::Cache, shutdown::Shutdown},
    node::launch::{Finished, Options, launch},
    runner::error::RunnerError,
    scene::{self, Scene, SceneError},
};
use ros_args::RosArgs;

/// The middleware crates log harmless warnings; `RUST_LOG` shows them.
const LOG_FILTER: &str = "warn,rustdds=off,ros2_client=off";

/// The run could not begin or continue.
const FAILED: u8 = 1;
/// The scene or the command line is invalid; clap uses the same code.
const INVALID_USAGE: u8 = 2;

fn main() -> ExitCode {
    let (line, ros_args) = match ros_args::split(std::env::args()) {
        Ok(split) => split,
        Err(error) => {
            drop(writeln!(io::stderr().lock(), "{error}"));
            return ExitCode::from(INVALID_USAGE);
        }
    };
    let cli = Cli::parse_from(line);
    let filter = ros_args.log_level.as_deref().map_or_else(
        || LOG_FILTER.to_owned(),
        |level| LOG_FILTER.replacen("warn", if level == "fatal" { "error" } else { level }, 1),
    );
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or(filter)).init();
    if let Some(width) = cli.lanes {
        lanes::limit(width);
    }
    let outcome = match cli.action {
        Action::Run(args) => run(&args, &ros_args),
        #[cfg(feature = "bag")]
        Action::Replay(args) => bag::replay(&args),
        #[cfg(feature = "bag")]
        Action::Bag(action) => bag::bag(&action),
        Action::Check(args) => check(&args),
        Action::Experiment(args) => experiment::experiment(&args),
        Action::Validate(args) => experiment::validate(&args),
        Action::Bench(args) => bench::bench(&args),
        #[cfg(all(feature = "ros", feature = "shm"))]
        Action::BenchListener { prefix, seconds } => bench::listen(&prefix, seconds),
        Action::Report { from, to } => experiment::report(&from, &to),
    };
    outcome.unwrap_or_else(|error| {
        let remedy = remedy::of(&*error).map(|it| format!("\n{it}")).unwrap_or_default();
        // Nothing can be done if standard error is closed.
        drop(writeln!(io::stderr().lock(), "{error}{remedy}"));
        let is_of_command_line = error.is::<SceneError>()
            || error.is::<ros_args::RosArgsError>()
            || error.downcast_ref::<BenchError>().is_some_and(BenchError::is_of_command_line)
            || error.downcast_ref::<RunnerError>().is_some_and(RunnerError::is_of_command_line);
        ExitCode::from(if is_of_command_line { INVALID_USAGE } else { FAILED })
    })
}

fn run(args: &args::Run, ros_args: &RosArgs) -> Result<ExitCode, Box<dyn Error>> {
    let mut overrides = ros_args.overrides()?;
    overrides.extend(args.overrides());
    let mut scene = scene::load(&args.scene.scene, &overrides)?;
    ros_args.rename(&mut scene.outputs.ros);
    let options = Options {
        n_threads: args.n_threads(),
        duration: args.duration,
        scene_file: args.scene.scene.clone(),
        cache: args.cache.clone().map_or_else(Cache::of_user, Cache::new),
        is_quiet: args.json,
        shutdown: Shutdown::listen()?,
        facts: Vec::new(),
    };
    let finished = start(&scene, args, &options)?;
    summary::print(&finished.summary, args.json)?;
    match finished.error {
        Some(error) => Err(error.into()),
        None => Ok(ExitCode::SUCCESS),
    }
}

#[cfg(feature = "bag")]
fn start(scene: &Scene, args: &args::Run, options: &Options) -> Result<Finished, Box<dyn Error>> {
    match &args.commands {
        Some(commands) => bag::run_by(commands, scene, options),
        None => Ok(launch(scene, options)?),
    }
}

#[cfg(not(feature = "bag"))]
fn start(scene: &Scene, _: &args::Run, options: &Options) -> Result<Finished, Box<dyn Error>> {
    Ok(launch(scene, options)?)
}

fn check(args: &args::SceneArgs) -> Result<ExitCode, Box<dyn Error>> {
    let scene = scene::load(&args.scene, &args.overrides())?;
    write!(io::stdout().lock(), "{}", scene::to_yaml(&scene))?;
    Ok(ExitCode::SUCCESS)
}
