//! Who may touch whom: lists with a skin, built anew only when something has moved far enough.
//!
//! Distances are taken relative to the carrier, the first wall, so that carrying the whole gripper through the
//! room costs no rebuild. History outlives rebuilds: pairs stay sorted, and springs move by merge.

mod cell_grid;
mod crossings;
mod sphere_list;
mod triangle_list;
mod verlet_list;

use super::{
    Model, Scratch, State,
    membrane::SheetContact,
    scratch::{Neighbours, PairSize},
};

/// Builds the lists anew if they may have become incomplete.
pub fn refresh(model: &Model, state: &mut State, scratch: &mut Scratch) {
    let reach = model.skin / 2.0;
    // The factor keeps the last substep's motion, which is not measured yet, inside the skin.
    let limit = (0.9 * reach).powi(2);
    if scratch.neighbours.is_built && scratch.neighbours.displacement_squared_max < limit {
        return;
    }
    let lists = &mut scratch.neighbours;
    // In a periodic box there is no membrane, so the wrapped grid serves the pairs alone.
    let positions = match &model.period {
        Some(period) => verlet_list::wrap(&state.grains.positions, period),
        None => state.grains.positions.clone(),
    };
    let grid = cell_grid::CellGrid::new(&positions, 2.0 * model.radius_max + model.skin);
    verlet_list::build(model, &grid, &positions, state, lists);
    match model.membrane.contact {
        SheetContact::Triangles => {
            triangle_list::build(model, &grid, state, lists);
            sphere_list::clear(state, lists);
        }
        SheetContact::Spheres { radius } => {
            triangle_list::clear(state, lists);
            sphere_list::build(model, radius, &grid, state, lists);
            scratch.leaked = scratch.leaked.or_else(|| crossings::first(model, &grid, state));
        }
    }
    weigh_pairs(state, lists);
    lists.grain_positions.clone_from(&state.grains.positions);
    lists.vertex_positions.clone_from(&state.membrane.positions);
    lists.carrier_position = state.carrier_position();
    lists.displacement_squared_max = 0.0;
    lists.is_built = true;
    lists.n_builds += 1;
}

/// Effective radii and masses of the listed pairs; to be called again whenever grains grow.
pub fn weigh_pairs(state: &State, lists: &mut Neighbours) {
    let (radii, masses) = (&state.grains.radii, &state.grains.masses);
    let parallel = |a: f64, b: f64| a * b / (a + b);
    lists.pair_sizes.clear();
    lists.pair_sizes.extend(state.pair_ids.iter().map(|ids| {
        let [i, j] = ids.map(|id| id as usize);
        PairSize { radius: parallel(radii[i], radii[j]), mass: parallel(masses[i], masses[j]) }
    }));
}
