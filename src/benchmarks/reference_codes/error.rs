//! Errors of reference codes.

use std::{io, process::ExitStatus};

use crate::base::Real;

/// A reference code does not run, or its output cannot be parsed.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    /// It cannot be started, or its files cannot be written.
    #[error("{peer}: {reason}")]
    Io {
        /// Name of the code.
        peer: &'static str,
        /// The error of the operating system.
        reason: io::Error,
    },
    /// It ended with an error.
    #[error("{peer}: ended with {status}; its last lines:\n{tail}")]
    Failed {
        /// Name of the code.
        peer: &'static str,
        /// Exit status.
        status: ExitStatus,
        /// Its last lines of output.
        tail: String,
    },
    /// Its output lacks something.
    #[error("{peer}: no `{expected}` in its output; its last lines:\n{tail}")]
    Unreadable {
        /// Name of the code.
        peer: &'static str,
        /// What is missing.
        expected: &'static str,
        /// Its last lines of output.
        tail: String,
    },
    /// It has lost its contacts.
    #[error("{peer}: {found:.0} contacts between grains, expected at least {expected:.0}")]
    Empty {
        /// Name of the code.
        peer: &'static str,
        /// Number of contacts.
        found: Real,
        /// Minimum number of contacts.
        expected: Real,
    },
    /// Several threads need MPI.
    #[error("{peer}: more than one thread needs `mpirun`; install it, or use --threads 1")]
    NoMpi {
        /// Name of the code.
        peer: &'static str,
    },
}
