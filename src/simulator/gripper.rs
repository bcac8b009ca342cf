//! The gripper as drivers of vacuum grippers and MoveIt know theirs.
//!
//! A position is a share of the strongest vacuum: 0 is vented, 1 is all that the pump can. An effort
//! is a pressure below the ambient one (Pa); as a limit it bounds the vacuum. A goal has been reached
//! when the pressure is within 5 % of what was asked; it has `stalled` if the bag then holds
//! something and can draw no further. A new goal aborts the one before, a cancelled one keeps the
//! pressure that it has come to.

use super::{Simulator, World, goals::GoalId, services::Action};
use crate::{
    command::{Command, change::Change},
    cosim::refused::ChangeError,
    snapshot::Snapshot,
    wire::{
        cdr::Cdr,
        messages::{
            action_msgs::GoalStatus,
            control_msgs::{
                GripperCommandFeedback, GripperCommandGoal, GripperCommandResult,
                ParallelGripperCommandFeedback, ParallelGripperCommandGoal,
                ParallelGripperCommandResult,
            },
            sensor_msgs::JointState,
            std_srvs::{SetBoolRequest, SetBoolResponse, TriggerResponse},
        },
    },
};

/// How near the pressure must come, as a share of the strongest vacuum.
const NEAR: f64 = 0.05;
/// Simulated time after which a goal that is not reached is given up (ns).
const PATIENCE_NS: u64 = 30_000_000_000;
/// Ticks between two feedbacks.
const FEEDBACK_EVERY: u64 = 20;
/// Name of the joint that a vacuum is.
const JOINT: &str = crate::command::JOINTS[0];

/// A goal that is on its way.
pub(super) struct Grip {
    goal: GoalId,
    action: Action,
    /// What was asked for, after limits (Pa).
    gauge: f64,
    since_ns: u64,
    n_ticks: u64,
}

/// How far a goal has come.
struct Progress {
    position: f64,
    gauge: f64,
    is_reached: bool,
    is_stalled: bool,
}

impl Simulator {
    pub(super) fn grip_command(&mut self, request: &SetBoolRequest) -> SetBoolResponse {
        if !self.has_world() {
            return SetBoolResponse { success: false, message: ChangeError::NoScene.to_string() };
        }
        let gauge_pa = if request.data { self.scene.chamber.gauge_min } else { 0.0 };
        self.end_grip(GoalStatus::STATUS_ABORTED, None);
        self.commands.push(Command::Vacuum { gauge_pa });
        SetBoolResponse { success: true, message: format!("{gauge_pa} Pa are set") }
    }

    pub(super) fn zero_force_sensor(&mut self, world: &mut World<'_>) -> TriggerResponse {
        match self.change(&Change::ZeroForceSensor, world) {
            Ok(()) => TriggerResponse {
                success: true,
                message: "~/flange/wrench reads zero from here on".to_owned(),
            },
            Err(ChangeError::Unchangeable) | Err(_) => {
                TriggerResponse { success: false, message: "there is no sensor".to_owned() }
            }
        }
    }

    /// Begins a goal of GripperCommand; false if it makes no sense.
    pub(super) fn begin_grip(
        &mut self,
        goal: GoalId,
        asked: &GripperCommandGoal,
        seen: &Snapshot,
    ) -> bool {
        let command = &asked.command;
        self.begin(Action::Gripper, goal, [command.position, command.max_effort], seen)
    }

    /// Begins a goal of ParallelGripperCommand; false if it makes no sense.
    pub(super) fn begin_parallel_grip(
        &mut self,
        goal: GoalId,
        asked: &ParallelGripperCommandGoal,
        seen: &Snapshot,
    ) -> bool {
        let JointState { name, position, effort, .. } = &asked.command;
        let is_ours = name.is_empty() || name.iter().map(String::as_str).eq([JOINT]);
        let [position] = position.as_slice() else { return false };
        let effort = effort.first().copied().unwrap_or(0.0);
        is_ours && self.begin(Action::ParallelGripper, goal, [*position, effort], seen)
    }

