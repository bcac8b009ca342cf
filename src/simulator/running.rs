//! Whether time goes on: states of the simulation, steps, resets, and what is advertised.

use super::{Simulator, Unreadable, World, failed, goals::GoalId, ok};
use crate::{
    command::change::{Change, Scope},
    cosim::refused::ChangeError,
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

/// What is advertised: everything here has passed the black-box test.
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

/// Whether time goes on.
pub(super) struct Running {
    state: u8,
    /// True in the first stop, which a first command ends.
    is_first: bool,
    stepping: Option<Stepping>,
}

/// Steps that someone waits for.
pub(super) struct Stepping {
    left: u64,
    done: u64,
    whose: Whose,
}

/// Who waits for steps.
enum Whose {
    /// A client of the service.
    Client(RequestId),
    /// A goal of the action.
    Goal(GoalId),
}

impl Running {
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

    /// The state before.
    pub(super) fn begin_loading(&mut self) -> u8 {
        self.is_first = false;
        std::mem::replace(&mut self.state, SimulationState::STATE_LOADING_WORLD)
    }

    /// A world is there. Who has been told to quit meanwhile quits.
    pub(super) fn end_loading(&mut self) {
        if !self.is_quitting() {
            self.state = SimulationState::STATE_STOPPED;
        }
    }

    /// The world that was there before is there still.
    pub(super) fn give_up_loading(&mut self, before: u8) {
        if !self.is_quitting() {
            self.state = before;
        }
    }

    pub(super) fn unload(&mut self) {
        self.is_first = false;
        self.state = SimulationState::STATE_NO_WORLD;
    }

    /// True if steps may begin.
    fn is_ready_to_step(&self) -> Result<(), String> {
        if self.stepping.is_some() {
            return Err("steps are being made: wait for them or cancel them".to_owned());
        }
        if self.state != SimulationState::STATE_PAUSED {
            return Err("the simulation is not paused: pause it first".to_owned());
        }
        Ok(())
    }
}

impl Simulator {
    pub(super) fn features(&self) -> GetSimulatorFeaturesResponse {
        let is_there = |it: &u8| !self.is_monotonic || *it != F::SIMULATION_RESET_TIME;
        let features = FEATURES.into_iter().filter(is_there).map(u16::from).collect();
        let custom_info = format!(
            "jamgrip {}; ticks of {} ns",
            env!("CARGO_PKG_VERSION"),
            self.scene.time.tick_ns
        );
        let spawn_formats = FORMATS.map(str::to_owned).to_vec();
        GetSimulatorFeaturesResponse { features: F { features, spawn_formats, custom_info } }
    }

    pub(super) fn simulation_state(&self) -> GetSimulationStateResponse {
        let state = SimulationState { state: self.running.state };
        GetSimulationStateResponse { state, result: ok() }
    }

    pub(super) fn set_simulation_state(
        &mut self,
        request: &SetSimulationStateRequest,
        world: &mut World<'_>,
    ) -> SetSimulationStateResponse {
        let result = self.go_to(request.state.state, world);
        SetSimulationStateResponse { result }
    }

    fn go_to(&mut self, target: u8, world: &mut World<'_>) -> SimResult {
        use SetSimulationStateResponse as R;
        use SimulationState as S;
        let now = self.running.state;
        if target == now && !(target == S::STATE_STOPPED && self.running.stepping.is_some()) {
            return failed(R::ALREADY_IN_TARGET_STATE, "the simulation is in this state already");
        }
        let is_world_state =
            [S::STATE_PLAYING, S::STATE_PAUSED, S::STATE_STOPPED].contains(&target);
        if is_world_state && !self.has_world() {
            let why = "no world is loaded: load one first";
            return failed(R::STATE_TRANSITION_ERROR, why);
        }
        match target {
            S::STATE_PLAYING | S::STATE_PAUSED if self.running.stepping.is_some() => {
                let why = "steps are being made: wait for them, cancel them, or stop";
                return failed(R::STATE_TRANSITION_ERROR, why);
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
                self.register.forget_spawned(&self.scene);
            }
            S::STATE_NO_WORLD | S::STATE_LOADING_WORLD => {
                let why = "worlds are loaded and unloaded by services of their own";
                return failed(R::INCORRECT_TRANSITION, why);
            }
            _ => return failed(R::INCORRECT_TRANSITION, format!("there is no state {target}")),
        }
        self.running.state = target;
        self.running.is_first = false;
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
                let why = "outputs.ros.monotonic_clock is true: time never goes back";
                return ResetSimulationResponse {
                    result: failed(SimResult::RESULT_FEATURE_UNSUPPORTED, why),
                };
            }
            scope if scope & !known == 0 => Scope {
                time: has(R::SCOPE_TIME),
                state: has(R::SCOPE_STATE),
                spawned: has(R::SCOPE_SPAWNED),
            },
            scope => {
                let why = format!("scope {scope} has bits beyond time 1, state 2 and spawned 4");
                return ResetSimulationResponse {
                    result: failed(SimResult::RESULT_FEATURE_UNSUPPORTED, why),
                };
            }
        };
        if self.running.stepping.is_some() {
            let why = "steps are being made: wait for them, cancel them, or stop";
            return ResetSimulationResponse {
                result: failed(SimResult::RESULT_INCORRECT_STATE, why),
            };
        }
        let scope = Scope { time: scope.time && !self.is_monotonic, ..scope };
        let result = match self.change(&Change::Reset(scope), world) {
            Ok(()) => {
                if scope.spawned {
                    self.register.forget_spawned(&self.scene);
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
        asker: &RequestId,
    ) -> Result<Option<Cdr>, Unreadable> {
        let StepSimulationRequest { steps } = body.read()?;
        let result = match self.running.is_ready_to_step() {
            Err(why) => failed(SimResult::RESULT_OPERATION_FAILED, why),
            Ok(()) if steps == 0 => ok(),
            Ok(()) => {
                let whose = Whose::Client(asker.clone());
                self.running.stepping = Some(Stepping { left: steps, done: 0, whose });
                return Ok(None);
            }
        };
        Ok(Some(Cdr::of(&StepSimulationResponse { result })))
    }

    /// Begins the steps of a goal.
    pub(super) fn begin_steps(&mut self, steps: u64, goal: GoalId) -> Result<(), String> {
        self.running.is_ready_to_step()?;
        if 0 < steps {
            self.running.stepping =
                Some(Stepping { left: steps, done: 0, whose: Whose::Goal(goal) });
        }
        Ok(())
    }

    /// Ends the steps of a goal; how many were made and how many not.
    pub(super) fn cancel_steps(&mut self, goal: GoalId) -> Option<(u64, u64)> {
        let is_its = |it: &Stepping| matches!(it.whose, Whose::Goal(id) if id == goal);
        let stepping = self.running.stepping.take_if(|it| is_its(it))?;
        Some((stepping.done, stepping.left))
    }

    /// A tick has ended: counts it, and tells those who wait.
    pub(super) fn steps_ticked(&mut self) {
        let Some(mut stepping) = self.running.stepping.take() else { return };
        stepping.left -= 1;
        stepping.done += 1;
        let is_done = stepping.left == 0;
        match &stepping.whose {
            Whose::Client(asker) if is_done => {
                self.send_answer(asker.clone(), &StepSimulationResponse { result: ok() });
            }
            Whose::Client(_) => {}
            Whose::Goal(goal) => self.goal_stepped(*goal, stepping.done, stepping.left),
        }
        if !is_done {
            self.running.stepping = Some(stepping);
        }
    }

    pub(super) fn end_steps(&mut self, why: &str) {
        let Some(stepping) = self.running.stepping.take() else { return };
        let why = format!("{why} after {} steps, {} were left", stepping.done, stepping.left);
        let result = failed(SimResult::RESULT_OPERATION_FAILED, why);
        match stepping.whose {
            Whose::Client(asker) => self.send_answer(asker, &StepSimulationResponse { result }),
            Whose::Goal(goal) => self.abort_goal(goal, result),
        }
    }
}
