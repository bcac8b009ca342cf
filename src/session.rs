//! One run in memory: tick, look, save, resume.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{
    base::{
        Tick, Vec3,
        digest::Digest,
        parallel,
        real::{Wrench, real},
    },
    command::{
        Command, CommandRecord,
        apply::{CommandProcessor, Frames},
        change::{Change, Scope, SettledScene, TunableParameter},
    },
    cosim::{
        Coupled, FLANGE, Inputs, Means,
        compile::{Compiled, retune},
        rapier_world::RapierWorld,
        refused::ChangeError,
        saved_state::{self, SavedStateError},
    },
    measure,
    physics::{
        State, System,
        boundary::body::BodyMotion,
        fill::{self, Progress},
        health::{self, Diverged},
    },
    scene::{Object, Scene},
};

/// What a reset goes back to.
struct Start {
    /// The settled bag; `None` in a run that was taken up later and was not told.
    state: Option<State>,
    /// The scene's own objects.
    objects: Vec<Object>,
}

/// A run.
pub struct Session {
    /// Its objects are those that are there now.
    scene: Scene,
    start: Start,
    coupled: Coupled,
    processor: CommandProcessor,
    tick: Tick,
    /// Ticks since the start of the run, whatever became of simulated time.
    run_tick: Tick,
    means: Means,
    /// What the wrist sensor takes for zero, flange axes.
    sensor_zero: Wrench,
    /// True once another scene has taken the place of the first.
    is_loaded: bool,
    /// Properties that are not those of the scene any more.
    parameters: Vec<(TunableParameter, f64)>,
    records: Vec<CommandRecord>,
    digest: u64,
    normal_forces: Vec<f64>,
    pool: Arc<rayon::ThreadPool>,
}

/// A run that has stopped between two ticks.
#[derive(Serialize, Deserialize)]
struct Saved<'a> {
    tick: u64,
    run_tick: u64,
    state: &'a [u8],
    world: &'a [u8],
    processor: &'a [u8],
    /// Force and torque.
    sensor_zero: [[f64; 3]; 2],
    parameters: Vec<(TunableParameter, f64)>,
}

impl<'a> Saved<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self, SavedStateError> {
        let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
        postcard::from_bytes(saved_state::unsealed(bytes)?).map_err(|_| corrupt)
    }
}

impl Session {
    /// Fills the bag of a compiled scene; this takes a while, so `on_progress` is told.
    ///
    /// # Errors
    /// If the filling blows up or leaks.
    pub fn settle(
        compiled: Compiled,
        on_progress: &mut (dyn FnMut(Progress) + Send),
    ) -> Result<Self, Diverged> {
        let Compiled { scene, model, pool, .. } = &compiled;
        let state = parallel::lead(pool, || fill::fill(scene, model, on_progress))?;
        Ok(Self::start(compiled, state))
    }

    /// Goes on from a start state that was settled before.
    ///
    /// # Errors
    /// If the bytes are not a start state of this scene.
    pub fn from_start_state(compiled: Compiled, bytes: &[u8]) -> Result<Self, SavedStateError> {
        let state = compiled.read_start_state(bytes)?;
        Ok(Self::start(compiled, state))
    }

    /// Goes on from what `save` wrote, as if it had never stopped: the same bits from here on if
    /// the scene is the same. Values of the scene that no saved number depends on may differ.
    ///
    /// # Errors
    /// If the bytes are damaged or of a scene with other grains, meshes or objects.
    pub fn resume(compiled: Compiled, bytes: &[u8]) -> Result<Self, SavedStateError> {
        let saved = Saved::read(bytes)?;
        let state = compiled.read_state(saved.state)?;
        let mut session = Self::assemble(compiled, state);
        session.coupled.world.restore(saved.world)?;
        session.processor.restore(saved.processor)?;
        session.tick = Tick(saved.tick);
        session.run_tick = Tick(saved.run_tick);
        let [force, torque] = saved.sensor_zero.map(Vec3::from);
        session.sensor_zero = Wrench { force, torque };
        saved
            .parameters
            .iter()
            .for_each(|(parameter, value)| session.set_parameter(*parameter, *value));
        if 0 < saved.run_tick {
            session.start.state = None;
        }
        session.digest = session.take_digest();
        Ok(session)
    }

