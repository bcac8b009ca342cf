//! The command line, as written by people.

use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand};
use jamgrip::{
    base::lanes::Width,
    experiments::Size,
    runner::outcome::{n_processors, sized_name},
};

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
                  jamgrip check launch_configs/pick_and_lift.yaml\n  \
                  jamgrip experiment --list\n  \
                  jamgrip validate\n\n\
                  Exit codes: 0 the run came to its end or was interrupted once, 1 it could not \
                  begin or go on, 2 the command line or the scene is wrong, 130 interrupted twice. \
                  Experiments: see `jamgrip help experiment`."
)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) action: Action,

    /// At most so many numbers side by side in a register: 8 (AVX-512), 4 (AVX2) or 1; results are
    /// the same
    #[arg(long, global = true, value_name = "N", value_parser = lanes)]
    pub(crate) lanes: Option<Width>,
}

fn lanes(text: &str) -> Result<Width, String> {
    match text {
        "1" => Ok(Width::One),
        "4" => Ok(Width::Four),
        "8" => Ok(Width::Eight),
        _ => Err("there are 1, 4 and 8".to_owned()),
    }
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Action {
    /// Runs a scene to its end
    Run(Run),
    /// Plays a recording, proves it, or branches a new run off it
    #[cfg(feature = "bag")]
    #[command(after_help = crate::args_bag::REPLAY_HELP)]
    Replay(crate::args_bag::Replay),
    /// Looks into recordings, also those of others, and mends damaged ones
    #[cfg(feature = "bag")]
    #[command(subcommand)]
    Bag(crate::args_bag::Bag),
    /// Checks a scene and prints it with all defaults
    Check(SceneArgs),
    /// Runs an experiment and sets what it finds beside what its source shows
    #[command(after_help = EXPERIMENT_HELP)]
    Experiment(Experiment),
    /// Runs all quick experiments and prints one table of verdicts
    #[command(after_help = VALIDATE_HELP)]
    Validate(Validate),
    /// Measures how fast the simulation is
    #[command(after_help = BENCH_HELP)]
    Bench(Bench),
    /// Listens to a run whose latency is measured: a part of `bench --case latency`
    #[cfg(all(feature = "ros", feature = "shm"))]
    #[command(hide = true)]
    BenchListener {
        /// Prefix of the run's streams
        prefix: String,
        /// Seconds that the run takes
        seconds: f64,
    },
    /// Writes kept results beside what their sources show, as Markdown with figures
    Report {
        /// Folder of result files, for example tests/golden/validation
        from: PathBuf,
        /// Folder for validation.md and figures/*.svg, for example docs
        to: PathBuf,
    },
}

const EXPERIMENT_HELP: &str = "\
Writes result.json, report.html and curves/*.csv. Ctrl-C saves all running cases; the same command \
goes on from there, with the same bits. Cases that run also save themselves once a minute.\n\n\
Examples:\n  \
jamgrip experiment triaxial --full --threads 2\n  \
jamgrip experiment laws --set steps_per_contact=1000 --out results/laws_fine\n\n\
Exit codes: 0 all rows pass, 1 something could not run, 2 the command line or the scene is wrong, \
3 a row is red, 130 interrupted.";

const VALIDATE_HELP: &str = "\
Without --out nothing is written to disk and nothing is taken from an earlier run.\n\n\
With --json standard output is an array of rows, one a line: id, quantity, unit, oracle, tolerance, \
measured, pass, reason; also oracle_source, relation, experiment, wall_s, left_validity. A number that \
is none is null.\n\n\
Exit codes: 0 all rows pass, 1 something could not run (a case that did not come to its end is also a \
red row), 2 the command line is wrong, 3 a row is red, 130 interrupted.";

const BENCH_HELP: &str = "\
Each case starts from a state that is made once and kept (the first time takes minutes), and steps copies \
of it in laps of the same work. The digest is that of the state at the end of a lap: it depends on neither \
threads nor seconds.\n\n\
Examples:\n  \
jamgrip bench --case grains_3k_rest --case grains_3k_flow --threads 1\n  \
jamgrip bench --json --seconds 1\n\n\
Exit codes: 0 all cases were measured, 1 a case is not worth measuring or could not run, 2 the command line \
is wrong.";

/// Cases and how they are measured.
#[derive(Debug, Args)]
pub(crate) struct Bench {
    /// Names all cases
    #[arg(long)]
    pub(crate) list: bool,
    /// Measures this case; may be given more than once [default: all]
    #[arg(long = "case", value_name = "NAME", conflicts_with = "list")]
    pub(crate) cases: Vec<String>,
    /// Solver threads [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Time on the clock for which the laps of a case are repeated; there are always three
    #[arg(long, value_name = "S", default_value_t = 3.0, value_parser = seconds)]
    pub(crate) seconds: f64,
    /// Runs LAMMPS, LIGGGHTS and YADE, whichever is installed, on the same packings in turns with ours
    #[arg(long)]
    pub(crate) peers: bool,
    /// Prints an array of cases, one a line, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Adds a row for each case to this CSV file, for example benches/results/desk.csv
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Keeps states to start from in this folder [default: ~/.cache/jamgrip]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
}

impl Bench {
    /// How many solver threads.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if (0.0..=86_400.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err("write seconds from 0 to 86400, such as 0.5".to_owned())
    }
}

