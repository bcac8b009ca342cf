//! The simulator as ROS 2 users know it: the services and the action of `simulation_interfaces`, and
//! those of grippers.
//!
//! Questions are answered between two ticks, from the snapshot of the last one; what they change goes
//! to the world as plain values. Nothing here knows a socket, a clock or a thread, so a test asks
//! it directly.
//!
//! Where the standard contradicts itself: a stopped simulation may be paused, as the comment on its
//! states says; a step of a simulation that is not paused is `RESULT_OPERATION_FAILED`, as
//! the service's comment says. A name filter may match anywhere in a name, as POSIX expressions do.

mod bounds; // bounding volumes of entities
mod entities; // the entities of the world
mod entity_info; // category, tags, description
mod filters; // entity filters
mod goals; // actions
mod gripper; // vacuum gripper interfaces
mod named_poses; // named poses
mod parameters; // ROS 2 parameters
mod running; // states, steps, resets
pub mod services; // the closed list of services
mod spawning; // spawns and deletes objects
mod worlds; // loads and unloads worlds

use std::{
    cell::RefCell,
    path::{Path, PathBuf},
    sync::Arc,
};

use serde::{Serialize, de::DeserializeOwned};
pub use services::{Endpoint, Service, asked};

use self::{entity_info::Register, goals::Goals, gripper::Grip, running::Running, worlds::Loading};
use crate::{
    base::real::Twist,
    command::{Command, change::Change},
    cosim::refused::ChangeError,
    io::server::{Outgoing, RequestId, ServiceRequest},
    physics::boundary::shape::Aabb,
    scene::{Scene, resource::Shelf},
    snapshot::Snapshot,
    wire::{
        cdr::Cdr,
        messages::simulation_interfaces::{
            Resource, Result as SimResult, Spawnable, WorldResource,
        },
    },
};

/// What can be looked at and changed between two ticks.
pub trait Subject {
    /// A copy of what the outside may see, with all large parts.
    fn look(&self) -> Snapshot;

    /// Changes the world.
    ///
    /// # Errors
    /// If the change cannot be made; nothing is changed then.
    fn change(&mut self, change: &Change) -> Result<(), ChangeError>;
}

/// The world between two ticks.
pub struct World<'a> {
    /// The thing itself.
    pub subject: &'a mut dyn Subject,
    /// How it was at the end of the last tick.
    pub seen: &'a Snapshot,
}

/// Which of the two wire formats of `simulation_interfaces` is answered in where they differ.
/// Questions are understood in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// 1.x: Humble, Jazzy, Kilted.
    One,
    /// 2.x.
    #[default]
    Two,
}

/// What questions have done to the world since the last look.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changed {
    /// What was changed, in this order.
    pub changes: Vec<Change>,
    /// Simulated time is zero again.
    pub is_time_reset: bool,
    /// The state is that of the start again.
    pub is_state_reset: bool,
    /// It is another scene.
    pub is_scene_loaded: bool,
}

/// The simulator.
pub struct Simulator {
    scene: Arc<Scene>,
    /// Where it is from, and the folder that others are looked for in.
    resource: Resource,
    folder: PathBuf,
    version: Version,
    asked: Vec<Endpoint>,
    running: Running,
    register: Register,
    goals: Goals,
    grip: Option<Grip>,
    /// Lists that were made, and of what.
    spawnables: Option<(Shelf, Vec<Spawnable>)>,
    worlds: Option<(Shelf, Vec<WorldResource>)>,
    /// A scene that someone waits for, and the same until it is handed on.
    loading: Option<Loading>,
    wanted: Option<Scene>,
    is_monotonic: bool,
    /// Velocities at the ends of the last two ticks, with their times (ns).
    twists: [(u64, Vec<(String, Twist)>); 2],
    out: Vec<Outgoing>,
    commands: Vec<Command>,
    changed: Changed,
    /// Extent of the bag at a time and digest, once someone asked.
    bag: RefCell<Option<((u64, u64), Aabb)>>,
}

/// Why a question has no answer.
type Unreadable = cdr_encoding::Error;

