//! The interface between the run loop and the system that runs: a session, or a mock in tests.

use std::error::Error;

use super::schedule::Parts;
use crate::{
    command::{Command, change::Change},
    cosim::change_error::ChangeError,
    physics::{health::Diverged, membrane::mesh::Mesh},
    session::Session,
    simulator::WorldAccess,
    snapshot::{Snapshot, checkpoint::Checkpoint, view::View},
};

/// A system that can be run.
pub trait Plant: WorldAccess {
    /// Why it cannot continue.
    type Error: Error + Send + Sync + 'static;

    /// Applies `commands` and advances by one tick.
    ///
    /// # Errors
    /// If the system cannot continue.
    fn tick(&mut self, commands: &[Command]) -> Result<(), Self::Error>;

    /// Copies the results of the last tick, with the large parts that `parts` selects.
    fn snapshot(&self, parts: Parts) -> Snapshot;

    /// Everything needed to resume from here, if it can be saved.
    fn checkpoint(&self) -> Option<Checkpoint> {
        None
    }

    /// Mesh of the membrane, if there is one.
    fn mesh(&self) -> Option<&Mesh> {
        None
    }

    /// Length of a substep (s).
    fn substep_s(&self) -> f64 {
        0.0
    }

    /// Borrows the results of the last tick. `snapshot` is the snapshot of the same tick.
    fn view<'a>(&'a self, snapshot: &'a Snapshot) -> View<'a>;
}

impl Plant for Session {
    type Error = Diverged;

    fn tick(&mut self, commands: &[Command]) -> Result<(), Diverged> {
        Self::tick(self, commands)
    }

    fn snapshot(&self, parts: Parts) -> Snapshot {
        Self::snapshot(self, parts)
    }

    fn checkpoint(&self) -> Option<Checkpoint> {
        let (tick, time_ns, digest) = (self.run_tick(), self.run_time_ns(), self.digest());
        self.save().map(|bytes| Checkpoint { tick, time_ns, digest, bytes })
    }

    fn mesh(&self) -> Option<&Mesh> {
        Some(&self.coupled().system.model.membrane.mesh)
    }

    fn substep_s(&self) -> f64 {
        self.coupled().system.model.substep
    }

    fn view<'a>(&'a self, snapshot: &'a Snapshot) -> View<'a> {
        Self::view(self, snapshot)
    }
}

impl WorldAccess for Session {
    fn full_snapshot(&self) -> Snapshot {
        Self::snapshot(self, Parts::ALL)
    }

    fn change(&mut self, change: &Change) -> Result<(), ChangeError> {
        Self::change(self, change)
    }
}