/// An experiment and how it is run.
#[derive(Debug, Args)]
pub(crate) struct Experiment {
    /// Name of the experiment
    #[arg(required_unless_present = "list")]
    pub(crate) name: Option<String>,
    /// Names all experiments
    #[arg(long, conflicts_with = "name")]
    pub(crate) list: bool,
    /// Smaller or faster, within minutes; the default
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// As in the source; may take hours
    #[arg(long)]
    full: bool,
    /// Changes a value of the scene, for example grains.youngs_modulus=100MPa; may be given more
    /// than once
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Reads this scene file instead of the experiment's own
    #[arg(long, value_name = "FILE")]
    pub(crate) scene: Option<PathBuf>,
    /// Folder for results and saved states [default: results/NAME_quick or results/NAME_full]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Begins anew, whatever is in the folder
    #[arg(long)]
    pub(crate) fresh: bool,
    /// Goes on with cases that another build of jamgrip has run
    #[arg(long)]
    pub(crate) mixed_builds: bool,
    #[command(flatten)]
    pub(crate) manner: Manner,
}

/// All quick experiments and how they are run.
#[derive(Debug, Args)]
pub(crate) struct Validate {
    /// Only these experiments
    pub(crate) names: Vec<String>,
    /// Folder for the results of each experiment; the same command goes on where it was ended
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Begins anew, whatever is in the folder
    #[arg(long, requires = "out")]
    pub(crate) fresh: bool,
    #[command(flatten)]
    pub(crate) manner: Manner,
}

/// What holds for one experiment and for all.
#[derive(Debug, Args)]
pub(crate) struct Manner {
    /// Cases at a time, each on one thread; the result is the same for any number
    /// [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Shows no progress; JSON on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

impl Experiment {
    /// How much is run.
    pub(crate) fn size(&self) -> Size {
        if self.full { Size::Full } else { Size::Quick }
    }

    /// Where the results go.
    pub(crate) fn out(&self, name: &str) -> PathBuf {
        let by_name = || PathBuf::from("results").join(sized_name(name, self.size()));
        self.out.clone().unwrap_or_else(by_name)
    }
}

impl Manner {
    /// Cases at a time.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }
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
    /// Takes all commands from this recording, a rosbag2 folder or an .mcap file, whoever made it
    #[cfg(feature = "bag")]
    #[arg(long, value_name = "BAG")]
    pub(crate) commands: Option<PathBuf>,
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
        overrides.extend(self.bag.as_deref().map(bag_folder));
        overrides
    }

    /// How many solver threads.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }
}

/// The change of a scene that records into a folder.
pub(crate) fn bag_folder(folder: &Path) -> String {
    // A JSON string is a YAML string, whatever stands in it.
    let folder = serde_json::Value::from(folder.to_string_lossy());
    format!("outputs.bag.folder={folder}")
}

/// A time of zero or more.
pub(crate) fn time_or_zero(text: &str) -> Result<f64, String> {
    let seconds = jamgrip::scene::quantity::TIME.parse(text).map_err(|error| error.to_string())?;
    if 0.0 <= seconds { Ok(seconds) } else { Err("write a time such as 2s".to_owned()) }
}

/// A time above zero.
pub(crate) fn time(text: &str) -> Result<f64, String> {
    let seconds = time_or_zero(text)?;
    if 0.0 < seconds { Ok(seconds) } else { Err("write a time above zero, such as 2s".to_owned()) }
}
