//! Asks a simulator what it advertises of `simulation_interfaces`, and tries all of it from outside.
//!
//! ```text
//! conformance [--prefix /jamgrip] [--way enhanced|cyclone] [--version 1|2] [--patience 10]
//! ```
//!
//! It knows nothing of the simulator but the standard, so it may be pointed at any. The simulation is
//! reset and its entities are moved about. Exit codes: 0 all that is advertised passes, 1 nobody
//! answers, 2 the command line is wrong, 3 something fails.

mod checks; // what is tried
mod client; // how it is asked
mod entities; // checks on entities
mod running; // checks on states, steps and resets
mod spawning; // checks on spawning and named poses
mod worlds; // checks on worlds

use std::{
    io::{self, Write},
    process::ExitCode,
    time::Duration,
};

use checks::{Outcome, Verdict};
use client::Client;
use jamgrip::{
    ros::{discovery::DiscoveryRange, node::RosNode, service::ServiceMapping},
    scene::Ros,
};

/// What was asked for on the command line.
#[derive(Clone, Debug)]
struct Options {
    prefix: String,
    way: ServiceMapping,
    version: u8,
    patience: Duration,
}

fn main() -> ExitCode {
    let options = match options(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(fault) => {
            drop(writeln!(io::stderr().lock(), "{fault}"));
            return ExitCode::from(2);
        }
    };
    match run(&options) {
        Ok(outcomes) => tell(&outcomes),
        Err(fault) => {
            drop(writeln!(io::stderr().lock(), "{fault}"));
            ExitCode::FAILURE
        }
    }
}

fn options(mut arguments: impl Iterator<Item = String>) -> Result<Options, String> {
    let mut options = Options {
        prefix: "/jamgrip".to_owned(),
        way: ServiceMapping::Enhanced,
        version: 2,
        patience: Duration::from_secs(10),
    };
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or(format!("{name} needs a value"))?;
        match (name.as_str(), value.as_str()) {
            ("--prefix", _) => options.prefix = value,
            ("--way", "enhanced") => options.way = ServiceMapping::Enhanced,
            ("--way", "cyclone") => options.way = ServiceMapping::Cyclone,
            ("--version", "1") => options.version = 1,
            ("--version", "2") => options.version = 2,
            ("--patience", _) => {
                let seconds = value.parse().map_err(|_| format!("`{value}` is no time in s"))?;
                options.patience = Duration::from_secs(seconds);
            }
            _ => return Err(format!("what is `{name} {value}`?")),
        }
    }
    Ok(options)
}

fn run(options: &Options) -> Result<Vec<Outcome>, String> {
    let scene = Ros { enabled: true, ..Ros::OFF };
    let reach = DiscoveryRange::choose(&scene, |name| std::env::var(name).ok());
    let node = RosNode::join_as("conformance", &reach.map_err(|it| it.to_string())?);
    let mut client = Client::new(node.map_err(|it| it.to_string())?, options)?;
    checks::all(&mut client)
}

fn tell(outcomes: &[Outcome]) -> ExitCode {
    let mut out = io::stdout().lock();
    for outcome in outcomes {
        let (word, text) = match &outcome.verdict {
            Verdict::Passed => ("pass", ""),
            Verdict::Skipped => ("skip", "not advertised"),
            Verdict::Failed(why) => ("FAIL", why.as_str()),
        };
        drop(writeln!(out, "{word}  {:<46} {text}", outcome.name));
    }
    let n_failed = outcomes.iter().filter(|it| matches!(it.verdict, Verdict::Failed(_))).count();
    let n_passed = outcomes.iter().filter(|it| matches!(it.verdict, Verdict::Passed)).count();
    drop(writeln!(out, "{n_passed} passed, {n_failed} failed, {} in all", outcomes.len()));
    if n_failed == 0 { ExitCode::SUCCESS } else { ExitCode::from(3) }
}
