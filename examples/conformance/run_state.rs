//! Checks on states, steps and resets.

use std::time::Duration;

use jamgrip::wire::{
    actions::{GetResultRequest, GetResultResponse, SendGoalRequest, SendGoalResponse},
    cdr::Cdr,
    messages::{
        RosAction, RosService,
        action_msgs::{
            CancelGoalRequest, CancelGoalResponse, GoalInfo, GoalStatus, srv::CancelGoal,
        },
        simulation_interfaces::{
            GetEntityStateRequest, GetSimulationStateRequest, ResetSimulationRequest,
            Result as SimResult, SetSimulationStateRequest, SetSimulationStateResponse,
            SimulateStepsGoal, SimulateStepsResult, SimulationState as S, StepSimulationRequest,
            StepSimulationResponse, action::SimulateSteps, srv,
        },
        unique_identifier_msgs::UUID,
    },
};

use crate::{
    client::{Client, ensure, must_be, must_be_ok, must_fail},
    entities::{movable, pose_of},
};

/// Wall-clock time in which a paused clock must not advance.
const PAUSE_CHECK: Duration = Duration::from_millis(300);

/// The state of the simulation.
pub(crate) fn state(client: &mut Client) -> Result<u8, String> {
    let request = GetSimulationStateRequest::default();
    let response = client.call::<srv::GetSimulationState>("get_simulation_state", &request)?;
    must_be_ok("get_simulation_state", &response.result)?;
    Ok(response.state.state)
}

/// Requests a state.
pub(crate) fn set(client: &mut Client, state: u8) -> Result<SimResult, String> {
    let request = SetSimulationStateRequest { state: S { state } };
    Ok(client.call::<srv::SetSimulationState>("set_simulation_state", &request)?.result)
}

/// Puts the simulation into a state.
pub(crate) fn enter(client: &mut Client, target: u8) -> Result<(), String> {
    if state(client)? != target {
        must_be_ok(&format!("setting state {target}"), &set(client, target)?)?;
    }
    Ok(())
}

/// Steps, and returns the result.
pub(crate) fn step(client: &mut Client, steps: u64) -> Result<SimResult, String> {
    let request = StepSimulationRequest { steps };
    Ok(client.call::<srv::StepSimulation>("step_simulation", &request)?.result)
}

pub(crate) fn reset(client: &mut Client, scope: u8) -> Result<SimResult, String> {
    let request = ResetSimulationRequest { scope };
    Ok(client.call::<srv::ResetSimulation>("reset_simulation", &request)?.result)
}

pub(crate) fn state_is_read(client: &mut Client) -> Result<(), String> {
    let state = state(client)?;
    ensure(state <= S::STATE_LOADING_WORLD, || format!("there is no state {state}"))
}

pub(crate) fn states_follow(client: &mut Client) -> Result<(), String> {
    for target in
        [S::STATE_PLAYING, S::STATE_PAUSED, S::STATE_PLAYING, S::STATE_STOPPED, S::STATE_PLAYING]
    {
        enter(client, target)?;
        let found = state(client)?;
        ensure(found == target, || format!("state {found} after setting {target}"))?;
        let again = set(client, target)?;
        must_be(
            "the same state again",
            &again,
            SetSimulationStateResponse::ALREADY_IN_TARGET_STATE,
        )?;
    }
    let before = client.time_ns()?;
    client.until("the clock to continue", |it| it.time_ns().is_ok_and(|now| now != before))
}

pub(crate) fn invalid_states_are_rejected(client: &mut Client) -> Result<(), String> {
    let before = state(client)?;
    for wrong in [S::STATE_NO_WORLD, S::STATE_LOADING_WORLD, 17, 255] {
        must_fail(&format!("setting state {wrong}"), &set(client, wrong)?)?;
    }
    let after = state(client)?;
    ensure(before == after, || format!("state {after} after a rejected request in state {before}"))
}

