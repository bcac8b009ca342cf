//! Mean stress of the grains: what their contacts carry.
//!
//! ```text
//! σ_ij = 1/V Σ_c f_i l_j       over all contacts of grains with grains, walls and membrane
//! p    = tr σ / 3
//!
//! f  force of the contact on one of its partners                          [N]
//! l  from the other partner's centre to its own; from the contact point
//!    on wall or membrane to the centre                                    [m]
//! V  volume that the grains take up between walls and membrane            [m³]
//! ```
//!
//! Pressure is positive. Source: Love (1927), Weber (1966); for grains at rest without body forces
//! the sum equals the mean of Cauchy's stress over V.

use crate::{
    base::{Mat3, Real},
    physics::{Model, Scratch, State, contact::grains::closest_image},
};

/// Mean stress [Pa] of all contact forces of the last substep in `volume` [m³].
pub fn contact_stress(model: &Model, state: &State, scratch: &Scratch, volume: Real) -> Mat3 {
    let positions = &state.grains.positions;
    let mut sum = Mat3::zeros();
    for (pair, [i, j]) in scratch.touching_pairs(state) {
        let separation = positions[*i as usize] - positions[*j as usize];
        let branch = model.period.map_or(separation, |period| closest_image(separation, &period));
        sum += pair.force * branch.transpose();
    }
    let mesh = &model.membrane.mesh;
    for (patches, position) in scratch.patch_forces.iter().zip(positions) {
        for patch in &patches.contacts[..patches.n] {
            let mut branch = *position;
            for (&v, &weight) in mesh.triangles[patch.triangle as usize].iter().zip(&patch.weights)
            {
                branch -= state.membrane.positions[v as usize] * weight;
            }
            sum += patch.force * branch.transpose();
        }
    }
    for (wall, _) in scratch.touching_walls(state) {
        sum -= wall.force * wall.arm.transpose();
    }
    sum / volume
}

/// Mean pressure [Pa] of the normal forces of the last substep in `volume` [m³].
pub fn normal_pressure(state: &State, scratch: &Scratch, volume: Real) -> Real {
    let radii = &state.grains.radii;
    let mut sum = 0.0;
    for (pair, [i, j]) in scratch.touching_pairs(state) {
        let branch = radii[*i as usize] + radii[*j as usize] - pair.overlap;
        sum += pair.normal * branch;
    }
    for (patches, radius) in scratch.patch_forces.iter().zip(radii) {
        for patch in &patches.contacts[..patches.n] {
            sum += patch.normal * (radius - patch.overlap);
        }
    }
    for (wall, [_, i]) in scratch.touching_walls(state) {
        sum += wall.normal * (radii[i] - wall.overlap / 2.0);
    }
    sum / (3.0 * volume)
}
