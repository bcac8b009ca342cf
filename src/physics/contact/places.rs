//! Contacts of grains with walls of triangles and with rigid bodies.
//!
//! A grain may touch a wall of triangles in several places; `boundary::touching` finds them. Each place is a
//! contact of its own with its own friction spring. A place has no number that lasts, since the contact goes
//! from triangle to triangle while the grain slides or rolls. On a sphere the normal tells one place from
//! another, so a place inherits the spring of the place whose normal was closest to its own, and only one
//! place inherits it.
//!
//! A body is a wall that something else moves, so its contacts are made here too. Polyhedra are touched as
//! triangles, where a grain can rest in a corner on two faces; all other shapes by their signed distance, in
//! one place. The reaction goes into the wrench of the wall or of the body. The effective mass is that of the
//! grain, as at a wall: the mass of a body is much larger.
//!
//! Planes, tubes, bowls and balls stay in `contact::walls`: a grain touches them in one place, so their springs
//! can be listed once for each wall and grain.
//!
//! The state holds the places that exist, not those that are listed; nothing in it depends on the lists.

use super::{bodies::signed_distance, walls::RigidSurface};
use crate::{
    base::{Real, Vec3, lanes::Vector, parallel},
    physics::{
        Controls, Model, Scratch, State,
        boundary::body::BodyMotion,
        law::{ContactLaw, History, Memory, UnderLaw},
        model::TouchedSurface,
        scratch::{PlaceContact, PlaceLists},
        state::{Grains, Place, PlaceSprings},
    },
};

/// Cosine of the angle to its former normal within which a place is recognized (45°).
const SAME_HISTORY: Real = 0.7;

/// Forces of the surfaces on the grains listed near them; carries what these contacts remember on by one
/// substep.
pub fn forces(model: &Model, controls: &Controls, state: &mut State, scratch: &mut Scratch) {
    let lists = &scratch.neighbours.places;
    let contacts = &mut scratch.places;
    contacts.resize_with(lists.ids.len(), Vec::new);
    if lists.ids.is_empty() && state.springs.places.ids.is_empty() {
        return;
    }
    let mut begin = 0;
    while let Some(&[s, _]) = lists.ids.get(begin) {
        let n = lists.ids[begin..].iter().take_while(|ids| ids[0] == s).count();
        if let Some((surface, law)) = model.surface(s as usize) {
            law.with(OfSurface {
                surface,
                motion: motion(model, controls, state, s as usize),
                grains: &state.grains,
                before: &state.springs.places,
                dt: model.substep,
                lists,
                begin,
                contacts: &mut contacts[begin..begin + n],
            });
        }
        begin += n;
    }
    let PlaceSprings { ids, places } = &mut state.springs.places;
    ids.clear();
    places.clear();
    for (contact, of) in scratch.place_contacts() {
        ids.push(*of);
        places.push(contact.place.clone());
    }
}

/// Adds the reactions of all these contacts to the wrenches on walls and bodies.
pub fn react(model: &Model, controls: &Controls, state: &State, scratch: &mut Scratch) {
    let Scratch { neighbours, places, wall_wrenches, body_wrenches, .. } = scratch;
    for (contacts, ids) in places.iter().zip(&neighbours.places.ids) {
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

/// How a surface of `Model::surface` moves.
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
struct OfSurface<'a> {
    surface: TouchedSurface<'a>,
    motion: &'a BodyMotion,
    grains: &'a Grains,
    /// The places of the last substep.
    before: &'a PlaceSprings,
    dt: Real,
    lists: &'a PlaceLists,
    /// Index of the first of these grains in the lists.
    begin: usize,
    /// Written: the places of each grain.
    contacts: &'a mut [Vec<PlaceContact>],
}

impl UnderLaw for OfSurface<'_> {
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
            for (touch, place) in touches.iter().zip(inherited) {
                contacts.extend(contact(&rigid, grains, i, touch, place));
            }
        });
    }
}

/// Where a surface is close to a grain.
struct Touch {
    distance: Real,
    /// From the surface to the grain, world axes.
    normal: Vec3,
    share: Real,
}

/// The places where a grain at `position` (m) that reaches `reach` (m) touches a surface.
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

/// The place that each contact continues, if there is one: both are closest to each other.
fn inherited<'a>(before: &'a [Place], touches: &[Touch]) -> Vec<Option<&'a Place>> {
    let likeness = |touch: &Touch, place: &Place| touch.normal.dot(&place.normal);
    let closest_touch = |place: &Place| {
        let likenesses = touches.iter().map(|touch| likeness(touch, place));
        largest(likenesses)
    };
    let of_touch = |k: usize| {
        let place = &before[largest(before.iter().map(|place| likeness(&touches[k], place)))?];
        (closest_touch(place) == Some(k)).then_some(place)
    };
    (0..touches.len()).map(of_touch).collect()
}

/// Index of the largest likeness that is large enough, the first of equal ones.
fn largest(likenesses: impl Iterator<Item = Real>) -> Option<usize> {
    let mut best = (SAME_HISTORY, None);
    for (k, likeness) in likenesses.enumerate() {
        if likeness > best.0 {
            best = (likeness, Some(k));
        }
    }
    best.1
}

/// One contact of grain `i`; `None` if it has ended.
fn contact<C: ContactLaw>(
    surface: &RigidSurface<'_, C>,
    grains: &Grains,
    i: usize,
    touch: &Touch,
    before: Option<&Place>,
) -> Option<PlaceContact> {
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
    let place = Place { spring: history.spring.into(), normal: touch.normal, memory };
    Some(PlaceContact { place, force, share: touch.share })
}

impl PlaceSprings {
    /// The places of a surface and a grain.
    fn of(&self, ids: &[u32; 2]) -> &[Place] {
        let begin = self.ids.partition_point(|it| it < ids);
        let n = self.ids[begin..].partition_point(|it| it <= ids);
        &self.places[begin..begin + n]
    }

    /// Forgets the contacts of bodies, in a system with `n_walls` walls.
    pub fn forget_bodies(&mut self, n_walls: usize) {
        let n = self.ids.partition_point(|[surface, _]| (*surface as usize) < n_walls);
        self.ids.truncate(n);
        self.places.truncate(n);
    }
}
