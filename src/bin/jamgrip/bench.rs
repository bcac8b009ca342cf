//! The subcommand `bench`.

use std::{
    error::Error,
    io::{self, Write},
    process::ExitCode,
};

use jamgrip::{
    benchmarks::{self, CASES, Options, history_csv},
    host::cache::Cache,
};

use crate::args::Bench;

/// A case failed its checks or could not run.
const FAILED: u8 = 1;

pub(crate) fn bench(args: &Bench) -> Result<ExitCode, Box<dyn Error>> {
    let mut stdout = io::stdout().lock();
    if args.list {
        for case in CASES {
            writeln!(stdout, "{:<24} {}", case.name, case.about)?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let options = Options {
        n_threads: args.n_threads(),
        seconds: args.seconds,
        cache: args.cache.clone().map_or_else(Cache::of_user, Cache::new),
        with_peers: args.peers,
        is_quiet: args.json,
    };
    let cases = benchmarks::chosen(&args.cases)?;
    let (mut lines, mut has_failed) = (Vec::new(), false);
    for case in cases {
        let figures = match benchmarks::run(case, &options) {
            Ok(figures) => figures,
            Err(error) => {
                // The other cases are measured all the same.
                writeln!(io::stderr().lock(), "{error}")?;
                has_failed = true;
                continue;
            }
        };
        if args.json {
            lines.push(serde_json::to_string(&figures)?);
        } else {
            write!(stdout, "{}", figures.to_text())?;
            stdout.flush()?;
        }
        if let Some(out) = &args.out {
            // Row by row: an interrupted run keeps what was measured.
            history_csv::add(out, &[figures])?;
        }
    }
    if args.json {
        writeln!(stdout, "[\n{}\n]", lines.join(",\n"))?;
    }
    Ok(if has_failed { ExitCode::from(FAILED) } else { ExitCode::SUCCESS })
}

#[cfg(all(feature = "ros", feature = "shm"))]
pub(crate) fn listen(prefix: &str, seconds: f64) -> Result<ExitCode, Box<dyn Error>> {
    let measured = benchmarks::listen(prefix, seconds).map_err(|error| error.to_string())?;
    writeln!(io::stdout().lock(), "{measured}")?;
    Ok(ExitCode::SUCCESS)
}
