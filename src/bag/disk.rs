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
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

/// Room for the last chunk and the index of a long recording (bytes).
pub const RESERVE: usize = 4 << 20;

/// Tells how long the file is, and whether the disk has become full.
#[derive(Clone, Debug, Default)]
pub struct Gauge(Arc<Reading>);

#[derive(Debug, Default)]
struct Reading {
    is_full: AtomicBool,
    n_bytes: AtomicU64,
}

impl Gauge {
    /// True once the reserve was needed.
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
    gauge: Gauge,
}

impl ReservedFile {
    /// Creates the file at `path`, which must not exist yet, and its reserve.
    ///
    /// # Errors
    /// If the file exists, the folder cannot be written, or there is no room for the reserve.
    pub fn create(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new().write(true).create_new(true).open(path)?;
        let reserve = reserve_beside(path)?;
        Ok(Self { file, reserve: Some(reserve), gauge: Gauge::default() })
    }

    /// Tells length and fullness, also while someone else writes.
    pub fn gauge(&self) -> Gauge {
        self.gauge.clone()
    }

    /// Sees to it that the file is on the disk, and not only in memory.
    ///
    /// # Errors
    /// As the disk says.
    pub fn sync(&self) -> io::Result<()> {
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
pub fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded)
}

impl Write for ReservedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n_written = match self.file.write(bytes) {
            Err(error) if is_full(&error) && self.reserve.is_some() => {
                self.reserve = None;
                self.gauge.0.is_full.store(true, Ordering::Relaxed);
                self.file.write(bytes)?
            }
            other => other?,
        };
        self.gauge.0.n_bytes.fetch_add(n_written as u64, Ordering::Relaxed);
        Ok(n_written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
