//! What the operating system provides: clock, signals, files, terminal.

pub mod atomic_file; // files that are complete or absent
pub mod cache; // settled initial states on disk
pub mod clock; // the only clock
pub mod job_queue; // jobs on several threads
pub mod progress_bar; // one line for the terminal
pub mod shutdown; // Ctrl-C and SIGTERM