pub(crate) fn pause_holds(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PLAYING)?;
    enter(client, S::STATE_PAUSED)?;
    // Messages in transit may still arrive.
    client.idle(PAUSE_CHECK);
    client.take_times();
    client.idle(PAUSE_CHECK);
    let times = client.take_times();
    ensure(times.is_empty(), || format!("the clock continued to {times:?} ns"))
}

/// Pauses the simulation and returns its time.
fn paused(client: &mut Client) -> Result<i64, String> {
    enter(client, S::STATE_PAUSED)?;
    client.idle(PAUSE_CHECK);
    client.take_times();
    client.time_ns()
}

pub(crate) fn one_step(client: &mut Client) -> Result<(), String> {
    let before = paused(client)?;
    let mut spans = Vec::new();
    let mut last = before;
    for _ in 0..5 {
        must_be_ok("step_simulation", &step(client, 1)?)?;
        // Published before the response: it may still be in transit, but nothing may follow it.
        client.until("a tick of the clock", |it| it.time_ns().is_ok_and(|now| now != last))?;
        client.idle(Duration::from_millis(20));
        let times = client.take_times();
        ensure(times.len() == 1, || format!("one step made the clocks {times:?} ns"))?;
        spans.push(times[0] - last);
        last = times[0];
    }
    let is_even = spans.iter().all(|it| 0 < *it && *it == spans[0]);
    ensure(is_even, || format!("steps of {spans:?} ns"))
}

pub(crate) fn many_steps(client: &mut Client) -> Result<(), String> {
    let before = paused(client)?;
    let n = 25;
    must_be_ok("step_simulation", &step(client, n)?)?;
    client.idle(PAUSE_CHECK);
    let times = client.take_times();
    ensure(times.len() as u64 == n, || format!("{n} steps made {} ticks", times.len()))?;
    let mut all = vec![before];
    all.extend(times);
    let spans: Vec<i64> = all.windows(2).map(|it| it[1] - it[0]).collect();
    ensure(spans.iter().all(|it| *it == spans[0]), || format!("steps of {spans:?} ns"))?;
    let after = state(client)?;
    ensure(after == S::STATE_PAUSED, || format!("state {after} after stepping"))
}

pub(crate) fn steps_need_pause(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PLAYING)?;
    let result = step(client, 1)?;
    must_be("a step while playing", &result, SimResult::RESULT_OPERATION_FAILED)?;
    enter(client, S::STATE_PAUSED)
}

fn send_goal(client: &mut Client, id: u8, steps: u64) -> Result<bool, String> {
    let goal_id = UUID { uuid: [id; 16] };
    let request = SendGoalRequest { goal_id, goal: SimulateStepsGoal { steps } };
    let of = SimulateSteps::TYPE.send_goal;
    let response = client.call_raw("simulate_steps/_action/send_goal", of, &Cdr::of(&request))?;
    let response: SendGoalResponse = response.read().map_err(|it| it.to_string())?;
    Ok(response.accepted)
}

const GET_RESULT: &str = "simulate_steps/_action/get_result";

fn request_result(client: &mut Client, id: u8) -> Result<(), String> {
    let request = Cdr::of(&GetResultRequest { goal_id: UUID { uuid: [id; 16] } });
    client.send_raw(GET_RESULT, SimulateSteps::TYPE.get_result, &request)
}

fn result(client: &mut Client) -> Result<GetResultResponse<SimulateStepsResult>, String> {
    client.wait(GET_RESULT)?.read().map_err(|it| it.to_string())
}

pub(crate) fn action_steps(client: &mut Client) -> Result<(), String> {
    paused(client)?;
    let n = 12;
    ensure(send_goal(client, 1, n)?, || "the goal was not accepted".to_owned())?;
    request_result(client, 1)?;
    let ended = result(client)?;
    let is_done = ended.status == GoalStatus::STATUS_SUCCEEDED;
    ensure(is_done, || format!("the goal ended with status {}", ended.status))?;
    must_be_ok("its result", &ended.result.result)?;
    client.idle(PAUSE_CHECK);
    let n_ticks = client.take_times().len() as u64;
    ensure(n_ticks == n, || format!("{n} steps made {n_ticks} ticks"))
}

