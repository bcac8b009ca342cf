//! The running thing: commands in, a tick, results out, and so on until there is a reason to end.

pub mod command_sources; // controllers, topics, recordings
mod connect; // opens recording, streams and ROS 2
pub mod launch; // from a scene to a run
pub mod lift_monitor; // metrics of the lift
pub mod loader; // loads scenes while the run goes on
pub mod lockstep; // ticks that wait for a controller
pub mod outputs; // encoder and sinks
pub mod plant; // the system that runs
pub mod schedule; // what is due when
pub mod server; // serves requests between ticks
pub mod start; // the filled bag, from the cache or computed
pub mod summary; // the summary of a run

use std::{fmt, mem, sync::Arc, time::Duration};

use self::{
    command_sources::CommandSources,
    lift_monitor::LiftMonitor,
    lockstep::{Gate, Missed},
    outputs::OutputSinks,
    plant::Plant,
    schedule::{Parts, Schedule},
    server::SimulationServer,
};
use crate::host::{clock::Pacer, progress_bar::Progress, shutdown::Shutdown};
use crate::{
    command::change::Change,
    io::sink::{Packet, RunStatistics},
    simulator::World,
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
    /// A client of the simulator told it to quit.
    Quit,
    /// In lockstep no command came in time, and the scene says to end then.
    NoCommand,
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Finished => "finished",
            Self::TimeUp => "time is up",
            Self::Interrupted => "interrupted",
            Self::RecordingFailed => "recording failed",
            Self::Quit => "told to quit",
            Self::NoCommand => "no command in time",
        })
    }
}

/// Everything around the plant.
pub struct RunContext {
    /// Who commands.
    pub command_sources: CommandSources,
    /// Whether ticks wait for commands.
    pub gate: Gate,
    /// Who may ask and change, if anybody.
    pub front: Option<SimulationServer>,
    /// Where results go.
    pub outputs: OutputSinks,
    /// What is due when.
    pub schedule: Schedule,
    /// What came of it.
    pub lift_monitor: LiftMonitor,
    /// What a person sees.
    pub progress: Progress,
    /// Whether someone asked to end.
    pub shutdown: Shutdown,
    /// Length of a tick (ns).
    pub tick_ns: u64,
    /// Time of the run at which it ends (ns).
    pub end_ns: Option<u64>,
    /// True keeps to real time.
    pub is_real_time: bool,
    /// What statistics say of the scene.
    pub about: RunStatistics,
    /// Packets given out so far.
    pub n_packets: u64,
    /// What the next packet keeps besides.
    pub checkpoints: Vec<Checkpoint>,
    /// True once a command was missed that the run cannot go on without.
    pub has_missed: bool,
}

/// How a run went, as far as clocks and plant know.
pub struct Report<Fault> {
    /// Why it ended.
    pub ending: Result<Ending, Fault>,
    /// The system at the end of the last whole tick.
    pub last: Arc<Packet>,
    /// Wall time of all ticks (s).
    pub wall_time_s: f64,
    /// Simulated over wall time.
    pub real_time_factor: f64,
}

/// What comes next.
enum NextStep {
    /// A tick.
    Tick,
    /// Nothing yet; perhaps the run waits for its first command.
    Wait { is_waiting: bool },
}

/// Runs `plant` until there is a reason to end. What was recorded is still open afterwards.
pub fn run<P: Plant>(plant: &mut P, context: &mut RunContext) -> Report<P::Fault> {
    let mut seen = Arc::new(Packet::new(plant.snapshot(Parts::ALL), None));
    let mut pacer = Pacer::start_at(context.run_time_ns(&seen.snapshot), context.is_real_time);
    // The start is kept whatever the rate, at whatever time it is.
    context.save_checkpoint(plant, true);
    context.announce_waiting();
    let ending = loop {
        if let Some(ending) = context.ending(&seen.snapshot) {
            break Ok(ending);
        }
        seen = context.handle_requests(plant, seen); // questions between two ticks
        // Outside to plain values.
        if let NextStep::Wait { is_waiting } = context.next_step(&seen.snapshot) {
            context.wait_paused(plant, &seen, &mut pacer, is_waiting);
            continue;
        }
        if let Err(fault) = plant.tick(&context.gate.pass()) {
            break Err(fault); // the core cannot go on, nobody can
        }
        let time_ns = seen.snapshot.time_ns + context.tick_ns;
        let snapshot = plant.snapshot(context.schedule.parts(time_ns)); // a copy
        let run_time_ns = context.run_time_ns(&snapshot);
        context.pace(&mut pacer, run_time_ns); // the only clock
        context.save_checkpoint(plant, context.schedule.checkpoint(run_time_ns));
        seen = Arc::new(context.pack(snapshot, &pacer));
        context.outputs.publish(&plant.view(&seen.snapshot), &seen); // never fails the run
        context.ticked(&seen);
    };
    context.progress.end();
    let (wall_time_s, real_time_factor) = (pacer.wall_time_s(), pacer.real_time_factor_mean());
    Report { ending, last: seen, wall_time_s, real_time_factor }
}

