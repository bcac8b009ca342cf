//! A triangle mesh with its connectivity: edges, hinges, rims, and incidence lists of the vertices.
//!
//! ```text
//!            r1                triangle 1 = (r1, r3, r4), triangle 2 = (r2, r4, r3),
//!          /    \              both with outward normals, so
//!        /   1    \              n1 = (r1 − r3) × (r1 − r4)
//!      r3 -------- r4            n2 = (r2 − r4) × (r2 − r3)
//!        \   2    /            as in Götz (2024), eqs. 17, 18.
//!          \    /
//!            r2
//! ```
//!
//! Every edge between two triangles is a hinge. Hinges come first in the numbering of edges: hinge `h` folds about
//! edge `h`, and edges from `hinges.len()` on are boundary edges.

use thiserror::Error;

use crate::base::{Real, Vec3};

/// Marks the missing second triangle of a boundary edge.
pub const NONE: u32 = u32::MAX;

/// Two triangles that share an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hinge {
    /// Vertices r1, r2 opposite the edge and r3, r4 at its ends.
    pub vertices: [u32; 4],
    /// Triangles 1 and 2.
    pub triangles: [u32; 2],
}

/// A list of entries for each vertex, stored contiguously.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Incidence {
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl Incidence {
    /// Sorts pairs `(vertex, entry)` by vertex. The entries of a vertex keep their order.
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

/// A consistently oriented surface with one or more parts, each closed or with rims.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Reference position of each vertex (m).
    pub positions: Vec<Vec3>,
    /// Vertices of each triangle, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of each edge, hinges first. A boundary edge has the direction of its triangle.
    pub edges: Vec<[u32; 2]>,
    /// The two triangles at each edge that is not on the boundary.
    pub hinges: Vec<Hinge>,
    /// Triangles on both sides of each edge, the second `NONE` on the boundary.
    pub triangles_of_edge: Vec<[u32; 2]>,
    /// Edges of each triangle: edge `k` joins its vertices `k` and `k + 1`.
    pub edges_of_triangle: Vec<[u32; 3]>,
    /// Triangle across each edge of each triangle, `NONE` on the boundary.
    pub neighbors_of_triangle: Vec<[u32; 3]>,
    /// Vertices of each boundary loop, in right-handed order about the outward normal of a lid that closes it.
    /// Empty for a closed mesh.
    pub rims: Vec<Vec<u32>>,
    /// True for boundary vertices.
    pub is_on_rim: Vec<bool>,
    /// Triangles at each vertex.
    pub triangles_of_vertex: Incidence,
    /// `4 · edge + slot` for each role of a vertex: slots 0 and 1 are r1 and r2 of a hinge, slots 2 and 3 are the
    /// ends r3 and r4 of the edge.
    pub slots_of_vertex: Incidence,
}

/// Why triangles do not form a valid surface.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MeshError {
    /// A vertex index that does not exist.
    #[error(
        "triangle {triangle} refers to vertex {vertex}, but there are only {n_vertices} vertices"
    )]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The invalid index.
        vertex: u32,
        /// Number of vertices.
        n_vertices: usize,
    },
    /// A coordinate that is not finite.
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
    #[error("edge {from}-{to} belongs to {count} triangles; a surface has at most 2 at each edge")]
    Branching {
        /// One end.
        from: u32,
        /// The other end.
        to: u32,
        /// Number of triangles at the edge.
        count: usize,
    },
    /// Two adjacent triangles with opposite orientations.
    #[error(
        "triangles {first} and {second} have opposite orientations at edge {from}-{to}; flip one of them"
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
    /// A vertex without triangle.
    #[error("vertex {vertex} belongs to no triangle; remove it")]
    Unused {
        /// The vertex.
        vertex: usize,
    },
    /// A boundary that touches itself.
    #[error("vertex {vertex} is on two rims; split it into two vertices")]
    TwoRims {
        /// The vertex.
        vertex: u32,
    },
    /// A tube or bar with too few vertices.
    #[error(
        "{n_around} vertices around and {n_rows} rows are too few; a tube needs at least 3 and 2, a \
         bar 8 and 2"
    )]
    TooFew {
        /// Number of vertices in a row.
        n_around: usize,
        /// Number of rows.
        n_rows: usize,
    },
    /// A disc without rings.
    #[error("a disc needs at least 1 ring of vertices, not {n_rings}")]
    TooFewRings {
        /// Number of rings.
        n_rings: usize,
    },
    /// A frequency without edges on the equator.
    #[error("subdivision frequency {frequency} is not an even number of at least 2")]
    Frequency {
        /// The invalid frequency.
        frequency: usize,
    },
}

