//! Grains, membrane, chamber and walls with all that a substep needs, driven by whoever owns it.

use super::{
    Controls, Model, Scratch, State,
    health::{self, Diverged},
    substep,
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

    /// Advances by one substep; walls move on at their velocities.
    pub fn step(&mut self) {
        let dt = self.model.substep;
        for wall in &mut self.controls.walls {
            wall.advance(dt);
        }
        substep(&self.model, &self.controls, &mut self.state, &mut self.scratch);
    }

    /// Looks for what cannot go on; `tick` is only told in the fault.
    ///
    /// # Errors
    /// The first fault in a fixed order.
    pub fn check(&self, tick: u64) -> Result<(), Diverged> {
        health::check(&self.model, &self.state, &self.scratch, tick)
    }
}
