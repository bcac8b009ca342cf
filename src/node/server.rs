//! The simulator at its bench: questions are taken between two ticks, answers go out behind their
//! tick.

use std::{sync::Arc, time::Duration};

use super::loader::Loader;
use crate::{
    command::Command,
    io::{published::PublishedUpTo, server::ServiceServer},
    simulator::{Changed, Simulator, World},
    snapshot::Snapshot,
};

/// Questions that are answered between two ticks while time goes on; more wait for the next.
const PER_TICK: usize = 16;
/// Packets that steps may run ahead of what is published.
const LEAD_MAX: u64 = 100;
/// How long is waited for a publisher that has fallen behind.
const TIMEOUT: Duration = Duration::from_secs(1);

/// The simulator, and those who ask it.
pub struct SimulationServer {
    simulator: Simulator,
    bench: Box<dyn ServiceServer>,
    published: Arc<PublishedUpTo>,
    loader: Option<Loader>,
}

impl SimulationServer {
    /// A simulator that is asked at `bench`; answers stay behind what `published` counts.
    pub fn new(
        simulator: Simulator,
        bench: Box<dyn ServiceServer>,
        published: Arc<PublishedUpTo>,
    ) -> Self {
        Self { simulator, bench, published, loader: None }
    }

    /// The same, which can load other scenes.
    pub fn with_loader(self, loader: Loader) -> Self {
        Self { loader: Some(loader), ..self }
    }

    /// Answers what waits. `n_packets` is the number of the last packet given out.
    pub fn handle_requests(&mut self, world: &mut World<'_>, n_packets: u64) -> Changed {
        for call in self.bench.take(PER_TICK) {
            if let Err(fault) = self.simulator.handle_request(&call, world) {
                self.bench.report_malformed(fault);
            }
        }
        self.load(world);
        let changed = self.simulator.take_changed();
        // What tells of changes is the next packet.
        self.send(n_packets + u64::from(!changed.changes.is_empty()));
        changed
    }

    /// Hands on what shall be loaded, and takes in what has been.
    fn load(&mut self, world: &mut World<'_>) {
        let wanted = self.simulator.take_scene_to_settle();
        match (&mut self.loader, wanted) {
            (Some(loader), Some(scene)) => loader.begin(scene),
            (None, Some(_)) => {
                let why = "this run cannot load other scenes".to_owned();
                self.simulator.finish_loading(Err(why), world);
            }
            _ => {}
        }
        if let Some(settled) = self.loader.as_mut().and_then(Loader::poll) {
            self.simulator.finish_loading(settled, world);
        }
    }

    /// A tick has ended, and packet `n_packets` tells of it.
    pub fn ticked(&mut self, seen: &Snapshot, n_packets: u64) {
        self.simulator.finish_tick(seen);
        self.send(n_packets);
        if self.simulator.is_stepping() {
            self.published.wait_for(n_packets.saturating_sub(LEAD_MAX), TIMEOUT);
        }
    }

    fn send(&mut self, n_packets: u64) {
        for outgoing in self.simulator.take_outgoing() {
            self.bench.send(outgoing, n_packets);
        }
    }

    /// Waits for a question, at most this long.
    pub fn wait(&mut self, at_most: Duration) {
        self.bench.wait(at_most);
    }

    /// The simulator.
    pub fn simulator(&self) -> &Simulator {
        &self.simulator
    }

    /// A first command has come.
    pub fn first_command(&mut self) {
        self.simulator.first_command();
    }

    /// Stops time where it is.
    pub fn pause(&mut self) {
        self.simulator.pause();
    }

    /// True if a question has led to a command that sets a waiting run going.
    pub fn has_commands(&self) -> bool {
        self.simulator.has_commands()
    }

    /// Commands that questions have led to.
    pub fn take_commands(&mut self) -> Vec<Command> {
        self.simulator.take_commands()
    }
}
