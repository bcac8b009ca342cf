//! A triangle mesh with its connectivity: edges, hinges, rims, and what meets at each vertex.
//!
//! ```text
//!            r1                triangle 1 = (r1, r3, r4), triangle 2 = (r2, r4, r3),
//!          /    \              both with outward normals, so
//!        /   1    \              n1 = (r1 − r3) × (r1 − r4)
//!      r3 -------- r4            n2 = (r2 − r4) × (r2 − r3)
//!        \   2    /            as in Götz (2024) eqs. 17, 18.
//!          \    /
//!            r2
//! ```
//!
//! Every edge between two triangles is a hinge. Edges are numbered so that these come first:
//! hinge `h` folds about edge `h`, and edges from `hinges.len()` on are on the boundary.

use thiserror::Error;

use crate::base::{Real, Vec3};

/// Stands where a boundary edge has no second triangle.
pub const NONE: u32 = u32::MAX;

/// Two triangles that share an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hinge {
    /// Vertices r1, r2 opposite the edge and r3, r4 at its ends.
    pub vertices: [u32; 4],
    /// Triangles 1 and 2.
    pub triangles: [u32; 2],
}

/// Which entries belong to each vertex: all lists end to end, and where each begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Incidence {
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl Incidence {
    /// Sorts `(vertex, entry)` by vertex; the entries of a vertex keep their order.
    fn new(n_vertices: usize, pairs: &[(u32, u32)]) -> Self {
        let mut starts = vec![0_u32; n_vertices + 1];
        for &(vertex, _) in pairs {
            starts[vertex as usize + 1] += 1;
        }
        for v in 0..n_vertices {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut entries = vec![0; pairs.len()];
        for &(vertex, entry) in pairs {
            entries[next[vertex as usize] as usize] = entry;
            next[vertex as usize] += 1;
        }
        Self { starts, entries }
    }

    /// The entries of `vertex`.
    #[inline]
    pub fn of(&self, vertex: usize) -> &[u32] {
        &self.entries[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

/// A consistently oriented surface of one or more parts, each closed or with rims.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Reference position of each vertex (m).
    pub positions: Vec<Vec3>,
    /// Vertices of each triangle, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of each edge; those of hinges first. A boundary edge runs as its triangle does.
    pub edges: Vec<[u32; 2]>,
    /// The two triangles at each edge that is not on the boundary.
    pub hinges: Vec<Hinge>,
    /// Triangles on both sides of each edge, the second `NONE` on the boundary.
    pub triangles_of_edge: Vec<[u32; 2]>,
    /// Edges of each triangle: `k` joins its vertices `k` and `k + 1`.
    pub edges_of_triangle: Vec<[u32; 3]>,
    /// Triangle across each edge of each triangle, `NONE` on the boundary.
    pub neighbours_of_triangle: Vec<[u32; 3]>,
    /// Each loop of the boundary: its vertices in order around, right-handed about the outward
    /// normal of a lid that closes it. None for a closed mesh.
    pub rims: Vec<Vec<u32>>,
    /// True for vertices of the boundary.
    pub is_on_rim: Vec<bool>,
    /// Triangles at each vertex.
    pub triangles_of_vertex: Incidence,
    /// `4 · edge + slot` of each vertex: slots 0 and 1 face a hinge as r1 and r2, slots 2 and 3
    /// are the ends r3 and r4 of the edge.
    pub slots_of_vertex: Incidence,
}

/// Why triangles do not make a usable surface.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MeshError {
    /// A vertex index past the end.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {n_vertices} vertices")]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The index it names.
        vertex: u32,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// A coordinate that is not a number.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A triangle without area.
    #[error("triangle {triangle} has no area; merge its vertices or remove it")]
    NoArea {
        /// The triangle.
        triangle: usize,
    },
    /// More than two triangles at one edge.
    #[error("edge {from}-{to} belongs to {count} triangles, at most 2 make a surface")]
    Branching {
        /// One end.
        from: u32,
        /// The other end.
        to: u32,
        /// How many triangles meet there.
        count: usize,
    },
    /// Two neighbours that disagree about which side is outside.
    #[error(
        "triangles {first} and {second} run the same way along edge {from}-{to}: turn one over"
    )]
    Orientation {
        /// One end of the edge.
        from: u32,
        /// The other end.
        to: u32,
        /// One triangle.
        first: usize,
        /// The other triangle.
        second: usize,
    },
    /// A vertex of no triangle.
    #[error("vertex {vertex} belongs to no triangle; remove it")]
    Unused {
        /// The vertex.
        vertex: usize,
    },
    /// A boundary that meets itself.
    #[error("vertex {vertex} is on two rims: take it apart")]
    TwoRims {
        /// The vertex.
        vertex: u32,
    },
    /// A tube that goes around nothing.
    #[error("a tube needs 3 vertices around and 2 rows at least, not {n_around} and {n_rows}")]
    TooFew {
        /// Vertices in a row.
        n_around: usize,
        /// Rows.
        n_rows: usize,
    },
    /// A disc without a ring of vertices.
    #[error("a disc needs 1 ring of vertices at least, not {n_rings}")]
    TooFewRings {
        /// Rings.
        n_rings: usize,
    },
    /// A frequency without a ring of edges on the equator.
    #[error("subdivision frequency {frequency} is not an even number of at least 2")]
    Frequency {
        /// The frequency given.
        frequency: usize,
    },
}

