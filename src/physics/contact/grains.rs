//! Contacts between grains: the pair pass.

use super::law::{self, Touch};
use crate::{
    base::{Vec3, parallel},
    physics::{
        Model,
        scratch::{Neighbours, PairForce, PairSize},
        state::{Grains, State},
    },
};

/// Forces of all pairs; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    state: &State,
    springs: &mut [Vec3],
    lists: &Neighbours,
    pair_forces: &mut Vec<PairForce>,
) {
    pair_forces.resize(state.pair_ids.len(), PairForce::default());
    parallel::for_each_of_two(pair_forces, springs, |k, force, spring| {
        let pair = Pair { ids: state.pair_ids[k], size: lists.pair_sizes[k] };
        *force = of_pair(model, &state.grains, &pair, spring);
    });
}

struct Pair {
    ids: [u32; 2],
    size: PairSize,
}

#[inline(always)]
fn of_pair(model: &Model, grains: &Grains, pair: &Pair, spring: &mut Vec3) -> PairForce {
    let [i, j] = pair.ids.map(|id| id as usize);
    let apart = grains.positions[i] - grains.positions[j];
    let (radius_i, radius_j) = (grains.radii[i], grains.radii[j]);
    let reach = radius_i + radius_j;
    let distance_squared = apart.norm_squared();
    if distance_squared >= reach * reach {
        *spring = Vec3::zeros();
        return PairForce::default();
    }
    let distance = distance_squared.sqrt();
    let overlap = reach - distance;
    let normal = apart * distance.recip();
    // Levers from the centres to the contact point: −(R_i − ξ/2) n and +(R_j − ξ/2) n.
    let spin =
        grains.spins[i] * (radius_i - overlap / 2.0) + grains.spins[j] * (radius_j - overlap / 2.0);
    let velocity = grains.velocities[i] - grains.velocities[j] - spin.cross(&normal);
    let PairSize { radius, mass } = pair.size;
    let touch = Touch { overlap, normal, velocity, radius, mass };
    let force = law::force(&model.grain_law, &touch, model.substep, spring);
    PairForce {
        force: normal * force.normal + force.tangential,
        couple: normal.cross(&force.tangential),
        overlap,
        signed_normal: if force.slides { -force.normal } else { force.normal },
    }
}
