//! Contacts between grains and walls.

use crate::{
    base::{Real, lanes::Vector},
    physics::{
        Model,
        boundary::{body::BodyMotion, wall::Placed},
        law::{ContactLaw, ContactState, History, Memory, ScalarForce, UnderLaw},
        scratch::{ContactFlags, WallForce},
        state::{Grains, ListedSprings},
    },
};

/// Forces of the walls at `motions` on the grains listed near them; carries what these contacts remember on
/// by one substep. They are few, so one thread does it.
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
        let contacts = OfWall {
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
struct OfWall<'a> {
    shape: &'a Placed,
    motion: &'a BodyMotion,
    grains: &'a Grains,
    dt: Real,
    /// Their indices in the lists.
    contacts: std::ops::Range<usize>,
    listed: &'a mut ListedSprings,
    forces: &'a mut [WallForce],
}

impl UnderLaw for OfWall<'_> {
    type Output = ();

    fn run<C: ContactLaw>(self, law: &C) {
        let ListedSprings { ids, springs, memories } = self.listed;
        let memories = C::Memory::rows(memories, ids.len());
        let wall = Wall { law, shape: self.shape, motion: self.motion, dt: self.dt };
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

/// A wall and the law of its contacts.
struct Wall<'a, C> {
    law: &'a C,
    shape: &'a Placed,
    motion: &'a BodyMotion,
    dt: Real,
}

impl<C: ContactLaw> Wall<'_, C> {
    /// Force on grain `i`. Nothing is remembered of a contact that has ended.
    #[inline(always)]
    fn force(&self, grains: &Grains, i: usize, history: &mut History<f64, C::Memory>) -> WallForce {
        let radius = grains.radii[i];
        let from_wall = grains.positions[i] - self.motion.pose.translation.vector;
        let nearest = self.shape.distance(&from_wall);
        let reach = radius + self.law.range();
        let Some((distance, normal)) = nearest.filter(|(distance, _)| *distance < reach) else {
            return Self::none(history);
        };
        let overlap = radius - distance;
        let arm = normal * -(radius - overlap / 2.0);
        let velocity = grains.velocities[i] + grains.angular_velocities[i].cross(&arm)
            - self.motion.twist.at(&(from_wall + arm));
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
            return Self::none(history);
        }
        let is_loaded = force.normal != 0.0;
        WallForce {
            force: normal * force.normal + force.tangential,
            arm,
            overlap,
            normal: force.normal,
            flags: if is_loaded { ContactFlags::contact(force.slides) } else { ContactFlags::NONE },
        }
    }

    /// No contact, and nothing that it remembers.
    #[inline(always)]
    fn none(history: &mut History<f64, C::Memory>) -> WallForce {
        *history = History { spring: Vector::zero(), memory: C::Memory::nothing() };
        WallForce::default()
    }
}
