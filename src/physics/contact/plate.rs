//! Contacts between grains and the flange's plate, which closes the bag from above.

use super::law::{self, Touch};
use crate::{
    base::{Vec3, parallel},
    physics::{Model, scratch::PlateForce, state::State},
};

/// Forces of the plate on all grains; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    state: &State,
    springs: &mut [Vec3],
    plate_forces: &mut Vec<PlateForce>,
) {
    plate_forces.resize(springs.len(), PlateForce::default());
    parallel::for_each_of_two(plate_forces, springs, |i, plate_force, spring| {
        *plate_force = force(model, state, i, spring);
    });
}

#[inline(always)]
fn force(model: &Model, state: &State, i: usize, spring: &mut Vec3) -> PlateForce {
    let State { grains, flange, flange_twist, .. } = state;
    let down = -(flange.rotation * Vec3::z());
    let from_flange = grains.positions[i] - flange.translation.vector;
    let overlap = grains.radii[i] - down.dot(&from_flange);
    if overlap <= 0.0 {
        *spring = Vec3::zeros();
        return PlateForce::default();
    }
    let arm = down * -(grains.radii[i] - overlap / 2.0);
    let velocity =
        grains.velocities[i] + grains.spins[i].cross(&arm) - flange_twist.at(&(from_flange + arm));
    let touch =
        Touch { overlap, normal: down, velocity, radius: grains.radii[i], mass: grains.masses[i] };
    let force = law::force(&model.plate_law, &touch, model.substep, spring);
    PlateForce { force: down * force.normal + force.tangential, arm, normal: force.normal }
}
