//! A plant for the latency benchmark: a settled session that does not advance, and a solver that is
//! as busy as one that barely runs in real time.

use std::cell::RefCell;

use super::{
    Latency, LatencyError, ListenerSamples, N_FIRST, latency, listener::Samples, percentiles,
};
use crate::{
    base::{Real, Tick, parallel, real::real_of},
    benchmarks::{
        BenchError, Options,
        packing::{Boxed, Phase},
    },
    command::{Command, change::Change},
    cosim::change_error::ChangeError,
    host::clock::{Stopwatch, wall_ns},
    node::plant::Plant,
    physics::{System, health::Diverged},
    session::Session,
    simulator::WorldAccess,
    snapshot::{Parts, Snapshot, view::View},
};

/// Time for which all solver threads are busy in each tick (s).
const BUSY: Real = 7e-4;
/// The solver's box, with a substep of some ten microseconds.
const BOX: Boxed = Boxed { n_grains: 300, n_tiles: [1; 3], phase: Phase::Rest };

/// The plant.
pub(super) struct IdlePlant {
    session: Session,
    tick: u64,
    tick_ns: u64,
    pool: parallel::ThreadPool,
    solver: System,
    /// Number of each command, and the start time of the first tick that has it (ns).
    used: Samples,
    /// Each tick, and the time at which it was published (ns). `Plant::view` only borrows.
    published: RefCell<Samples>,
}

impl IdlePlant {
    /// A plant with a `session` that does not advance.
    pub(super) fn new(
        session: Session,
        tick_ns: u64,
        options: &Options,
    ) -> Result<Self, BenchError> {
        let pool = parallel::ThreadPool::new(options.n_threads)?;
        let grown = parallel::lead(&pool, || BOX.grow())?;
        let solver = BOX.system(grown);
        let published = RefCell::default();
        Ok(Self { session, tick: 0, tick_ns, pool, solver, used: Vec::new(), published })
    }

    /// The session, for its sizes.
    pub(super) fn session(&self) -> &Session {
        &self.session
    }

    /// Latencies from the samples of both processes.
    pub(super) fn latencies(
        &self,
        samples: &ListenerSamples,
    ) -> Result<Vec<Latency>, LatencyError> {
        let published = self.published.borrow();
        let first = N_FIRST * self.tick_ns;
        let counted: Vec<u64> =
            published.iter().filter(|(mark, _)| first < *mark).map(|(_, at)| *at).collect();
        let periods = counted.windows(2).map(|it| 1e-3 * real_of(it[1] - it[0])).collect();
        Ok(vec![
            latency("command_to_tick_ros", 1, &samples.commands, &self.used)?,
            latency("tick_to_sample_ros", first, &published, &samples.ros)?,
            latency("tick_to_sample_stream", first, &published, &samples.stream)?,
            percentiles("tick_period", periods, counted.len() - 1),
        ])
    }
}

impl WorldAccess for IdlePlant {
    fn full_snapshot(&self) -> Snapshot {
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

    fn view<'a>(&'a self, snapshot: &'a Snapshot) -> View<'a> {
        // Called right before publishing. The start is published repeatedly and not counted.
        if 0 < snapshot.time_ns {
            self.published.borrow_mut().push((snapshot.time_ns, wall_ns()));
        }
        self.session.view(snapshot)
    }
}
