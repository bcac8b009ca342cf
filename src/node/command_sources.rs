//! Everyone who may command: the built-in controller and the outside.

use std::time::Duration;

use crate::{
    command::Command,
    controller::{Observation, Phase, PickAndLift},
    io::source::{Source, SourceCounters},
    scene::{self, Controller, Scene},
    snapshot::Snapshot,
};

/// All sources of commands of a run.
pub struct CommandSources {
    builtin: Option<Builtin>,
    outside: Vec<Box<dyn Source>>,
}

struct Builtin {
    machine: PickAndLift,
    parameters: scene::PickAndLift,
}

impl CommandSources {
    /// The built-in controller, if `scene` asks for it, and `outside`.
    pub fn new(scene: &Scene, outside: Vec<Box<dyn Source>>) -> Self {
        let builtin = match &scene.controller {
            Controller::Builtin(parameters) => Some(Builtin::new(parameters)),
            Controller::Topics { .. } => None,
        };
        Self { builtin, outside }
    }

    /// Only what `outside` says, whatever `scene` asks for.
    pub fn from_outside(outside: Vec<Box<dyn Source>>) -> Self {
        Self { builtin: None, outside }
    }

    /// Commands for the next tick. Those from outside come last, so that a person can overrule
    /// the built-in controller.
    pub fn drain(&mut self, seen: &Snapshot) -> Vec<Command> {
        let mut commands = self.builtin.as_mut().map(|it| it.decide(seen)).unwrap_or_default();
        commands.extend(self.outside.iter_mut().flat_map(|source| source.drain(seen)));
        commands
    }

    /// The world is at its start again: so is the built-in controller.
    pub fn restart(&mut self) {
        if let Some(builtin) = &mut self.builtin {
            builtin.machine = PickAndLift::new(&builtin.parameters);
        }
    }

    /// Another scene has been loaded: what was commanded before is not for it. The built-in controller
    /// goes by its numbers, if it has some.
    pub fn scene_loaded(&mut self, scene: &Scene, seen: &Snapshot) {
        for source in &mut self.outside {
            drop(source.drain(seen));
        }
        if let (Some(builtin), Controller::Builtin(parameters)) =
            (&mut self.builtin, &scene.controller)
        {
            *builtin = Builtin::new(parameters);
        }
    }

    /// What the built-in controller is doing.
    pub fn phase(&self) -> Option<Phase> {
        self.builtin.as_ref().map(|it| it.machine.phase())
    }

    /// True when the built-in controller has finished.
    pub fn is_done(&self) -> bool {
        self.builtin.as_ref().is_some_and(|it| it.machine.is_done())
    }

    /// True if the run must wait for a first command.
    pub fn is_waiting(&self) -> bool {
        self.builtin.is_none() && !self.outside.iter().any(|source| source.has_received())
    }

    /// What became of the messages from outside, source by source.
    pub fn counters(&self) -> Vec<(&'static str, SourceCounters)> {
        self.outside.iter().map(|source| (source.name(), source.counters())).collect()
    }
}

impl Builtin {
    fn new(parameters: &scene::PickAndLift) -> Self {
        Self { machine: PickAndLift::new(parameters), parameters: parameters.clone() }
    }

    fn decide(&mut self, seen: &Snapshot) -> Vec<Command> {
        let found = seen.objects.iter().find(|it| it.name == self.parameters.object);
        let Some(object) = found else { return Vec::new() };
        self.machine.decide(&Observation {
            time_s: Duration::from_nanos(seen.time_ns).as_secs_f64(),
            flange_pose: seen.flange.pose,
            contact_force: seen.contact_wrench.force,
            gauge_pa: seen.chamber.gauge,
            object_pose: object.body.pose,
        })
    }
}
