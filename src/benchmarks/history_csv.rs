//! History of results: a CSV file for each machine, with a row for each case.

use std::{
    fs::{self, OpenOptions},
    io,
    path::{Path, PathBuf},
    process::Command,
};

use serde::Serialize;

use super::BenchResult;
use crate::{base::Real, host::clock::utc_stamp, runner::outcome::Machine};

/// The file cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum HistoryError {
    /// The operating system reports an error.
    #[error("{}: cannot be written: {reason}; name a writable file with --out", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        reason: io::Error,
    },
    /// The file has other columns.
    #[error("{}: has other columns, `{found}`; name a new file with --out", path.display())]
    OtherColumns {
        /// The file.
        path: PathBuf,
        /// Its first line.
        found: String,
    },
}

/// A row, whose fields are the columns.
#[derive(Serialize)]
struct Row<'a> {
    date_utc: &'a str,
    commit: &'a str,
    cpu: &'a str,
    n_processors: usize,
    case: &'a str,
    n_grains: usize,
    n_vertices: usize,
    threads: usize,
    substep_s: Real,
    steps_per_s: Real,
    spread: Real,
    processor_share: Option<Real>,
    contact_steps_per_s_per_core: Real,
    real_time_factor: Real,
    n_contacts: usize,
    peak_rss_bytes: Option<u64>,
    digest: &'a str,
    digest_after_steps: u64,
    lammps_history: Option<Real>,
    lammps_mindlin: Option<Real>,
    liggghts: Option<Real>,
    yade: Option<Real>,
}

/// The columns of the reference codes hold their contact-steps per second and thread.
fn row<'a>(origin: &'a Origin, it: &'a BenchResult) -> Row<'a> {
    let peer = |name: &str| {
        let found = it.peers.iter().find(|it| it.peer == name);
        found.map(|it| it.contact_steps_per_s_per_core)
    };
    Row {
        date_utc: &origin.date,
        commit: &origin.commit,
        cpu: &origin.machine.cpu,
        n_processors: origin.machine.n_processors,
        case: &it.case,
        n_grains: it.n_grains,
        n_vertices: it.n_vertices,
        threads: it.threads,
        substep_s: it.substep_s,
        steps_per_s: it.steps_per_s,
        spread: it.spread,
        processor_share: it.processor_share,
        contact_steps_per_s_per_core: it.contact_steps_per_s_per_core,
        real_time_factor: it.real_time_factor,
        n_contacts: it.n_contacts,
        peak_rss_bytes: it.peak_rss_bytes,
        digest: &it.digest,
        digest_after_steps: it.digest_after_steps,
        lammps_history: peer("lammps_history"),
        lammps_mindlin: peer("lammps_mindlin"),
        liggghts: peer("liggghts"),
        yade: peer("yade"),
    }
}

/// When and where the rows were measured.
struct Origin {
    date: String,
    commit: String,
    machine: Machine,
}

/// Adds a row for each result to the file at `path`, which is created if it does not exist.
///
/// # Errors
/// If the file cannot be written, or has other columns.
pub fn add(path: &Path, results: &[BenchResult]) -> Result<(), HistoryError> {
    let origin = Origin { date: utc_stamp(), commit: commit(), machine: Machine::here() };
    let unwritable = |reason| HistoryError::Unwritable { path: path.to_owned(), reason };
    let old = match fs::read_to_string(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
        text => text.map_err(unwritable)?,
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for it in results {
        writer.serialize(row(&origin, it)).map_err(|error| unwritable(error.into()))?;
    }
    let bytes = writer.into_inner().map_err(|error| unwritable(error.into_error()))?;
    let text = String::from_utf8_lossy(&bytes);
    let Some((head, rows)) = text.split_once('\n') else { return Ok(()) };
    let added = match old.lines().next() {
        None => &*text,
        Some(first) if first == head => rows,
        Some(first) => {
            return Err(HistoryError::OtherColumns {
                path: path.to_owned(),
                found: first.to_owned(),
            });
        }
    };
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(unwritable)?;
    }
    let file = OpenOptions::new().create(true).append(true).open(path);
    file.and_then(|mut file| io::Write::write_all(&mut file, added.as_bytes())).map_err(unwritable)
}

/// The commit of the current sources of the program, with `-dirty` if they differ from it.
fn commit() -> String {
    if let Some(commit) = option_env!("JAMGRIP_COMMIT") {
        return commit.to_owned();
    }
    let describe = ["-C", env!("CARGO_MANIFEST_DIR"), "describe", "--always", "--dirty"];
    let output = Command::new("git").args(describe).output().ok();
    let text = output.filter(|it| it.status.success()).map(|it| it.stdout);
    let text = text.and_then(|it| String::from_utf8(it).ok()).unwrap_or_default();
    if text.is_empty() { "unknown".to_owned() } else { text.trim().to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: one header, one row for each case, in the order they were added.
    #[test]
    fn rows_are_appended_and_files_with_other_columns_are_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/history.csv");
        let results = |case: &str| BenchResult { case: case.to_owned(), ..BenchResult::default() };
        add(&path, &[results("a"), results("b")]).unwrap();
        add(&path, &[results("c")]).unwrap();
        let mut reader = csv::Reader::from_path(&path).unwrap();
        let index = reader.headers().unwrap().iter().position(|it| it == "case").unwrap();
        let cases: Vec<String> = reader.records().map(|it| it.unwrap()[index].to_owned()).collect();
        assert_eq!(cases, ["a", "b", "c"]);
        fs::write(&path, "something,else\n1,2\n").unwrap();
        let error = add(&path, &[results("d")]).unwrap_err();
        assert!(error.to_string().contains("something,else"), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "something,else\n1,2\n");
    }
}
