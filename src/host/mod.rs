//! What the operating system provides: clock, signals, files, terminal.

pub mod atomic_file; // files that are complete or absent
pub mod cache; // settled initial states on disk
pub mod clock; // the only clock
pub mod job_queue; // jobs on several threads
#[cfg(all(feature = "node", not(feature = "cli")))]
mod no_terminal; // nothing is drawn without feature `cli`
#[cfg(feature = "node")]
pub mod progress_bar; // one line for the terminal
pub mod shutdown; // Ctrl-C and SIGTERM
