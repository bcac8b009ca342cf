//! One substep: the stages in order.

use super::{
    Controls, Model, Scratch, State, chamber,
    contact::{bodies, grains, membrane as sheet, plate, sums},
    integrate, membrane, neighbours,
    state::Springs,
};

/// Advances the state by `model.substep`.
pub fn substep(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    chamber::advance(&model.chamber, controls, state);
    neighbours::refresh(model, state, scratch);
    forces(model, controls, state, scratch);
    sums::on_membrane(model, controls, scratch);
    sums::on_flange(model, controls, state, scratch);
    integrate::advance(model, controls, scratch, state);
}

/// All forces at once: each stage reads the state and writes its own springs and forces.
fn forces(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    let mut springs = std::mem::take(&mut state.springs);
    let Springs { pairs, patches, plate: on_plate, bodies: on_bodies } = &mut springs;
    let Scratch { neighbours, pair_forces, patch_forces, plate_forces, sample_forces, .. } =
        scratch;
    let sheet_scratch = &mut scratch.membrane;
    let (state_now, lists) = (&*state, &*neighbours);
    rayon::join(
        || grains::forces(model, state_now, pairs, pair_forces),
        || {
            rayon::join(
                || {
                    sheet::forces(model, state_now, lists, patches, patch_forces);
                    plate::forces(model, state_now, on_plate, plate_forces);
                },
                || {
                    rayon::join(
                        || bodies::forces(model, controls, state_now, on_bodies, sample_forces),
                        || {
                            let (sheet, gauge) = (&state_now.membrane, state_now.gauge);
                            membrane::forces(&model.membrane, sheet, gauge, sheet_scratch);
                        },
                    )
                },
            )
        },
    );
    state.springs = springs;
}
