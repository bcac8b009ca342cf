//! The closed list of questions, with the names and types of their services.

use crate::{
    io::server::{ServiceSpec, TopicSpec},
    wire::messages::{
        ActionType, RosAction, RosService, ServiceType,
        action_msgs::srv::CancelGoal,
        control_msgs::action::{GripperCommand, ParallelGripperCommand},
        rcl_interfaces::srv::{
            DescribeParameters, GetParameterTypes, GetParameters, ListParameters, SetParameters,
            SetParametersAtomically,
        },
        simulation_interfaces::{
            action::SimulateSteps,
            srv::{
                DeleteEntity, GetAvailableWorlds, GetCurrentWorld, GetEntities, GetEntitiesStates,
                GetEntityBounds, GetEntityInfo, GetEntityState, GetNamedPoseBounds, GetNamedPoses,
                GetSimulationState, GetSimulatorFeatures, GetSpawnables, LoadWorld,
                ResetSimulation, SetEntityInfo, SetEntityState, SetSimulationState, SpawnEntities,
                SpawnEntity, StepSimulation, UnloadWorld,
            },
        },
        std_srvs::srv::{SetBool, Trigger},
    },
};

/// What may be asked by a service of its own.
#[expect(missing_docs, reason = "named after the services of simulation_interfaces")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Service {
    GetSimulatorFeatures,
    GetSimulationState,
    SetSimulationState,
    ResetSimulation,
    StepSimulation,
    GetEntities,
    GetEntitiesStates,
    GetEntityState,
    SetEntityState,
    GetEntityInfo,
    SetEntityInfo,
    GetEntityBounds,
    SpawnEntity,
    SpawnEntities,
    DeleteEntity,
    GetSpawnables,
    GetNamedPoses,
    GetNamedPoseBounds,
    LoadWorld,
    UnloadWorld,
    GetCurrentWorld,
    GetAvailableWorlds,
    GripCommand,
    ZeroForceSensor,
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
}

/// What may be asked by an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Many steps, with feedback.
    SimulateSteps,
    /// `control_msgs/GripperCommand`.
    Gripper,
    /// `control_msgs/ParallelGripperCommand`.
    ParallelGripper,
}

/// What a service is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// A question of its own.
    Service(Service),
    /// An action's hidden service that takes goals.
    SendGoal(Action),
    /// An action's hidden service that cancels goals.
    CancelGoal(Action),
    /// An action's hidden service that waits for results.
    GetResult(Action),
}

/// Name below the node, type.
const SERVICES: [(Service, &str, ServiceType); 30] = [
    (Service::GetSimulatorFeatures, "get_simulator_features", GetSimulatorFeatures::TYPE),
    (Service::GetSimulationState, "get_simulation_state", GetSimulationState::TYPE),
    (Service::SetSimulationState, "set_simulation_state", SetSimulationState::TYPE),
    (Service::ResetSimulation, "reset_simulation", ResetSimulation::TYPE),
    (Service::StepSimulation, "step_simulation", StepSimulation::TYPE),
    (Service::GetEntities, "get_entities", GetEntities::TYPE),
    (Service::GetEntitiesStates, "get_entities_states", GetEntitiesStates::TYPE),
    (Service::GetEntityState, "get_entity_state", GetEntityState::TYPE),
    (Service::SetEntityState, "set_entity_state", SetEntityState::TYPE),
    (Service::GetEntityInfo, "get_entity_info", GetEntityInfo::TYPE),
    (Service::SetEntityInfo, "set_entity_info", SetEntityInfo::TYPE),
    (Service::GetEntityBounds, "get_entity_bounds", GetEntityBounds::TYPE),
    (Service::SpawnEntity, "spawn_entity", SpawnEntity::TYPE),
    (Service::SpawnEntities, "spawn_entities", SpawnEntities::TYPE),
    (Service::DeleteEntity, "delete_entity", DeleteEntity::TYPE),
    (Service::GetSpawnables, "get_spawnables", GetSpawnables::TYPE),
    (Service::GetNamedPoses, "get_named_poses", GetNamedPoses::TYPE),
    (Service::GetNamedPoseBounds, "get_named_pose_bounds", GetNamedPoseBounds::TYPE),
    (Service::LoadWorld, "load_world", LoadWorld::TYPE),
    (Service::UnloadWorld, "unload_world", UnloadWorld::TYPE),
    (Service::GetCurrentWorld, "get_current_world", GetCurrentWorld::TYPE),
    (Service::GetAvailableWorlds, "get_available_worlds", GetAvailableWorlds::TYPE),
    (Service::GripCommand, "grip_cmd", SetBool::TYPE),
    (Service::ZeroForceSensor, "zero_ftsensor", Trigger::TYPE),
    (Service::DescribeParameters, "describe_parameters", DescribeParameters::TYPE),
    (Service::GetParameters, "get_parameters", GetParameters::TYPE),
    (Service::GetParameterTypes, "get_parameter_types", GetParameterTypes::TYPE),
    (Service::ListParameters, "list_parameters", ListParameters::TYPE),
    (Service::SetParameters, "set_parameters", SetParameters::TYPE),
    (Service::SetParametersAtomically, "set_parameters_atomically", SetParametersAtomically::TYPE),
];