impl Simulator {
    /// A simulator of `scene` that is asked by `asked`, in the order of the services offered. If it is
    /// stopped, it stands still until a first command or until it is told to play.
    pub fn new(scene: &Arc<Scene>, asked: Vec<Endpoint>, is_stopped: bool) -> Self {
        Self {
            scene: Arc::clone(scene),
            resource: Resource::default(),
            folder: PathBuf::new(),
            version: Version::default(),
            asked,
            running: Running::new(is_stopped),
            register: Register::new(scene),
            goals: Goals::default(),
            grip: None,
            spawnables: None,
            worlds: None,
            loading: None,
            wanted: None,
            is_monotonic: scene.outputs.ros.monotonic_clock,
            twists: Default::default(),
            out: Vec::new(),
            commands: Vec::new(),
            changed: Changed::default(),
            bag: RefCell::new(None),
        }
    }

    /// The scene, with the parameters as they are now.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Answers in this version.
    pub fn speaking(self, version: Version) -> Self {
        Self { version, ..self }
    }

    /// The scene is from this file; others are looked for beside it.
    pub fn beside(self, file: &Path) -> Self {
        let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        let folder = file.parent().map_or_else(PathBuf::new, Path::to_owned);
        let uri = format!("file://{}", file.display());
        Self { resource: Resource { uri, resource_string: String::new() }, folder, ..self }
    }

    /// Answers a question, now or later.
    ///
    /// # Errors
    /// If the question cannot be read; there is no answer then.
    pub fn handle_requests(
        &mut self,
        call: &ServiceRequest,
        world: &mut World<'_>,
    ) -> Result<(), String> {
        let Some(asked) = self.asked.get(call.asker.offer).copied() else { return Ok(()) };
        let answer = self
            .answer(asked, call, world)
            .map_err(|fault| format!("{}: {fault}", asked.name()))?;
        if let Some(body) = answer {
            self.out.push(Outgoing::Response(call.asker.clone(), body));
        }
        Ok(())
    }

    fn answer(
        &mut self,
        asked: Endpoint,
        call: &ServiceRequest,
        world: &mut World<'_>,
    ) -> Result<Option<Cdr>, Unreadable> {
        let (body, asker) = (&call.body, &call.asker);
        let ask = match asked {
            Endpoint::Service(ask) => ask,
            Endpoint::SendGoal(action) => {
                return self.send_goal(action, body, world.seen).map(Some);
            }
            Endpoint::CancelGoal(action) => {
                return self.cancel_goals(action, body, world.seen).map(Some);
            }
            Endpoint::GetResult(action) => return self.get_result(action, body, asker),
        };
        let answer = match ask {
            Service::GetSimulatorFeatures => Cdr::of(&self.features()),
            Service::GetSimulationState => Cdr::of(&self.simulation_state()),
            Service::SetSimulationState => reply(body, |it| self.set_simulation_state(&it, world))?,
            Service::ResetSimulation => reply(body, |it| self.reset_simulation(&it, world))?,
            Service::StepSimulation => return self.step_simulation(body, asker),
            Service::GetEntities => reply(body, |it| self.get_entities(&it, world))?,
            Service::GetEntitiesStates => reply(body, |it| self.get_entities_states(&it, world))?,
            Service::GetEntityState => reply(body, |it| self.get_entity_state(&it, world))?,
            Service::SetEntityState => {
                let request = entities::read_set_entity_state(body)?;
                Cdr::of(&self.set_entity_state(&request, world))
            }
            Service::GetEntityInfo => reply(body, |it| self.get_entity_info(&it, world))?,
            Service::SetEntityInfo => reply(body, |it| self.set_entity_info(it, world))?,
            Service::GetEntityBounds => reply(body, |it| self.get_entity_bounds(&it, world))?,
            Service::SpawnEntity => reply(body, |it| self.spawn_entity(it, world))?,
            Service::SpawnEntities => reply(body, |it| self.spawn_entities(&it, world))?,
            Service::DeleteEntity => reply(body, |it| self.delete_entity(&it, world))?,
            Service::GetSpawnables => self.get_spawnables(&body.read()?),
            Service::GetNamedPoses => reply(body, |it| self.get_named_poses(&it))?,
            Service::GetNamedPoseBounds => reply(body, |it| self.get_named_pose_bounds(&it))?,
            Service::LoadWorld => return self.load_world(body, asker),
            Service::UnloadWorld => Cdr::of(&self.unload_world()),
            Service::GetCurrentWorld => Cdr::of(&self.get_current_world()),
            Service::GetAvailableWorlds => reply(body, |it| self.get_available_worlds(&it))?,
            Service::GripCommand => reply(body, |it| self.grip_command(&it))?,
            Service::DescribeParameters => reply(body, |it| self.describe_parameters(&it))?,
            Service::GetParameters => reply(body, |it| self.get_parameters(&it))?,
            Service::GetParameterTypes => reply(body, |it| self.get_parameter_types(&it))?,
            Service::ListParameters => reply(body, |it| self.list_parameters(&it))?,
            Service::SetParameters => reply(body, |it| self.set_parameters(&it, world))?,
            Service::SetParametersAtomically => {
                reply(body, |it| self.set_parameters_atomically(&it, world))?
            }
            Service::ZeroForceSensor => Cdr::of(&self.zero_force_sensor(world)),
        };
        Ok(Some(answer))
    }

