//! One substep: the stages in order.

use super::{
    Controls, Model, Scratch, State, chamber,
    contact::{bodies, grains, membrane as sheet, plate, sums},
    integrate, membrane, neighbours,
    scratch::{PatchForces, PlateForce},
};
use crate::base::parallel;

/// Advances the state by `model.substep`.
pub fn substep(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    chamber::advance(&model.chamber, controls, state);
    neighbours::refresh(model, state, scratch);
    grains::forces(model, state, &mut scratch.pair_forces);
    grain_boundary_forces(model, state, scratch);
    bodies::forces(model, controls, state, &mut scratch.sample_forces);
    sums::on_membrane(model, controls, scratch);
    membrane::forces(&model.membrane, &state.membrane, state.gauge, &mut scratch.membrane);
    sums::on_flange(model, state, scratch);
    integrate::advance(model, controls, scratch, state);
}

/// What membrane and plate do to each grain.
fn grain_boundary_forces(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let mut patches = std::mem::take(&mut state.patches);
    scratch.patch_forces.resize(patches.len(), PatchForces::NONE);
    let lists = &scratch.neighbours;
    parallel::for_each_of_two(&mut scratch.patch_forces, &mut patches, |i, forces, patches| {
        *forces = sheet::forces(model, state, lists, i, patches);
    });
    state.patches = patches;
    let mut springs = std::mem::take(&mut state.plate_springs);
    scratch.plate_forces.resize(springs.len(), PlateForce::default());
    parallel::for_each_of_two(&mut scratch.plate_forces, &mut springs, |i, force, spring| {
        *force = plate::force(model, state, i, spring);
    });
    state.plate_springs = springs;
}
