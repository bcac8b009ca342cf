//! Validated experiments: a scene, the cases it is cut into, and what their records must show.
//!
//! An experiment reads its scene into a plan. The plan names its cases; each case is a run that goes
//! on slice by slice, can be saved and resumed, and leaves a record. From the records alone, and
//! without any clock or file, the plan makes its findings: quantities, curves, plots, and rows in
//! which a measured value stands beside its oracle. Tests, reports and benches run the same cases.

pub mod findings; // results and verdicts
pub mod gripper; // the force that holds an object
pub mod hollow_sphere; // how much vacuum reaches an object
pub mod laws; // closed forms, equation by equation
mod number_format; // numbers in text
pub mod oracles; // closed forms to compare with
pub mod packing; // dense packings and what they bear
pub mod record; // the record of a case
mod saved_run; // a run as bytes
pub mod slide; // a ball drawn over a membrane
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

/// How much of an experiment is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Size {
    /// Smaller or faster, within minutes: for everyday checks.
    Quick,
    /// As in the source.
    Full,
}

/// Where the text of an experiment's scene comes from.
#[derive(Clone, Debug)]
pub struct SceneText<'a> {
    /// The YAML.
    pub text: &'a str,
    /// Names it in messages.
    pub source: &'a str,
    /// Changes of the form `key=value`.
    pub overrides: &'a [String],
    /// Which of the sections `quick` and `full` is laid over the rest.
    pub size: Size,
}

impl SceneText<'_> {
    /// The layers of the scene; `on_defaults` if the gripper's defaults lie below.
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
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// One line: what is done, and whose experiment it is.
    fn about(&self) -> &'static str;

    /// The scene that comes with the program: its path in the repository, and its text.
    fn scene(&self) -> (&'static str, &'static str);

    /// Reads and checks a scene.
    ///
    /// # Errors
    /// All faults of the scene at once.
    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError>;
}

/// A scene that has been read: what is to be run, and what must come out.
pub trait Plan: Send + Sync {
    /// Names of the cases, usable as file names; they are independent of each other.
    fn cases(&self) -> Vec<String>;

    /// Seconds that a case is expected to take on one thread, if that is known: the longest are
    /// begun first. Nothing else depends on it.
    fn expected_s(&self, _case: &str) -> Option<f64> {
        None
    }

    /// A case at its start.
    ///
    /// # Errors
    /// If the case cannot be set up.
    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError>;

    /// What the records show. Cases that failed have none; rows that need them are left out and
    /// named in the notes.
    fn evaluate(&self, records: &[Record]) -> Findings;
}

/// A case on its way.
pub trait Run: Send {
    /// Goes on by a slice of work, some tenths of a second at most.
    ///
    /// # Errors
    /// If the system cannot go on.
    fn advance(&mut self) -> Result<Progress, Diverged>;

    /// All that is needed to go on, as bytes.
    fn save(&self) -> Vec<u8>;

    /// Goes on from where a run of the same case was saved: the same bits as without the break.
    ///
    /// # Errors
    /// If the bytes are damaged or of another case.
    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError>;

    /// What was recorded so far; complete once `advance` has said so.
    fn record(&self) -> Record;

    /// What is being stepped, for those who measure how fast that goes; `None` where it is no single
    /// system.
    fn stepped(&self) -> Option<Stepped<'_>> {
        None
    }
}

/// A system and what its case does to it.
#[derive(Clone, Copy)]
pub struct Stepped<'a> {
    /// The system.
    pub system: &'a System,
    /// What is done to it after each substep.
    pub after: fn(&mut System),
}

/// How far a case is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What the last slice did; its time is counted under this name.
    pub stage: &'static str,
    /// Share of the whole work that is done, as far as it can be told.
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
        /// What was asked for.
        name: String,
        /// What there is.
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
    /// The grains find no place to grow from.
    #[error("packing: {0}")]
    NoRoom(#[from] crate::physics::packing::scatter::NoRoom),
}

/// Why a saved run cannot be resumed.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("saved state: {reason}; the case starts anew")]
pub struct ResumeError {
    /// What is wrong with it.
    pub reason: String,
}
