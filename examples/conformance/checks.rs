//! The list of checks, each with the features that it is about.

use jamgrip::wire::messages::simulation_interfaces::{
    GetSimulatorFeaturesRequest, SimulatorFeatures as F, srv::GetSimulatorFeatures,
};

use crate::{
    client::{Client, ensure},
    entities, running, spawning, worlds,
};

/// What came of a check.
pub(crate) struct Outcome {
    /// Name of the check.
    pub(crate) name: &'static str,
    /// Passed or not.
    pub(crate) verdict: Verdict,
}

/// Passed or not.
pub(crate) enum Verdict {
    /// It did.
    Passed,
    /// The simulator does not advertise what it is about.
    Skipped,
    /// It did not.
    Failed(String),
}

/// A check: its name, the features it needs, what it does.
pub(crate) type Check = (&'static str, &'static [u8], fn(&mut Client) -> Result<(), String>);

const CHECKS: &[Check] = &[
    ("states: read", &[F::SIMULATION_STATE_GETTING], running::state_is_read),
    (
        "states: play, pause, stop",
        &[F::SIMULATION_STATE_SETTING, F::SIMULATION_STATE_PAUSE, F::SIMULATION_STATE_GETTING],
        running::states_follow,
    ),
    ("states: what is refused", &[F::SIMULATION_STATE_SETTING], running::states_are_refused),
    ("pause: the clock stands still", &[F::SIMULATION_STATE_PAUSE], running::pause_holds),
    ("steps: one is one tick", &[F::STEP_SIMULATION_SINGLE], running::one_step),
    ("steps: many are as many ticks", &[F::STEP_SIMULATION_MULTIPLE], running::many_steps),
    ("steps: refused unless paused", &[F::STEP_SIMULATION_SINGLE], running::steps_need_pause),
    ("steps: an action with feedback", &[F::STEP_SIMULATION_ACTION], running::action_steps),
    ("steps: an action is cancelled", &[F::STEP_SIMULATION_ACTION], running::action_is_cancelled),
    ("steps: an action is refused", &[F::STEP_SIMULATION_ACTION], running::action_is_refused),
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
        entities::filtered_by_place,
    ),
    ("entities: states agree", &[F::ENTITY_STATE_GETTING], entities::states_agree),
    ("entities: an unknown one", &[F::ENTITY_STATE_GETTING], entities::unknown),
    (
        "entities: pose and twist are set",
        &[F::ENTITY_STATE_SETTING, F::ENTITY_STATE_GETTING],
        entities::state_is_set,
    ),
    (
        "entities: senseless states are refused",
        &[F::ENTITY_STATE_SETTING],
        entities::senseless_states,
    ),
    (
        "entities: information is set",
        &[F::ENTITY_INFO_GETTING, F::ENTITY_INFO_SETTING],
        entities::info_is_set,
    ),
    ("entities: bounds", &[F::ENTITY_BOUNDS], entities::bounds),
    ("reset: time", &[F::SIMULATION_RESET_TIME], running::reset_time),
    ("reset: state", &[F::SIMULATION_RESET_STATE, F::ENTITY_STATE_GETTING], running::reset_state),
    (
        "spawn: in, moved, out",
        &[F::SPAWNING, F::DELETING, F::SPAWNING_RESOURCE_STRING],
        spawning::in_and_out,
    ),
    (
        "spawn: a mesh and its convex hull",
        &[F::SPAWNING, F::DELETING, F::SPAWNING_RESOURCE_STRING, F::ENTITY_BOUNDS_CONVEX],
        spawning::convex_hull,
    ),
    ("spawn: what is refused", &[F::SPAWNING, F::SPAWNING_RESOURCE_STRING], spawning::refused),
    ("spawn: many at once", &[F::SPAWNING_ENTITIES, F::SPAWNING_RESOURCE_STRING], spawning::many),
    ("spawn: what is there to spawn", &[F::SPAWNABLES, F::SPAWNING], spawning::spawnables),
    (
        "spawn: gone after a reset",
        &[F::SPAWNING, F::SPAWNING_RESOURCE_STRING, F::SIMULATION_RESET_SPAWNED],
        spawning::gone_after_reset,
    ),
    ("named poses", &[F::NAMED_POSES, F::POSE_BOUNDS], spawning::named_poses),
    ("worlds: the present one", &[F::WORLD_INFO_GETTING], worlds::current_world),
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
        "worlds: what is refused",
        &[F::WORLD_LOADING, F::WORLD_RESOURCE_STRING, F::WORLD_INFO_GETTING],
        worlds::refused,
    ),
    (
        "worlds: each in turn",
        &[F::WORLD_LOADING, F::AVAILABLE_WORLDS, F::WORLD_INFO_GETTING],
        worlds::others_loaded,
    ),
    ("reset: what was spawned", &[F::SIMULATION_RESET_SPAWNED], entities::reset_spawned),
    ("reset: everything, twice the same", &[F::SIMULATION_RESET], running::reset_all),
];

/// Runs all of them.
pub(crate) fn all(client: &mut Client) -> Result<Vec<Outcome>, String> {
    let answer = client.ask::<GetSimulatorFeatures>(
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
            outcomes.push(Outcome { name, verdict: Verdict::Skipped });
        }
    }
    let tried = CHECKS.iter().flat_map(|(_, needs, _)| needs.iter().map(|it| u16::from(*it)));
    let tried: Vec<u16> = tried.chain([F::ENTITY_BOUNDS_BOX.into()]).collect();
    let untried: Vec<_> = features.iter().filter(|it| !tried.contains(it)).collect();
    let is_complete = ensure(untried.is_empty(), || format!("no check for features {untried:?}"));
    outcomes.push(outcome("features: all were tried", is_complete));
    Ok(outcomes)
}

fn outcome(name: &'static str, result: Result<(), String>) -> Outcome {
    Outcome { name, verdict: result.map_or_else(Verdict::Failed, |()| Verdict::Passed) }
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
