//! A case on its way: the bag is filled, then one grip after the other.

use serde::{Deserialize, Serialize};

use super::{
    build::{Ready, compile},
    cases::{Case, Change},
    measure::{self, When},
    phase::Phase,
    scene::GripperScene,
    summary::{has_passed, summarise},
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

/// Substeps in a slice of work, about.
const SLICE: usize = 300;

/// How far a case is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Place {
    /// The bag is filled.
    Filling,
    /// A grip.
    Grip {
        /// Its number.
        grip: usize,
        /// What is done.
        phase: Phase,
        /// Ticks of the phase that are over.
        tick: usize,
        /// Ticks of the grip that are over.
        tick_of_grip: usize,
    },
    /// All grips are over.
    Done,
}

/// A case on its way.
pub(super) struct GripRun {
    scene: GripperScene,
    /// The model in which the bag is filled, and that of the settled bag.
    models: [Model; 2],
    grips: Vec<Ready>,
    place: Place,
    filling: Filling,
    system: Option<System>,
    /// When everything had come to rest.
    settled: Option<State>,
    /// When the bag had relaxed around the object, if a later grip begins there.
    inserted: Option<State>,
    record: Record,
    n_expected: usize,
}

/// What is written down of a case that is broken off, besides its states: the present one, and those
/// that are settled and inserted if there are.
#[derive(Serialize, Deserialize)]
struct Saved {
    place: Place,
    filling: fill::FillPosition,
    has_settled: bool,
    has_inserted: bool,
    record: Record,
}

impl GripRun {
    /// A case before its first substep.
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
        let ready: Result<Vec<Ready>, CompileError> =
            case.grips.iter().map(|grip| Ready::new(&scene, grip, case)).collect();
        let grips = ready?;
        let filling = Filling::new(&scene.gripper, &models[0], &models[1]);
        let of_grips: usize = grips.iter().map(Ready::n_substeps_expected).sum();
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
            place: Place::Filling,
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
        // A slice that ends a stage is counted under its name as a whole.
        let n = if before.stage == after.stage { after.k - before.k } else { SLICE };
        *self.record.n_substeps.entry(name.to_owned()).or_default() += n as u64;
        if self.filling.is_settled() {
            self.settled = Some(self.filling.state().clone());
            self.begin(0);
        }
        Ok(name)
    }

    /// Begins the grip of this number, or ends the case after the last.
    fn begin(&mut self, grip: usize) {
        let Some(ready) = self.grips.get(grip) else {
            self.place = Place::Done;
            self.record.digest = saved_run::digest(self.state());
            return;
        };
        let phase = if ready.is_inserted { Phase::Evacuate } else { Phase::Insert };
        self.place = Place::Grip { grip, phase, tick: 0, tick_of_grip: 0 };
        let start = if ready.is_inserted { &self.inserted } else { &self.settled };
        if let Some(state) = start {
            self.system = Some(ready.system(state.clone()));
        }
    }

    fn grip(&mut self) -> Result<&'static str, Diverged> {
        let Place::Grip { grip, phase, .. } = self.place else { return Ok("done") };
        let n_ticks = SLICE.div_ceil(self.grips[grip].n_substeps);
        for _ in 0..n_ticks {
            let is_over = self.tick()?;
            if is_over {
                break;
            }
        }
        Ok(phase.name())
    }

    /// One tick; true if the phase is over with it.
    fn tick(&mut self) -> Result<bool, Diverged> {
        let Place::Grip { grip, phase, tick, tick_of_grip } = self.place else { return Ok(true) };
        let low = self.settled.as_ref().map_or(0.0, lowest);
        let (ready, Some(system)) = (&self.grips[grip], &mut self.system) else { return Ok(true) };
        let mut force = 0.0;
        for s in 0..ready.n_substeps {
            let time = real(tick * ready.n_substeps + s) * system.model.substep;
            ready.control(&mut system.controls, phase, time, low);
            system.step();
            force += system.scratch.body_wrenches[0].force.z;
        }
        system.check(u64::try_from(tick_of_grip).unwrap_or(u64::MAX))?;
        let (tick, tick_of_grip) = (tick + 1, tick_of_grip + 1);
        let z = system.controls.bodies[0].pose.translation.vector.z;
        let when = When {
            time: real(tick_of_grip) * ready.tick,
            grip,
            phase,
            penetration: z + ready.scene.object_radius() - low,
            force: force / real(ready.n_substeps),
        };
        let (overlap, pressure, n_contacts) = measure::look(&mut self.record, system, when);
        let speed = system.controls.bodies[0].twist.linear.norm();
        let validity = &mut self.record.validity;
        validity.overlap_over_diameter_max = validity.overlap_over_diameter_max.max(overlap);
        // A weaker vacuum is not claimed to be pulled slowly enough; its number is a scalar.
        if phase == Phase::Withdraw {
            let inertial = ready.inertial_number(speed, pressure);
            let name = format!("{}.inertial_number", ready.change.name());
            let before = self.record.scalar(&name).unwrap_or(0.0);
            self.record.set(&name, inertial.max(before), "1");
            if !matches!(ready.change, Change::Pressure(_)) {
                let validity = &mut self.record.validity;
                validity.inertial_number_max = validity.inertial_number_max.max(inertial);
            }
        }
        *self.record.n_substeps.entry(phase.name().to_owned()).or_default() +=
            ready.n_substeps as u64;
        self.place = Place::Grip { grip, phase, tick, tick_of_grip };
        let is_let_go = phase == Phase::Withdraw
            && (n_contacts == 0 || ready.is_cut && has_passed(&self.record, grip, &ready.scene));
        let is_over = is_let_go || ready.duration(phase) <= real(tick) * ready.tick;
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
        let is_wanted = self.grips[grip + 1..].iter().any(|it| it.is_inserted);
        if grip == 0 && phase == Phase::Relax && is_wanted {
            self.inserted = Some(system.state.clone());
        }
        match phase.next() {
            Some(phase) => self.place = Place::Grip { grip, phase, tick: 0, tick_of_grip },
            None => {
                summarise(&mut self.record, grip, &self.grips[grip]);
                self.begin(grip + 1);
            }
        }
    }
}

