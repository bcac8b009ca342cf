//! The only file that reads a clock: the speed of the run, and waiting in real time.

#![expect(clippy::disallowed_methods, reason = "only this file may read clocks")]

use std::{
    collections::VecDeque,
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

/// Wall-clock time over which the current real-time factor is averaged.
const WINDOW: Duration = Duration::from_secs(1);

/// Measures wall-clock time against the time of the run, which continues when simulation time is
/// reset.
pub struct Pacer {
    start: Instant,
    /// Time of the run at the start (ns).
    origin_ns: u64,
    /// The last time the run advanced.
    last: Instant,
    /// Wall-clock time since the run last advanced.
    paused: Duration,
    /// The last time that `is_due` returned true.
    last_due: Option<Instant>,
    is_real_time: bool,
    time_ns: u64,
    /// Wall-clock times and times of the run during the last second.
    marks: VecDeque<(Instant, u64)>,
}

impl Pacer {
    /// Starts a pacer. In real time, the run waits when it is ahead.
    pub fn start(is_real_time: bool) -> Self {
        Self::start_at(0, is_real_time)
    }

    /// Starts a pacer for a run that begins at the time `origin_ns`.
    pub fn start_at(origin_ns: u64, is_real_time: bool) -> Self {
        let start = Instant::now();
        let marks = VecDeque::from([(start, origin_ns)]);
        Self {
            start,
            origin_ns,
            last: start,
            paused: Duration::ZERO,
            last_due: None,
            is_real_time,
            time_ns: origin_ns,
            marks,
        }
    }

    /// Excludes the wall-clock time since the run last advanced, because the run is paused.
    pub fn wait_paused(&mut self) {
        let now = Instant::now();
        let paused = now - self.last;
        self.start += paused;
        self.marks.iter_mut().for_each(|(mark, _)| *mark += paused);
        self.last = now;
        self.paused += paused;
    }

    /// Wall-clock time since the run last advanced (s).
    pub fn paused_s(&self) -> f64 {
        self.paused.as_secs_f64()
    }

    /// Returns true `rate` times per second of wall-clock time.
    pub fn is_due(&mut self, rate: u32) -> bool {
        let now = Instant::now();
        let is_due = self.last_due.is_none_or(|then| Duration::from_secs(1) / rate <= now - then);
        self.last_due = if is_due { Some(now) } else { self.last_due };
        is_due
    }

    /// Records that the run has reached `time_ns`, and waits for that time in real time.
    pub fn wait_until(&mut self, time_ns: u64) {
        self.time_ns = time_ns;
        if self.is_real_time {
            let due = self.start + Duration::from_nanos(time_ns - self.origin_ns);
            thread::sleep(due.saturating_duration_since(Instant::now()));
        }
        self.last = Instant::now();
        self.paused = Duration::ZERO;
        self.mark(self.last);
    }

    fn mark(&mut self, now: Instant) {
        let is_due = |last: &(Instant, u64)| WINDOW / 20 <= now - last.0;
        if self.marks.back().is_none_or(is_due) {
            self.marks.push_back((now, self.time_ns));
        }
        while 2 < self.marks.len() && WINDOW < now - self.marks[0].0 {
            self.marks.pop_front();
        }
    }

    /// Wall-clock time since the start, without pauses (s).
    pub fn wall_time_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Simulation time over wall-clock time since the start.
    pub fn real_time_factor_mean(&self) -> f64 {
        ratio(self.time_ns - self.origin_ns, self.start.elapsed())
    }

    /// Simulation time over wall-clock time, during the last second.
    pub fn real_time_factor(&self) -> f64 {
        let (wall, time_ns) = self.marks[0];
        ratio(self.time_ns - time_ns, wall.elapsed())
    }
}

/// The position of a player: recorded time that advances with wall-clock time.
pub struct Playhead {
    anchor: Instant,
    time_ns: u64,
    rate: f64,
    is_paused: bool,
}

impl Playhead {
    /// Starts at `time_ns`, at `rate` times the recorded speed.
    pub fn start(time_ns: u64, rate: f64) -> Self {
        Self { anchor: Instant::now(), time_ns, rate, is_paused: false }
    }

    /// The current position in recorded time (ns).
    pub fn now_ns(&self) -> u64 {
        if self.is_paused {
            return self.time_ns;
        }
        let passed = self.anchor.elapsed().mul_f64(self.rate).as_nanos();
        self.time_ns.saturating_add(u64::try_from(passed).unwrap_or(u64::MAX))
    }

    /// Continues from `time_ns`.
    pub fn jump(&mut self, time_ns: u64) {
        (self.anchor, self.time_ns) = (Instant::now(), time_ns);
    }

    /// Sets the speed relative to the recording.
    pub fn set_rate(&mut self, rate: f64) {
        self.jump(self.now_ns());
        self.rate = rate;
    }

    /// Pauses or resumes.
    pub fn set_paused(&mut self, is_paused: bool) {
        self.jump(self.now_ns());
        self.is_paused = is_paused;
    }

    /// Speed relative to the recording.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// True while paused.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Waits for `time_ns`, but at most for a time too short to notice. Returns true if it was
    /// reached.
    pub fn wait_for(&self, time_ns: u64) -> bool {
        const SLEEP_MAX: Duration = Duration::from_millis(20);
        let left = Duration::from_nanos(time_ns.saturating_sub(self.now_ns()));
        if left.is_zero() && !self.is_paused {
            return true;
        }
        let left = if self.is_paused { SLEEP_MAX } else { left.div_f64(self.rate) };
        thread::sleep(left.min(SLEEP_MAX));
        !self.is_paused && time_ns <= self.now_ns()
    }
}

/// Measures wall-clock time in laps.
pub struct Stopwatch {
    start: Instant,
    lap: Instant,
}

impl Stopwatch {
    /// Starts a stopwatch.
    pub fn start() -> Self {
        let start = Instant::now();
        Self { start, lap: start }
    }

    /// Wall-clock time since the start (s).
    pub fn total_s(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Wall-clock time since the last lap (s). Starts a new lap.
    pub fn lap_s(&mut self) -> f64 {
        let now = Instant::now();
        let lap = now - self.lap;
        self.lap = now;
        lap.as_secs_f64()
    }
}

fn ratio(time_ns: u64, wall: Duration) -> f64 {
    let wall = wall.as_secs_f64();
    if wall == 0.0 { 0.0 } else { Duration::from_nanos(time_ns).as_secs_f64() / wall }
}

/// Wall-clock time since 1970 (ns), the same for all processes of this host.
pub fn wall_ns() -> u64 {
    let since_epoch = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since_epoch.as_nanos()).unwrap_or(u64::MAX)
}

/// Time between two checks while the run waits for input.
pub const IDLE_SLEEP: Duration = Duration::from_millis(5);

/// Time between two checks while a tick waits for a command.
pub const POLL_PERIOD: Duration = Duration::from_micros(50);

/// Sleeps briefly while the run waits for input.
pub fn pause() {
    thread::sleep(IDLE_SLEEP);
}

/// The current UTC time for folder names: `2026-11-22_15-43-50`.
pub fn utc_stamp() -> String {
    let since_epoch = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    stamp_text(since_epoch.as_secs())
}

/// The date and time of a number of seconds since 1970.
fn stamp_text(seconds: u64) -> String {
    let (hour, minute, second) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    let mut day = seconds / 86_400;
    let mut year = 1970;
    while days_in_year(year) <= day {
        day -= days_in_year(year);
        year += 1;
    }
    let february = days_in_year(year) - 337;
    let months = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 0;
    while months[month] <= day {
        day -= months[month];
        month += 1;
    }
    format!("{year}-{:02}-{:02}_{hour:02}-{minute:02}-{second:02}", month + 1, day + 1)
}

fn days_in_year(year: u64) -> u64 {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    365 + u64::from(is_leap)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: `date -u -d @SECONDS`.
    #[test]
    fn stamps() {
        assert_eq!(stamp_text(0), "1970-01-01_00-00-00");
        assert_eq!(stamp_text(1_709_210_096), "2024-02-29_12-34-56");
        assert_eq!(stamp_text(1_798_761_599), "2026-12-31_23-59-59");
    }

    /// Oracle: in real time, 50 ms of simulation time take at least 50 ms of wall-clock time.
    #[test]
    fn real_time_waits() {
        let mut pacer = Pacer::start(true);
        pacer.wait_until(50_000_000);
        assert!(0.05 <= pacer.wall_time_s());
        assert!(pacer.real_time_factor_mean() <= 1.0);
        assert!(pacer.real_time_factor() <= 1.0);
    }
}
