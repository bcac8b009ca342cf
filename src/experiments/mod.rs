//! Validation experiments: reproductions of published tests, compared with their results.
//!
//! An experiment is a folder with the same files in each; the roles are
//!
//! | file | holds |
//! |---|---|
//! | `scene.rs` | the keys of its scene, one line each (`scene_keys!`), and the rules that join them |
//! | `cases.rs` | the list of cases: independent runs, which may run in parallel, and their names |
//! | `build.rs` | the physical system of a case at its start |
//! | `measure.rs` | what is read from a system while it runs, and from records afterward |
//! | `run.rs` | a `Run`: the phases of a case, slice by slice, how it is saved and resumed |
//! | `plots.rs` | plots and tables of the report |
//! | `evaluate.rs` | rows that compare measured values with their oracles, and notes |
//! | `mod.rs` | the `Experiment` and its `Plan`, which tie these together |
//!
//! A file may use those above it. To add an experiment, write
//! a scene in `launch_configs/experiments`, these files, and a line in `EXPERIMENTS`. Findings are
//! computed from records alone, without clock or files; tests, reports and benchmarks run the same
//! cases.

pub mod findings; // results and verdicts
pub mod gripper; // holding force of the gripper
pub mod hollow_sphere; // pressure on an object inside a shell of grains
pub mod laws; // every equation against its closed form
mod number_format; // numbers in text formats
pub mod oracles; // closed forms to compare with
pub mod packing; // dense packings: jamming, moduli, stress
pub mod record; // the record of a case
mod saved_run; // a run as bytes
pub mod slide; // a ball pulled over a membrane
pub mod triaxial; // grains under confining pressure

use serde::{Deserialize, Serialize};

use crate::{
    physics::{System, health::Diverged},
    scene::{SceneError, text::Layers},
};
use findings::Findings;
pub use record::Record;

/// All experiments, in the order of the sources.
pub static EXPERIMENTS: &[&dyn Experiment] = &[
    &laws::Laws,
    &slide::Slide,
    &triaxial::Triaxial,
    &packing::Packing,
    &gripper::Gripper,
    &hollow_sphere::HollowSphere,
];

/// Which size of an experiment is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Size {
    /// Smaller or faster, for everyday checks within minutes.
    Quick,
    /// The size of the source.
    Full,
}

/// The scene text of an experiment.
#[derive(Clone, Debug)]
pub struct SceneText<'a> {
    /// The YAML.
    pub text: &'a str,
    /// Name of the text in messages.
    pub source: &'a str,
    /// Overrides of the form `key=value`.
    pub overrides: &'a [String],
    /// Which of the sections `quick` and `full` overrides the rest.
    pub size: Size,
}

impl SceneText<'_> {
    /// The layers of the scene; with `on_defaults` they override the gripper's defaults.
    pub(crate) fn layers(&self, on_defaults: bool) -> Layers<'_> {
        let chosen = match self.size {
            Size::Quick => "quick",
            Size::Full => "full",
        };
        let Self { text, source, overrides, .. } = *self;
        Layers { text, source, variants: (&["quick", "full"], chosen), overrides, on_defaults }
    }
}

/// One experiment.
pub trait Experiment: Sync {
    /// Name on the command line.
    fn name(&self) -> &'static str;

    /// One line: what is tested, and the source.
    fn about(&self) -> &'static str;

    /// The built-in scene: its path in the repository and its text.
    fn scene(&self) -> (&'static str, &'static str);

    /// Reads and checks a scene.
    ///
    /// # Errors
    /// All errors of the scene at once.
    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError>;
}

/// A checked scene: the cases to run, and the evaluation of their records.
pub trait Plan: Send + Sync {
    /// Names of the cases, usable as file names. Cases are independent of each other.
    fn cases(&self) -> Vec<String>;

    /// Expected run time of a case on one thread (s), if known. The longest cases start first;
    /// nothing else depends on it.
    fn expected_s(&self, _case: &str) -> Option<f64> {
        None
    }

    /// Sets a case up.
    ///
    /// # Errors
    /// If there is no such case, or it cannot be set up.
    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError>;

    /// Evaluates the records. Cases that failed have none; rows that need them are left out, and a
    /// note says so.
    fn evaluate(&self, records: &[Record]) -> Findings;
}

/// A running case.
pub trait Run: Send {
    /// Advances by a slice of work of at most a few tenths of a second.
    ///
    /// # Errors
    /// If the simulation diverges.
    fn advance(&mut self) -> Result<Progress, Diverged>;

    /// Encodes everything needed to resume.
    fn save(&self) -> Vec<u8>;

    /// Resumes from a saved run of the same case, with the same bits as without the interruption.
    ///
    /// # Errors
    /// If the bytes are damaged or belong to another case.
    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError>;

    /// The record so far; complete once `advance` returned `is_done`.
    fn record(&self) -> Record;

    /// The system that is being stepped, for benchmarks; `None` if there is no single one.
    fn stepped(&self) -> Option<Stepped<'_>> {
        None
    }
}

/// A system, and what its case does after each substep.
#[derive(Clone, Copy)]
pub struct Stepped<'a> {
    /// The system.
    pub system: &'a System,
    /// Called after each substep.
    pub after: fn(&mut System),
}

/// Progress of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Phase of the last slice; its wall-clock time is counted under this name.
    pub phase: &'static str,
    /// Estimated share of the whole work that is done.
    pub share: f64,
    /// True at the end.
    pub is_done: bool,
}

/// Why a case cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// There is no such case.
    #[error("no case `{name}`; there are: {}", known.join(", "))]
    NoSuchCase {
        /// The unknown name.
        name: String,
        /// Names of all cases.
        known: Vec<String>,
    },
    /// The scene cannot be compiled.
    #[error(transparent)]
    Compile(#[from] crate::cosim::compile::CompileError),
    /// The membrane cannot be meshed.
    #[error("membrane: {0}")]
    Mesh(#[from] crate::physics::membrane::mesh::MeshError),
    /// The parts of the system do not fit each other.
    #[error("system: {0}")]
    Build(#[from] crate::physics::builder::BuildError),
    /// There is no room for the grains.
    #[error("packing: {0}")]
    NoRoom(#[from] crate::physics::packing::scatter::NoRoom),
}

/// Why a saved run cannot be resumed.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("saved state: {reason}; the case restarts from its beginning")]
pub struct ResumeError {
    /// What is wrong with it.
    pub reason: String,
}

/// The case with this name.
///
/// # Errors
/// If there is none.
fn find_case<C>(
    cases: impl IntoIterator<Item = C>,
    name: &str,
    name_of: impl Fn(&C) -> String,
) -> Result<C, StartError> {
    let mut known = Vec::new();
    for case in cases {
        let own = name_of(&case);
        if own == name {
            return Ok(case);
        }
        known.push(own);
    }
    Err(StartError::NoSuchCase { name: name.to_owned(), known })
}
