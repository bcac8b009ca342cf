//! Mesh of a closed bar with a square cross-section and rounded edges, of nearly equilateral triangles.
//!
//! Rows of vertices run around the bar as around a tube. Each end is closed by nested rings, each with two
//! vertices fewer per side than the ring around it, and a strip across the innermost one:
//!
//! ```text
//!     o---o---o---o---o
//!     |  o--o--o--o   |      n vertices per side: 4 n vertices in a row,
//!     |  | o--o--o |  |      4 (n − 2), 4 (n − 4), … in the rings of an end
//!     o  o | /| /| o  o
//!     |  | o--o--o |  |
//!     |  o--o--o--o   |
//!     o---o---o---o---o
//! ```

use std::ops::Range;

use super::icosphere::coherent;
use super::mesh::{Mesh, MeshError, index};
use super::tube::cosine_and_sine;
use crate::base::{Real, Vec3};

/// Difference of the vertices per side between a ring and the next inner one.
const SIDE_STEP: usize = 2;

/// Size and resolution of a bar along z, centered on the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Width of each side (m).
    pub width: Real,
    /// Length (m).
    pub length: Real,
    /// Radius of the rounded edges along the bar (m), at most half the width.
    pub edge_radius: Real,
    /// Number of vertices of a row on each side.
    pub n_side: usize,
    /// Number of rows.
    pub n_rows: usize,
}

impl Mesh {
    /// The surface of `bar`.
    ///
    /// # Errors
    /// If there are fewer than two vertices on a side or fewer than two rows.
    pub fn bar(bar: &Bar) -> Result<Self, MeshError> {
        let Bar { length, n_side, n_rows, .. } = *bar;
        if n_side < 2 || n_rows < 2 {
            return Err(MeshError::TooFew { n_around: 4 * n_side, n_rows });
        }
        let mut builder = Builder { bar, positions: Vec::new(), triangles: Vec::new() };
        let z_of = |row: usize| length * (row as Real / (n_rows - 1) as Real - 0.5);
        let first = builder.ring(n_side, 0, z_of(0));
        let mut last = first.clone();
        for row in 1..n_rows {
            let next = builder.ring(n_side, row % 2, z_of(row));
            // Seen from outside the bar, the row below is the outer ring.
            builder.join((&last, (row - 1) % 2), (&next, row % 2), true);
            last = next;
        }
        builder.close((last, (n_rows - 1) % 2), z_of(n_rows - 1), true);
        builder.close((first, 0), z_of(0), false);
        let (positions, triangles) = coherent(&builder.positions, builder.triangles);
        Self::new(positions, triangles)
    }
}

/// A mesh under construction.
struct Builder<'a> {
    bar: &'a Bar,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Builder<'_> {
    /// Adds a ring with `n_side` vertices on each side at height `z` (m), rotated by `half_steps` half steps.
    fn ring(&mut self, n_side: usize, half_steps: usize, z: Real) -> Range<usize> {
        let begin = self.positions.len();
        let shrunk = n_side as Real / self.bar.n_side as Real;
        let (half, radius) = (0.5 * self.bar.width * shrunk, self.bar.edge_radius * shrunk);
        for k in 0..4 * n_side {
            let (x, y) = on_contour(2 * k + half_steps, 8 * n_side, half, radius);
            self.positions.push(Vec3::new(x, y, z));
        }
        begin..self.positions.len()
    }

    /// Joins two rings by triangles, advancing on the ring that is behind. Each ring is given with its rotation in
    /// half steps. `is_up` is true if normals point up when the inner ring is inside the outer one.
    fn join(
        &mut self,
        (outer, outer_turn): (&Range<usize>, usize),
        (inner, inner_turn): (&Range<usize>, usize),
        is_up: bool,
    ) {
        let (n_outer, n_inner) = (outer.len(), inner.len());
        let (mut i, mut j) = (0, 0);
        while i < n_outer || j < n_inner {
            // Middle of the next edge, as a fraction of the circumference, times two.
            let middle = |k: usize, turn: usize, n: usize| (2 * k + 1 + turn) as Real / n as Real;
            let outer_is_next = j == n_inner
                || i < n_outer && middle(i, outer_turn, n_outer) <= middle(j, inner_turn, n_inner);
            let at = [outer.start + i % n_outer, inner.start + j % n_inner];
            let third = if outer_is_next {
                i += 1;
                outer.start + i % n_outer
            } else {
                j += 1;
                inner.start + j % n_inner
            };
            self.triangle([at[0], third, at[1]], is_up);
        }
    }

    /// Closes the end at height `z` (m) whose outermost ring is `outer`.
    fn close(&mut self, (mut outer, mut turn): (Range<usize>, usize), z: Real, is_up: bool) {
        while outer.len() / 4 > SIDE_STEP {
            let inner = self.ring(outer.len() / 4 - SIDE_STEP, 0, z);
            self.join((&outer, turn), (&inner, 0), is_up);
            (outer, turn) = (inner, 0);
        }
        // A strip that alternates between both halves of the innermost ring. It starts at a corner, because three
        // vertices of one side do not form a triangle.
        let n = outer.len();
        let at = |k: usize| outer.start + (k + 1) % n;
        let (mut i, mut j) = (0, n - 1);
        let mut is_first_half = true;
        while i + 1 < j {
            if is_first_half {
                self.triangle([at(i), at(i + 1), at(j)], is_up);
                i += 1;
            } else {
                self.triangle([at(i), at(j - 1), at(j)], is_up);
                j -= 1;
            }
            is_first_half = !is_first_half;
        }
    }

    fn triangle(&mut self, [a, b, c]: [usize; 3], is_up: bool) {
        let oriented = if is_up { [a, b, c] } else { [a, c, b] };
        self.triangles.push(oriented.map(index));
    }
}

