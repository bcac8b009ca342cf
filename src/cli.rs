//! The command line, as written by people.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

/// What was asked for.
#[derive(Debug, Parser)]
#[command(
    version,
    about = "Simulates a granular jamming gripper as a ROS 2 node",
    long_about = "Simulates a granular jamming gripper: grains in a flexible membrane, air sucked \
                  out, a rigid object held. Publishes on ROS 2 topics and in shared memory while \
                  it runs, takes commands from ROS 2 topics, and records a bag.",
    after_help = "Examples:\n  \
                  jamgrip run launch_configs/pick_and_lift.yaml\n  \
                  jamgrip run launch_configs/pick_and_lift.yaml --set object.friction=0 --json\n  \
                  jamgrip check launch_configs/pick_and_lift.yaml\n\n\
                  Exit codes: 0 the run came to its end or was interrupted once, 1 it could not \
                  begin or go on, 2 the command line or the scene is wrong, 130 interrupted twice."
)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) action: Action,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Action {
    /// Runs a scene to its end
    Run(Run),
    /// Checks a scene and prints it with all defaults
    Check(SceneArgs),
}

/// A scene and what is changed in it.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file, for example launch_configs/pick_and_lift.yaml
    pub(crate) scene: PathBuf,
    /// Changes a value of the scene, for example object.friction=0 or
    /// grains.youngs_modulus=100MPa; may be given more than once
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// A scene and how it is run.
#[derive(Debug, Args)]
pub(crate) struct Run {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Shows no progress and ends with one line of JSON on standard output
    #[arg(long)]
    pub(crate) json: bool,
    /// Leaves ROS 2 out
    #[arg(long)]
    no_ros: bool,
    /// Leaves the zero-copy streams out
    #[arg(long)]
    no_stream: bool,
    /// Records into this folder, which must not exist yet or be empty
    #[arg(long, value_name = "DIR", conflicts_with = "no_bag")]
    bag: Option<PathBuf>,
    /// Records nothing
    #[arg(long)]
    no_bag: bool,
    /// Ends the run after this simulated time, for example 2s
    #[arg(long = "for", value_name = "TIME", value_parser = time)]
    pub(crate) duration: Option<f64>,
    /// Solver threads; the result is the same for any number [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Keeps settled start states in this folder [default: ~/.cache/jamgrip]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
    /// Waits where the machine is faster than real time
    #[arg(long)]
    real_time: bool,
}

impl SceneArgs {
    /// Changes of the scene, as `key=value`.
    pub(crate) fn overrides(&self) -> Vec<String> {
        self.set.clone()
    }
}

impl Run {
    /// Changes of the scene, as `key=value`: every flag that has a key is nothing but that key.
    pub(crate) fn overrides(&self) -> Vec<String> {
        let mut overrides = self.scene.overrides();
        let flags = [
            (self.no_ros, "outputs.ros.enabled=false"),
            (self.no_stream, "outputs.stream=false"),
            (self.no_bag, "outputs.bag.enabled=false"),
            (self.bag.is_some(), "outputs.bag.enabled=true"),
            (self.real_time, "outputs.real_time=true"),
        ];
        let chosen = flags.into_iter().filter(|(is_set, _)| *is_set);
        overrides.extend(chosen.map(|(_, text)| text.to_owned()));
        overrides.extend(self.seed.map(|seed| format!("seed={seed}")));
        overrides.extend(self.bag.as_ref().map(|folder| {
            // A JSON string is a YAML string, whatever stands in it.
            let folder = serde_json::Value::from(folder.to_string_lossy());
            format!("outputs.bag.folder={folder}")
        }));
        overrides
    }

    /// How many solver threads.
    pub(crate) fn n_threads(&self) -> usize {
        let all = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        self.threads.map_or_else(all, usize::from)
    }
}

fn time(text: &str) -> Result<f64, String> {
    let seconds = jamgrip::scene::quantity::TIME.parse(text).map_err(|error| error.to_string())?;
    if 0.0 < seconds { Ok(seconds) } else { Err("write a time above zero, such as 2s".to_owned()) }
}
