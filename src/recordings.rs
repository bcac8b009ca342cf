//! Command line to recordings.

use std::{
    error::Error,
    io::{self, Write},
    process::ExitCode,
    time::Duration,
};

use jamgrip::{
    node::{cache::Cache, progress::Progress, shutdown::Shutdown},
    replay::{
        again::Again,
        verify::{self, Verdict},
    },
};

use crate::cli::Replay;

/// A digest differs, or something could not be done.
const FAILED: u8 = 1;
/// Someone asked it to end: 128 and the number of SIGINT.
const INTERRUPTED: u8 = 130;

pub(crate) fn replay(args: &Replay) -> Result<ExitCode, Box<dyn Error>> {
    verify(args)
}

fn verify(args: &Replay) -> Result<ExitCode, Box<dyn Error>> {
    let shutdown = Shutdown::listen()?;
    let progress = Progress::new(args.json);
    let again = Again::open(&args.bag)?;
    let verdict = verify::verify(
        &again,
        &verify::Options {
            n_threads: args.n_threads(),
            settles: args.settle,
            from_ns: nanoseconds(args.start.unwrap_or(0.0)),
            to_ns: args.end.map(nanoseconds),
            cache: args.cache.clone().map_or_else(Cache::of_user, Cache::new),
            progress: &progress,
            shutdown: &shutdown,
        },
    )?;
    let mut stdout = io::stdout().lock();
    if args.json {
        writeln!(stdout, "{}", verdict.to_json())?;
    } else {
        tell(&mut stdout, &verdict)?;
    }
    Ok(match &verdict {
        it if it.is_interrupted => ExitCode::from(INTERRUPTED),
        it if it.is_equal() => ExitCode::SUCCESS,
        _ => ExitCode::from(FAILED),
    })
}

fn tell(out: &mut impl Write, verdict: &Verdict) -> io::Result<()> {
    for remark in &verdict.remarks {
        writeln!(out, "{remark}")?;
    }
    let Verdict { n_ticks, n_compared, start_tick, real_time_factor, .. } = verdict;
    writeln!(
        out,
        "{n_ticks} ticks simulated from tick {start_tick} on at {real_time_factor:.3} x real time, \
         {n_compared} digests compared"
    )?;
    match &verdict.first_difference {
        Some(it) => writeln!(
            out,
            "tick {} differs: {:016x} is recorded, {:016x} was simulated",
            it.tick, it.recorded, it.simulated
        ),
        None if verdict.is_interrupted => writeln!(out, "interrupted; all equal so far"),
        None if *n_compared == 0 => writeln!(out, "nothing to compare"),
        None => writeln!(out, "all equal"),
    }
}

fn nanoseconds(seconds: f64) -> u64 {
    u64::try_from(Duration::from_secs_f64(seconds).as_nanos()).unwrap_or(u64::MAX)
}
