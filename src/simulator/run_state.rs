//! The run state: playing, paused or stopped; steps, resets, and the advertised features.

use super::{DecodeError, Simulator, World, failed, goals::GoalId, ok};
use crate::{
    command::change::{Change, Scope},
    cosim::change_error::ChangeError,
    io::server::RequestId,
    scene::resource::FORMATS,
    wire::{
        cdr::Cdr,
        messages::simulation_interfaces::{
            GetSimulationStateResponse, GetSimulatorFeaturesResponse, ResetSimulationRequest,
            ResetSimulationResponse, Result as SimResult, SetSimulationStateRequest,
            SetSimulationStateResponse, SimulationState, SimulatorFeatures as F,
            StepSimulationRequest, StepSimulationResponse,
        },
    },
};

/// The advertised features. The conformance test covers all of them.
const FEATURES: [u8; 32] = [
    F::SPAWNING,
    F::DELETING,
    F::NAMED_POSES,
    F::POSE_BOUNDS,
    F::SPAWNING_RESOURCE_STRING,
    F::SPAWNABLES,
    F::WORLD_LOADING,
    F::WORLD_RESOURCE_STRING,
    F::WORLD_UNLOADING,
    F::WORLD_TAGS,
    F::WORLD_INFO_GETTING,
    F::AVAILABLE_WORLDS,
    F::SPAWNING_ENTITIES,
    F::STEP_SIMULATION_ACTION,
    F::ENTITY_TAGS,
    F::ENTITY_BOUNDS,
    F::ENTITY_BOUNDS_BOX,
    F::ENTITY_BOUNDS_CONVEX,
    F::ENTITY_CATEGORIES,
    F::ENTITY_STATE_GETTING,
    F::ENTITY_STATE_SETTING,
    F::ENTITY_INFO_GETTING,
    F::ENTITY_INFO_SETTING,
    F::SIMULATION_RESET,
    F::SIMULATION_RESET_TIME,
    F::SIMULATION_RESET_STATE,
    F::SIMULATION_RESET_SPAWNED,
    F::SIMULATION_STATE_GETTING,
    F::SIMULATION_STATE_SETTING,
    F::SIMULATION_STATE_PAUSE,
    F::STEP_SIMULATION_SINGLE,
    F::STEP_SIMULATION_MULTIPLE,
];

/// Whether the simulation may advance.
pub(super) struct RunState {
    state: u8,
    /// True during the initial stop, which a first command ends.
    is_first: bool,
    stepping: Option<Stepping>,
}

/// A requested series of steps.
pub(super) struct Stepping {
    n_left: u64,
    n_done: u64,
    requester: Requester,
}

/// The client that requested steps.
enum Requester {
    /// A client of the service.
    Client(RequestId),
    /// A goal of the action.
    Goal(GoalId),
}

impl RunState {
    pub(super) fn new(is_stopped: bool) -> Self {
        let state = if is_stopped {
            SimulationState::STATE_STOPPED
        } else {
            SimulationState::STATE_PLAYING
        };
        Self { state, is_first: is_stopped, stepping: None }
    }

    pub(super) fn may_tick(&self) -> bool {
        self.state == SimulationState::STATE_PLAYING || self.stepping.is_some()
    }

    pub(super) fn pause(&mut self) {
        self.state = SimulationState::STATE_PAUSED;
    }

    pub(super) fn is_stepping(&self) -> bool {
        self.stepping.is_some()
    }

    pub(super) fn is_quitting(&self) -> bool {
        self.state == SimulationState::STATE_QUITTING
    }

    pub(super) fn is_waiting(&self) -> bool {
        self.is_first
    }

    pub(super) fn first_command(&mut self) {
        if std::mem::take(&mut self.is_first) {
            self.state = SimulationState::STATE_PLAYING;
        }
    }

    pub(super) fn has_world(&self) -> bool {
        ![SimulationState::STATE_NO_WORLD, SimulationState::STATE_LOADING_WORLD]
            .contains(&self.state)
    }

    /// Enters the loading state and returns the previous one.
    pub(super) fn begin_loading(&mut self) -> u8 {
        self.is_first = false;
        std::mem::replace(&mut self.state, SimulationState::STATE_LOADING_WORLD)
    }

