//! Ctrl-C and SIGTERM: the first ends the run properly, the second ends the process at once.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

/// Exit code of a process that was interrupted twice: 128 plus the number of SIGINT.
#[cfg(feature = "cli")]
const INTERRUPTED: i32 = 130;

/// A flag that is set when the user requests to stop.
#[derive(Clone, Debug, Default)]
pub struct Shutdown(Arc<AtomicBool>);

impl Shutdown {
    /// Installs the signal handler. This is possible once per process.
    ///
    /// # Errors
    /// If a handler is already installed, or the operating system rejects it.
    #[cfg(feature = "cli")]
    pub fn listen() -> Result<Self, ctrlc::Error> {
        let shutdown = Self::default();
        let is_requested = Arc::clone(&shutdown.0);
        ctrlc::set_handler(move || {
            if is_requested.swap(true, Ordering::SeqCst) {
                std::process::exit(INTERRUPTED);
            }
        })?;
        Ok(shutdown)
    }

    /// Requests the run to end.
    pub fn request(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    /// True once the end of the run was requested.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}
