//! One substep: the stages in order.

use super::{
    Controls, Model, Scratch, State, chamber,
    contact::{bodies, grains, membrane as sheet, spheres, sums, walls},
    integrate, membrane, neighbours,
};

/// Advances the state by `model.substep`.
pub fn substep(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    chamber::advance(&model.chamber, controls, state);
    neighbours::refresh(model, state, scratch);
    forces(model, controls, state, scratch);
    sums::on_membrane(model, controls, scratch);
    sums::on_walls(model, controls, state, scratch);
    integrate::advance(model, controls, scratch, state);
}

/// Each stage reads the state and writes its own springs and forces.
fn forces(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    let mut springs = std::mem::take(&mut state.springs);
    let state_now = &*state;
    let Scratch { neighbours: lists, grain_rows, pair_forces, candidates, .. } = scratch;
    let Scratch { patch_forces, sphere_forces, wall_forces, .. } = scratch;
    grains::forces(model, state_now, &mut springs.pairs, lists, (grain_rows, pair_forces));
    let of_sheet = (&**grain_rows, candidates, patch_forces);
    sheet::forces(model, state_now, &mut springs.patches, lists, of_sheet);
    spheres::forces(model, state_now, &mut springs.spheres, sphere_forces);
    walls::forces(model, state_now, &mut springs.walls, lists, wall_forces);
    bodies::forces(model, controls, state_now, &mut springs.bodies, &mut scratch.sample_forces);
    membrane::forces(&model.membrane, &state_now.membrane, state_now.gauge, &mut scratch.membrane);
    state.springs = springs;
}
