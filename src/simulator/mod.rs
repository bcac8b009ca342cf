//! The simulator as seen from ROS 2: the services and the action of `simulation_interfaces`,
//! and those of vacuum grippers.
//!
//! Requests are handled between two ticks, from the snapshot of the last tick. Changes go to the
//! world as plain values. This module uses no sockets, clocks or threads, so tests can call it
//! directly.
//!
//! Where the standard contradicts itself: a stopped simulation may be paused, as the comment on the
//! states says; stepping a simulation that is not paused is `RESULT_OPERATION_FAILED`, as the
//! comment of the service says. A name filter may match anywhere in a name, as POSIX expressions
//! do.

mod bounds; // bounding volumes of entities
mod entities; // the entities of the world
mod entity_info; // category, tags, description
mod filters; // entity filters
mod goals; // actions
mod gripper; // vacuum gripper interfaces
mod named_poses; // named poses of the scene
mod parameters; // ROS 2 parameters
mod run_state; // playing, paused or stopped; steps and resets
pub mod services; // the list of services
mod spawning; // spawns and deletes objects
mod worlds; // loads and unloads worlds

use std::{
    cell::RefCell,
    path::{Path, PathBuf},
    sync::Arc,
};

use serde::{Serialize, de::DeserializeOwned};
pub use services::{Endpoint, Service, endpoints};

use self::{
    entity_info::EntityTable, goals::Goals, gripper::GripGoal, run_state::RunState, worlds::Loading,
};
use crate::{
    base::real::Twist,
    command::{Command, change::Change},
    cosim::change_error::ChangeError,
    io::server::{Outgoing, RequestId, ServiceRequest},
    physics::boundary::shape::Aabb,
    scene::{Scene, resource::FolderState},
    snapshot::Snapshot,
    wire::{
        cdr::Cdr,
        messages::simulation_interfaces::{
            Resource, Result as SimResult, Spawnable, WorldResource,
        },
    },
};

/// The operations on the world that requests need between two ticks.
pub trait WorldAccess {
    /// A snapshot with all large parts.
    fn full_snapshot(&self) -> Snapshot;

    /// Applies a change.
    ///
    /// # Errors
    /// If the change is impossible; the world is unchanged then.
    fn change(&mut self, change: &Change) -> Result<(), ChangeError>;
}

/// The world between two ticks, and its last snapshot.
pub struct World<'a> {
    /// The world.
    pub access: &'a mut dyn WorldAccess,
    /// The snapshot of the last tick.
    pub snapshot: &'a Snapshot,
}

/// The wire format of responses, where the two versions of `simulation_interfaces` differ. Requests
/// are accepted in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// 1.x: Humble, Jazzy, Kilted.
    One,
    /// 2.x.
    #[default]
    Two,
}

/// What requests have changed since the last call of [`Simulator::take_changed`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changed {
    /// Changes of the world, in order.
    pub changes: Vec<Change>,
    /// True if simulation time was reset to zero.
    pub is_time_reset: bool,
    /// True if the state was reset to the start.
    pub is_state_reset: bool,
    /// True if another scene was loaded.
    pub is_scene_loaded: bool,
}

/// The state of the simulator's services.
pub struct Simulator {
    scene: Arc<Scene>,
    /// Where the scene comes from, and the folder in which others are looked up.
    resource: Resource,
    folder: PathBuf,
    version: Version,
    endpoints: Vec<Endpoint>,
    run_state: RunState,
    entity_table: EntityTable,
    goals: Goals,
    grip: Option<GripGoal>,
    /// Cached lists, with the state of the folders that they were made from.
    spawnables: Option<(FolderState, Vec<Spawnable>)>,
    worlds: Option<(FolderState, Vec<WorldResource>)>,
    /// The request to load a scene, and the scene until it is taken to be settled.
    loading: Option<Loading>,
    scene_to_settle: Option<Scene>,
    is_monotonic: bool,
    /// Velocities at the ends of the last two ticks, with their times (ns).
    twists: [(u64, Vec<(String, Twist)>); 2],
    outgoing: Vec<Outgoing>,
    commands: Vec<Command>,
    changed: Changed,
    /// Extent of membrane and grains, with the time and digest for which it was computed.
    membrane_extent: RefCell<Option<((u64, u64), Aabb)>>,
}

