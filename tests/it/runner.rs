//! The experiment runner: cases in parallel, failures, stopping and resuming, folders with other
//! contents, and result files.

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use jamgrip::{
    experiments::Size,
    host::shutdown::Shutdown,
    runner::{
        self, Ending, Options, Task,
        error::RunnerError,
        experiment::RunRequest,
        folder::Policy,
        outcome::Outcome,
        report,
        table::{self, TableLayout},
        validation_doc,
    },
};

use crate::{oscillator::Oscillator, peers};

fn run(
    experiment: &Oscillator,
    out: Option<&Path>,
    n_threads: usize,
    policy: Policy,
) -> Result<Ending, RunnerError> {
    run_changed(experiment, out, n_threads, policy, &[])
}

fn run_changed(
    experiment: &Oscillator,
    out: Option<&Path>,
    n_threads: usize,
    policy: Policy,
    overrides: &[&str],
) -> Result<Ending, RunnerError> {
    let shutdown = experiment.stop.as_ref().map_or_else(Shutdown::default, |it| it.0.clone());
    let overrides = overrides.iter().map(|it| (*it).to_owned()).collect();
    let request = RunRequest { experiment, size: Size::Quick, overrides, scene: None };
    let tasks = [Task { request, out: out.map(Path::to_owned) }];
    runner::run(&tasks, &Options { n_threads, is_quiet: true, policy, shutdown: &shutdown })
}

fn outcome(ending: Result<Ending, RunnerError>) -> Outcome {
    match ending.unwrap() {
        Ending::Finished(mut outcomes) => outcomes.remove(0),
        Ending::Interrupted { .. } => panic!("the run was not stopped"),
    }
}

/// The outcome without times.
fn without_times(mut outcome: Outcome) -> Outcome {
    outcome.wall_s = 0.0;
    outcome.cases.iter_mut().for_each(|case| case.wall_s.clear());
    outcome
}

fn with(also: &[&str]) -> Oscillator {
    Oscillator { also: also.iter().map(|it| (*it).to_owned()).collect(), stop: None }
}

/// Oracle: the run on one thread.
#[test]
fn parallel_cases_give_the_same_results() {
    let one = outcome(run(&with(&[]), None, 1, Policy::default()));
    assert!(one.rows.len() == 3 && one.n_failed() == 0, "{:?}", one.rows);
    assert!(one.cases.iter().all(|case| case.wall_s.contains_key("swinging")));
    for n_threads in [2, 7] {
        let many = outcome(run(&with(&[]), None, n_threads, Policy::default()));
        assert_eq!(without_times(many), without_times(one.clone()));
    }
}

/// Oracle: each experiment alone.
#[test]
fn experiments_share_one_queue_and_keep_their_order() {
    let experiments = [with(&["growing"]), with(&[])];
    let task = |experiment| {
        let request =
            RunRequest { experiment, size: Size::Full, overrides: Vec::new(), scene: None };
        Task { request, out: None }
    };
    let tasks = [task(&experiments[0]), task(&experiments[1])];
    let shutdown = Shutdown::default();
    let policy = Policy::default();
    let options = Options { n_threads: 3, is_quiet: true, policy, shutdown: &shutdown };
    let Ending::Finished(found) = runner::run(&tasks, &options).unwrap() else { panic!("stopped") };
    for (found, experiment) in found.into_iter().zip(&experiments) {
        let alone = Outcome { size: Size::Full, ..outcome(run(experiment, None, 1, policy)) };
        assert_eq!(without_times(found), without_times(alone));
    }
}

