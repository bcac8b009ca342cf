//! The longest stable substep of a membrane.
//!
//! ```text
//! semi-implicit Euler:  v' = v − dt M⁻¹(K x + C v),  x' = x + dt v'
//! stable while          λ(dt) = largest eigenvalue of M⁻¹(dt² K + 2 dt C)  <  4
//!
//! one mode:             dt < 2/ω (√(1 + ζ²) − ζ),   ω² from K, 2 ζ ω from C
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | dt | length of a substep | s |
//! | x, v | displacements and velocities of the vertices | m, m/s |
//! | M, K, C | matrices of mass, stiffness and damping | kg, N/m, N s/m |
//! | λ | eigenvalue | – |
//! | ω, ζ | angular frequency and damping ratio of a mode | rad/s, – |
//!
//! Source: linear stability of the scheme. The first unstable mode has the factor −1 per step: x' = −x
//! makes dt² K + 2 dt C − 4 M singular.
//!
//! Valid near the given shape: K and C are those of springs and hinges there; contacts add their
//! stiffness to every vertex. On a regular lattice ω² = 6 k/m without hinges. A strain ε of the membrane
//! changes the limit by a fraction of about ε, which a safety factor on the step must cover; if damped
//! hinges with reference areas determine the limit, by 3 ε.
//!
//! Eigenvalues are computed by power iteration. Rejected: bounds from rows or elements of the matrix
//! (9 k/m and 12 k/m on the lattice), which cost 20–40 % of the speed of a run. Since λ(s dt) ≤ s² λ(dt)
//! for s > 1, the iteration dt ← dt √(4/λ) approaches the limit from the stable side.

use super::bridson_2003::Fold;
use super::{FREE, Facet, MembraneModel, Side};
use crate::base::{Real, Vec3, lanes::Vector};

/// Iterations for the first eigenvalue: about 1 % accurate, even if eigenvalues are close to each other.
const N_FIRST: usize = 150;
/// Iterations for each further eigenvalue, which starts from the last mode.
const N_NEXT: usize = 25;
/// Iterations of dt; each at least halves the distance from the limit.
const N_STEP_ITERATIONS: usize = 8;
/// Safety margin, because power iteration approaches eigenvalues from below.
const MARGIN: Real = 1.02;

/// The linearized membrane.
struct Linear<'a> {
    model: &'a MembraneModel,
    positions: &'a [Vec3],
    folds: Vec<Option<Fold<Real>>>,
    contact_stiffness: Real,
}

/// The longest stable substep (s) of a membrane in its reference shape whose vertices have contacts of
/// `contact_stiffness` (N/m), 0 without contacts.
pub fn critical_step(model: &MembraneModel, contact_stiffness: Real) -> Real {
    critical_step_at(model, &model.mesh.positions, contact_stiffness)
}

/// The longest stable substep (s) with the vertices at `positions` (m).
pub fn critical_step_at(
    model: &MembraneModel,
    positions: &[Vec3],
    contact_stiffness: Real,
) -> Real {
    let folds = (0..model.links.len()).map(|k| fold(model, positions, k)).collect();
    let linear = Linear { model, positions, folds, contact_stiffness };
    let mut mode = start_vector(model.mesh.n_vertices());
    let square = MARGIN * linear.largest_eigenvalue([1.0, 0.0], &mut mode, N_FIRST);
    restore_empty_axes(&mut mode);
    let rate = MARGIN * linear.largest_eigenvalue([0.0, 1.0], &mut mode, N_FIRST);
    restore_empty_axes(&mut mode);
    // A lower bound of the limit: as if the stiffest mode were also the most damped one.
    let mut dt = ((rate * rate + 4.0 * square).sqrt() - rate) / square;
    for _ in 0..N_STEP_ITERATIONS {
        let weights = [dt * dt, 2.0 * dt];
        dt *= (4.0 / (MARGIN * linear.largest_eigenvalue(weights, &mut mode, N_NEXT))).sqrt();
    }
    dt
}

/// Start vector for power iteration, with a component of every mode: it has no symmetry of the mesh.
fn start_vector(n: usize) -> Vec<Vec3> {
    let at = |v: usize| {
        let phase = (v as Real) * 0.618_033_988_749_895;
        Vec3::new(phase.fract() - 0.5, (1.7 * phase).fract() - 0.5, (2.3 * phase).fract() - 0.5)
    };
    (0..n).map(at).collect()
}

