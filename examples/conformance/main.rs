//! Tests a simulator against `simulation_interfaces`: all advertised features, as a black box.
//!
//! ```text
//! conformance [--prefix /jamgrip] [--way enhanced|cyclone] [--version 1|2] [--timeout 10]
//! ```
//!
//! It only depends on the standard, so it can test any simulator. `--way` selects how requests are
//! identified (rmw_fastrtps or rmw_cyclonedds), `--timeout` is the timeout of responses in
//! seconds. The simulation is reset and its entities are moved. Exit codes: 0 all advertised
//! features pass, 1 no response, 2 the command line is invalid, 3 a check fails.

mod checks; // the list of checks
mod client; // calls services and reads the clock
mod entities; // checks on entities
mod run_state; // checks on states, steps and resets
mod spawning; // checks on spawning and named poses
mod worlds; // checks on worlds

use std::{
    io::{self, Write},
    process::ExitCode,
    time::Duration,
};

use checks::{CheckResult, Outcome};
use client::Client;
use jamgrip::{
    ros::{discovery::DiscoveryRange, node::RosNode, service::ServiceMapping},
    scene::Ros,
};

/// The command line options.
#[derive(Clone, Debug)]
struct Options {
    prefix: String,
    mapping: ServiceMapping,
    version: u8,
    timeout: Duration,
}

fn main() -> ExitCode {
    let options = match options(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(error) => {
            drop(writeln!(io::stderr().lock(), "{error}"));
            return ExitCode::from(2);
        }
    };
    match run(&options) {
        Ok(outcomes) => report(&outcomes),
        Err(error) => {
            drop(writeln!(io::stderr().lock(), "{error}"));
            ExitCode::FAILURE
        }
    }
}

fn options(mut arguments: impl Iterator<Item = String>) -> Result<Options, String> {
    let mut options = Options {
        prefix: "/jamgrip".to_owned(),
        mapping: ServiceMapping::Enhanced,
        version: 2,
        timeout: Duration::from_secs(10),
    };
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or(format!("{name} needs a value"))?;
        match (name.as_str(), value.as_str()) {
            ("--prefix", _) => options.prefix = value,
            ("--way", "enhanced") => options.mapping = ServiceMapping::Enhanced,
            ("--way", "cyclone") => options.mapping = ServiceMapping::Cyclone,
            ("--version", "1") => options.version = 1,
            ("--version", "2") => options.version = 2,
            ("--timeout", _) => {
                let seconds =
                    value.parse().map_err(|_| format!("`{value}` is not a number of seconds"))?;
                options.timeout = Duration::from_secs(seconds);
            }
            _ => return Err(format!("unknown option `{name} {value}`")),
        }
    }
    Ok(options)
}

fn run(options: &Options) -> Result<Vec<Outcome>, String> {
    let scene = Ros { enabled: true, ..Ros::OFF };
    let range = DiscoveryRange::choose(&scene, |name| std::env::var(name).ok());
    let node = RosNode::join_as("conformance", &range.map_err(|it| it.to_string())?);
    let mut client = Client::new(node.map_err(|it| it.to_string())?, options)?;
    checks::all(&mut client)
}

fn report(outcomes: &[Outcome]) -> ExitCode {
    let mut out = io::stdout().lock();
    for outcome in outcomes {
        let (word, text) = match &outcome.result {
            CheckResult::Passed => ("pass", ""),
            CheckResult::Skipped => ("skip", "not advertised"),
            CheckResult::Failed(reason) => ("FAIL", reason.as_str()),
        };
        drop(writeln!(out, "{word}  {:<46} {text}", outcome.name));
    }
    let n_failed = outcomes.iter().filter(|it| matches!(it.result, CheckResult::Failed(_))).count();
    let n_passed = outcomes.iter().filter(|it| matches!(it.result, CheckResult::Passed)).count();
    drop(writeln!(out, "{n_passed} passed, {n_failed} failed, {} in total", outcomes.len()));
    if n_failed == 0 { ExitCode::SUCCESS } else { ExitCode::from(3) }
}
