//! The subcommands `replay` and `bag`.

use std::{
    error::Error,
    io::{self, BufRead, Write},
    path::Path,
    process::ExitCode,
    sync::mpsc,
    time::Duration,
};

use jamgrip::{
    bag::{check, info::Info, recover, source::Script},
    host::{cache::Cache, progress_bar::Progress, shutdown::Shutdown},
    node::launch::{Finished, Options, launch_by},
    replay::{
        branch::{self, Branch},
        page,
        play::{self, Played},
        player_command::{CommandRequest, PlayerCommand},
        recorded_run::RecordedRun,
        segment::{Difference, DifferenceKind},
        verify::{self, VerifyReport},
    },
    scene::Scene,
    wire::{from_ros::CommandCodec, topics::topics},
};

use crate::{
    args_bag::{Bag, Inspect, Replay},
    summary,
};

/// A digest differs, a recording is damaged, or an error occurred.
const FAILED: u8 = 1;
/// The command line is invalid; clap uses the same code.
const INVALID_USAGE: u8 = 2;
/// The user interrupted it: 128 plus the number of SIGINT.
const INTERRUPTED: u8 = 130;

pub(crate) fn replay(args: &Replay) -> Result<ExitCode, Box<dyn Error>> {
    match args.from {
        _ if args.verify => verify(args),
        Some(from) => branch(args, from),
        None => play(args),
    }
}

pub(crate) fn bag(action: &Bag) -> Result<ExitCode, Box<dyn Error>> {
    match action {
        Bag::Info(args) => info(args),
        Bag::Check(args) => check(args),
        Bag::Plot { bag, output } => plot(bag, output.as_deref()),
        Bag::Recover { bag, output } => recover(bag, output.as_deref()),
    }
}

/// Runs a scene under the commands of a recording.
pub(crate) fn run_by(
    commands: &Path,
    scene: &Scene,
    options: &Options,
) -> Result<Finished, Box<dyn Error>> {
    let topics = topics(scene);
    let objects = scene.objects.iter().map(|it| it.name.clone()).collect();
    let codec = CommandCodec::new(topics.clone(), objects);
    let tick_ns = scene.time.tick_ns;
    let script = Script::read(commands, &topics, &codec, tick_ns)?;
    // Without another end the run ends a second after the last command.
    let end = Duration::from_nanos(script.last_tick().saturating_mul(tick_ns)).as_secs_f64() + 1.0;
    let duration = Some(options.duration.unwrap_or(end));
    Ok(launch_by(scene, &Options { duration, ..options.clone() }, script)?)
}

