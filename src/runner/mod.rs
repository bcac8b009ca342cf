//! Runs experiments: cases on threads, state on disk, findings in files and tables.
//!
//! A `LoadedExperiment` is an experiment whose scene has been read. Its cases are carried out side by side,
//! each on one thread; what they leave becomes an `Outcome`, and that is all that result files,
//! tables, reports and documents are made of.

mod case; // one case from start to end
pub mod error; // why an experiment cannot be run
pub mod eta; // estimated time of arrival
pub mod experiment; // an experiment whose scene has been read
pub mod folder; // files of an experiment
pub mod outcome; // results of an experiment
pub mod progress; // progress bars
pub mod report; // results as an HTML page
pub mod table; // results on the terminal
pub mod validation_doc; // kept results beside their sources, as Markdown
mod workers; // cases on threads

use std::path::{Path, PathBuf};

use self::{
    case::CaseEnd,
    error::RunnerError,
    experiment::{LoadedExperiment, RunRequest},
    folder::{Folder, Policy},
    outcome::Outcome,
    progress::ProgressBoard,
    workers::Job,
};
use crate::{experiments::findings::Findings, host::shutdown::Shutdown};

/// How experiments are run; nothing here changes what comes out.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// Cases at a time.
    pub n_threads: usize,
    /// True shows no progress.
    pub is_quiet: bool,
    /// What may be found in a folder.
    pub policy: Policy,
    /// Asks all cases to end early.
    pub shutdown: &'a Shutdown,
}

/// One experiment and where its files go, if they are wanted.
#[derive(Debug)]
pub struct Task<'a> {
    /// What is run.
    pub order: RunRequest<'a>,
    /// The folder.
    pub out: Option<PathBuf>,
}

/// How it ended.
#[derive(Debug)]
pub enum Ending {
    /// All cases came to an end, of one kind or the other. In the order of the tasks.
    Finished(Vec<Outcome>),
    /// Someone asked it to end.
    Interrupted {
        /// Cases that had come to their end.
        n_done: usize,
        /// All cases.
        n_cases: usize,
    },
}

/// Runs experiments, all cases of all of them in one queue.
///
/// # Errors
/// If something is wrong before the first case, or the files cannot be written.
pub fn run(tasks: &[Task<'_>], options: &Options<'_>) -> Result<Ending, RunnerError> {
    let loaded_all = tasks
        .iter()
        .map(|task| LoadedExperiment::read(&task.order))
        .collect::<Result<Vec<_>, RunnerError>>()?;
    let folders = tasks
        .iter()
        .zip(&loaded_all)
        .map(|(task, loaded)| open(task.out.as_deref(), loaded, options.policy))
        .collect::<Result<Vec<_>, RunnerError>>()?;
    let jobs = jobs(&loaded_all, &folders);
    let progress = ProgressBoard::new(&jobs, options.n_threads, options.is_quiet);
    let ends = workers::work(&jobs, options.n_threads, options.shutdown, &progress);
    progress.end();
    let ends = ends?;
    if ends.iter().any(|end| matches!(end, CaseEnd::Stopped)) {
        let n_done = ends.iter().filter(|end| !matches!(end, CaseEnd::Stopped)).count();
        return Ok(Ending::Interrupted { n_done, n_cases: ends.len() });
    }
    let mut ends = ends.into_iter();
    let mut outcomes = Vec::new();
    for (loaded, folder) in loaded_all.iter().zip(&folders) {
        let of_study = ends.by_ref().take(loaded.cases().len()).collect();
        let (outcome, findings) = loaded.conclude(of_study);
        if let Some(folder) = folder {
            write(folder, &outcome, &findings)?;
        }
        outcomes.push(outcome);
    }
    Ok(Ending::Finished(outcomes))
}

fn open(
    out: Option<&Path>,
    loaded: &LoadedExperiment<'_>,
    policy: Policy,
) -> Result<Option<Folder>, RunnerError> {
    out.map(|path| Folder::open(path, &loaded.identity, policy)).transpose()
}

/// All cases, in the order of the studies.
fn jobs<'a>(loaded_all: &'a [LoadedExperiment<'a>], folders: &'a [Option<Folder>]) -> Vec<Job<'a>> {
    let of_study = |(loaded, folder): (&'a LoadedExperiment<'a>, &'a Option<Folder>)| {
        loaded.cases().iter().map(move |case| Job { loaded, folder: folder.as_ref(), case })
    };
    loaded_all.iter().zip(folders).flat_map(of_study).collect()
}

fn write(folder: &Folder, outcome: &Outcome, findings: &Findings) -> Result<(), RunnerError> {
    folder.write_text("result.json", &outcome.to_text())?;
    for curve in &findings.curves {
        folder.write_curve(curve)?;
    }
    folder.write_text("report.html", &report::page(outcome))
}
