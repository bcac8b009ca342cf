//! Serves requests between ticks. A response is sent after the messages of its tick.

use std::{sync::Arc, time::Duration};

use super::loader::Loader;
use crate::{
    command::Command,
    io::{published::PublishedUpTo, server::ServiceServer},
    simulator::{Changed, Simulator, World},
    snapshot::Snapshot,
};

/// Largest number of requests served between two ticks; the others wait for the next.
const PER_TICK: usize = 16;
/// Largest number of packets that steps may be ahead of publication.
const LEAD_MAX: u64 = 100;
/// How long to wait for a publisher that has fallen behind.
const TIMEOUT: Duration = Duration::from_secs(1);

/// The simulator and its service server.
pub struct SimulationServer {
    simulator: Simulator,
    services: Box<dyn ServiceServer>,
    published: Arc<PublishedUpTo>,
    loader: Option<Loader>,
}

impl SimulationServer {
    /// A simulator that serves the requests of `services`. Responses wait until `published` has
    /// counted the packet of their tick.
    pub fn new(
        simulator: Simulator,
        services: Box<dyn ServiceServer>,
        published: Arc<PublishedUpTo>,
    ) -> Self {
        Self { simulator, services, published, loader: None }
    }

    /// The same, able to load other scenes.
    pub fn with_loader(self, loader: Loader) -> Self {
        Self { loader: Some(loader), ..self }
    }

    /// Serves waiting requests. `n_packets` is the number of the last published packet.
    pub fn handle_requests(&mut self, world: &mut World<'_>, n_packets: u64) -> Changed {
        for call in self.services.take(PER_TICK) {
            if let Err(error) = self.simulator.handle_request(&call, world) {
                self.services.report_malformed(error);
            }
        }
        self.load(world);
        let changed = self.simulator.take_changed();
        // The next packet reports the changes.
        self.send(n_packets + u64::from(!changed.changes.is_empty()));
        changed
    }

    /// Passes scenes to the loader and takes the settled ones.
    fn load(&mut self, world: &mut World<'_>) {
        let requested = self.simulator.take_scene_to_settle();
        match (&mut self.loader, requested) {
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

    /// A tick has ended; packet `n_packets` holds its results.
    pub fn ticked(&mut self, snapshot: &Snapshot, n_packets: u64) {
        self.simulator.finish_tick(snapshot);
        self.send(n_packets);
        if self.simulator.is_stepping() {
            self.published.wait_for(n_packets.saturating_sub(LEAD_MAX), TIMEOUT);
        }
    }

    fn send(&mut self, n_packets: u64) {
        for outgoing in self.simulator.take_outgoing() {
            self.services.send(outgoing, n_packets);
        }
    }

    /// Waits for a request, at most this long.
    pub fn wait(&mut self, at_most: Duration) {
        self.services.wait(at_most);
    }

    /// The simulator.
    pub fn simulator(&self) -> &Simulator {
        &self.simulator
    }

    /// A first command has arrived.
    pub fn first_command(&mut self) {
        self.simulator.first_command();
    }

    /// Pauses the simulation.
    pub fn pause(&mut self) {
        self.simulator.pause();
    }

    /// True if a request has produced a command that starts a waiting run.
    pub fn has_commands(&self) -> bool {
        self.simulator.has_commands()
    }

    /// Takes the commands that requests have produced.
    pub fn take_commands(&mut self) -> Vec<Command> {
        self.simulator.take_commands()
    }
}
