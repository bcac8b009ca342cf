//! Why an experiment cannot be run. Every fault names its remedy.

use std::{io, path::PathBuf};

use crate::{
    experiments::EXPERIMENTS,
    scene::{SceneError, error::near_matches},
};

/// Why an experiment cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum RunnerError {
    /// No experiment has this name.
    #[error("no experiment `{name}`; {}there are: {}", did_you_mean(.near), known())]
    Unknown {
        /// What was asked for.
        name: String,
        /// Names spelled alike.
        near: Vec<String>,
    },
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file or folder cannot be written.
    #[error("{}: cannot be written: {reason}; name a writable folder with --out", path.display())]
    Unwritable {
        /// Which.
        path: PathBuf,
        /// What the operating system said.
        reason: io::Error,
    },
    /// The folder holds something else.
    #[error(
        "{}: holds files, but no experiment; name a new or empty folder with --out",
        path.display()
    )]
    Foreign {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds cases of another plan.
    #[error(
        "{}: holds cases of something else: {}; begin anew with --fresh, or name another folder \
         with --out{}",
        path.display(),
        differences.join("; "),
        if *is_program_only { "; --mixed-builds goes on, and the result says so" } else { "" }
    )]
    OtherPlan {
        /// The folder.
        path: PathBuf,
        /// What differs.
        differences: Vec<String>,
        /// True if only the program differs.
        is_program_only: bool,
    },
    /// Another process is at work in the folder.
    #[error("{}: another jamgrip is at work there; wait, or name another folder with --out", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// A kept result cannot be read.
    #[error("{}: cannot be read as a result: {reason}; run the experiment anew", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The operating system refuses threads.
    #[error("threads: {0}; ask for fewer with --threads")]
    Threads(#[from] crate::base::parallel::ThreadPoolError),
}

impl RunnerError {
    /// No experiment is called `name`.
    pub fn unknown(name: &str) -> Self {
        let near = near_matches(name, EXPERIMENTS.iter().map(|it| it.name()));
        Self::Unknown { name: name.to_owned(), near }
    }

    /// True if the command line or the scene is at fault, not the machine.
    pub fn is_of_command_line(&self) -> bool {
        matches!(self, Self::Unknown { .. } | Self::Scene(_))
    }
}

fn did_you_mean(near: &[String]) -> String {
    let quoted: Vec<String> = near.iter().map(|name| format!("`{name}`")).collect();
    if near.is_empty() { String::new() } else { format!("did you mean {}? ", quoted.join(" or ")) }
}

fn known() -> String {
    EXPERIMENTS.iter().map(|it| it.name()).collect::<Vec<_>>().join(", ")
}
