//! Mean stress of the grains from their contact forces.
//!
//! ```text
//! σ_ij = 1/V Σ_c f_i l_j       over all contacts of grains with grains, walls and membrane
//! p    = tr σ / 3
//!
//! f  force of the contact on one of its partners                          (N)
//! l  from the other partner's center to its own; from the contact point
//!    on wall or membrane to the center                                    (m)
//! V  volume that the grains take up between walls and membrane            (m³)
//! ```
//!
//! Pressure is positive. Source: Love (1927), Weber (1966); for grains at rest without body forces
//! the sum equals the mean of Cauchy's stress over V.

use crate::{
    base::{Mat3, Real, Vec3},
    physics::{Model, Scratch, State, contact::grains::closest_image},
};

/// A contact of a grain: its force and its branch vector. World frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Center of the grain that the force acts on (m).
    pub end: Vec3,
    /// From the center of the other grain, or from the contact point on wall or membrane, to `end` (m).
    pub branch: Vec3,
    /// Force on the grain (N).
    pub force: Vec3,
}

/// All contacts of grains in the last substep: with each other, with the membrane, with walls.
pub fn branches(model: &Model, state: &State, scratch: &Scratch) -> Vec<Branch> {
    let positions = &state.grains.positions;
    let mut branches = Vec::new();
    for (pair, [i, j]) in scratch.touching_pairs(state) {
        let end = positions[*i as usize];
        let separation = end - positions[*j as usize];
        let branch = model.period.map_or(separation, |period| closest_image(separation, &period));
        branches.push(Branch { end, branch, force: pair.force });
    }
    let mesh = &model.membrane.mesh;
    for (patches, &end) in scratch.patch_forces.iter().zip(positions) {
        for patch in &patches.contacts[..patches.n] {
            let mut branch = end;
            for (&v, &weight) in mesh.triangles[patch.triangle as usize].iter().zip(&patch.weights)
            {
                branch -= state.membrane.positions[v as usize] * weight;
            }
            branches.push(Branch { end, branch, force: patch.force });
        }
    }
    for (sphere, ids) in scratch.sphere_forces.iter().zip(&state.springs.spheres.ids) {
        if sphere.overlap > 0.0 {
            let end = positions[ids[0] as usize];
            let offset = end - state.membrane.positions[sphere.vertex as usize];
            let reach = state.grains.radii[ids[0] as usize] - sphere.overlap / 2.0;
            branches.push(Branch { end, branch: offset.normalize() * reach, force: sphere.force });
        }
    }
    for (wall, [_, i]) in scratch.touching_walls(state) {
        let end = positions[i];
        branches.push(Branch { end, branch: -wall.arm, force: wall.force });
    }
    branches
}

/// Mean stress (Pa) of all contact forces of the last substep in `volume` (m³).
pub fn contact_stress(model: &Model, state: &State, scratch: &Scratch, volume: Real) -> Mat3 {
    mean_stress(&branches(model, state, scratch), volume)
}

/// Mean stress (Pa) of contacts in `volume` (m³).
pub fn mean_stress(branches: &[Branch], volume: Real) -> Mat3 {
    let mut sum = Mat3::zeros();
    for Branch { branch, force, .. } in branches {
        sum += force * branch.transpose();
    }
    sum / volume
}
