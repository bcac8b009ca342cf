//! Contacts between grains and walls.
//!
//! ```text
//! ξ = R − d,   b = −(R − ξ/2) n,   v = ẋ + ω × b − v_wall,   R* = R,   m* = m
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | R, m, ẋ, ω | radius, mass, velocity and angular velocity of the grain | m, kg, m/s, rad/s |
//! | d, n | distance of the wall from the grain's center, unit normal toward the grain | m, – |
//! | ξ, b | overlap, vector from the center to the contact point | m |
//! | v, v_wall | relative velocity, velocity of the wall at the contact point | m/s |
//! | R*, m* | effective radius and mass for the contact law | m, kg |
//!
//! Valid while the wall is flat compared with the grain: its curvature does not change R*.

use crate::{
    base::{Real, Vec3, lanes::Vector},
    physics::{
        Model,
        boundary::{body::BodyMotion, wall::PlacedSurface},
        law::{ContactLaw, ContactState, History, Memory, ScalarForce, WithLaw},
        scratch::{ContactFlags, WallForce},
        state::{Grains, ListedSprings},
    },
};

/// Computes the forces of the walls at `motions` on the grains listed near them, and updates the history of these
/// contacts by one substep. They are few, so one thread computes them.
pub fn forces(
    model: &Model,
    motions: &[BodyMotion],
    grains: &Grains,
    listed: &mut ListedSprings,
    forces: &mut Vec<WallForce>,
) {
    forces.resize(listed.ids.len(), WallForce::default());
    let mut begin = 0;
    while let Some(&[w, _]) = listed.ids.get(begin) {
        let n = listed.ids[begin..].iter().take_while(|ids| ids[0] == w).count();
        let (wall, motion) = (&model.walls[w as usize], &motions[w as usize]);
        let contacts = WallPass {
            shape: &wall.shape.placed(motion),
            motion,
            grains,
            dt: model.substep,
            contacts: begin..begin + n,
            listed,
            forces,
        };
        wall.law.with(contacts);
        begin += n;
    }
}

/// The listed contacts of one wall.
struct WallPass<'a> {
    shape: &'a PlacedSurface,
    motion: &'a BodyMotion,
    grains: &'a Grains,
    dt: Real,
    /// Indices of the contacts in the lists.
    contacts: std::ops::Range<usize>,
    listed: &'a mut ListedSprings,
    forces: &'a mut [WallForce],
}

impl WithLaw for WallPass<'_> {
    type Output = ();

    fn run<C: ContactLaw>(self, law: &C) {
        let ListedSprings { ids, springs, memories } = self.listed;
        let memories = C::Memory::rows(memories, ids.len());
        let surface = RigidSurface { law, motion: self.motion, dt: self.dt };
        let wall = Wall { shape: self.shape, surface };
        for k in self.contacts {
            let mut history = History {
                spring: Vector::from(springs[k]),
                memory: C::Memory::load::<f64>(&memories[k..]),
            };
            let force = wall.force(self.grains, ids[k][1] as usize, &mut history);
            springs[k] = history.spring.into();
            C::Memory::store::<f64>(history.memory, true, &mut memories[k..]);
            self.forces[k] = force;
        }
    }
}

/// A wall and the law of its contacts with grains.
struct Wall<'a, C> {
    shape: &'a PlacedSurface,
    surface: RigidSurface<'a, C>,
}

impl<C: ContactLaw> Wall<'_, C> {
    /// Force on grain `i`. The history of a contact that has ended is reset.
    #[inline(always)]
    fn force(&self, grains: &Grains, i: usize, history: &mut History<f64, C::Memory>) -> WallForce {
        let reach = grains.radii[i] + self.surface.law.range();
        let nearest = self.shape.distance(&self.surface.arm(&grains.positions[i]));
        nearest
            .filter(|(distance, _)| *distance < reach)
            .and_then(|nearest| self.surface.force(grains, i, nearest, history))
            .unwrap_or_else(|| {
                *history = History { spring: Vector::zero(), memory: C::Memory::nothing() };
                WallForce::default()
            })
    }
}

/// A moving rigid surface, and the law of its contacts with grains.
pub(super) struct RigidSurface<'a, C> {
    pub(super) law: &'a C,
    pub(super) motion: &'a BodyMotion,
    pub(super) dt: Real,
}

impl<C: ContactLaw> RigidSurface<'_, C> {
    /// Vector from the origin of the surface to `point` (m).
    #[inline(always)]
    pub(super) fn arm(&self, point: &Vec3) -> Vec3 {
        point - self.motion.pose.translation.vector
    }

    /// Force on grain `i` from a point of the surface at this distance (m), with the unit normal from that point to
    /// the grain. `None` if the contact has ended.
    #[inline(always)]
    pub(super) fn force(
        &self,
        grains: &Grains,
        i: usize,
        (distance, normal): (Real, Vec3),
        history: &mut History<f64, C::Memory>,
    ) -> Option<WallForce> {
        let radius = grains.radii[i];
        let overlap = radius - distance;
        let arm = normal * -(radius - overlap / 2.0);
        let velocity = grains.velocities[i] + grains.angular_velocities[i].cross(&arm)
            - self.motion.twist.at(&(self.arm(&grains.positions[i]) + arm));
        let contact = ContactState {
            touches: distance < radius,
            overlap,
            normal: normal.into(),
            velocity: velocity.into(),
            radius,
            mass: grains.masses[i],
        };
        let force = ScalarForce::of(&self.law.force(&contact, self.dt, history));
        if !force.acts {
            return None;
        }
        let is_loaded = force.normal != 0.0;
        Some(WallForce {
            force: normal * force.normal + force.tangential,
            arm,
            overlap,
            normal: force.normal,
            flags: if is_loaded { ContactFlags::contact(force.slides) } else { ContactFlags::NONE },
        })
    }
}
