//! Forces of springs, hinges and pressure on every vertex.
//!
//! ```text
//! F_v = Σ_links (spring + hinge) + p/6 Σ_facets n
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | F_v | force on vertex v | N |
//! | p | gauge pressure inside | Pa |
//! | n | area normal of a facet at the vertex, \|n\| = 2 · area | m² |
//!
//! Sources and validity: `stretch` for springs, `bridson_2003` for hinges, `pressure` for the air.
//!
//! There are three passes, each of which computes its elements from read-only data: the normal of every
//! facet, the four forces of every link (an edge with its spring and its hinge), and the sum at every
//! vertex in a fixed order. The bits do not depend on the number of threads or lanes.

use super::{
    MembraneModel, MembraneScratch, MembraneState, Side, VertexRow, bridson_2003::Fold, stretch,
};
use crate::base::{
    Real, Vec3,
    lanes::{self, Kernel, Lanes, Vector},
    parallel,
};

/// Computes the forces of springs, hinges and `gauge_pressure` (Pa) on every vertex, in `scratch.forces`.
pub fn forces(
    model: &MembraneModel,
    state: &MembraneState,
    gauge_pressure: Real,
    scratch: &mut MembraneScratch,
) {
    let MembraneScratch { facets, vertices, wing_forces, end_forces, forces } = scratch;
    parallel::for_each(vertices, |v, row| {
        let (position, velocity) = (&state.positions[v], &state.velocities[v]);
        row.position = [position.x, position.y, position.z, 0.0];
        row.velocity = [velocity.x, velocity.y, velocity.z, 0.0];
    });
    let vertices = &*vertices;
    parallel::for_parts(facets, |first, facets| {
        lanes::widest(FacetPass {
            model,
            vertices,
            first,
            facets: bytemuck::cast_slice_mut(facets),
        });
    });
    let facets = bytemuck::cast_slice(facets);
    parallel::for_parts_of_two(wing_forces, end_forces, |first, wings, ends| {
        lanes::widest(LinkPass { model, vertices, facets, first, wings, ends });
    });
    let link_forces = [&**wing_forces, &**end_forces].map(bytemuck::cast_slice);
    parallel::for_parts(forces, |first, forces| {
        lanes::widest(VertexPass { model, gauge_pressure, facets, link_forces, first, forces });
    });
}

/// The first three of four numbers as a vector.
#[inline(always)]
fn vector<L: Lanes>([x, y, z, _]: [L; 4]) -> Vector<L> {
    Vector::new(x, y, z)
}

/// A facet from a row of `Facet`.
#[inline(always)]
fn side<L: Lanes>([x, y, z, inverse_norm]: [L; 4]) -> Side<L> {
    Side { area_normal: Vector::new(x, y, z), inverse_norm }
}

/// The pass over facets from index `first` on.
struct FacetPass<'a> {
    model: &'a MembraneModel,
    vertices: &'a [VertexRow],
    first: usize,
    /// Rows of `Facet`.
    facets: &'a mut [[Real; 4]],
}

impl Kernel for FacetPass<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { model, vertices, first, facets } = self;
        let triangles = &model.mesh.triangles[first..first + facets.len()];
        let n_whole = facets.len() / L::N * L::N;
        let (whole, rest) = facets.split_at_mut(n_whole);
        for (triangles, facets) in triangles.chunks_exact(L::N).zip(whole.chunks_exact_mut(L::N)) {
            orient::<L>(vertices, triangles, facets);
        }
        for (triangle, facet) in triangles[n_whole..].chunks_exact(1).zip(rest.chunks_exact_mut(1))
        {
            orient::<Real>(vertices, triangle, facet);
        }
    }
}

#[inline(always)]
fn orient<L: Lanes>(vertices: &[VertexRow], triangles: &[[u32; 3]], facets: &mut [[Real; 4]]) {
    let position = |lane: usize, k: usize| &vertices[triangles[lane][k] as usize].position;
    let side = Side::new([
        vector(L::from_rows_of_4(|lane| position(lane, 0))),
        vector(L::from_rows_of_4(|lane| position(lane, 1))),
        vector(L::from_rows_of_4(|lane| position(lane, 2))),
    ]);
    let Vector { x, y, z } = side.area_normal;
    L::to_rows_of_4([x, y, z, side.inverse_norm], facets);
}

/// The pass over links from index `first` on.
struct LinkPass<'a> {
    model: &'a MembraneModel,
    vertices: &'a [VertexRow],
    /// Rows of `Facet`.
    facets: &'a [[Real; 4]],
    first: usize,
    wings: &'a mut [[Real; 8]],
    ends: &'a mut [[Real; 8]],
}

impl Kernel for LinkPass<'_> {
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let n_hinges = self.model.mesh.hinges.len();
        let (mut k, n) = (0, self.wings.len());
        while k < n {
            // Boundary edges have no hinge. They are few, and are computed one at a time.
            if self.first + k + L::N <= n_hinges && k + L::N <= n {
                self.hinges::<L>(k);
                k += L::N;
            } else {
                if self.first + k < n_hinges {
                    self.hinges::<Real>(k);
                } else {
                    self.boundary(k);
                }
                k += 1;
            }
        }
    }
}

