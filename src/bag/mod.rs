//! Recordings: how they are written, and how they are read, even if damaged.
//!
//! A recording is a rosbag2 folder of MCAP files. Each file is self-contained: it holds the scene,
//! the files that the scene refers to, the build, all messages and all commands. With the digest of
//! every tick and regular checkpoints, a recorded run can be simulated again, not only played back.

pub mod chain; // the chained digests of all ticks
pub mod check; // compares a recording's metadata with its contents
pub mod disk; // a file that can be completed on a full disk
pub mod index; // the index of a file's chunks
pub mod info; // counts the contents of a recording
pub mod metadata; // metadata.yaml of rosbag2
pub mod reader; // reads the records of a file, even if damaged
pub mod recording; // the data needed to simulate a recorded run again
pub mod recover; // repairs a damaged file
pub mod sink; // writes a recording
pub mod source; // commands from a recording
pub mod writer; // writes one MCAP file

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use crate::scene::BagCompression;

/// Attachment with the resolved scene.
pub const SCENE: &str = "scene.yaml";
/// Prefix of attachments with files that the scene refers to.
pub const SCENE_FILE: &str = "scene_file/";
/// Prefix of attachments with checkpoints; the tick follows.
pub const CHECKPOINT: &str = "checkpoint/";
/// Metadata record written at the start.
pub const START: &str = "jamgrip";
/// Metadata record written at the end.
pub const END: &str = "jamgrip_end";
/// Metadata record of rosbag2.
pub const ROSBAG2: &str = "rosbag2";

/// A description of the recorded run, and the format to write it in.
#[derive(Clone, Debug)]
pub struct RunDescription {
    /// Text of the resolved scene.
    pub scene_text: String,
    /// Files that the scene refers to: name and contents.
    pub scene_files: Vec<(String, Vec<u8>)>,
    /// Other information needed to simulate the run again: key and value.
    pub facts: Vec<(&'static str, String)>,
    /// The format of the recording.
    pub format: Format,
}

/// The format of a recording.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// How messages are compressed.
    pub compression: BagCompression,
    /// Length at which a new file is started (bytes).
    pub split_bytes: Option<u64>,
    /// Simulation time in a file after which a new one is started (ns).
    pub split_ns: Option<u64>,
}

impl Default for Format {
    fn default() -> Self {
        Self { compression: BagCompression::Zstd, split_bytes: None, split_ns: None }
    }
}

/// Why a path cannot be opened as a recording.
#[derive(Debug, thiserror::Error)]
pub enum OpenBagError {
    /// It cannot be read.
    #[error("{}: cannot be read: {error}; check the path", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        error: io::Error,
    },
    /// It contains no MCAP file.
    #[error("{}: contains no .mcap file; give a rosbag2 folder or an .mcap file", path.display())]
    Empty {
        /// The folder.
        path: PathBuf,
    },
}

/// The MCAP files of a rosbag2 folder, in the order they were written; or the path itself if it is
/// a file.
///
/// The order follows from the names alone, because `metadata.yaml` may be missing or out of date.
///
/// # Errors
/// If the path cannot be read, or contains no such file.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, OpenBagError> {
    let unreadable = |error| OpenBagError::Unreadable { path: path.to_owned(), error };
    if fs::metadata(path).map_err(unreadable)?.is_file() {
        return Ok(vec![path.to_owned()]);
    }
    let mut found = Vec::new();
    for entry in fs::read_dir(path).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.path();
        if file.extension().is_some_and(|it| it == "mcap") {
            found.push(file);
        }
    }
    if found.is_empty() {
        return Err(OpenBagError::Empty { path: path.to_owned() });
    }
    // By number: the tenth file comes after the ninth.
    found.sort_by_key(|file| (number_at_end(file), file.clone()));
    Ok(found)
}

fn number_at_end(file: &Path) -> u64 {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let digits = stem.len() - stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    stem[stem.len() - digits..].parse().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the numbers in the names.
    #[test]
    fn files_are_sorted_in_the_order_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b_10.mcap", "b_9.mcap", "b_0.mcap", "metadata.yaml"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let names: Vec<_> = files(folder.path()).unwrap();
        let names: Vec<_> = names.iter().map(|it| it.file_name().unwrap()).collect();
        assert_eq!(names, ["b_0.mcap", "b_9.mcap", "b_10.mcap"]);
        assert!(files(&folder.path().join("nothing")).is_err());
        let empty = tempfile::tempdir().unwrap();
        assert!(files(empty.path()).unwrap_err().to_string().contains("no .mcap file"));
    }
}