impl RunContext {
    fn announce_waiting(&self) {
        if self.is_waiting() {
            self.progress.say(&"waiting for a first command");
        }
    }

    /// True until something sets a run going that shall begin by command.
    fn is_waiting(&self) -> bool {
        self.front
            .as_ref()
            .map_or(self.command_sources.is_waiting(), |it| it.simulator().is_waiting())
    }

    /// Takes the commands that have come, and says what is next. While time stands still they wait
    /// where they came in, where the oldest give way; a lockstep needs to see them.
    fn next_step(&mut self, seen: &Snapshot) -> NextStep {
        // Asked once: a first command that comes right after is for the next look.
        let is_waiting = self.is_waiting();
        let (is_playing, is_stepping) = match &self.front {
            None => (!is_waiting, false),
            Some(front) => (front.simulator().may_tick(), front.simulator().is_stepping()),
        };
        if is_playing {
            let mut commands = self.command_sources.drain(seen);
            commands.extend(self.front.iter_mut().flat_map(SimulationServer::take_commands));
            self.gate.offer(commands, seen.time_ns);
        }
        let may_tick = is_playing && self.gate.is_open(is_stepping, seen.time_ns);
        if may_tick { NextStep::Tick } else { NextStep::Wait { is_waiting } }
    }

    /// Answers questions, and shows what they have changed.
    fn handle_requests<P: Plant>(&mut self, plant: &mut P, seen: Arc<Packet>) -> Arc<Packet> {
        let Some(front) = &mut self.front else { return seen };
        if !self.command_sources.is_waiting() || front.has_commands() {
            front.first_command();
        }
        let changed = {
            let mut world = World { access: plant, snapshot: &seen.snapshot };
            front.handle_requests(&mut world, self.n_packets)
        };
        if let Some(outputs) = &changed.outputs {
            self.schedule = Schedule::new(outputs, self.tick_ns);
            let encoder = self.outputs.encoder.as_deref().map(|it| it.with_outputs(outputs));
            self.outputs.encoder = encoder.map(Arc::new);
        }
        if changed.changes.is_empty() {
            return seen;
        }
        if changed.is_state_reset || changed.is_time_reset {
            self.command_sources.restart();
            self.lift_monitor = LiftMonitor::default();
        }
        if changed.is_scene_loaded {
            self.scene_loaded(plant, &seen.snapshot);
        }
        self.add_spawned_topics(&changed.changes);
        let packet = Packet::new(plant.snapshot(Parts::ALL), None).with_changes(changed.changes);
        let packet = Arc::new(self.number(packet));
        self.outputs.publish(&plant.view(&packet.snapshot), &packet);
        packet
    }

    /// Objects that have come get topics of their own.
    fn add_spawned_topics(&mut self, changes: &[Change]) {
        let of_change = |it: &Change| -> Vec<String> {
            match it {
                Change::Insert(object) => vec![object.name.clone()],
                Change::LoadScene(it) => {
                    it.scene.objects.iter().map(|it| it.name.clone()).collect()
                }
                _ => Vec::new(),
            }
        };
        let spawned: Vec<String> = changes.iter().flat_map(of_change).collect();
        if let Some(before) = self.outputs.encoder.as_deref().filter(|_| !spawned.is_empty()) {
            let encoder = before.with_spawned(spawned.iter().map(String::as_str));
            self.outputs.encoder = Some(Arc::new(encoder));
        }
    }

    /// Another scene has taken the place of the one before.
    fn scene_loaded<P: Plant>(&mut self, plant: &P, seen: &Snapshot) {
        let before = self.outputs.encoder.as_deref();
        let Some(encoder) = before.and_then(|it| plant.encoder(it)) else { return };
        self.gate.forget();
        self.command_sources.scene_loaded(encoder.scene(), seen);
        self.about.seed = encoder.scene().seed;
        self.about.substep_s = plant.substep_s();
        self.progress.say(&format!("scene `{}` is loaded", encoder.scene().name));
        self.outputs.encoder = Some(Arc::new(encoder));
    }