impl LinkPass<'_> {
    /// Computes `L::N` links with hinges from the `k`-th on.
    #[inline(always)]
    fn hinges<L: Lanes>(&mut self, k: usize) {
        let first = self.first + k;
        let links = &self.model.links[first..first + L::N];
        let row = |lane: usize, k: usize| &self.vertices[links[lane].vertices[k] as usize];
        let [r1, r2, r3, r4] = [0, 1, 2, 3];
        let positions = [
            vector(L::from_rows_of_4(|lane| &row(lane, r1).position)),
            vector(L::from_rows_of_4(|lane| &row(lane, r2).position)),
            vector(L::from_rows_of_4(|lane| &row(lane, r3).position)),
            vector(L::from_rows_of_4(|lane| &row(lane, r4).position)),
        ];
        let velocities = [
            vector(L::from_rows_of_4(|lane| &row(lane, r1).velocity)),
            vector(L::from_rows_of_4(|lane| &row(lane, r2).velocity)),
            vector(L::from_rows_of_4(|lane| &row(lane, r3).velocity)),
            vector(L::from_rows_of_4(|lane| &row(lane, r4).velocity)),
        ];
        let sides = [
            side(L::from_rows_of_4(|lane| &self.facets[links[lane].triangles[0] as usize])),
            side(L::from_rows_of_4(|lane| &self.facets[links[lane].triangles[1] as usize])),
        ];
        let [rest_length, stiffness, damping, rest_half_sine] =
            L::from_rows_of_4(|lane| bytemuck::cast_ref(&links[lane].law));
        let edge = positions[3] - positions[2];
        let length = edge.dot(edge).sqrt();
        let inverse = L::splat(1.0) / length;
        let along = edge * inverse;
        let rate = along.dot(velocities[3] - velocities[2]);
        let pull = along * stretch::tension([rest_length, stiffness, damping], length, rate);
        let mut fold = Fold::new(positions, sides, edge, [length, inverse]);
        if let [Some(first), Some(second)] =
            [0, 1].map(|side| self.model.reference_areas[side].get(first..first + L::N))
        {
            fold = fold.with_areas([L::load(first), L::load(second)], sides, length);
        }
        let material = &self.model.material;
        let [mut stiffness, mut damping] =
            [material.bending_stiffness, material.bending_damping].map(L::splat);
        if let [Some(elastic), Some(viscous)] =
            [0, 1].map(|k| self.model.bending[k].get(first..first + L::N))
        {
            (stiffness, damping) = (L::load(elastic), L::load(viscous));
        }
        let opening = fold.half_sine - rest_half_sine;
        let elastic = stiffness * fold.slenderness * opening;
        let viscous = damping * length * fold.project(velocities);
        let [f1, f2, f3, f4] = fold.spread(elastic - viscous);
        let (f3, f4, zero) = (f3 + pull, f4 - pull, L::splat(0.0));
        let (wings, ends) = (&mut self.wings[k..k + L::N], &mut self.ends[k..k + L::N]);
        L::to_rows_of_8([f1.x, f1.y, f1.z, zero, f2.x, f2.y, f2.z, zero], wings);
        L::to_rows_of_8([f3.x, f3.y, f3.z, zero, f4.x, f4.y, f4.z, zero], ends);
    }

    /// Computes the `k`-th link, which has a spring but no hinge.
    #[inline(always)]
    fn boundary(&mut self, k: usize) {
        let link = &self.model.links[self.first + k];
        let [from, to] = [2, 3].map(|end| &self.vertices[link.vertices[end] as usize]);
        let between = |from: &[Real; 4], to: &[Real; 4]| {
            Vector::new(to[0] - from[0], to[1] - from[1], to[2] - from[2])
        };
        let edge: Vector<Real> = between(&from.position, &to.position);
        let length = edge.dot(edge).sqrt();
        let along = edge * (1.0 / length);
        let rate = along.dot(between(&from.velocity, &to.velocity));
        let [rest_length, stiffness, damping, _] = bytemuck::cast::<_, [Real; 4]>(link.law);
        let pull = along * stretch::tension([rest_length, stiffness, damping], length, rate);
        let reaction = -pull;
        self.wings[k] = [0.0; 8];
        self.ends[k] = [pull.x, pull.y, pull.z, 0.0, reaction.x, reaction.y, reaction.z, 0.0];
    }
}

/// The pass over vertices from index `first` on: it sums the pressure, then the links in the order of their
/// numbers.
struct VertexPass<'a> {
    model: &'a MembraneModel,
    gauge_pressure: Real,
    /// Rows of `Facet`.
    facets: &'a [[Real; 4]],
    /// Two rows per link: of wings, of ends.
    link_forces: [&'a [[Real; 4]]; 2],
    first: usize,
    forces: &'a mut [Vec3],
}

impl Kernel for VertexPass<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let mesh = &self.model.mesh;
        for (vertex, force) in (self.first..).zip(self.forces) {
            let mut sum = [0.0; 4];
            for &t in mesh.triangles_of_vertex.of(vertex) {
                sum = add_row(sum, &self.facets[t as usize]);
            }
            sum = sum.map(|load| load * (self.gauge_pressure / 6.0));
            for &slot in mesh.slots_of_vertex.of(vertex) {
                let (link, corner) = (slot as usize / 4, slot as usize % 4);
                sum = add_row(sum, &self.link_forces[corner / 2][2 * link + corner % 2]);
            }
            *force = Vec3::new(sum[0], sum[1], sum[2]);
        }
    }
}

#[inline(always)]
fn add_row(sum: [Real; 4], row: &[Real; 4]) -> [Real; 4] {
    std::array::from_fn(|c| sum[c] + row[c])
}
