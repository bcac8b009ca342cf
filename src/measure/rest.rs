//! Criteria for rest: unbalanced force, energies, and the inertial number of a slow deformation.
//!
//! ```text
//! u   = mean |force on a grain| / mean |force in a contact|        at rest below 1e-3
//! U   = Σ 8/15 E* √R* ξ^(5/2) + ½ k |ξ_t|²                         Hertz, and the friction springs
//! I   = ε̇ d √(ρ/p)                                                quasi-static below 1e-3
//! ```
//!
//! Source of u and I: da Cruz et al. (2005). At rest, E_kin/U must also be below 1e-6, since a grain in
//! free flight has no unbalanced force.

use crate::{
    base::{Real, real::real},
    physics::{Model, Scratch, State, contact::sums, law::PairLaw, state::ListedSprings},
};

/// Mean force on a grain divided by the mean force in its contacts; 0 without contacts.
pub fn unbalanced_force(model: &Model, state: &State, scratch: &Scratch) -> Real {
    let grains = &state.grains;
    let net: Real = (0..grains.len())
        .map(|i| (sums::on_grain(grains, scratch, i).0 + model.gravity * grains.masses[i]).norm())
        .sum();
    let touching = scratch.touching_pairs(state);
    let of_pairs = touching.map(|(pair, _)| pair.force.norm());
    let of_patches = (scratch.patch_forces.iter())
        .flat_map(|patches| patches.contacts[..patches.n].iter().map(|it| it.force.norm()));
    let of_walls = scratch.touching_walls(state).map(|(wall, _)| wall.force.norm());
    let mut n_contacts = 0;
    let mut sum = 0.0;
    for force in of_pairs.chain(of_patches).chain(of_walls) {
        n_contacts += 1;
        sum += force;
    }
    if sum == 0.0 {
        return 0.0;
    }
    (net / real(grains.len())) / (sum / real(n_contacts))
}

/// Energy stored in the contacts of grains with each other, with walls and with the membrane (J).
/// Friction springs of the membrane are not included.
pub fn elastic_energy(model: &Model, state: &State, scratch: &Scratch) -> Real {
    let radii = &state.grains.radii;
    let mut energy = 0.0;
    let springs = &state.springs.pairs;
    for ((pair, ids), spring) in scratch.pair_forces.iter().zip(&state.pair_ids).zip(springs) {
        if pair.overlap > 0.0 {
            let [a, b] = ids.map(|id| radii[id as usize]);
            let stretch = spring.norm_squared();
            energy += stored(&model.grain_law, a * b / (a + b), pair.overlap, stretch);
        }
    }
    for (patches, &radius) in scratch.patch_forces.iter().zip(radii) {
        for patch in &patches.contacts[..patches.n] {
            energy += stored(&model.membrane_law, radius, patch.overlap, 0.0);
        }
    }
    let ListedSprings { ids, springs, .. } = &state.springs.walls;
    for ((contact, ids), spring) in scratch.wall_forces.iter().zip(ids).zip(springs) {
        if contact.overlap > 0.0 {
            let [w, i] = ids.map(|id| id as usize);
            let law = &model.walls[w].law;
            energy += stored(law, radii[i], contact.overlap, spring.norm_squared());
        }
    }
    for (contact, ids) in scratch.surface_contacts_with_ids() {
        let [s, i] = ids.map(|id| id as usize);
        let law = model.surface(s).map(|(_, law)| law);
        if let Some(law) = law.filter(|_| contact.force.overlap > 0.0) {
            let stretch = contact.history.spring.norm_squared();
            energy += contact.share * stored(law, radii[i], contact.force.overlap, stretch);
        }
    }
    energy
}

/// Energy of one contact (J).
fn stored(law: &PairLaw, radius: Real, overlap: Real, stretch_squared: Real) -> Real {
    let contact_radius = (radius * overlap).sqrt();
    let normal = 8.0 / 15.0 * law.modulus * contact_radius * overlap * overlap;
    normal + 0.5 * (16.0 / 3.0 * law.shear_modulus * contact_radius) * stretch_squared
}

/// Inertial number at the strain rate (1/s) of grains with `diameter` (m) and `density` (kg/m³)
/// under `pressure` (Pa).
pub fn inertial_number(strain_rate: Real, diameter: Real, density: Real, pressure: Real) -> Real {
    strain_rate.abs() * diameter * (density / pressure).sqrt()
}
