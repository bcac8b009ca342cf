//! Who touches, and how hard: one pass writes the force of every possible contact, then whoever
//! is touched sums its own contacts in a fixed order. No atomics, so the bits do not depend on
//! the number of threads.

pub mod bodies;
mod candidates; // where a grain is closest to the sheet
pub mod grains;
pub mod law;
pub mod membrane;
mod sharing; // one force among several places
pub mod spheres;
pub mod walls;
pub mod sums;

use law::PairLaw;

use super::membrane::{MembraneContact, MembraneModel};
use crate::base::Real;

/// Normal stiffness dF/dξ [N/m] of a Hertz contact that carries `force` [N]; `radius` [m] is R*.
pub fn stiffness(law: &PairLaw, radius: Real, force: Real) -> Real {
    let overlap = (0.75 * force / (law.modulus * radius.sqrt())).powf(2.0 / 3.0);
    2.0 * law.modulus * (radius * overlap).sqrt()
}

/// Stiffness [N/m] that grains of `grain_radius` [m] add to a vertex when `pressure` [Pa] lays the
/// sheet on them: what a stable substep must reckon with.
pub fn stiffness_at_vertex(
    membrane: &MembraneModel,
    law: &PairLaw,
    grain_radius: Real,
    pressure: Real,
) -> Real {
    match membrane.contact {
        // One contact carries the pressure on the grain's square of sheet.
        MembraneContact::Triangles => {
            stiffness(law, grain_radius, pressure * 4.0 * grain_radius.powi(2))
        }
        // Two grains at one sphere, each with the pressure on the vertex's own share of the sheet.
        MembraneContact::Spheres { radius } => {
            let area = membrane.mesh.vertex_areas().into_iter().fold(0.0, Real::max);
            let shared = grain_radius * radius / (grain_radius + radius);
            2.0 * stiffness(law, shared, pressure * area)
        }
    }
}
