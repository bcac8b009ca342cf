//! Contacts of grains with walls of triangles and with rigid bodies.
//!
//! A grain may have several contacts with a wall of triangles, which `boundary::touching` finds. Each contact
//! has its own friction spring. A contact has no permanent id, because it moves from triangle to triangle while the
//! grain slides or rolls. The normal identifies it: a contact inherits the spring of the former contact with the
//! most similar normal, and each spring is inherited only once.
//!
//! Bodies are handled like walls that something else moves. Polyhedra are treated as triangles, so a grain in a
//! corner touches two faces; all other shapes have one contact, from their signed distance. The reaction is added
//! to the wrench of the wall or the body. The effective mass is that of the grain, as for walls: the mass of a
//! body is assumed to be much larger.
//!
//! Planes, tubes, bowls and balls belong to `contact::walls`: a grain has at most one contact with each, so their
//! springs can be listed by wall and grain.
//!
//! The state contains only existing contacts, so it does not depend on the lists. The formulas are those of
//! `contact::walls`.

use super::{bodies::signed_distance, walls::RigidSurface};
use crate::{
    base::{Real, Vec3, lanes::Vector, parallel},
    physics::{
        Controls, Model, Scratch, State,
        boundary::body::BodyMotion,
        law::{ContactLaw, History, Memory, WithLaw},
        model::TouchedSurface,
        scratch::{SurfaceContact, SurfaceLists},
        state::{Grains, SurfaceHistories, SurfaceHistory},
    },
};

/// A contact inherits a spring if the cosine of the angle between the normals is larger than this (45°).
const SAME_HISTORY: Real = 0.7;

/// Computes the forces of the surfaces on the grains listed near them, and updates the history of these contacts by
/// one substep.
pub fn forces(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    let lists = &scratch.neighbors.surfaces;
    let contacts = &mut scratch.surface_contacts;
    contacts.resize_with(lists.ids.len(), Vec::new);
    if lists.ids.is_empty() && state.springs.surfaces.ids.is_empty() {
        return;
    }
    let mut begin = 0;
    while let Some(&[s, _]) = lists.ids.get(begin) {
        let n = lists.ids[begin..].iter().take_while(|ids| ids[0] == s).count();
        if let Some((surface, law)) = model.surface(s as usize) {
            law.with(SurfacePass {
                surface,
                motion: motion(model, controls, state, s as usize),
                grains: &state.grains,
                before: &state.springs.surfaces,
                dt: model.substep,
                lists,
                begin,
                contacts: &mut contacts[begin..begin + n],
            });
        }
        begin += n;
    }
    let SurfaceHistories { ids, histories } = &mut state.springs.surfaces;
    ids.clear();
    histories.clear();
    for (contact, of) in scratch.surface_contacts_with_ids() {
        ids.push(*of);
        histories.push(contact.history.clone());
    }
}

/// Adds the reactions of these contacts to the wrenches on walls and bodies.
pub fn react(model: &Model, controls: &Controls, state: &State, scratch: &mut Scratch) {
    let Scratch { neighbors, surface_contacts, wall_wrenches, body_wrenches, .. } = scratch;
    for (contacts, ids) in surface_contacts.iter().zip(&neighbors.surfaces.ids) {
        let [s, i] = ids.map(|id| id as usize);
        let origin = motion(model, controls, state, s).pose.translation.vector;
        let wrench = match wall_wrenches.get_mut(s) {
            Some(of_wall) => of_wall,
            None => &mut body_wrenches[s - model.walls.len()],
        };
        for contact in contacts.iter().filter(|it| it.force.flags.touches()) {
            let arm = state.grains.positions[i] + contact.force.arm - origin;
            wrench.force -= contact.force.force;
            wrench.torque -= arm.cross(&contact.force.force);
        }
    }
}

/// Motion of a surface, with its index as in `Model::surface`.
pub(in crate::physics) fn motion<'a>(
    model: &Model,
    controls: &'a Controls,
    state: &'a State,
    surface: usize,
) -> &'a BodyMotion {
    match state.walls.get(surface) {
        Some(of_wall) => of_wall,
        None => &controls.bodies[surface - model.walls.len()],
    }
}

/// The listed grains of one surface.
struct SurfacePass<'a> {
    surface: TouchedSurface<'a>,
    motion: &'a BodyMotion,
    grains: &'a Grains,
    /// Histories after the last substep.
    before: &'a SurfaceHistories,
    dt: Real,
    lists: &'a SurfaceLists,
    /// Index of the first of these grains in the lists.
    begin: usize,
    /// Output: the contacts of each grain.
    contacts: &'a mut [Vec<SurfaceContact>],
}

