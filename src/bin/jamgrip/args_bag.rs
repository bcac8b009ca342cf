//! The command line of recordings.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use jamgrip::{replay::workers::CpuBudget, runner::outcome::n_processors};

use crate::args::{bag_folder, time, time_or_zero};

pub(crate) const REPLAY_HELP: &str = "\
Without --verify or --from the recording is published on ROS 2 topics with its original timing; --cues \
takes pause, resume, toggle, next, seek TIME, rate FACTOR and quit, one a line. The services of rosbag2's \
player are below /jamgrip_player: pause, resume, toggle_paused, is_paused, set_rate, get_rate, seek, \
play_next, burst, stop.\n\n\
--verify simulates again from the scene, the start and the commands in the recording and compares the \
digest of every tick. With --json it ends with one line: ticks (simulated), first_difference (the first \
tick whose digest differs, or null), real_time_factor, compared (digests), checkpoints (compared), remarks. \
The recording is cut at its checkpoints, and the parts are simulated side by side, in the order of time: each \
begins at a checkpoint and ends with everything equal to the next one.\n\n\
--from branches a new run off a recorded moment: the recorded commands go on, --set changes the scene. \
What the recorded grains, membrane or object have in them (sizes, shapes, the seed) cannot change.\n\n\
Examples:\n  \
jamgrip replay bags/pick_and_lift --rate 0.5 --exclude '/jamgrip/grains'\n  \
jamgrip replay BAG --verify --threads 7             # one part, as recorded, on seven threads\n  \
jamgrip replay BAG --verify --jobs 4                # four parts at a time\n  \
jamgrip replay BAG --from 1.5s --set object.friction=0.4 --bag bags/slippery\n\n\
Exit codes: 0 played, every digest equal, or run to its end; 1 a digest differs, or it cannot be done; \
2 the command line or a change is wrong; 130 interrupted.";

/// A recording and what becomes of it.
#[derive(Debug, Args)]
pub(crate) struct Replay {
    /// The recording: a rosbag2 folder, or an .mcap file
    pub(crate) bag: PathBuf,
    /// Simulates again and proves every tick's digest equal
    #[arg(long, conflicts_with = "from")]
    pub(crate) verify: bool,
    /// Branches a new run off this simulated time
    #[arg(long, value_name = "TIME", value_parser = time_or_zero)]
    pub(crate) from: Option<f64>,
    /// With --from, changes a value of the scene; may be given more than once
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "from")]
    set: Vec<String>,
    /// With --from, records the new run into this folder
    #[arg(long = "bag", value_name = "DIR", requires = "from", conflicts_with = "no_bag")]
    folder: Option<PathBuf>,
    /// With --from, records nothing
    #[arg(long, requires = "from")]
    no_bag: bool,
    /// With --from, leaves ROS 2 out
    #[arg(long, requires = "from")]
    no_ros: bool,
    /// With --from, leaves the zero-copy streams out
    #[arg(long, requires = "from")]
    no_stream: bool,
    /// Begins at this time; --verify begins at the last checkpoint before it
    #[arg(long, value_name = "TIME", value_parser = time_or_zero, conflicts_with = "from")]
    pub(crate) start: Option<f64>,
    /// Ends at this time
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub(crate) end: Option<f64>,
    /// Plays so many times as fast as recorded
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = factor)]
    pub(crate) rate: f64,
    /// Stands still at first, until a cue or a service lets it go on
    #[arg(long, conflicts_with_all = ["verify", "from"])]
    pub(crate) start_paused: bool,
    /// Plays over and over
    #[arg(long = "loop", conflicts_with_all = ["verify", "from"])]
    pub(crate) is_loop: bool,
    /// Plays only these topics; `*` at the end stands for any rest
    #[arg(long, value_name = "TOPIC", num_args = 1.., conflicts_with_all = ["verify", "from"])]
    pub(crate) topics: Vec<String>,
    /// Does not play these topics
    #[arg(long, value_name = "TOPIC", num_args = 1.., conflicts_with_all = ["verify", "from"])]
    pub(crate) exclude: Vec<String>,
    /// Publishes /clock so often in wall time, in place of the recorded one [default: 40]
    #[arg(
        long, value_name = "HZ", num_args = 0..=1, default_missing_value = "40",
        value_parser = factor, conflicts_with_all = ["verify", "from"]
    )]
    pub(crate) clock: Option<f64>,
    /// Waits so long between announcing the topics and the first message, for readers to find them
    #[arg(
        long, value_name = "TIME", default_value = "0.5s", value_parser = time_or_zero,
        conflicts_with_all = ["verify", "from"]
    )]
    pub(crate) delay: f64,
    /// Takes cues from standard input while it plays
    #[arg(long, conflicts_with_all = ["verify", "from"])]
    pub(crate) cues: bool,
    /// With --verify, fills the bag again from scene and seed too, in place of the recorded start
    #[arg(long, requires = "verify", conflicts_with = "start")]
    pub(crate) settle: bool,
    /// Shows no progress and ends with one line of JSON on standard output
    #[arg(long)]
    pub(crate) json: bool,
    /// Solver threads of a simulation; the result is the same for any number [default: all
    /// processors; with --verify the processors that each part has]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// With --verify, parts of the recording that are simulated at a time [default: as many as there
    /// are processors for --threads, which is then 1]
    #[arg(
        long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024),
        requires = "verify"
    )]
    jobs: Option<u16>,
    /// Keeps settled start states in this folder [default: ~/.cache/jamgrip]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
}

