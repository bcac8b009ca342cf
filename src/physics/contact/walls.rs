//! Contacts between grains and walls.

use super::law::{self, PairLaw, Touch};
use crate::{
    base::{Real, Vec3},
    physics::{
        Model,
        boundary::{body::BodyMotion, wall::Placed},
        scratch::{Neighbours, WallForce},
        state::{Grains, State},
    },
};

/// Forces of all walls on the grains near them; carries their springs on by one substep. They are few,
/// so one thread does it.
pub fn forces(
    model: &Model,
    state: &State,
    springs: &mut [Vec3],
    lists: &Neighbours,
    wall_forces: &mut Vec<WallForce>,
) {
    wall_forces.resize(springs.len(), WallForce::default());
    let n_grains = state.grains.len();
    let placed: Vec<Placed> =
        model.walls.iter().zip(&state.walls).map(|(it, motion)| it.shape.placed(motion)).collect();
    for &[w, i] in &lists.walls {
        let (w, i) = (w as usize, i as usize);
        let wall = Contact { law: &model.walls[w].law, shape: &placed[w], motion: &state.walls[w] };
        let place = w * n_grains + i;
        wall_forces[place] = wall.force(&state.grains, i, model.substep, &mut springs[place]);
    }
}

struct Contact<'a> {
    law: &'a PairLaw,
    shape: &'a Placed,
    motion: &'a BodyMotion,
}

impl Contact<'_> {
    #[inline(always)]
    fn force(&self, grains: &Grains, i: usize, dt: Real, spring: &mut Vec3) -> WallForce {
        let radius = grains.radii[i];
        let from_wall = grains.positions[i] - self.motion.pose.translation.vector;
        let nearest = self.shape.distance(&from_wall);
        let Some((distance, normal)) = nearest.filter(|(distance, _)| *distance < radius) else {
            *spring = Vec3::zeros();
            return WallForce::default();
        };
        let overlap = radius - distance;
        let arm = normal * -(radius - overlap / 2.0);
        let velocity = grains.velocities[i] + grains.spins[i].cross(&arm)
            - self.motion.twist.at(&(from_wall + arm));
        let touch = Touch {
            overlap,
            normal: normal.into(),
            velocity: velocity.into(),
            radius,
            mass: grains.masses[i],
        };
        let force = law::single(self.law, &touch, dt, spring);
        WallForce {
            force: normal * force.normal + force.tangential,
            arm,
            overlap,
            normal: force.normal,
        }
    }
}
