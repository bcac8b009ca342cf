//! Settled start states on disk, by digest of what they depend on. What is missing, cut off or
//! changed is settled anew.

use std::{fs, io, path::PathBuf};

use crate::host::atomic_file::{self, Opened};

/// A folder of start states.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
}

/// What was found under a key.
#[derive(Debug, PartialEq, Eq)]
pub enum Found {
    /// The bytes that were stored.
    State(Vec<u8>),
    /// Nothing.
    Nothing,
    /// A file that is cut off or changed.
    Damaged(PathBuf),
}

/// The cache cannot be written. The run goes on; the next start takes as long as this one.
#[derive(Debug, thiserror::Error)]
#[error(
    "start state cache {}: cannot be written: {reason}; choose a writable folder",
    path.display()
)]
pub struct CacheError {
    /// The file or folder.
    pub path: PathBuf,
    /// What the operating system said.
    pub reason: io::Error,
}

impl Cache {
    /// A cache in `folder`.
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// The user's cache: `$XDG_CACHE_HOME/jamgrip`, else `~/.cache/jamgrip`, else a folder of the
    /// system's for temporary files.
    pub fn of_user() -> Self {
        let absolute = |name: &str| {
            std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute())
        };
        let base = absolute("XDG_CACHE_HOME")
            .or_else(|| absolute("HOME").map(|home| home.join(".cache")))
            .unwrap_or_else(std::env::temp_dir);
        Self::new(base.join("jamgrip"))
    }

    /// Its folder.
    pub fn folder(&self) -> &std::path::Path {
        &self.folder
    }

    /// Looks up `key`.
    pub fn load(&self, key: u64) -> Found {
        let path = self.path(key);
        match atomic_file::open(&path, key) {
            Opened::Whole(bytes) => Found::State(bytes),
            Opened::Nothing => Found::Nothing,
            Opened::Damaged => Found::Damaged(path),
        }
    }

    /// Keeps `bytes` under `key`.
    ///
    /// # Errors
    /// If folder or file cannot be written; what was there before stays.
    pub fn store(&self, key: u64, bytes: &[u8]) -> Result<(), CacheError> {
        let path = self.path(key);
        let fault = |reason| CacheError { path: path.clone(), reason };
        fs::create_dir_all(&self.folder).map_err(fault)?;
        atomic_file::seal(&path, key, bytes).map_err(fault)
    }

    fn path(&self, key: u64) -> PathBuf {
        self.folder.join(format!("start-{key:016x}.state"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_stored_is_found_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().join("new"));
        assert_eq!(cache.load(7), Found::Nothing);
        cache.store(7, b"state").unwrap();
        assert_eq!(cache.load(7), Found::State(b"state".to_vec()));
        assert_eq!(cache.load(8), Found::Nothing);
        fs::copy(cache.path(7), cache.path(8)).unwrap();
        assert_eq!(cache.load(8), Found::Damaged(cache.path(8)), "a file under another's name");
        let names = fs::read_dir(folder.path().join("new")).unwrap().count();
        assert_eq!(names, 2, "no drafts are left");
    }

    /// Every cut and every flipped byte is noticed, and storing again mends it.
    #[test]
    fn damage_is_noticed_and_mended() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().to_owned());
        cache.store(7, b"a settled state").unwrap();
        let whole = fs::read(cache.path(7)).unwrap();
        for cut in 0..whole.len() {
            fs::write(cache.path(7), &whole[..cut]).unwrap();
            assert_eq!(cache.load(7), Found::Damaged(cache.path(7)), "cut to {cut} bytes");
        }
        for flipped in 0..whole.len() {
            let mut bytes = whole.clone();
            bytes[flipped] ^= 1;
            fs::write(cache.path(7), &bytes).unwrap();
            assert_eq!(cache.load(7), Found::Damaged(cache.path(7)), "byte {flipped} flipped");
        }
        cache.store(7, b"a settled state").unwrap();
        assert_eq!(cache.load(7), Found::State(b"a settled state".to_vec()));
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_an_error_with_a_remedy() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, b"").unwrap();
        let error = Cache::new(file.join("cache")).store(7, b"state").unwrap_err();
        assert!(error.to_string().contains("writable folder"), "{error}");
    }
}
