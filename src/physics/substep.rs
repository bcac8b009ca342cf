//! One substep: the stages in order.

use super::{
    Controls, Model, Scratch, State, chamber,
    contact::{bodies, grains, membrane as sheet, spheres, sums, walls},
    integrate, membrane, neighbours,
};

/// A stage reads the state and writes its own part of state and scratch.
pub type Stage = fn(&Model, &Controls, &mut State, &mut Scratch);

/// All stages of a substep in order, by the names under which their time is told.
pub static STAGES: &[(&str, Stage)] = &[
    ("chamber", |model, controls, state, _| chamber::advance(&model.chamber, controls, state)),
    ("neighbours", |model, controls, state, scratch| {
        neighbours::refresh(model, controls, state, scratch);
    }),
    // Before those that touch the sheet: it brings its vertices into rows, which they read.
    ("membrane", |model, _, state, scratch| {
        membrane::forces(&model.membrane, &state.membrane, state.gauge, &mut scratch.membrane);
    }),
    ("contact_grains", |model, _, state, scratch| {
        let mut springs = std::mem::take(&mut state.springs.pairs);
        let Scratch { neighbours, grain_rows, pair_forces, .. } = scratch;
        grains::forces(model, state, &mut springs, neighbours, (grain_rows, pair_forces));
        state.springs.pairs = springs;
    }),
    ("contact_membrane", |model, _, state, scratch| {
        let mut springs = std::mem::take(&mut state.springs.patches);
        let Scratch { neighbours, grain_rows, membrane, candidates, patch_forces, .. } = scratch;
        let rows = (&**grain_rows, &*membrane.vertices);
        sheet::forces(model, state, &mut springs, neighbours, rows, (candidates, patch_forces));
        state.springs.patches = springs;
    }),
    ("contact_spheres", |model, _, state, scratch| {
        let mut springs = std::mem::take(&mut state.springs.spheres);
        spheres::forces(model, state, &mut springs, &mut scratch.sphere_forces);
        state.springs.spheres = springs;
    }),
    ("contact_walls", |model, _, state, scratch| {
        let mut springs = std::mem::take(&mut state.springs.walls);
        let Scratch { neighbours, wall_forces, .. } = scratch;
        walls::forces(model, state, &mut springs, neighbours, wall_forces);
        state.springs.walls = springs;
    }),
    ("contact_bodies", |model, controls, state, scratch| {
        let mut springs = std::mem::take(&mut state.springs.bodies);
        let Scratch { neighbours, sample_forces, .. } = scratch;
        bodies::forces(model, controls, state, &mut springs, (&neighbours.bodies, sample_forces));
        state.springs.bodies = springs;
    }),
    ("sums", |model, controls, state, scratch| {
        sums::on_membrane(model, controls, scratch);
        sums::on_walls(model, controls, state, scratch);
    }),
    ("integrate", |model, controls, state, scratch| {
        integrate::advance(model, controls, scratch, state);
    }),
];

/// Advances the state by `model.substep`.
pub fn substep(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    for (_, stage) in STAGES {
        stage(model, controls, state, scratch);
    }
}
