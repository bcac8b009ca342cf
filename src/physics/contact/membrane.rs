//! Contacts between grains and the membrane's triangles.
//!
//! A grain touches the membrane where its distance to the membrane has a local minimum. On one
//! triangle that point lies on the face, on an edge or on a vertex; on an edge or a vertex it
//! counts only if it is the closest point of all triangles that share it, and then once. That is
//! the rule of priorities (face before edge before vertex) of Götz (2024), section 3.2.3, stated
//! by depth, so that force, direction and point are continuous when a grain moves over an edge.
//!
//! In the valley between two triangles both faces can hold a local minimum; `sharing` says how they share
//! the force.
//!
//! The friction spring belongs to the patch, not to the triangle: a patch inherits the spring of the patch
//! whose normal was closest to its own.

use arrayvec::ArrayVec;

use super::{
    candidates,
    sharing::{self, Minimum, N_TOUCHED, Saddles, short},
};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Model,
        law::{self, ContactState},
        membrane::{MembraneState, VertexRow, contact_geometry::Feature},
        scratch::{
            CandidateScratch, ContactFlags, GrainRow, Neighbours, PatchForce, PatchForces, Scratch,
        },
        state::{Grains, N_PATCHES, Patch, Patches},
    },
};

/// Cosine of the angle to its former normal within which a patch is recognized (45°).
const SAME_HISTORY: Real = 0.7;
/// Squared distances that differ by less than this share are equal.
const EQUAL: Real = 1e-9;

/// A triangle within reach of a grain.
#[derive(Clone, Copy)]
struct Touched {
    triangle: u32,
    feature: Feature,
    distance_squared: Real,
    /// Its index in `CandidateScratch::found`.
    index: usize,
}

/// Where a grain touches the membrane.
struct Contact {
    triangle: u32,
    weights: [Real; 3],
    from_membrane: Vec3,
    overlap: Real,
}

/// Forces of the membrane on all grains near it; carries their springs on by one substep. The rows of grains
/// and vertices in `scratch` must be those of the present positions. Cohesion does not act here.
pub fn forces(
    model: &Model,
    grains: &Grains,
    membrane: &MembraneState,
    springs: &mut [Patches],
    scratch: &mut Scratch,
) {
    let Scratch { neighbours: lists, candidates, patch_forces, .. } = scratch;
    patch_forces.resize(springs.len(), PatchForces::NONE);
    if lists.membrane_grains.is_empty() {
        return;
    }
    let rows: (&[GrainRow], &[VertexRow]) = (&scratch.grain_rows, &scratch.membrane.vertices);
    candidates::look(model, lists, rows, candidates);
    let (lists, candidates) = (&*lists, &*candidates);
    let listed = &lists.membrane_grains;
    parallel::for_listed_of_two(listed, patch_forces, springs, |s, force, patches| {
        let i = listed[s] as usize;
        let mut touched = ArrayVec::new();
        touching(grains.radii[i], lists, candidates, s, &mut touched);
        let grain = Grain { model, grains, membrane, i, found: &candidates.found };
        grain.meet(&touched, patches, force);
    });
}

/// A grain near the membrane.
struct Grain<'a> {
    model: &'a Model,
    grains: &'a Grains,
    membrane: &'a MembraneState,
    i: usize,
    /// Closest points of candidates.
    found: &'a [[Real; 8]],
}