fn verify(args: &Replay) -> Result<ExitCode, Box<dyn Error>> {
    let shutdown = Shutdown::listen()?;
    let progress = Progress::new(args.json);
    let recorded = RecordedRun::open(&args.bag)?;
    let report = verify::verify(
        &recorded,
        &verify::Options {
            cpu_budget: args.cpu_budget(),
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
        writeln!(stdout, "{}", report.to_json())?;
    } else {
        print_report(&mut stdout, &report)?;
    }
    Ok(match &report {
        it if it.is_interrupted => ExitCode::from(INTERRUPTED),
        it if it.is_equal() => ExitCode::SUCCESS,
        _ => ExitCode::from(FAILED),
    })
}

fn print_report(out: &mut impl Write, report: &VerifyReport) -> io::Result<()> {
    for remark in &report.remarks {
        writeln!(out, "{remark}")?;
    }
    let VerifyReport { n_ticks, n_compared, start_tick, real_time_factor, .. } = report;
    let ((n_jobs, n_threads), n_checkpoints) = (report.jobs_and_threads, report.n_checkpoints);
    writeln!(
        out,
        "{n_ticks} ticks simulated from tick {start_tick} at {real_time_factor:.3} x real time \
         ({n_jobs} segments in parallel, {n_threads} threads each); \
         {n_compared} digests and {n_checkpoints} checkpoints compared"
    )?;
    match &report.first_difference {
        Some(Difference { tick, kind: DifferenceKind::Digest { recorded, simulated } }) => {
            writeln!(
                out,
                "tick {tick} differs: {recorded:016x} is recorded, {simulated:016x} was simulated"
            )
        }
        Some(Difference { tick, kind: DifferenceKind::Checkpoint(part) }) => {
            writeln!(
                out,
                "checkpoint at tick {tick} differs although the digests are equal: {part}"
            )
        }
        None if report.is_interrupted => writeln!(out, "interrupted; all equal so far"),
        None if *n_compared == 0 => writeln!(out, "nothing to compare"),
        None => writeln!(out, "all equal"),
    }
}

fn branch(args: &Replay, from: f64) -> Result<ExitCode, Box<dyn Error>> {
    let recorded = RecordedRun::open(&args.bag)?;
    let options = Options {
        n_threads: args.n_threads(),
        duration: args.end,
        scene_file: args.bag.clone(),
        cache: args.cache.clone().map_or_else(Cache::of_user, Cache::new),
        is_quiet: args.json,
        shutdown: Shutdown::listen()?,
        facts: Vec::new(),
    };
    let requested = Branch { from_ns: nanoseconds(from), overrides: args.overrides() };
    let finished = match branch::branch(&recorded, &requested, &options) {
        Err(error) if error.is_of_command_line() => {
            writeln!(io::stderr().lock(), "{error}")?;
            return Ok(ExitCode::from(INVALID_USAGE));
        }
        other => other?,
    };
    summary::print(&finished.summary, args.json)?;
    match finished.error {
        Some(error) => Err(error.into()),
        None => Ok(ExitCode::SUCCESS),
    }
}

fn play(args: &Replay) -> Result<ExitCode, Box<dyn Error>> {
    let shutdown = Shutdown::listen()?;
    let files = jamgrip::bag::files(&args.bag)?;
    let options = play::Options {
        rate: args.rate,
        start_ns: nanoseconds(args.start.unwrap_or(0.0)),
        end_ns: args.end.map(nanoseconds),
        is_paused: args.start_paused,
        is_loop: args.is_loop,
        topics: args.topics.clone(),
        exclude: args.exclude.clone(),
        delay: Duration::from_secs_f64(args.delay),
        clock_rate: args.clock,
    };
    let (sender, cues) = mpsc::channel();
    if args.cues {
        let sender = sender.clone();
        std::thread::Builder::new().name("cues".to_owned()).spawn(move || read_cues(&sender))?;
    }
    let perform = |player: &mut dyn play::PlayerOutput| {
        play::play(&files, &options, player, &cues, &shutdown)
    };
    let (played, error) = with_player_node(&options, sender, perform)?;
    let mut stderr = io::stderr().lock();
    for topic in &played.unplayable {
        writeln!(
            stderr,
            "{topic}: not played: its messages are not CDR, or its name is not valid in ROS 2"
        )?;
    }
    if 0 < played.n_damages {
        let n = played.n_damages;
        writeln!(stderr, "the recording has {n} damaged parts; `jamgrip bag check` lists them")?;
    }
    if let Some(error) = error {
        writeln!(stderr, "some messages were not published, the last: {error}")?;
    }
    let mut stdout = io::stdout().lock();
    if args.json {
        let (n, unplayable) = (played.n_published, &played.unplayable);
        writeln!(stdout, "{}", serde_json::json!({"published": n, "refused": unplayable}))?;
    } else {
        writeln!(stdout, "{} messages published", played.n_published)?;
    }
    let is_interrupted = shutdown.is_requested();
    Ok(if is_interrupted { ExitCode::from(INTERRUPTED) } else { ExitCode::SUCCESS })
}

/// What was played, and the last error of the publisher.
type Performance = (Played, Option<String>);

#[cfg(feature = "ros")]
fn with_player_node(
    options: &play::Options,
    sender: mpsc::Sender<CommandRequest>,
    perform: impl FnOnce(&mut dyn play::PlayerOutput) -> io::Result<Played>,
) -> Result<Performance, Box<dyn Error>> {
    use jamgrip::{replay::player_node::RosPlayerNode, ros::discovery::DiscoveryRange, scene::Ros};

    let anywhere = Ros { enabled: true, ..Ros::OFF };
    let reach = DiscoveryRange::choose(&anywhere, |name| std::env::var(name).ok())?;
    let mut player = RosPlayerNode::join(&reach, options.clock_rate.is_some())?;
    let _services = player.open_services(sender)?;
    let played = perform(&mut player)?;
    Ok((played, player.errors.1))
}

#[cfg(not(feature = "ros"))]
fn with_player_node(
    _: &play::Options,
    _: mpsc::Sender<CommandRequest>,
    _: impl FnOnce(&mut dyn play::PlayerOutput) -> io::Result<Played>,
) -> Result<Performance, Box<dyn Error>> {
    Err("playing needs a build with feature `ros`".into())
}

/// Reads cues until standard input or the player ends.
fn read_cues(sender: &mpsc::Sender<CommandRequest>) {
    for line in io::stdin().lock().lines().map_while(Result::ok) {
        match PlayerCommand::parse(&line) {
            Ok(cue) => {
                if sender.send(cue.into()).is_err() {
                    return;
                }
            }
            // Nothing can be done if standard error is closed.
            Err(error) => drop(writeln!(io::stderr().lock(), "{error}")),
        }
    }
}

fn info(args: &Inspect) -> Result<ExitCode, Box<dyn Error>> {
    let info = Info::read(&args.bag)?;
    let mut stdout = io::stdout().lock();
    if args.json { writeln!(stdout, "{}", info.to_json()) } else { write!(stdout, "{info}") }?;
    Ok(ExitCode::SUCCESS)
}

fn check(args: &Inspect) -> Result<ExitCode, Box<dyn Error>> {
    let findings = check::check(&args.bag)?;
    let mut stdout = io::stdout().lock();
    let n_errors = findings.iter().filter(|it| it.is_error).count();
    if args.json {
        let line = |it: &check::Finding| {
            let path = it.path.display().to_string();
            serde_json::json!({"error": it.is_error, "path": path, "text": it.text})
        };
        let findings: Vec<_> = findings.iter().map(line).collect();
        writeln!(stdout, "{}", serde_json::json!({"errors": n_errors, "findings": findings}))?;
    } else {
        for it in &findings {
            let kind = if it.is_error { "error" } else { "note" };
            writeln!(stdout, "{kind}: {}: {}", it.path.display(), it.text)?;
        }
        writeln!(stdout, "{n_errors} errors, {} notes", findings.len() - n_errors)?;
    }
    Ok(if n_errors == 0 { ExitCode::SUCCESS } else { ExitCode::from(FAILED) })
}

fn plot(path: &Path, output: Option<&Path>) -> Result<ExitCode, Box<dyn Error>> {
    let beside = || match path.is_dir() {
        true => path.join("report.html"),
        false => path.with_extension("html"),
    };
    let output = output.map_or_else(beside, Path::to_owned);
    let page = page::html(path)?;
    let error = |error| format!("{}: {error}; choose another file with --output", output.display());
    std::fs::write(&output, page).map_err(error)?;
    writeln!(io::stdout().lock(), "{}", output.display())?;
    Ok(ExitCode::SUCCESS)
}

fn recover(path: &Path, output: Option<&Path>) -> Result<ExitCode, Box<dyn Error>> {
    let output = output.map_or_else(|| recover::default_output(path), Path::to_owned);
    let recovered = recover::recover(path, &output)?;
    let mut stdout = io::stdout().lock();
    for (file, damage) in &recovered.damages {
        writeln!(stdout, "{}: {damage}", file.display())?;
    }
    let (n_messages, n_attachments) = (recovered.n_messages, recovered.n_attachments);
    let output = recovered.output.display();
    writeln!(stdout, "{n_messages} messages and {n_attachments} attachments saved in {output}")?;
    Ok(ExitCode::SUCCESS)
}

fn nanoseconds(seconds: f64) -> u64 {
    u64::try_from(Duration::from_secs_f64(seconds).as_nanos()).unwrap_or(u64::MAX)
}
