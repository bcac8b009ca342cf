//! What all packings have in common: their grains, the drag that brings them to rest, and when they
//! are at rest.

use super::scene::{Grains, Scene};
use crate::{
    base::{
        Real,
        random::{Random, Stream},
    },
    physics::{
        System,
        contact::law::PairLaw,
        measure::{kinetic_energy, rest},
        packing::sphere_volume,
        state,
    },
};

/// Unbalanced force over mean contact force below which grains are at rest.
pub(super) const UNBALANCED_MAX: Real = 1e-3;
/// Kinetic over elastic energy below which they are.
pub(super) const KINETIC_MAX: Real = 1e-6;
/// Substeps between two looks at whether they are.
pub(super) const LOOK_EVERY: u64 = 50;
/// Substeps in a slice of work.
pub(super) const SLICE: u64 = 400;

/// Law between grains at this friction.
pub(super) fn grain_law(grains: &Grains, friction: Real) -> PairLaw {
    PairLaw::between(&grains.material, &grains.material, grains.surface(friction))
}

/// Final radii [m]: uniform between the limits, or all the mean.
pub(super) fn final_radii(scene: &Scene, count: usize, is_mono: bool) -> Vec<Real> {
    let grains = &scene.grains;
    let mut random = Random::new(scene.seed, Stream::Radius);
    let mut draw = || random.between(grains.radius_min, grains.radius_max);
    (0..count).map(|_| if is_mono { grains.radius_mean() } else { draw() }).collect()
}

/// Grains at rest at `positions`, `scale` times their final size, with their final masses.
pub(super) fn grains(
    scene: &Scene,
    positions: Vec<crate::base::Vec3>,
    final_radii: &[Real],
    scale: Real,
) -> state::Grains {
    let density = scene.grains.material.density;
    let radii = final_radii.iter().map(|r| scale * r).collect();
    let masses = final_radii.iter().map(|&r| density * sphere_volume(r)).collect();
    state::Grains::at_rest(positions, radii, masses)
}

/// Lets the velocities of the grains decay by one substep of `drag_time` [s].
pub(super) fn drag(system: &mut System, drag_time: Real) {
    let left = (-system.model.substep / drag_time).exp();
    let grains = &mut system.state.grains;
    grains.velocities.iter_mut().for_each(|it| *it *= left);
    grains.spins.iter_mut().for_each(|it| *it *= left);
}

/// How far from rest a system is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unrest {
    /// Mean unbalanced force over mean contact force.
    pub(super) unbalanced: Real,
    /// Kinetic over elastic energy.
    pub(super) kinetic: Real,
}

impl Unrest {
    /// Of the last substep.
    pub(super) fn of(system: &System) -> Self {
        let System { model, state, scratch, .. } = system;
        let elastic = rest::elastic_energy(model, state, scratch);
        let kinetic = kinetic_energy(model, state) / elastic.max(Real::MIN_POSITIVE);
        Self { unbalanced: rest::unbalanced_force(model, state, scratch), kinetic }
    }

    /// True if both are small enough.
    pub(super) fn is_rest(&self) -> bool {
        self.unbalanced < UNBALANCED_MAX && self.kinetic < KINETIC_MAX
    }
}