    /// Tells a run that was resumed what a reset goes back to: what `save` wrote at its start.
    ///
    /// # Errors
    /// If the bytes are damaged or of another scene.
    pub fn remember_start(&mut self, bytes: &[u8]) -> Result<(), SavedStateError> {
        let saved = Saved::read(bytes)?;
        let state = saved_state::read(saved.state)?;
        let now = &self.coupled.system.state;
        saved_state::same_counts(&[
            ("grains", state.grains.len(), now.grains.len()),
            ("vertices", state.membrane.positions.len(), now.membrane.positions.len()),
        ])?;
        self.start.state = Some(state);
        Ok(())
    }

    /// Everything that is needed to go on, as bytes; nothing while there are other objects than the
    /// scene's own, or in another order, or if the scene is not the first.
    pub fn save(&self) -> Option<Vec<u8>> {
        let names = |objects: &[Object]| objects.iter().map(|it| it.name.clone()).collect();
        let (there, own): (Vec<_>, Vec<_>) =
            (names(&self.scene.objects), names(&self.start.objects));
        if there != own || self.is_loaded {
            return None;
        }
        let (state, world) =
            (saved_state::write(&self.coupled.system.state), self.coupled.world.save());
        let processor = self.processor.save();
        let (tick, run_tick) = (self.tick.0, self.run_tick.0);
        let Wrench { force, torque } = self.sensor_zero;
        let sensor_zero = [force, torque].map(Into::into);
        let (state, world, processor, parameters) =
            (&state, &world, &processor, self.parameters.clone());
        let saved = Saved { tick, run_tick, state, world, processor, sensor_zero, parameters };
        Some(saved_state::sealed(postcard::to_stdvec(&saved).expect("bytes always serialise")))
    }

