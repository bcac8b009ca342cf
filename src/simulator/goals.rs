//! Action goals: accepting, executing, canceling and ending them, and sending their results to the
//! waiting clients.

use serde::Serialize;

use super::{
    DecodeError, Simulator,
    entities::stamp,
    failed, ok,
    services::{Action, topics_of},
};
use crate::{
    io::server::{Outgoing, RequestId},
    snapshot::Snapshot,
    wire::{
        actions::{GetResultRequest, GetResultResponse, SendGoalRequest, SendGoalResponse},
        cdr::Cdr,
        messages::{
            action_msgs::{
                CancelGoalRequest, CancelGoalResponse, GoalInfo, GoalStatus, GoalStatusArray,
            },
            builtin_interfaces::Time,
            control_msgs::{
                GripperCommandGoal, GripperCommandResult, ParallelGripperCommandGoal,
                ParallelGripperCommandResult,
            },
            simulation_interfaces::{
                Result as SimResult, SimulateStepsFeedback, SimulateStepsGoal, SimulateStepsResult,
            },
            unique_identifier_msgs::UUID,
        },
    },
};

/// ID of a goal.
pub(super) type GoalId = [u8; 16];

/// Number of ended goals whose results are kept for late requests.
const N_ENDED_MAX: usize = 64;
/// Number of clients that may wait for one goal.
const WAITING_MAX: usize = 64;
/// Steps between two feedback messages; the first and the last step always send one.
const FEEDBACK_PERIOD: u64 = 10;

/// All goals that are kept, oldest first.
#[derive(Default)]
pub(super) struct Goals {
    goals: Vec<Goal>,
    /// Number of action topics, in all namespaces.
    pub(super) n_topics: usize,
}

struct Goal {
    id: GoalId,
    action: Action,
    stamp: Time,
    status: i8,
    /// The response to result requests, once the goal has ended.
    result: Option<Cdr>,
    waiting: Vec<RequestId>,
}

impl Simulator {
    /// Sets the number of action topics for feedback and status.
    pub fn with_n_topics(mut self, n_topics: usize) -> Self {
        self.goals.n_topics = n_topics;
        self
    }

    pub(super) fn send_goal(
        &mut self,
        action: Action,
        body: &Cdr,
        snapshot: &Snapshot,
    ) -> Result<Cdr, DecodeError> {
        let stamp = stamp(snapshot.time_ns);
        let (id, is_accepted) = match action {
            Action::Gripper => {
                let request: SendGoalRequest<GripperCommandGoal> = body.read()?;
                let id = request.goal_id.uuid;
                let is_new = self.goals.find(id).is_none();
                (id, is_new && self.begin_grip(id, &request.goal, snapshot))
            }
            Action::ParallelGripper => {
                let request: SendGoalRequest<ParallelGripperCommandGoal> = body.read()?;
                let id = request.goal_id.uuid;
                let is_new = self.goals.find(id).is_none();
                (id, is_new && self.begin_parallel_grip(id, &request.goal, snapshot))
            }
            Action::SimulateSteps => {
                let request: SendGoalRequest<SimulateStepsGoal> = body.read()?;
                let id = request.goal_id.uuid;
                let is_new = self.goals.find(id).is_none();
                (id, is_new && self.begin_steps(request.goal.steps, id).is_ok())
            }
        };
        if is_accepted {
            let status = GoalStatus::STATUS_EXECUTING;
            let goal =
                Goal { id, action, stamp: stamp.clone(), status, result: None, waiting: vec![] };
            self.goals.add(goal);
            self.publish_status(action);
            if action == Action::SimulateSteps && !self.run_state.is_stepping() {
                self.report_goal_step(id, 0, 0);
            }
        }
        Ok(Cdr::of(&SendGoalResponse { accepted: is_accepted, stamp }))
    }

    pub(super) fn get_result(
        &mut self,
        action: Action,
        body: &Cdr,
        id: &RequestId,
    ) -> Result<Option<Cdr>, DecodeError> {
        let request: GetResultRequest = body.read()?;
        let found = self.goals.find(request.goal_id.uuid);
        let Some(goal) = found.filter(|it| it.action == action) else {
            return Ok(Some(unknown_goal(action)));
        };
        if goal.result.is_none() && goal.waiting.len() < WAITING_MAX {
            goal.waiting.push(id.clone());
        }
        Ok(goal.result.clone())
    }

    pub(super) fn cancel_goals(
        &mut self,
        action: Action,
        body: &Cdr,
        snapshot: &Snapshot,
    ) -> Result<Cdr, DecodeError> {
        let CancelGoalRequest { goal_info } = body.read()?;
        let ids = match self.goals.select(action, &goal_info) {
            Ok(ids) => ids,
            Err(return_code) => {
                return Ok(Cdr::of(&CancelGoalResponse { return_code, ..Default::default() }));
            }
        };
        let mut goals_canceling = Vec::new();
        for id in ids {
            if let Some(goal) = self.goals.find(id) {
                let goal_id = UUID { uuid: id };
                goals_canceling.push(GoalInfo { goal_id, stamp: goal.stamp.clone() });
            }
            self.cancel_grip(id, snapshot);
            if let Some((done, left)) = self.cancel_steps(id) {
                let reason = format!("canceled after {done} steps with {left} remaining");
                let result = failed(SimResult::RESULT_OPERATION_FAILED, reason);
                let result = SimulateStepsResult { result };
                self.end_goal(id, GoalStatus::STATUS_CANCELED, &result);
            }
        }
        let return_code = CancelGoalResponse::ERROR_NONE;
        Ok(Cdr::of(&CancelGoalResponse { return_code, goals_canceling }))
    }

