//! A flat patch of the triangular lattice, and the ways over it.
//!
//! ```text
//! vertex (i, j) at  i a + j b,   a = (s, 0),  b = (s/2, √3 s/2)
//! ```

use crate::{
    base::{Real, Vec3},
    physics::membrane::mesh::{Mesh, MeshError},
};

/// A direction in which the lattice repeats itself, as the steps i, j that make one period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Way(pub(super) i32, pub(super) i32);

impl Way {
    /// From vertex to vertex, over edges.
    pub(super) const ROWS: Self = Self(1, 0);
    /// At right angles to it: over a vertex, a hollow, an edge and another hollow.
    pub(super) const ACROSS: Self = Self(-1, 2);
    /// Neither: 19.1° off the rows.
    pub(super) const SKEW: Self = Self(2, 1);

    /// One period (m) on a lattice of `edge` (m).
    pub(super) fn period(self, edge: Real) -> Vec3 {
        place((self.0, self.1), edge)
    }
}

/// A piece of the lattice, its outside below.
pub(super) struct Patch {
    pub(super) mesh: Mesh,
    /// i, j of each vertex, row by row.
    cells: Vec<(i32, i32)>,
}

impl Patch {
    /// All whole triangles between two corners (m).
    ///
    /// # Errors
    /// If there are none.
    pub(super) fn between(edge: Real, low: &Vec3, high: &Vec3) -> Result<Self, MeshError> {
        let n = count(((high - low).norm() + low.norm()) / edge) + 2;
        let is_inside = |cell: (i32, i32)| {
            let at = place(cell, edge);
            low.x <= at.x && at.x <= high.x && low.y <= at.y && at.y <= high.y
        };
        let corners_of = |(i, j): (i32, i32)| {
            [[(i, j), (i, j + 1), (i + 1, j)], [(i, j), (i + 1, j), (i + 1, j - 1)]]
        };
        let all = || (-n..=n).flat_map(|j| (-2 * n..=2 * n).map(move |i| (i, j)));
        let whole: Vec<[(i32, i32); 3]> = all()
            .flat_map(corners_of)
            .filter(|corners| corners.iter().all(|&cell| is_inside(cell)))
            .collect();
        let cells: Vec<(i32, i32)> =
            all().filter(|cell| whole.iter().flatten().any(|it| it == cell)).collect();
        let patch = |cell: (i32, i32)| id(&cells, cell).expect("corners of triangles are listed");
        let triangles = whole.into_iter().map(|corners| corners.map(patch)).collect();
        let positions = cells.iter().map(|&cell| place(cell, edge)).collect();
        Ok(Self { mesh: Mesh::new(positions, triangles)?, cells })
    }

    /// Which vertex lies one period of `way` behind each; `None` where the patch ends. The ids
    /// keep their order.
    pub(super) fn behind(&self, way: Way) -> Vec<Option<u32>> {
        self.cells.iter().map(|&(i, j)| id(&self.cells, (i - way.0, j - way.1))).collect()
    }
}

fn id(cells: &[(i32, i32)], cell: (i32, i32)) -> Option<u32> {
    let at = cells.iter().position(|&it| it == cell)?;
    u32::try_from(at).ok()
}

fn place((i, j): (i32, i32), edge: Real) -> Vec3 {
    let (i, j) = (Real::from(i), Real::from(j));
    Vec3::new(i + 0.5 * j, 0.75_f64.sqrt() * j, 0.0) * edge
}

/// A positive real rounded up.
#[expect(clippy::cast_possible_truncation, reason = "patches have some hundred edges")]
fn count(value: Real) -> i32 {
    value.ceil() as i32
}
