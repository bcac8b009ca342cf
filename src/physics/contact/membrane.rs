//! Contacts between grains and the membrane's triangles.
//!
//! A grain touches the membrane where its distance to the sheet has a local minimum. On one
//! triangle that point lies on the face, on an edge or on a vertex; on an edge or a vertex it
//! counts only if it is the closest point of all triangles that share it, and then once. That is
//! the rule of priorities (face before edge before vertex) of Götz (2024), section 3.2.3, stated
//! by depth, so that force, direction and point are continuous when a grain moves over an edge.
//!
//! In the flat valley between two triangles both faces can hold a local minimum with almost the
//! same normal: that is one patch of a smooth sheet, and only its deepest point counts. The
//! friction spring belongs to the patch, not to the triangle: it is handed on by direction.

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

/// Cosine of the angle between normals below which two contacts are patches of their own (20°).
const SAME_PATCH: Real = 0.94;
/// Cosine of the angle to its former normal within which a patch is recognised (45°).
const SAME_HISTORY: Real = 0.7;
/// Squared distances that differ by less than this share are equal.
const EQUAL: Real = 1e-9;
/// Triangles one grain may touch at once; a grain much larger than the mesh would need more.
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
    let (before, n_before) = (patches.slots, patches.n);
    patches.n = 0;
    result.n = 0;
    result.torque = Vec3::zeros();
    result.is_outside = false;
    for contact in &touched {
        if result.n == N_PATCHES {
            break;
        }
        let normal = contact.from_membrane / contact.distance_squared.sqrt();
        let known = patches.slots[..patches.n].iter().any(|p| p.normal.dot(&normal) > SAME_PATCH);
        if known || !is_local_minimum(model, contact, &touched) {
            continue;
        }
        let mut patch = Patch { spring: spring_of(&before[..n_before], &normal), normal };
        let (force, torque) = of_patch(model, state, i, contact, &mut patch);
        result.is_outside |= contact.is_outside(model, state);
        result.contacts[result.n] = force;
        result.torque += torque;
        result.n += 1;
        patches.slots[patches.n] = patch;
        patches.n += 1;
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
        if distance_squared >= radius * radius || distance_squared == 0.0 || touched.is_full() {
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
        touched.insert(place, contact);
    }
    touched
}

/// True if no triangle that shares the contact's edge or vertex has a closer point, or holds the
/// same point with higher priority.
fn is_local_minimum(model: &Model, contact: &Touched, touched: &[Touched]) -> bool {
    let triangles = &model.membrane.mesh.triangles;
    let corners = triangles[contact.triangle as usize];
    let shared: [Option<u32>; 2] = match contact.feature {
        Feature::Face => return true,
        Feature::Edge(k) => {
            [Some(corners[usize::from(k)]), Some(corners[(usize::from(k) + 1) % 3])]
        }
        Feature::Vertex(k) => [Some(corners[usize::from(k)]), None],
    };
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
    contact: &Touched,
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
    let overlap = radius - contact.distance_squared.sqrt();
    let arm = patch.normal * -(radius - overlap / 2.0);
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
    /// True if the grain's centre is on the outer side of the triangle whose face it touches.
    fn is_outside(&self, model: &Model, state: &State) -> bool {
        if self.feature != Feature::Face {
            return false;
        }
        let [a, b, c] = model.membrane.mesh.triangles[self.triangle as usize]
            .map(|vertex| state.membrane.positions[vertex as usize]);
        (b - a).cross(&(c - a)).dot(&self.from_membrane) > 0.0
    }
}