    /// Compares with what `save` wrote of another run: the first part that is not the same to the
    /// bit, if any is not.
    ///
    /// # Errors
    /// If the bytes are damaged.
    pub fn differs_from(&self, bytes: &[u8]) -> Result<Option<&'static str>, SavedStateError> {
        let other = Saved::read(bytes)?;
        let state = saved_state::read(other.state)?;
        let bits = |it: [[f64; 3]; 2]| it.map(|it| it.map(f64::to_bits));
        let Wrench { force, torque } = self.sensor_zero;
        let sensor_zero: [[f64; 3]; 2] = [force, torque].map(Into::into);
        let parameters = |parameters: &[(TunableParameter, f64)]| -> Vec<(TunableParameter, u64)> {
            parameters.iter().map(|(parameter, value)| (*parameter, value.to_bits())).collect()
        };
        let parts = [
            ("time", [self.tick.0, self.run_tick.0] == [other.tick, other.run_tick]),
            ("grains and membrane", saved_state::is_same(self.coupled.system.state.clone(), state)),
            ("rigid world", self.coupled.world.save() == other.world),
            ("what was commanded", self.processor.save() == other.processor),
            ("zero of the wrist sensor", bits(sensor_zero) == bits(other.sensor_zero)),
            ("parameters", parameters(&self.parameters) == parameters(&other.parameters)),
        ];
        Ok(parts.into_iter().find(|(_, is_same)| !is_same).map(|(part, _)| part))
    }

    fn start(compiled: Compiled, mut state: State) -> Self {
        state.springs.bodies = vec![Vec3::zeros(); compiled.n_samples()];
        Self::assemble(compiled, state)
    }

    fn assemble(compiled: Compiled, state: State) -> Self {
        let Compiled { scene, model, plan, bulks, limits, pool, .. } = compiled;
        let start = Start { state: Some(state.clone()), objects: scene.objects.clone() };
        let step = plan.tick / real(plan.n_substeps / plan.n_per_exchange);
        let world = RapierWorld::new(&scene, &model, bulks, step);
        let (n_objects, n_grains) = (scene.objects.len(), state.grains.positions.len());
        let processor = CommandProcessor::new(&scene);
        let coupled = Coupled::new(model, plan, state, world, limits);
        let mut session = Self {
            scene,
            start,
            coupled,
            processor,
            tick: Tick(0),
            run_tick: Tick(0),
            means: no_forces(n_objects),
            sensor_zero: Wrench::zero(),
            is_loaded: false,
            parameters: Vec::new(),
            records: Vec::new(),
            digest: 0,
            // Nothing is known of forces before the first tick.
            normal_forces: vec![0.0; n_grains],
            pool,
        };
        session.digest = session.take_digest();
        session
    }

    /// Advances by one tick under the commands that arrived since the last.
    ///
    /// # Errors
    /// If the system cannot go on; the state is then that of the fault.
    pub fn tick(&mut self, commands: &[Command]) -> Result<(), Diverged> {
        let now_ns = self.time_ns();
        let frames = self.frames();
        let (inputs, records) = self.processor.take(commands, &frames, now_ns);
        self.records = records;
        self.advance(&inputs);
        self.tick = self.tick.next();
        self.run_tick = self.run_tick.next();
        let System { state, scratch, .. } = &self.coupled.system;
        self.normal_forces = measure::normal_forces(state, scratch);
        self.digest = self.take_digest();
        health::check(state, scratch, self.tick.0)
    }

    /// Changes the world between two ticks.
    ///
    /// # Errors
    /// If the change cannot be made; nothing is changed then.
    pub fn change(&mut self, change: &Change) -> Result<(), ChangeError> {
        match change {
            Change::Reset(scope) => self.reset(*scope)?,
            Change::PlaceObject { object, pose, twist } => {
                let i = self.find(object)?;
                let motion = BodyMotion { pose: *pose, twist: *twist };
                self.coupled.place_object(&self.scene, i, &motion)?;
                self.processor.release(i);
            }
            Change::PlaceFlange { pose } => {
                self.coupled.place_flange(&self.scene, pose)?;
                self.processor.place_flange(*pose, self.time_ns());
            }
            Change::ZeroForceSensor => {
                self.sensor_zero = self.sensed();
                self.records.clear();
                return Ok(());
            }
            Change::SetParameter { parameter, value } => {
                self.set_parameter(*parameter, *value);
                self.records.clear();
                return Ok(());
            }
            Change::LoadScene(settled) => return self.load(settled),
            Change::Insert(object) => self.insert(object)?,
            Change::Remove { object } => {
                let i = self.find(object)?;
                self.remove(i);
            }
        }
        self.means = no_forces(self.scene.objects.len());
        self.normal_forces.fill(0.0);
        self.records.clear();
        self.digest = self.take_digest();
        Ok(())
    }

    fn set_parameter(&mut self, parameter: TunableParameter, value: f64) {
        parameter.set(&mut self.scene, value);
        if parameter == TunableParameter::ObjectFriction {
            self.start.objects.iter_mut().for_each(|it| it.friction = value);
        }
        retune(&self.scene, &mut self.coupled.system.model);
        self.parameters.retain(|(other, _)| *other != parameter);
        self.parameters.push((parameter, value));
    }

    /// Begins another scene; ticks of the run and counts of commands go on.
    fn load(&mut self, settled: &SettledScene) -> Result<(), ChangeError> {
        let SettledScene { scene, start, keeps_time } = settled;
        let [now, then] = [&self.scene, scene].map(|it| it.time.tick_ns);
        if now != then {
            let why = format!("its ticks are {then} ns long, those of this run {now} ns");
            return Err(ChangeError::Unusable(why));
        }
        let compiled = Compiled::new(scene, &self.pool)
            .map_err(|fault| ChangeError::Unusable(fault.to_string()))?;
        let mut next = Self::from_start_state(compiled, start)
            .map_err(|fault| ChangeError::Unusable(fault.to_string()))?;
        next.run_tick = self.run_tick;
        next.is_loaded = true;
        next.processor.count_on(self.processor.counts());
        if *keeps_time {
            next.tick = self.tick;
            next.processor.place_flange(scene.flange.pose, next.time_ns());
        }
        next.digest = next.take_digest();
        *self = next;
        Ok(())
    }

    fn reset(&mut self, scope: Scope) -> Result<(), ChangeError> {
        let is_own = |object: &Object| self.start.objects.iter().any(|it| it.name == object.name);
        if scope.state {
            let start = self.start.state.as_ref().ok_or(ChangeError::StartUnknown)?;
            let added = self.scene.objects.iter().filter(|it| !scope.spawned && !is_own(it));
            self.scene.objects = self.start.objects.iter().chain(added).cloned().collect();
            self.coupled.start_anew(&self.scene, start);
            self.processor.restart(&self.scene);
            self.sensor_zero = Wrench::zero();
        } else if scope.spawned {
            let objects = self.scene.objects.iter().enumerate();
            let added: Vec<usize> = objects.filter(|(_, it)| !is_own(it)).map(|(i, _)| i).collect();
            added.into_iter().rev().for_each(|i| self.remove(i));
        }
        if scope.time {
            self.tick = Tick(0);
            self.processor.restart_time();
        } else if scope.state {
            self.processor.place_flange(self.scene.flange.pose, self.time_ns());
        }
        Ok(())
    }

    fn insert(&mut self, object: &Object) -> Result<(), ChangeError> {
        let mut names = self.scene.objects.iter().chain(&self.start.objects);
        if names.any(|it| it.name == object.name) {
            return Err(ChangeError::NameTaken { object: object.name.clone() });
        }
        self.coupled.insert(&self.scene, object)?;
        self.scene.objects.push(object.clone());
        self.processor.insert(object);
        Ok(())
    }

    fn remove(&mut self, i: usize) {
        self.coupled.remove(i);
        self.scene.objects.remove(i);
        self.processor.remove(i);
    }

    fn find(&self, object: &str) -> Result<usize, ChangeError> {
        let objects = &self.scene.objects;
        objects.iter().position(|it| it.name == object).ok_or_else(|| {
            let known: Vec<&str> = objects.iter().map(|it| it.name.as_str()).collect();
            ChangeError::UnknownObject { object: object.to_owned(), known: known.join(", ") }
        })
    }

    fn advance(&mut self, inputs: &Inputs) {
        let Self { coupled, pool, means, .. } = self;
        *means = parallel::lead(pool, || coupled.advance(inputs));
    }

    fn frames(&self) -> Frames {
        let world = &self.coupled.world;
        Frames {
            flange: self.coupled.system.state.walls[FLANGE].pose,
            objects: (0..self.coupled.n_objects()).map(|i| world.motion(i).pose).collect(),
        }
    }

    fn take_digest(&self) -> u64 {
        let mut digest = Digest::new();
        digest.integer(self.tick.0);
        self.coupled.system.state.digest(&mut digest);
        self.coupled.world.digest(&mut digest);
        digest.finish()
    }

    /// The last tick that ended.
    pub fn now(&self) -> Tick {
        self.tick
    }

    /// Simulated time (ns).
    pub fn time_ns(&self) -> u64 {
        self.tick.time_ns(self.scene.time.tick_ns)
    }

    /// Ticks since the start of the run, whatever became of simulated time.
    pub fn run_tick(&self) -> Tick {
        self.run_tick
    }

    /// Time of the run [ns]: that of its ticks together.
    pub fn run_time_ns(&self) -> u64 {
        self.run_tick.time_ns(self.scene.time.tick_ns)
    }

    /// Digest of the whole state.
    pub fn digest(&self) -> u64 {
        self.digest
    }

    /// The scene of this run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The coupled system, to look at.
    pub fn coupled(&self) -> &Coupled {
        &self.coupled
    }

    /// What a wrist sensor feels that was never set to zero: the wrench of the whole gripper on its
    /// mount about the flange's origin, flange axes, mean over the last tick.
    fn sensed(&self) -> Wrench {
        let to_flange = self.coupled.system.state.walls[FLANGE].pose.rotation.inverse();
        let Wrench { force, torque } = self.means.gripper_on_mount;
        Wrench { force: to_flange * force, torque: to_flange * torque }
    }

    /// What the wrist sensor reads: what it feels less what it takes for zero.
    pub fn sensor(&self) -> Wrench {
        let (felt, zero) = (self.sensed(), self.sensor_zero);
        Wrench { force: felt.force - zero.force, torque: felt.torque - zero.torque }
    }

    /// Means over the last tick.
    pub fn means(&self) -> &Means {
        &self.means
    }

    /// Commands of the last tick, with their fate.
    pub fn records(&self) -> &[CommandRecord] {
        &self.records
    }

    /// The desk, for its counts.
    pub fn processor(&self) -> &CommandProcessor {
        &self.processor
    }

    /// Sum of normal force magnitudes on each grain at the end of the last tick (N).
    pub fn normal_forces(&self) -> &[f64] {
        &self.normal_forces
    }

    /// The settled start state as bytes for a cache. Only meaningful before the first tick.
    pub fn start_state(&self) -> Vec<u8> {
        saved_state::write(&self.coupled.system.state)
    }
}

/// Before a first tick nothing is known of forces.
fn no_forces(n_objects: usize) -> Means {
    Means {
        membrane_on_objects: vec![Wrench::zero(); n_objects],
        contacts_on_objects: vec![Wrench::zero(); n_objects],
        objects_on_gripper: Wrench::zero(),
        gripper_on_mount: Wrench::zero(),
    }
}
