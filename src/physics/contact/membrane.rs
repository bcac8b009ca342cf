//! Contacts between grains and the membrane's triangles.
//!
//! A grain touches the membrane where its distance to the sheet has a local minimum. On one
//! triangle that point lies on the face, on an edge or on a vertex; on an edge or a vertex it
//! counts only if it is the closest point of all triangles that share it, and then once. That is
//! the rule of priorities (face before edge before vertex) of Götz (2024), section 3.2.3, stated
//! by depth, so that force, direction and point are continuous when a grain moves over an edge.
//!
//! In the valley between two triangles both faces can hold a local minimum. If their normals are
//! nearly the same, that is one patch of a smooth sheet and must not count twice; if they are far
//! apart, the grain lies in a fold and is held from both sides. In between, and while a minimum
//! wanders into a face over its edge, the forces are shared out without a jump:
//!
//! ```text
//! F_i = c_i F(ξ_i),   c_i = q_i / (q_i + Σ_(j≠i) s_ij q_j),   q_i = ξ_i g_i
//! ```
//!
//! s_ij falls from 1 to nearly 0 as the angle between the normals grows from 10° to 45°, and g_i
//! grows with the distance of the contact point from the edge of its triangle. A contact that is
//! alone has c = 1. A jump here would be a force of the order of 1 N on a vertex of 5 mg.
//!
//! The friction spring belongs to the patch, not to the triangle: it is handed on by direction.

use arrayvec::ArrayVec;

use super::law::{self, Touch};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Model,
        membrane::contact_geometry::{Feature, closest_on_triangle},
        scratch::{Neighbours, PatchForce, PatchForces},
        state::{N_PATCHES, Patch, Patches, State},
    },
};

/// Cosine of the angle between normals up to which two contacts are one patch (10°).
const ONE_PATCH: Real = 0.985;
/// Cosine of the angle beyond which they are two (45°).
const TWO_PATCHES: Real = 0.707;
/// What two patches far apart still know of each other: makes a new one grow in smoothly.
const APART: Real = 0.05;
/// Share g of a contact on an edge or a vertex.
const ON_EDGE: Real = 0.03;
/// Barycentric distance from the edge at which a contact on a face has its full share.
const ON_FACE: Real = 0.15;
/// Cosine of the angle to its former normal within which a patch is recognised (45°).
const SAME_HISTORY: Real = 0.7;
/// Squared distances that differ by less than this share are equal.
const EQUAL: Real = 1e-9;
/// Triangles one grain may touch at once, the deepest; a grain much larger than the mesh would
/// need more.
const N_TOUCHED: usize = 24;

/// A triangle within reach of a grain.
#[derive(Clone, Copy)]
struct Touched {
    triangle: u32,
    feature: Feature,
    weights: [Real; 3],
    from_membrane: Vec3,
    distance_squared: Real,
}

/// Forces of the membrane on all grains; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    state: &State,
    lists: &Neighbours,
    springs: &mut [Patches],
    patch_forces: &mut Vec<PatchForces>,
) {
    patch_forces.resize(springs.len(), PatchForces::NONE);
    parallel::for_each_of_two(patch_forces, springs, |i, force, patches| {
        let range = lists.triangle_starts[i] as usize..lists.triangle_starts[i + 1] as usize;
        if range.is_empty() {
            // Most grains are inside the packing: nothing but the counts is touched.
            (force.n, patches.n) = (0, 0);
        } else {
            on_grain(model, state, i, &lists.triangles[range], patches, force);
        }
    });
}

fn on_grain(
    model: &Model,
    state: &State,
    i: usize,
    candidates: &[u32],
    patches: &mut Patches,
    result: &mut PatchForces,
) {
    let touched = touching(model, state, i, candidates);
    let mut minima = ArrayVec::<Minimum<'_>, N_PATCHES>::new();
    for contact in &touched {
        if !minima.is_full() && is_local_minimum(model, contact, &touched) {
            minima.push(Minimum::new(contact, state.grains.radii[i]));
        }
    }
    let (before, n_before) = (patches.slots, patches.n);
    patches.n = minima.len();
    result.n = minima.len();
    result.torque = Vec3::zeros();
    result.is_outside = false;
    for (slot, minimum) in minima.iter().enumerate() {
        let share = share(slot, &minima);
        let spring = spring_of(&before[..n_before], &minimum.normal);
        let mut patch = Patch { spring, normal: minimum.normal };
        let (force, torque) = of_patch(model, state, i, minimum, &mut patch);
        result.is_outside |= minimum.contact.is_outside(model, state, &touched);
        result.contacts[slot] =
            PatchForce { force: force.force * share, normal: force.normal * share, ..force };
        result.torque += torque * share;
        patches.slots[slot] = patch;
    }
}

