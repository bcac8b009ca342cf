//! A convex polyhedron that is cut by half-spaces, face by face.
//!
//! A vertex within a tolerance of the cutting plane counts as on it. This keeps the cells of lattices, where
//! four or more planes meet in one point, exact. If rounding still makes the cut edges inconsistent, the
//! plane is moved by a multiple of the tolerance.

use super::Neighbor;
use crate::base::{Real, Vec3};

/// Distance from the plane within which a vertex is on the plane, relative to the size of the polyhedron.
const TOLERANCE: Real = 1e-13;
/// Number of attempts for an inconsistent cut.
const N_TRIES: u32 = 8;

/// A face: its vertices are `loops[start .. end]`, counterclockwise seen from outside.
#[derive(Clone, Copy, Debug)]
struct Face {
    /// `None` for a plane that only divides.
    neighbor: Option<Neighbor>,
    start: u32,
    end: u32,
}

/// A polyhedron (m). The origin may be outside.
#[derive(Clone, Debug, Default)]
pub(super) struct Polyhedron {
    vertices: Vec<Vec3>,
    faces: Vec<Face>,
    loops: Vec<u32>,
}

/// Working memory of a cut.
#[derive(Clone, Debug, Default)]
pub(super) struct Cutter {
    /// Height of each vertex above the plane (m).
    heights: Vec<Real>,
    /// Vertices on cut edges: the ends, inside first, and the vertex.
    crossed: Vec<[u32; 3]>,
    /// Edges of the new face, in its orientation: opposite to those of the faces that were cut.
    rim: Vec<[u32; 2]>,
    cut: Polyhedron,
    /// New index of each vertex.
    kept: Vec<u32>,
}

/// Index of an unused vertex.
const UNUSED: u32 = u32::MAX;

impl Polyhedron {
    /// The box from `low` to `high` (m); its faces −x, +x, −y, +y, −z, +z belong to `neighbors`.
    pub(super) fn cuboid([low, high]: &[Vec3; 2], neighbors: [Neighbor; 6]) -> Self {
        let at = |k: u32, axis: usize| if k >> axis & 1 == 1 { high[axis] } else { low[axis] };
        let vertices = (0..8).map(|k| Vec3::from_fn(|axis, _| at(k, axis))).collect();
        let quads =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let mut it = Self { vertices, ..Self::default() };
        for (neighbor, quad) in neighbors.into_iter().zip(quads) {
            let start = id(it.loops.len());
            it.loops.extend_from_slice(&quad);
            it.faces.push(Face { neighbor: Some(neighbor), start, end: start + 4 });
        }
        it
    }

    fn clear(&mut self) {
        self.vertices.clear();
        self.faces.clear();
        self.loops.clear();
    }

    /// True if nothing is left.
    pub(super) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Largest distance of a vertex from the origin (m).
    pub(super) fn reach(&self) -> Real {
        self.vertices.iter().map(Vec3::norm_squared).fold(0.0, Real::max).sqrt()
    }

    /// Volume (m³).
    pub(super) fn volume(&self) -> Real {
        // Relative to one of its vertices: accurate wherever the origin is.
        let Some(apex) = self.vertices.first() else { return 0.0 };
        self.faces
            .iter()
            .map(|face| self.area_vector(face).dot(&(self.first(face) - apex)))
            .sum::<Real>()
            / 3.0
    }

    /// Each face's neighbor and its area (m²).
    pub(super) fn faces(&self) -> impl Iterator<Item = (Neighbor, Real)> {
        self.faces.iter().filter_map(|face| Some((face.neighbor?, self.area_vector(face).norm())))
    }

    /// True if a vertex lies where `normal · x < offset` (m).
    pub(super) fn has_part_below(&self, normal: &Vec3, offset: Real) -> bool {
        self.vertices.iter().any(|vertex| normal.dot(vertex) < offset)
    }

    fn first(&self, face: &Face) -> Vec3 {
        self.vertices[self.loops[face.start as usize] as usize]
    }

    /// Outward normal times area (m²).
    fn area_vector(&self, face: &Face) -> Vec3 {
        let first = self.first(face);
        let corners = &self.loops[face.start as usize + 1..face.end as usize];
        let arm = |v: u32| self.vertices[v as usize] - first;
        let twice: Vec3 = corners.windows(2).map(|it| arm(it[0]).cross(&arm(it[1]))).sum();
        twice * 0.5
    }

