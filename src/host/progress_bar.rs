//! The progress display on the terminal: one line on standard error, and messages above it. Without
//! a terminal, only the messages are printed.

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

/// Ticks between two updates of the line.
const UPDATE_PERIOD: u64 = 25;
/// Steps of the progress bar while the grains settle.
const SETTLE_STEPS: u64 = 1000;

/// The progress line on standard error.
pub struct Progress {
    bar: ProgressBar,
    /// Also receive all messages.
    listeners: Mutex<Vec<Listener>>,
}

/// Receives messages.
type Listener = Box<dyn Fn(&str) + Send>;

impl Progress {
    /// Creates a progress line for a terminal; with `is_quiet` or a pipe there is none.
    pub fn new(is_quiet: bool) -> Self {
        let target =
            if is_quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(SETTLE_STEPS), target);
        Self { bar, listeners: Mutex::default() }
    }

    /// Shows the progress of filling the membrane: the `share` of the longest time it can take.
    pub fn settling(&self, stage: &str, share: f64) {
        if self.bar.is_hidden() {
            return;
        }
        self.bar.set_style(style("{bar:24} {elapsed} filling the membrane: {msg}"));
        self.bar.set_message(stage.to_owned());
        #[expect(clippy::cast_possible_truncation, reason = "at most SETTLE_STEPS")]
        #[expect(clippy::cast_sign_loss, reason = "clamped to be positive")]
        self.bar.set_position((share.clamp(0.0, 1.0) * SETTLE_STEPS as f64) as u64);
    }

    /// Starts the display of the run, which ends at `end_ns` if that is known.
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

    /// Shows the state after a tick.
    pub fn tick(&self, snapshot: &Snapshot, phase: &str, pacer: &Pacer) {
        if self.bar.is_hidden() || !snapshot.tick.0.is_multiple_of(UPDATE_PERIOD) {
            return;
        }
        let real_time_factor = pacer.real_time_factor();
        let time = Duration::from_nanos(snapshot.time_ns).as_secs_f64();
        let pressure = snapshot.chamber.gauge / 1e3;
        let force = snapshot.contact_force_world().z;
        self.bar.set_position(snapshot.time_ns);
        self.bar.set_message(format!(
            "{time:7.3} s  {real_time_factor:5.2} x real time  {phase:<9} {pressure:6.1} kPa  \
             {force:7.2} N"
        ));
    }

    /// Shows the simulation time `time_ns` and the real-time factor.
    pub fn share(&self, time_ns: u64, real_time_factor: f64) {
        if self.bar.is_hidden() {
            return;
        }
        let time = Duration::from_nanos(time_ns).as_secs_f64();
        self.bar.set_position(time_ns);
        self.bar.set_message(format!("{time:7.3} s  {real_time_factor:5.2} x real time"));
    }

    /// Prints a message above the line.
    pub fn say(&self, text: &dyn Display) {
        self.bar.suspend(|| {
            // If standard error is closed, the message is lost.
            drop(writeln!(io::stderr().lock(), "jamgrip: {text}"));
        });
        let listeners = self.listeners.lock().unwrap_or_else(PoisonError::into_inner);
        listeners.iter().for_each(|listener| listener(&text.to_string()));
    }

    /// Adds a listener that receives all messages.
    pub fn add_listener(&self, listener: Listener) {
        self.listeners.lock().unwrap_or_else(PoisonError::into_inner).push(listener);
    }

    /// Removes the line.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the templates in this file are valid")
}
