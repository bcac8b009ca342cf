//! The files of an experiment.
//!
//! ```text
//! plan.json          everything that determines the results; another plan is rejected
//! states/CASE.state  a running case
//! cases/CASE.json    a finished case
//! result.json        the outcome, with report.html and curves/CURVE.csv
//! ```

use std::{
    collections::BTreeMap,
    fs::{self, File, TryLockError},
    io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use crate::runner::{error::RunnerError, experiment::Identity};
use crate::{
    base::digest::Digest,
    experiments::{findings::Curve, record::Record},
    host::atomic_file::{self, Loaded},
};

const PLAN: &str = "plan.json";
const LOCK: &str = "lock";
const STATES: &str = "states";
const CASES: &str = "cases";
const CURVES: &str = "curves";

/// What to do with cases in the folder.
#[derive(Clone, Copy, Debug, Default)]
pub struct Policy {
    /// True to restart, whatever the folder contains.
    pub is_fresh: bool,
    /// True to continue cases of another build of the program.
    pub allows_mixed_builds: bool,
}

/// A finished case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FinishedCase {
    /// Digest of plan and case, so that a file under another name is not accepted.
    key: u64,
    /// Digests of the program files that ran it.
    pub programs: Vec<String>,
    /// The results.
    pub record: Record,
}

/// The saved state of a running case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedCase {
    /// Fraction of the work that is done.
    pub(super) share: f64,
    /// Wall-clock time so far, by stage (s).
    pub(super) wall_s: BTreeMap<String, f64>,
    /// Digests of the program files that ran it.
    pub(super) programs: Vec<String>,
    /// The state of the run.
    #[serde(with = "serde_bytes")]
    pub(super) run: Vec<u8>,
}

/// What is stored of a case.
#[derive(Debug)]
pub(super) enum Stored {
    /// The finished case.
    Finished(Box<FinishedCase>),
    /// The state of a running case.
    Saved(SavedCase),
    /// A truncated or changed file.
    Damaged(PathBuf),
    /// Nothing.
    Nothing,
}

/// The folder of one experiment, locked against other processes.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    key: u64,
    _lock: File,
}

impl Folder {
    /// Opens a new folder, an empty one, or one with cases of the same plan.
    ///
    /// # Errors
    /// If it contains something else, is in use, or cannot be written.
    pub fn open(path: &Path, requested: &Identity, policy: Policy) -> Result<Self, RunnerError> {
        let unwritable = |reason| RunnerError::Unwritable { path: path.to_owned(), reason };
        let plan = path.join(PLAN);
        if !plan.exists() && contains_files(path) {
            return Err(RunnerError::Foreign { path: path.to_owned() });
        }
        fs::create_dir_all(path).map_err(unwritable)?;
        let lock = lock(path)?;
        let folder = Self { path: path.to_owned(), key: requested.key(), _lock: lock };
        if policy.is_fresh {
            folder.clear().map_err(unwritable)?;
        } else if let Ok(text) = fs::read_to_string(&plan) {
            folder.compare(requested, &text, policy)?;
        }
        for name in [STATES, CASES, CURVES] {
            fs::create_dir_all(path.join(name)).map_err(unwritable)?;
        }
        let text = serde_json::to_string_pretty(requested).expect("all keys are texts");
        folder.write_text(PLAN, &(text + "\n"))?;
        Ok(folder)
    }

    fn compare(&self, requested: &Identity, plan: &str, policy: Policy) -> Result<(), RunnerError> {
        let path = self.path.clone();
        let Ok(stored) = serde_json::from_str::<Identity>(plan) else {
            let differences = vec![format!("{PLAN} is damaged")];
            return Err(RunnerError::OtherPlan { path, differences, is_program_only: false });
        };
        let mut differences = requested.differences(&stored);
        let is_program_only = differences.is_empty();
        if requested.program != stored.program && !(is_program_only && policy.allows_mixed_builds) {
            differences.push("they were run by another build of jamgrip".to_owned());
        }
        if differences.is_empty() {
            return Ok(());
        }
        Err(RunnerError::OtherPlan { path, differences, is_program_only })
    }

    /// Removes the files of the experiment; other files stay.
    fn clear(&self) -> io::Result<()> {
        let patterns = [(STATES, "state"), (CASES, "json"), (CURVES, "csv")];
        for (name, ending) in patterns {
            let Ok(entries) = fs::read_dir(self.path.join(name)) else { continue };
            for entry in entries {
                let file = entry?.path();
                if file.extension().is_some_and(|it| it == ending) {
                    fs::remove_file(file)?;
                }
            }
        }
        for name in ["result.json", "report.html"] {
            remove(&self.path.join(name))?;
        }
        Ok(())
    }

