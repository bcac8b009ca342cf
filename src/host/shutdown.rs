//! Ctrl-C and SIGTERM: the first ends the run in order, the second ends it at once.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

/// Exit code of a process that was interrupted twice: 128 and the number of SIGINT.
#[cfg(feature = "cli")]
const INTERRUPTED: i32 = 130;

/// Whether someone asked the run to end.
#[derive(Clone, Debug, Default)]
pub struct Shutdown(Arc<AtomicBool>);

impl Shutdown {
    /// Handles signals from now on. A process can call this once.
    ///
    /// # Errors
    /// If a handler is installed already or the operating system refuses it.
    #[cfg(feature = "cli")]
    pub fn listen() -> Result<Self, ctrlc::Error> {
        let shutdown = Self::default();
        let asked = Arc::clone(&shutdown.0);
        ctrlc::set_handler(move || {
            if asked.swap(true, Ordering::SeqCst) {
                std::process::exit(INTERRUPTED);
            }
        })?;
        Ok(shutdown)
    }

    /// Asks the run to end.
    pub fn request(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    /// True once someone asked.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}
