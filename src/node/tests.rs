//! The run loop, tried on a plant that counts and on sinks that remember.

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
    cosim::refused::ChangeError,
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
    type Fault = Broken;

    fn tick(&mut self, commands: &[Command]) -> Result<(), Broken> {
        if self.breaks_at == Some(self.n_ticks) {
            return Err(Broken);
        }
        self.n_ticks += 1;
        self.commands.extend(commands.iter().map(|it| (self.n_ticks, it.clone())));
        Ok(())
    }

    fn snapshot(&self, _parts: Parts) -> Snapshot {
        let mut seen = snapshot(self.n_ticks);
        let zero = self.restarts_at.filter(|it| *it <= self.n_ticks).unwrap_or(0);
        seen.time_ns -= zero * TICK_NS;
        seen
    }

    fn view<'a>(&'a self, seen: &'a Snapshot) -> View<'a> {
        View {
            snapshot: seen,
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

/// Says one thing when it has been asked `after` times whether it was heard.
struct Late {
    after: Mutex<u32>,
    command: Option<Command>,
}

impl Source for Late {
    fn name(&self) -> &'static str {
        "late"
    }

    fn drain(&mut self, _seen: &Snapshot) -> Vec<Command> {
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

/// A crew for commands over topics that ends at tick 100.
fn context(outside: Vec<Box<dyn Source>>) -> RunContext {
    let text = "{ name: x, controller: topics, object: { shape: { sphere: { radius: 1 mm } }, \
                position: [0 m, 0 m, 1 mm] } }";
    let scene = scene::parse(text, "x", std::path::Path::new(""), &[]).unwrap();
    RunContext {
        front: None,
        checkpoints: Vec::new(),
        gate: Gate::new(scene::Lockstep::OFF),
        n_packets: 0,
        has_missed: false,
        command_sources: CommandSources::new(&scene, outside),
        outputs: OutputSinks::default(),
        schedule: Schedule::new(&scene.outputs, TICK_NS),
        lift_monitor: LiftMonitor::default(),
        progress: Progress::new(true),
        shutdown: Shutdown::default(),
        tick_ns: TICK_NS,
        end_ns: Some(100 * TICK_NS),
        is_real_time: false,
        about: RunStatistics::default(),
    }
}

fn late() -> Vec<Box<dyn Source>> {
    let command = Some(Command::Vacuum { gauge_pa: -5.0 });
    vec![Box::new(Late { after: Mutex::new(3), command })]
}

#[test]
fn a_run_waits_for_its_first_command_and_loses_no_tick() {
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
    assert!(closed.faults.is_empty(), "{:?}", closed.faults);
    let mut seen = ticks.lock().unwrap().clone();
    seen.dedup();
    assert_eq!(seen, (0..=100).collect::<Vec<_>>(), "the start while it waits, then every tick");
}

/// Oracle: counting. The time that a run was given is that of its ticks together.
#[test]
fn a_run_is_as_long_as_it_was_told_whatever_becomes_of_time() {
    let mut context = context(late());
    let mut plant = Counter { restarts_at: Some(60), ..Counter::default() };
    let report = run(&mut plant, &mut context);
    assert_eq!(report.ending.unwrap(), Ending::TimeUp);
    assert_eq!((plant.n_ticks, report.last.snapshot.time_ns), (100, 40 * TICK_NS));
}

#[test]
fn a_run_ends_where_the_plant_cannot_go_on() {
    let mut context = context(late());
    let mut plant = Counter { breaks_at: Some(7), ..Counter::default() };
    let report = run(&mut plant, &mut context);
    assert!(report.ending.is_err());
    assert_eq!(report.last.snapshot.tick.0, 7, "the last whole tick is reported");
}

#[test]
fn a_request_to_end_is_heard_even_while_waiting() {
    let mut context = context(Vec::new());
    context.shutdown.request();
    let report = run(&mut Counter::default(), &mut context);
    assert_eq!(report.ending.unwrap(), Ending::Interrupted);
}

#[test]
fn a_failed_recording_ends_the_run_only_if_the_scene_says_so() {
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
fn an_object_is_held_if_it_stays_above_nine_tenths() {
    for (sag, is_held) in [(0.005, true), (0.02, false)] {
        let mut lift_monitor = LiftMonitor::default();
        for tick in 0..1000 {
            let mut seen = snapshot(tick);
            let up = if tick < 100 { 0.0 } else { 0.1 };
            let sagged = if tick < 500 { 0.0 } else { sag };
            seen.flange.pose.translation.vector = Vec3::new(0.0, 0.0, 0.2 + up);
            if tick == 100 {
                seen.flange.twist.linear.z = 1.0;
            }
            seen.objects[0].body.pose.translation.vector.z = 0.035 + up - sagged * up / 0.1;
            seen.chamber.gauge_setpoint = -90e3;
            seen.contact_wrench.force.z = if tick < 100 { 7.0 } else { -2.5 };
            lift_monitor.look(&seen, 1e-3);
        }
        let verdict = lift_monitor.verdict();
        assert_eq!(verdict.is_held(), is_held, "{verdict:?}");
        assert!((verdict.lift_height - 0.1).abs() < 1e-12, "{verdict:?}");
        // 900 ticks up, of which the first 100 ms do not count as still.
        assert!((verdict.hold_time - 0.8).abs() < 2e-3, "{verdict:?}");
        assert!((verdict.peak_push_force - 7.0).abs() < 1e-12, "{verdict:?}");
        assert!((verdict.peak_pull_force - 2.5).abs() < 1e-12, "{verdict:?}");
    }
}
