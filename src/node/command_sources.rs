//! All sources of commands: the built-in controller and external sources.

use std::time::Duration;

use crate::{
    command::Command,
    controller::{Observation, Phase, PickAndLift},
    io::source::{Source, SourceCounters},
    scene::{Controller, Scene},
    snapshot::Snapshot,
};

/// All sources of commands of a run.
pub struct CommandSources {
    builtin: Option<PickAndLift>,
    external: Vec<Box<dyn Source>>,
}

impl CommandSources {
    /// The built-in controller, if `scene` selects it, and external sources.
    pub fn new(scene: &Scene, external: Vec<Box<dyn Source>>) -> Self {
        Self { builtin: builtin(scene), external }
    }

    /// External sources only, whatever controller the scene selects.
    pub fn from_external(external: Vec<Box<dyn Source>>) -> Self {
        Self { builtin: None, external }
    }

    /// Returns the commands for the next tick. External commands come last, so that a person can
    /// overrule the built-in controller.
    pub fn drain(&mut self, snapshot: &Snapshot) -> Vec<Command> {
        let mut commands = self.builtin.as_mut().map(|it| decide(it, snapshot)).unwrap_or_default();
        commands.extend(self.external.iter_mut().flat_map(|source| source.drain(snapshot)));
        commands
    }

    /// Drops the external commands that have arrived so far.
    pub fn discard(&mut self, snapshot: &Snapshot) {
        self.external.iter_mut().for_each(|source| drop(source.drain(snapshot)));
    }

    /// Restarts the built-in controller, if there is one, with the parameters of `scene`.
    pub fn restart(&mut self, scene: &Scene) {
        if let (Some(controller), Some(restarted)) = (&mut self.builtin, builtin(scene)) {
            *controller = restarted;
        }
    }

    /// Phase of the built-in controller.
    pub fn phase(&self) -> Option<Phase> {
        self.builtin.as_ref().map(PickAndLift::phase)
    }

    /// True when the built-in controller has finished.
    pub fn is_done(&self) -> bool {
        self.builtin.as_ref().is_some_and(PickAndLift::is_done)
    }

    /// True while the run must wait for a first command.
    pub fn is_waiting(&self) -> bool {
        self.builtin.is_none() && !self.external.iter().any(|source| source.has_received())
    }

    /// Counters of the external sources, by name.
    pub fn counters(&self) -> Vec<(&'static str, SourceCounters)> {
        self.external.iter().map(|source| (source.name(), source.counters())).collect()
    }
}

fn builtin(scene: &Scene) -> Option<PickAndLift> {
    match &scene.controller {
        Controller::Builtin(parameters) => Some(PickAndLift::new(parameters)),
        Controller::Topics { .. } => None,
    }
}

fn decide(controller: &mut PickAndLift, snapshot: &Snapshot) -> Vec<Command> {
    let found = snapshot.objects.iter().find(|it| it.name == controller.object());
    let Some(object) = found else { return Vec::new() };
    controller.decide(&Observation {
        time_s: Duration::from_nanos(snapshot.time_ns).as_secs_f64(),
        flange_pose: snapshot.flange.pose,
        contact_force: snapshot.contact_wrench.force,
        gauge_pa: snapshot.chamber.gauge,
        object_pose: object.body.pose,
    })
}
