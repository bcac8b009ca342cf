//! One run in memory: tick, inspect, save, resume.

mod change; // discontinuous changes between ticks
mod saved; // save and resume

use crate::{
    base::{
        Tick, Vec3,
        digest::Digest,
        parallel::{self, ThreadPool},
        real::{Wrench, real},
    },
    command::{
        Command, CommandRecord,
        apply::{CommandProcessor, Frames},
        change::TunableParameter,
    },
    cosim::{
        Coupled, FLANGE, Inputs, Means,
        compile::{CompileError, Compiled},
        rapier_world::RapierWorld,
        saved_state::{self, SavedStateError},
    },
    measure,
    physics::{
        State, System,
        fill::{self, Progress},
        health::{self, Diverged},
    },
    scene::{Object, Scene},
};

/// Why a session could not be created.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SessionError {
    /// The scene cannot be simulated.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// Filling the membrane with grains diverged.
    #[error("filling the membrane: {0}")]
    Settle(#[from] Diverged),
}

/// What a reset restores.
struct Start {
    /// The settled state; `None` if the session was resumed and `remember_start` was not called.
    state: Option<State>,
    /// The objects of the scene.
    objects: Vec<Object>,
}

/// A gripper over its objects, simulated tick by tick.
///
/// A session starts with the membrane filled and vented, the flange and the objects at rest at
/// the poses of the scene. The same scene, commands and seed give the same bits on one machine,
/// for any number of solver threads.
pub struct Session {
    /// The scene, with the objects that exist now.
    scene: Scene,
    start: Start,
    coupled: Coupled,
    processor: CommandProcessor,
    tick: Tick,
    /// Ticks since the start of the run; not reset with simulated time.
    run_tick: Tick,
    means: Means,
    /// Wrench at which the wrist sensor was zeroed, flange axes.
    sensor_zero: Wrench,
    /// True once another scene was loaded.
    is_loaded: bool,
    /// Parameters that were changed since the start.
    parameters: Vec<(TunableParameter, f64)>,
    records: Vec<CommandRecord>,
    digest: u64,
    normal_forces: Vec<f64>,
    pool: ThreadPool,
}

impl Session {
    /// Fills the membrane of `scene` with grains and returns the session before its first tick.
    /// The threads of `pool` run it. Filling a scene takes seconds to minutes; see
    /// [`Session::start_state`] for a way to do it once.
    ///
    /// # Errors
    /// If the scene cannot be simulated or its filling diverges.
    pub fn new(scene: &Scene, pool: &ThreadPool) -> Result<Self, SessionError> {
        Ok(Self::settle(Compiled::new(scene, pool)?, &mut |_| {})?)
    }

    /// Like [`Session::new`] for a compiled scene; `on_progress` is called while it is filled.
    ///
    /// # Errors
    /// If the filling diverges or a grain leaks through the membrane.
    pub fn settle(
        compiled: Compiled,
        on_progress: &mut (dyn FnMut(Progress) + Send),
    ) -> Result<Self, Diverged> {
        let Compiled { scene, model, pool, .. } = &compiled;
        let state = parallel::lead(pool, || fill::fill(scene, model, on_progress))?;
        Ok(Self::start(compiled, state))
    }

    /// Starts from a state that `start_state` returned.
    ///
    /// # Errors
    /// If the bytes are not a start state of this scene.
    pub fn from_start_state(compiled: Compiled, bytes: &[u8]) -> Result<Self, SavedStateError> {
        let state = compiled.read_start_state(bytes)?;
        Ok(Self::start(compiled, state))
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
            // Forces are computed by the first tick.
            normal_forces: vec![0.0; n_grains],
            pool,
        };
        session.digest = session.take_digest();
        session
    }

    /// Applies `commands` in their order and advances by one tick, `scene.time.tick_ns`.
    ///
    /// A command that cannot be applied is rejected and recorded, see [`Session::records`]; it is
    /// not an error.
    ///
    /// # Errors
    /// If the simulation diverges or a grain leaks through the membrane. The session then holds
    /// the state at the error and cannot be continued.
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

    /// Number of the last completed tick.
    pub fn now(&self) -> Tick {
        self.tick
    }

    /// Simulated time (ns).
    pub fn time_ns(&self) -> u64 {
        self.tick.time_ns(self.scene.time.tick_ns)
    }

    /// Ticks since the start of the run. Unlike `now` it is not reset with simulated time.
    pub fn run_tick(&self) -> Tick {
        self.run_tick
    }

    /// Simulated time since the start of the run (ns); not reset with simulated time.
    pub fn run_time_ns(&self) -> u64 {
        self.run_tick.time_ns(self.scene.time.tick_ns)
    }

    /// Digest of the whole state. Equal digests mean equal states.
    pub fn digest(&self) -> u64 {
        self.digest
    }

    /// The scene, with the objects that exist now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The coupled system: grains, membrane, chamber and rigid world.
    pub fn coupled(&self) -> &Coupled {
        &self.coupled
    }

    /// Reading of a wrist sensor that was never zeroed: the wrench of the whole gripper on its
    /// mount about the origin of the flange, flange axes, mean over the last tick.
    fn sensed(&self) -> Wrench {
        let to_flange = self.coupled.system.state.walls[FLANGE].pose.rotation.inverse();
        let Wrench { force, torque } = self.means.gripper_on_mount;
        Wrench { force: to_flange * force, torque: to_flange * torque }
    }

    /// Reading of the wrist sensor: wrench of the gripper on its mount (N, N m) about the origin of
    /// the flange, flange axes, mean over the last tick, minus the reading at the last zeroing.
    pub fn sensor(&self) -> Wrench {
        let (raw, zero) = (self.sensed(), self.sensor_zero);
        Wrench { force: raw.force - zero.force, torque: raw.torque - zero.torque }
    }

    /// Forces averaged over the last tick.
    pub fn means(&self) -> &Means {
        &self.means
    }

    /// Commands of the last tick and their outcomes.
    pub fn records(&self) -> &[CommandRecord] {
        &self.records
    }

    /// The command processor, with its setpoints and counts.
    pub fn processor(&self) -> &CommandProcessor {
        &self.processor
    }

    /// Sum of normal force magnitudes on each grain at the end of the last tick (N).
    pub fn normal_forces(&self) -> &[f64] {
        &self.normal_forces
    }

    /// The settled state as bytes for a cache. Call it before the first tick.
    pub fn start_state(&self) -> Vec<u8> {
        saved_state::write(&self.coupled.system.state)
    }
}

/// Zero forces, before the first tick.
fn no_forces(n_objects: usize) -> Means {
    Means {
        membrane_on_objects: vec![Wrench::zero(); n_objects],
        contacts_on_objects: vec![Wrench::zero(); n_objects],
        objects_on_gripper: Wrench::zero(),
        gripper_on_mount: Wrench::zero(),
    }
}