/// Oracle: the file itself; the error names a missing file.
#[test]
fn a_scene_file_replaces_the_built_in_scene() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.yaml");
    let experiment = with(&[]);
    let run_mine = || {
        let scene = Some(file.clone());
        let (size, overrides) = (Size::Quick, Vec::new());
        let tasks = [Task {
            request: RunRequest { experiment: &experiment, size, overrides, scene },
            out: None,
        }];
        let shutdown = Shutdown::default();
        let policy = Policy::default();
        runner::run(&tasks, &Options { n_threads: 1, is_quiet: true, policy, shutdown: &shutdown })
    };
    let error = run_mine().unwrap_err();
    assert!(error.is_of_command_line() && error.to_string().contains("mine.yaml"), "{error}");
    fs::write(&file, "dampings: []").unwrap();
    let found = outcome(run_mine());
    assert_eq!(found.scene.source, file.display().to_string());
    let usual = outcome(run(&experiment, None, 1, Policy::default()));
    assert_ne!(found.scene.digest, usual.scene.digest);
    assert!(table::command(&found).contains("--scene"));
}

/// Oracle: the run without the failing cases, and the errors that they were made for.
#[test]
fn a_failed_case_is_a_row_that_fails_and_does_not_affect_others() {
    let alone = outcome(run(&with(&[]), None, 2, Policy::default()));
    let found = outcome(run(&with(&["growing", "panicking"]), None, 2, Policy::default()));
    assert!(!found.is_complete());
    assert_eq!(without_times(alone.clone()).cases, without_times(found.clone()).cases[..3]);
    assert_eq!(found.rows[..3], alone.rows);
    let error = |i: usize| found.cases[i].error.clone().unwrap();
    assert!(error(3).contains("height [m] of oscillator") && error(3).contains("damp it"));
    assert_eq!(error(4), "the program panicked: expected panic");
    let failed: Vec<&str> =
        found.rows.iter().filter(|row| !row.pass).map(|row| row.id.as_str()).collect();
    assert_eq!(
        failed,
        ["oscillator.growing.ran_to_its_end", "oscillator.panicking.ran_to_its_end"]
    );
    assert!(
        table::of_one(&found, TableLayout::new(None))
            .contains("FAIL oscillator.growing.ran_to_its_end")
    );
}

/// Oracle: the run without a break, bit for bit: digests of all cases and all numbers.
#[test]
fn a_stopped_run_resumes_with_the_same_bits() {
    let uninterrupted = tempfile::tempdir().unwrap();
    let uninterrupted =
        outcome(run(&with(&[]), Some(&uninterrupted.path().join("a")), 2, Policy::default()));
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results/oscillator_quick");
    let stopping = Oscillator { stop: Some((Shutdown::default(), 17)), ..with(&[]) };
    let ending = run(&stopping, Some(&out), 2, Policy::default()).unwrap();
    let Ending::Interrupted { n_cases: 3, .. } = ending else { panic!("{ending:?}") };
    assert!(out.join("states/damping_0.1.state").exists());
    assert!(!out.join("result.json").exists());
    let resumed = outcome(run(&with(&[]), Some(&out), 1, Policy::default()));
    assert_eq!(without_times(resumed.clone()), without_times(uninterrupted));
    assert_eq!(fs::read_dir(out.join("states")).unwrap().count(), 0);
    // Once more: everything is read, nothing runs, and the times are those of the first run.
    assert_eq!(outcome(run(&with(&[]), Some(&out), 2, Policy::default())), resumed);
}

/// Oracle: the run without a break.
#[test]
fn damaged_states_and_cases_are_restarted() {
    let folder = tempfile::tempdir().unwrap();
    let stopping = Oscillator { stop: Some((Shutdown::default(), 9)), ..with(&[]) };
    run(&stopping, Some(folder.path()), 1, Policy::default()).unwrap();
    let state = folder.path().join("states/damping_0.1.state");
    let mut bytes = fs::read(&state).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&state, bytes).unwrap();
    // The longest case was started first and is stored.
    fs::write(folder.path().join("cases/damping_0.2.json"), "{").unwrap();
    let found = outcome(run(&with(&[]), Some(folder.path()), 2, Policy::default()));
    let uninterrupted = outcome(run(&with(&[]), None, 2, Policy::default()));
    assert_eq!(without_times(found), without_times(uninterrupted));
}