/// One side of one triangle, for sorting equal edges together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    low: u32,
    high: u32,
    runs_down: bool,
    triangle: u32,
    place: u32,
}

impl Mesh {
    /// Finds edges, hinges and rim of `triangles`.
    ///
    /// # Errors
    /// If the triangles are no consistently oriented surface with rims that do not touch.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        check_triangles(&positions, &triangles)?;
        let sides = sorted_sides(&triangles);
        let (inner, outer) = pair_sides(&sides)?;
        let rims = rim_loops(positions.len(), &triangles, &outer)?;

        let mut mesh = Self {
            edges: Vec::with_capacity(inner.len() + outer.len()),
            hinges: Vec::with_capacity(inner.len()),
            triangles_of_edge: Vec::with_capacity(inner.len() + outer.len()),
            edges_of_triangle: vec![[NONE; 3]; triangles.len()],
            neighbours_of_triangle: vec![[NONE; 3]; triangles.len()],
            is_on_rim: vec![false; positions.len()],
            triangles_of_vertex: triangles_of_vertex(positions.len(), &triangles),
            slots_of_vertex: Incidence { starts: vec![], entries: vec![] },
            rims,
            positions,
            triangles,
        };
        for &vertex in mesh.rims.iter().flatten() {
            mesh.is_on_rim[vertex as usize] = true;
        }
        for [up, down] in inner {
            mesh.add_hinge(up, down);
        }
        for side in outer {
            mesh.add_boundary_edge(side);
        }
        mesh.slots_of_vertex = mesh.find_slots();
        Ok(mesh)
    }

    fn add_hinge(&mut self, up: Side, down: Side) {
        let edge = index(self.edges.len());
        let opposite =
            |side: Side| self.triangles[side.triangle as usize][(side.place as usize + 2) % 3];
        self.hinges.push(Hinge {
            vertices: [opposite(up), opposite(down), up.low, up.high],
            triangles: [up.triangle, down.triangle],
        });
        self.edges.push([up.low, up.high]);
        self.triangles_of_edge.push([up.triangle, down.triangle]);
        for (side, other) in [(up, down), (down, up)] {
            let (triangle, place) = (side.triangle as usize, side.place as usize);
            self.edges_of_triangle[triangle][place] = edge;
            self.neighbours_of_triangle[triangle][place] = other.triangle;
        }
    }

    fn add_boundary_edge(&mut self, side: Side) {
        let edge = index(self.edges.len());
        let (triangle, place) = (side.triangle as usize, side.place as usize);
        self.edges.push(ends(&self.triangles[triangle], place));
        self.triangles_of_edge.push([side.triangle, NONE]);
        self.edges_of_triangle[triangle][place] = edge;
    }

    fn find_slots(&self) -> Incidence {
        let mut pairs = Vec::with_capacity(4 * self.edges.len());
        for (e, edge) in self.edges.iter().enumerate() {
            let first = index(4 * e);
            if let Some(hinge) = self.hinges.get(e) {
                pairs.push((hinge.vertices[0], first));
                pairs.push((hinge.vertices[1], first + 1));
            }
            pairs.push((edge[0], first + 2));
            pairs.push((edge[1], first + 3));
        }
        Incidence::new(self.positions.len(), &pairs)
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// True when the edge belongs to one triangle only.
    pub fn is_boundary(&self, edge: usize) -> bool {
        self.hinges.len() <= edge
    }

    /// True when the mesh has no rim.
    pub fn is_closed(&self) -> bool {
        self.rims.is_empty()
    }

    /// A third of the reference area of the triangles at each vertex (m²).
    pub fn vertex_areas(&self) -> Vec<Real> {
        let mut areas = vec![0.0; self.n_vertices()];
        for triangle in &self.triangles {
            let area = 0.5 * area_normal(&self.positions, triangle).norm();
            for &vertex in triangle {
                areas[vertex as usize] += area / 3.0;
            }
        }
        areas
    }
}

