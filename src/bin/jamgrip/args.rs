//! The command line.

use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand};
use jamgrip::{
    base::lanes::Width,
    experiments::Size,
    runner::outcome::{n_processors, sized_name},
};

/// The command line.
#[derive(Debug, Parser)]
#[command(
    version,
    about = "Simulates a granular jamming gripper as a ROS 2 node",
    long_about = "Simulates a granular jamming gripper: a flexible membrane filled with grains, \
                  evacuated to hold a rigid object. Publishes on ROS 2 topics and in shared \
                  memory, takes commands from ROS 2 topics, and records to rosbag2.",
    after_help = "Examples:\n  \
                  jamgrip run launch_configs/pick_and_lift.yaml\n  \
                  jamgrip run launch_configs/pick_and_lift.yaml --set object.friction=0 --json\n  \
                  jamgrip check launch_configs/pick_and_lift.yaml\n  \
                  jamgrip experiment --list\n  \
                  jamgrip validate\n\n\
                  Exit codes: 0 finished, or interrupted once; 1 the run could not start or \
                  failed; 2 invalid command line or scene; 130 interrupted twice. \
                  For experiments see `jamgrip help experiment`."
)]
pub(crate) struct Cli {
    /// Subcommand.
    #[command(subcommand)]
    pub(crate) action: Action,

    /// Maximum SIMD width: 8 (AVX-512), 4 (AVX2) or 1; does not change results
    #[arg(long, global = true, value_name = "N", value_parser = lanes)]
    pub(crate) lanes: Option<Width>,
}

fn lanes(text: &str) -> Result<Width, String> {
    match text {
        "1" => Ok(Width::One),
        "4" => Ok(Width::Four),
        "8" => Ok(Width::Eight),
        _ => Err("expected 1, 4 or 8".to_owned()),
    }
}

/// Subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Action {
    /// Run a scene
    Run(Run),
    /// Play, verify, or branch from a recording
    #[cfg(feature = "bag")]
    #[command(after_help = crate::args_bag::REPLAY_HELP)]
    Replay(crate::args_bag::Replay),
    /// Inspect, check and repair recordings (any MCAP file or rosbag2 folder)
    #[cfg(feature = "bag")]
    #[command(subcommand)]
    Bag(crate::args_bag::Bag),
    /// Check a scene and print it with all defaults
    Check(SceneArgs),
    /// Run a validation experiment and compare it with published results
    #[command(after_help = EXPERIMENT_HELP)]
    Experiment(Experiment),
    /// Run all quick experiments and print one table of results
    #[command(after_help = VALIDATE_HELP)]
    Validate(Validate),
    /// Measure the speed of the simulation
    #[command(after_help = BENCH_HELP)]
    Bench(Bench),
    /// Measure the latency of another process: part of `bench --case latency`
    #[cfg(all(feature = "ros", feature = "shm"))]
    #[command(hide = true)]
    BenchListener {
        /// Prefix of the streams
        prefix: String,
        /// Duration of the run (s)
        seconds: f64,
    },
    /// Generate the validation report (Markdown and SVG) from stored results
    Report {
        /// Folder of result files, for example tests/golden/validation
        from: PathBuf,
        /// Folder for validation.md and figures/*.svg, for example docs
        to: PathBuf,
    },
}

const EXPERIMENT_HELP: &str = "\
Writes result.json, report.html and curves/*.csv. Ctrl-C saves all running cases; the same command \
resumes them with identical results. Running cases are also saved once a minute.\n\n\
Examples:\n  \
jamgrip experiment triaxial --full --threads 2\n  \
jamgrip experiment laws --set steps_per_contact=1000 --out results/laws_fine\n\n\
Exit codes: 0 all rows pass, 1 a case could not run, 2 invalid command line or scene, \
3 a row fails, 130 interrupted.";

const VALIDATE_HELP: &str = "\
Without --out nothing is written to disk and no earlier results are used.\n\n\
With --json standard output is an array of rows, one per line: id, quantity, unit, oracle, tolerance, \
measured, pass, reason; also oracle_source, relation, experiment, wall_s, left_validity. A number that \
is not finite is null.\n\n\
Exit codes: 0 all rows pass, 1 a case could not run or finish (its row also fails), \
2 invalid command line, 3 a row fails, 130 interrupted.";

const BENCH_HELP: &str = "\
Each case starts from a cached state (computing it the first time takes minutes) and repeats the same \
steps from copies of it. The digest is that of the state after one repetition; it does not depend on the \
number of threads or on --seconds.\n\n\
Examples:\n  \
jamgrip bench --case grains_3k_rest --case grains_3k_flow --threads 1\n  \
jamgrip bench --json --seconds 1\n\n\
Exit codes: 0 all cases were measured, 1 a case failed its checks or could not run, 2 invalid command \
line.";

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub(crate) struct Bench {
    /// List all cases
    #[arg(long)]
    pub(crate) list: bool,
    /// Case to measure; may be repeated [default: all]
    #[arg(long = "case", value_name = "NAME", conflicts_with = "list")]
    pub(crate) cases: Vec<String>,
    /// Number of solver threads [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Minimum wall-clock time per case; at least three repetitions
    #[arg(long, value_name = "S", default_value_t = 3.0, value_parser = seconds)]
    pub(crate) seconds: f64,
    /// Also measure LAMMPS, LIGGGHTS and YADE, if installed, on the same packings
    #[arg(long)]
    pub(crate) peers: bool,
    /// Print only a JSON array of cases, one per line
    #[arg(long)]
    pub(crate) json: bool,
    /// Append a row for each case to this CSV file, for example benches/results/desk.csv
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Cache of start states [default: ~/.cache/jamgrip]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
}

