//! Contacts between the membrane and rigid bodies.
//!
//! ```text
//! ξ = −φ                             at a vertex
//! ξ = −φ − 1/3 Σ max(0, ξ_corner)    at the centroid of a facet
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | φ | signed distance of the sample from the body, negative inside | m |
//! | ξ | overlap of the sample | m |
//!
//! The membrane touches a body at sample points that are fixed to the membrane: every vertex, and the
//! centroid of every facet, which detects corners and edges of the body between vertices. A centroid has
//! only the overlap that its corners do not have, so its force increases from zero when a body's corner or
//! edge moves in between three vertices. Because the samples are fixed to the membrane, friction springs
//! stay with them. The contact law is that of the other contacts, without cohesion; the effective radius is a
//! property of the body's model.
//!
//! Source: none; penalty contacts at vertices are standard, the centroids were added for jamgrip. Valid for
//! bodies whose features are not much smaller than the facets.

use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Controls, Model,
        boundary::body::BodyMotion,
        law::{self, ContactState},
        membrane::MembraneState,
        model::{BodyModel, BodySurface},
        scratch::{BodyLists, ContactFlags, NearSamples, SampleForce},
    },
};

/// Computes the forces of all bodies on the samples near them, and updates their springs by one substep.
pub fn forces(
    model: &Model,
    controls: &Controls,
    membrane: &MembraneState,
    springs: &mut [Vec3],
    (lists, samples): (&BodyLists, &mut [SampleForce]),
) {
    let mesh = &model.membrane.mesh;
    let n_samples = mesh.n_vertices() + mesh.triangles.len();
    if samples.is_empty() {
        return;
    }
    let of_bodies = samples.chunks_mut(n_samples).zip(springs.chunks_mut(n_samples));
    let bodies = model.bodies.iter().zip(&controls.bodies).zip(&lists.near);
    for (((body, motion), near), (samples, springs)) in bodies.zip(of_bodies) {
        let contact = Contact { body, motion, dt: model.substep };
        let (of_vertices, of_facets) = samples.split_at_mut(mesh.n_vertices());
        let (vertex_springs, facet_springs) = springs.split_at_mut(mesh.n_vertices());
        let NearSamples { vertices, facets } = near;
        parallel::for_listed_of_two(vertices, of_vertices, vertex_springs, |k, sample, spring| {
            let point = MembranePoint::vertex(model, membrane, vertices[k] as usize);
            *sample = contact.force(&point, spring);
        });
        let of_vertices = &*of_vertices;
        parallel::for_listed_of_two(facets, of_facets, facet_springs, |k, sample, spring| {
            let corners = mesh.triangles[facets[k] as usize].map(|v| v as usize);
            let overlaps = corners.map(|v| of_vertices[v].overlap);
            let point = MembranePoint::facet(model, membrane, corners, overlaps);
            *sample = contact.force(&point, spring);
        });
    }
}

/// A material point of the membrane.
struct MembranePoint {
    position: Vec3,
    velocity: Vec3,
    mass: Real,
    /// Mean overlap of the facet's corners (m), 0 for a vertex.
    corner_overlap: Real,
}

impl MembranePoint {
    fn vertex(model: &Model, membrane: &MembraneState, v: usize) -> Self {
        Self {
            position: membrane.positions[v],
            velocity: membrane.velocities[v],
            mass: model.membrane.masses[v],
            corner_overlap: 0.0,
        }
    }

    fn facet(
        model: &Model,
        membrane: &MembraneState,
        corners: [usize; 3],
        overlaps: [Real; 3],
    ) -> Self {
        let [a, b, c] = corners;
        let masses = &model.membrane.masses;
        Self {
            position: (membrane.positions[a] + membrane.positions[b] + membrane.positions[c]) / 3.0,
            velocity: (membrane.velocities[a] + membrane.velocities[b] + membrane.velocities[c])
                / 3.0,
            mass: (masses[a] + masses[b] + masses[c]) / 3.0,
            corner_overlap: overlaps.map(|overlap| overlap.max(0.0)).iter().sum::<Real>() / 3.0,
        }
    }
}

/// Contacts of one body.
struct Contact<'a> {
    body: &'a BodyModel,
    motion: &'a BodyMotion,
    dt: Real,
}

impl Contact<'_> {
    #[inline(always)]
    fn force(&self, membrane: &MembranePoint, spring: &mut Vec3) -> SampleForce {
        let arm = membrane.position - self.motion.pose.translation.vector;
        let beyond = arm.norm() - self.body.bounding_radius;
        if beyond > 0.0 {
            *spring = Vec3::zeros();
            return SampleForce { overlap: -beyond, ..SampleForce::NONE };
        }
        let (distance, normal) = signed_distance(self.body, self.motion, &arm);
        let overlap = -distance - membrane.corner_overlap;
        if overlap <= 0.0 {
            *spring = Vec3::zeros();
            return SampleForce { overlap, ..SampleForce::NONE };
        }
        let contact = ContactState {
            touches: true,
            overlap,
            normal: normal.into(),
            velocity: (membrane.velocity - self.motion.twist.at(&arm)).into(),
            radius: self.body.contact_radius,
            mass: membrane.mass,
        };
        let force = law::scalar(&self.body.law, &contact, self.dt, spring);
        SampleForce {
            force: normal * force.normal + force.tangential,
            normal,
            point: membrane.position,
            overlap,
            flags: ContactFlags::contact(force.slides),
        }
    }
}

/// Signed distance (m) of the point at `arm` (m) from the origin of `body`, and the outward unit normal, world
/// axes.
#[inline]
pub fn signed_distance(body: &BodyModel, motion: &BodyMotion, arm: &Vec3) -> (Real, Vec3) {
    match &body.surface {
        BodySurface::HalfSpace => {
            let normal = motion.pose.rotation * Vec3::z();
            (normal.dot(arm), normal)
        }
        BodySurface::Shape(surface) => {
            let local = motion.pose.rotation.inverse_transform_vector(arm);
            let signed = surface.distance(&local);
            (signed.distance, motion.pose.rotation * signed.normal)
        }
    }
}
