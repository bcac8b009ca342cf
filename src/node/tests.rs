//! The run loop, on a plant that counts ticks and sinks that remember packets.

use std::{
    error::Error,
    sync::{Arc, Mutex},
};

use super::*;
use crate::{
    base::{
        Pose, Tick, Vec3,
        real::{Twist, Wrench},
    },
    command::{Command, CommandCounts, change::Change},
    cosim::change_error::ChangeError,
    io::{
        fanout::Delivery,
        sink::Sink,
        source::{Source, SourceCounters},
    },
    scene,
    simulator::WorldAccess,
    snapshot::{BodySnapshot, ChamberSnapshot, JammingSnapshot, ObjectSnapshot, view::View},
};

const TICK_NS: u64 = 1_000_000;

/// Does nothing but count ticks and remember commands.
#[derive(Default)]
struct Counter {
    n_ticks: u64,
    commands: Vec<(u64, Command)>,
    breaks_at: Option<u64>,
    /// Simulated time is zero again after this tick.
    restarts_at: Option<u64>,
}

#[derive(Debug, thiserror::Error)]
#[error("broken")]
struct Broken;

impl WorldAccess for Counter {
    fn full_snapshot(&self) -> Snapshot {
        snapshot(self.n_ticks)
    }

    fn change(&mut self, _change: &Change) -> Result<(), ChangeError> {
        Err(ChangeError::Unchangeable)
    }
}

impl Plant for Counter {
    type Error = Broken;

    fn tick(&mut self, commands: &[Command]) -> Result<(), Broken> {
        if self.breaks_at == Some(self.n_ticks) {
            return Err(Broken);
        }
        self.n_ticks += 1;
        self.commands.extend(commands.iter().map(|it| (self.n_ticks, it.clone())));
        Ok(())
    }

    fn snapshot(&self, _parts: Parts) -> Snapshot {
        let mut snapshot = snapshot(self.n_ticks);
        let zero = self.restarts_at.filter(|it| *it <= self.n_ticks).unwrap_or(0);
        snapshot.time_ns -= zero * TICK_NS;
        snapshot
    }

    fn view<'a>(&'a self, snapshot: &'a Snapshot) -> View<'a> {
        View {
            snapshot,
            grain_positions: &[],
            grain_velocities: &[],
            grain_spins: &[],
            grain_radii: &[],
            grain_normal_forces: &[],
            vertex_positions: &[],
            vertex_velocities: &[],
            vertex_contact_forces: &[],
        }
    }
}

/// Everything at rest at the end of a tick.
pub(super) fn snapshot(tick: u64) -> Snapshot {
    let at_rest = BodySnapshot { pose: Pose::identity(), twist: Twist::zero() };
    Snapshot {
        tick: Tick(tick),
        time_ns: tick * TICK_NS,
        run_tick: Tick(tick),
        flange: at_rest,
        objects: vec![ObjectSnapshot {
            name: "object".to_owned(),
            body: at_rest,
            contact_wrench: Wrench::zero(),
            membrane_wrench: Wrench::zero(),
            is_driven: false,
        }],
        contact_wrench: Wrench::zero(),
        mount_wrench: Wrench::zero(),
        chamber: ChamberSnapshot { gauge_setpoint: 0.0, gauge: 0.0, ambient: 1e5, volume: 1e-4 },
        jamming: JammingSnapshot::default(),
        membrane: None,
        grains: None,
        contacts: None,
        commands: Vec::new(),
        command_counts: CommandCounts::default(),
        digest: tick,
    }
}

/// Sends one command after `after` calls of `has_received`.
struct Late {
    after: Mutex<u32>,
    command: Option<Command>,
}

impl Source for Late {
    fn name(&self) -> &'static str {
        "late"
    }

    fn drain(&mut self, _snapshot: &Snapshot) -> Vec<Command> {
        self.command.take().into_iter().collect()
    }

    fn has_received(&self) -> bool {
        let mut after = self.after.lock().unwrap();
        *after = after.saturating_sub(1);
        *after == 0
    }

    fn counters(&self) -> SourceCounters {
        SourceCounters::default()
    }
}

/// Remembers the ticks it was given, and may fail.
struct Memory {
    ticks: Arc<Mutex<Vec<u64>>>,
    fails_at: Option<u64>,
}

impl Sink for Memory {
    fn name(&self) -> &'static str {
        "bag"
    }

    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn Error + Send + Sync>> {
        let tick = packet.snapshot.tick.0;
        self.ticks.lock().unwrap().push(tick);
        if self.fails_at == Some(tick) { Err("disk full".into()) } else { Ok(()) }
    }

    fn close(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        Ok(())
    }
}

/// A context with commands over topics that ends at tick 100.
fn context(external: Vec<Box<dyn Source>>) -> RunContext {
    let text = "{ name: x, controller: topics, object: { shape: { sphere: { radius: 1 mm } }, \
                position: [0 m, 0 m, 1 mm] } }";
    let scene = scene::parse(text, "x", std::path::Path::new(""), &[]).unwrap();
    let inputs = Inputs {
        command_sources: CommandSources::new(&scene, external),
        gate: Gate::new(scene::Lockstep::OFF),
        server: None,
    };
    let (progress, shutdown) = (Progress::new(true), Shutdown::default());
    let supervision = Supervision { progress, shutdown, end_ns: Some(100 * TICK_NS) };
    RunContext::new(Arc::new(scene), inputs, OutputSinks::default(), supervision)
}

