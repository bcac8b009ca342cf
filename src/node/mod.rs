//! The run loop: commands in, a tick, results out, until there is a reason to end.

pub mod command_sources; // controllers, topics, recordings
mod connect; // opens recording, streams and ROS 2
pub mod launch; // from a scene to a run
pub mod lift_monitor; // metrics of the lift
pub mod loader; // loads scenes during a run
pub mod lockstep; // ticks that wait for a controller
pub mod outputs; // encoder and sinks
pub mod plant; // the system that runs
pub mod schedule; // what is due at which tick
pub mod server; // serves requests between ticks
pub mod start; // the filled membrane, from the cache or computed
pub mod summary; // the summary of a run

use std::{fmt, mem, sync::Arc, time::Duration};

use self::{
    command_sources::CommandSources,
    lift_monitor::LiftMonitor,
    lockstep::{Gate, Missed},
    outputs::{Closed, OutputSinks},
    plant::Plant,
    schedule::{Parts, Schedule},
    server::SimulationServer,
};
use crate::{
    command::change::Change,
    host::{
        clock::{self, Pacer},
        progress_bar::Progress,
        shutdown::Shutdown,
    },
    io::sink::{Packet, RunStatistics},
    scene::Scene,
    simulator::World,
    snapshot::{Snapshot, checkpoint::Checkpoint},
};

/// Rate at which the start is published while the run waits for its first command (Hz).
const WAITING_RATE: u32 = 10;

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The built-in controller has finished.
    Finished,
    /// The requested time is over.
    TimeUp,
    /// The user interrupted it.
    Interrupted,
    /// The recording failed, and the scene says to stop then.
    RecordingFailed,
    /// A client requested it.
    Quit,
    /// In lockstep no command arrived in time, and the scene says to end then.
    NoCommand,
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Finished => "finished",
            Self::TimeUp => "time is up",
            Self::Interrupted => "interrupted",
            Self::RecordingFailed => "recording failed",
            Self::Quit => "quit by request",
            Self::NoCommand => "no command in time",
        })
    }
}

/// What controls a run.
pub struct Inputs {
    /// Sources of commands.
    pub command_sources: CommandSources,
    /// Decides when the next tick may begin.
    pub gate: Gate,
    /// Serves requests, if the run has a service server.
    pub server: Option<SimulationServer>,
}

#[cfg(feature = "bag")]
impl Inputs {
    /// The commands of a script and nothing else.
    pub fn of_script(script: crate::bag::source::Script) -> Self {
        Self {
            command_sources: CommandSources::from_external(vec![Box::new(script)]),
            gate: Gate::new(crate::scene::Lockstep::OFF),
            server: None,
        }
    }
}

/// When and how a run ends, and what the user sees meanwhile.
pub struct Supervision {
    /// Shows progress and messages.
    pub progress: Progress,
    /// Ends the run when requested.
    pub shutdown: Shutdown,
    /// Simulated time since the start of the run at which it ends (ns).
    pub end_ns: Option<u64>,
}

/// Everything around the plant.
///
/// The context owns the scene. Encoder, schedule and controller are derived from it, and
/// `replace_scene` is the only function that changes it.
pub struct RunContext {
    scene: Arc<Scene>,
    inputs: Inputs,
    outputs: OutputSinks,
    supervision: Supervision,
    schedule: Schedule,
    lift_monitor: LiftMonitor,
    /// Length of a substep (s).
    substep_s: f64,
    /// Packets published so far.
    n_packets: u64,
    /// Checkpoints for the next packet.
    checkpoints: Vec<Checkpoint>,
    /// True once a command was missed and the scene says to end then.
    has_missed: bool,
}

/// Result of a run.
pub struct Report<E> {
    /// Why it ended.
    pub ending: Result<Ending, E>,
    /// Results of the last complete tick.
    pub last: Arc<Packet>,
    /// Wall time of all ticks (s).
    pub wall_time_s: f64,
    /// Simulated over wall time.
    pub real_time_factor: f64,
}

/// What the run loop does next.
enum NextStep {
    /// Run a tick.
    Tick,
    /// Wait; `is_waiting` says whether for a first command.
    Wait { is_waiting: bool },
}

