//! One run in memory: tick, look, save, resume.

use serde::{Deserialize, Serialize};

use crate::{
    base::{Tick, Vec3, digest::Digest, parallel, real::Wrench},
    command::{
        Command, CommandRecord,
        apply::{Desk, Frames},
    },
    cosim::{
        Coupled, FLANGE, Inputs, Means,
        compile::Compiled,
        rapier_world::RapierWorld,
        saved_state::{self, SavedStateError},
    },
    physics::{
        State,
        fill::{self, Progress},
        health::{self, Diverged},
        measure,
    },
    scene::Scene,
};

/// A run.
pub struct Session {
    scene: Scene,
    coupled: Coupled,
    desk: Desk,
    tick: Tick,
    means: Means,
    records: Vec<CommandRecord>,
    digest: u64,
    normal_forces: Vec<f64>,
    pool: rayon::ThreadPool,
}

/// A run that has stopped between two ticks.
#[derive(Serialize, Deserialize)]
struct Saved<'a> {
    tick: u64,
    state: &'a [u8],
    world: &'a [u8],
    desk: &'a [u8],
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
        let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
        let saved: Saved<'_> =
            postcard::from_bytes(saved_state::unsealed(bytes)?).map_err(|_| corrupt)?;
        let state = compiled.read_state(saved.state)?;
        let mut session = Self::assemble(compiled, state);
        session.coupled.world.restore(saved.world)?;
        session.desk.restore(saved.desk)?;
        session.tick = Tick(saved.tick);
        session.digest = session.take_digest();
        Ok(session)
    }

    /// Everything that is needed to go on, as bytes.
    pub fn save(&self) -> Vec<u8> {
        let (state, world) = (saved_state::write(&self.coupled.state), self.coupled.world.save());
        let desk = self.desk.save();
        let saved = Saved { tick: self.tick.0, state: &state, world: &world, desk: &desk };
        saved_state::sealed(postcard::to_stdvec(&saved).expect("bytes always serialise"))
    }

    fn start(compiled: Compiled, mut state: State) -> Self {
        state.springs.bodies = vec![Vec3::zeros(); compiled.n_samples()];
        Self::assemble(compiled, state)
    }

    fn assemble(compiled: Compiled, state: State) -> Self {
        let Compiled { scene, model, plan, bulks, limits, pool, .. } = compiled;
        let step = plan.tick / measure::real(plan.n_substeps / plan.n_per_exchange);
        let world = RapierWorld::new(&scene, &model, bulks, step);
        let (n_objects, n_grains) = (scene.objects.len(), state.grains.positions.len());
        let desk = Desk::new(&scene);
        let coupled = Coupled::new(model, plan, state, world, limits);
        let still = vec![Wrench::zero(); n_objects];
        let mut session = Self {
            scene,
            coupled,
            desk,
            tick: Tick(0),
            means: Means {
                membrane_on_objects: still.clone(),
                contacts_on_objects: still,
                objects_on_gripper: Wrench::zero(),
                gripper_on_mount: Wrench::zero(),
            },
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
        let (inputs, records) = self.desk.take(commands, &frames, now_ns);
        self.records = records;
        self.advance(&inputs);
        self.tick = self.tick.next();
        let Coupled { model, state, scratch, .. } = &self.coupled;
        self.normal_forces = measure::normal_forces(state, scratch);
        self.digest = self.take_digest();
        health::check(model, state, scratch, self.tick.0)
    }

    fn advance(&mut self, inputs: &Inputs) {
        let Self { coupled, pool, means, .. } = self;
        *means = parallel::lead(pool, || coupled.advance(inputs));
    }

    fn frames(&self) -> Frames {
        let world = &self.coupled.world;
        Frames {
            flange: self.coupled.state.walls[FLANGE].pose,
            objects: (0..self.coupled.n_objects()).map(|i| world.motion(i).pose).collect(),
        }
    }

    fn take_digest(&self) -> u64 {
        let mut digest = Digest::new();
        digest.integer(self.tick.0);
        self.coupled.state.digest(&mut digest);
        self.coupled.world.digest(&mut digest);
        digest.finish()
    }

    /// The last tick that ended.
    pub fn now(&self) -> Tick {
        self.tick
    }

    /// Simulated time [ns].
    pub fn time_ns(&self) -> u64 {
        self.tick.time_ns(self.scene.time.tick_ns)
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

    /// Means over the last tick.
    pub fn means(&self) -> &Means {
        &self.means
    }

    /// Commands of the last tick, with their fate.
    pub fn records(&self) -> &[CommandRecord] {
        &self.records
    }

    /// The desk, for its counts.
    pub fn desk(&self) -> &Desk {
        &self.desk
    }

    /// Sum of normal force magnitudes on each grain at the end of the last tick [N].
    pub fn normal_forces(&self) -> &[f64] {
        &self.normal_forces
    }

    /// The settled start state as bytes for a cache. Only meaningful before the first tick.
    pub fn start_state(&self) -> Vec<u8> {
        saved_state::write(&self.coupled.state)
    }
}
