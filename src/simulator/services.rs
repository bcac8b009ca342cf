//! The list of services and actions, with their names and types.

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

/// The services.
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

/// The actions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// `simulation_interfaces/SimulateSteps`: many steps, with feedback.
    SimulateSteps,
    /// `control_msgs/GripperCommand`.
    Gripper,
    /// `control_msgs/ParallelGripperCommand`.
    ParallelGripper,
}

/// What a DDS service is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// A service.
    Service(Service),
    /// The hidden service of an action that receives goals.
    SendGoal(Action),
    /// The hidden service of an action that cancels goals.
    CancelGoal(Action),
    /// The hidden service of an action that returns results.
    GetResult(Action),
}

/// Services with their names relative to the node, and types.
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
    /// Name of the service or action, for log messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Service(service) => {
                SERVICES.iter().find(|it| it.0 == service).map_or("", |it| it.1)
            }
            Self::SendGoal(action) | Self::CancelGoal(action) | Self::GetResult(action) => {
                ACTIONS.iter().find(|it| it.0 == action).map_or("", |it| it.1)
            }
        }
    }
}

/// All services of `node`, with what each is for. The standard ones are repeated under `prefix`.
pub fn endpoints(node: &str, prefix: Option<&str>) -> (Vec<ServiceSpec>, Vec<Endpoint>) {
    let mut specs = Vec::new();
    let mut endpoints = Vec::new();
    let mut add = |name: String, service_type, endpoint| {
        specs.push(ServiceSpec { name, service_type });
        endpoints.push(endpoint);
    };
    for namespace in std::iter::once(node).chain(prefix) {
        let is_standard = |service_type: &ServiceType| {
            namespace == node || service_type.name.starts_with("simulation_interfaces/")
        };
        for (service, name, service_type) in SERVICES.into_iter().filter(|it| is_standard(&it.2)) {
            add(format!("{namespace}/{name}"), service_type, Endpoint::Service(service));
        }
        for (action, name, types) in ACTIONS {
            let hidden = format!("{namespace}/{name}/_action");
            add(format!("{hidden}/send_goal"), types.send_goal, Endpoint::SendGoal(action));
            add(format!("{hidden}/cancel_goal"), CancelGoal::TYPE, Endpoint::CancelGoal(action));
            add(format!("{hidden}/get_result"), types.get_result, Endpoint::GetResult(action));
        }
    }
    (specs, endpoints)
}

/// Topics for feedback and status of all actions, in this order, in each namespace; the last one is
/// `/parameter_events`.
pub fn action_topics(node: &str, prefix: Option<&str>) -> Vec<TopicSpec> {
    let mut topics = Vec::new();
    for namespace in std::iter::once(node).chain(prefix) {
        for (_, name, types) in ACTIONS {
            let hidden = format!("{namespace}/{name}/_action");
            topics.push(TopicSpec {
                name: format!("{hidden}/feedback"),
                dds_name: types.feedback_dds_name.to_owned(),
                is_latched: false,
            });
            topics.push(TopicSpec {
                name: format!("{hidden}/status"),
                dds_name: "action_msgs::msg::dds_::GoalStatusArray_".to_owned(),
                is_latched: true,
            });
        }
    }
    topics.push(TopicSpec {
        name: "/parameter_events".to_owned(),
        dds_name: "rcl_interfaces::msg::dds_::ParameterEvent_".to_owned(),
        is_latched: false,
    });
    topics
}

/// Index of the topic `/parameter_events`.
pub(super) fn parameter_events(n_topics: usize) -> Option<usize> {
    n_topics.checked_sub(1)
}

/// Indices of an action's feedback and status topics, in each namespace.
pub(super) fn topics_of(action: Action, n_topics: usize) -> Vec<[usize; 2]> {
    let index = ACTIONS.iter().position(|it| it.0 == action).unwrap_or(0);
    let per_namespace = 2 * ACTIONS.len();
    (0..n_topics / per_namespace)
        .map(|i| [i * per_namespace + 2 * index, i * per_namespace + 2 * index + 1])
        .collect()
}
