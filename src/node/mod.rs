//! The running thing: commands in, a tick, results out, and so on until there is a reason to end.

pub mod cache; // settled start states on disk
mod doors; // recording, streams, ROS 2
pub mod judge; // what came of a run
pub mod launch; // scene to a run
pub mod orders; // who may command
pub mod outlets; // where results go
pub mod pacer; // the only clock
pub mod plant; // what runs
pub mod progress; // one line for the terminal
pub mod schedule; // what is due when
pub mod sealed; // files that are whole or not there
pub mod shutdown; // Ctrl-C
pub mod start; // a settled bag, from the cache or from scratch
pub mod summary; // what is left at the end

use std::{fmt, mem, sync::Arc, time::Duration};

use self::{
    judge::Judge,
    orders::Orders,
    outlets::Outlets,
    pacer::Pacer,
    plant::Plant,
    progress::Progress,
    schedule::{Parts, Schedule},
    shutdown::Shutdown,
};
use crate::{
    sinks::{Packet, RunStatistics},
    snapshot::{Snapshot, checkpoint::Checkpoint},
};

/// While the run waits for a first command, its start is shown this many times a second.
const WAITING_RATE: u32 = 10;

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The built-in controller has finished.
    Finished,
    /// The time asked for is over.
    TimeUp,
    /// Someone asked it to end.
    Interrupted,
    /// The recording failed, and the scene says to stop then.
    RecordingFailed,
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Finished => "finished",
            Self::TimeUp => "time is up",
            Self::Interrupted => "interrupted",
            Self::RecordingFailed => "recording failed",
        })
    }
}

/// Everything around the plant.
pub struct Crew {
    /// Who commands.
    pub orders: Orders,
    /// Where results go.
    pub outlets: Outlets,
    /// What is due when.
    pub schedule: Schedule,
    /// What came of it.
    pub judge: Judge,
    /// What a person sees.
    pub progress: Progress,
    /// Whether someone asked to end.
    pub shutdown: Shutdown,
    /// Length of a tick [ns].
    pub tick_ns: u64,
    /// Simulated time at which the run ends [ns].
    pub end_ns: Option<u64>,
    /// True keeps to real time.
    pub is_real_time: bool,
    /// What statistics say of the scene.
    pub about: RunStatistics,
}

/// How a run went, as far as clocks and plant know.
pub struct Report<Fault> {
    /// Why it ended.
    pub ending: Result<Ending, Fault>,
    /// The system at the end of the last whole tick.
    pub last: Arc<Packet>,
    /// Wall time of all ticks [s].
    pub wall_time_s: f64,
    /// Simulated over wall time.
    pub real_time_factor: f64,
}

/// Runs `plant` until there is a reason to end. What was recorded is still open afterwards.
pub fn run<P: Plant>(plant: &mut P, crew: &mut Crew) -> Report<P::Fault> {
    let mut seen = Arc::new(Packet::new(plant.snapshot(Parts::ALL), None));
    crew.wait_for_orders(plant, &seen);
    // The start is kept whatever the rate, at whatever time it is.
    let mut checkpoints: Vec<_> = crew.checkpoint(plant, true).into_iter().collect();
    let mut pacer = Pacer::start_at(seen.snapshot.time_ns, crew.is_real_time);
    let ending = loop {
        if let Some(ending) = crew.ending(&seen.snapshot) {
            break Ok(ending);
        }
        let commands = crew.orders.drain(&seen.snapshot); // outside to plain values
        if let Err(fault) = plant.tick(&commands) {
            break Err(fault); // the core cannot go on, nobody can
        }
        let time_ns = seen.snapshot.time_ns + crew.tick_ns;
        let snapshot = plant.snapshot(crew.schedule.parts(time_ns)); // a copy
        pacer.wait_until(time_ns); // the only clock
        let is_due = crew.schedule.checkpoint(time_ns);
        checkpoints.extend(crew.checkpoint(plant, is_due));
        let packet = crew.pack(snapshot, &pacer);
        seen = Arc::new(packet.with_checkpoints(mem::take(&mut checkpoints)));
        crew.outlets.publish(&plant.view(&seen.snapshot), &seen); // never fails the run
    };
    crew.progress.end();
    let (wall_time_s, real_time_factor) = (pacer.wall_time_s(), pacer.real_time_factor_mean());
    Report { ending, last: seen, wall_time_s, real_time_factor }
}

impl Crew {
    /// Shows the start to the outside until it commands something.
    fn wait_for_orders<P: Plant>(&mut self, plant: &P, start: &Arc<Packet>) {
        if self.orders.is_waiting() {
            self.progress.say(&"waiting for a first command");
        }
        let mut shown_at = None;
        let waiting = Pacer::start(false);
        while self.orders.is_waiting() && !self.shutdown.is_requested() {
            let now = waiting.wall_time_s();
            if shown_at.is_none_or(|then| 1.0 <= (now - then) * f64::from(WAITING_RATE)) {
                self.outlets.publish(&plant.view(&start.snapshot), start);
                shown_at = Some(now);
            }
            pacer::pause();
        }
    }

    /// All that is needed to go on, if it is due and someone keeps it.
    fn checkpoint<P: Plant>(&self, plant: &P, is_due: bool) -> Option<Checkpoint> {
        if is_due && self.outlets.bag.is_some() { plant.checkpoint() } else { None }
    }

    fn ending(&mut self, seen: &Snapshot) -> Option<Ending> {
        if self.shutdown.is_requested() {
            return Some(Ending::Interrupted);
        }
        if self.orders.is_done() {
            return Some(Ending::Finished);
        }
        if self.end_ns.is_some_and(|end_ns| end_ns <= seen.time_ns) {
            return Some(Ending::TimeUp);
        }
        let (faults, must_stop) = self.outlets.take_faults();
        faults.iter().for_each(|fault| self.progress.say(fault));
        must_stop.then_some(Ending::RecordingFailed)
    }

    /// Judges a snapshot, shows it, and adds statistics where they are due.
    fn pack(&mut self, snapshot: Snapshot, pacer: &Pacer) -> Packet {
        self.judge.look(&snapshot, Duration::from_nanos(self.tick_ns).as_secs_f64());
        let phase = self.orders.phase().map_or("", |phase| phase.name());
        self.progress.tick(&snapshot, phase, pacer);
        let is_due = self.schedule.statistics(snapshot.time_ns);
        let run = is_due.then(|| RunStatistics {
            wall_time_s: pacer.wall_time_s(),
            real_time_factor: pacer.real_time_factor(),
            real_time_factor_mean: pacer.real_time_factor_mean(),
            phase: phase.to_owned(),
            sinks: self.outlets.counters(),
            ..self.about.clone()
        });
        Packet::new(snapshot, run)
    }
}

#[cfg(test)]
mod tests;
