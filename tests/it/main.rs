//! The integration tests: one binary, one module per question.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

mod stream; // do processes on this host read the state in place?
mod synthetic; // a made-up system with known numbers, for tests of what leaves the process
