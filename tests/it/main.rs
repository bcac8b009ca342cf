//! All integration tests, in one binary.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

mod generated_types; // msgs/*.msg and the Rust types agree
