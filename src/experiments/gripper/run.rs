//! One case: the membrane is filled, then one grip follows the other.

use serde::{Deserialize, Serialize};

use super::{
    build::{PreparedGrip, compile},
    cases::{Case, Change},
    measure::{self, Tick, is_past_peak, record_results},
    phase::Phase,
    scene::GripperScene,
};
use crate::{
    base::{Real, real::real},
    cosim::compile::CompileError,
    experiments::{Progress, ResumeError, Run, Stepped, record::Record, saved_run},
    measure::rest::unbalanced_force,
    physics::{
        Model, State, System,
        fill::{self, Filling},
        health::Diverged,
    },
};

/// Approximate number of substeps in a slice.
const SLICE: usize = 300;

/// What the run is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum RunState {
    /// Filling the membrane.
    Filling,
    /// A grip.
    Grip {
        /// Its index.
        grip: usize,
        /// Its phase.
        phase: Phase,
        /// Completed ticks of the phase.
        tick: usize,
        /// Completed ticks of the grip.
        tick_of_grip: usize,
    },
    /// All grips are done.
    Done,
}

/// A running case.
pub(super) struct GripperRun {
    scene: GripperScene,
    /// Model of the filling, and model of the settled state.
    models: [Model; 2],
    grips: Vec<PreparedGrip>,
    run_state: RunState,
    filling: Filling,
    system: Option<System>,
    /// State after filling, at rest.
    settled: Option<State>,
    /// State after relaxation around the object, if a later grip starts there.
    inserted: Option<State>,
    record: Record,
    n_expected: usize,
}

/// Everything needed to resume, in addition to the states: the current one, and the settled and the
/// inserted one if there are.
#[derive(Serialize, Deserialize)]
struct Saved {
    run_state: RunState,
    filling: fill::FillPosition,
    has_settled: bool,
    has_inserted: bool,
    record: Record,
}

impl GripperRun {
    /// The case before its first substep.
    pub(super) fn new(scene: &GripperScene, case: &Case) -> Result<Self, CompileError> {
        let mut scene = scene.clone();
        scene.gripper.seed += case.filling as u64;
        scene.gripper.grains.material.youngs_modulus = case.modulus;
        scene.gripper.grains.count = case.count;
        let mut soft = scene.clone();
        if let Some(modulus) = scene.accelerations.filling_modulus {
            soft.gripper.grains.material.youngs_modulus = modulus.min(case.modulus);
        }
        let models = [compile(&soft)?.0, compile(&scene)?.0];
        let prepared: Result<Vec<PreparedGrip>, CompileError> =
            case.grips.iter().map(|grip| PreparedGrip::new(&scene, grip, case)).collect();
        let grips = prepared?;
        let filling = Filling::new(&scene.gripper.scene(), &models[0], &models[1]);
        let of_grips: usize = grips.iter().map(PreparedGrip::n_substeps_expected).sum();
        let n_expected = filling.n_substeps_max() + of_grips;
        let record = Record {
            case: case.name.clone(),
            seed: scene.gripper.seed,
            columns: measure::columns(),
            ..Record::default()
        };
        Ok(Self {
            scene,
            models,
            grips,
            run_state: RunState::Filling,
            filling,
            system: None,
            settled: None,
            inserted: None,
            record,
            n_expected,
        })
    }

    fn state(&self) -> &State {
        self.system.as_ref().map_or(self.filling.state(), |system| &system.state)
    }

