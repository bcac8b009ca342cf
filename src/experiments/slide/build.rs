//! A flat patch of the triangular lattice, and the ball on it.

use super::{
    cases::{Case, Direction, GRAVITY, lattice_point, mass},
    expected::{self, Bed},
    scene::SlideScene,
};
use crate::{
    base::{Real, Vec3},
    physics::{
        System, SystemBuilder,
        builder::{BuildError, Membrane, Vertices, Wall},
        membrane::{
            MembraneContact, MembraneModel, critical_step,
            mesh::{Mesh, MeshError},
        },
        state::Grains,
    },
};

/// Skin of the neighbor lists, as a share of the ball's radius.
const SKIN_SHARE: Real = 0.25;
/// Share of the critical step that a free membrane is computed with.
const SAFETY: Real = 0.8;

/// A piece of the lattice, its outside below.
pub(super) struct Patch {
    pub(super) mesh: Mesh,
    /// i, j of each vertex, row by row.
    cells: Vec<(i32, i32)>,
}

impl Patch {
    /// The vertices that the ball of a case meets.
    ///
    /// # Errors
    /// If there are none.
    pub(super) fn new(scene: &SlideScene, case: &Case) -> Result<Self, MeshError> {
        let edge = case.edge;
        if case.is_framed {
            let half = Vec3::repeat(scene.frame.size / 2.0);
            return Self::between(edge, &-half, &half);
        }
        let margin = Vec3::repeat(scene.ball.radius + scene.membrane.sphere_radius + edge);
        let period = case.period();
        let (low, high) = (Vec3::zeros().inf(&period), Vec3::zeros().sup(&period));
        Self::between(edge, &(low - margin), &(high + margin))
    }

    /// All complete triangles between two corners (m).
    ///
    /// # Errors
    /// If there are none.
    fn between(edge: Real, low: &Vec3, high: &Vec3) -> Result<Self, MeshError> {
        let n = count(((high - low).norm() + low.norm()) / edge) + 2;
        let is_inside = |cell: (i32, i32)| {
            let at = lattice_point(cell, edge);
            low.x <= at.x && at.x <= high.x && low.y <= at.y && at.y <= high.y
        };
        let corners_of = |(i, j): (i32, i32)| {
            [[(i, j), (i, j + 1), (i + 1, j)], [(i, j), (i + 1, j), (i + 1, j - 1)]]
        };
        let all = || (-n..=n).flat_map(|j| (-2 * n..=2 * n).map(move |i| (i, j)));
        let complete: Vec<[(i32, i32); 3]> = all()
            .flat_map(corners_of)
            .filter(|corners| corners.iter().all(|&cell| is_inside(cell)))
            .collect();
        let cells: Vec<(i32, i32)> =
            all().filter(|cell| complete.iter().flatten().any(|it| it == cell)).collect();
        let vertex = |cell: (i32, i32)| id(&cells, cell).expect("corners of triangles are listed");
        let triangles = complete.into_iter().map(|corners| corners.map(vertex)).collect();
        let positions = cells.iter().map(|&cell| lattice_point(cell, edge)).collect();
        Ok(Self { mesh: Mesh::new(positions, triangles)?, cells })
    }

    /// For each vertex, the vertex one period behind it in this direction; `None` beyond the patch.
    /// The ids keep their order.
    pub(super) fn one_period_behind(&self, direction: Direction) -> Vec<Option<u32>> {
        let behind = |&(i, j): &(i32, i32)| id(&self.cells, (i - direction.0, j - direction.1));
        self.cells.iter().map(behind).collect()
    }
}

fn id(cells: &[(i32, i32)], cell: (i32, i32)) -> Option<u32> {
    let index = cells.iter().position(|&it| it == cell)?;
    u32::try_from(index).ok()
}

/// A positive number rounded up.
#[expect(clippy::cast_possible_truncation, reason = "patches have a few hundred edges")]
fn count(value: Real) -> i32 {
    value.ceil() as i32
}

/// Position of the ball at the start (m), above a vertex: at rest under its load if all vertices
/// are held, otherwise just touching.
pub(super) fn start(scene: &SlideScene, case: &Case, patch: &Patch) -> Vec3 {
    let law = case.law(scene);
    let radius = scene.ball.radius;
    if case.is_framed {
        let n_edges = (scene.frame.length / 2.0 / case.edge).round();
        let up = if case.has_spheres { radius + scene.membrane.sphere_radius } else { radius };
        return Vec3::new(-n_edges * case.edge, 0.0, up);
    }
    let height = if case.has_spheres {
        Bed::new(scene, case, &patch.mesh.positions).rest(&Vec3::zeros(), 0.0).height
    } else {
        radius - expected::overlap(&law, radius, case.weight(scene))
    };
    Vec3::z() * height
}

/// The ball at `start` (m) over the membrane, which a frame holds.
///
/// # Errors
/// If the parts do not fit each other.
pub(super) fn system(
    scene: &SlideScene,
    case: &Case,
    patch: Patch,
    start: Vec3,
) -> Result<System, BuildError> {
    let radius = scene.ball.radius;
    let law = case.law(scene);
    let mut membrane = MembraneModel::new(patch.mesh, scene.membrane.material());
    let mut contact_radius = radius;
    if case.has_spheres {
        let sphere = scene.membrane.sphere_radius;
        membrane.contact = MembraneContact::Spheres { radius: sphere };
        contact_radius = radius * sphere / (radius + sphere);
    }
    let (mut substep, mut held) = (case.pull.substep, Vertices::All);
    if case.is_framed {
        held = Vertices::Rims;
        membrane.scale_rest_lengths(1.0 / (1.0 + scene.frame.stretch));
        let stiffness = law.stiffness(contact_radius, case.weight(scene));
        let longest = SAFETY * critical_step::critical_step(&membrane, stiffness);
        substep = substep.min(longest);
    }
    let mut builder = SystemBuilder::new(law);
    builder.gravity(Vec3::z() * -GRAVITY).substep(substep).skin(SKIN_SHARE * radius);
    builder.grains(Grains::at_rest(vec![start], vec![radius], vec![mass(scene)]));
    let frame = builder.wall(Wall::frame());
    builder.membrane(Membrane::of(membrane).hold(held, frame));
    builder.build()
}
