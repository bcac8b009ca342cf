//! Why an experiment cannot be run. Every error names its remedy.

use std::{io, path::PathBuf};

use crate::{
    experiments::EXPERIMENTS,
    scene::{SceneError, error::near_matches},
};

/// Why an experiment cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum RunnerError {
    /// No experiment has this name.
    #[error("no experiment `{name}`; {}known experiments: {}", did_you_mean(.near), known_names())]
    Unknown {
        /// The requested name.
        name: String,
        /// Similar names.
        near: Vec<String>,
    },
    /// The scene is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file or folder cannot be written.
    #[error("{}: cannot be written: {reason}; choose a writable folder with --out", path.display())]
    Unwritable {
        /// The file or folder.
        path: PathBuf,
        /// Reason given by the operating system.
        reason: io::Error,
    },
    /// The folder holds other files.
    #[error(
        "{}: contains files, but no experiment; choose a new or empty folder with --out",
        path.display()
    )]
    Foreign {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds cases of another plan.
    #[error(
        "{}: contains cases of another plan: {}; restart with --fresh, or choose another folder \
         with --out{}",
        path.display(),
        differences.join("; "),
        if *is_program_only { "; --mixed-builds continues, and the result mentions it" } else { "" }
    )]
    OtherPlan {
        /// The folder.
        path: PathBuf,
        /// The differences.
        differences: Vec<String>,
        /// True if only the program differs.
        is_program_only: bool,
    },
    /// Another process uses the folder.
    #[error("{}: another jamgrip process is using it; wait, or choose another folder with --out", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A stored result cannot be read.
    #[error("{}: cannot be read as a result: {reason}; run the experiment again", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// The operating system cannot start the threads.
    #[error("threads: {0}; request fewer with --threads")]
    Threads(#[from] crate::base::parallel::ThreadPoolError),
}

impl RunnerError {
    /// The error for an unknown experiment.
    pub fn unknown(name: &str) -> Self {
        let near = near_matches(name, EXPERIMENTS.iter().map(|it| it.name()));
        Self::Unknown { name: name.to_owned(), near }
    }

    /// True if the command line or the scene is invalid.
    pub fn is_of_command_line(&self) -> bool {
        matches!(self, Self::Unknown { .. } | Self::Scene(_))
    }
}

fn did_you_mean(near: &[String]) -> String {
    let quoted: Vec<String> = near.iter().map(|name| format!("`{name}`")).collect();
    if near.is_empty() { String::new() } else { format!("did you mean {}? ", quoted.join(" or ")) }
}

fn known_names() -> String {
    EXPERIMENTS.iter().map(|it| it.name()).collect::<Vec<_>>().join(", ")
}
