//! Benchmarks: reproducible cases, measured in repetitions of the same work.
//!
//! A case starts from a prepared state, which is kept in the cache of start states. Each repetition
//! steps a copy of it, first unmeasured, until lists and caches are warm, then measured. All
//! repetitions of a case end in the same state, independent of the number of threads and
//! repetitions, so the digest of that state is reported with the speed. Contacts, overlaps and
//! speeds are checked before a case is reported: an empty, exploded or frozen system would seem
//! fast.

mod beam; // grains in a closed bar
mod cases; // the list of cases
pub mod history_csv; // results kept over time
#[cfg(all(feature = "ros", feature = "shm"))]
mod latency; // latency of the loop
mod lift; // a complete session
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
pub use latency::{Latency, LatencyError, PrivateNetworkError, listen};
pub use reference_codes::{ReferenceError, ReferenceResult};
pub use result::BenchResult;
pub use sanity::InvalidState;

use crate::{
    experiments, host::cache::Cache, node, physics::health::Diverged, runner::error::RunnerError,
    scene::SceneError,
};

/// How the cases are run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Solver threads.
    pub n_threads: usize,
    /// Minimum wall-clock time of all repetitions (s); there are at least three.
    pub seconds: f64,
    /// Cache of the start states.
    pub cache: Cache,
    /// True runs other codes on the same packings, if they are installed.
    pub with_peers: bool,
    /// True prints nothing to standard error while a start state is prepared.
    pub is_quiet: bool,
}

/// Why a case has no result.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// There is no such case.
    #[error("no case `{name}`; there are: {}", known())]
    NoSuchCase {
        /// The unknown name.
        name: String,
    },
    /// The state is not valid for a benchmark.
    #[error("{case}: {error}")]
    InvalidState {
        /// The case.
        case: String,
        /// What is wrong.
        error: InvalidState,
    },
    /// Two repetitions did not end in the same state.
    #[error(
        "{case}: repetition {repetition} ended with digest {found:016x}, the first one with \
         {expected:016x}; the same work must give the same bits"
    )]
    Unequal {
        /// The case.
        case: String,
        /// Number of the repetition.
        repetition: usize,
        /// Its digest.
        found: u64,
        /// Digest of the first one.
        expected: u64,
    },
    /// The simulation diverged.
    #[error("{case}: {error}")]
    Diverged {
        /// The case.
        case: String,
        /// Why.
        error: Diverged,
    },
    /// The experiment ended before the state to be measured.
    #[error("{case}: the experiment ended before the state to be measured")]
    NoMoment {
        /// The case.
        case: String,
    },
    /// The experiment cannot be set up.
    #[error(transparent)]
    Experiment(#[from] experiments::StartError),
    /// There is no such experiment.
    #[error(transparent)]
    Runner(#[from] RunnerError),
    /// The scene is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The session cannot be started.
    #[error(transparent)]
    Session(#[from] node::start::StartError),
    /// The beam cannot be prepared.
    #[error("beam: {0}")]
    Beam(#[from] BeamError),
    /// There is no room for the grains.
    #[error("packing: {0}")]
    NoRoom(#[from] crate::physics::packing::scatter::NoRoom),
    /// A reference code failed.
    #[error("{case}: {error}")]
    Peer {
        /// The case.
        case: String,
        /// What is wrong.
        error: ReferenceError,
    },
    /// The latencies of the loop cannot be measured.
    #[cfg(all(feature = "ros", feature = "shm"))]
    #[error("latency: {error}")]
    Latency {
        /// Why.
        error: LatencyError,
    },
    /// The threads cannot be started.
    #[error("solver threads: {0}; use fewer with --threads")]
    Threads(#[from] crate::base::parallel::ThreadPoolError),
}

impl BenchError {
    /// True if the command line is wrong.
    pub fn is_of_command_line(&self) -> bool {
        matches!(self, Self::NoSuchCase { .. })
    }
}

fn known() -> String {
    let names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
    names.join(", ")
}

/// The cases with these names, or all cases if there are none.
///
/// # Errors
/// If there is no case with one of the names.
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
/// If it cannot be started, or its state is not valid for a benchmark.
pub fn run(case: &Case, options: &Options) -> Result<BenchResult, BenchError> {
    process::reset_peak();
    match &case.kind {
        cases::Kind::Lift => lift::run(case, options),
        #[cfg(all(feature = "ros", feature = "shm"))]
        cases::Kind::Latency => latency::run(case, options),
        cases::Kind::Grains(..) | cases::Kind::Beam | cases::Kind::Experiment(..) => {
            let mut measurement = repetitions::Measurement::new(case, options)?;
            let mut peers = measurement.peers()?;
            while !measurement.is_over() {
                measurement.repetition()?;
                // Alternating, so that other load of the machine affects both.
                if let Some(peers) = &mut peers {
                    peers
                        .repetition()
                        .map_err(|error| BenchError::Peer { case: case.name.to_owned(), error })?;
                }
            }
            measurement.result(peers.as_ref())
        }
    }
}
