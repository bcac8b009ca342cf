//! The longest substep that does not blow up.
//!
//! ```text
//! semi-implicit Euler:  v' = v − dt M⁻¹(K x + C v),  x' = x + dt v'
//! stable while          λ(dt) = largest eigenvalue of M⁻¹(dt² K + 2 dt C)  <  4
//!
//! one mode:             dt < 2/ω (√(1 + ζ²) − ζ),   ω² from K, 2 ζ ω from C
//! ```
//!
//! The first unstable mode has the factor −1 per step: x' = −x makes dt² K + 2 dt C − 4 M singular.
//! K and C are those of springs and hinges in the reference shape or another; contacts add their
//! stiffness to every vertex. On a regular lattice ω² = 6 k/m without hinges. A strain ε of the membrane
//! changes the limit by a share of about ε, which is what a safety factor on the step is for; where
//! damped hinges set it and have their first areas, by 3 ε.
//!
//! Eigenvalues come from power iteration. Bounds from rows or elements of the matrix (9 k/m and
//! 12 k/m on the lattice) were rejected: they cost 20–40 % of the speed of a run. Since
//! λ(s dt) ≤ s² λ(dt) for s > 1, steps dt ← dt √(4/λ) approach the limit from the safe side.

use super::bridson_2003::Fold;
use super::{FREE, Facet, MembraneModel, Side};
use crate::base::{Real, Vec3, lanes::Vector};

/// Iterations for the first eigenvalue: about a percent, whatever its neighbours.
const N_FIRST: usize = 150;
/// Iterations for each further one, which starts where the last ended.
const N_NEXT: usize = 25;
/// Approaches to the limit; each at least halves what is missing.
const N_APPROACHES: usize = 8;
/// What power iteration may still have missed: it finds eigenvalues from below.
const MARGIN: Real = 1.02;

/// The membrane as a linear force law with weights on its stiffness and its damping.
struct Linear<'a> {
    model: &'a MembraneModel,
    positions: &'a [Vec3],
    folds: Vec<Option<Fold<Real>>>,
    contact_stiffness: Real,
}

/// The longest stable substep (s) of a membrane whose vertices meet contacts of `contact_stiffness`
/// (N/m) (0 for none).
pub fn critical_step(model: &MembraneModel, contact_stiffness: Real) -> Real {
    critical_step_at(model, &model.mesh.positions, contact_stiffness)
}

/// The same with the vertices at `positions`.
pub fn critical_step_at(
    model: &MembraneModel,
    positions: &[Vec3],
    contact_stiffness: Real,
) -> Real {
    let folds = (0..model.links.len()).map(|k| fold(model, positions, k)).collect();
    let linear = Linear { model, positions, folds, contact_stiffness };
    let mut mode = irregular(model.mesh.n_vertices());
    let square = MARGIN * linear.largest_eigenvalue([1.0, 0.0], &mut mode, N_FIRST);
    stir(&mut mode);
    let rate = MARGIN * linear.largest_eigenvalue([0.0, 1.0], &mut mode, N_FIRST);
    stir(&mut mode);
    // Safe: as if the stiffest mode were the most damped one as well.
    let mut dt = ((rate * rate + 4.0 * square).sqrt() - rate) / square;
    for _ in 0..N_APPROACHES {
        let weights = [dt * dt, 2.0 * dt];
        dt *= (4.0 / (MARGIN * linear.largest_eigenvalue(weights, &mut mode, N_NEXT))).sqrt();
    }
    dt
}

/// A start for power iteration that has a share of every mode: no symmetry of the mesh.
fn irregular(n: usize) -> Vec<Vec3> {
    let at = |v: usize| {
        let turn = (v as Real) * 0.618_033_988_749_895;
        Vec3::new(turn.fract() - 0.5, (1.7 * turn).fract() - 0.5, (2.3 * turn).fract() - 0.5)
    };
    (0..n).map(at).collect()
}

/// Gives a share of every mode along an axis along which none is left: the springs of a flat membrane leave
/// nothing of the modes that its hinges damp, and those nothing of the springs'.
fn stir(mode: &mut [Vec3]) {
    for axis in 0..3 {
        if mode.iter().all(|x| x[axis] == 0.0) {
            let start = irregular(mode.len());
            mode.iter_mut().zip(&start).for_each(|(x, start)| x[axis] = start[axis]);
        }
    }
}

/// The hinge of the `k`-th link; `None` on the boundary.
fn fold(model: &MembraneModel, positions: &[Vec3], k: usize) -> Option<Fold<Real>> {
    let link = &model.links[k];
    if !link.is_hinge() {
        return None;
    }
    let triangles = link.triangles.map(|t| &model.mesh.triangles[t as usize]);
    let [t1, t2] = triangles.map(|triangle| Facet::new(positions, triangle));
    let fold = link.fold(positions, [&t1, &t2]);
    let [_, _, r3, r4] = link.corners(positions);
    let first = model.first_areas.each_ref().map(|areas| areas.get(k).copied());
    Some(match first {
        [Some(one), Some(two)] => {
            fold.with_areas([one, two], [Side::from(&t1), Side::from(&t2)], (r4 - r3).norm())
        }
        _ => fold,
    })
}

impl Linear<'_> {
    /// Largest eigenvalue of M⁻¹(w₀ K + w₁ C) over the vertices that are not clamped; `mode` is
    /// where to start, and what was found.
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
                mode.copy_from_slice(&irregular(mode.len()));
                return 0.0;
            }
            eigenvalue = xkx / xmx;
            mode.iter_mut().for_each(|x| *x /= yy.sqrt());
        }
        eigenvalue
    }

    /// (w₀ K + w₁ C) x in the reference shape.
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
            let turn = fold.project(link.corners(x).map(|x| Vector::from(*x)));
            for (vertex, force) in at.into_iter().zip(fold.spread(hinge * turn)) {
                y[vertex] += Vec3::from(force);
            }
        }
        y
    }
}
