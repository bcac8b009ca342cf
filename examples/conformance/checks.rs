//! The list of checks, with the features that each of them covers.

use jamgrip::wire::messages::simulation_interfaces::{
    GetSimulatorFeaturesRequest, SimulatorFeatures as F, srv::GetSimulatorFeatures,
};

use crate::{
    client::{Client, ensure},
    entities, run_state, spawning, worlds,
};

/// The outcome of a check.
pub(crate) struct Outcome {
    /// Name of the check.
    pub(crate) name: &'static str,
    /// The result of the check.
    pub(crate) result: CheckResult,
}

/// The result of a check.
pub(crate) enum CheckResult {
    /// It passed.
    Passed,
    /// The simulator does not advertise the features.
    Skipped,
    /// It failed, with the reason.
    Failed(String),
}

/// A check: its name, the features it needs, and the function that runs it.
pub(crate) type Check = (&'static str, &'static [u8], fn(&mut Client) -> Result<(), String>);

const CHECKS: &[Check] = &[
    ("states: read", &[F::SIMULATION_STATE_GETTING], run_state::state_is_read),
    (
        "states: play, pause, stop",
        &[F::SIMULATION_STATE_SETTING, F::SIMULATION_STATE_PAUSE, F::SIMULATION_STATE_GETTING],
        run_state::states_follow,
    ),
    (
        "states: invalid requests are rejected",
        &[F::SIMULATION_STATE_SETTING],
        run_state::invalid_states_are_rejected,
    ),
    ("pause: the clock stops", &[F::SIMULATION_STATE_PAUSE], run_state::pause_holds),
    ("steps: one is one tick", &[F::STEP_SIMULATION_SINGLE], run_state::one_step),
    ("steps: n are n ticks", &[F::STEP_SIMULATION_MULTIPLE], run_state::many_steps),
    ("steps: rejected unless paused", &[F::STEP_SIMULATION_SINGLE], run_state::steps_need_pause),
    ("steps: an action with feedback", &[F::STEP_SIMULATION_ACTION], run_state::action_steps),
    ("steps: an action is canceled", &[F::STEP_SIMULATION_ACTION], run_state::action_is_canceled),
    ("steps: an action is rejected", &[F::STEP_SIMULATION_ACTION], run_state::action_is_rejected),
    ("entities: listed once each", &[], entities::listed),
    ("entities: filtered by name", &[], entities::filtered_by_name),
    ("entities: filtered by category", &[F::ENTITY_CATEGORIES], entities::filtered_by_category),
    (
        "entities: filtered by tags",
        &[F::ENTITY_TAGS, F::ENTITY_INFO_SETTING],
        entities::filtered_by_tags,
    ),
    (
        "entities: filtered by a sphere",
        &[F::ENTITY_STATE_GETTING, F::ENTITY_BOUNDS],
        entities::filtered_by_sphere,
    ),
    ("entities: states agree", &[F::ENTITY_STATE_GETTING], entities::states_agree),
    ("entities: an unknown one", &[F::ENTITY_STATE_GETTING], entities::unknown),
    (
        "entities: pose and twist are set",
        &[F::ENTITY_STATE_SETTING, F::ENTITY_STATE_GETTING],
        entities::state_is_set,
    ),
    ("entities: invalid states are rejected", &[F::ENTITY_STATE_SETTING], entities::invalid_states),
    (
        "entities: information is set",
        &[F::ENTITY_INFO_GETTING, F::ENTITY_INFO_SETTING],
        entities::info_is_set,
    ),
    ("entities: bounds", &[F::ENTITY_BOUNDS], entities::bounds),
    ("reset: time", &[F::SIMULATION_RESET_TIME], run_state::reset_time),
    ("reset: state", &[F::SIMULATION_RESET_STATE, F::ENTITY_STATE_GETTING], run_state::reset_state),
    (
        "spawn: spawned, moved, deleted",
        &[F::SPAWNING, F::DELETING, F::SPAWNING_RESOURCE_STRING],
        spawning::spawned_and_deleted,
    ),
    (
        "spawn: a mesh and its convex hull",
        &[F::SPAWNING, F::DELETING, F::SPAWNING_RESOURCE_STRING, F::ENTITY_BOUNDS_CONVEX],
        spawning::convex_hull,
    ),
    (
        "spawn: invalid requests are rejected",
        &[F::SPAWNING, F::SPAWNING_RESOURCE_STRING],
        spawning::rejected,
    ),
    ("spawn: many at once", &[F::SPAWNING_ENTITIES, F::SPAWNING_RESOURCE_STRING], spawning::many),
    ("spawn: list of spawnables", &[F::SPAWNABLES, F::SPAWNING], spawning::spawnables),
    (
        "spawn: deleted by a reset",
        &[F::SPAWNING, F::SPAWNING_RESOURCE_STRING, F::SIMULATION_RESET_SPAWNED],
        spawning::deleted_by_reset,
    ),
    ("named poses", &[F::NAMED_POSES, F::POSE_BOUNDS], spawning::named_poses),
    ("worlds: the current one", &[F::WORLD_INFO_GETTING], worlds::current_world),
    ("worlds: others, by tags", &[F::AVAILABLE_WORLDS, F::WORLD_TAGS], worlds::available_worlds),
    (
        "worlds: unloaded, and loaded again",
        &[F::WORLD_LOADING, F::WORLD_UNLOADING, F::WORLD_INFO_GETTING, F::SIMULATION_STATE_GETTING],
        worlds::unloaded_and_loaded,
    ),
    (
        "worlds: loaded from a text",
        &[F::WORLD_LOADING, F::WORLD_RESOURCE_STRING, F::WORLD_INFO_GETTING],
        worlds::loaded_from_text,
    ),
    (
        "worlds: invalid requests are rejected",
        &[F::WORLD_LOADING, F::WORLD_RESOURCE_STRING, F::WORLD_INFO_GETTING],
        worlds::rejected,
    ),
    (
        "worlds: each in turn",
        &[F::WORLD_LOADING, F::AVAILABLE_WORLDS, F::WORLD_INFO_GETTING],
        worlds::others_loaded,
    ),
    ("reset: what was spawned", &[F::SIMULATION_RESET_SPAWNED], entities::reset_spawned),
    ("reset: everything, with equal results", &[F::SIMULATION_RESET], run_state::reset_all),
];

