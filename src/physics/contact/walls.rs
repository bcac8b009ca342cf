//! Contacts between grains and walls.

use super::law::{self, Touch};
use crate::{
    base::Vec3,
    physics::{
        Model,
        boundary::{body::BodyMotion, wall::WallModel},
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
    for &place in &lists.walls {
        let place = place as usize;
        let (w, i) = (place / n_grains, place % n_grains);
        let contact = Contact { wall: &model.walls[w], motion: &state.walls[w], dt: model.substep };
        wall_forces[place] = contact.force(&state.grains, i, &mut springs[place]);
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
        let touch = Touch {
            overlap,
            normal: normal.into(),
            velocity: velocity.into(),
            radius,
            mass: grains.masses[i],
        };
        let force = law::single(&self.wall.law, &touch, self.dt, spring);
        WallForce {
            force: normal * force.normal + force.tangential,
            arm,
            overlap,
            normal: force.normal,
        }
    }
}
