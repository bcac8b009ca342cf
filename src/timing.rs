//! Command line to benchmarks.

use std::{
    error::Error,
    io::{self, Write},
    process::ExitCode,
};

use jamgrip::{
    bench::{self, CASES, Options},
    node::cache::Cache,
};

use crate::cli::Bench;

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
        is_quiet: args.json,
    };
    let cases = bench::chosen(&args.cases)?;
    let mut lines = Vec::new();
    for case in cases {
        let figures = bench::run(case, &options)?;
        if args.json {
            lines.push(serde_json::to_string(&figures)?);
        } else {
            write!(stdout, "{}", figures.to_text())?;
            stdout.flush()?;
        }
    }
    if args.json {
        writeln!(stdout, "[\n{}\n]", lines.join(",\n"))?;
    }
    Ok(ExitCode::SUCCESS)
}
