//! Closest points of candidate triangles: which triangles a grain overlaps, and where.
//!
//! A candidate separated from its grain by `gap` cannot touch it before grain and triangle have moved by a total
//! of `gap`. It therefore sleeps until `travel`, the accumulated largest displacements of any grain and any
//! vertex, has grown by the gap. The awake candidates are evaluated in lanes.

use crate::{
    base::{
        Real,
        lanes::{self, Kernel, Lanes, Vector},
        parallel,
    },
    physics::{
        Model,
        membrane::{VertexRow, contact_geometry::closest, mesh::Mesh},
        scratch::{CandidateScratch, GrainRow, Neighbors},
    },
};

/// Finds the closest points of all awake candidates.
pub(super) fn find_closest(
    model: &Model,
    lists: &mut Neighbors,
    (rows, vertices): (&[GrainRow], &[VertexRow]),
    scratch: &mut CandidateScratch,
) {
    list_awake(lists, scratch);
    let CandidateScratch { awake, found, .. } = scratch;
    found.resize(awake.len(), [0.0; 8]);
    let input = Input { mesh: &model.membrane.mesh, lists, rows, vertices };
    parallel::for_parts_of_two(found, awake, |_, found, awake| {
        lanes::widest(Pass { input: &input, awake, found });
    });
    for (&k, found) in scratch.awake.iter().zip(&scratch.found) {
        let radius = rows[lists.candidate_grains[k as usize] as usize].position_radius[3];
        if found[0] >= radius * radius {
            // Slightly less than the gap, because sums are rounded.
            lists.wake_at[k as usize] = lists.travel + (found[0].sqrt() - radius) * (1.0 - 1e-9);
        }
    }
}

/// Lists the awake candidates, grain by grain.
fn list_awake(lists: &Neighbors, scratch: &mut CandidateScratch) {
    let CandidateScratch { awake, awake_starts, .. } = scratch;
    awake.clear();
    awake.resize(lists.triangles.len(), 0);
    awake_starts.clear();
    awake_starts.push(0);
    let mut n_awake = 0;
    // Grains and their candidates have the same order in all lists.
    let mut k = 0;
    for &grain in &lists.membrane_grains {
        let end = lists.triangle_starts[grain as usize + 1];
        for (index, wake_at) in (k..end).zip(&lists.wake_at[k as usize..end as usize]) {
            awake[n_awake] = index;
            // Branch-free, and a NaN travel wakes all candidates.
            n_awake += usize::from(!is_more(*wake_at, lists.travel));
        }
        k = end;
        awake_starts.push(n_awake);
    }
    awake.truncate(n_awake);
}

fn is_more(a: Real, b: Real) -> bool {
    a > b
}

/// Input of the pass.
struct Input<'a> {
    mesh: &'a Mesh,
    lists: &'a Neighbors,
    rows: &'a [GrainRow],
    vertices: &'a [VertexRow],
}

/// The pass over the awake candidates.
struct Pass<'a> {
    input: &'a Input<'a>,
    awake: &'a [u32],
    found: &'a mut [[Real; 8]],
}

impl Kernel for Pass<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { input, awake, found } = self;
        let n_whole = awake.len() / L::N * L::N;
        let (awake, last_awake) = awake.split_at(n_whole);
        let (found, last_found) = found.split_at_mut(n_whole);
        for (awake, found) in awake.chunks_exact(L::N).zip(found.chunks_exact_mut(L::N)) {
            input.block::<L>(awake, found);
        }
        for (awake, found) in last_awake.chunks_exact(1).zip(last_found.chunks_exact_mut(1)) {
            input.block::<f64>(awake, found);
        }
    }
}

impl Input<'_> {
    #[inline(always)]
    fn block<L: Lanes>(&self, awake: &[u32], found: &mut [[Real; 8]]) {
        let grain = |lane: usize| {
            &self.rows[self.lists.candidate_grains[awake[lane] as usize] as usize].position_radius
        };
        let triangle =
            |lane: usize| &self.mesh.triangles[self.lists.triangles[awake[lane] as usize] as usize];
        let corner = |lane: usize, k: usize| &self.vertices[triangle(lane)[k] as usize].position;
        let vector = |[x, y, z, _]: [L; 4]| Vector::new(x, y, z);
        let corners = [
            vector(L::from_rows_of_4(|lane| corner(lane, 0))),
            vector(L::from_rows_of_4(|lane| corner(lane, 1))),
            vector(L::from_rows_of_4(|lane| corner(lane, 2))),
        ];
        let it = closest(vector(L::from_rows_of_4(grain)), corners);
        let [w0, w1, w2] = it.weights;
        let Vector { x, y, z } = it.to_given;
        L::to_rows_of_8([it.distance_squared, w0, w1, w2, x, y, z, it.feature], found);
    }
}
