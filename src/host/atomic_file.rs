//! Files that are whole or not there: a digest of the bytes stands before them, and a new file
//! appears under its name only when it is complete.

use std::{
    fs,
    io::{self, Write},
    path::Path,
};

use crate::base::digest::Digest;

/// First bytes of every sealed file: name and version of the format.
const MAGIC: &[u8; 8] = b"jamgrip1";

/// What was found under a name.
#[derive(Debug, PartialEq, Eq)]
pub enum Opened {
    /// The bytes that were sealed.
    Whole(Vec<u8>),
    /// Nothing.
    Nothing,
    /// A file that is cut off, changed, or sealed under another key.
    Damaged,
}

/// Writes `bytes` to `path`, sealed under `key`.
///
/// # Errors
/// If the file cannot be written; what was there before stays.
pub fn seal(path: &Path, key: u64, bytes: &[u8]) -> io::Result<()> {
    replace(path, &[MAGIC, &digest(key, bytes).to_le_bytes(), bytes])
}

/// Reads what was sealed under `key`.
pub fn open(path: &Path, key: u64) -> Opened {
    let Ok(file) = fs::read(path) else { return Opened::Nothing };
    match unpack(key, &file) {
        Some(bytes) => Opened::Whole(bytes.to_vec()),
        None => Opened::Damaged,
    }
}

/// Writes a file so that at any time either the old or the new one is there, whole.
///
/// # Errors
/// If it cannot be written; what was there before stays.
pub fn replace(path: &Path, parts: &[&[u8]]) -> io::Result<()> {
    // Two processes may write the same file at once: each has its own draft.
    let draft = path.with_extension(format!("{}.draft", std::process::id()));
    let written = write_whole(&draft, parts).and_then(|()| fs::rename(&draft, path));
    if written.is_err() {
        // Nothing more can be done if even this fails.
        drop(fs::remove_file(&draft));
    }
    written
}

fn write_whole(path: &Path, parts: &[&[u8]]) -> io::Result<()> {
    let mut file = fs::File::create(path)?;
    for part in parts {
        file.write_all(part)?;
    }
    file.sync_all()
}

fn unpack(key: u64, file: &[u8]) -> Option<&[u8]> {
    let rest = file.strip_prefix(MAGIC)?;
    let (found, bytes) = rest.split_first_chunk()?;
    (u64::from_le_bytes(*found) == digest(key, bytes)).then_some(bytes)
}

/// The key is part of the digest, so that a file under another's name is not taken for it.
fn digest(key: u64, bytes: &[u8]) -> u64 {
    let mut digest = Digest::new();
    digest.integer(key);
    digest.bytes(bytes);
    digest.finish()
}
