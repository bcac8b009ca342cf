//! Lists of possible contacts. They include everything within contact plus the range of the law plus a skin, and are
//! rebuilt only when something has moved far enough to use up the skin.
//!
//! Displacements are relative to the carrier, the first wall, so moving the whole gripper does not cause rebuilds.
//! Code that moves grains, vertices or walls other than by `integrate`, or changes the bodies, must set
//! `Neighbors::is_built` to false. Contact history survives rebuilds: lists are sorted, and one pass over the old
//! and the new list transfers it.

mod body_list;
mod bounds; // bounding box of the grains
pub(crate) mod cell_grid;
mod crossings;
mod surface_list; // grains near triangulated walls and bodies
mod skin;
mod sphere_list;
mod triangle_list;
mod verlet_list;
mod wall_list;

use bounds::Bounds;

use super::{
    Controls, Model, Scratch, State,
    membrane::MembraneContact,
    scratch::{Neighbors, PatchForces},
    state::Patches,
};
use crate::base::Real;

/// Rebuilds the lists if they may be incomplete.
pub fn refresh(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    let Scratch { neighbors: lists, sample_forces, .. } = scratch;
    lists.bodies.is_built &= lists.is_built;
    let of_bodies = (&mut lists.bodies, sample_forces);
    body_list::refresh(model, controls, state, lists.vertex_travel, of_bodies);
    refresh_grains(model, controls, state, scratch);
}

/// Rebuilds all lists of grains if they may be incomplete.
fn refresh_grains(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    let lists = &mut scratch.neighbors;
    let used = 2.0 * used(model, controls, state, lists);
    // The factor reserves a part of the skin for the motion of the last substep, which is not measured yet.
    let is_complete = lists.is_built && used < 0.9 * lists.skin;
    if is_complete && !skin::is_too_thick(model, lists, used) {
        lists.n_since_build += 1;
        return;
    }
    // Motion before the first build, or by other code, is unknown.
    lists.skin = if lists.is_built { skin::optimal(model, lists, used) } else { model.skin };
    // In a periodic box there is no membrane, so only pairs use the wrapped grid.
    let positions = match &model.period {
        Some(period) => verlet_list::wrap(&state.grains.positions, period),
        None => state.grains.positions.clone(),
    };
    let grid = cell_grid::CellGrid::new(
        &positions,
        2.0 * model.radius_max + model.grain_law.range() + lists.skin,
    );
    verlet_list::build(model, &grid, &positions, state, lists);
    match model.membrane.contact {
        MembraneContact::Triangles => {
            triangle_list::build(model, &grid, state, lists);
            sphere_list::clear(state, lists);
        }
        MembraneContact::Spheres { radius } => {
            triangle_list::clear(state, lists);
            sphere_list::build(model, radius, &grid, state, lists);
            scratch.leaked = scratch.leaked.or_else(|| crossings::first(model, &grid, state));
        }
    }
    remove_patches(lists, &mut state.springs.patches, &mut scratch.patch_forces);
    let bounds = Bounds::of(&state.grains);
    wall_list::build(model, state, &bounds, lists, &mut scratch.wall_forces);
    surface_list::build(model, controls, state, (&grid, &bounds), lists);
    update_pair_masses(state, lists);
    lists.grain_positions.clone_from(&state.grains.positions);
    lists.vertex_positions.clone_from(&state.membrane.positions);
    lists.carrier_position = state.carrier_position();
    lists.radii.clone_from(&state.grains.radii);
    lists.growth_max = 0.0;
    lists.displacement_squared_max = 0.0;
    lists.is_built = true;
    lists.n_since_build = 0;
    lists.n_builds += 1;
}

/// Largest displacement or growth of anything since the last build (m).
fn used(model: &Model, controls: &Controls, state: &State, lists: &Neighbors) -> Real {
    if !lists.is_built {
        return 0.0;
    }
    let (moved, walls) =
        (lists.displacement_squared_max.sqrt(), wall_list::displacement(model, state, lists));
    let surfaces = walls.max(surface_list::displacement(model, controls, state, lists));
    // NaN counts as the largest displacement.
    lists.growth_max + if moved < surfaces { surfaces } else { moved }
}

/// Removes the patches of grains without candidate triangles, which have none until the next build.
fn remove_patches(lists: &Neighbors, springs: &mut [Patches], forces: &mut Vec<PatchForces>) {
    forces.resize(springs.len(), PatchForces::NONE);
    for (i, (patches, forces)) in springs.iter_mut().zip(forces).enumerate() {
        if lists.triangle_starts[i] == lists.triangle_starts[i + 1] {
            (patches.n, forces.n) = (0, 0);
        }
    }
}

/// Updates the effective radii and masses of the listed pairs. Must be called after radii or masses change.
pub fn update_pair_masses(state: &State, lists: &mut Neighbors) {
    let reduced = |a: f64, b: f64| a * b / (a + b);
    let of_pairs = |quantity: &[f64]| {
        let ids = state.pair_ids.iter().map(|ids| ids.map(|id| id as usize));
        ids.map(|[i, j]| reduced(quantity[i], quantity[j])).collect()
    };
    lists.pair_radii = of_pairs(&state.grains.radii);
    lists.pair_masses = of_pairs(&state.grains.masses);
    let growth = state.grains.radii.iter().zip(&lists.radii).map(|(now, then)| now - then);
    lists.wake_at.fill(0.0);
    lists.growth_max = growth.fold(0.0, f64::max);
}
