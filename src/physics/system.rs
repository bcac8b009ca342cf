//! Grains, membrane, chamber and walls with all that a substep needs, driven by whoever owns it.

use super::{
    Controls, Model, Scratch, State,
    boundary::body::BodyMotion,
    health::{self, Diverged},
    membrane::MembraneState,
    state::{Grains, Springs},
    substep,
    substep::STAGES,
};

/// One system.
#[derive(Clone)]
pub struct System {
    /// What it is made of.
    pub model: Model,
    /// What the outside wants.
    pub controls: Controls,
    /// What evolves.
    pub state: State,
    /// What the last substep computed.
    pub scratch: Scratch,
}

impl System {
    /// A system that has not moved yet.
    pub fn new(model: Model, controls: Controls, state: State) -> Self {
        let scratch = Scratch::new(&model);
        Self { model, controls, state, scratch }
    }

    /// Grains at rest in `model`, its membrane in its reference shape, walls at `walls`.
    pub fn at_rest(model: Model, walls: Vec<BodyMotion>, grains: Grains) -> Self {
        let n_samples = model.membrane.mesh.n_vertices() + model.membrane.mesh.triangles.len();
        let springs = Springs::none(grains.len(), n_samples * model.bodies.len());
        let state = State {
            grains,
            membrane: MembraneState::at_rest(&model.membrane.mesh),
            springs,
            pair_ids: Vec::new(),
            gauge: 0.0,
            walls: walls.clone(),
        };
        let controls = Controls { gauge_setpoint: 0.0, walls, bodies: Vec::new() };
        Self::new(model, controls, state)
    }

    /// Advances by one substep; walls move on at their velocities.
    pub fn step(&mut self) {
        self.move_walls();
        substep(&self.model, &self.controls, &mut self.state, &mut self.scratch);
    }

    /// The same, telling `after` the number of each stage of `STAGES` that is over.
    pub fn step_by_stages(&mut self, mut after: impl FnMut(usize)) {
        self.move_walls();
        for (k, (_, stage)) in STAGES.iter().enumerate() {
            stage(&self.model, &self.controls, &mut self.state, &mut self.scratch);
            after(k);
        }
    }

    fn move_walls(&mut self) {
        let dt = self.model.substep;
        self.controls.walls.iter_mut().for_each(|wall| wall.advance(dt));
    }

    /// Looks for what cannot go on; `tick` is only told in the fault.
    ///
    /// # Errors
    /// The first fault in a fixed order.
    pub fn check(&self, tick: u64) -> Result<(), Diverged> {
        health::check(&self.state, &self.scratch, tick)
    }
}