    /// Stops in the loaded world, unless a request to quit came in the meantime.
    pub(super) fn end_loading(&mut self) {
        if !self.is_quitting() {
            self.state = SimulationState::STATE_STOPPED;
        }
    }

    /// Returns to the state before loading, unless a request to quit came in the meantime.
    pub(super) fn abort_loading(&mut self, before: u8) {
        if !self.is_quitting() {
            self.state = before;
        }
    }

    pub(super) fn unload(&mut self) {
        self.is_first = false;
        self.state = SimulationState::STATE_NO_WORLD;
    }

    /// Checks that steps may begin.
    fn check_ready_to_step(&self) -> Result<(), String> {
        if self.stepping.is_some() {
            return Err("another step request is running: wait for it or cancel it".to_owned());
        }
        if self.state != SimulationState::STATE_PAUSED {
            return Err("the simulation is not paused: pause it first".to_owned());
        }
        Ok(())
    }
}

impl Simulator {
    pub(super) fn features(&self) -> GetSimulatorFeaturesResponse {
        let is_supported = |it: &u8| !self.is_monotonic || *it != F::SIMULATION_RESET_TIME;
        let features = FEATURES.into_iter().filter(is_supported).map(u16::from).collect();
        let custom_info = format!(
            "jamgrip {}; ticks of {} ns",
            env!("CARGO_PKG_VERSION"),
            self.scene.time.tick_ns
        );
        let spawn_formats = FORMATS.map(str::to_owned).to_vec();
        GetSimulatorFeaturesResponse { features: F { features, spawn_formats, custom_info } }
    }

    pub(super) fn simulation_state(&self) -> GetSimulationStateResponse {
        let state = SimulationState { state: self.run_state.state };
        GetSimulationStateResponse { state, result: ok() }
    }

    pub(super) fn set_simulation_state(
        &mut self,
        request: &SetSimulationStateRequest,
        world: &mut World<'_>,
    ) -> SetSimulationStateResponse {
        let result = self.enter_state(request.state.state, world);
        SetSimulationStateResponse { result }
    }

    fn enter_state(&mut self, target: u8, world: &mut World<'_>) -> SimResult {
        use SetSimulationStateResponse as R;
        use SimulationState as S;
        let now = self.run_state.state;
        if target == now && !(target == S::STATE_STOPPED && self.run_state.stepping.is_some()) {
            return failed(R::ALREADY_IN_TARGET_STATE, "the simulation is already in this state");
        }
        let is_world_state =
            [S::STATE_PLAYING, S::STATE_PAUSED, S::STATE_STOPPED].contains(&target);
        if is_world_state && !self.has_world() {
            let reason = "no world is loaded: load one first";
            return failed(R::STATE_TRANSITION_ERROR, reason);
        }
        match target {
            S::STATE_PLAYING | S::STATE_PAUSED if self.run_state.stepping.is_some() => {
                let reason = "a step request is running: wait for it, cancel it, or stop";
                return failed(R::STATE_TRANSITION_ERROR, reason);
            }
            S::STATE_PLAYING | S::STATE_PAUSED => {}
            S::STATE_STOPPED | S::STATE_QUITTING => {
                self.end_steps("the simulation was stopped");
                let reset = Change::Reset(Scope { time: !self.is_monotonic, ..Scope::ALL });
                if target == S::STATE_STOPPED
                    && let Err(error) = self.change(&reset, world)
                {
                    return failed(R::STATE_TRANSITION_ERROR, error);
                }
                self.entity_table.remove_spawned(&self.scene);
            }
            S::STATE_NO_WORLD | S::STATE_LOADING_WORLD => {
                let reason = "worlds are loaded and unloaded by their own services";
                return failed(R::INCORRECT_TRANSITION, reason);
            }
            _ => return failed(R::INCORRECT_TRANSITION, format!("there is no state {target}")),
        }
        self.run_state.state = target;
        self.run_state.is_first = false;
        ok()
    }

