//! Goals of actions: taken or refused, executing, cancelled, ended, and the clients that wait for
//! their results.

use serde::Serialize;

use super::{
    Simulator, Unreadable,
    entities::stamp,
    failed, ok,
    services::{Action, channels_of},
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

/// Which goal.
pub(super) type GoalId = [u8; 16];

/// Ended goals whose results are kept for those who ask late.
const KEPT: usize = 64;
/// Clients that may wait for one goal.
const WAITING_MAX: usize = 64;
/// Steps between two feedbacks; the first and the last are always told.
const FEEDBACK_EVERY: u64 = 10;

/// All goals that are remembered, oldest first.
#[derive(Default)]
pub(super) struct Goals {
    goals: Vec<Goal>,
    /// How many channels there are; feedback goes to all places.
    pub(super) n_channels: usize,
}

struct Goal {
    id: GoalId,
    action: Action,
    stamp: Time,
    status: i8,
    /// The response to those who wait, once there is one.
    result: Option<Cdr>,
    waiting: Vec<RequestId>,
}

impl Simulator {
    /// Says how many channels there are for feedback and status.
    pub fn with_channels(mut self, n_channels: usize) -> Self {
        self.goals.n_channels = n_channels;
        self
    }

    pub(super) fn send_goal(
        &mut self,
        action: Action,
        body: &Cdr,
        seen: &Snapshot,
    ) -> Result<Cdr, Unreadable> {
        let stamp = stamp(seen.time_ns);
        let (id, begun) = match action {
            Action::Gripper => {
                let request: SendGoalRequest<GripperCommandGoal> = body.read()?;
                let id = request.goal_id.uuid;
                let is_new = self.goals.find(id).is_none();
                (id, is_new && self.begin_grip(id, &request.goal, seen))
            }
            Action::ParallelGripper => {
                let request: SendGoalRequest<ParallelGripperCommandGoal> = body.read()?;
                let id = request.goal_id.uuid;
                let is_new = self.goals.find(id).is_none();
                (id, is_new && self.begin_parallel_grip(id, &request.goal, seen))
            }
            Action::SimulateSteps => {
                let request: SendGoalRequest<SimulateStepsGoal> = body.read()?;
                let id = request.goal_id.uuid;
                let is_new = self.goals.find(id).is_none();
                (id, is_new && self.begin_steps(request.goal.steps, id).is_ok())
            }
        };
        if begun {
            let status = GoalStatus::STATUS_EXECUTING;
            let goal =
                Goal { id, action, stamp: stamp.clone(), status, result: None, waiting: vec![] };
            self.goals.add(goal);
            self.tell_status(action);
            if action == Action::SimulateSteps && !self.running.is_stepping() {
                self.goal_stepped(id, 0, 0);
            }
        }
        Ok(Cdr::of(&SendGoalResponse { accepted: begun, stamp }))
    }

    pub(super) fn get_result(
        &mut self,
        action: Action,
        body: &Cdr,
        asker: &RequestId,
    ) -> Result<Option<Cdr>, Unreadable> {
        let request: GetResultRequest = body.read()?;
        let found = self.goals.find(request.goal_id.uuid);
        let Some(goal) = found.filter(|it| it.action == action) else {
            return Ok(Some(unknown_goal(action)));
        };
        if goal.result.is_none() && goal.waiting.len() < WAITING_MAX {
            goal.waiting.push(asker.clone());
        }
        Ok(goal.result.clone())
    }

    pub(super) fn cancel_goals(
        &mut self,
        action: Action,
        body: &Cdr,
        seen: &Snapshot,
    ) -> Result<Cdr, Unreadable> {
        let CancelGoalRequest { goal_info } = body.read()?;
        let ids = match self.goals.to_cancel(action, &goal_info) {
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
            self.cancel_grip(id, seen);
            if let Some((done, left)) = self.cancel_steps(id) {
                let why = format!("cancelled after {done} steps, {left} were left");
                let result = failed(SimResult::RESULT_OPERATION_FAILED, why);
                let result = SimulateStepsResult { result };
                self.end_goal(id, GoalStatus::STATUS_CANCELED, &result);
            }
        }
        let return_code = CancelGoalResponse::ERROR_NONE;
        Ok(Cdr::of(&CancelGoalResponse { return_code, goals_canceling }))
    }

    /// A step of a goal is done.
    pub(super) fn goal_stepped(&mut self, id: GoalId, done: u64, left: u64) {
        if done <= 1 || left == 0 || done.is_multiple_of(FEEDBACK_EVERY) {
            let feedback = SimulateStepsFeedback { completed_steps: done, remaining_steps: left };
            self.tell_feedback(Action::SimulateSteps, id, &Cdr::of(&feedback));
        }
        if left == 0 {
            let result = SimulateStepsResult { result: ok() };
            self.end_goal(id, GoalStatus::STATUS_SUCCEEDED, &result);
        }
    }

    /// A goal cannot be reached any more.
    pub(super) fn abort_goal(&mut self, id: GoalId, result: SimResult) {
        self.end_goal(id, GoalStatus::STATUS_ABORTED, &SimulateStepsResult { result });
    }

    pub(super) fn end_goal<R: Serialize + Clone>(&mut self, id: GoalId, status: i8, result: &R) {
        let Some(goal) = self.goals.find(id) else { return };
        let answer = Cdr::of(&GetResultResponse { status, result: result.clone() });
        goal.status = status;
        goal.result = Some(answer.clone());
        let action = goal.action;
        let waiting = std::mem::take(&mut goal.waiting);
        self.tell_status(action);
        let answers = waiting.into_iter().map(|asker| Outgoing::Response(asker, answer.clone()));
        self.out.extend(answers);
    }

    /// Publishes how far a goal is. Its id comes first, sixteen bytes, so that what follows is
    /// aligned as if it stood alone.
    pub(super) fn tell_feedback(&mut self, action: Action, goal: GoalId, feedback: &Cdr) {
        let bytes = [&goal[..], &feedback.bytes].concat();
        self.tell(action, 0, &Cdr { bytes, is_big_endian: false });
    }

    fn tell_status(&mut self, action: Action) {
        let of_action = self.goals.goals.iter().filter(|it| it.action == action);
        let status_list = of_action.map(Goal::status).collect();
        self.tell(action, 1, &Cdr::of(&GoalStatusArray { status_list }));
    }

    /// Publishes feedback (0) or status (1) of an action.
    fn tell(&mut self, action: Action, which: usize, body: &Cdr) {
        for channels in channels_of(action, self.goals.n_channels) {
            self.out.push(Outgoing::Message(channels[which], body.clone()));
        }
    }
}

impl Goals {
    fn find(&mut self, id: GoalId) -> Option<&mut Goal> {
        self.goals.iter_mut().find(|it| it.id == id)
    }

    fn add(&mut self, goal: Goal) {
        let n_ended = self.goals.iter().filter(|it| it.result.is_some()).count();
        if KEPT <= n_ended
            && let Some(oldest) = self.goals.iter().position(|it| it.result.is_some())
        {
            self.goals.remove(oldest);
        }
        self.goals.push(goal);
    }

    /// Goals that a request to cancel means: one by its name, those not younger than a time, or all.
    fn to_cancel(&self, action: Action, info: &GoalInfo) -> Result<Vec<GoalId>, i8> {
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
        let is_meant = |it: &&Goal| {
            let is_old = (it.stamp.sec, it.stamp.nanosec) <= until && until != (0, 0);
            it.result.is_none() && (it.id == id || is_old || (is_any && until == (0, 0)))
        };
        Ok(of_action().filter(is_meant).map(|it| it.id).collect())
    }
}

impl Goal {
    fn status(&self) -> GoalStatus {
        let goal_id = UUID { uuid: self.id };
        let goal_info = GoalInfo { goal_id, stamp: self.stamp.clone() };
        GoalStatus { goal_info, status: self.status }
    }
}

/// What those are told who wait for a goal that is not there.
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
