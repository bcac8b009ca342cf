//! One substep, as a list of stages.

use super::{
    Controls, Model, Scratch, State, chamber,
    contact::{bodies, grains, membrane as membrane_contact, spheres, sums, surfaces, walls},
    integrate, membrane, neighbors,
};

/// One stage of a substep. It reads model, controls and state, and writes its own part of state and scratch.
pub type Stage = fn(&Model, &Controls, &mut State, &mut Scratch);

/// All stages of a substep in order, with the names under which benchmarks report their times.
pub static STAGES: &[(&str, Stage)] = &[
    ("chamber", |model, controls, state, _| chamber::advance(&model.chamber, controls, state)),
    // This name is part of the JSON reports of benchmarks.
    ("neighbours", |model, controls, state, scratch| {
        neighbors::refresh(model, controls, state, scratch);
    }),
    // Before the contacts with the membrane, which read the rows of vertices that this stage writes.
    ("membrane", |model, _, state, scratch| {
        membrane::forces(&model.membrane, &state.membrane, state.gauge, &mut scratch.membrane);
    }),
    ("contact_grains", |model, _, state, scratch| {
        let State { grains, pair_ids, springs, .. } = state;
        grains::forces(model, grains, pair_ids, springs, scratch);
    }),
    ("contact_membrane", |model, _, state, scratch| {
        let State { grains, membrane, springs, .. } = state;
        membrane_contact::forces(model, grains, membrane, &mut springs.patches, scratch);
    }),
    ("contact_spheres", |model, _, state, scratch| {
        let State { grains, membrane, springs, .. } = state;
        let forces = &mut scratch.sphere_forces;
        spheres::forces(model, grains, membrane, &mut springs.spheres, forces);
    }),
    ("contact_walls", |model, controls, state, scratch| {
        let State { grains, walls, springs, .. } = state;
        walls::forces(model, walls, grains, &mut springs.walls, &mut scratch.wall_forces);
        surfaces::forces(model, controls, state, scratch);
    }),
    ("contact_bodies", |model, controls, state, scratch| {
        let State { membrane, springs, .. } = state;
        let Scratch { neighbors, sample_forces, .. } = scratch;
        let samples = (&neighbors.bodies, &mut **sample_forces);
        bodies::forces(model, controls, membrane, &mut springs.bodies, samples);
    }),
    ("sums", |model, controls, state, scratch| {
        sums::on_membrane(model, controls, scratch);
        sums::on_walls(model, controls, state, scratch);
        surfaces::react(model, controls, state, scratch);
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