    /// What is stored of `case`.
    pub(super) fn find(&self, case: &str) -> Stored {
        let (file, key) = (self.case_file(case), self.case_key(case));
        if let Ok(text) = fs::read_to_string(&file) {
            return match serde_json::from_str::<FinishedCase>(&text) {
                Ok(finished) if finished.key == key => Stored::Finished(Box::new(finished)),
                _ => Stored::Damaged(file),
            };
        }
        let file = self.state_file(case);
        match atomic_file::load(&file, key) {
            Loaded::Missing => Stored::Nothing,
            Loaded::Damaged => Stored::Damaged(file),
            Loaded::Complete(bytes) => match postcard::from_bytes(&bytes) {
                Ok(saved) => Stored::Saved(saved),
                Err(_) => Stored::Damaged(file),
            },
        }
    }

    /// Saves the state of a running case.
    pub(super) fn save(&self, case: &str, saved: &SavedCase) -> Result<(), RunnerError> {
        let file = self.state_file(case);
        let bytes = postcard::to_stdvec(saved).expect("memory is the only limit");
        atomic_file::store(&file, self.case_key(case), &bytes)
            .map_err(|reason| RunnerError::Unwritable { path: file, reason })
    }

    /// Stores a finished case, and removes its saved state.
    pub(super) fn store_finished(
        &self,
        case: &str,
        finished: &FinishedCase,
    ) -> Result<(), RunnerError> {
        let text = serde_json::to_string(finished).expect("all keys are texts");
        self.write_text(&format!("{CASES}/{case}.json"), &(text + "\n"))?;
        self.remove_state(case);
        Ok(())
    }

    /// Removes the saved state of a case.
    pub(super) fn remove_state(&self, case: &str) {
        // Best effort: a state that remains is ignored by later runs.
        drop(remove(&self.state_file(case)));
    }

    /// Writes a file of this folder atomically.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write_text(&self, name: &str, text: &str) -> Result<(), RunnerError> {
        let path = self.path.join(name);
        atomic_file::replace(&path, &[text.as_bytes()])
            .map_err(|reason| RunnerError::Unwritable { path, reason })
    }

    /// Writes a curve as CSV, with names and units in the header.
    pub(super) fn write_curve(&self, curve: &Curve) -> Result<(), RunnerError> {
        let name = format!("{CURVES}/{}.csv", curve.name);
        let text = csv_text(curve).map_err(|error| RunnerError::Unwritable {
            path: self.path.join(&name),
            reason: io::Error::other(error),
        })?;
        self.write_text(&name, &text)
    }

    /// Digest of plan and case.
    pub(super) fn case_key(&self, case: &str) -> u64 {
        let mut digest = Digest::new();
        digest.integer(self.key);
        digest.bytes(case.as_bytes());
        digest.finish()
    }

    fn case_file(&self, case: &str) -> PathBuf {
        self.path.join(CASES).join(format!("{case}.json"))
    }

    fn state_file(&self, case: &str) -> PathBuf {
        self.path.join(STATES).join(format!("{case}.state"))
    }
}

impl FinishedCase {
    pub(super) fn new(key: u64, programs: Vec<String>, record: Record) -> Self {
        Self { key, programs, record }
    }
}

/// True if `folder` contains anything but the lock.
fn contains_files(folder: &Path) -> bool {
    fs::read_dir(folder)
        .is_ok_and(|entries| entries.flatten().any(|entry| entry.file_name() != LOCK))
}

fn lock(folder: &Path) -> Result<File, RunnerError> {
    let path = folder.join(LOCK);
    let unwritable = |reason| RunnerError::Unwritable { path: path.clone(), reason };
    let file = File::create(&path).map_err(unwritable)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(RunnerError::Busy { path: folder.to_owned() }),
        Err(TryLockError::Error(reason)) => Err(unwritable(reason)),
    }
}

fn remove(file: &Path) -> io::Result<()> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// A table with `name [unit]` in its header; short columns are padded with empty cells.
fn csv_text(curve: &Curve) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(curve.columns.iter().map(|it| format!("{} [{}]", it.name, it.unit)))?;
    let n_rows = curve.columns.iter().map(|it| it.values.len()).max().unwrap_or(0);
    for i in 0..n_rows {
        let cell = |values: &Vec<f64>| values.get(i).map_or_else(String::new, f64::to_string);
        writer.write_record(curve.columns.iter().map(|it| cell(&it.values)))?;
    }
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8(bytes).expect("written from texts"))
}
