//! What a person at the terminal sees while cases run: a bar for each, and one for all with the
//! time that is left. Where there is no terminal, a line for each case that ends and one a minute.

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
use crate::{report::format, runner::eta::Forecast};

/// Steps of a bar.
const STEPS: u64 = 1000;
/// Wall time between two lines where there is no terminal (s).
const LINE_EVERY_S: f64 = 60.0;

/// The lines on standard error.
pub struct ProgressBoard {
    bars: MultiProgress,
    overall: ProgressBar,
    titles: Vec<String>,
    /// Place of each job in the queue.
    places: Vec<usize>,
    forecast: Mutex<Forecast>,
    watch: Stopwatch,
    said_at_s: Mutex<f64>,
    is_quiet: bool,
}

impl ProgressBoard {
    /// A board for a terminal; `is_quiet` shows nothing but faults.
    pub(super) fn new(jobs: &[Job<'_>], n_threads: usize, is_quiet: bool) -> Self {
        let target =
            if is_quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bars = MultiProgress::with_draw_target(target);
        let overall = bars.add(ProgressBar::new(STEPS));
        overall.set_style(style("{bar:24} {msg}"));
        let queue = workers::queue(jobs);
        let mut places = vec![0; jobs.len()];
        queue.iter().enumerate().for_each(|(place, &i)| places[i] = place);
        let group = |i: usize| {
            let name = &jobs[i].loaded.identity.experiment;
            jobs.iter().position(|job| job.loaded.identity.experiment == *name).unwrap_or(i)
        };
        let cases = queue.iter().map(|&i| (group(i), jobs[i].expected_s()));
        Self {
            bars,
            overall,
            titles: jobs.iter().map(Job::title).collect(),
            places,
            forecast: Mutex::new(Forecast::new(n_threads, cases)),
            watch: Stopwatch::start(),
            said_at_s: Mutex::new(0.0),
            is_quiet,
        }
    }

    /// Job `i` begins.
    pub(super) fn begin(&self, i: usize) -> Line<'_> {
        let bar = self.bars.insert_before(&self.overall, ProgressBar::new(STEPS));
        bar.set_style(style("{bar:24} {msg}"));
        Line { progress: self, i, bar }
    }

    /// Says something above the lines.
    fn say(&self, text: &dyn Display) {
        self.bars.suspend(|| {
            // If standard error is gone there is nobody to tell.
            drop(writeln!(io::stderr().lock(), "jamgrip: {text}"));
        });
    }

    fn forecast<R>(&self, use_it: impl FnOnce(&mut Forecast) -> R) -> R {
        use_it(&mut self.forecast.lock().expect("nothing panics under this lock"))
    }

    /// How far all is, in words.
    fn state(&self) -> String {
        let (n_ended, share, left) = self.forecast(|it| (it.n_ended(), it.share(), it.left_s()));
        let n = self.titles.len();
        let elapsed = format::duration(self.watch.total_s());
        let left =
            left.map_or_else(String::new, |it| format!(", about {} left", format::duration(it)));
        format!("{n_ended} of {n} cases done, {:.0} %, after {elapsed}{left}", share * 1e2)
    }

    fn show_overall(&self) {
        let share = self.forecast(|it| it.share());
        self.overall.set_position(steps(share));
        self.overall.set_message(self.state());
    }

    /// One line a minute where there are no bars.
    fn speak_now_and_then(&self) {
        let mut said_at_s = self.said_at_s.lock().expect("nothing panics under this lock");
        if !self.is_quiet && LINE_EVERY_S <= self.watch.total_s() - *said_at_s {
            *said_at_s = self.watch.total_s();
            self.say(&self.state());
        }
    }

    /// Removes the lines.
    pub(super) fn end(&self) {
        // If standard error is gone there is nobody to tell.
        drop(self.bars.clear());
    }
}

/// The line of a case.
pub(super) struct Line<'a> {
    progress: &'a ProgressBoard,
    i: usize,
    bar: ProgressBar,
}

impl Line<'_> {
    /// The case goes on, after `wall_s` of this run, which began at `share_at_start`.
    pub(super) fn show(&self, progress: &Progress, share_at_start: f64, wall_s: f64) {
        let place = self.progress.places[self.i];
        let left = self.progress.forecast(|it| {
            it.running(place, share_at_start, progress.share, wall_s);
            it.left_of(place)
        });
        if self.bar.is_hidden() {
            self.progress.speak_now_and_then();
            return;
        }
        self.bar.set_position(steps(progress.share));
        let title = &self.progress.titles[self.i];
        let left = left.map_or_else(String::new, |it| format!(", {} left", format::duration(it)));
        let percent = progress.share * 1e2;
        self.bar.set_message(format!("{title}: {}, {percent:.0} %{left}", progress.stage));
        self.progress.show_overall();
    }

    /// Says something above the lines.
    pub(super) fn say(&self, text: &dyn Display) {
        self.progress.say(text);
    }

    /// The case has ended.
    pub(super) fn end(self, end: &CaseEnd) {
        let place = self.progress.places[self.i];
        let title = &self.progress.titles[self.i];
        let took_s = match end {
            CaseEnd::Finished(kept) => Some(kept.record.wall_s.values().sum()),
            CaseEnd::Failed(_) | CaseEnd::Stopped => None,
        };
        self.progress.forecast(|it| it.ended(place, took_s));
        self.bar.finish_and_clear();
        match end {
            CaseEnd::Failed(fault) => self.say(&format!("{title} cannot go on: {fault}")),
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
    ProgressStyle::with_template(template).expect("the templates in this file are right")
}