    /// Keeps the part with `normal · x ≤ offset` (m); the new face belongs to `neighbor`. True if
    /// something was cut off.
    pub(super) fn cut(
        &mut self,
        normal: &Vec3,
        offset: Real,
        neighbor: Option<Neighbor>,
        cutter: &mut Cutter,
    ) -> bool {
        let mut size: Real = 0.0;
        let mut highest = Real::NEG_INFINITY;
        let mut lowest = Real::INFINITY;
        cutter.heights.clear();
        for vertex in &self.vertices {
            let height = normal.dot(vertex) - offset;
            (highest, lowest) = (highest.max(height), lowest.min(height));
            size = size.max(vertex.amax());
            cutter.heights.push(height);
        }
        let tolerance = TOLERANCE * size.max(offset.abs());
        if highest <= tolerance {
            return false;
        }
        for _ in 0..N_TRIES {
            if lowest >= -tolerance {
                self.clear();
                return true;
            }
            if highest <= tolerance {
                return false;
            }
            if cutter.divide(self, tolerance, neighbor) {
                std::mem::swap(self, &mut cutter.cut);
                return true;
            }
            let step = 3.0 * tolerance;
            cutter.heights.iter_mut().for_each(|height| *height -= step);
            (highest, lowest) = (highest - step, lowest - step);
        }
        // Not reached on lattices disturbed by 1e-3 to 1e-17 of their edge. A missing cut would be visible
        // in the sum of the volumes.
        false
    }
}

impl Cutter {
    /// Sets `self.cut` to the part of `original` that is not above the plane; false if the cut is
    /// inconsistent.
    fn divide(
        &mut self,
        original: &Polyhedron,
        tolerance: Real,
        neighbor: Option<Neighbor>,
    ) -> bool {
        self.cut.clear();
        self.crossed.clear();
        self.rim.clear();
        self.cut.vertices.extend_from_slice(&original.vertices);
        for face in &original.faces {
            let corners = &original.loops[face.start as usize..face.end as usize];
            if !self.divide_face(face.neighbor, corners, tolerance) {
                return false;
            }
        }
        let is_closed = self.close(neighbor);
        self.compact();
        is_closed
    }

    /// Keeps the part of a face that is not above the plane.
    fn divide_face(
        &mut self,
        neighbor: Option<Neighbor>,
        corners: &[u32],
        tolerance: Real,
    ) -> bool {
        let start = self.cut.loops.len();
        let (mut exit, mut entry) = (UNUSED, UNUSED);
        let mut n_exits = 0;
        let mut previous = corners[corners.len() - 1];
        for &corner in corners {
            let (before, here) = (self.heights[previous as usize], self.heights[corner as usize]);
            let (was_above, is_above) = (before > tolerance, here > tolerance);
            if is_above && !was_above {
                exit = if before < -tolerance { self.cross(previous, corner) } else { previous };
                n_exits += 1;
                if before < -tolerance {
                    self.cut.loops.push(exit);
                }
            } else if was_above && !is_above {
                entry = if here < -tolerance { self.cross(corner, previous) } else { corner };
                if here < -tolerance {
                    self.cut.loops.push(entry);
                }
            }
            if !is_above {
                self.cut.loops.push(corner);
            }
            previous = corner;
        }
        if n_exits == 1 && exit != entry {
            self.rim.push([entry, exit]);
        }
        if self.cut.loops.len() - start < 3 {
            self.cut.loops.truncate(start);
        } else {
            let (start, end) = (id(start), id(self.cut.loops.len()));
            self.cut.faces.push(Face { neighbor, start, end });
        }
        n_exits <= 1
    }

    /// The vertex where the edge from `inside` to `above` intersects the plane.
    fn cross(&mut self, inside: u32, above: u32) -> u32 {
        if let Some(known) = self.crossed.iter().find(|it| it[0] == inside && it[1] == above) {
            return known[2];
        }
        let [low, high] = [inside, above].map(|v| self.heights[v as usize]);
        let [from, to] = [inside, above].map(|v| self.cut.vertices[v as usize]);
        let vertex = id(self.cut.vertices.len());
        self.cut.vertices.push(from + (to - from) * (low / (low - high)));
        self.crossed.push([inside, above, vertex]);
        vertex
    }

    /// Closes the hole with a face along its rim; false if the rim is not one loop.
    fn close(&mut self, neighbor: Option<Neighbor>) -> bool {
        let Some(&[first, mut at]) = self.rim.first() else { return false };
        let start = id(self.cut.loops.len());
        self.cut.loops.push(first);
        let mut n_edges = 1;
        while at != first && n_edges < self.rim.len() {
            let Some(next) = self.rim.iter().find(|edge| edge[0] == at) else { return false };
            self.cut.loops.push(at);
            at = next[1];
            n_edges += 1;
        }
        let end = id(self.cut.loops.len());
        self.cut.faces.push(Face { neighbor, start, end });
        at == first && n_edges == self.rim.len() && end - start >= 3
    }

    /// Removes vertices that no face uses.
    fn compact(&mut self) {
        let Polyhedron { vertices, loops, .. } = &mut self.cut;
        self.kept.clear();
        self.kept.resize(vertices.len(), UNUSED);
        for &v in loops.iter() {
            self.kept[v as usize] = 0;
        }
        let mut n = 0;
        for v in 0..vertices.len() {
            if self.kept[v] != UNUSED {
                self.kept[v] = id(n);
                vertices[n] = vertices[v];
                n += 1;
            }
        }
        vertices.truncate(n);
        loops.iter_mut().for_each(|v| *v = self.kept[*v as usize]);
    }
}

/// An index as the 32-bit id that loops hold.
#[expect(clippy::cast_possible_truncation, reason = "a cell has far fewer vertices than 2^32")]
fn id(index: usize) -> u32 {
    index as u32
}