/// The error of a request that cannot be decoded.
type DecodeError = cdr_encoding::Error;

impl Simulator {
    /// Creates a simulator of `scene` with these endpoints, in the order of the services offered.
    /// If `is_stopped`, it waits for a first command or a request to play.
    pub fn new(scene: &Arc<Scene>, endpoints: Vec<Endpoint>, is_stopped: bool) -> Self {
        Self {
            scene: Arc::clone(scene),
            resource: Resource::default(),
            folder: PathBuf::new(),
            version: Version::default(),
            endpoints,
            run_state: RunState::new(is_stopped),
            entity_table: EntityTable::new(scene),
            goals: Goals::default(),
            grip: None,
            spawnables: None,
            worlds: None,
            loading: None,
            scene_to_settle: None,
            is_monotonic: scene.outputs.ros.monotonic_clock,
            twists: Default::default(),
            outgoing: Vec::new(),
            commands: Vec::new(),
            changed: Changed::default(),
            membrane_extent: RefCell::new(None),
        }
    }

    /// The scene, with the current values of the parameters.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Sets the version of responses.
    pub fn with_version(self, version: Version) -> Self {
        Self { version, ..self }
    }

    /// Sets the scene file; other scenes are looked up in its folder.
    pub fn with_scene_file(self, file: &Path) -> Self {
        let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        let folder = file.parent().map_or_else(PathBuf::new, Path::to_owned);
        let uri = format!("file://{}", file.display());
        Self { resource: Resource { uri, resource_string: String::new() }, folder, ..self }
    }

    /// Handles a request. The response is queued now or later.
    ///
    /// # Errors
    /// If the request cannot be decoded; there is no response then.
    pub fn handle_request(
        &mut self,
        request: &ServiceRequest,
        world: &mut World<'_>,
    ) -> Result<(), String> {
        let Some(endpoint) = self.endpoints.get(request.id.service).copied() else { return Ok(()) };
        let response = self
            .respond(endpoint, request, world)
            .map_err(|error| format!("{}: {error}", endpoint.name()))?;
        if let Some(body) = response {
            self.outgoing.push(Outgoing::Response(request.id.clone(), body));
        }
        Ok(())
    }

    fn respond(
        &mut self,
        endpoint: Endpoint,
        request: &ServiceRequest,
        world: &mut World<'_>,
    ) -> Result<Option<Cdr>, DecodeError> {
        let (body, id) = (&request.body, &request.id);
        let service = match endpoint {
            Endpoint::Service(service) => service,
            Endpoint::SendGoal(action) => {
                return self.send_goal(action, body, world.snapshot).map(Some);
            }
            Endpoint::CancelGoal(action) => {
                return self.cancel_goals(action, body, world.snapshot).map(Some);
            }
            Endpoint::GetResult(action) => return self.get_result(action, body, id),
        };
        let response = match service {
            Service::GetSimulatorFeatures => Cdr::of(&self.features()),
            Service::GetSimulationState => Cdr::of(&self.simulation_state()),
            Service::SetSimulationState => {
                respond_to(body, |it| self.set_simulation_state(&it, world))?
            }
            Service::ResetSimulation => respond_to(body, |it| self.reset_simulation(&it, world))?,
            Service::StepSimulation => return self.step_simulation(body, id),
            Service::GetEntities => respond_to(body, |it| self.get_entities(&it, world))?,
            Service::GetEntitiesStates => {
                respond_to(body, |it| self.get_entities_states(&it, world))?
            }
            Service::GetEntityState => respond_to(body, |it| self.get_entity_state(&it, world))?,
            Service::SetEntityState => {
                let request = entities::read_set_entity_state(body)?;
                Cdr::of(&self.set_entity_state(&request, world))
            }
            Service::GetEntityInfo => respond_to(body, |it| self.get_entity_info(&it, world))?,
            Service::SetEntityInfo => respond_to(body, |it| self.set_entity_info(it, world))?,
            Service::GetEntityBounds => respond_to(body, |it| self.get_entity_bounds(&it, world))?,
            Service::SpawnEntity => respond_to(body, |it| self.spawn_entity(it, world))?,
            Service::SpawnEntities => respond_to(body, |it| self.spawn_entities(&it, world))?,
            Service::DeleteEntity => respond_to(body, |it| self.delete_entity(&it, world))?,
            Service::GetSpawnables => self.get_spawnables(&body.read()?),
            Service::GetNamedPoses => respond_to(body, |it| self.get_named_poses(&it))?,
            Service::GetNamedPoseBounds => respond_to(body, |it| self.get_named_pose_bounds(&it))?,
            Service::LoadWorld => return self.load_world(body, id),
            Service::UnloadWorld => Cdr::of(&self.unload_world()),
            Service::GetCurrentWorld => Cdr::of(&self.get_current_world()),
            Service::GetAvailableWorlds => respond_to(body, |it| self.get_available_worlds(&it))?,
            Service::GripCommand => respond_to(body, |it| self.grip_command(&it))?,
            Service::DescribeParameters => respond_to(body, |it| self.describe_parameters(&it))?,
            Service::GetParameters => respond_to(body, |it| self.get_parameters(&it))?,
            Service::GetParameterTypes => respond_to(body, |it| self.get_parameter_types(&it))?,
            Service::ListParameters => respond_to(body, |it| self.list_parameters(&it))?,
            Service::SetParameters => respond_to(body, |it| self.set_parameters(&it, world))?,
            Service::SetParametersAtomically => {
                respond_to(body, |it| self.set_parameters_atomically(&it, world))?
            }
            Service::ZeroForceSensor => Cdr::of(&self.zero_force_sensor(world)),
        };
        Ok(Some(response))
    }

