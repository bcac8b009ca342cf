//! All integration tests, in one binary.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

mod by_tick; // a made-up system whose numbers follow from its tick
mod fanout; // sinks behind their queues: order, drops, failure, closing
mod generated_types; // msgs/*.msg and the Rust types agree
mod synthetic; // a scene and snapshots made up for tests
mod peers; // Python, with other people's implementations of what we speak
mod private_network; // where tests may speak DDS
mod ros_loop; // what goes out reaches others, what others say comes in
mod scenes; // scenes that run, scenes that are refused
mod stream; // what other processes read in shared memory
