//! A plant that ticks in real time: a settled session that stands still, beside a solver that is as busy as
//! one that just keeps up.

use std::cell::RefCell;

use super::{Heard, Latency, LatencyError, N_FIRST, latency, listener::Samples, percentiles};
use crate::{
    base::{Real, Tick, parallel, real::real_of},
    benchmarks::{
        BenchError, Options,
        packing::{Boxed, Phase},
    },
    command::{Command, change::Change},
    cosim::refused::ChangeError,
    host::clock::{Stopwatch, wall_ns},
    node::plant::Plant,
    physics::{System, health::Diverged},
    session::Session,
    simulator::Subject,
    snapshot::{Parts, Snapshot, view::View},
};

/// Time for which all solver threads are at work in each tick (s).
const BUSY: Real = 7e-4;
/// Grains of the solver's box: a substep of some ten microseconds.
const BOX: Boxed = Boxed { n_grains: 300, n_tiles: [1; 3], phase: Phase::Rest };

/// The plant.
pub(super) struct IdlePlant {
    session: Session,
    tick: u64,
    tick_ns: u64,
    pool: parallel::ThreadPool,
    solver: System,
    /// Number of each command, and when the first tick that has it began (ns).
    used: Samples,
    /// Each tick, and when it was given out (ns). `Plant::view` only borrows.
    shown: RefCell<Samples>,
}

impl IdlePlant {
    /// Beside `session`, which does not tick.
    pub(super) fn new(
        session: Session,
        tick_ns: u64,
        options: &Options,
    ) -> Result<Self, BenchError> {
        let pool = parallel::ThreadPool::new(options.n_threads)?;
        let grown = parallel::lead(&pool, || BOX.grow())?;
        let solver = BOX.system(grown);
        let shown = RefCell::default();
        Ok(Self { session, tick: 0, tick_ns, pool, solver, used: Vec::new(), shown })
    }

    /// The session, for its sizes.
    pub(super) fn session(&self) -> &Session {
        &self.session
    }

    /// What was measured here, with what was heard over there.
    pub(super) fn latencies(&self, heard: &Heard) -> Result<Vec<Latency>, LatencyError> {
        let shown = self.shown.borrow();
        let first = N_FIRST * self.tick_ns;
        let counted: Vec<u64> =
            shown.iter().filter(|(mark, _)| first < *mark).map(|(_, at)| *at).collect();
        let periods = counted.windows(2).map(|it| 1e-3 * real_of(it[1] - it[0])).collect();
        Ok(vec![
            latency("command_to_tick_ros", 1, &heard.commands, &self.used)?,
            latency("tick_to_sample_ros", first, &shown, &heard.ros)?,
            latency("tick_to_sample_stream", first, &shown, &heard.stream)?,
            percentiles("tick_period", periods, counted.len() - 1),
        ])
    }
}

impl Subject for IdlePlant {
    fn look(&self) -> Snapshot {
        Plant::snapshot(self, Parts::ALL)
    }

    fn change(&mut self, _: &Change) -> Result<(), ChangeError> {
        Err(ChangeError::Unchangeable)
    }
}

impl Plant for IdlePlant {
    type Error = Diverged;

    fn tick(&mut self, commands: &[Command]) -> Result<(), Diverged> {
        let now = wall_ns();
        for command in commands {
            if let Command::Vacuum { gauge_pa } = command {
                self.used.push((super::listener::number(*gauge_pa), now));
            }
        }
        let Self { pool, solver, .. } = self;
        parallel::lead(pool, || {
            let watch = Stopwatch::start();
            while watch.total_s() < BUSY {
                solver.step();
            }
        });
        self.tick += 1;
        Ok(())
    }

    fn snapshot(&self, parts: Parts) -> Snapshot {
        let time_ns = self.tick * self.tick_ns;
        let (tick, run_tick) = (Tick(self.tick), Tick(self.tick));
        Snapshot { tick, time_ns, run_tick, ..self.session.snapshot(parts) }
    }

    fn view<'a>(&'a self, seen: &'a Snapshot) -> View<'a> {
        // Asked for right before it is given out; the start is shown again and again, and not counted.
        if 0 < seen.time_ns {
            self.shown.borrow_mut().push((seen.time_ns, wall_ns()));
        }
        self.session.view(seen)
    }
}
