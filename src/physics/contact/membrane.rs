//! Contacts between grains and the membrane's triangles.
//!
//! ```text
//! ξ = R − |x − x_c|,   n = (x − x_c) / |x − x_c|,   R* = R,   m* = Σ_k w_k m_k
//! b = x_c − x,         v = ẋ + ω × b − Σ_k w_k v_k
//! force on the grain c F,   on vertex k  −c w_k F,   torque on the grain c b × F
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | x, R, ω | center, radius and angular velocity of the grain | m, m, rad/s |
//! | x_c, w_k | closest point of the triangle and its barycentric weights | m, – |
//! | v_k, m_k | velocity and mass of the triangle's vertices | m/s, kg |
//! | ξ, n, v | overlap, normal from membrane to grain, relative velocity | m, –, m/s |
//! | F | force of the contact law | N |
//! | c | share of the force, see `sharing`; 1 for a single contact | – |
//!
//! A grain touches the membrane where its distance to the membrane has a local minimum. On one
//! triangle the minimum lies on the face, on an edge or on a vertex. On an edge or a vertex it
//! counts only if it is the closest point of all triangles that share the edge or vertex, and it
//! counts once. This is the priority rule (face before edge before vertex) of Götz (2024), section
//! 3.2.3, expressed by depth, so that force, direction and contact point are continuous when a
//! grain moves over an edge. In a valley between two triangles, both faces can have a local minimum;
//! `sharing` defines how they share the force.
//!
//! The friction spring belongs to the patch, not to the triangle: a patch inherits the spring of the patch
//! with the most similar normal.
//!
//! Source: Götz (2024), section 3.2.3, except for the shares. Valid while the grain overlaps at most
//! `N_TOUCHED` triangles and has at most `N_PATCHES` contacts, and ξ < 0.1 R as for the contact law.

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
            CandidateScratch, ContactFlags, GrainRow, Neighbors, PatchForce, PatchForces, Scratch,
        },
        state::{Grains, N_PATCHES, Patch, Patches},
    },
};

/// A patch inherits a spring if the cosine of the angle between the normals is larger than this (45°).
const SAME_HISTORY: Real = 0.7;
/// Relative difference below which squared distances count as equal.
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

/// A contact of a grain with the membrane.
struct Contact {
    triangle: u32,
    weights: [Real; 3],
    from_membrane: Vec3,
    overlap: Real,
}