impl Grain<'_> {
    fn radius(&self) -> Real {
        self.grains.radii[self.i]
    }

    /// From the closest point to the center (m).
    fn arm(&self, contact: &Touched) -> Vec3 {
        let [.., x, y, z, _] = self.found[contact.index];
        Vec3::new(x, y, z)
    }

    /// Forces of the patches among the triangles that are touched.
    fn meet(&self, touched: &[Touched], patches: &mut Patches, result: &mut PatchForces) {
        let mut minima = ArrayVec::<Minimum, N_PATCHES>::new();
        for (index, contact) in touched.iter().enumerate() {
            if !minima.is_full() && is_local_minimum(self.model, contact, touched) {
                minima.push(self.minimum(index, contact));
            }
        }
        let mut shares = [1.0; N_PATCHES];
        if minima.len() > 1 {
            let mut saddles = Saddles::new();
            self.saddles(touched, &mut saddles);
            shares = sharing::shares(&minima, &mut saddles, self.radius());
        }
        let before: ArrayVec<Patch, N_PATCHES> =
            patches.slots[..patches.n].iter().copied().collect();
        patches.n = minima.len();
        result.n = minima.len();
        result.torque = Vec3::zeros();
        // The deepest come first. Only the nearest point decides on which side the grain is: a fold behind it
        // may have the grain on its outer side.
        let nearest = minima.first().map(|it| &touched[it.index]);
        result.is_outside = nearest.is_some_and(|it| self.is_outside(it, &self.arm(it), touched));
        for (slot, minimum) in minima.iter().enumerate() {
            let (it, share) = (&touched[minimum.index], shares[slot]);
            let [_, w0, w1, w2, ..] = self.found[it.index];
            let contact = Contact {
                triangle: it.triangle,
                weights: [w0, w1, w2],
                from_membrane: self.arm(it),
                overlap: minimum.overlap,
            };
            let spring = spring_of(&before, &minimum.normal);
            let mut patch = Patch { spring, normal: minimum.normal };
            let (force, torque) = self.of_patch(&contact, &mut patch);
            result.contacts[slot] =
                PatchForce { force: force.force * share, normal: force.normal * share, ..force };
            result.torque += torque * share;
            patches.slots[slot] = patch;
        }
    }

    /// A contact as a local minimum; `index` is its index among those that are touched.
    fn minimum(&self, index: usize, contact: &Touched) -> Minimum {
        let distance = contact.distance_squared.sqrt();
        Minimum {
            index,
            normal: self.arm(contact) * distance.recip(),
            overlap: self.radius() - distance,
            distance_squared: contact.distance_squared,
        }
    }

    /// Adds the edges between the triangles that the grain overlaps.
    fn saddles(&self, touched: &[Touched], saddles: &mut Saddles) {
        let mesh = &self.model.membrane.mesh;
        let mut edges = [[0_u8; 3]; N_TOUCHED * (N_TOUCHED - 1) / 2];
        let mut n_edges = 0;
        for (index, contact) in touched.iter().enumerate() {
            let across = &mesh.neighbours_of_triangle[contact.triangle as usize];
            for (later, other) in touched.iter().enumerate().skip(index + 1) {
                let is_across = across.map(|it| it == other.triangle);
                // Branch-free: whether two touched triangles are neighbors is not predictable.
                let edge = u8::from(is_across[1]) + 2 * u8::from(is_across[2]);
                edges[n_edges] = [short(index), short(later), edge];
                n_edges += usize::from(is_across[0] | is_across[1] | is_across[2]);
            }
        }
        for &[index, later, edge] in &edges[..n_edges] {
            let height_squared = self.height_squared(&touched[usize::from(index)], edge);
            saddles.add([index, later], height_squared);
        }
    }

    /// Squared distance of the grain's center from an edge of a triangle that it touches (m²).
    fn height_squared(&self, contact: &Touched, edge: u8) -> Real {
        if contact.feature == Feature::Edge(edge) {
            return contact.distance_squared;
        }
        let corners = &self.model.membrane.mesh.triangles[contact.triangle as usize];
        let k = usize::from(edge);
        let [from, to] =
            [k, (k + 1) % 3].map(|corner| &self.membrane.positions[corners[corner] as usize]);
        let (side, arm) = (to - from, self.grains.positions[self.i] - from);
        let share = (arm.dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        (arm - side * share).norm_squared()
    }

    /// Force on the grain, and torque (N m).
    fn of_patch(&self, contact: &Contact, patch: &mut Patch) -> (PatchForce, Vec3) {
        let Self { model, grains, membrane, i, .. } = *self;
        let vertices = model.membrane.mesh.triangles[contact.triangle as usize];
        let mut membrane_velocity = Vec3::zeros();
        let mut mass = 0.0;
        for (vertex, &weight) in vertices.map(|v| v as usize).into_iter().zip(&contact.weights) {
            membrane_velocity += membrane.velocities[vertex] * weight;
            mass += model.membrane.masses[vertex] * weight;
        }
        // The contact point lies on the membrane, so that both sides have the same lever.
        let arm = -contact.from_membrane;
        let velocity =
            grains.velocities[i] + grains.angular_velocities[i].cross(&arm) - membrane_velocity;
        let contact_state = ContactState {
            touches: true,
            overlap: contact.overlap,
            normal: patch.normal.into(),
            velocity: velocity.into(),
            radius: self.radius(),
            mass,
        };
        let force =
            law::scalar(&model.membrane_law, &contact_state, model.substep, &mut patch.spring);
        let result = PatchForce {
            triangle: contact.triangle,
            weights: contact.weights,
            force: patch.normal * force.normal + force.tangential,
            overlap: contact.overlap,
            normal: force.normal,
            flags: ContactFlags::contact(force.slides),
        };
        (result, arm.cross(&force.tangential))
    }

    /// True if the center is on the outer side of the triangles that share the feature it touches. All
    /// of them must agree, since around a saddle's vertex some always see the center on their outer
    /// side.
    fn is_outside(&self, contact: &Touched, from_membrane: &Vec3, touched: &[Touched]) -> bool {
        let triangles = &self.model.membrane.mesh.triangles;
        let sees_outside = |triangle: u32| {
            let [a, b, c] =
                triangles[triangle as usize].map(|vertex| self.membrane.positions[vertex as usize]);
            (b - a).cross(&(c - a)).dot(from_membrane) > 0.0
        };
        // Most contacts are inside; their own triangle is enough to tell.
        if !sees_outside(contact.triangle) {
            return false;
        }
        let shared = contact.shared_vertices(self.model);
        touched
            .iter()
            .filter(|other| {
                let theirs = triangles[other.triangle as usize];
                contact.feature != Feature::Face
                    && shared.iter().flatten().all(|vertex| theirs.contains(vertex))
            })
            .all(|other| sees_outside(other.triangle))
    }
}

/// Triangles that the `s`-th grain near the membrane, of `radius` (m), overlaps, deepest first.
fn touching(
    radius: Real,
    lists: &Neighbours,
    candidates: &CandidateScratch,
    s: usize,
    touched: &mut ArrayVec<Touched, N_TOUCHED>,
) {
    for a in candidates.awake_starts[s]..candidates.awake_starts[s + 1] {
        let [distance_squared, .., feature] = candidates.found[a];
        if distance_squared >= radius * radius || distance_squared == 0.0 {
            continue;
        }
        let contact = Touched {
            triangle: lists.triangles[candidates.awake[a] as usize],
            feature: Feature::of_number(feature),
            distance_squared,
            index: a,
        };
        let is_deeper = |other: &Touched| distance_squared < other.distance_squared;
        if touched.is_full() {
            if !touched.last().is_some_and(is_deeper) {
                continue;
            }
            touched.pop();
        }
        // From the end on, those that are less deep make room.
        touched.push(contact);
        let mut index = touched.len() - 1;
        while index > 0 && is_deeper(&touched[index - 1]) {
            touched[index] = touched[index - 1];
            index -= 1;
        }
        touched[index] = contact;
    }
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
