//! Lists of the grains that a wall may touch.

use super::{
    Bounds,
    cell_grid::id,
    verlet_list::{index_by_second, kept_memories, kept_springs},
};
use crate::{
    base::Real,
    physics::{
        Model, State,
        boundary::wall::WallShape,
        scratch::{Neighbors, WallForce},
        state::ListedSprings,
    },
};

/// Lists, wall by wall, the grains within contact plus the range of the wall's law plus the skin. The history of
/// contacts that were listed before is kept. Walls far from all grains are skipped.
pub(super) fn build(
    model: &Model,
    state: &mut State,
    bounds: &Bounds,
    lists: &mut Neighbors,
    wall_forces: &mut Vec<WallForce>,
) {
    let mut ids = Vec::new();
    lists.wall_extents.clear();
    lists.wall_gaps.clear();
    for (w, (wall, motion)) in model.walls.iter().zip(&state.walls).enumerate() {
        let shape = wall.shape.placed(motion);
        let beyond = wall.law.range() + lists.skin;
        let gap = bounds.gap_to_wall(wall, &shape, motion, beyond);
        lists.wall_gaps.push(gap);
        let mut extent: Real = 0.0;
        if let WallShape::Triangles(triangles) = &wall.shape {
            lists.wall_extents.push(triangles.bounding_radius());
            continue;
        }
        if gap > 0.0 {
            let furthest = bounds.furthest_from(&motion.pose.translation.vector);
            lists.wall_extents.push(furthest + lists.skin);
            continue;
        }
        for (i, position) in state.grains.positions.iter().enumerate() {
            let arm = position - motion.pose.translation.vector;
            extent = extent.max(arm.norm() + lists.skin);
            let cut = state.grains.radii[i] + beyond;
            if shape.distance(&arm).is_some_and(|(distance, _)| distance < cut) {
                ids.push([w, i].map(id));
            }
        }
        lists.wall_extents.push(extent);
    }
    (lists.wall_starts, lists.wall_contacts) = index_by_second(&ids, state.grains.len());
    let before = &state.springs.walls;
    let springs = kept_springs(&before.ids, &before.springs, &ids);
    let memories = kept_memories(&before.ids, &before.memories, &ids);
    wall_forces.clear();
    wall_forces.resize(ids.len(), WallForce::default());
    state.springs.walls = ListedSprings { ids, springs, memories };
    lists.walls_at_build.clone_from(&state.walls);
}

/// Largest distance by which a wall has approached the grains since the last build, relative to the carrier (m).
pub(super) fn displacement(model: &Model, state: &State, lists: &Neighbors) -> Real {
    let carried = state.carrier_position() - lists.carrier_position;
    let walls = model.walls.iter().zip(&lists.walls_at_build).zip(&state.walls);
    walls
        .zip(lists.wall_extents.iter().zip(&lists.wall_gaps))
        .map(|(((wall, from), to), (extent, gap))| {
            wall.shape.displacement(from, to, &carried, *extent) - gap
        })
        .fold(0.0, Real::max)
}
