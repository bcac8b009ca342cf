//! The command line for recordings.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use jamgrip::{replay::workers::CpuBudget, runner::outcome::n_processors};

use crate::args::{bag_folder, time, time_or_zero};

pub(crate) const REPLAY_HELP: &str = "\
Without --verify or --from the recording is published on ROS 2 topics with its original timing. With \
--cues, standard input takes pause, resume, toggle, next, seek TIME, rate FACTOR and quit, one per line. \
The services of rosbag2's player are available under /jamgrip_player: pause, resume, toggle_paused, is_paused, set_rate, get_rate, seek, \
play_next, burst, stop.\n\n\
--verify simulates the run again from the scene, the start and the commands in the recording, and \
compares the digest of every tick. With --json it prints one line: ticks (simulated), first_difference \
(the first tick whose digest differs, or null), real_time_factor, compared (digests), checkpoints \
(compared), remarks. The recording is split at its checkpoints and the segments are simulated in parallel: \
each starts at a checkpoint and must end equal to the next one.\n\n\
--from starts a new run from a recorded tick: the recorded commands continue, and --set changes the scene. \
Properties that the recorded state depends on (sizes, shapes, the seed) cannot change.\n\n\
Examples:\n  \
jamgrip replay bags/pick_and_lift --rate 0.5 --exclude '/jamgrip/grains'\n  \
jamgrip replay BAG --verify --threads 7             # one segment on seven threads\n  \
jamgrip replay BAG --verify --jobs 4                # four segments in parallel\n  \
jamgrip replay BAG --from 1.5s --set object.friction=0.4 --bag bags/slippery\n\n\
Exit codes: 0 success; 1 a digest differs, or an error occurred; 2 invalid command line or override; \
130 interrupted.";

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub(crate) struct Replay {
    /// Recording: a rosbag2 folder or an .mcap file
    pub(crate) bag: PathBuf,
    /// Simulate again and compare the digest of every tick
    #[arg(long, conflicts_with = "from")]
    pub(crate) verify: bool,
    /// Start a new run from this simulated time
    #[arg(long, value_name = "TIME", value_parser = time_or_zero)]
    pub(crate) from: Option<f64>,
    /// With --from, set a key of the scene; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "from")]
    set: Vec<String>,
    /// With --from, record the new run into this folder
    #[arg(long = "bag", value_name = "DIR", requires = "from", conflicts_with = "no_bag")]
    folder: Option<PathBuf>,
    /// With --from, disable recording
    #[arg(long, requires = "from")]
    no_bag: bool,
    /// With --from, disable ROS 2
    #[arg(long, requires = "from")]
    no_ros: bool,
    /// With --from, disable the zero-copy streams
    #[arg(long, requires = "from")]
    no_stream: bool,
    /// Start at this time; --verify starts at the last checkpoint before it
    #[arg(long, value_name = "TIME", value_parser = time_or_zero, conflicts_with = "from")]
    pub(crate) start: Option<f64>,
    /// End at this time
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub(crate) end: Option<f64>,
    /// Playback speed, as a multiple of the recorded speed
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = factor)]
    pub(crate) rate: f64,
    /// Start paused, until a cue or a service resumes it
    #[arg(long, conflicts_with_all = ["verify", "from"])]
    pub(crate) start_paused: bool,
    /// Play in a loop
    #[arg(long = "loop", conflicts_with_all = ["verify", "from"])]
    pub(crate) is_loop: bool,
    /// Play only these topics; a trailing `*` matches any suffix
    #[arg(long, value_name = "TOPIC", num_args = 1.., conflicts_with_all = ["verify", "from"])]
    pub(crate) topics: Vec<String>,
    /// Do not play these topics
    #[arg(long, value_name = "TOPIC", num_args = 1.., conflicts_with_all = ["verify", "from"])]
    pub(crate) exclude: Vec<String>,
    /// Publish /clock at this wall-clock rate instead of the recorded one [default: 40]
    #[arg(
        long, value_name = "HZ", num_args = 0..=1, default_missing_value = "40",
        value_parser = factor, conflicts_with_all = ["verify", "from"]
    )]
    pub(crate) clock: Option<f64>,
    /// Delay between announcing the topics and the first message, for readers to match
    #[arg(
        long, value_name = "TIME", default_value = "0.5s", value_parser = time_or_zero,
        conflicts_with_all = ["verify", "from"]
    )]
    pub(crate) delay: f64,
    /// Read cues from standard input while playing
    #[arg(long, conflicts_with_all = ["verify", "from"])]
    pub(crate) cues: bool,
    /// With --verify, fill the membrane again instead of using the recorded start
    #[arg(long, requires = "verify", conflicts_with = "start")]
    pub(crate) settle: bool,
    /// Hide progress and print one line of JSON at the end
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of solver threads; does not change results [default: all processors; with --verify
    /// the processors available to each segment]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// With --verify, number of segments simulated in parallel [default: all processors, with
    /// --threads 1]
    #[arg(
        long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024),
        requires = "verify"
    )]
    jobs: Option<u16>,
    /// Cache of settled states [default: ~/.cache/jamgrip]
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
}

impl Replay {
    /// Number of solver threads.
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.map_or_else(n_processors, usize::from)
    }

    /// How `--verify` divides the processors.
    pub(crate) fn cpu_budget(&self) -> CpuBudget {
        let (n_threads, n_jobs) = (self.threads.map(usize::from), self.jobs.map(usize::from));
        CpuBudget { n_processors: n_processors(), n_threads, n_jobs }
    }

    /// Overrides of the recorded scene, as `key=value`. The folder of the recording is not reused.
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

/// Subcommands of `bag`.
#[derive(Debug, Subcommand)]
pub(crate) enum Bag {
    /// Summarize a recording
    Info(Inspect),
    /// Check that a recording is complete and consistent; exit code 1 if not
    Check(Inspect),
    /// Plot force, pressure, heights and events over time as an HTML page
    Plot {
        /// Recording: a rosbag2 folder or an .mcap file
        bag: PathBuf,
        /// Output file [default: report.html in the folder, or next to the file]
        #[arg(long, short, value_name = "FILE")]
        output: Option<PathBuf>,
    },
    /// Repair a damaged recording: save what is readable as a new recording
    Recover {
        /// Recording: a rosbag2 folder or an .mcap file
        bag: PathBuf,
        /// Output [default: next to it, with the suffix _recovered]
        #[arg(long, short, value_name = "PATH")]
        output: Option<PathBuf>,
    },
}

/// Arguments of `bag info` and `bag check`.
#[derive(Debug, Args)]
pub(crate) struct Inspect {
    /// Recording: a rosbag2 folder or an .mcap file
    pub(crate) bag: PathBuf,
    /// Print one line of JSON
    #[arg(long)]
    pub(crate) json: bool,
}

fn factor(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(factor) if 0.0 < factor && f64::is_finite(factor) => Ok(factor),
        _ => Err("expected a number above zero, such as 2".to_owned()),
    }
}
