//! How fast it is: cases that anyone can repeat, measured in laps of the same work.
//!
//! A case starts from a state that was made ready before (and is kept in the cache of start states).
//! Each lap steps a copy of it: first unmeasured, until lists and caches are warm, then measured. All
//! laps of a case end in the same state, whatever the threads and however many laps there are, so
//! the digest of that state stands beside the speed. Before a case is reported its contacts, overlaps and
//! speeds are looked at: an empty, exploded or frozen system would look fast.

mod beam; // grains in a closed bar
mod cases; // the list of cases
pub mod history_csv; // results kept over time
#[cfg(all(feature = "ros", feature = "shm"))]
mod latency; // latency of the loop
mod lift; // a whole session
mod packing; // grains in a box
mod prepare; // initial states
mod process; // resource use of the process
mod reference_codes; // the same cases in other DEM codes
mod repetitions; // stepping and timing
pub mod result; // the result of a case
mod sanity; // checks of the system that is measured

pub use beam::BeamError;
pub use cases::{CASES, Case};
#[cfg(all(feature = "ros", feature = "shm"))]
pub use latency::{Latency, LatencyError, PrivateError, listen};
pub use reference_codes::{PeerError, PeerFigures};
pub use result::Figures;
pub use sanity::Unsound;

use crate::{
    experiments, host::cache::Cache, node, physics::health::Diverged, runner::error::RunnerError,
    scene::SceneError,
};

/// How the cases are run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Solver threads.
    pub n_threads: usize,
    /// Time on the clock for which laps are repeated (s); there are always a few.
    pub seconds: f64,
    /// Where states to start from are kept.
    pub cache: Cache,
    /// True runs other codes on the same packings, if they are installed.
    pub with_peers: bool,
    /// True tells nothing on standard error while a state is made ready.
    pub is_quiet: bool,
}

/// Why there are no figures.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// There is no such case.
    #[error("no case `{name}`; there are: {}", known())]
    NoSuchCase {
        /// What was asked for.
        name: String,
    },
    /// The state is not worth measuring.
    #[error("{case}: {fault}")]
    Unsound {
        /// The case.
        case: String,
        /// What is wrong.
        fault: Unsound,
    },
    /// Two laps did not end in the same state.
    #[error(
        "{case}: lap {repetition} ended with digest {found:016x}, the first with {expected:016x}; the same work \
         must give the same bits"
    )]
    Unequal {
        /// The case.
        case: String,
        /// Number of the lap.
        repetition: usize,
        /// Its digest.
        found: u64,
        /// That of the first.
        expected: u64,
    },
    /// The system cannot go on.
    #[error("{case}: {fault}")]
    Diverged {
        /// The case.
        case: String,
        /// Why.
        fault: Diverged,
    },
    /// The experiment ended before the state that is to be measured.
    #[error("{case}: the experiment came to its end before there was anything to measure")]
    NoMoment {
        /// The case.
        case: String,
    },
    /// The experiment cannot be set up.
    #[error(transparent)]
    Experiment(#[from] experiments::StartError),
    /// There is no such experiment.
    #[error(transparent)]
    Lab(#[from] RunnerError),
    /// Its scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The session cannot be started.
    #[error(transparent)]
    Session(#[from] node::start::StartError),
    /// The beam cannot be made.
    #[error("beam: {0}")]
    Beam(#[from] BeamError),
    /// The grains find no place to grow from.
    #[error("packing: {0}")]
    NoRoom(#[from] crate::physics::packing::scatter::NoRoom),
    /// Another code does not do what it should.
    #[error("{case}: {fault}")]
    Peer {
        /// The case.
        case: String,
        /// What is wrong.
        fault: PeerError,
    },
    /// The loop's latencies cannot be measured.
    #[cfg(all(feature = "ros", feature = "shm"))]
    #[error("latency: {fault}")]
    Latency {
        /// Why.
        fault: LatencyError,
    },
    /// The operating system gives no threads.
    #[error("solver threads: {0}; use fewer with --threads")]
    Threads(#[from] crate::base::parallel::ThreadPoolError),
}

impl BenchError {
    /// True if the command line asks for what there is not.
    pub fn is_of_command_line(&self) -> bool {
        matches!(self, Self::NoSuchCase { .. })
    }
}

fn known() -> String {
    let names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
    names.join(", ")
}

/// The cases of these names; all that are run by default if there are none.
///
/// # Errors
/// If there is no case of a name.
pub fn chosen(names: &[String]) -> Result<Vec<&'static Case>, BenchError> {
    if names.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let by_name = |name: &String| {
        let found = CASES.iter().find(|case| case.name == *name);
        found.ok_or_else(|| BenchError::NoSuchCase { name: name.clone() })
    };
    names.iter().map(by_name).collect()
}

/// Measures one case.
///
/// # Errors
/// If it cannot be started, or is not worth measuring.
pub fn run(case: &Case, options: &Options) -> Result<Figures, BenchError> {
    process::forget_peak();
    match &case.kind {
        cases::Kind::Lift => lift::run(case, options),
        #[cfg(all(feature = "ros", feature = "shm"))]
        cases::Kind::Latency => latency::run(case, options),
        cases::Kind::Grains(..) | cases::Kind::Beam | cases::Kind::Experiment(..) => {
            let mut course = repetitions::Course::new(case, options)?;
            let mut peers = course.peers()?;
            while !course.is_over() {
                course.repetition()?;
                // In turns, so that a busy minute of the machine hits both.
                if let Some(peers) = &mut peers {
                    peers
                        .repetition()
                        .map_err(|fault| BenchError::Peer { case: case.name.to_owned(), fault })?;
                }
            }
            course.figures(peers.as_ref())
        }
    }
}