/// Oracle: differences are named with a remedy; old files stay until `--fresh`.
#[test]
fn a_folder_with_other_contents_is_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let first = outcome(run(&with(&[]), Some(out), 2, Policy::default()));
    let changed = |policy| run_changed(&with(&[]), Some(out), 2, policy, &["omega=4"]);
    let error = changed(Policy { allows_mixed_builds: true, ..Policy::default() }).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("the scene is unchanged in the folder, but changed by omega=4 here"),
        "{text}"
    );
    assert!(text.contains("--fresh") && text.contains("--out"), "{text}");
    assert_eq!(outcome(run(&with(&[]), Some(out), 2, Policy::default())), first);

    let plan = out.join("plan.json");
    let text = fs::read_to_string(&plan).unwrap();
    fs::write(&plan, text.replace(&first.build.programs[0], "0123456789abcdef")).unwrap();
    let text = run(&with(&[]), Some(out), 2, Policy::default()).unwrap_err().to_string();
    assert!(text.contains("another build") && text.contains("--mixed-builds"), "{text}");
    let mixed = Policy { allows_mixed_builds: true, ..Policy::default() };
    outcome(run(&with(&[]), Some(out), 2, mixed));

    fs::write(out.join("mine.txt"), "mine").unwrap();
    let restarted = outcome(changed(Policy { is_fresh: true, ..Policy::default() }));
    assert_eq!(restarted.scene.overrides, ["omega=4"]);
    assert!(out.join("mine.txt").exists(), "other files stay");

    let foreign = tempfile::tempdir().unwrap();
    fs::write(foreign.path().join("mine.txt"), "mine").unwrap();
    let error = run(&with(&[]), Some(foreign.path()), 2, Policy::default()).unwrap_err();
    assert!(matches!(error, RunnerError::Foreign { .. }), "{error}");
}

/// Oracle: the outcome in memory, and an independent HTML parser.
#[test]
fn files_contain_the_outcome() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let found = outcome(run(&with(&["growing"]), Some(out), 2, Policy::default()));
    let text = fs::read_to_string(out.join("result.json")).unwrap();
    assert_eq!(Outcome::from_text(&text).unwrap(), found);

    let curve = fs::read_to_string(out.join("curves/height_damping_0.1.csv")).unwrap();
    let lines: Vec<&str> = curve.lines().collect();
    assert_eq!((lines[0], lines.len()), ("time [s],height [m]", 41));
    let height: f64 = lines[40].split(',').nth(1).unwrap().parse().unwrap();
    assert_eq!(height.to_bits(), found.quantities[1].value.to_bits(), "all digits are kept");

    let page = out.join("report.html");
    let page_text = peers::run("read_page.py", &[page.to_str().unwrap()]);
    for row in &found.rows {
        assert!(page_text.contains(&format!("id {}\n", row.id)), "{} in {page_text}", row.id);
    }
    for plot in &found.plots {
        assert!(
            page_text.contains(&plot.title) && page_text.contains(&plot.source_says),
            "{page_text}"
        );
    }
    assert!(page_text.contains("pictures 1\n") && page_text.contains(&found.about), "{page_text}");
    assert!(
        page_text.contains("Outside the model's validity: damping_0.2: overlap over diameter"),
        "{page_text}"
    );
    assert!(page_text.contains("jamgrip experiment oscillator --quick"), "{page_text}");
}

