//! The interface of vacuum gripper drivers and MoveIt.
//!
//! A position is a fraction of the strongest vacuum: 0 is vented, 1 is the limit of the pump. An
//! effort is a pressure below ambient (Pa); as a limit it bounds the vacuum. A goal is reached when
//! the pressure is within 5 % of the requested one; it is `stalled` if the gripper then touches an
//! object. A new goal aborts the one before. Canceling a goal keeps the current pressure.

use super::{Simulator, World, goals::GoalId, services::Action};
use crate::{
    command::{Command, change::Change},
    cosim::change_error::ChangeError,
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

/// Tolerance of the pressure, as a fraction of the strongest vacuum.
const REACHED_TOLERANCE: f64 = 0.05;
/// Simulation time after which an unreached goal is aborted (ns).
const TIMEOUT_NS: u64 = 30_000_000_000;
/// Ticks between two feedback messages.
const FEEDBACK_PERIOD: u64 = 20;
/// Name of the joint that represents the vacuum.
const JOINT: &str = crate::command::JOINTS[0];

/// A running goal.
pub(super) struct GripGoal {
    id: GoalId,
    action: Action,
    /// The target pressure, within limits (Pa).
    gauge: f64,
    start_ns: u64,
    n_ticks: u64,
}

/// The progress of a goal.
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
        SetBoolResponse { success: true, message: format!("the setpoint is {gauge_pa} Pa") }
    }

    pub(super) fn zero_force_sensor(&mut self, world: &mut World<'_>) -> TriggerResponse {
        match self.change(&Change::ZeroForceSensor, world) {
            Ok(()) => TriggerResponse {
                success: true,
                message: "~/flange/wrench now reads zero".to_owned(),
            },
            Err(ChangeError::Unchangeable) | Err(_) => {
                TriggerResponse { success: false, message: "there is no force sensor".to_owned() }
            }
        }
    }

    /// Begins a goal of `GripperCommand`. Returns false if it is invalid.
    pub(super) fn begin_grip(
        &mut self,
        goal: GoalId,
        request: &GripperCommandGoal,
        snapshot: &Snapshot,
    ) -> bool {
        let command = &request.command;
        self.begin(Action::Gripper, goal, [command.position, command.max_effort], snapshot)
    }

    /// Begins a goal of `ParallelGripperCommand`. Returns false if it is invalid.
    pub(super) fn begin_parallel_grip(
        &mut self,
        goal: GoalId,
        request: &ParallelGripperCommandGoal,
        snapshot: &Snapshot,
    ) -> bool {
        let JointState { name, position, effort, .. } = &request.command;
        let is_known_joint = name.is_empty() || name.iter().map(String::as_str).eq([JOINT]);
        let [position] = position.as_slice() else { return false };
        let effort = effort.first().copied().unwrap_or(0.0);
        is_known_joint && self.begin(Action::ParallelGripper, goal, [*position, effort], snapshot)
    }

    fn begin(
        &mut self,
        action: Action,
        goal: GoalId,
        [position, max_effort]: [f64; 2],
        snapshot: &Snapshot,
    ) -> bool {
        let is_valid = (0.0..=1.0).contains(&position) && max_effort.is_finite();
        if !is_valid || !self.has_world() {
            return false;
        }
        self.end_grip(GoalStatus::STATUS_ABORTED, None);
        let strongest = self.scene.chamber.gauge_min;
        // An effort of zero or less means no limit, as in other gripper controllers.
        let limit = if 0.0 < max_effort { -max_effort } else { strongest };
        let gauge = (position * strongest).max(limit);
        self.commands.push(Command::Vacuum { gauge_pa: gauge });
        self.grip =
            Some(GripGoal { id: goal, action, gauge, start_ns: snapshot.time_ns, n_ticks: 0 });
        true
    }

    /// Reports the progress of the goal after a tick, and ends it if it is reached or timed out.
    pub(super) fn update_grip(&mut self, snapshot: &Snapshot) {
        let Some(grip) = &mut self.grip else { return };
        grip.n_ticks += 1;
        let is_feedback_due = grip.n_ticks % FEEDBACK_PERIOD == 1;
        let is_timed_out = TIMEOUT_NS < snapshot.time_ns.saturating_sub(grip.start_ns);
        let (action, goal) = (grip.action, grip.id);
        let progress = self.progress(snapshot);
        if is_feedback_due || progress.is_reached {
            let body = feedback(action, &progress);
            self.publish_feedback(action, goal, &body);
        }
        if progress.is_reached {
            self.end_grip(GoalStatus::STATUS_SUCCEEDED, Some(&progress));
        } else if is_timed_out {
            self.end_grip(GoalStatus::STATUS_ABORTED, Some(&progress));
        }
    }

    /// Cancels the goal, and keeps the current pressure.
    pub(super) fn cancel_grip(&mut self, goal: GoalId, snapshot: &Snapshot) {
        if self.grip.as_ref().is_some_and(|it| it.id == goal) {
            let progress = self.progress(snapshot);
            self.commands.push(Command::Vacuum { gauge_pa: progress.gauge });
            self.end_grip(GoalStatus::STATUS_CANCELED, Some(&progress));
        }
    }

    /// Aborts the goal, because its world is being replaced or unloaded.
    pub(super) fn abort_grip(&mut self) {
        self.end_grip(GoalStatus::STATUS_ABORTED, None);
    }

    fn progress(&self, snapshot: &Snapshot) -> Progress {
        let strongest = self.scene.chamber.gauge_min;
        let target = self.grip.as_ref().map_or(0.0, |it| it.gauge);
        let gauge = snapshot.chamber.gauge;
        let is_reached = (gauge - target).abs() <= REACHED_TOLERANCE * strongest.abs();
        Progress {
            position: if strongest < 0.0 { gauge / strongest } else { 0.0 },
            gauge,
            is_reached,
            is_stalled: is_reached && target < 0.0 && 0 < snapshot.jamming.n_object_contacts,
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
                self.end_goal(grip.id, status, &result);
            }
            Action::Gripper | Action::SimulateSteps => {
                let (position, effort) = (it.position, -it.gauge);
                let result = GripperCommandResult { position, effort, stalled, reached_goal };
                self.end_goal(grip.id, status, &result);
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