/// One side of one triangle. Sorting brings the sides of an edge together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    low: u32,
    high: u32,
    is_descending: bool,
    triangle: u32,
    slot: u32,
}

impl Mesh {
    /// Creates a mesh and finds its edges, hinges and rims.
    ///
    /// # Errors
    /// If the triangles do not form a consistently oriented surface whose rims do not touch.
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
            neighbors_of_triangle: vec![[NONE; 3]; triangles.len()],
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
            |side: Side| self.triangles[side.triangle as usize][(side.slot as usize + 2) % 3];
        self.hinges.push(Hinge {
            vertices: [opposite(up), opposite(down), up.low, up.high],
            triangles: [up.triangle, down.triangle],
        });
        self.edges.push([up.low, up.high]);
        self.triangles_of_edge.push([up.triangle, down.triangle]);
        for (side, other) in [(up, down), (down, up)] {
            let (triangle, slot) = (side.triangle as usize, side.slot as usize);
            self.edges_of_triangle[triangle][slot] = edge;
            self.neighbors_of_triangle[triangle][slot] = other.triangle;
        }
    }

    fn add_boundary_edge(&mut self, side: Side) {
        let edge = index(self.edges.len());
        let (triangle, slot) = (side.triangle as usize, side.slot as usize);
        self.edges.push(ends(&self.triangles[triangle], slot));
        self.triangles_of_edge.push([side.triangle, NONE]);
        self.edges_of_triangle[triangle][slot] = edge;
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

    /// True if the edge belongs to only one triangle.
    pub fn is_boundary(&self, edge: usize) -> bool {
        self.hinges.len() <= edge
    }

    /// True if the mesh has no rim.
    pub fn is_closed(&self) -> bool {
        self.rims.is_empty()
    }

    /// A third of the reference area of the triangles at each vertex (m²): the area that a vertex represents.
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

/// Outward normal of a triangle; its length is twice the area (m²).
#[inline]
pub fn area_normal(positions: &[Vec3], triangle: &[u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|v| positions[v as usize]);
    (b - a).cross(&(c - a))
}

/// An index as the 32-bit number that meshes store.
#[expect(clippy::cast_possible_truncation, reason = "meshes stay far below 2³² entries")]
pub(super) fn index(i: usize) -> u32 {
    debug_assert!(i < NONE as usize);
    i as u32
}

fn ends(triangle: &[u32; 3], slot: usize) -> [u32; 2] {
    [triangle[slot], triangle[(slot + 1) % 3]]
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
        // A height below 10⁻¹² of the side is rounding.
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
        for slot in 0..3 {
            let [from, to] = ends(triangle, slot);
            sides.push(Side {
                low: from.min(to),
                high: from.max(to),
                is_descending: to < from,
                triangle: index(t),
                slot: index(slot),
            });
        }
    }
    sides.sort_unstable();
    sides
}

/// Pairs of sides at the same edge, as (ascending, descending), and sides without partner.
fn pair_sides(sides: &[Side]) -> Result<(Vec<[Side; 2]>, Vec<Side>), MeshError> {
    let (mut inner, mut outer) = (Vec::new(), Vec::new());
    for group in sides.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        match *group {
            [side] => outer.push(side),
            [up, down] if !up.is_descending && down.is_descending => inner.push([up, down]),
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

/// The loops of boundary sides, against the direction of their triangles, in the order of their first sides.
fn rim_loops(
    n_vertices: usize,
    triangles: &[[u32; 3]],
    outer: &[Side],
) -> Result<Vec<Vec<u32>>, MeshError> {
    let mut previous = vec![NONE; n_vertices];
    for side in outer {
        let [from, to] = ends(&triangles[side.triangle as usize], side.slot as usize);
        if previous[to as usize] != NONE {
            return Err(MeshError::TwoRims { vertex: to });
        }
        previous[to as usize] = from;
    }
    let mut rims = Vec::new();
    for first in outer {
        let mut rim = Vec::new();
        let mut vertex = first.low;
        while previous[vertex as usize] != NONE {
            rim.push(vertex);
            vertex = std::mem::replace(&mut previous[vertex as usize], NONE);
        }
        if !rim.is_empty() {
            rims.push(rim);
        }
    }
    Ok(rims)
}