    pub(super) fn reset_simulation(
        &mut self,
        request: &ResetSimulationRequest,
        world: &mut World<'_>,
    ) -> ResetSimulationResponse {
        use ResetSimulationRequest as R;
        let known = R::SCOPE_TIME | R::SCOPE_STATE | R::SCOPE_SPAWNED;
        let has = |bit: u8| request.scope & bit != 0;
        let scope = match request.scope {
            R::SCOPE_DEFAULT | R::SCOPE_ALL => Scope::ALL,
            R::SCOPE_TIME if self.is_monotonic => {
                let reason = "outputs.ros.monotonic_clock is true: time cannot be reset";
                return ResetSimulationResponse {
                    result: failed(SimResult::RESULT_FEATURE_UNSUPPORTED, reason),
                };
            }
            scope if scope & !known == 0 => Scope {
                time: has(R::SCOPE_TIME),
                state: has(R::SCOPE_STATE),
                spawned: has(R::SCOPE_SPAWNED),
            },
            scope => {
                let reason =
                    format!("scope {scope} has bits other than time 1, state 2, spawned 4");
                return ResetSimulationResponse {
                    result: failed(SimResult::RESULT_FEATURE_UNSUPPORTED, reason),
                };
            }
        };
        if self.run_state.stepping.is_some() {
            let reason = "a step request is running: wait for it, cancel it, or stop";
            return ResetSimulationResponse {
                result: failed(SimResult::RESULT_INCORRECT_STATE, reason),
            };
        }
        let scope = Scope { time: scope.time && !self.is_monotonic, ..scope };
        let result = match self.change(&Change::Reset(scope), world) {
            Ok(()) => {
                if scope.spawned {
                    self.entity_table.remove_spawned(&self.scene);
                }
                ok()
            }
            Err(error @ ChangeError::NoScene) => failed(SimResult::RESULT_INCORRECT_STATE, error),
            Err(error) => failed(SimResult::RESULT_OPERATION_FAILED, error),
        };
        ResetSimulationResponse { result }
    }

    pub(super) fn step_simulation(
        &mut self,
        body: &Cdr,
        id: &RequestId,
    ) -> Result<Option<Cdr>, DecodeError> {
        let StepSimulationRequest { steps } = body.read()?;
        let result = match self.run_state.check_ready_to_step() {
            Err(reason) => failed(SimResult::RESULT_OPERATION_FAILED, reason),
            Ok(()) if steps == 0 => ok(),
            Ok(()) => {
                let requester = Requester::Client(id.clone());
                self.run_state.stepping = Some(Stepping { n_left: steps, n_done: 0, requester });
                return Ok(None);
            }
        };
        Ok(Some(Cdr::of(&StepSimulationResponse { result })))
    }

    /// Begins the steps of a goal.
    pub(super) fn begin_steps(&mut self, steps: u64, goal: GoalId) -> Result<(), String> {
        self.run_state.check_ready_to_step()?;
        if 0 < steps {
            let requester = Requester::Goal(goal);
            self.run_state.stepping = Some(Stepping { n_left: steps, n_done: 0, requester });
        }
        Ok(())
    }

    /// Ends the steps of a goal. Returns the numbers of completed and remaining steps.
    pub(super) fn cancel_steps(&mut self, goal: GoalId) -> Option<(u64, u64)> {
        let is_goal = |it: &Stepping| matches!(it.requester, Requester::Goal(id) if id == goal);
        let stepping = self.run_state.stepping.take_if(|it| is_goal(it))?;
        Some((stepping.n_done, stepping.n_left))
    }

    /// Counts a tick as a step, and reports it to the requester.
    pub(super) fn count_step(&mut self) {
        let Some(mut stepping) = self.run_state.stepping.take() else { return };
        stepping.n_left -= 1;
        stepping.n_done += 1;
        let is_done = stepping.n_left == 0;
        match &stepping.requester {
            Requester::Client(id) if is_done => {
                self.send_response(id.clone(), &StepSimulationResponse { result: ok() });
            }
            Requester::Client(_) => {}
            Requester::Goal(goal) => self.report_goal_step(*goal, stepping.n_done, stepping.n_left),
        }
        if !is_done {
            self.run_state.stepping = Some(stepping);
        }
    }

    pub(super) fn end_steps(&mut self, reason: &str) {
        let Some(stepping) = self.run_state.stepping.take() else { return };
        let (n_done, n_left) = (stepping.n_done, stepping.n_left);
        let reason = format!("{reason} after {n_done} steps with {n_left} remaining");
        let result = failed(SimResult::RESULT_OPERATION_FAILED, reason);
        match stepping.requester {
            Requester::Client(id) => self.send_response(id, &StepSimulationResponse { result }),
            Requester::Goal(goal) => self.abort_goal(goal, result),
        }
    }
}
