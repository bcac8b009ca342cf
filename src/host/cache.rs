//! Settled start states on disk, by a digest of what they depend on. A missing or damaged state is
//! settled again.

use std::{fs, io, path::PathBuf};

use crate::host::atomic_file::{self, Loaded};

/// A folder of start states.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
}

/// The result of looking up a key.
#[derive(Debug, PartialEq, Eq)]
pub enum Lookup {
    /// The stored bytes.
    State(Vec<u8>),
    /// No state is stored.
    Missing,
    /// The file is truncated or changed.
    Damaged(PathBuf),
}

/// The cache cannot be written. The run continues; the next start takes as long as this one.
#[derive(Debug, thiserror::Error)]
#[error(
    "start state cache {}: cannot be written: {reason}; choose a writable folder",
    path.display()
)]
pub struct CacheError {
    /// The file or folder.
    pub path: PathBuf,
    /// Reason given by the operating system.
    pub reason: io::Error,
}

impl Cache {
    /// Creates a cache in `folder`.
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// The user's cache: `$XDG_CACHE_HOME/jamgrip`, else `~/.cache/jamgrip`, else a folder for
    /// temporary files.
    pub fn of_user() -> Self {
        let absolute = |name: &str| {
            std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute())
        };
        let base = absolute("XDG_CACHE_HOME")
            .or_else(|| absolute("HOME").map(|home| home.join(".cache")))
            .unwrap_or_else(std::env::temp_dir);
        Self::new(base.join("jamgrip"))
    }

    /// The folder of the cache.
    pub fn folder(&self) -> &std::path::Path {
        &self.folder
    }

    /// Looks up `key`.
    pub fn load(&self, key: u64) -> Lookup {
        let path = self.path(key);
        match atomic_file::load(&path, key) {
            Loaded::Complete(bytes) => Lookup::State(bytes),
            Loaded::Missing => Lookup::Missing,
            Loaded::Damaged => Lookup::Damaged(path),
        }
    }

    /// Stores `bytes` under `key`.
    ///
    /// # Errors
    /// If the folder or the file cannot be written; the old file is kept then.
    pub fn store(&self, key: u64, bytes: &[u8]) -> Result<(), CacheError> {
        let path = self.path(key);
        let to_error = |reason| CacheError { path: path.clone(), reason };
        fs::create_dir_all(&self.folder).map_err(to_error)?;
        atomic_file::store(&path, key, bytes).map_err(to_error)
    }

    fn path(&self, key: u64) -> PathBuf {
        self.folder.join(format!("start-{key:016x}.state"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_stored_states_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().join("new"));
        assert_eq!(cache.load(7), Lookup::Missing);
        cache.store(7, b"state").unwrap();
        assert_eq!(cache.load(7), Lookup::State(b"state".to_vec()));
        assert_eq!(cache.load(8), Lookup::Missing);
        fs::copy(cache.path(7), cache.path(8)).unwrap();
        assert_eq!(cache.load(8), Lookup::Damaged(cache.path(8)), "a file of another key");
        let names = fs::read_dir(folder.path().join("new")).unwrap().count();
        assert_eq!(names, 2, "no drafts are left");
    }

    /// Oracle: every truncation and every flipped byte is detected, and storing again repairs the
    /// file.
    #[test]
    fn damage_is_detected_and_repaired() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().to_owned());
        cache.store(7, b"a settled state").unwrap();
        let stored = fs::read(cache.path(7)).unwrap();
        for cut in 0..stored.len() {
            fs::write(cache.path(7), &stored[..cut]).unwrap();
            assert_eq!(cache.load(7), Lookup::Damaged(cache.path(7)), "cut to {cut} bytes");
        }
        for flipped in 0..stored.len() {
            let mut bytes = stored.clone();
            bytes[flipped] ^= 1;
            fs::write(cache.path(7), &bytes).unwrap();
            assert_eq!(cache.load(7), Lookup::Damaged(cache.path(7)), "byte {flipped} flipped");
        }
        cache.store(7, b"a settled state").unwrap();
        assert_eq!(cache.load(7), Lookup::State(b"a settled state".to_vec()));
    }

    #[test]
    fn a_folder_that_cannot_be_created_is_an_error_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"").unwrap();
        let error = Cache::new(file.join("cache")).store(7, b"state").unwrap_err();
        assert!(error.to_string().contains("writable folder"), "{error}");
    }
}
