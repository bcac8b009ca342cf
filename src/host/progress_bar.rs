//! What a person at the terminal sees while it runs: one line on standard error, and lines above
//! it where something is to be said. Without a terminal only those.

use std::{
    fmt::Display,
    io::{self, Write},
    sync::{Mutex, PoisonError},
    time::Duration,
};

#[cfg(feature = "cli")]
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

#[cfg(not(feature = "cli"))]
use super::no_terminal::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use crate::{host::clock::Pacer, snapshot::Snapshot};

/// Ticks between two new messages; the terminal does not show more anyway.
const EVERY: u64 = 25;
/// Steps of the bar while the grains settle.
const SETTLE_STEPS: u64 = 1000;

/// The line on standard error.
pub struct Progress {
    bar: ProgressBar,
    /// Who is told the same.
    others: Mutex<Vec<Listener>>,
}

/// Tells a text to someone else.
type Listener = Box<dyn Fn(&str) + Send>;

impl Progress {
    /// A line for a terminal; `is_quiet` and pipes get none.
    pub fn new(is_quiet: bool) -> Self {
        let target =
            if is_quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(SETTLE_STEPS), target);
        Self { bar, others: Mutex::default() }
    }

    /// The filling of the bag: `share` of the longest time it can take.
    pub fn settling(&self, stage: &str, share: f64) {
        if self.bar.is_hidden() {
            return;
        }
        self.bar.set_style(style("{bar:24} {elapsed} filling the bag: {msg}"));
        self.bar.set_message(stage.to_owned());
        #[expect(clippy::cast_possible_truncation, reason = "at most SETTLE_STEPS")]
        #[expect(clippy::cast_sign_loss, reason = "clamped to be positive")]
        self.bar.set_position((share.clamp(0.0, 1.0) * SETTLE_STEPS as f64) as u64);
    }

    /// The run begins; it ends at `end_ns` if that is known.
    pub fn running(&self, end_ns: Option<u64>) {
        self.bar.reset_elapsed();
        match end_ns {
            Some(end_ns) => {
                self.bar.set_length(end_ns);
                self.bar.set_style(style("{bar:24} {msg}"));
            }
            None => {
                self.bar.unset_length();
                self.bar.set_style(style("{spinner} {msg}"));
            }
        }
    }

    /// A tick ended.
    pub fn tick(&self, seen: &Snapshot, phase: &str, pacer: &Pacer) {
        if self.bar.is_hidden() || !seen.tick.0.is_multiple_of(EVERY) {
            return;
        }
        let real_time_factor = pacer.real_time_factor();
        let time = Duration::from_nanos(seen.time_ns).as_secs_f64();
        let pressure = seen.chamber.gauge / 1e3;
        let force = seen.contact_force_world().z;
        self.bar.set_position(seen.time_ns);
        self.bar.set_message(format!(
            "{time:7.3} s  {real_time_factor:5.2} x real time  {phase:<9} {pressure:6.1} kPa  \
             {force:7.2} N"
        ));
    }

    /// Simulated time has come to `time_ns`, at this multiple of real time.
    pub fn share(&self, time_ns: u64, real_time_factor: f64) {
        if self.bar.is_hidden() {
            return;
        }
        let time = Duration::from_nanos(time_ns).as_secs_f64();
        self.bar.set_position(time_ns);
        self.bar.set_message(format!("{time:7.3} s  {real_time_factor:5.2} x real time"));
    }

    /// Says something above the line.
    pub fn say(&self, text: &dyn Display) {
        self.bar.suspend(|| {
            // If standard error is gone there is nobody to tell.
            drop(writeln!(io::stderr().lock(), "jamgrip: {text}"));
        });
        let others = self.others.lock().unwrap_or_else(PoisonError::into_inner);
        others.iter().for_each(|tell| tell(&text.to_string()));
    }

    /// From now on someone else is told what is said.
    pub fn add_listener(&self, tell: Listener) {
        self.others.lock().unwrap_or_else(PoisonError::into_inner).push(tell);
    }

    /// Removes the line.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the templates in this file are right")
}