    fn begin(
        &mut self,
        action: Action,
        goal: GoalId,
        [position, max_effort]: [f64; 2],
        seen: &Snapshot,
    ) -> bool {
        let is_sensible = (0.0..=1.0).contains(&position) && max_effort.is_finite();
        if !is_sensible || !self.has_world() {
            return false;
        }
        self.end_grip(GoalStatus::STATUS_ABORTED, None);
        let strongest = self.scene.chamber.gauge_min;
        // An effort of zero or less is no limit, as controllers of grippers have it.
        let limit = if 0.0 < max_effort { -max_effort } else { strongest };
        let gauge = (position * strongest).max(limit);
        self.commands.push(Command::Vacuum { gauge_pa: gauge });
        self.grip = Some(Grip { goal, action, gauge, since_ns: seen.time_ns, n_ticks: 0 });
        true
    }

    /// A tick has ended: tells how far a goal is, and ends it.
    pub(super) fn grip_ticked(&mut self, seen: &Snapshot) {
        let Some(grip) = &mut self.grip else { return };
        grip.n_ticks += 1;
        let is_told = grip.n_ticks % FEEDBACK_EVERY == 1;
        let is_late = PATIENCE_NS < seen.time_ns.saturating_sub(grip.since_ns);
        let (action, goal) = (grip.action, grip.goal);
        let progress = self.progress(seen);
        if is_told || progress.is_reached {
            let body = feedback(action, &progress);
            self.tell_feedback(action, goal, &body);
        }
        if progress.is_reached {
            self.end_grip(GoalStatus::STATUS_SUCCEEDED, Some(&progress));
        } else if is_late {
            self.end_grip(GoalStatus::STATUS_ABORTED, Some(&progress));
        }
    }

    /// The goal is not wanted any more: the pressure stays what it is.
    pub(super) fn cancel_grip(&mut self, goal: GoalId, seen: &Snapshot) {
        if self.grip.as_ref().is_some_and(|it| it.goal == goal) {
            let progress = self.progress(seen);
            self.commands.push(Command::Vacuum { gauge_pa: progress.gauge });
            self.end_grip(GoalStatus::STATUS_CANCELED, Some(&progress));
        }
    }

    /// The world that a goal is about goes.
    pub(super) fn give_up_grip(&mut self) {
        self.end_grip(GoalStatus::STATUS_ABORTED, None);
    }

    fn progress(&self, seen: &Snapshot) -> Progress {
        let strongest = self.scene.chamber.gauge_min;
        let wanted = self.grip.as_ref().map_or(0.0, |it| it.gauge);
        let gauge = seen.chamber.gauge;
        let is_reached = (gauge - wanted).abs() <= NEAR * strongest.abs();
        Progress {
            position: if strongest < 0.0 { gauge / strongest } else { 0.0 },
            gauge,
            is_reached,
            is_stalled: is_reached && wanted < 0.0 && 0 < seen.jamming.n_object_contacts,
        }
    }

    fn end_grip(&mut self, status: i8, progress: Option<&Progress>) {
        let Some(grip) = self.grip.take() else { return };
        let nothing = Progress { position: 0.0, gauge: 0.0, is_reached: false, is_stalled: false };
        let it = progress.unwrap_or(&nothing);
        let (stalled, reached_goal) = (it.is_stalled, it.is_reached);
        match grip.action {
            Action::ParallelGripper => {
                let state = joint(it);
                let result = ParallelGripperCommandResult { state, stalled, reached_goal };
                self.end_goal(grip.goal, status, &result);
            }
            Action::Gripper | Action::SimulateSteps => {
                let (position, effort) = (it.position, -it.gauge);
                let result = GripperCommandResult { position, effort, stalled, reached_goal };
                self.end_goal(grip.goal, status, &result);
            }
        }
    }
}

fn feedback(action: Action, it: &Progress) -> Cdr {
    match action {
        Action::ParallelGripper => Cdr::of(&ParallelGripperCommandFeedback { state: joint(it) }),
        Action::Gripper | Action::SimulateSteps => Cdr::of(&GripperCommandFeedback {
            position: it.position,
            effort: -it.gauge,
            stalled: it.is_stalled,
            reached_goal: it.is_reached,
        }),
    }
}

fn joint(it: &Progress) -> JointState {
    JointState {
        name: vec![JOINT.to_owned()],
        position: vec![it.position],
        effort: vec![-it.gauge],
        ..Default::default()
    }
}
