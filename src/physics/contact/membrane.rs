//! Contacts between grains and the membrane's triangles.
//!
//! A grain touches the membrane where its distance to the sheet has a local minimum. On one
//! triangle that point lies on the face, on an edge or on a vertex; on an edge or a vertex it
//! counts only if it is the closest point of all triangles that share it, and then once. That is
//! the rule of priorities (face before edge before vertex) of Götz (2024), section 3.2.3, stated
//! by depth, so that force, direction and point are continuous when a grain moves over an edge.
//!
//! In the valley between two triangles both faces can hold a local minimum; how they share out the
//! force stands in `sharing`.
//!
//! The friction spring belongs to the patch, not to the triangle: it is handed on by direction.

use arrayvec::ArrayVec;

use super::{
    candidates,
    law::{self, Touch},
    sharing::{self, Minimum, N_TOUCHED, Passes},
};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Model,
        membrane::contact_geometry::Feature,
        scratch::{CandidateScratch, GrainRow, Neighbours, PatchForce, PatchForces},
        state::{N_PATCHES, Patch, Patches, State},
    },
};

/// Cosine of the angle to its former normal within which a patch is recognised (45°).
const SAME_HISTORY: Real = 0.7;
/// Squared distances that differ by less than this share are equal.
const EQUAL: Real = 1e-9;
/// Edges of a triangle by their short numbers.
const NUMBER: [u8; 3] = [0, 1, 2];

/// A triangle within reach of a grain.
#[derive(Clone, Copy)]
struct Touched {
    triangle: u32,
    feature: Feature,
    weights: [Real; 3],
    from_membrane: Vec3,
    distance_squared: Real,
}

/// Forces of the membrane on all grains near it; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    state: &State,
    springs: &mut [Patches],
    lists: &mut Neighbours,
    (rows, candidates, patch_forces): (&[GrainRow], &mut CandidateScratch, &mut Vec<PatchForces>),
) {
    patch_forces.resize(springs.len(), PatchForces::NONE);
    if lists.sheet_grains.is_empty() {
        return;
    }
    candidates::look(model, state, lists, rows, candidates);
    let (lists, candidates) = (&*lists, &*candidates);
    parallel::for_listed_of_two(&lists.sheet_grains, patch_forces, springs, |s, force, patches| {
        let touched = touching(state, lists, candidates, s);
        on_grain(model, state, lists.sheet_grains[s] as usize, &touched, patches, force);
    });
}

fn on_grain(
    model: &Model,
    state: &State,
    i: usize,
    touched: &[Touched],
    patches: &mut Patches,
    result: &mut PatchForces,
) {
    let mut minima = ArrayVec::<Minimum, N_PATCHES>::new();
    for (place, contact) in touched.iter().enumerate() {
        if !minima.is_full() && is_local_minimum(model, contact, touched) {
            minima.push(contact.minimum(place, state.grains.radii[i]));
        }
    }
    let mut shares = [1.0; N_PATCHES];
    if minima.len() > 1 {
        let mut passes = passes(model, state, i, touched);
        shares = sharing::shares(&minima, &mut passes, state.grains.radii[i]);
    }
    let (before, n_before) = (patches.slots, patches.n);
    patches.n = minima.len();
    result.n = minima.len();
    result.torque = Vec3::zeros();
    result.is_outside = false;
    for (slot, minimum) in minima.iter().enumerate() {
        let (contact, share) = (&touched[minimum.place], shares[slot]);
        let spring = spring_of(&before[..n_before], &minimum.normal);
        let mut patch = Patch { spring, normal: minimum.normal };
        let (force, torque) = of_patch(model, state, i, (contact, minimum.overlap), &mut patch);
        result.is_outside |= contact.is_outside(model, state, touched);
        result.contacts[slot] =
            PatchForce { force: force.force * share, normal: force.normal * share, ..force };
        result.torque += torque * share;
        patches.slots[slot] = patch;
    }
}

