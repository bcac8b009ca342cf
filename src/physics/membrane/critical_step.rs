//! The longest substep that does not blow up.
//!
//! ```text
//! semi-implicit Euler:  v' = v − dt M⁻¹(K x + C v),  x' = x + dt v'
//! stable while  dt² K + 2 dt C < 4 M,  which holds for
//!
//!     dt < ( −c + √(c² + 4 κ) ) / κ  =  2/ω (√(1 + ζ²) − ζ),   κ = ω²,  c = 2 ζ ω
//!
//! κ   largest eigenvalue of M⁻¹K      [1/s²]
//! c   largest eigenvalue of M⁻¹C      [1/s]
//! ```
//!
//! The first line has its first unstable mode at the factor −1 per step: x' = −x makes the matrix
//! dt² K + 2 dt C − 4 M singular. Taking κ and c from possibly different modes errs on the safe side.
//! K and C are those of springs and hinges in the reference shape; contacts add their stiffness to
//! every vertex. On a regular lattice κ = 6 k/m without hinges. A strain ε of the sheet changes κ
//! by a share of about ε, which is what a safety factor on the step is for.
//!
//! The eigenvalues come from power iteration. Bounds from rows or elements of the matrix
//! (9 k/m and 12 k/m on the lattice) were rejected: they cost 20–40 % of the speed of a run.

use super::bridson_2003::Fold;
use super::{Facet, Link, MembraneModel};
use crate::base::{Real, Vec3};

/// Enough for the largest eigenvalue to about a percent, whatever its neighbours.
const N_ITERATIONS: usize = 200;

/// What power iteration may still have missed: it approaches from below.
const MARGIN: Real = 1.02;

/// The two halves of a linear force law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Stiffness,
    Damping,
}

/// The longest stable substep [s] of a sheet whose vertices meet contacts of `contact_stiffness`
/// [N/m] (0 for none).
pub fn critical_step(model: &MembraneModel, contact_stiffness: Real) -> Real {
    let free = |v: &usize| !model.is_clamped[*v];
    let masses = (0..model.masses.len()).filter(free).map(|v| model.masses[v]);
    let lightest = masses.fold(Real::INFINITY, Real::min);
    let kappa = MARGIN * largest_eigenvalue(model, Part::Stiffness) + contact_stiffness / lightest;
    let c = MARGIN * largest_eigenvalue(model, Part::Damping);
    ((c * c + 4.0 * kappa).sqrt() - c) / kappa
}

/// Largest eigenvalue of M⁻¹K [1/s²] or M⁻¹C [1/s] over the vertices that are not clamped.
fn largest_eigenvalue(model: &MembraneModel, part: Part) -> Real {
    let n = model.mesh.n_vertices();
    let folds: Vec<_> = model.links.iter().map(|link| fold(model, link)).collect();
    // Any start with a share of the stiffest mode will do; this one has no symmetry of the mesh.
    let mut x: Vec<Vec3> = (0..n)
        .map(|v| {
            let turn = (v as Real) * 0.618_033_988_749_895;
            Vec3::new(turn.fract() - 0.5, (1.7 * turn).fract() - 0.5, (2.3 * turn).fract() - 0.5)
        })
        .collect();
    let mut eigenvalue = 0.0;
    for _ in 0..N_ITERATIONS {
        let mut y = apply(model, part, &folds, &x);
        let (mut xkx, mut xmx, mut yy) = (0.0, 0.0, 0.0);
        for v in 0..n {
            if model.is_clamped[v] {
                (x[v], y[v]) = (Vec3::zeros(), Vec3::zeros());
            }
            xkx += x[v].dot(&y[v]);
            xmx += model.masses[v] * x[v].norm_squared();
            y[v] /= model.masses[v];
            yy += y[v].norm_squared();
        }
        if yy == 0.0 {
            return 0.0;
        }
        eigenvalue = xkx / xmx;
        let scale = 1.0 / yy.sqrt();
        x = y.iter().map(|y| y * scale).collect();
    }
    eigenvalue
}

/// The hinge of `link` in the reference shape; `None` on the boundary.
fn fold(model: &MembraneModel, link: &Link) -> Option<Fold> {
    let mesh = &model.mesh;
    let [t1, t2] = link.triangles.map(|t| Facet::new(&mesh.positions, &mesh.triangles[t as usize]));
    link.is_hinge().then(|| link.fold(&mesh.positions, [&t1, &t2]))
}

/// K x or C x in the reference shape.
fn apply(model: &MembraneModel, part: Part, folds: &[Option<Fold>], x: &[Vec3]) -> Vec<Vec3> {
    let mut y = vec![Vec3::zeros(); x.len()];
    for (link, fold) in model.links.iter().zip(folds) {
        let at = link.vertices.map(|v| v as usize);
        let [_, _, r3, r4] = link.corners(&model.mesh.positions);
        let edge = r4 - r3;
        let length = edge.norm();
        let along = edge / length;
        let strength = match part {
            Part::Stiffness => link.spring.stiffness,
            Part::Damping => link.spring.damping,
        };
        let pull = along * (strength * along.dot(&(x[at[3]] - x[at[2]])));
        y[at[2]] -= pull;
        y[at[3]] += pull;
        let Some(fold) = fold else { continue };
        let strength = match part {
            // d(sin θ/2)/dθ = cos(θ/2)/2.
            Part::Stiffness => {
                let half_cosine = (1.0 - fold.half_sine * fold.half_sine).max(0.0).sqrt();
                0.5 * half_cosine * model.sheet.bending_stiffness * fold.slenderness
            }
            Part::Damping => model.sheet.bending_damping * length,
        };
        let turn = fold.project(link.corners(x));
        for (vertex, force) in at.into_iter().zip(fold.spread(strength * turn)) {
            y[vertex] += force;
        }
    }
    y
}