/// Outward normal of a triangle, as long as twice its area (m²).
#[inline]
pub fn area_normal(positions: &[Vec3], triangle: &[u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|v| positions[v as usize]);
    (b - a).cross(&(c - a))
}

/// A place in a list as the 32-bit number that meshes store.
#[expect(clippy::cast_possible_truncation, reason = "meshes stay far below 2³² entries")]
pub(super) fn index(place: usize) -> u32 {
    debug_assert!(place < NONE as usize);
    place as u32
}

fn ends(triangle: &[u32; 3], place: usize) -> [u32; 2] {
    [triangle[place], triangle[(place + 1) % 3]]
}

fn triangles_of_vertex(n_vertices: usize, triangles: &[[u32; 3]]) -> Incidence {
    let at_vertices = |(t, triangle): (usize, &[u32; 3])| triangle.map(|v| (v, index(t)));
    let pairs: Vec<_> = triangles.iter().enumerate().flat_map(at_vertices).collect();
    Incidence::new(n_vertices, &pairs)
}

fn check_triangles(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    let n_vertices = positions.len();
    if let Some(vertex) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(MeshError::NotFinite { vertex });
    }
    let mut is_used = vec![false; n_vertices];
    for (t, triangle) in triangles.iter().enumerate() {
        for &vertex in triangle {
            if n_vertices <= vertex as usize {
                return Err(MeshError::NoSuchVertex { triangle: t, vertex, n_vertices });
            }
            is_used[vertex as usize] = true;
        }
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let longest = (b - a).norm_squared().max((c - a).norm_squared());
        // A height of 10⁻¹² of the side is rounding, not shape.
        if (b - a).cross(&(c - a)).norm() <= 1e-12 * longest {
            return Err(MeshError::NoArea { triangle: t });
        }
    }
    match is_used.iter().position(|used| !used) {
        Some(vertex) => Err(MeshError::Unused { vertex }),
        None => Ok(()),
    }
}

fn sorted_sides(triangles: &[[u32; 3]]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (t, triangle) in triangles.iter().enumerate() {
        for place in 0..3 {
            let [from, to] = ends(triangle, place);
            sides.push(Side {
                low: from.min(to),
                high: from.max(to),
                runs_down: to < from,
                triangle: index(t),
                place: index(place),
            });
        }
    }
    sides.sort_unstable();
    sides
}

/// Sides that meet, as [running up, running down], and sides left alone.
fn pair_sides(sides: &[Side]) -> Result<(Vec<[Side; 2]>, Vec<Side>), MeshError> {
    let (mut inner, mut outer) = (Vec::new(), Vec::new());
    for group in sides.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        match *group {
            [side] => outer.push(side),
            [up, down] if !up.runs_down && down.runs_down => inner.push([up, down]),
            [a, b] => {
                return Err(MeshError::Orientation {
                    from: a.low,
                    to: a.high,
                    first: a.triangle as usize,
                    second: b.triangle as usize,
                });
            }
            _ => {
                let (from, to) = (group[0].low, group[0].high);
                return Err(MeshError::Branching { from, to, count: group.len() });
            }
        }
    }
    Ok((inner, outer))
}

/// The loops of boundary sides, against the direction in which their triangles run, in the order of
/// their first sides.
fn rim_loops(
    n_vertices: usize,
    triangles: &[[u32; 3]],
    outer: &[Side],
) -> Result<Vec<Vec<u32>>, MeshError> {
    let mut before = vec![NONE; n_vertices];
    for side in outer {
        let [from, to] = ends(&triangles[side.triangle as usize], side.place as usize);
        if before[to as usize] != NONE {
            return Err(MeshError::TwoRims { vertex: to });
        }
        before[to as usize] = from;
    }
    let mut rims = Vec::new();
    for first in outer {
        let mut rim = Vec::new();
        let mut vertex = first.low;
        while before[vertex as usize] != NONE {
            rim.push(vertex);
            vertex = std::mem::replace(&mut before[vertex as usize], NONE);
        }
        if !rim.is_empty() {
            rims.push(rim);
        }
    }
    Ok(rims)
}