/// Point (x, y) (m) on a square with rounded corners, at the fraction `part`/`whole` of its circumference from
/// the middle of a side, counterclockwise. The sides are `half` (m) from the center.
fn on_contour(part: usize, whole: usize, half: Real, radius: Real) -> (Real, Real) {
    let quarter = whole / 4;
    let straight = half - radius;
    let arc = std::f64::consts::FRAC_PI_2 * radius;
    let along = (2.0 * straight + arc) * (part % quarter) as Real / quarter as Real;
    let (x, y) = if along < straight {
        (half, along)
    } else if along < straight + arc {
        let (cosine, sine) = cosine_and_sine((along - straight) / arc / 4.0);
        (straight + radius * cosine, straight + radius * sine)
    } else {
        (2.0 * straight + arc - along, half)
    };
    match part / quarter % 4 {
        0 => (x, y),
        1 => (-y, x),
        2 => (-x, -y),
        _ => (y, -x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::membrane::pressure;

    /// Oracles: the beam of Götz, Santarossa, Sack, Pöschel & Müller: 8 cm × 8 cm × 40 cm, 1792 vertices, 3580
    /// triangles, which is 2 V − 4 of a closed surface; the area of an 8 cm square with corners rounded by
    /// 1 cm. Tolerance: chords a = 9.5 mm cut the corners: 1.7 chords at each corner, each cutting off
    /// 2/3 a · a²/8R, together 0.75 % of the section.
    #[test]
    fn the_beam_of_the_source_has_the_published_vertices_and_volume() {
        let bar = Bar { width: 0.08, length: 0.4, edge_radius: 0.01, n_side: 8, n_rows: 53 };
        let mesh = Mesh::bar(&bar).unwrap();
        assert_eq!((mesh.n_vertices(), mesh.triangles.len()), (1792, 3580));
        assert!(mesh.is_closed());
        let section = 0.08 * 0.08 - (4.0 - std::f64::consts::PI) * 0.01 * 0.01;
        let volume = pressure::volume(&mesh, &mesh.positions);
        assert!((0.9925..1.0).contains(&(volume / (section * 0.4))), "{volume}");
        let mut lengths: Vec<Real> = mesh
            .edges
            .iter()
            .map(|[a, b]| (mesh.positions[*a as usize] - mesh.positions[*b as usize]).norm())
            .collect();
        lengths.sort_by(Real::total_cmp);
        // Oracle: 3580 equilateral triangles on that surface have edges of 9.5 mm. Edges vary where
        // rings meet: none is shorter than half of that, and the longest lie across the innermost
        // rings, squares of 20 mm with a diagonal of 28.3 mm.
        let median = lengths[lengths.len() / 2];
        assert!((median / 9.5e-3 - 1.0).abs() < 0.05, "{median}");
        let (shortest, longest) = (lengths[0], lengths[lengths.len() - 1]);
        assert!(4.7e-3 < shortest && longest < 28.3e-3, "{shortest} {longest}");
    }

    /// Oracle: the volume of the box, exactly, with vertices on the sharp edges.
    #[test]
    fn a_bar_with_sharp_edges_is_a_box() {
        for n_side in [2, 4, 6] {
            let bar = Bar { width: 0.02, length: 0.05, edge_radius: 0.0, n_side, n_rows: 3 };
            let mesh = Mesh::bar(&bar).unwrap();
            let volume = pressure::volume(&mesh, &mesh.positions);
            // The middle row is rotated by half a step and so cuts the edges: a triangle with legs of half a
            // step, 0.01/n, is missing there. It vanishes toward both ends: a third of a prism in total.
            let cut = 4.0 * 0.5 * (0.01 / n_side as Real).powi(2) * 0.05 / 3.0;
            assert!((volume - (0.02 * 0.02 * 0.05 - cut)).abs() < 1e-12, "{volume} {cut}");
            assert!(mesh.is_closed());
        }
    }

    #[test]
    fn bars_with_too_few_vertices_are_rejected() {
        let bar = Bar { width: 1.0, length: 1.0, edge_radius: 0.1, n_side: 1, n_rows: 5 };
        assert!(Mesh::bar(&bar).is_err());
        assert!(Mesh::bar(&Bar { n_side: 4, n_rows: 1, ..bar }).is_err());
    }
}