/// The edges between the triangles that grain `i` overlaps.
fn passes(model: &Model, state: &State, i: usize, touched: &[Touched]) -> Passes {
    let mesh = &model.membrane.mesh;
    let centre = &state.grains.positions[i];
    let ids: ArrayVec<u32, N_TOUCHED> = touched.iter().map(|it| it.triangle).collect();
    let mut passes = Passes::new();
    for (place, contact) in touched.iter().enumerate() {
        let triangle = contact.triangle as usize;
        for (k, neighbour) in mesh.neighbours_of_triangle[triangle].into_iter().enumerate() {
            let later = ids[place + 1..].iter().position(|&it| it == neighbour);
            let Some(later) = later else { continue };
            let height_squared = if contact.feature == Feature::Edge(NUMBER[k]) {
                contact.distance_squared
            } else {
                let [from, to] = [k, (k + 1) % 3].map(|corner| {
                    &state.membrane.positions[mesh.triangles[triangle][corner] as usize]
                });
                let (side, arm) = (to - from, centre - from);
                let share = (arm.dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
                (arm - side * share).norm_squared()
            };
            passes.add([place, place + 1 + later], height_squared);
        }
    }
    passes
}

/// Triangles that the `s`-th grain near the sheet overlaps, deepest first.
fn touching(
    state: &State,
    lists: &Neighbours,
    candidates: &CandidateScratch,
    s: usize,
) -> ArrayVec<Touched, N_TOUCHED> {
    let radius = state.grains.radii[lists.sheet_grains[s] as usize];
    let mut touched = ArrayVec::<Touched, N_TOUCHED>::new();
    for a in candidates.awake_starts[s]..candidates.awake_starts[s + 1] {
        let [distance_squared, w0, w1, w2, x, y, z, feature] = candidates.found[a];
        if distance_squared >= radius * radius || distance_squared == 0.0 {
            continue;
        }
        let contact = Touched {
            triangle: lists.triangles[candidates.awake[a] as usize],
            feature: Feature::of_number(feature),
            weights: [w0, w1, w2],
            from_membrane: Vec3::new(x, y, z),
            distance_squared,
        };
        let is_deeper = |other: &Touched| distance_squared < other.distance_squared;
        let place = touched.iter().position(is_deeper).unwrap_or(touched.len());
        if touched.is_full() {
            if place == touched.len() {
                continue;
            }
            touched.pop();
        }
        touched.insert(place, contact);
    }
    touched
}

/// True if no triangle that shares the contact's edge or vertex has a closer point, or holds the
/// same point with higher priority.
fn is_local_minimum(model: &Model, contact: &Touched, touched: &[Touched]) -> bool {
    let mesh = &model.membrane.mesh;
    let triangle = contact.triangle as usize;
    match contact.feature {
        Feature::Face => true,
        Feature::Edge(k) => {
            let neighbour = mesh.neighbours_of_triangle[triangle][usize::from(k)];
            let other = touched.iter().find(|it| it.triangle == neighbour);
            !other.is_some_and(|other| other.beats(contact))
        }
        Feature::Vertex(k) => {
            let vertex = mesh.triangles[triangle][usize::from(k)];
            !touched.iter().any(|other| {
                mesh.triangles[other.triangle as usize].contains(&vertex)
                    && other.triangle != contact.triangle
                    && other.beats(contact)
            })
        }
    }
}

/// The spring of the patch that had nearly this normal, if there was one.
fn spring_of(before: &[Patch], normal: &Vec3) -> Vec3 {
    let mut best = (SAME_HISTORY, Vec3::zeros());
    for patch in before {
        let likeness = patch.normal.dot(normal);
        if likeness > best.0 {
            best = (likeness, patch.spring);
        }
    }
    best.1
}

fn of_patch(
    model: &Model,
    state: &State,
    i: usize,
    (contact, overlap): (&Touched, Real),
    patch: &mut Patch,
) -> (PatchForce, Vec3) {
    let grains = &state.grains;
    let vertices = model.membrane.mesh.triangles[contact.triangle as usize].map(|v| v as usize);
    let mut sheet_velocity = Vec3::zeros();
    let mut mass = 0.0;
    for (&vertex, &weight) in vertices.iter().zip(&contact.weights) {
        sheet_velocity += state.membrane.velocities[vertex] * weight;
        mass += model.membrane.masses[vertex] * weight;
    }
    let radius = grains.radii[i];
    // The contact point lies on the sheet, so that both sides have the same lever.
    let arm = -contact.from_membrane;
    let velocity = grains.velocities[i] + grains.spins[i].cross(&arm) - sheet_velocity;
    let touch = Touch {
        overlap,
        normal: patch.normal.into(),
        velocity: velocity.into(),
        radius,
        mass,
    };
    let force = law::single(&model.membrane_law, &touch, model.substep, &mut patch.spring);
    let result = PatchForce {
        triangle: contact.triangle,
        weights: contact.weights,
        force: patch.normal * force.normal + force.tangential,
        overlap,
        normal: force.normal,
    };
    (result, arm.cross(&force.tangential))
}

impl Touched {
    /// True if this contact of a neighbour is closer than `other`, or holds the same point with
    /// higher priority.
    fn beats(&self, other: &Self) -> bool {
        let difference = self.distance_squared - other.distance_squared;
        let tolerance = EQUAL * other.distance_squared;
        let (mine, yours) = (self.feature.priority(), other.feature.priority());
        difference < -tolerance
            || (difference <= tolerance
                && (mine > yours || (mine == yours && self.triangle < other.triangle)))
    }

    /// As a local minimum of a grain of `radius` [m].
    fn minimum(&self, place: usize, radius: Real) -> Minimum {
        let distance = self.distance_squared.sqrt();
        Minimum {
            place,
            normal: self.from_membrane * distance.recip(),
            overlap: radius - distance,
            distance_squared: self.distance_squared,
        }
    }

    /// True if the grain's centre is on the outer side of the triangles that share the feature it
    /// touches. All of them must agree, since around a saddle's vertex some always see the centre
    /// on their outer side.
    fn is_outside(&self, model: &Model, state: &State, touched: &[Self]) -> bool {
        let sees_outside = |triangle: u32| {
            let [a, b, c] = model.membrane.mesh.triangles[triangle as usize]
                .map(|vertex| state.membrane.positions[vertex as usize]);
            (b - a).cross(&(c - a)).dot(&self.from_membrane) > 0.0
        };
        // Most contacts are inside: one look at their own triangle is enough.
        if !sees_outside(self.triangle) {
            return false;
        }
        let shared = self.shared_vertices(model);
        touched
            .iter()
            .filter(|other| {
                let theirs = model.membrane.mesh.triangles[other.triangle as usize];
                self.feature != Feature::Face
                    && shared.iter().flatten().all(|vertex| theirs.contains(vertex))
            })
            .all(|other| sees_outside(other.triangle))
    }

    /// The ends of the edge, or the vertex, that the contact lies on; none on a face.
    fn shared_vertices(&self, model: &Model) -> [Option<u32>; 2] {
        let corners = model.membrane.mesh.triangles[self.triangle as usize];
        match self.feature {
            Feature::Face => [None, None],
            Feature::Edge(k) => {
                [Some(corners[usize::from(k)]), Some(corners[(usize::from(k) + 1) % 3])]
            }
            Feature::Vertex(k) => [Some(corners[usize::from(k)]), None],
        }
    }
}
