//! Who may touch whom: lists with a skin, built anew only when something has moved far enough.
//!
//! Distances are taken relative to the flange, so that carrying the whole gripper through the
//! room costs no rebuild. History outlives rebuilds: pairs stay sorted, and springs move by merge.

mod cell_grid;
mod triangle_list;
mod verlet_list;

use super::{Model, Scratch, State};

/// Builds the lists anew if they may have become incomplete.
pub fn refresh(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let reach = model.skin / 2.0;
    // The factor keeps the last substep's motion, which is not measured yet, inside the skin.
    let limit = (0.9 * reach).powi(2);
    if scratch.neighbours.is_built && scratch.neighbours.displacement_squared_max < limit {
        return;
    }
    let lists = &mut scratch.neighbours;
    let grid =
        cell_grid::CellGrid::new(&state.grains.positions, 2.0 * model.radius_max + model.skin);
    verlet_list::build(model, &grid, state, lists);
    triangle_list::build(model, &grid, state, lists);
    lists.grain_positions.clone_from(&state.grains.positions);
    lists.vertex_positions.clone_from(&state.membrane.positions);
    lists.flange_position = state.flange.translation.vector;
    lists.displacement_squared_max = 0.0;
    lists.is_built = true;
    lists.n_builds += 1;
}
