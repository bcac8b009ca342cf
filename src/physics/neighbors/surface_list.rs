//! Lists of the grains that walls of triangles and bodies may touch, and of their candidate triangles.

use super::{
    Bounds,
    cell_grid::{CellGrid, id},
    verlet_list::index_by_second,
};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Controls, Model, State,
        boundary::{body::BodyMotion, triangles::Triangles},
        contact::{bodies::signed_distance, surfaces::motion},
        membrane::contact_geometry::closest_on_triangle,
        model::{BodyModel, TouchedSurface},
        scratch::{Neighbors, SurfaceLists},
    },
};

/// Number of triangles in one parallel task.
const CHUNK: usize = 128;

/// Lists the grains within contact plus the range of the law plus the skin. Surfaces far from all grains are skipped;
/// `wall_list::build` must have determined which walls are far.
pub(super) fn build(
    model: &Model,
    controls: &Controls,
    state: &State,
    (grid, bounds): (&CellGrid, &Bounds),
    lists: &mut Neighbors,
) {
    let (skin, walls) = (lists.skin, std::mem::take(&mut lists.wall_gaps));
    let entries = &mut lists.surfaces;
    let n_grains = state.grains.len();
    *entries = SurfaceLists { triangle_starts: vec![0], ..SurfaceLists::default() };
    for s in 0..model.n_surfaces() {
        let surface = model.surface(s);
        if let Some((surface, law)) = surface {
            let motion = motion(model, controls, state, s);
            let beyond = law.range() + skin;
            let gap = match walls.get(s) {
                Some(gap) => *gap,
                None => gap_to_body(surface, motion, bounds, beyond),
            };
            if gap == 0.0 {
                let search = Search { state, grid, bounds, motion, beyond };
                match surface {
                    TouchedSurface::Triangles(triangles) => search.triangles(s, triangles, entries),
                    TouchedSurface::Body(body) => search.body(s, body, entries),
                }
            }
            if model.walls.len() <= s {
                let furthest = bounds.furthest_from(&motion.pose.translation.vector) + skin;
                entries.extents.push(surface.bounding_radius().min(furthest));
                entries.gaps.push(gap);
            }
        } else if model.walls.len() <= s {
            entries.extents.push(0.0);
            entries.gaps.push(Real::INFINITY);
        }
    }
    (entries.grain_starts, entries.by_grain) = index_by_second(&entries.ids, n_grains);
    entries.bodies_at_build.clone_from(&controls.bodies);
    lists.wall_gaps = walls;
}

/// Largest distance by which a body that grains touch has approached them since the last build, relative to the
/// carrier (m).
pub(super) fn displacement(
    model: &Model,
    controls: &Controls,
    state: &State,
    lists: &Neighbors,
) -> Real {
    let carried = state.carrier_position() - lists.carrier_position;
    let entries = &lists.surfaces;
    let motions = entries.bodies_at_build.iter().zip(&controls.bodies);
    let limits = entries.extents.iter().zip(&entries.gaps);
    let bodies = model.bodies.iter().zip(motions).zip(limits);
    bodies
        .filter(|((body, _), _)| body.of_grains.is_some())
        .map(|((_, (from, to)), (extent, gap))| {
            let origin = |it: &BodyMotion| it.pose.translation.vector;
            let shifted = (origin(to) - origin(from) - carried).norm();
            let angle = to.pose.rotation.angle_to(&from.pose.rotation);
            let rotated = if angle > 0.0 { 2.0 * (0.5 * angle).sin() * extent } else { 0.0 };
            shifted + rotated - gap
        })
        .fold(0.0, Real::max)
}

/// Distance by which a body can move before it may touch a grain (m), at least 0.
fn gap_to_body(
    surface: TouchedSurface<'_>,
    motion: &BodyMotion,
    bounds: &Bounds,
    beyond: Real,
) -> Real {
    let distance = bounds.distance_from(&motion.pose.translation.vector);
    (distance - surface.bounding_radius() - bounds.radius_max - beyond).max(0.0)
}

/// Search for grains near one surface.
struct Search<'a> {
    state: &'a State,
    grid: &'a CellGrid,
    bounds: &'a Bounds,
    motion: &'a BodyMotion,
    /// Range of the law plus skin (m).
    beyond: Real,
}

impl Search<'_> {
    /// Lists grains near the triangles of surface `s`.
    fn triangles(&self, s: usize, triangles: &Triangles, entries: &mut SurfaceLists) {
        let mesh = triangles.mesh();
        let pose = &self.motion.pose;
        let to_world = |p: &Vec3| pose.rotation * p + pose.translation.vector;
        let positions: Vec<Vec3> = mesh.positions.iter().map(to_world).collect();
        let n_triangles = mesh.triangles.len();
        let mut chunks = vec![Vec::new(); n_triangles.div_ceil(CHUNK)];
        parallel::for_each(&mut chunks, |chunk, found| {
            for t in chunk * CHUNK..n_triangles.min((chunk + 1) * CHUNK) {
                let corners = mesh.triangles[t].map(|vertex| &positions[vertex as usize]);
                self.triangle(id(t), corners, found);
            }
        });
        let mut pairs = chunks.concat();
        pairs.sort_unstable();
        let mut last = None;
        for [grain, triangle] in pairs {
            if last != Some(grain) {
                entries.ids.push([id(s), grain]);
                entries.triangle_starts.push(id(entries.triangles.len()));
                last = Some(grain);
            }
            entries.triangles.push(triangle);
            if let Some(end) = entries.triangle_starts.last_mut() {
                *end += 1;
            }
        }
    }

    /// Finds grains near a triangle.
    fn triangle(&self, t: u32, corners: [&Vec3; 3], found: &mut Vec<[u32; 2]>) {
        let reach = Vec3::repeat(self.bounds.radius_max + self.beyond);
        let low = corners[0].inf(corners[1]).inf(corners[2]) - reach;
        let high = corners[0].sup(corners[1]).sup(corners[2]) + reach;
        if !self.bounds.overlap(&low, &high) {
            return;
        }
        let grains = &self.state.grains;
        self.grid.visit(&low, &high, |grain| {
            let i = grain as usize;
            let cut = grains.radii[i] + self.beyond;
            let closest = closest_on_triangle(&grains.positions[i], corners);
            if (closest.point - grains.positions[i]).norm_squared() < cut * cut {
                found.push([grain, t]);
            }
        });
    }

    /// Lists grains near a body, which is surface `s`.
    fn body(&self, s: usize, body: &BodyModel, entries: &mut SurfaceLists) {
        let origin = self.motion.pose.translation.vector;
        let reach = Vec3::repeat(body.bounding_radius + self.bounds.radius_max + self.beyond);
        let grains = &self.state.grains;
        let mut found = Vec::new();
        self.grid.visit(&(origin - reach), &(origin + reach), |grain| {
            let i = grain as usize;
            let arm = grains.positions[i] - origin;
            if signed_distance(body, self.motion, &arm).0 < grains.radii[i] + self.beyond {
                found.push(grain);
            }
        });
        found.sort_unstable();
        entries.ids.extend(found.iter().map(|grain| [id(s), *grain]));
        let end = id(entries.triangles.len());
        entries.triangle_starts.extend(found.iter().map(|_| end));
    }
}