impl WithLaw for SurfacePass<'_> {
    type Output = ();

    fn run<C: ContactLaw>(self, law: &C) {
        let Self { surface, motion, grains, before, lists, begin, .. } = self;
        let rigid = RigidSurface { law, motion, dt: self.dt };
        parallel::for_each(self.contacts, |k, contacts| {
            contacts.clear();
            let ids = lists.ids[begin + k];
            let of = lists.triangle_starts[begin + k]..lists.triangle_starts[begin + k + 1];
            let candidates = &lists.triangles[of.start as usize..of.end as usize];
            let i = ids[1] as usize;
            let reach = grains.radii[i] + law.range();
            let touches = touches(surface, motion, candidates, (&grains.positions[i], reach));
            if touches.is_empty() {
                return;
            }
            let inherited = inherited(before.of(&ids), &touches);
            for (touch, history) in touches.iter().zip(inherited) {
                contacts.extend(contact(&rigid, grains, i, touch, history));
            }
        });
    }
}

/// The geometry of a contact.
struct Touch {
    distance: Real,
    /// Unit normal from the surface to the grain, world axes.
    normal: Vec3,
    share: Real,
}

/// The contacts of a surface with a grain at `position` (m); `reach` (m) is its radius plus the range of the law.
fn touches(
    surface: TouchedSurface<'_>,
    motion: &BodyMotion,
    candidates: &[u32],
    (position, reach): (&Vec3, Real),
) -> Vec<Touch> {
    let arm = position - motion.pose.translation.vector;
    match surface {
        TouchedSurface::Triangles(triangles) => {
            let local = motion.pose.rotation.inverse_transform_vector(&arm);
            let in_world = |it: crate::physics::boundary::touching::Touch| Touch {
                distance: it.nearest.distance,
                normal: motion.pose.rotation * it.nearest.normal,
                share: it.share,
            };
            triangles.touching(candidates, &local, reach).into_iter().map(in_world).collect()
        }
        TouchedSurface::Body(body) => {
            if body.bounding_radius + reach <= arm.norm() {
                return Vec::new();
            }
            let (distance, normal) = signed_distance(body, motion, &arm);
            (distance < reach)
                .then_some(Touch { distance, normal, share: 1.0 })
                .into_iter()
                .collect()
        }
    }
}

/// The history that each contact inherits, if any: contact and history must be most similar to each other.
fn inherited<'a>(
    before: &'a [SurfaceHistory],
    touches: &[Touch],
) -> Vec<Option<&'a SurfaceHistory>> {
    let similarity = |touch: &Touch, history: &SurfaceHistory| touch.normal.dot(&history.normal);
    let closest_touch = |history: &SurfaceHistory| {
        let similarities = touches.iter().map(|touch| similarity(touch, history));
        largest(similarities)
    };
    let of_touch = |k: usize| {
        let history = &before[largest(before.iter().map(|it| similarity(&touches[k], it)))?];
        (closest_touch(history) == Some(k)).then_some(history)
    };
    (0..touches.len()).map(of_touch).collect()
}

/// Index of the largest similarity if it is large enough; the first of equal ones.
fn largest(similarities: impl Iterator<Item = Real>) -> Option<usize> {
    let mut best = (SAME_HISTORY, None);
    for (k, similarity) in similarities.enumerate() {
        if similarity > best.0 {
            best = (similarity, Some(k));
        }
    }
    best.1
}

/// Computes one contact of grain `i`. `None` if it has ended.
fn contact<C: ContactLaw>(
    surface: &RigidSurface<'_, C>,
    grains: &Grains,
    i: usize,
    touch: &Touch,
    before: Option<&SurfaceHistory>,
) -> Option<SurfaceContact> {
    let mut memory = before.map_or_else(Vec::new, |it| it.memory.clone());
    let rows = C::Memory::rows(&mut memory, 1);
    let mut history = History {
        spring: Vector::from(before.map_or_else(Vec3::zeros, |it| it.spring)),
        memory: C::Memory::load::<f64>(rows),
    };
    let mut force = surface.force(grains, i, (touch.distance, touch.normal), &mut history)?;
    C::Memory::store::<f64>(history.memory, true, rows);
    force.force *= touch.share;
    force.normal *= touch.share;
    let history = SurfaceHistory { spring: history.spring.into(), normal: touch.normal, memory };
    Some(SurfaceContact { history, force, share: touch.share })
}

impl SurfaceHistories {
    /// The histories of a surface and a grain.
    fn of(&self, ids: &[u32; 2]) -> &[SurfaceHistory] {
        let begin = self.ids.partition_point(|it| it < ids);
        let n = self.ids[begin..].partition_point(|it| it <= ids);
        &self.histories[begin..begin + n]
    }

    /// Removes the histories of contacts with bodies, in a system with `n_walls` walls.
    pub fn forget_bodies(&mut self, n_walls: usize) {
        let n = self.ids.partition_point(|[surface, _]| (*surface as usize) < n_walls);
        self.ids.truncate(n);
        self.histories.truncate(n);
    }
}
