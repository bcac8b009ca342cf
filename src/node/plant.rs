//! What the run needs of the thing it runs: a session, or a toy in tests.

use std::error::Error;

use super::schedule::Parts;
use crate::{
    command::Command,
    physics::health::Diverged,
    session::Session,
    snapshot::{Snapshot, checkpoint::Checkpoint, take, view::View},
};

/// Something that ticks and can be looked at.
pub trait Plant {
    /// Why it cannot go on.
    type Fault: Error + Send + Sync + 'static;

    /// Advances by one tick under the commands that arrived since the last.
    ///
    /// # Errors
    /// If the system cannot go on.
    fn tick(&mut self, commands: &[Command]) -> Result<(), Self::Fault>;

    /// A copy of what the outside may see, with the large parts asked for.
    fn snapshot(&self, parts: Parts) -> Snapshot;

    /// All that is needed to go on from here, if it can be saved.
    fn checkpoint(&self) -> Option<Checkpoint> {
        None
    }

    /// A borrowed look at everything. `seen` is the snapshot of the same tick.
    fn view<'a>(&'a self, seen: &'a Snapshot) -> View<'a>;
}

impl Plant for Session {
    type Fault = Diverged;

    fn tick(&mut self, commands: &[Command]) -> Result<(), Diverged> {
        Self::tick(self, commands)
    }

    fn snapshot(&self, parts: Parts) -> Snapshot {
        take::snapshot(self, parts)
    }

    fn checkpoint(&self) -> Option<Checkpoint> {
        let (tick, time_ns, digest) = (self.now(), self.time_ns(), self.digest());
        Some(Checkpoint { tick, time_ns, digest, bytes: self.save() })
    }

    fn view<'a>(&'a self, seen: &'a Snapshot) -> View<'a> {
        take::view(self, seen)
    }
}