impl Bench {
    /// Number of solver threads.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if (0.0..=86_400.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("expected seconds from 0 to 86400, such as 0.5".to_owned())
    }
}

/// Arguments of `experiment`.
#[derive(Debug, Args)]
pub(crate) struct Experiment {
    /// Name of the experiment
    #[arg(required_unless_present = "list")]
    pub(crate) name: Option<String>,
    /// List all experiments
    #[arg(long, conflicts_with = "name")]
    pub(crate) list: bool,
    /// Reduced size, takes minutes (default)
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Full size, as published; may take hours
    #[arg(long)]
    full: bool,
    /// Set a key of the scene, for example grains.youngs_modulus=100MPa; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Use this scene file instead of the one of the experiment
    #[arg(long, value_name = "FILE")]
    pub(crate) scene: Option<PathBuf>,
    /// Folder for results and saved states [default: results/NAME_quick or results/NAME_full]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Discard earlier results in the folder
    #[arg(long)]
    pub(crate) fresh: bool,
    /// Resume cases of another build of jamgrip
    #[arg(long)]
    pub(crate) mixed_builds: bool,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Arguments of `validate`.
#[derive(Debug, Args)]
pub(crate) struct Validate {
    /// Run only these experiments
    pub(crate) names: Vec<String>,
    /// Folder for the results; the same command resumes an interrupted run
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Discard earlier results in the folder
    #[arg(long, requires = "out")]
    pub(crate) fresh: bool,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Arguments common to `experiment` and `validate`.
#[derive(Debug, Args)]
pub(crate) struct CommonArgs {
    /// Number of cases run in parallel, one thread each; does not change results
    /// [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Hide progress and print only JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl Experiment {
    /// The selected size.
    pub(crate) fn size(&self) -> Size {
        if self.full { Size::Full } else { Size::Quick }
    }

    /// Folder of the results.
    pub(crate) fn out(&self, name: &str) -> PathBuf {
        let by_name = || PathBuf::from("results").join(sized_name(name, self.size()));
        self.out.clone().unwrap_or_else(by_name)
    }
}

impl CommonArgs {
    /// Number of cases run in parallel.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }
}

/// A scene file and overrides.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file, for example launch_configs/pick_and_lift.yaml
    pub(crate) scene: PathBuf,
    /// Set a key of the scene, for example object.friction=0 or grains.youngs_modulus=100MPa; may
    /// be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Arguments of `run`.
#[derive(Debug, Args)]
pub(crate) struct Run {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Hide progress and print one line of JSON at the end
    #[arg(long)]
    pub(crate) json: bool,
    /// Disable ROS 2
    #[arg(long)]
    no_ros: bool,
    /// Disable the zero-copy streams
    #[arg(long)]
    no_stream: bool,
    /// Record into this folder, which must be new or empty
    #[arg(long, value_name = "DIR", conflicts_with = "no_bag")]
    bag: Option<PathBuf>,
    /// Disable recording
    #[arg(long)]
    no_bag: bool,
    /// End the run after this simulated time, for example 2s
    #[arg(long = "for", value_name = "TIME", value_parser = time)]
    pub(crate) duration: Option<f64>,
    /// Take all commands from this recording, any rosbag2 folder or .mcap file
    #[cfg(feature = "bag")]
    #[arg(long, value_name = "BAG")]
    pub(crate) commands: Option<PathBuf>,
    /// Number of solver threads; does not change results [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Cache of settled states [default: ~/.cache/jamgrip]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
    /// Do not run faster than real time
    #[arg(long)]
    real_time: bool,
}

impl SceneArgs {
    /// Overrides of the scene, as `key=value`.
    pub(crate) fn overrides(&self) -> Vec<String> {
        self.set.clone()
    }
}

impl Run {
    /// Overrides of the scene, as `key=value`. Flags that have a key become overrides.
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
        overrides.extend(self.bag.as_deref().map(bag_folder));
        overrides
    }

    /// Number of solver threads.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }
}

/// The override that records into a folder.
pub(crate) fn bag_folder(folder: &Path) -> String {
    // Any JSON string is also a YAML string.
    let folder = serde_json::Value::from(folder.to_string_lossy());
    format!("outputs.bag.folder={folder}")
}

/// Parses a time of zero or more (s).
pub(crate) fn time_or_zero(text: &str) -> Result<f64, String> {
    let seconds = jamgrip::scene::quantity::TIME.parse(text).map_err(|error| error.to_string())?;
    if 0.0 <= seconds { Ok(seconds) } else { Err("expected a time such as 2s".to_owned()) }
}

/// Parses a time above zero (s).
pub(crate) fn time(text: &str) -> Result<f64, String> {
    let seconds = time_or_zero(text)?;
    if 0.0 < seconds {
        Ok(seconds)
    } else {
        Err("expected a time above zero, such as 2s".to_owned())
    }
}