impl Replay {
    /// How many solver threads.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }

    /// How the machine is shared out when a recording is verified.
    pub(crate) fn cpu_budget(&self) -> CpuBudget {
        let (n_threads, n_jobs) = (self.threads.map(usize::from), self.jobs.map(usize::from));
        CpuBudget { n_processors: n_processors(), n_threads, n_jobs }
    }

    /// Changes of the recorded scene, as `key=value`. The old recording's folder is not taken.
    pub(crate) fn overrides(&self) -> Vec<String> {
        let mut overrides = vec!["outputs.bag.folder=auto".to_owned()];
        overrides.extend(self.set.iter().cloned());
        let flags = [
            (self.no_ros, "outputs.ros.enabled=false"),
            (self.no_stream, "outputs.stream=false"),
            (self.no_bag, "outputs.bag.enabled=false"),
            (self.folder.is_some(), "outputs.bag.enabled=true"),
        ];
        let chosen = flags.into_iter().filter(|(is_set, _)| *is_set);
        overrides.extend(chosen.map(|(_, text)| text.to_owned()));
        overrides.extend(self.folder.as_deref().map(bag_folder));
        overrides
    }
}

/// What to do with a recording.
#[derive(Debug, Subcommand)]
pub(crate) enum Bag {
    /// Counts what is in a recording
    Info(Look),
    /// Checks that a recording is whole and agrees with itself; exit code 1 if not
    Check(Look),
    /// Draws force, pressure, heights and events over time, as a page of HTML
    Plot {
        /// The recording: a rosbag2 folder, or an .mcap file
        bag: PathBuf,
        /// Where to write the page [default: report.html in the folder, or beside the file]
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Saves what can be saved of a damaged recording, as a whole one beside it
    Recover {
        /// The recording: a rosbag2 folder, or an .mcap file
        bag: PathBuf,
        /// Where to save it [default: beside it, its name and _recovered]
        #[arg(long, short, value_name = "PATH")]
        output: Option<PathBuf>,
    },
}

/// A recording to look into.
#[derive(Debug, Args)]
pub(crate) struct Look {
    /// The recording: a rosbag2 folder, or an .mcap file
    pub(crate) bag: PathBuf,
    /// Prints one line of JSON
    #[arg(long)]
    pub(crate) json: bool,
}

fn factor(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(factor) if 0.0 < factor && f64::is_finite(factor) => Ok(factor),
        _ => Err("write a number above zero, such as 2".to_owned()),
    }
}
