//! Grains that a wall may touch.

use super::cell_grid::id;
use crate::{
    base::Real,
    physics::{
        Model, State,
        scratch::{Neighbours, WallForce},
    },
};

/// Lists the walls that each grain is closer to than contact plus skin.
pub(super) fn build(
    model: &Model,
    state: &State,
    lists: &mut Neighbours,
    wall_forces: &mut [WallForce],
) {
    let n_grains = state.grains.len();
    for &[w, i] in &lists.walls {
        if let Some(force) = wall_forces.get_mut(w as usize * n_grains + i as usize) {
            *force = WallForce::default();
        }
    }
    lists.wall_starts.clear();
    lists.wall_starts.push(0);
    lists.walls.clear();
    lists.wall_extents.clear();
    lists.wall_extents.resize(model.walls.len(), 0.0);
    for (i, position) in state.grains.positions.iter().enumerate() {
        for (w, (wall, motion)) in model.walls.iter().zip(&state.walls).enumerate() {
            let arm = position - motion.pose.translation.vector;
            lists.wall_extents[w] = lists.wall_extents[w].max(arm.norm() + lists.skin);
            let cut = state.grains.radii[i] + lists.skin;
            if wall.shape.distance(motion, &arm).is_some_and(|(distance, _)| distance < cut) {
                lists.walls.push([w, i].map(id));
            }
        }
        lists.wall_starts.push(id(lists.walls.len()));
    }
    lists.walls_at_build.clone_from(&state.walls);
}

/// How far any wall has come towards the grains since the last build, relative to the carrier [m].
pub(super) fn displacement(model: &Model, state: &State, lists: &Neighbours) -> Real {
    let carried = state.carrier_position() - lists.carrier_position;
    let walls = model.walls.iter().zip(&lists.walls_at_build).zip(&state.walls);
    walls
        .zip(&lists.wall_extents)
        .map(|(((wall, from), to), extent)| wall.shape.displacement(from, to, &carried, *extent))
        .fold(0.0, Real::max)
}
