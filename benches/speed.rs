//! `cargo bench`: the same as `jamgrip bench`, built with the profile of benches.
//!
//! ```text
//! cargo bench                                          all cases
//! cargo bench -- --case grains_3k_rest --threads 1     what `jamgrip bench` takes
//! ```

use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    // Cargo adds `--bench` for harnesses that run as tests.
    let arguments = std::env::args().skip(1).filter(|argument| argument != "--bench");
    let status = Command::new(env!("CARGO_BIN_EXE_jamgrip")).arg("bench").args(arguments).status();
    let code = status.ok().and_then(|status| status.code()).and_then(|it| u8::try_from(it).ok());
    ExitCode::from(code.unwrap_or(1))
}
