//! The subcommands `experiment`, `validate` and `report`.

use std::{
    error::Error,
    io::{self, Write},
    path::Path,
    process::ExitCode,
};

use jamgrip::{
    experiments::{EXPERIMENTS, Size},
    host::shutdown::Shutdown,
    runner::{
        self, Ending, Options, Task,
        experiment::{self, RunRequest},
        folder::Policy,
        outcome::{Outcome, sized_name},
        table::{self, TableLayout},
        validation_doc,
    },
};

use crate::args::{CommonArgs, Experiment, Validate};

/// A case could not run.
const FAILED: u8 = 1;
/// All cases ran, and a row fails.
const ROW_FAILED: u8 = 3;
/// The user interrupted it: 128 plus the number of SIGINT.
const INTERRUPTED: u8 = 130;

pub(crate) fn experiment(args: &Experiment) -> Result<ExitCode, Box<dyn Error>> {
    if args.list {
        return list();
    }
    let name = args.name.as_deref().unwrap_or_default();
    let request = RunRequest {
        experiment: experiment::by_name(name)?,
        size: args.size(),
        overrides: args.set.clone(),
        scene: args.scene.clone(),
    };
    let out = args.out(name);
    let policy = Policy { is_fresh: args.fresh, allows_mixed_builds: args.mixed_builds };
    let tasks = [Task { request, out: Some(out.clone()) }];
    let ending = run(&tasks, &args.common, policy)?;
    let Ending::Finished(outcomes) = ending else { return interrupted(&ending, true) };
    let mut stdout = io::stdout().lock();
    for outcome in &outcomes {
        if args.common.json {
            writeln!(stdout, "{}", outcome.to_line())?;
        } else {
            write!(stdout, "{}", table::of_one(outcome, layout()))?;
            writeln!(stdout, "results in {}; see report.html", out.display())?;
        }
    }
    Ok(verdict(&outcomes))
}

pub(crate) fn validate(args: &Validate) -> Result<ExitCode, Box<dyn Error>> {
    let mut experiments = EXPERIMENTS.to_vec();
    if !args.names.is_empty() {
        let chosen = args.names.iter().map(|name| experiment::by_name(name));
        experiments = chosen.collect::<Result<_, _>>()?;
    }
    let task = |experiment| {
        let request =
            RunRequest { experiment, size: Size::Quick, overrides: Vec::new(), scene: None };
        let name = sized_name(experiment.name(), Size::Quick);
        Task { request, out: args.out.as_ref().map(|out| out.join(name)) }
    };
    let tasks: Vec<Task<'_>> = experiments.into_iter().map(task).collect();
    let policy = Policy { is_fresh: args.fresh, allows_mixed_builds: false };
    let ending = run(&tasks, &args.common, policy)?;
    let Ending::Finished(outcomes) = ending else {
        return interrupted(&ending, args.out.is_some());
    };
    let mut stdout = io::stdout().lock();
    if args.common.json {
        let rows = outcomes.iter().flat_map(Outcome::rows_as_json);
        let lines: Vec<String> = rows.map(|row| row.to_string()).collect();
        writeln!(stdout, "[\n{}\n]", lines.join(",\n"))?;
    } else {
        write!(stdout, "{}", table::of_all(&outcomes, layout()))?;
    }
    Ok(verdict(&outcomes))
}

pub(crate) fn report(from: &Path, to: &Path) -> Result<ExitCode, Box<dyn Error>> {
    validation_doc::write(&validation_doc::read(from)?, to)?;
    Ok(ExitCode::SUCCESS)
}

fn list() -> Result<ExitCode, Box<dyn Error>> {
    let mut stdout = io::stdout().lock();
    for it in EXPERIMENTS {
        writeln!(stdout, "{:<16} {}\n{:<16} {}", it.name(), it.about(), "", it.scene().0)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn run(tasks: &[Task<'_>], common: &CommonArgs, policy: Policy) -> Result<Ending, Box<dyn Error>> {
    let shutdown = Shutdown::listen()?;
    let options = Options {
        n_threads: common.n_threads(),
        is_quiet: common.json,
        policy,
        shutdown: &shutdown,
    };
    Ok(runner::run(tasks, &options)?)
}

fn interrupted(ending: &Ending, is_saved: bool) -> Result<ExitCode, Box<dyn Error>> {
    if let Ending::Interrupted { n_done, n_cases } = ending {
        let rest = if is_saved { "; the same command resumes the run" } else { "" };
        writeln!(io::stderr().lock(), "interrupted: {n_done} of {n_cases} cases done{rest}")?;
    }
    Ok(ExitCode::from(INTERRUPTED))
}

fn verdict(outcomes: &[Outcome]) -> ExitCode {
    if !outcomes.iter().all(Outcome::is_complete) {
        return ExitCode::from(FAILED);
    }
    let has_failed_row = outcomes.iter().any(|outcome| 0 < outcome.n_failed());
    if has_failed_row { ExitCode::from(ROW_FAILED) } else { ExitCode::SUCCESS }
}

/// Width of the terminal, if the shell exports it.
fn layout() -> TableLayout {
    TableLayout::new(std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok()))
}