    fn fill(&mut self) -> Result<&'static str, Diverged> {
        let before = self.filling.position();
        self.filling.advance(SLICE)?;
        let after = self.filling.position();
        let name = before.stage.name();
        // A slice that ends a stage of the filling is counted for that stage as a whole.
        let n = if before.stage == after.stage { after.k - before.k } else { SLICE };
        self.record.count(name, n as u64);
        if self.filling.is_settled() {
            self.settled = Some(self.filling.state().clone());
            self.start_grip(0);
        }
        Ok(name)
    }

    /// Starts the grip with this index, or ends the case after the last one.
    fn start_grip(&mut self, grip: usize) {
        let Some(prepared) = self.grips.get(grip) else {
            self.run_state = RunState::Done;
            self.record.digest = saved_run::digest(self.state());
            return;
        };
        let phase = if prepared.is_inserted { Phase::Evacuate } else { Phase::Insert };
        self.run_state = RunState::Grip { grip, phase, tick: 0, tick_of_grip: 0 };
        let start = if prepared.is_inserted { &self.inserted } else { &self.settled };
        if let Some(state) = start {
            self.system = Some(prepared.system(state.clone()));
        }
    }

    fn grip(&mut self) -> Result<&'static str, Diverged> {
        let RunState::Grip { grip, phase, .. } = self.run_state else { return Ok("done") };
        let n_ticks = SLICE.div_ceil(self.grips[grip].n_substeps);
        for _ in 0..n_ticks {
            let is_over = self.tick()?;
            if is_over {
                break;
            }
        }
        Ok(phase.name())
    }

    /// One tick; returns true if it ends the phase.
    fn tick(&mut self) -> Result<bool, Diverged> {
        let RunState::Grip { grip, phase, tick, tick_of_grip } = self.run_state else {
            return Ok(true);
        };
        let low = self.settled.as_ref().map_or(0.0, lowest);
        let (prepared, Some(system)) = (&self.grips[grip], &mut self.system) else {
            return Ok(true);
        };
        let mut force = 0.0;
        for s in 0..prepared.n_substeps {
            let time = real(tick * prepared.n_substeps + s) * system.model.substep;
            prepared.control(&mut system.controls, phase, time, low);
            system.step();
            force += system.scratch.body_wrenches[0].force.z;
        }
        system.check(u64::try_from(tick_of_grip).unwrap_or(u64::MAX))?;
        let (tick, tick_of_grip) = (tick + 1, tick_of_grip + 1);
        let z = system.controls.bodies[0].pose.translation.vector.z;
        let row = Tick {
            time: real(tick_of_grip) * prepared.tick,
            grip,
            phase,
            penetration: z + prepared.scene.gripper.object.radius - low,
            force: force / real(prepared.n_substeps),
        };
        let (overlap, pressure, n_contacts) = measure::record_tick(&mut self.record, system, row);
        let speed = system.controls.bodies[0].twist.linear.norm();
        let validity = &mut self.record.validity;
        validity.overlap_over_diameter_max = validity.overlap_over_diameter_max.max(overlap);
        // Grips with a weaker vacuum need not be quasi-static; their number is a scalar.
        if phase == Phase::Withdraw {
            let inertial = prepared.inertial_number(speed, pressure);
            let name = format!("{}.inertial_number", prepared.change.name());
            let before = self.record.scalar(&name).unwrap_or(0.0);
            self.record.set(&name, inertial.max(before), "1");
            if !matches!(prepared.change, Change::Pressure(_)) {
                let validity = &mut self.record.validity;
                validity.inertial_number_max = validity.inertial_number_max.max(inertial);
            }
        }
        self.record.count(phase.name(), prepared.n_substeps as u64);
        self.run_state = RunState::Grip { grip, phase, tick, tick_of_grip };
        let is_free = phase == Phase::Withdraw
            && (n_contacts == 0
                || prepared.is_cut && is_past_peak(&self.record, grip, &prepared.scene));
        let is_over = is_free || prepared.duration(phase) <= real(tick) * prepared.tick;
        if is_over {
            self.end_phase(grip, phase, tick_of_grip);
        }
        Ok(is_over)
    }

    fn end_phase(&mut self, grip: usize, phase: Phase, tick_of_grip: usize) {
        let Some(system) = &self.system else { return };
        if matches!(phase, Phase::Relax | Phase::Hold) {
            let unbalanced = unbalanced_force(&system.model, &system.state, &system.scratch);
            let name = format!("{}.unbalanced_{}", self.grips[grip].change.name(), phase.name());
            self.record.set(&name, unbalanced, "1");
            let validity = &mut self.record.validity;
            validity.unbalanced_force = validity.unbalanced_force.max(unbalanced);
        }
        let is_needed = self.grips[grip + 1..].iter().any(|it| it.is_inserted);
        if grip == 0 && phase == Phase::Relax && is_needed {
            self.inserted = Some(system.state.clone());
        }
        match phase.next() {
            Some(phase) => self.run_state = RunState::Grip { grip, phase, tick: 0, tick_of_grip },
            None => {
                record_results(&mut self.record, grip, &self.grips[grip]);
                self.start_grip(grip + 1);
            }
        }
    }
}

/// Height of the lowest vertex (m).
fn lowest(state: &State) -> Real {
    state.membrane.positions.iter().map(|it| it.z).fold(Real::INFINITY, Real::min)
}

impl Run for GripperRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let phase = match self.run_state {
            RunState::Filling => self.fill()?,
            RunState::Grip { .. } => self.grip()?,
            RunState::Done => "done",
        };
        let n_done: u64 = self.record.n_substeps.values().sum();
        #[expect(clippy::cast_precision_loss, reason = "substeps are far below 2^53")]
        let share = n_done as Real / real(self.n_expected);
        let is_done = self.run_state == RunState::Done;
        Ok(Progress { phase, share: if is_done { 1.0 } else { share.min(1.0) }, is_done })
    }

    fn save(&self) -> Vec<u8> {
        let saved = Saved {
            run_state: self.run_state,
            filling: self.filling.position(),
            has_settled: self.settled.is_some(),
            has_inserted: self.inserted.is_some(),
            record: self.record.clone(),
        };
        let states = [Some(self.state()), self.settled.as_ref(), self.inserted.as_ref()];
        saved_run::pack(&self.record.case, &saved, states.into_iter().flatten())
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let error = |reason: &str| saved_run::error(reason.to_owned());
        let (saved, states): (Saved, _) = saved_run::unpack_any(&self.record.case, bytes)?;
        let mut states = states.into_iter();
        let mut next = || states.next().ok_or_else(|| error("a state is missing"));
        let state = next()?;
        saved_run::check_scene(&state, self.state())?;
        self.settled = saved.has_settled.then(&mut next).transpose()?;
        self.inserted = saved.has_inserted.then(&mut next).transpose()?;
        self.run_state = saved.run_state;
        self.record = saved.record;
        match self.run_state {
            RunState::Filling => {
                let [soft, goal] = &self.models;
                let from = (saved.filling, state);
                self.filling = Filling::resume(&self.scene.gripper.scene(), soft, goal, from);
                self.system = None;
            }
            RunState::Grip { grip, .. } => {
                let prepared = self.grips.get(grip).ok_or_else(|| error("it has other grips"))?;
                self.system = Some(prepared.system(state));
            }
            RunState::Done => {
                self.system = self.grips.last().map(|prepared| prepared.system(state));
            }
        }
        Ok(())
    }

    fn record(&self) -> Record {
        self.record.clone()
    }

    fn stepped(&self) -> Option<Stepped<'_>> {
        self.system.as_ref().map(|system| Stepped { system, after: |_| {} })
    }
}