    /// Reports a completed step of a goal, and ends the goal after the last one.
    pub(super) fn report_goal_step(&mut self, id: GoalId, done: u64, left: u64) {
        if done <= 1 || left == 0 || done.is_multiple_of(FEEDBACK_PERIOD) {
            let feedback = SimulateStepsFeedback { completed_steps: done, remaining_steps: left };
            self.publish_feedback(Action::SimulateSteps, id, &Cdr::of(&feedback));
        }
        if left == 0 {
            let result = SimulateStepsResult { result: ok() };
            self.end_goal(id, GoalStatus::STATUS_SUCCEEDED, &result);
        }
    }

    /// Ends a goal that can no longer be reached.
    pub(super) fn abort_goal(&mut self, id: GoalId, result: SimResult) {
        self.end_goal(id, GoalStatus::STATUS_ABORTED, &SimulateStepsResult { result });
    }

    pub(super) fn end_goal<R: Serialize + Clone>(&mut self, id: GoalId, status: i8, result: &R) {
        let Some(goal) = self.goals.find(id) else { return };
        let response = Cdr::of(&GetResultResponse { status, result: result.clone() });
        goal.status = status;
        goal.result = Some(response.clone());
        let action = goal.action;
        let waiting = std::mem::take(&mut goal.waiting);
        self.publish_status(action);
        let responses = waiting.into_iter().map(|id| Outgoing::Response(id, response.clone()));
        self.outgoing.extend(responses);
    }

    /// Publishes the progress of a goal. The goal's ID comes first; it has 16 bytes, so the
    /// feedback after it is aligned as in a separate message.
    pub(super) fn publish_feedback(&mut self, action: Action, goal: GoalId, feedback: &Cdr) {
        let bytes = [&goal[..], &feedback.bytes].concat();
        self.publish(action, 0, &Cdr { bytes, is_big_endian: false });
    }

    fn publish_status(&mut self, action: Action) {
        let of_action = self.goals.goals.iter().filter(|it| it.action == action);
        let status_list = of_action.map(Goal::status).collect();
        self.publish(action, 1, &Cdr::of(&GoalStatusArray { status_list }));
    }

    /// Publishes feedback (0) or status (1) of an action.
    fn publish(&mut self, action: Action, kind: usize, body: &Cdr) {
        for topics in topics_of(action, self.goals.n_topics) {
            self.outgoing.push(Outgoing::Message(topics[kind], body.clone()));
        }
    }
}

impl Goals {
    fn find(&mut self, id: GoalId) -> Option<&mut Goal> {
        self.goals.iter_mut().find(|it| it.id == id)
    }

    fn add(&mut self, goal: Goal) {
        let n_ended = self.goals.iter().filter(|it| it.result.is_some()).count();
        if N_ENDED_MAX <= n_ended
            && let Some(oldest) = self.goals.iter().position(|it| it.result.is_some())
        {
            self.goals.remove(oldest);
        }
        self.goals.push(goal);
    }

    /// The goals that a cancel request selects: one by its ID, those accepted up to a time, or all.
    fn select(&self, action: Action, info: &GoalInfo) -> Result<Vec<GoalId>, i8> {
        let id = info.goal_id.uuid;
        let is_any = id == [0; 16];
        let until = (info.stamp.sec, info.stamp.nanosec);
        let of_action = || self.goals.iter().filter(|it| it.action == action);
        if !is_any {
            let goal = of_action().find(|it| it.id == id);
            let goal = goal.ok_or(CancelGoalResponse::ERROR_UNKNOWN_GOAL_ID)?;
            if goal.result.is_some() {
                return Err(CancelGoalResponse::ERROR_GOAL_TERMINATED);
            }
        }
        let is_selected = |it: &&Goal| {
            let is_old = (it.stamp.sec, it.stamp.nanosec) <= until && until != (0, 0);
            it.result.is_none() && (it.id == id || is_old || (is_any && until == (0, 0)))
        };
        Ok(of_action().filter(is_selected).map(|it| it.id).collect())
    }
}

impl Goal {
    fn status(&self) -> GoalStatus {
        let goal_id = UUID { uuid: self.id };
        let goal_info = GoalInfo { goal_id, stamp: self.stamp.clone() };
        GoalStatus { goal_info, status: self.status }
    }
}

/// The response to result requests for an unknown goal.
fn unknown_goal(action: Action) -> Cdr {
    match action {
        Action::Gripper => Cdr::of(&GetResultResponse {
            status: GoalStatus::STATUS_UNKNOWN,
            result: GripperCommandResult::default(),
        }),
        Action::ParallelGripper => Cdr::of(&GetResultResponse {
            status: GoalStatus::STATUS_UNKNOWN,
            result: ParallelGripperCommandResult::default(),
        }),
        Action::SimulateSteps => Cdr::of(&GetResultResponse {
            status: GoalStatus::STATUS_UNKNOWN,
            result: SimulateStepsResult {
                result: failed(SimResult::RESULT_NOT_FOUND, "no such goal"),
            },
        }),
    }
}
