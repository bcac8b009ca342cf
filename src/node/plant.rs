//! What the run needs of the thing it runs: a session, or a toy in tests.

use std::error::Error;

use super::schedule::Parts;
use crate::{
    command::{
        Command,
        change::{Change, ChangeRefused},
    },
    physics::health::Diverged,
    session::Session,
    simulator::Subject,
    snapshot::{Snapshot, checkpoint::Checkpoint, view::View},
    wire::to_ros::Encoder,
};

/// Something that ticks and can be looked at.
pub trait Plant: Subject {
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

    /// Who tells of it in the way of `before`, now that another scene was loaded.
    fn encoder(&self, _before: &Encoder) -> Option<Encoder> {
        None
    }

    /// Length of a substep (s).
    fn substep_s(&self) -> f64 {
        0.0
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
        Self::snapshot(self, parts)
    }

    fn checkpoint(&self) -> Option<Checkpoint> {
        let (tick, time_ns, digest) = (self.run_tick(), self.run_time_ns(), self.digest());
        self.save().map(|bytes| Checkpoint { tick, time_ns, digest, bytes })
    }

    fn encoder(&self, before: &Encoder) -> Option<Encoder> {
        let mesh = &self.coupled().system.model.membrane.mesh;
        Some(before.of_scene(self.scene(), &mesh.triangles, &mesh.positions))
    }

    fn substep_s(&self) -> f64 {
        self.coupled().system.model.substep
    }

    fn view<'a>(&'a self, seen: &'a Snapshot) -> View<'a> {
        Self::view(self, seen)
    }
}

impl Subject for Session {
    fn look(&self) -> Snapshot {
        Self::snapshot(self, Parts::ALL)
    }

    fn change(&mut self, change: &Change) -> Result<(), ChangeRefused> {
        Self::change(self, change)
    }
}
