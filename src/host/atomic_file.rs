//! Files that are complete or absent: they start with a digest of their contents, and a new file
//! only appears under its name when it is complete.

use std::{
    fs,
    io::{self, Write},
    path::Path,
};

use crate::base::digest::Digest;

/// First bytes of every file with a digest: name and version of the format.
const MAGIC: &[u8; 8] = b"jamgrip1";

/// The result of reading a file.
#[derive(Debug, PartialEq, Eq)]
pub enum Loaded {
    /// The stored bytes.
    Complete(Vec<u8>),
    /// There is no file.
    Missing,
    /// The file is truncated, changed, or stored under another key.
    Damaged,
}

/// Writes `bytes` to `path`, with a digest of `key` and `bytes`.
///
/// # Errors
/// If the file cannot be written; the old file is kept then.
pub fn store(path: &Path, key: u64, bytes: &[u8]) -> io::Result<()> {
    replace(path, &[MAGIC, &digest(key, bytes).to_le_bytes(), bytes])
}

/// Reads bytes stored under `key`.
pub fn load(path: &Path, key: u64) -> Loaded {
    let Ok(file) = fs::read(path) else { return Loaded::Missing };
    match verified(key, &file) {
        Some(bytes) => Loaded::Complete(bytes.to_vec()),
        None => Loaded::Damaged,
    }
}

/// Writes a file atomically: at any time either the complete old file or the complete new one
/// exists.
///
/// # Errors
/// If the file cannot be written; the old file is kept then.
pub fn replace(path: &Path, parts: &[&[u8]]) -> io::Result<()> {
    // Two processes may write the same file at once, so each has its own draft.
    let draft = path.with_extension(format!("{}.draft", std::process::id()));
    let written = write_synced(&draft, parts).and_then(|()| fs::rename(&draft, path));
    if written.is_err() {
        // Best effort: a remaining temporary file is harmless.
        drop(fs::remove_file(&draft));
    }
    written
}

fn write_synced(path: &Path, parts: &[&[u8]]) -> io::Result<()> {
    let mut file = fs::File::create(path)?;
    for part in parts {
        file.write_all(part)?;
    }
    file.sync_all()
}

fn verified(key: u64, file: &[u8]) -> Option<&[u8]> {
    let rest = file.strip_prefix(MAGIC)?;
    let (found, bytes) = rest.split_first_chunk()?;
    (u64::from_le_bytes(*found) == digest(key, bytes)).then_some(bytes)
}

/// The key is part of the digest, so that a file of another key is not accepted.
fn digest(key: u64, bytes: &[u8]) -> u64 {
    let mut digest = Digest::new();
    digest.integer(key);
    digest.bytes(bytes);
    digest.finish()
}