    /// True if the next tick may begin.
    pub fn may_tick(&self) -> bool {
        self.run_state.may_tick()
    }

    /// True while a requested series of steps is running.
    pub fn is_stepping(&self) -> bool {
        self.run_state.is_stepping()
    }

    /// True once a client has requested to quit.
    pub fn is_quitting(&self) -> bool {
        self.run_state.is_quitting()
    }

    /// True until a first command or request ends the initial stop.
    pub fn is_waiting(&self) -> bool {
        self.run_state.is_waiting()
    }

    /// Starts the simulation if it waits for a first command.
    pub fn first_command(&mut self) {
        self.run_state.first_command();
    }

    /// Updates goals and steps after a tick.
    pub fn finish_tick(&mut self, snapshot: &Snapshot) {
        self.twists.swap(0, 1);
        self.twists[1] = (snapshot.time_ns, entities::twists(snapshot));
        self.count_step();
        self.update_grip(snapshot);
    }

    /// Pauses the simulation.
    pub fn pause(&mut self) {
        self.run_state.pause();
    }

    /// True if requests have led to commands that were not taken yet.
    pub fn has_commands(&self) -> bool {
        !self.commands.is_empty()
    }

    /// Takes the commands that requests have led to.
    pub fn take_commands(&mut self) -> Vec<Command> {
        std::mem::take(&mut self.commands)
    }

    /// Takes the responses and messages to send.
    pub fn take_outgoing(&mut self) -> Vec<Outgoing> {
        std::mem::take(&mut self.outgoing)
    }

    /// Takes what requests have changed since the last call.
    pub fn take_changed(&mut self) -> Changed {
        std::mem::take(&mut self.changed)
    }

    fn send_response<T: Serialize>(&mut self, request: RequestId, response: &T) {
        self.outgoing.push(Outgoing::Response(request, Cdr::of(response)));
    }

    /// True if a scene is loaded.
    fn has_world(&self) -> bool {
        self.run_state.has_world()
    }

    fn change(&mut self, change: &Change, world: &mut World<'_>) -> Result<(), ChangeError> {
        if !self.has_world() {
            return Err(ChangeError::NoScene);
        }
        self.apply(change, world)
    }

    fn apply(&mut self, change: &Change, world: &mut World<'_>) -> Result<(), ChangeError> {
        let changed = world.access.change(change);
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

fn respond_to<Q: DeserializeOwned, A: Serialize>(
    body: &Cdr,
    respond: impl FnOnce(Q) -> A,
) -> Result<Cdr, DecodeError> {
    body.read::<Q>().map(|request| Cdr::of(&respond(request)))
}

/// The result of a request that succeeded.
fn ok() -> SimResult {
    SimResult { result: SimResult::RESULT_OK, error_message: String::new() }
}

/// The result of a request that failed.
fn failed(result: u8, reason: impl std::fmt::Display) -> SimResult {
    SimResult { result, error_message: reason.to_string() }
}