/// Restores axes along which the mode has become zero. The springs of a flat membrane act in its plane and its
/// hinges normal to it, so iterating with one of them removes the modes of the other.
fn restore_empty_axes(mode: &mut [Vec3]) {
    for axis in 0..3 {
        if mode.iter().all(|x| x[axis] == 0.0) {
            let start = start_vector(mode.len());
            mode.iter_mut().zip(&start).for_each(|(x, start)| x[axis] = start[axis]);
        }
    }
}

/// Geometry of the hinge of the `k`-th link; `None` on the boundary.
fn fold(model: &MembraneModel, positions: &[Vec3], k: usize) -> Option<Fold<Real>> {
    let link = &model.links[k];
    if !link.is_hinge() {
        return None;
    }
    let triangles = link.triangles.map(|t| &model.mesh.triangles[t as usize]);
    let [t1, t2] = triangles.map(|triangle| Facet::new(positions, triangle));
    let fold = link.fold(positions, [&t1, &t2]);
    let [_, _, r3, r4] = link.corners(positions);
    let first = model.reference_areas.each_ref().map(|areas| areas.get(k).copied());
    Some(match first {
        [Some(one), Some(two)] => {
            fold.with_areas([one, two], [Side::from(&t1), Side::from(&t2)], (r4 - r3).norm())
        }
        _ => fold,
    })
}

impl Linear<'_> {
    /// Largest eigenvalue of M⁻¹(w₀ K + w₁ C), with held vertices fixed. `mode` is the start vector on entry and the
    /// approximate mode on return; `n` is the number of iterations.
    fn largest_eigenvalue(&self, weights: [Real; 2], mode: &mut [Vec3], n: usize) -> Real {
        let model = self.model;
        let mut eigenvalue = 0.0;
        for _ in 0..n {
            let forces = self.apply(weights, mode);
            let (mut xkx, mut xmx, mut yy) = (0.0, 0.0, 0.0);
            for (v, x) in mode.iter_mut().enumerate() {
                if model.holders[v] != FREE {
                    *x = Vec3::zeros();
                    continue;
                }
                xkx += x.dot(&forces[v]);
                xmx += model.masses[v] * x.norm_squared();
                *x = forces[v] / model.masses[v];
                yy += x.norm_squared();
            }
            if yy == 0.0 {
                mode.copy_from_slice(&start_vector(mode.len()));
                return 0.0;
            }
            eigenvalue = xkx / xmx;
            mode.iter_mut().for_each(|x| *x /= yy.sqrt());
        }
        eigenvalue
    }

    /// (w₀ K + w₁ C) x.
    fn apply(&self, [stiff, damp]: [Real; 2], x: &[Vec3]) -> Vec<Vec3> {
        let model = self.model;
        let mut y: Vec<Vec3> = x.iter().map(|x| x * (stiff * self.contact_stiffness)).collect();
        for (k, (link, fold)) in model.links.iter().zip(&self.folds).enumerate() {
            let at = link.vertices.map(|v| v as usize);
            let [_, _, r3, r4] = link.corners(self.positions);
            let edge = r4 - r3;
            let length = edge.norm();
            let along = edge / length;
            let spring = stiff * link.law.spring.stiffness + damp * link.law.spring.damping;
            let pull = along * (spring * along.dot(&(x[at[3]] - x[at[2]])));
            y[at[2]] -= pull;
            y[at[3]] += pull;
            let Some(fold) = fold else { continue };
            // d(sin θ/2)/dθ = cos(θ/2)/2.
            let half_cosine = (1.0 - fold.half_sine * fold.half_sine).max(0.0).sqrt();
            let [stiffness, damping] = model.bending_of(k);
            let elastic = 0.5 * half_cosine * stiffness * fold.slenderness;
            let hinge = stiff * elastic + damp * damping * length;
            let rotation = fold.project(link.corners(x).map(|x| Vector::from(*x)));
            for (vertex, force) in at.into_iter().zip(fold.spread(hinge * rotation)) {
                y[vertex] += Vec3::from(force);
            }
        }
        y
    }
}