const ACTIONS: [(Action, &str, ActionType); 3] = [
    (Action::SimulateSteps, "simulate_steps", SimulateSteps::TYPE),
    (Action::Gripper, "gripper_cmd", GripperCommand::TYPE),
    (Action::ParallelGripper, "parallel_gripper_cmd", ParallelGripperCommand::TYPE),
];

impl Endpoint {
    /// For messages to people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Service(ask) => SERVICES.iter().find(|it| it.0 == ask).map_or("", |it| it.1),
            Self::SendGoal(action) | Self::CancelGoal(action) | Self::GetResult(action) => {
                ACTIONS.iter().find(|it| it.0 == action).map_or("", |it| it.1)
            }
        }
    }
}

/// All services below `node` and, if there is one, below `prefix` too; and what each is asked for.
pub fn asked(node: &str, prefix: Option<&str>) -> (Vec<ServiceSpec>, Vec<Endpoint>) {
    let mut offers = Vec::new();
    let mut asked = Vec::new();
    let mut offer = |name: String, service_type, what| {
        offers.push(ServiceSpec { name, service_type });
        asked.push(what);
    };
    for place in std::iter::once(node).chain(prefix) {
        let is_standard = |service_type: &ServiceType| {
            place == node || service_type.name.starts_with("simulation_interfaces/")
        };
        for (ask, name, service_type) in SERVICES.into_iter().filter(|it| is_standard(&it.2)) {
            offer(format!("{place}/{name}"), service_type, Endpoint::Service(ask));
        }
        for (action, name, of) in ACTIONS {
            let hidden = format!("{place}/{name}/_action");
            offer(format!("{hidden}/send_goal"), of.send_goal, Endpoint::SendGoal(action));
            offer(format!("{hidden}/cancel_goal"), CancelGoal::TYPE, Endpoint::CancelGoal(action));
            offer(format!("{hidden}/get_result"), of.get_result, Endpoint::GetResult(action));
        }
    }
    (offers, asked)
}

/// Feedback and status of all actions, in this order, below each place; last, changed parameters.
pub fn channels(node: &str, prefix: Option<&str>) -> Vec<TopicSpec> {
    let mut channels = Vec::new();
    for place in std::iter::once(node).chain(prefix) {
        for (_, name, of) in ACTIONS {
            let hidden = format!("{place}/{name}/_action");
            channels.push(TopicSpec {
                name: format!("{hidden}/feedback"),
                dds_name: of.feedback_dds_name.to_owned(),
                is_latched: false,
            });
            channels.push(TopicSpec {
                name: format!("{hidden}/status"),
                dds_name: "action_msgs::msg::dds_::GoalStatusArray_".to_owned(),
                is_latched: true,
            });
        }
    }
    channels.push(TopicSpec {
        name: "/parameter_events".to_owned(),
        dds_name: "rcl_interfaces::msg::dds_::ParameterEvent_".to_owned(),
        is_latched: false,
    });
    channels
}

/// Index of the channel of changed parameters.
pub(super) fn parameter_events(n_channels: usize) -> Option<usize> {
    n_channels.checked_sub(1)
}

/// Indices of an action's channels: feedback and status, below each of `n_places` places.
pub(super) fn channels_of(action: Action, n_channels: usize) -> Vec<[usize; 2]> {
    let place = ACTIONS.iter().position(|it| it.0 == action).unwrap_or(0);
    let per_place = 2 * ACTIONS.len();
    (0..n_channels / per_place)
        .map(|i| [i * per_place + 2 * place, i * per_place + 2 * place + 1])
        .collect()
}