/// Share c of the force that contact `slot` takes.
fn share(slot: usize, minima: &[Minimum<'_>]) -> Real {
    if minima.len() == 1 {
        return 1.0;
    }
    let own = &minima[slot];
    let mut all = own.weight;
    for (other, minimum) in minima.iter().enumerate() {
        if other != slot {
            let cosine = own.normal.dot(&minimum.normal);
            let likeness = (cosine - TWO_PATCHES) * (1.0 / (ONE_PATCH - TWO_PATCHES));
            let likeness = likeness.clamp(0.0, 1.0);
            let smooth = likeness * likeness * (3.0 - 2.0 * likeness);
            all += (APART + (1.0 - APART) * smooth) * minimum.weight;
        }
    }
    own.weight / all
}

/// A local minimum of the grain's distance to the sheet.
struct Minimum<'a> {
    contact: &'a Touched,
    /// From membrane to grain.
    normal: Vec3,
    overlap: Real,
    /// The q of the formula.
    weight: Real,
}

impl<'a> Minimum<'a> {
    fn new(contact: &'a Touched, radius: Real) -> Self {
        let distance = contact.distance_squared.sqrt();
        let overlap = radius - distance;
        let from_edge = contact.weights.iter().copied().fold(1.0, Real::min);
        let on_face = (from_edge * (1.0 / ON_FACE)).min(1.0);
        Self {
            contact,
            normal: contact.from_membrane * distance.recip(),
            overlap,
            weight: overlap * (ON_EDGE + (1.0 - ON_EDGE) * on_face),
        }
    }
}

/// Triangles that grain `i` overlaps, deepest first.
fn touching(
    model: &Model,
    state: &State,
    i: usize,
    candidates: &[u32],
) -> ArrayVec<Touched, N_TOUCHED> {
    let (position, radius) = (state.grains.positions[i], state.grains.radii[i]);
    let mut touched = ArrayVec::<Touched, N_TOUCHED>::new();
    for &triangle in candidates {
        let corners = model.membrane.mesh.triangles[triangle as usize]
            .map(|vertex| &state.membrane.positions[vertex as usize]);
        let closest = closest_on_triangle(&position, corners);
        let from_membrane = position - closest.point;
        let distance_squared = from_membrane.norm_squared();
        if distance_squared >= radius * radius || distance_squared == 0.0 {
            continue;
        }
        let contact = Touched {
            triangle,
            feature: closest.feature,
            weights: closest.weights,
            from_membrane,
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
    let triangles = &model.membrane.mesh.triangles;
    if contact.feature == Feature::Face {
        return true;
    }
    let shared = contact.shared_vertices(model);
    let beats = |other: &Touched| {
        let theirs = triangles[other.triangle as usize];
        if other.triangle == contact.triangle
            || !shared.iter().flatten().all(|vertex| theirs.contains(vertex))
        {
            return false;
        }
        let difference = other.distance_squared - contact.distance_squared;
        let tolerance = EQUAL * contact.distance_squared;
        let (mine, yours) = (contact.feature.priority(), other.feature.priority());
        difference < -tolerance
            || (difference <= tolerance
                && (yours > mine || (yours == mine && other.triangle < contact.triangle)))
    };
    !touched.iter().any(beats)
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
    minimum: &Minimum<'_>,
    patch: &mut Patch,
) -> (PatchForce, Vec3) {
    let &Minimum { contact, overlap, .. } = minimum;
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
    let touch = Touch { overlap, normal: patch.normal, velocity, radius, mass };
    let force = law::force(&model.membrane_law, &touch, model.substep, &mut patch.spring);
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
    /// True if the grain's centre is on the outer side of the triangles that share the feature it
    /// touches. All of them must agree, since around a saddle's vertex some always see the centre
    /// on their outer side.
    fn is_outside(&self, model: &Model, state: &State, touched: &[Self]) -> bool {
        let sees_outside = |triangle: u32| {
            let [a, b, c] = model.membrane.mesh.triangles[triangle as usize]
                .map(|vertex| state.membrane.positions[vertex as usize]);
            (b - a).cross(&(c - a)).dot(&self.from_membrane) > 0.0
        };
        let shared = self.shared_vertices(model);
        touched
            .iter()
            .filter(|other| {
                let theirs = model.membrane.mesh.triangles[other.triangle as usize];
                other.triangle == self.triangle
                    || (self.feature != Feature::Face
                        && shared.iter().flatten().all(|vertex| theirs.contains(vertex)))
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
