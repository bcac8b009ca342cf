//! Measurements of a state: energies, volumes, contacts, fields, structure. Nothing is changed.
//!
//! Fields, radial distribution functions and Voronoi cells take plain slices of positions and radii, so
//! they work for any system and any recording:
//!
//! ```
//! use jamgrip::{base::Vec3, measure::{fields::Overlaps, grid::Grid}};
//!
//! let (positions, radii) = ([Vec3::new(0.5, 0.5, 0.5)], [0.25]);
//! let grid = Grid::aligned(&Vec3::zeros(), &Vec3::repeat(1.0), [2, 1, 1])?;
//! let overlaps = Overlaps::new(&grid, &positions, &radii, None);
//! let velocity = overlaps.mean(&[Vec3::new(0.0, 0.0, 0.1)]);
//! assert_eq!(velocity[0], Some(Vec3::new(0.0, 0.0, 0.1)));
//! # Ok::<(), jamgrip::measure::grid::GridError>(())
//! ```

pub mod cell_stress; // stress in each cell of a grid
pub mod coordination; // contacts per grain, rattlers
pub mod fields; // density, velocity, displacement in each cell of a grid
pub mod grid; // the grid of cells
mod search; // neighbor search with periodic images
pub mod overlap; // exact overlap volume of sphere and box
pub mod rest; // unbalanced force, energies, inertial number
pub mod stress; // mean stress
pub mod structure; // solid fraction, radial distribution
pub mod voronoi; // Laguerre-Voronoi cells

use crate::{
    base::{Real, real::real},
    physics::{Model, Scratch, State, membrane::pressure},
};

/// Contact statistics of the packing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Packing {
    /// Number of contacts between grains.
    pub n_grain_contacts: usize,
    /// Number of contacts between grains and membrane; each vertex sphere counts.
    pub n_membrane_contacts: usize,
    /// Number of contacts between membrane and bodies.
    pub n_body_contacts: usize,
    /// Mean number of contacts per grain, with grains, membrane and walls.
    pub coordination_number: Real,
    /// Fraction of grains with at least four contacts, which can carry load.
    pub jammed_fraction: Real,
    /// Fraction of sliding contacts among contacts between grains.
    pub sliding_fraction: Real,
    /// Largest overlap between grains (m).
    pub overlap_max: Real,
    /// Largest overlap between grain and membrane (m).
    pub membrane_overlap_max: Real,
}

/// Contact statistics of the last substep.
pub fn packing(state: &State, scratch: &Scratch) -> Packing {
    let n_grains = state.grains.len();
    let mut packing = Packing::default();
    let mut touching = vec![0_usize; n_grains];
    for (pair, ids) in scratch.touching_pairs(state) {
        packing.n_grain_contacts += 1;
        packing.overlap_max = packing.overlap_max.max(pair.overlap);
        for id in ids {
            touching[*id as usize] += 1;
        }
    }
    for (i, patches) in scratch.patch_forces.iter().enumerate() {
        packing.n_membrane_contacts += patches.n;
        touching[i] += patches.n;
        for patch in &patches.contacts[..patches.n] {
            packing.membrane_overlap_max = packing.membrane_overlap_max.max(patch.overlap);
        }
    }
    for (sphere, ids) in scratch.sphere_forces.iter().zip(&state.springs.spheres.ids) {
        if sphere.flags.touches() {
            packing.n_membrane_contacts += 1;
            touching[ids[0] as usize] += 1;
            packing.membrane_overlap_max = packing.membrane_overlap_max.max(sphere.overlap);
        }
    }
    for (_, [_, i]) in scratch.touching_walls(state) {
        touching[i] += 1;
    }
    packing.n_body_contacts = scratch.sample_forces.iter().filter(|s| s.flags.touches()).count();
    let share = |n: usize, of: usize| if of == 0 { 0.0 } else { real(n) / real(of) };
    packing.coordination_number = share(touching.iter().sum(), n_grains);
    packing.jammed_fraction = share(touching.iter().filter(|&&n| n >= 4).count(), n_grains);
    packing.sliding_fraction = share(scratch.n_sliding_pairs(), packing.n_grain_contacts);
    packing
}

/// Sum of normal force magnitudes on each grain (N).
pub fn normal_forces(state: &State, scratch: &Scratch) -> Vec<Real> {
    let mut forces = vec![0.0; state.grains.len()];
    for (pair, ids) in scratch.pair_forces.iter().zip(&state.pair_ids) {
        for id in ids {
            forces[*id as usize] += pair.normal;
        }
    }
    for (i, patches) in scratch.patch_forces.iter().enumerate() {
        let of_patches: Real = patches.contacts[..patches.n].iter().map(|c| c.normal).sum();
        forces[i] += of_patches;
    }
    for (sphere, ids) in scratch.sphere_forces.iter().zip(&state.springs.spheres.ids) {
        forces[ids[0] as usize] += sphere.normal;
    }
    for (wall, [_, i]) in scratch.touching_walls(state) {
        forces[i] += wall.normal;
    }
    forces
}

/// Kinetic energy of grains and membrane (J).
pub fn kinetic_energy(model: &Model, state: &State) -> Real {
    let grains = &state.grains;
    let of_grains: Real = (0..grains.len())
        .map(|i| {
            let inertia = 0.4 * grains.masses[i] * grains.radii[i].powi(2);
            0.5 * grains.masses[i] * grains.velocities[i].norm_squared()
                + 0.5 * inertia * grains.angular_velocities[i].norm_squared()
        })
        .sum();
    let masses = &model.membrane.masses;
    let of_membrane: Real = (masses.iter().zip(&state.membrane.velocities))
        .map(|(mass, velocity)| 0.5 * mass * velocity.norm_squared())
        .sum();
    of_grains + of_membrane
}

/// Volume of all grains (m³).
pub fn grain_volume(state: &State) -> Real {
    state.grains.radii.iter().map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum()
}

/// Mass of grains and membrane (kg).
pub fn mass(model: &Model, state: &State) -> Real {
    state.grains.masses.iter().sum::<Real>() + model.membrane.mass()
}

/// Volume enclosed by membrane and flange (m³).
pub fn enclosed_volume(model: &Model, state: &State) -> Real {
    pressure::volume(&model.membrane.mesh, &state.membrane.positions)
}
