//! What can go wrong with a peer.

use std::{io, process::ExitStatus};

use crate::base::Real;

/// A peer does not run, or says what cannot be understood.
#[derive(Debug, thiserror::Error)]
pub enum PeerError {
    /// It cannot be started, or its files cannot be written.
    #[error("{peer}: {reason}")]
    Io {
        /// Which.
        peer: &'static str,
        /// What the operating system said.
        reason: io::Error,
    },
    /// It ended in a fault.
    #[error("{peer}: ended with {status}; its last lines:\n{tail}")]
    Failed {
        /// Which.
        peer: &'static str,
        /// How.
        status: ExitStatus,
        /// What it printed at last.
        tail: String,
    },
    /// It did not say what it should.
    #[error("{peer}: no `{wanted}` in what it prints; its last lines:\n{tail}")]
    Unreadable {
        /// Which.
        peer: &'static str,
        /// What was looked for.
        wanted: &'static str,
        /// What it printed at last.
        tail: String,
    },
    /// It has lost its contacts.
    #[error("{peer}: {found:.0} contacts between grains, expected {expected:.0} at least")]
    Empty {
        /// Which.
        peer: &'static str,
        /// What was found.
        found: Real,
        /// What it should be.
        expected: Real,
    },
    /// Several threads need MPI.
    #[error("{peer}: more than one thread needs `mpirun`; install it, or use --threads 1")]
    NoMpi {
        /// Which.
        peer: &'static str,
    },
}