/// Height of the lowest vertex [m].
fn lowest(state: &State) -> Real {
    state.membrane.positions.iter().map(|it| it.z).fold(Real::INFINITY, Real::min)
}

impl Run for GripRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let stage = match self.place {
            Place::Filling => self.fill()?,
            Place::Grip { .. } => self.grip()?,
            Place::Done => "done",
        };
        let n_done: u64 = self.record.n_substeps.values().sum();
        #[expect(clippy::cast_precision_loss, reason = "substeps are far below 2^53")]
        let share = n_done as Real / real(self.n_expected);
        let is_done = self.place == Place::Done;
        Ok(Progress { stage, share: if is_done { 1.0 } else { share.min(1.0) }, is_done })
    }

    fn save(&self) -> Vec<u8> {
        let saved = Saved {
            place: self.place,
            filling: self.filling.position(),
            has_settled: self.settled.is_some(),
            has_inserted: self.inserted.is_some(),
            record: self.record.clone(),
        };
        let states = [Some(self.state()), self.settled.as_ref(), self.inserted.as_ref()];
        saved_run::pack(&self.record.case, &saved, states.into_iter().flatten())
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let reason = |reason: &str| saved_run::refusal(reason.to_owned());
        let (saved, states): (Saved, _) = saved_run::unpack_any(&self.record.case, bytes)?;
        let mut states = states.into_iter();
        let mut next = || states.next().ok_or_else(|| reason("a state is missing"));
        let state = next()?;
        saved_run::of_one_scene(&state, self.state())?;
        self.settled = saved.has_settled.then(&mut next).transpose()?;
        self.inserted = saved.has_inserted.then(&mut next).transpose()?;
        self.place = saved.place;
        self.record = saved.record;
        match self.place {
            Place::Filling => {
                let [soft, goal] = &self.models;
                let from = (saved.filling, state);
                self.filling = Filling::resume(&self.scene.gripper, soft, goal, from);
                self.system = None;
            }
            Place::Grip { grip, .. } => {
                let ready = self.grips.get(grip).ok_or_else(|| reason("it has other grips"))?;
                self.system = Some(ready.system(state));
            }
            Place::Done => {
                self.system = self.grips.last().map(|ready| ready.system(state));
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