/// Runs `plant` until there is a reason to end. The outputs are still open afterward.
pub fn run<P: Plant>(plant: &mut P, context: &mut RunContext) -> Report<P::Error> {
    let mut packet = Arc::new(Packet::new(plant.snapshot(Parts::ALL), None));
    let mut pacer =
        Pacer::start_at(context.run_time_ns(&packet.snapshot), context.scene.outputs.real_time);
    context.substep_s = plant.substep_s();
    // The start is recorded whatever the checkpoint rate.
    context.save_checkpoint(plant, true);
    context.announce_waiting();
    let ending = loop {
        if let Some(ending) = context.ending(&packet.snapshot) {
            break Ok(ending);
        }
        packet = context.handle_requests(plant, packet); // between two ticks
        if let NextStep::Wait { is_waiting } = context.next_step(&packet.snapshot) {
            context.wait_paused(plant, &packet, &mut pacer, is_waiting);
            continue;
        }
        if let Err(error) = plant.tick(&context.inputs.gate.pass()) {
            break Err(error);
        }
        let time_ns = packet.snapshot.time_ns + context.tick_ns();
        let snapshot = plant.snapshot(context.schedule.parts(time_ns));
        let run_time_ns = context.run_time_ns(&snapshot);
        context.pace(&mut pacer, run_time_ns); // the only clock
        context.save_checkpoint(plant, context.schedule.checkpoint(run_time_ns));
        packet = Arc::new(context.pack(snapshot, &pacer));
        context.outputs.publish(&plant.view(&packet.snapshot), &packet); // errors are collected
        context.ticked(&packet);
    };
    context.supervision.progress.end();
    let (wall_time_s, real_time_factor) = (pacer.wall_time_s(), pacer.real_time_factor_mean());
    Report { ending, last: packet, wall_time_s, real_time_factor }
}

impl RunContext {
    /// The context of a run of `scene`.
    pub fn new(
        scene: Arc<Scene>,
        inputs: Inputs,
        outputs: OutputSinks,
        supervision: Supervision,
    ) -> Self {
        Self {
            schedule: Schedule::new(&scene.outputs, scene.time.tick_ns),
            scene,
            inputs,
            outputs,
            supervision,
            lift_monitor: LiftMonitor::default(),
            substep_s: 0.0,
            n_packets: 0,
            checkpoints: Vec::new(),
            has_missed: false,
        }
    }

    /// Closes the outputs and shows their errors. Sources of commands are closed before.
    pub fn close(self) -> Closed {
        drop(self.inputs.command_sources);
        let closed = self.outputs.close();
        closed.errors.iter().for_each(|error| self.supervision.progress.say(error));
        closed
    }

    /// Ends the run when requested.
    pub fn shutdown(&self) -> &Shutdown {
        &self.supervision.shutdown
    }

    fn tick_ns(&self) -> u64 {
        self.scene.time.tick_ns
    }

    fn announce_waiting(&self) {
        if self.is_waiting() {
            self.supervision.progress.say(&"waiting for a first command");
        }
    }

    /// True while the run waits for its first command.
    fn is_waiting(&self) -> bool {
        let Inputs { command_sources, server, .. } = &self.inputs;
        server.as_ref().map_or(command_sources.is_waiting(), |it| it.simulator().is_waiting())
    }

    /// Takes the commands that have arrived and decides what to do next. While paused, commands
    /// stay in their queues, where the oldest are dropped; a lockstep needs to see them.
    fn next_step(&mut self, snapshot: &Snapshot) -> NextStep {
        // Read once: a first command that arrives after this is for the next call.
        let is_waiting = self.is_waiting();
        let Inputs { command_sources, gate, server } = &mut self.inputs;
        let (is_playing, is_stepping) = match server {
            None => (!is_waiting, false),
            Some(server) => (server.simulator().may_tick(), server.simulator().is_stepping()),
        };
        if is_playing {
            let mut commands = command_sources.drain(snapshot);
            commands.extend(server.iter_mut().flat_map(SimulationServer::take_commands));
            gate.offer(commands, snapshot.time_ns);
        }
        let may_tick = is_playing && gate.is_open(is_stepping, snapshot.time_ns);
        if may_tick { NextStep::Tick } else { NextStep::Wait { is_waiting } }
    }

    /// Serves requests and publishes what they changed.
    fn handle_requests<P: Plant>(&mut self, plant: &mut P, packet: Arc<Packet>) -> Arc<Packet> {
        let Some(server) = &mut self.inputs.server else { return packet };
        if !self.inputs.command_sources.is_waiting() || server.has_commands() {
            server.first_command();
        }
        let changed = {
            let mut world = World { access: plant, snapshot: &packet.snapshot };
            server.handle_requests(&mut world, self.n_packets)
        };
        let scene = Arc::clone(server.simulator().scene());
        if !Arc::ptr_eq(&scene, &self.scene) {
            self.replace_scene(scene, plant, changed.is_scene_loaded);
        }
        if changed.changes.is_empty() {
            return packet;
        }
        if changed.is_scene_loaded {
            self.inputs.gate.forget();
            self.inputs.command_sources.discard(&packet.snapshot);
            self.supervision.progress.say(&format!("scene `{}` is loaded", self.scene.name));
        }
        if changed.is_state_reset || changed.is_time_reset {
            self.inputs.command_sources.restart(&self.scene);
            self.lift_monitor = LiftMonitor::default();
        }
        self.add_spawned_topics(&changed.changes);
        let packet = Packet::new(plant.snapshot(Parts::ALL), None).with_changes(changed.changes);
        let packet = Arc::new(self.number(packet));
        self.outputs.publish(&plant.view(&packet.snapshot), &packet);
        packet
    }