/// Computes the forces of the membrane on all grains near it, and updates their springs by one substep. The rows
/// of grains and vertices in `scratch` must hold the current positions. Cohesion does not act here.
pub fn forces(
    model: &Model,
    grains: &Grains,
    membrane: &MembraneState,
    springs: &mut [Patches],
    scratch: &mut Scratch,
) {
    let Scratch { neighbors: lists, candidates, patch_forces, .. } = scratch;
    patch_forces.resize(springs.len(), PatchForces::NONE);
    if lists.membrane_grains.is_empty() {
        return;
    }
    let rows: (&[GrainRow], &[VertexRow]) = (&scratch.grain_rows, &scratch.membrane.vertices);
    candidates::find_closest(model, lists, rows, candidates);
    let (lists, candidates) = (&*lists, &*candidates);
    let listed = &lists.membrane_grains;
    parallel::for_listed_of_two(listed, patch_forces, springs, |s, force, patches| {
        let i = listed[s] as usize;
        let mut touched = ArrayVec::new();
        touching(grains.radii[i], lists, candidates, s, &mut touched);
        let grain = Grain { model, grains, membrane, i, found: &candidates.found };
        grain.update(&touched, patches, force);
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

    /// Vector from the closest point to the grain's center (m).
    fn arm(&self, contact: &Touched) -> Vec3 {
        let [.., x, y, z, _] = self.found[contact.index];
        Vec3::new(x, y, z)
    }

    /// Computes the forces of all patches among the touched triangles.
    fn update(&self, touched: &[Touched], patches: &mut Patches, result: &mut PatchForces) {
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
        // The deepest contact comes first. Only the closest point decides on which side the grain is: a fold
        // behind it may have the grain on its outer side.
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
            let spring = inherited_spring(&before, &minimum.normal);
            let mut patch = Patch { spring, normal: minimum.normal };
            let (force, torque) = self.patch_force(&contact, &mut patch);
            result.contacts[slot] =
                PatchForce { force: force.force * share, normal: force.normal * share, ..force };
            result.torque += torque * share;
            patches.slots[slot] = patch;
        }
    }

    /// The local minimum of a contact; `index` is its index in the list of touched triangles.
    fn minimum(&self, index: usize, contact: &Touched) -> Minimum {
        let distance = contact.distance_squared.sqrt();
        Minimum {
            index,
            normal: self.arm(contact) * distance.recip(),
            overlap: self.radius() - distance,
            distance_squared: contact.distance_squared,
        }
    }

    /// Adds the edges between touched triangles to `saddles`.
    fn saddles(&self, touched: &[Touched], saddles: &mut Saddles) {
        let mesh = &self.model.membrane.mesh;
        let mut edges = [[0_u8; 3]; N_TOUCHED * (N_TOUCHED - 1) / 2];
        let mut n_edges = 0;
        for (index, contact) in touched.iter().enumerate() {
            let across = &mesh.neighbors_of_triangle[contact.triangle as usize];
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

    /// Squared distance of the grain's center from an edge of a touched triangle (m²).
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

    /// Force of a patch on the grain, and its torque (N m).
    fn patch_force(&self, contact: &Contact, patch: &mut Patch) -> (PatchForce, Vec3) {
        let Self { model, grains, membrane, i, .. } = *self;
        let vertices = model.membrane.mesh.triangles[contact.triangle as usize];
        let mut membrane_velocity = Vec3::zeros();
        let mut mass = 0.0;
        for (vertex, &weight) in vertices.map(|v| v as usize).into_iter().zip(&contact.weights) {
            membrane_velocity += membrane.velocities[vertex] * weight;
            mass += model.membrane.masses[vertex] * weight;
        }
        // The contact point lies on the membrane, so both sides have the same lever arm.
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

    /// True if the center is on the outer side of all triangles that share the touched feature. All must
    /// agree, because around the vertex of a saddle surface the center is always on the outer side of some.
    fn is_outside(&self, contact: &Touched, from_membrane: &Vec3, touched: &[Touched]) -> bool {
        let triangles = &self.model.membrane.mesh.triangles;
        let is_on_outer_side = |triangle: u32| {
            let [a, b, c] =
                triangles[triangle as usize].map(|vertex| self.membrane.positions[vertex as usize]);
            (b - a).cross(&(c - a)).dot(from_membrane) > 0.0
        };
        // Most contacts are inside, and their own triangle suffices to decide that.
        if !is_on_outer_side(contact.triangle) {
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
            .all(|other| is_on_outer_side(other.triangle))
    }
}

/// Lists the triangles that the `s`-th grain near the membrane, with `radius` (m), overlaps; the deepest first.
fn touching(
    radius: Real,
    lists: &Neighbors,
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
        // Insertion sort from the end.
        touched.push(contact);
        let mut index = touched.len() - 1;
        while index > 0 && is_deeper(&touched[index - 1]) {
            touched[index] = touched[index - 1];
            index -= 1;
        }
        touched[index] = contact;
    }
}

/// True if no triangle that shares the contact's edge or vertex has a closer point, or the same point
/// with higher priority.
fn is_local_minimum(model: &Model, contact: &Touched, touched: &[Touched]) -> bool {
    let mesh = &model.membrane.mesh;
    let triangle = contact.triangle as usize;
    match contact.feature {
        Feature::Face => true,
        Feature::Edge(k) => {
            let neighbor = mesh.neighbors_of_triangle[triangle][usize::from(k)];
            let other = touched.iter().find(|it| it.triangle == neighbor);
            !other.is_some_and(|other| other.precedes(contact))
        }
        Feature::Vertex(k) => {
            let vertex = mesh.triangles[triangle][usize::from(k)];
            !touched.iter().any(|other| {
                mesh.triangles[other.triangle as usize].contains(&vertex)
                    && other.triangle != contact.triangle
                    && other.precedes(contact)
            })
        }
    }
}

/// The spring of the former patch with the most similar normal, zero if none is similar.
fn inherited_spring(before: &[Patch], normal: &Vec3) -> Vec3 {
    let mut best = (SAME_HISTORY, Vec3::zeros());
    for patch in before {
        let similarity = patch.normal.dot(normal);
        if similarity > best.0 {
            best = (similarity, patch.spring);
        }
    }
    best.1
}

impl Touched {
    /// True if this contact is closer than `other`, the contact of an adjacent triangle, or is the same point
    /// with higher priority.
    fn precedes(&self, other: &Self) -> bool {
        let difference = self.distance_squared - other.distance_squared;
        let tolerance = EQUAL * other.distance_squared;
        let (own, others) = (self.feature.priority(), other.feature.priority());
        difference < -tolerance
            || (difference <= tolerance
                && (own > others || (own == others && self.triangle < other.triangle)))
    }

    /// The ends of the edge, or the vertex, on which the contact lies; none on a face.
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
