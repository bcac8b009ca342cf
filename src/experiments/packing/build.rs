//! Common parts of all packings: their grains, the drag, kinetic damping and the criterion of rest.

use serde::{Deserialize, Serialize};

use super::scene::{Grains, PackingScene};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::real,
    },
    measure::{kinetic_energy, rest},
    physics::{System, law::PairLaw, packing::sphere_volume, state},
};

/// Largest unbalanced force over mean contact force of grains at rest.
pub(super) const UNBALANCED_MAX: Real = 5e-4;
/// Largest kinetic over elastic energy of grains at rest.
pub(super) const KINETIC_MAX: Real = 1e-6;
/// Substeps between two measurements of the kinetic energy.
const STOP_EVERY: u64 = 10;
/// Substeps between two checks of rest.
const CHECK_EVERY: u64 = 50;
/// Substeps of a slice.
pub(super) const SLICE: u64 = 400;

/// Contact law between grains with this friction.
pub(super) fn grain_law(grains: &Grains, friction: Real) -> PairLaw {
    PairLaw::between(&grains.material, &grains.material, grains.surface(friction))
}

/// Final radii (m): uniform between the limits, or all the mean.
pub(super) fn final_radii(scene: &PackingScene, count: usize, is_mono: bool) -> Vec<Real> {
    let grains = &scene.grains;
    let mut random = Random::new(scene.seed, Stream::Radius);
    let mut draw = || random.between(grains.radius_min, grains.radius_max);
    (0..count).map(|_| if is_mono { grains.radius_mean() } else { draw() }).collect()
}

/// Grains at rest at `positions`, `scale` times their final size, with their final masses.
pub(super) fn grains(
    scene: &PackingScene,
    positions: Vec<Vec3>,
    final_radii: &[Real],
    scale: Real,
) -> state::Grains {
    let density = scene.grains.material.density;
    let radii = final_radii.iter().map(|r| scale * r).collect();
    let masses = final_radii.iter().map(|&r| density * sphere_volume(r)).collect();
    state::Grains::at_rest(positions, radii, masses)
}

/// Lets the velocities of the grains decay by one substep of `drag_time` (s).
pub(super) fn drag(system: &mut System, drag_time: Real) {
    let left = (-system.model.substep / drag_time).exp();
    let grains = &mut system.state.grains;
    grains.velocities.iter_mut().for_each(|it| *it *= left);
    grains.angular_velocities.iter_mut().for_each(|it| *it *= left);
}

/// Kinetic damping (Cundall 1976): grains and membrane move freely until their kinetic energy has
/// passed a peak, and are then stopped. Slow modes come to rest several times faster than with
/// drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Settling {
    /// Number of substeps so far.
    pub(super) n_done: u64,
    /// Kinetic energy at its last measurement (J).
    last: Real,
    /// Largest kinetic energy since the last check of rest (J).
    highest: Real,
}

impl Settling {
    /// One substep; returns true when rest should be checked.
    pub(super) fn step(&mut self, system: &mut System) -> bool {
        system.step();
        self.n_done += 1;
        if !self.n_done.is_multiple_of(STOP_EVERY) {
            return false;
        }
        let now = kinetic_energy(&system.model, &system.state);
        self.highest = self.highest.max(now);
        self.last = if now < self.last { stop(system) } else { now };
        self.n_done.is_multiple_of(CHECK_EVERY)
    }

    /// Residuals since the last call.
    pub(super) fn residuals(&mut self, system: &System) -> Residuals {
        let System { model, state, scratch, .. } = system;
        let elastic = rest::elastic_energy(model, state, scratch);
        let kinetic = self.highest / elastic.max(Real::MIN_POSITIVE);
        self.highest = 0.0;
        Residuals { unbalanced: rest::unbalanced_force(model, state, scratch), kinetic }
    }
}

/// Stops all motion; returns the remaining kinetic energy, zero.
fn stop(system: &mut System) -> Real {
    let grains = &mut system.state.grains;
    grains.velocities.fill(Vec3::zeros());
    grains.angular_velocities.fill(Vec3::zeros());
    system.state.membrane.velocities.fill(Vec3::zeros());
    0.0
}

/// Unbalanced forces and motion that remain in a system.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residuals {
    /// Mean unbalanced force over mean contact force.
    pub(super) unbalanced: Real,
    /// Kinetic over elastic energy.
    pub(super) kinetic: Real,
}

impl Residuals {
    /// True if the system is at rest.
    pub(super) fn is_rest(&self) -> bool {
        self.unbalanced < UNBALANCED_MAX && self.kinetic < KINETIC_MAX
    }
}

/// True if `n` has reached `n_max`.
pub(super) fn is_over(n: u64, n_max: Real) -> bool {
    n_max <= real(usize::try_from(n).unwrap_or(usize::MAX))
}