/// Oracle: the rows themselves.
#[test]
fn documents_and_tables_contain_every_row() {
    let found = outcome(run(&with(&["growing"]), None, 2, Policy::default()));
    let files = validation_doc::files(std::slice::from_ref(&found));
    let document = &files[0].1;
    assert_eq!((files.len(), files[1].0.as_str()), (2, "figures/oscillator_quick_1.svg"));
    let screen = table::of_all(std::slice::from_ref(&found), TableLayout::new(Some(110)));
    let first_column: String = screen.lines().filter_map(|it| it.split('┆').next()).collect();
    let first_column = first_column.replace(['│', ' '], "");
    for row in &found.rows {
        assert!(document.contains(&format!("`{}`", row.id)), "{document}");
        assert!(first_column.contains(&row.id), "{screen}");
    }
    assert!(document.contains("height at the end \\| of the run"), "cells are escaped");
    let in_table = |line: &&str| line.starts_with(['│', '┌', '├', '└']);
    assert!(screen.lines().filter(in_table).all(|line| line.chars().count() <= 110));
    assert!(
        screen.contains("3 of 4 rows pass") && screen.contains("outside the model's validity"),
        "{screen}"
    );
    let rows: Vec<_> = found.rows_as_json().collect();
    assert_eq!(rows.len(), 4);
    for key in ["id", "quantity", "unit", "oracle", "tolerance", "measured", "pass", "reason"] {
        assert!(rows.iter().all(|row| !row[key].is_null()), "{key}");
    }
    assert_eq!(rows[3]["pass"], false);
}

/// Oracle: the stored results, rendered again. After a change of either:
/// `JAMGRIP_UPDATE=1 cargo test --release --test it validation`, then read the diff.
#[test]
fn the_validation_document_matches_the_stored_results() {
    let stored = validation_doc::read(Path::new("tests/golden/validation")).unwrap();
    let files = validation_doc::files(&stored);
    let is_ours = |name: &String| name == "validation.md" || name.starts_with("figures/");
    assert!(files.iter().all(|(name, _)| is_ours(name)), "only these may be replaced");
    if std::env::var_os("JAMGRIP_UPDATE").is_some() {
        drop(fs::remove_dir_all("docs/figures"));
        validation_doc::write(&stored, Path::new("docs")).unwrap();
    }
    for (name, text) in &files {
        let present = fs::read_to_string(Path::new("docs").join(name)).unwrap_or_default();
        assert!(present == *text, "docs/{name} is out of date");
    }
    let n_figures = fs::read_dir("docs/figures").map_or(0, Iterator::count);
    assert_eq!(n_figures + 1, files.len(), "there is no unused figure");
    for outcome in &stored {
        assert_eq!(report::page(outcome).matches("<figure>").count(), outcome.plots.len());
    }
}

fn jamgrip(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_jamgrip")).args(arguments).output().unwrap()
}

/// Oracle: the list itself, and exit codes as documented in `--help`.
#[test]
fn experiments_are_listed_and_unknown_ones_rejected() {
    let listed = jamgrip(&["experiment", "--list"]);
    assert!(listed.status.success());
    let listed = String::from_utf8(listed.stdout).unwrap();
    for it in jamgrip::experiments::EXPERIMENTS {
        assert!(listed.contains(it.name()) && listed.contains(it.about()), "{listed}");
    }
    for arguments in [&["experiment", "triaxal"][..], &["validate", "triaxal"]] {
        let output = jamgrip(arguments);
        assert_eq!(output.status.code(), Some(2));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains("no experiment `triaxal`"), "{errors}");
        assert!(output.stdout.is_empty());
    }
    let missing = jamgrip(&["report", "/nowhere", "/nowhere"]);
    assert_eq!(missing.status.code(), Some(1));
}

/// Oracle: the rules for names of files, and for the sizes.
#[test]
fn every_experiment_can_be_read_in_both_sizes() {
    for it in jamgrip::experiments::EXPERIMENTS {
        let (source, text) = it.scene();
        assert_eq!(fs::read_to_string(source).unwrap(), text, "the scene of {}", it.name());
        for size in [Size::Quick, Size::Full] {
            let scene = jamgrip::experiments::SceneText { text, source, overrides: &[], size };
            let plan = it.read(&scene).unwrap_or_else(|error| panic!("{}: {error}", it.name()));
            let mut cases = plan.cases();
            let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
            assert!(cases.iter().all(|case| case.chars().all(is_plain)), "{cases:?}");
            let n = cases.len();
            cases.sort();
            cases.dedup();
            assert!(0 < n && n == cases.len(), "cases of {}: {cases:?}", it.name());
        }
    }
}
