//! A file that can always be completed: when the disk is full, a reserve is given up.
//!
//! The reserve is a second file, without a name, that holds a few megabytes. On a full disk it is
//! closed, and what was begun is written into the room that it leaves. So a recording ends with
//! its index, and everything in it stays readable.

use std::{
    fs::{File, OpenOptions},
    io::{self, ErrorKind, Write},
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

/// Room for the last chunk and the index of a long recording [bytes].
pub(super) const RESERVE: usize = 4 << 20;

/// Tells whether the disk has become full.
#[derive(Clone, Debug, Default)]
pub(super) struct FullFlag(Arc<AtomicBool>);

impl FullFlag {
    /// True once the reserve was needed.
    pub(super) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A file with a reserve.
#[derive(Debug)]
pub(super) struct ReservedFile {
    file: File,
    reserve: Option<File>,
    full: FullFlag,
}

impl ReservedFile {
    /// Creates the file at `path`, which must not exist yet, and its reserve.
    ///
    /// # Errors
    /// If the file exists, the folder cannot be written, or there is no room for the reserve.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new().write(true).create_new(true).open(path)?;
        let reserve = reserve_beside(path)?;
        Ok(Self { file, reserve: Some(reserve), full: FullFlag::default() })
    }

    /// Set when the disk becomes full.
    pub(super) fn full_flag(&self) -> FullFlag {
        self.full.clone()
    }

    /// Sees to it that the file is on the disk, and not only in memory.
    ///
    /// # Errors
    /// As the disk says.
    pub(super) fn sync(&self) -> io::Result<()> {
        self.file.sync_all()
    }
}

/// A file that keeps room and has no name: it goes when it is closed, even if the process is killed.
fn reserve_beside(path: &Path) -> io::Result<File> {
    let name = path.with_extension("reserve");
    let mut reserve = OpenOptions::new().write(true).create_new(true).open(&name)?;
    let filled = reserve.write_all(&vec![0; RESERVE]);
    std::fs::remove_file(&name)?;
    filled.map(|()| reserve)
}

/// True for the errors of a disk, or a quota, without room.
pub(super) fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded)
}

impl Write for ReservedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.file.write(bytes) {
            Err(error) if is_full(&error) && self.reserve.is_some() => {
                self.reserve = None;
                self.full.0.store(true, Ordering::Relaxed);
                self.file.write(bytes)
            }
            other => other,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