    /// Replaces the scene and all that is derived from it: schedule, encoder and statistics.
    fn replace_scene<P: Plant>(&mut self, scene: Arc<Scene>, plant: &P, is_loaded: bool) {
        self.schedule = Schedule::new(&scene.outputs, scene.time.tick_ns);
        self.substep_s = plant.substep_s();
        if let Some(encoder) = self.outputs.encoder.as_deref() {
            let mut encoder = encoder.clone().with_scene(Arc::clone(&scene));
            if let Some(mesh) = plant.mesh().filter(|_| is_loaded) {
                encoder = encoder.with_membrane(&mesh.triangles, &mesh.positions);
            }
            self.outputs.encoder = Some(Arc::new(encoder));
        }
        self.scene = scene;
    }

    /// Gives inserted objects topics of their own.
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

    /// Waits a moment while no tick may run. While the run waits for its first command, the start
    /// is published repeatedly.
    fn wait_paused<P: Plant>(
        &mut self,
        plant: &P,
        packet: &Arc<Packet>,
        pacer: &mut Pacer,
        is_waiting: bool,
    ) {
        if is_waiting && pacer.is_due(WAITING_RATE) {
            self.outputs.publish(&plant.view(&packet.snapshot), packet);
        }
        let Inputs { gate, server, .. } = &mut self.inputs;
        let timeout = if gate.is_lockstep() { clock::POLL_PERIOD } else { clock::IDLE_SLEEP };
        match server {
            Some(server) => server.wait(timeout),
            None => clock::pause(),
        }
        pacer.wait_paused();
        let is_playing = server.as_ref().is_none_or(|it| it.simulator().may_tick());
        let missed = if is_playing { gate.miss(pacer.paused_s()) } else { None };
        if let Some(missed) = missed {
            let waited_s = pacer.paused_s();
            self.supervision.progress.say(&format!("no command for {waited_s:.3} s of wall time"));
            match (missed, server) {
                (Missed::End, _) => self.has_missed = true,
                (Missed::Pause, Some(server)) => server.pause(),
                _ => {}
            }
        }
    }

    /// Waits for real time, if the scene says so. Requested steps are not paced.
    fn pace(&self, pacer: &mut Pacer, run_time_ns: u64) {
        if self.inputs.server.as_ref().is_some_and(|it| it.simulator().is_stepping()) {
            pacer.wait_paused();
        }
        pacer.wait_until(run_time_ns);
    }

    fn ticked(&mut self, packet: &Packet) {
        if let Some(server) = &mut self.inputs.server {
            server.ticked(&packet.snapshot, self.n_packets);
        }
    }

    fn number(&mut self, packet: Packet) -> Packet {
        self.n_packets += 1;
        let packet = packet.with_encoder(self.outputs.encoder.clone());
        packet.numbered(self.n_packets).with_checkpoints(mem::take(&mut self.checkpoints))
    }

    /// Adds a checkpoint to the next packet if one is due and a recording keeps it.
    fn save_checkpoint<P: Plant>(&mut self, plant: &P, is_due: bool) {
        if is_due && self.outputs.bag.is_some() {
            self.checkpoints.extend(plant.checkpoint());
        }
    }

    /// Simulated time since the start of the run; not reset with simulated time.
    fn run_time_ns(&self, snapshot: &Snapshot) -> u64 {
        snapshot.run_tick.time_ns(self.tick_ns())
    }

    fn ending(&mut self, snapshot: &Snapshot) -> Option<Ending> {
        let Inputs { command_sources, server, .. } = &self.inputs;
        if self.supervision.shutdown.is_requested() {
            return Some(Ending::Interrupted);
        }
        if server.as_ref().is_some_and(|it| it.simulator().is_quitting()) {
            return Some(Ending::Quit);
        }
        if self.has_missed {
            return Some(Ending::NoCommand);
        }
        if command_sources.is_done() {
            return Some(Ending::Finished);
        }
        if self.supervision.end_ns.is_some_and(|end_ns| end_ns <= self.run_time_ns(snapshot)) {
            return Some(Ending::TimeUp);
        }
        let (errors, must_stop) = self.outputs.take_errors();
        errors.iter().for_each(|error| self.supervision.progress.say(error));
        must_stop.then_some(Ending::RecordingFailed)
    }

    /// Updates metrics and progress, and adds statistics where they are due.
    fn pack(&mut self, snapshot: Snapshot, pacer: &Pacer) -> Packet {
        self.lift_monitor.update(&snapshot, Duration::from_nanos(self.tick_ns()).as_secs_f64());
        let phase = self.inputs.command_sources.phase().map_or("", |phase| phase.name());
        self.supervision.progress.tick(&snapshot, phase, pacer);
        let is_due = self.schedule.statistics(snapshot.time_ns);
        let run = is_due.then(|| RunStatistics {
            wall_time_s: pacer.wall_time_s(),
            real_time_factor: pacer.real_time_factor(),
            real_time_factor_mean: pacer.real_time_factor_mean(),
            substep_s: self.substep_s,
            seed: self.scene.seed,
            phase: phase.to_owned(),
            sinks: self.outputs.counters(),
        });
        self.number(Packet::new(snapshot, run))
    }
}

#[cfg(test)]
mod tests;
