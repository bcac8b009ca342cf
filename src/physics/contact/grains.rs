//! Contacts between grains: the pair pass.
//!
//! In a periodic box a pair meets by its closest image. Whether there is a box is decided once for all
//! pairs, so that open systems do not pay for it.

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
    match &model.period {
        None => of_pairs(model, state, springs, lists, pair_forces, |apart| apart),
        Some(period) => of_pairs(model, state, springs, lists, pair_forces, |apart| {
            closest_image(apart, period)
        }),
    }
}

/// The shortest of the vectors `apart` [m] between the images of two points.
#[inline(always)]
pub fn closest_image(apart: Vec3, period: &Vec3) -> Vec3 {
    apart - apart.component_div(period).map(f64::round).component_mul(period)
}

#[inline(always)]
fn of_pairs(
    model: &Model,
    state: &State,
    springs: &mut [Vec3],
    lists: &Neighbours,
    pair_forces: &mut [PairForce],
    image: impl Fn(Vec3) -> Vec3 + Sync,
) {
    parallel::for_each_of_two(pair_forces, springs, |k, force, spring| {
        let pair = Pair { ids: state.pair_ids[k], size: lists.pair_sizes[k] };
        *force = of_pair(model, &state.grains, &pair, &image, spring);
    });
}

struct Pair {
    ids: [u32; 2],
    size: PairSize,
}

#[inline(always)]
fn of_pair(
    model: &Model,
    grains: &Grains,
    pair: &Pair,
    image: &impl Fn(Vec3) -> Vec3,
    spring: &mut Vec3,
) -> PairForce {
    let [i, j] = pair.ids.map(|id| id as usize);
    let apart = image(grains.positions[i] - grains.positions[j]);
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