    /// True if the next tick may begin.
    pub fn may_tick(&self) -> bool {
        self.running.may_tick()
    }

    /// True while steps are made that someone waits for.
    pub fn is_stepping(&self) -> bool {
        self.running.is_stepping()
    }

    /// True once someone has asked the simulator to quit.
    pub fn is_quitting(&self) -> bool {
        self.running.is_quitting()
    }

    /// True until a first command or a question has moved it out of its first stop.
    pub fn is_waiting(&self) -> bool {
        self.running.is_waiting()
    }

    /// A first command has come: a simulator that waited for it plays.
    pub fn first_command(&mut self) {
        self.running.first_command();
    }

    /// A tick has ended.
    pub fn ticked(&mut self, seen: &Snapshot) {
        self.twists.swap(0, 1);
        self.twists[1] = (seen.time_ns, entities::twists(seen));
        self.steps_ticked();
        self.grip_ticked(seen);
    }

    /// Stops time where it is.
    pub fn pause(&mut self) {
        self.running.pause();
    }

    /// True if there are some.
    pub fn has_commands(&self) -> bool {
        !self.commands.is_empty()
    }

    /// Commands that questions have led to.
    pub fn take_commands(&mut self) -> Vec<Command> {
        std::mem::take(&mut self.commands)
    }

    /// What is to leave.
    pub fn take_out(&mut self) -> Vec<Outgoing> {
        std::mem::take(&mut self.out)
    }

    /// How the world is not the one of the last tick any more; asking clears it.
    pub fn take_changed(&mut self) -> Changed {
        std::mem::take(&mut self.changed)
    }

    fn send_answer<T: Serialize>(&mut self, asker: RequestId, answer: &T) {
        self.out.push(Outgoing::Response(asker, Cdr::of(answer)));
    }

    /// True if there is a scene that can be asked about and changed.
    fn has_world(&self) -> bool {
        self.running.has_world()
    }

    fn change(&mut self, change: &Change, world: &mut World<'_>) -> Result<(), ChangeError> {
        if !self.has_world() {
            return Err(ChangeError::NoScene);
        }
        self.apply(change, world)
    }

    fn apply(&mut self, change: &Change, world: &mut World<'_>) -> Result<(), ChangeError> {
        let changed = world.subject.change(change);
        if changed.is_ok() {
            self.changed.changes.push(change.clone());
            if let Change::Reset(scope) = change {
                self.changed.is_time_reset |= scope.time;
                self.changed.is_state_reset |= scope.state;
                self.twists = Default::default();
            }
            if let Change::LoadScene(settled) = change {
                self.changed.is_time_reset |= !settled.keeps_time;
                self.changed.is_state_reset = true;
                self.changed.is_scene_loaded = true;
                self.twists = Default::default();
            }
        }
        changed
    }
}

fn reply<Q: DeserializeOwned, A: Serialize>(
    body: &Cdr,
    answer: impl FnOnce(Q) -> A,
) -> Result<Cdr, Unreadable> {
    body.read::<Q>().map(|question| Cdr::of(&answer(question)))
}

/// All went well.
fn ok() -> SimResult {
    SimResult { result: SimResult::RESULT_OK, error_message: String::new() }
}

/// It did not.
fn failed(result: u8, why: impl std::fmt::Display) -> SimResult {
    SimResult { result, error_message: why.to_string() }
}
