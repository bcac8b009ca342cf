//! A file that can always be completed: when the disk is full, it frees reserved space.
//!
//! The reserve is a second, unnamed file of a few megabytes. When the disk is full it is closed,
//! and the last data are written to the space that it frees. So a recording always ends with its
//! index and stays readable.

use std::{
    fs::{File, OpenOptions},
    io::{self, ErrorKind, Write},
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

/// Space for the last chunk and the index of a long recording (bytes).
pub const RESERVE: usize = 4 << 20;

/// Reports the length of a file, and whether the disk is full.
#[derive(Clone, Debug, Default)]
pub struct FileStatus(Arc<SharedStatus>);

#[derive(Debug, Default)]
struct SharedStatus {
    is_full: AtomicBool,
    n_bytes: AtomicU64,
}

impl FileStatus {
    /// True once the reserve has been used.
    pub fn is_full(&self) -> bool {
        self.0.is_full.load(Ordering::Relaxed)
    }

    /// Bytes written so far.
    pub fn n_bytes(&self) -> u64 {
        self.0.n_bytes.load(Ordering::Relaxed)
    }
}

/// A file with a reserve.
#[derive(Debug)]
pub struct ReservedFile {
    file: File,
    reserve: Option<File>,
    status: FileStatus,
}

impl ReservedFile {
    /// Creates the file at `path`, which must not exist yet, and its reserve.
    ///
    /// # Errors
    /// If the file exists, the folder cannot be written, or there is no room for the reserve.
    pub fn create(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new().write(true).create_new(true).open(path)?;
        let reserve = reserve_space(path)?;
        Ok(Self { file, reserve: Some(reserve), status: FileStatus::default() })
    }

    /// A status that can be read while another owner writes.
    pub fn status(&self) -> FileStatus {
        self.status.clone()
    }

    /// Flushes the file to the disk.
    ///
    /// # Errors
    /// The errors of the disk.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_all()
    }
}

/// Reserves space with an unnamed file, which disappears when it is closed, even if the process is
/// killed.
fn reserve_space(path: &Path) -> io::Result<File> {
    let name = path.with_extension("reserve");
    let mut reserve = OpenOptions::new().write(true).create_new(true).open(&name)?;
    let filled = reserve.write_all(&vec![0; RESERVE]);
    std::fs::remove_file(&name)?;
    filled.map(|()| reserve)
}

/// True for the errors of a full disk or an exhausted quota.
pub fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded)
}

impl Write for ReservedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n_written = match self.file.write(bytes) {
            Err(error) if is_full(&error) && self.reserve.is_some() => {
                self.reserve = None;
                self.status.0.is_full.store(true, Ordering::Relaxed);
                self.file.write(bytes)?
            }
            other => other?,
        };
        self.status.0.n_bytes.fetch_add(n_written as u64, Ordering::Relaxed);
        Ok(n_written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
