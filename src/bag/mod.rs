//! What a recording is: its names, how it is written, and how it is read, however damaged.
//!
//! A recording is a rosbag2 folder of MCAP files. Each file explains itself: it holds the scene, the
//! files that the scene names, the build, every message and every command. The digest of every tick
//! and, now and then, all that is needed to go on, make it more than a film: it can be run again.

pub mod chain; // the digest of every tick, each tied to all before it
pub mod check; // does all that it says agree with what is in it?
pub mod disk; // a file that can be completed on a full disk
pub mod index; // where its chunks are
pub mod info; // what is in it, counted
pub mod metadata; // what a recording says about itself
pub mod reader; // records of a file, however damaged
pub mod recording; // what is needed to run it again
pub mod recover; // repairs a damaged file
pub mod sink; // writes a recording
pub mod source; // commands from a recording
pub mod writer; // one file

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use crate::scene::BagCompression;

/// Attachment with the resolved scene.
pub const SCENE: &str = "scene.yaml";
/// Attachments with files that the scene names begin with this.
pub const SCENE_FILE: &str = "scene_file/";
/// Attachments with checkpoints begin with this; the tick follows.
pub const CHECKPOINT: &str = "checkpoint/";
/// Metadata record with what was known at the start.
pub const START: &str = "jamgrip";
/// Metadata record with what was known at the end.
pub const END: &str = "jamgrip_end";
/// Metadata record of rosbag2.
pub const ROSBAG2: &str = "rosbag2";

/// What a recording is about.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Text of the resolved scene.
    pub scene_text: String,
    /// Files that the scene names: name and contents.
    pub scene_files: Vec<(String, Vec<u8>)>,
    /// What else is worth knowing to run it again: key and value.
    pub facts: Vec<(&'static str, String)>,
    /// How it is written.
    pub format: Format,
}

/// How a recording is written.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// How messages are compressed.
    pub compression: BagCompression,
    /// A file as long as this is followed by another (bytes).
    pub split_bytes: Option<u64>,
    /// The same for the simulated time in it (ns).
    pub split_ns: Option<u64>,
}

impl Default for Format {
    fn default() -> Self {
        Self { compression: BagCompression::Zstd, split_bytes: None, split_ns: None }
    }
}

/// Why a path is no recording.
#[derive(Debug, thiserror::Error)]
pub enum NotABag {
    /// It cannot be read.
    #[error("{}: cannot be read: {fault}; check the path", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        fault: io::Error,
    },
    /// There is no MCAP file.
    #[error("{}: no .mcap file in it; name a rosbag2 folder or an .mcap file", path.display())]
    Empty {
        /// The folder.
        path: PathBuf,
    },
}

/// The MCAP files of a rosbag2 folder in the order they were written, or the one file.
///
/// The names alone decide: `metadata.yaml` may be missing, or older than what is there.
///
/// # Errors
/// If the path cannot be read, or holds no such file.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, NotABag> {
    let unreadable = |fault| NotABag::Unreadable { path: path.to_owned(), fault };
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
        return Err(NotABag::Empty { path: path.to_owned() });
    }
    // The tenth comes after the ninth.
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

    /// Oracle: the order of counting.
    #[test]
    fn files_come_in_the_order_they_were_written() {
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
