//! Inputs and outputs, independent of transport: traits, queues, threads.
//!
//! A sink runs on its own thread behind a bounded queue, so a slow or dead reader never slows the
//! physics. A source never blocks: commands that arrive during a tick are kept for the next one.

pub mod fanout; // one thread and one queue per sink
pub mod inbox; // a bounded queue of commands
pub mod published; // how far packets have been published
pub mod request_queue; // a bounded queue of requests
pub mod server; // serves requests
pub mod sink; // receives snapshots
pub mod source; // yields commands
