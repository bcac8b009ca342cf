//! A system of grains, membranes, air and walls: model, controls, state and scratch.

use std::iter::repeat;

use super::{
    Controls, Model, Scratch, State,
    boundary::motion::{WallMemory, WallMotion},
    builder::WallId,
    health::{self, Diverged},
    state::Springs,
    substep,
    substep::STAGES,
};
use crate::base::{Real, Vec3};

/// A system of grains, membranes, air and walls.
#[derive(Clone)]
pub struct System {
    /// What the system consists of.
    pub model: Model,
    /// Inputs of the next substep.
    pub controls: Controls,
    /// Everything that changes.
    pub state: State,
    /// What the last substep has computed.
    pub scratch: Scratch,
}

impl System {
    /// A system at its initial state.
    pub fn new(model: Model, controls: Controls, state: State) -> Self {
        let scratch = Scratch::new(&model);
        Self { model, controls, state, scratch }
    }

    /// Advances by one substep. Walls move as their `WallMotion` prescribes.
    pub fn step(&mut self) {
        self.move_walls();
        substep(&self.model, &self.controls, &mut self.state, &mut self.scratch);
        self.update_wall_memory();
    }

    /// Like `step`, and calls `after` with the index in `STAGES` of each completed stage.
    pub fn step_by_stages(&mut self, mut after: impl FnMut(usize)) {
        self.move_walls();
        for (k, (_, stage)) in STAGES.iter().enumerate() {
            stage(&self.model, &self.controls, &mut self.state, &mut self.scratch);
            after(k);
        }
        self.update_wall_memory();
    }

    /// Replaces the motion of a wall. The new motion starts now, at the wall's current pose.
    ///
    /// # Panics
    /// If there is no such wall.
    pub fn set_wall_motion(&mut self, wall: WallId, motion: WallMotion) {
        self.model.walls[wall.index()].motion = motion;
        if let Some(memory) = self.state.wall_memory.get_mut(wall.index()) {
            memory.time = 0.0;
        }
    }

    /// Adds a grain at rest while a system is set up, and returns its index. Discards the history of all contacts.
    pub fn add_grain(&mut self, position: Vec3, radius: Real, mass: Real) -> usize {
        let Self { model, state, scratch, .. } = self;
        let grains = &mut state.grains;
        grains.positions.push(position);
        grains.velocities.push(Vec3::zeros());
        grains.angular_velocities.push(Vec3::zeros());
        grains.radii.push(radius);
        grains.masses.push(mass);
        model.radius_max = model.radius_max.max(radius);
        model.radius_mean = grains.mean_radius();
        let n_samples = model.n_samples() * model.bodies.len();
        state.springs = Springs::none(grains.len(), n_samples);
        state.pair_ids.clear();
        *scratch = Scratch::new(model);
        grains.len() - 1
    }

    /// Continues from another state of the same model.
    pub fn restart(&mut self, state: State) {
        self.controls.walls.clone_from(&state.walls);
        self.scratch = Scratch::new(&self.model);
        self.state = state;
    }

    fn move_walls(&mut self) {
        let Self { model, controls, state, .. } = self;
        let dt = model.substep;
        if model.walls.iter().any(|wall| wall.motion.needs_memory()) {
            state.wall_memory.resize(model.walls.len(), WallMemory::default());
        }
        let memories = state.wall_memory.iter().copied().chain(repeat(WallMemory::default()));
        for ((wall, model), memory) in controls.walls.iter_mut().zip(&model.walls).zip(memories) {
            if let Some(twist) = model.motion.twist(&wall.pose, &memory, dt) {
                wall.twist = twist;
            }
            wall.advance(dt);
        }
    }

    fn update_wall_memory(&mut self) {
        let wrenches = &self.scratch.wall_wrenches;
        for (w, memory) in self.state.wall_memory.iter_mut().enumerate() {
            memory.time += self.model.substep;
            if let WallMotion::Servo(servo) = &self.model.walls[w].motion {
                memory.force = -servo.axis.dot(&wrenches[w].force);
            }
        }
    }

    /// Checks that the run can continue; the error names `tick`.
    ///
    /// # Errors
    /// The first problem in a fixed order.
    pub fn check(&self, tick: u64) -> Result<(), Diverged> {
        health::check(&self.state, &self.scratch, tick)
    }
}
