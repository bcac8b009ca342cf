//! The progress display on the terminal: a bar for each running case, and one for all with the
//! remaining time. Without a terminal, a line for each finished case and one every minute.

use std::{
    fmt::Display,
    io::{self, Write},
    sync::Mutex,
};

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{
    case::CaseEnd,
    workers::{self, Job},
};
use crate::{experiments::Progress, host::clock::Stopwatch};
use crate::{report::format, runner::eta::TimeEstimate};

/// Steps of a bar.
const STEPS: u64 = 1000;
/// Wall-clock time between two lines without a terminal (s).
const LINE_PERIOD_S: f64 = 60.0;

/// The progress display on standard error.
pub struct ProgressDisplay {
    bars: MultiProgress,
    overall: ProgressBar,
    titles: Vec<String>,
    /// Index of each job in the queue.
    queue_indices: Vec<usize>,
    estimate: Mutex<TimeEstimate>,
    watch: Stopwatch,
    last_line_s: Mutex<f64>,
    is_quiet: bool,
}

impl ProgressDisplay {
    /// Creates a display; with `is_quiet` it only shows errors.
    pub(super) fn new(jobs: &[Job<'_>], n_threads: usize, is_quiet: bool) -> Self {
        let target =
            if is_quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bars = MultiProgress::with_draw_target(target);
        let overall = bars.add(ProgressBar::new(STEPS));
        overall.set_style(style("{bar:24} {msg}"));
        let queue = workers::queue(jobs);
        let mut queue_indices = vec![0; jobs.len()];
        queue.iter().enumerate().for_each(|(queue_index, &i)| queue_indices[i] = queue_index);
        let group = |i: usize| {
            let name = &jobs[i].loaded.identity.experiment;
            jobs.iter().position(|job| job.loaded.identity.experiment == *name).unwrap_or(i)
        };
        let cases = queue.iter().map(|&i| (group(i), jobs[i].expected_s()));
        Self {
            bars,
            overall,
            titles: jobs.iter().map(Job::title).collect(),
            queue_indices,
            estimate: Mutex::new(TimeEstimate::new(n_threads, cases)),
            watch: Stopwatch::start(),
            last_line_s: Mutex::new(0.0),
            is_quiet,
        }
    }

    /// Adds a line for job `i`.
    pub(super) fn begin(&self, i: usize) -> CaseProgress<'_> {
        let bar = self.bars.insert_before(&self.overall, ProgressBar::new(STEPS));
        bar.set_style(style("{bar:24} {msg}"));
        CaseProgress { progress: self, i, bar }
    }

    /// Prints a message above the bars.
    fn say(&self, text: &dyn Display) {
        self.bars.suspend(|| {
            // If standard error is closed, the message is lost.
            drop(writeln!(io::stderr().lock(), "jamgrip: {text}"));
        });
    }

    fn estimate<R>(&self, apply: impl FnOnce(&mut TimeEstimate) -> R) -> R {
        apply(&mut self.estimate.lock().expect("nothing panics under this lock"))
    }

    /// The overall progress as text.
    fn state(&self) -> String {
        let (n_ended, share, remaining) =
            self.estimate(|it| (it.n_ended(), it.share(), it.remaining_s()));
        let n = self.titles.len();
        let elapsed = format::duration(self.watch.total_s());
        let remaining = remaining
            .map_or_else(String::new, |it| format!(", about {} remaining", format::duration(it)));
        format!("{n_ended} of {n} cases done, {:.0} %, after {elapsed}{remaining}", share * 1e2)
    }

    fn show_overall(&self) {
        let share = self.estimate(|it| it.share());
        self.overall.set_position(steps(share));
        self.overall.set_message(self.state());
    }

    /// Prints the overall progress once a minute if there are no bars.
    fn print_once_a_minute(&self) {
        let mut last_line_s = self.last_line_s.lock().expect("nothing panics under this lock");
        if !self.is_quiet && LINE_PERIOD_S <= self.watch.total_s() - *last_line_s {
            *last_line_s = self.watch.total_s();
            self.say(&self.state());
        }
    }

    /// Removes the display.
    pub(super) fn end(&self) {
        // If standard error is closed, there is nothing to remove.
        drop(self.bars.clear());
    }
}

/// The display of one case.
pub(super) struct CaseProgress<'a> {
    progress: &'a ProgressDisplay,
    i: usize,
    bar: ProgressBar,
}

impl CaseProgress<'_> {
    /// Shows the progress of the case, after `wall_s` of this run, which started at `start_share`.
    pub(super) fn show(&self, progress: &Progress, start_share: f64, wall_s: f64) {
        let queue_index = self.progress.queue_indices[self.i];
        let remaining = self.progress.estimate(|it| {
            it.running(queue_index, start_share, progress.share, wall_s);
            it.remaining_of(queue_index)
        });
        if self.bar.is_hidden() {
            self.progress.print_once_a_minute();
            return;
        }
        self.bar.set_position(steps(progress.share));
        let title = &self.progress.titles[self.i];
        let remaining =
            remaining.map_or_else(String::new, |it| format!(", {} left", format::duration(it)));
        let percent = progress.share * 1e2;
        self.bar.set_message(format!("{title}: {}, {percent:.0} %{remaining}", progress.phase));
        self.progress.show_overall();
    }

    /// Prints a message above the bars.
    pub(super) fn say(&self, text: &dyn Display) {
        self.progress.say(text);
    }

    /// Removes the bar of the case and reports how it ended.
    pub(super) fn end(self, end: &CaseEnd) {
        let queue_index = self.progress.queue_indices[self.i];
        let title = &self.progress.titles[self.i];
        let took_s = match end {
            CaseEnd::Finished(finished) => Some(finished.record.wall_s.values().sum()),
            CaseEnd::Failed(_) | CaseEnd::Stopped => None,
        };
        self.progress.estimate(|it| it.ended(queue_index, took_s));
        self.bar.finish_and_clear();
        match end {
            CaseEnd::Failed(reason) => self.say(&format!("{title} failed: {reason}")),
            CaseEnd::Finished(_) if !self.progress.is_quiet && self.bar.is_hidden() => {
                let took = format::duration(took_s.unwrap_or(0.0));
                self.say(&format!("{title}: {took}; {}", self.progress.state()));
            }
            CaseEnd::Finished(_) | CaseEnd::Stopped => {}
        }
        self.progress.show_overall();
    }
}

fn steps(share: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, reason = "at most STEPS")]
    #[expect(clippy::cast_sign_loss, reason = "clamped to be positive")]
    let steps = (share.clamp(0.0, 1.0) * STEPS as f64).round() as u64;
    steps
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the templates in this file are valid")
}
