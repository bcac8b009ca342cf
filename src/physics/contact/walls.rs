//! Contacts between grains and walls.

use super::law::{self, Touch};
use crate::{
    base::{Vec3, parallel},
    physics::{
        Model,
        boundary::{body::BodyMotion, wall::WallModel},
        scratch::WallForce,
        state::{Grains, State},
    },
};

/// Forces of all walls on all grains; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    state: &State,
    springs: &mut [Vec3],
    wall_forces: &mut Vec<WallForce>,
) {
    let n_grains = state.grains.len();
    wall_forces.resize(springs.len(), WallForce::default());
    if n_grains == 0 {
        return;
    }
    let of_walls = wall_forces.chunks_mut(n_grains).zip(springs.chunks_mut(n_grains));
    for ((wall, motion), (forces, springs)) in model.walls.iter().zip(&state.walls).zip(of_walls) {
        let contact = Contact { wall, motion, dt: model.substep };
        parallel::for_each_of_two(forces, springs, |i, wall_force, spring| {
            *wall_force = contact.force(&state.grains, i, spring);
        });
    }
}

struct Contact<'a> {
    wall: &'a WallModel,
    motion: &'a BodyMotion,
    dt: f64,
}

impl Contact<'_> {
    #[inline(always)]
    fn force(&self, grains: &Grains, i: usize, spring: &mut Vec3) -> WallForce {
        let radius = grains.radii[i];
        let from_wall = grains.positions[i] - self.motion.pose.translation.vector;
        let nearest = self.wall.shape.distance(self.motion, &from_wall);
        let Some((distance, normal)) = nearest.filter(|(distance, _)| *distance < radius) else {
            *spring = Vec3::zeros();
            return WallForce::default();
        };
        let overlap = radius - distance;
        let arm = normal * -(radius - overlap / 2.0);
        let velocity = grains.velocities[i] + grains.spins[i].cross(&arm)
            - self.motion.twist.at(&(from_wall + arm));
        let touch = Touch { overlap, normal, velocity, radius, mass: grains.masses[i] };
        let force = law::force(&self.wall.law, &touch, self.dt, spring);
        WallForce {
            force: normal * force.normal + force.tangential,
            arm,
            overlap,
            normal: force.normal,
        }
    }
}
