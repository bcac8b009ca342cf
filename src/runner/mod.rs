//! Runs experiments: cases in parallel, with their state on disk, and results in files and tables.
//!
//! A [`LoadedExperiment`] is an experiment whose scene has been read. Its cases run in parallel,
//! each on one thread. Their results are combined into an [`Outcome`], from which result files,
//! tables, reports and documents are made.

mod case; // runs one case
pub mod error; // errors
pub mod eta; // estimated remaining time
pub mod experiment; // an experiment whose scene has been read
pub mod folder; // files of an experiment
pub mod outcome; // results of an experiment
pub mod progress; // progress bars
pub mod report; // results as an HTML page
pub mod table; // results on the terminal
pub mod validation_doc; // the validation document, from stored results
mod workers; // runs cases in parallel

use std::path::{Path, PathBuf};

use self::{
    case::CaseEnd,
    error::RunnerError,
    experiment::{LoadedExperiment, RunRequest},
    folder::{Folder, Policy},
    outcome::Outcome,
    progress::ProgressDisplay,
    workers::Job,
};
use crate::{experiments::findings::Findings, host::shutdown::Shutdown};

/// Options of a run; they do not affect the results.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// Number of cases that run at the same time.
    pub n_threads: usize,
    /// True to show no progress.
    pub is_quiet: bool,
    /// What to do with cases in the folder.
    pub policy: Policy,
    /// Set when the user requests to stop.
    pub shutdown: &'a Shutdown,
}

/// An experiment to run, and the folder for its files, if any.
#[derive(Debug)]
pub struct Task<'a> {
    /// What to run.
    pub request: RunRequest<'a>,
    /// The folder.
    pub out: Option<PathBuf>,
}

/// How the run ended.
#[derive(Debug)]
pub enum Ending {
    /// All cases finished or failed. Outcomes are in the order of the tasks.
    Finished(Vec<Outcome>),
    /// The user stopped the run.
    Interrupted {
        /// Number of cases that had ended.
        n_done: usize,
        /// Number of all cases.
        n_cases: usize,
    },
}

/// Runs experiments. All cases of all experiments share one queue.
///
/// # Errors
/// If an experiment cannot be loaded, or its files cannot be written.
pub fn run(tasks: &[Task<'_>], options: &Options<'_>) -> Result<Ending, RunnerError> {
    let experiments = tasks
        .iter()
        .map(|task| LoadedExperiment::read(&task.request))
        .collect::<Result<Vec<_>, RunnerError>>()?;
    let folders = tasks
        .iter()
        .zip(&experiments)
        .map(|(task, loaded)| open(task.out.as_deref(), loaded, options.policy))
        .collect::<Result<Vec<_>, RunnerError>>()?;
    let jobs = jobs(&experiments, &folders);
    let progress = ProgressDisplay::new(&jobs, options.n_threads, options.is_quiet);
    let ends = workers::run_all(&jobs, options.n_threads, options.shutdown, &progress);
    progress.end();
    let ends = ends?;
    if ends.iter().any(|end| matches!(end, CaseEnd::Stopped)) {
        let n_done = ends.iter().filter(|end| !matches!(end, CaseEnd::Stopped)).count();
        return Ok(Ending::Interrupted { n_done, n_cases: ends.len() });
    }
    let mut ends = ends.into_iter();
    let mut outcomes = Vec::new();
    for (loaded, folder) in experiments.iter().zip(&folders) {
        let ends = ends.by_ref().take(loaded.cases().len()).collect();
        let (outcome, findings) = loaded.evaluate(ends);
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

/// All cases, in the order of the experiments.
fn jobs<'a>(
    experiments: &'a [LoadedExperiment<'a>],
    folders: &'a [Option<Folder>],
) -> Vec<Job<'a>> {
    let of_experiment = |(loaded, folder): (&'a LoadedExperiment<'a>, &'a Option<Folder>)| {
        loaded.cases().iter().map(move |case| Job { loaded, folder: folder.as_ref(), case })
    };
    experiments.iter().zip(folders).flat_map(of_experiment).collect()
}

fn write(folder: &Folder, outcome: &Outcome, findings: &Findings) -> Result<(), RunnerError> {
    folder.write_text("result.json", &outcome.to_text())?;
    for curve in &findings.curves {
        folder.write_curve(curve)?;
    }
    folder.write_text("report.html", &report::page(outcome))
}