/// Runs all checks.
pub(crate) fn all(client: &mut Client) -> Result<Vec<Outcome>, String> {
    let answer = client.call::<GetSimulatorFeatures>(
        "get_simulator_features",
        &GetSimulatorFeaturesRequest::default(),
    )?;
    let features = answer.features.features;
    let mut outcomes = vec![outcome("features: consistent", consistent(&features))];
    for (name, needs, check) in CHECKS {
        let is_advertised = needs.iter().all(|it| features.contains(&u16::from(*it)));
        if is_advertised {
            outcomes.push(outcome(name, check(client)));
        } else {
            outcomes.push(Outcome { name, result: CheckResult::Skipped });
        }
    }
    let covered = CHECKS.iter().flat_map(|(_, needs, _)| needs.iter().map(|it| u16::from(*it)));
    let covered: Vec<u16> = covered.chain([F::ENTITY_BOUNDS_BOX.into()]).collect();
    let uncovered: Vec<_> = features.iter().filter(|it| !covered.contains(it)).collect();
    let is_complete =
        ensure(uncovered.is_empty(), || format!("no check for features {uncovered:?}"));
    outcomes.push(outcome("features: all are covered", is_complete));
    Ok(outcomes)
}

fn outcome(name: &'static str, result: Result<(), String>) -> Outcome {
    Outcome { name, result: result.map_or_else(CheckResult::Failed, |()| CheckResult::Passed) }
}

fn consistent(features: &[u16]) -> Result<(), String> {
    let has = |it: u8| features.contains(&u16::from(it));
    let mut sorted = features.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    ensure(sorted.len() == features.len(), || "a feature is listed twice".to_owned())?;
    let implied = [
        (F::ENTITY_BOUNDS_BOX, F::ENTITY_BOUNDS),
        (F::ENTITY_BOUNDS_CONVEX, F::ENTITY_BOUNDS),
        (F::SIMULATION_RESET_TIME, F::SIMULATION_RESET),
        (F::SIMULATION_RESET_STATE, F::SIMULATION_RESET),
        (F::SIMULATION_RESET_SPAWNED, F::SIMULATION_RESET),
        (F::SIMULATION_STATE_PAUSE, F::SIMULATION_STATE_SETTING),
        (F::STEP_SIMULATION_MULTIPLE, F::STEP_SIMULATION_SINGLE),
        (F::SPAWNING_RESOURCE_STRING, F::SPAWNING),
        (F::WORLD_RESOURCE_STRING, F::WORLD_LOADING),
    ];
    for (feature, needs) in implied {
        ensure(!has(feature) || has(needs), || format!("feature {feature} without {needs}"))?;
    }
    Ok(())
}
