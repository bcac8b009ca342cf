//! What all packings have in common: their grains, the drag that brings them to rest, and when they
//! are at rest.

use serde::{Deserialize, Serialize};

use super::scene::{Grains, Scene};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::real,
    },
    measure::{kinetic_energy, rest},
    physics::{System, law::PairLaw, packing::sphere_volume, state},
};

/// Unbalanced force over mean contact force below which grains are at rest.
pub(super) const UNBALANCED_MAX: Real = 5e-4;
/// Kinetic over elastic energy below which they are.
pub(super) const KINETIC_MAX: Real = 1e-6;
/// Substeps between two looks at the kinetic energy.
const STOP_EVERY: u64 = 10;
/// Substeps between two looks at whether they are at rest.
const LOOK_EVERY: u64 = 50;
/// Substeps in a slice of work.
pub(super) const SLICE: u64 = 400;

/// Law between grains at this friction.
pub(super) fn grain_law(grains: &Grains, friction: Real) -> PairLaw {
    PairLaw::between(&grains.material, &grains.material, grains.surface(friction))
}

/// Final radii (m): uniform between the limits, or all the mean.
pub(super) fn final_radii(scene: &Scene, count: usize, is_mono: bool) -> Vec<Real> {
    let grains = &scene.grains;
    let mut random = Random::new(scene.seed, Stream::Radius);
    let mut draw = || random.between(grains.radius_min, grains.radius_max);
    (0..count).map(|_| if is_mono { grains.radius_mean() } else { draw() }).collect()
}

/// Grains at rest at `positions`, `scale` times their final size, with their final masses.
pub(super) fn grains(
    scene: &Scene,
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
/// passed a peak, and are then stopped. Slow modes get to rest several times sooner than under drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Settling {
    /// Substeps so far.
    pub(super) n_done: u64,
    /// Kinetic energy when it was last looked at (J).
    last: Real,
    /// Largest kinetic energy since rest was last looked for (J).
    highest: Real,
}

impl Settling {
    /// One substep; true when it is time to look for rest.
    pub(super) fn step(&mut self, system: &mut System) -> bool {
        system.step();
        self.n_done += 1;
        if !self.n_done.is_multiple_of(STOP_EVERY) {
            return false;
        }
        let now = kinetic_energy(&system.model, &system.state);
        self.highest = self.highest.max(now);
        self.last = if now < self.last { stop(system) } else { now };
        self.n_done.is_multiple_of(LOOK_EVERY)
    }

    /// How far from rest it has been since this was last asked.
    pub(super) fn unrest(&mut self, system: &System) -> Unrest {
        let System { model, state, scratch, .. } = system;
        let elastic = rest::elastic_energy(model, state, scratch);
        let kinetic = self.highest / elastic.max(Real::MIN_POSITIVE);
        self.highest = 0.0;
        Unrest { unbalanced: rest::unbalanced_force(model, state, scratch), kinetic }
    }
}

/// Stops all motion; the kinetic energy that is left is zero.
fn stop(system: &mut System) -> Real {
    let grains = &mut system.state.grains;
    grains.velocities.fill(Vec3::zeros());
    grains.angular_velocities.fill(Vec3::zeros());
    system.state.membrane.velocities.fill(Vec3::zeros());
    0.0
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
    /// True if both are small enough.
    pub(super) fn is_rest(&self) -> bool {
        self.unbalanced < UNBALANCED_MAX && self.kinetic < KINETIC_MAX
    }
}

/// True if `n` substeps are as many as `n_max`.
pub(super) fn is_over(n: u64, n_max: Real) -> bool {
    n_max <= real(usize::try_from(n).unwrap_or(usize::MAX))
}