pub(crate) fn action_is_canceled(client: &mut Client) -> Result<(), String> {
    paused(client)?;
    ensure(send_goal(client, 2, 1_000_000)?, || "the goal was not accepted".to_owned())?;
    request_result(client, 2)?;
    client.idle(Duration::from_millis(100));
    let goal_info = GoalInfo { goal_id: UUID { uuid: [2; 16] }, ..Default::default() };
    let request = Cdr::of(&CancelGoalRequest { goal_info });
    let response =
        client.call_raw("simulate_steps/_action/cancel_goal", CancelGoal::TYPE, &request)?;
    let response: CancelGoalResponse = response.read().map_err(|it| it.to_string())?;
    let n = response.goals_canceling.len();
    ensure(n == 1, || format!("{n} goals are canceled, code {}", response.return_code))?;
    let ended = result(client)?;
    let is_canceled = ended.status == GoalStatus::STATUS_CANCELED;
    ensure(is_canceled, || format!("the goal ended with status {}", ended.status))?;
    client.idle(PAUSE_CHECK);
    client.take_times();
    client.idle(PAUSE_CHECK);
    let times = client.take_times();
    ensure(times.is_empty(), || "the clock continues after canceling".to_owned())
}

pub(crate) fn action_is_rejected(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PLAYING)?;
    if send_goal(client, 3, 1)? {
        // The standard also allows accepting the goal and aborting it.
        request_result(client, 3)?;
        let ended = result(client)?;
        must_be("steps while playing", &ended.result.result, SimResult::RESULT_OPERATION_FAILED)?;
    }
    enter(client, S::STATE_PAUSED)
}

pub(crate) fn reset_time(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    must_be_ok("step_simulation", &step(client, 20)?)?;
    client.idle(PAUSE_CHECK);
    let before = client.time_ns()?;
    must_be_ok("reset_simulation", &reset(client, ResetSimulationRequest::SCOPE_TIME)?)?;
    client.until("an earlier clock", |it| it.time_ns().is_ok_and(|now| now < before))?;
    let after = client.time_ns()?;
    ensure(after < 1_000_000_000, || format!("the clock starts at {after} ns"))
}

pub(crate) fn reset_state(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    must_be_ok("reset_simulation", &reset(client, ResetSimulationRequest::SCOPE_STATE)?)?;
    let Some(name) = movable(client)? else { return Ok(()) };
    let start = pose_of(client, &name)?;
    must_be_ok("step_simulation", &step(client, 5)?)?;
    must_be_ok("reset_simulation", &reset(client, ResetSimulationRequest::SCOPE_STATE)?)?;
    let back = pose_of(client, &name)?;
    ensure(start == back, || format!("`{name}` is at {back:?}, not at {start:?}"))
}

pub(crate) fn reset_all(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    let Some(name) = movable(client)? else { return Ok(()) };
    let mut ends = Vec::new();
    for scope in [ResetSimulationRequest::SCOPE_ALL, ResetSimulationRequest::SCOPE_DEFAULT, 7] {
        must_be_ok(&format!("resetting scope {scope}"), &reset(client, scope)?)?;
        must_be_ok("step_simulation", &step(client, 30)?)?;
        let request = GetEntityStateRequest { entity: name.clone() };
        let response = client.call::<srv::GetEntityState>("get_entity_state", &request)?;
        ends.push(response.state);
    }
    let is_same = ends.iter().all(|it| *it == ends[0]);
    ensure(is_same, || format!("`{name}` ends in different states: {ends:?}"))?;
    must_fail("resetting an unknown scope", &reset(client, 64)?)?;
    let result: StepSimulationResponse = client
        .call_raw("step_simulation", srv::StepSimulation::TYPE, &Cdr::of(&1_u64))?
        .read()
        .map_err(|it| it.to_string())?;
    must_be_ok("a step after all that", &result.result)
}