fn late() -> Vec<Box<dyn Source>> {
    let command = Some(Command::Vacuum { gauge_pa: -5.0 });
    vec![Box::new(Late { after: Mutex::new(3), command })]
}

#[test]
fn run_waits_for_first_command_and_loses_no_tick() {
    let mut context = context(late());
    let ticks = Arc::new(Mutex::new(Vec::new()));
    let memory = Memory { ticks: Arc::clone(&ticks), fails_at: None };
    context.outputs.fanout.add(Box::new(memory), Delivery::Every { depth: 10 }).unwrap();
    let mut plant = Counter::default();
    let report = run(&mut plant, &mut context);
    assert_eq!(report.ending.unwrap(), Ending::TimeUp);
    assert_eq!(report.last.snapshot.tick.0, 100);
    assert_eq!(plant.commands, [(1, Command::Vacuum { gauge_pa: -5.0 })], "before the first tick");
    let closed = context.outputs.close();
    assert!(closed.errors.is_empty(), "{:?}", closed.errors);
    let mut snapshot = ticks.lock().unwrap().clone();
    snapshot.dedup();
    assert_eq!(
        snapshot,
        (0..=100).collect::<Vec<_>>(),
        "the start while it waits, then every tick"
    );
}

/// Oracle: counting. The duration of a run counts its ticks, whatever resets simulated time.
#[test]
fn run_lasts_as_long_as_requested_when_time_is_reset() {
    let mut context = context(late());
    let mut plant = Counter { restarts_at: Some(60), ..Counter::default() };
    let report = run(&mut plant, &mut context);
    assert_eq!(report.ending.unwrap(), Ending::TimeUp);
    assert_eq!((plant.n_ticks, report.last.snapshot.time_ns), (100, 40 * TICK_NS));
}

#[test]
fn run_ends_when_the_plant_fails() {
    let mut context = context(late());
    let mut plant = Counter { breaks_at: Some(7), ..Counter::default() };
    let report = run(&mut plant, &mut context);
    assert!(report.ending.is_err());
    assert_eq!(report.last.snapshot.tick.0, 7, "the last complete tick is reported");
}

#[test]
fn shutdown_is_noticed_while_waiting() {
    let mut context = context(Vec::new());
    context.supervision.shutdown.request();
    let report = run(&mut Counter::default(), &mut context);
    assert_eq!(report.ending.unwrap(), Ending::Interrupted);
}

#[test]
fn failed_recording_ends_the_run_only_if_the_scene_says_so() {
    for (stops_with_bag, expected) in [(true, Ending::RecordingFailed), (false, Ending::TimeUp)] {
        let mut context = context(late());
        let memory = Memory { ticks: Arc::default(), fails_at: Some(10) };
        // A queue of one: the sink is at most one tick behind.
        context.outputs.fanout.add(Box::new(memory), Delivery::Every { depth: 1 }).unwrap();
        context.outputs.stops_with_bag = stops_with_bag;
        let report = run(&mut Counter::default(), &mut context);
        assert_eq!(report.ending.unwrap(), expected);
    }
}

/// Oracle: heights by hand. The object follows the flange up by 100 mm, then sags by 5 or 20 mm.
#[test]
fn object_is_held_above_nine_tenths() {
    for (sag, is_held) in [(0.005, true), (0.02, false)] {
        let mut lift_monitor = LiftMonitor::default();
        for tick in 0..1000 {
            let mut snapshot = snapshot(tick);
            let up = if tick < 100 { 0.0 } else { 0.1 };
            let sagged = if tick < 500 { 0.0 } else { sag };
            snapshot.flange.pose.translation.vector = Vec3::new(0.0, 0.0, 0.2 + up);
            if tick == 100 {
                snapshot.flange.twist.linear.z = 1.0;
            }
            snapshot.objects[0].body.pose.translation.vector.z = 0.035 + up - sagged * up / 0.1;
            snapshot.chamber.gauge_setpoint = -90e3;
            snapshot.contact_wrench.force.z = if tick < 100 { 7.0 } else { -2.5 };
            lift_monitor.update(&snapshot, 1e-3);
        }
        let metrics = lift_monitor.metrics();
        assert_eq!(metrics.is_held(), is_held, "{metrics:?}");
        assert!((metrics.lift_height - 0.1).abs() < 1e-12, "{metrics:?}");
        // 900 ticks up, of which the first 100 ms do not count as still.
        assert!((metrics.hold_time - 0.8).abs() < 2e-3, "{metrics:?}");
        assert!((metrics.peak_push_force - 7.0).abs() < 1e-12, "{metrics:?}");
        assert!((metrics.peak_pull_force - 2.5).abs() < 1e-12, "{metrics:?}");
    }
}