    /// Time stands still: waits a moment for someone to change that. Who waits for a first command
    /// is shown the start.
    fn wait_paused<P: Plant>(
        &mut self,
        plant: &P,
        seen: &Arc<Packet>,
        pacer: &mut Pacer,
        is_waiting: bool,
    ) {
        if is_waiting && pacer.is_due(WAITING_RATE) {
            self.outputs.publish(&plant.view(&seen.snapshot), seen);
        }
        let patience = if self.gate.is_lockstep() {
            crate::host::clock::POLL_PERIOD
        } else {
            crate::host::clock::IDLE_SLEEP
        };
        match &mut self.front {
            Some(front) => front.wait(patience),
            None => crate::host::clock::pause(),
        }
        pacer.wait_paused();
        let is_playing = self.front.as_ref().is_none_or(|it| it.simulator().may_tick());
        let missed = if is_playing { self.gate.miss(pacer.paused_s()) } else { None };
        if let Some(missed) = missed {
            self.progress.say(&format!("no command for {:.3} s of wall time", pacer.paused_s()));
            match (missed, &mut self.front) {
                (Missed::Ended, _) => self.has_missed = true,
                (Missed::Paused, Some(front)) => front.pause(),
                _ => {}
            }
        }
    }

    /// Steps that someone waits for are not paced.
    fn pace(&self, pacer: &mut Pacer, run_time_ns: u64) {
        if self.front.as_ref().is_some_and(|it| it.simulator().is_stepping()) {
            pacer.wait_paused();
        }
        pacer.wait_until(run_time_ns);
    }

    fn ticked(&mut self, seen: &Packet) {
        if let Some(front) = &mut self.front {
            front.ticked(&seen.snapshot, self.n_packets);
        }
    }

    fn number(&mut self, packet: Packet) -> Packet {
        self.n_packets += 1;
        let packet = packet.with_encoder(self.outputs.encoder.clone());
        packet.numbered(self.n_packets).with_checkpoints(mem::take(&mut self.checkpoints))
    }

    /// Takes all that is needed to go on, if it is due and someone keeps it, for the next packet.
    fn save_checkpoint<P: Plant>(&mut self, plant: &P, is_due: bool) {
        if is_due && self.outputs.bag.is_some() {
            self.checkpoints.extend(plant.checkpoint());
        }
    }

    /// Time of the run: that of its ticks together, whatever became of simulated time.
    fn run_time_ns(&self, seen: &Snapshot) -> u64 {
        seen.run_tick.time_ns(self.tick_ns)
    }

    fn ending(&mut self, seen: &Snapshot) -> Option<Ending> {
        if self.shutdown.is_requested() {
            return Some(Ending::Interrupted);
        }
        if self.front.as_ref().is_some_and(|it| it.simulator().is_quitting()) {
            return Some(Ending::Quit);
        }
        if self.has_missed {
            return Some(Ending::NoCommand);
        }
        if self.command_sources.is_done() {
            return Some(Ending::Finished);
        }
        if self.end_ns.is_some_and(|end_ns| end_ns <= self.run_time_ns(seen)) {
            return Some(Ending::TimeUp);
        }
        let (faults, must_stop) = self.outputs.take_faults();
        faults.iter().for_each(|fault| self.progress.say(fault));
        must_stop.then_some(Ending::RecordingFailed)
    }

    /// Judges a snapshot, shows it, and adds statistics where they are due.
    fn pack(&mut self, snapshot: Snapshot, pacer: &Pacer) -> Packet {
        self.lift_monitor.look(&snapshot, Duration::from_nanos(self.tick_ns).as_secs_f64());
        let phase = self.command_sources.phase().map_or("", |phase| phase.name());
        self.progress.tick(&snapshot, phase, pacer);
        let is_due = self.schedule.statistics(snapshot.time_ns);
        let run = is_due.then(|| RunStatistics {
            wall_time_s: pacer.wall_time_s(),
            real_time_factor: pacer.real_time_factor(),
            real_time_factor_mean: pacer.real_time_factor_mean(),
            phase: phase.to_owned(),
            sinks: self.outputs.counters(),
            ..self.about.clone()
        });
        self.number(Packet::new(snapshot, run))
    }
}

#[cfg(test)]
mod tests;
