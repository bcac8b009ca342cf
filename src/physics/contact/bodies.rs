//! Contacts between the membrane and rigid bodies.
//!
//! The membrane meets a body in material points of its own: every vertex, and the centroid of
//! every facet for what pokes through between vertices. A vertex with signed distance φ < 0 has the
//! overlap ξ = −φ; a centroid has only what its corners do not see already,
//! ξ = −φ − ⅓ Σ max(0, ξ_corner), so that the force grows from zero when a corner or an edge of
//! the body comes up between three vertices. The samples are fixed to the sheet, so their friction
//! springs need no hand-over. The law is the one of all other contacts; the effective radius is a
//! property of the body's model.

use super::law::{self, PairLaw, Touch};
use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Controls, Model,
        boundary::body::BodyMotion,
        membrane::MembraneState,
        model::{BodyModel, BodySurface},
        scratch::SampleForce,
        state::State,
    },
};

/// Forces of all bodies on all samples; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    controls: &Controls,
    state: &State,
    springs: &mut [Vec3],
    samples: &mut Vec<SampleForce>,
) {
    let mesh = &model.membrane.mesh;
    let n_samples = mesh.n_vertices() + mesh.triangles.len();
    samples.resize(n_samples * model.bodies.len(), SampleForce::NONE);
    let of_bodies = samples.chunks_mut(n_samples).zip(springs.chunks_mut(n_samples));
    for ((body, motion), (samples, springs)) in
        model.bodies.iter().zip(&controls.bodies).zip(of_bodies)
    {
        let contact = Contact { body, motion, dt: model.substep };
        let (of_vertices, of_facets) = samples.split_at_mut(mesh.n_vertices());
        let (vertex_springs, facet_springs) = springs.split_at_mut(mesh.n_vertices());
        parallel::for_each_of_two(of_vertices, vertex_springs, |v, sample, spring| {
            let point = SheetPoint::vertex(model, &state.membrane, v);
            *sample = contact.force(&point, spring);
        });
        let of_vertices = &*of_vertices;
        parallel::for_each_of_two(of_facets, facet_springs, |t, sample, spring| {
            let corners = mesh.triangles[t].map(|v| v as usize);
            let overlaps = corners.map(|v| of_vertices[v].overlap);
            // A facet further away than its own size cannot touch.
            if overlaps.iter().all(|&overlap| overlap < -model.membrane.longest_edge) {
                (sample.overlap, *spring) = (Real::NEG_INFINITY, Vec3::zeros());
                return;
            }
            let point = SheetPoint::facet(model, &state.membrane, corners, overlaps);
            *sample = contact.force(&point, spring);
        });
    }
}

/// A material point of the sheet.
struct SheetPoint {
    position: Vec3,
    velocity: Vec3,
    mass: Real,
    /// Overlap that the facet's corners see already [m].
    known_overlap: Real,
}

impl SheetPoint {
    fn vertex(model: &Model, sheet: &MembraneState, v: usize) -> Self {
        Self {
            position: sheet.positions[v],
            velocity: sheet.velocities[v],
            mass: model.membrane.masses[v],
            known_overlap: 0.0,
        }
    }

    fn facet(
        model: &Model,
        sheet: &MembraneState,
        corners: [usize; 3],
        overlaps: [Real; 3],
    ) -> Self {
        let [a, b, c] = corners;
        let masses = &model.membrane.masses;
        Self {
            position: (sheet.positions[a] + sheet.positions[b] + sheet.positions[c]) / 3.0,
            velocity: (sheet.velocities[a] + sheet.velocities[b] + sheet.velocities[c]) / 3.0,
            mass: (masses[a] + masses[b] + masses[c]) / 3.0,
            known_overlap: overlaps.map(|overlap| overlap.max(0.0)).iter().sum::<Real>() / 3.0,
        }
    }
}

struct Contact<'a> {
    body: &'a BodyModel,
    motion: &'a BodyMotion,
    dt: Real,
}

impl Contact<'_> {
    #[inline]
    fn force(&self, sheet: &SheetPoint, spring: &mut Vec3) -> SampleForce {
        let arm = sheet.position - self.motion.pose.translation.vector;
        let Some((distance, normal)) = self.distance(&arm) else {
            *spring = Vec3::zeros();
            return SampleForce::NONE;
        };
        let overlap = -distance - sheet.known_overlap;
        if overlap <= 0.0 {
            *spring = Vec3::zeros();
            return SampleForce { overlap, ..SampleForce::NONE };
        }
        let touch = Touch {
            overlap,
            normal,
            velocity: sheet.velocity - self.motion.twist.at(&arm),
            radius: self.body.contact_radius,
            mass: sheet.mass,
        };
        let law: &PairLaw = &self.body.law;
        let force = law::force(law, &touch, self.dt, spring);
        SampleForce {
            force: normal * force.normal + force.tangential,
            normal,
            point: sheet.position,
            overlap,
        }
    }

    /// Signed distance and outward normal in world axes, if the point is near at all.
    #[inline]
    fn distance(&self, arm: &Vec3) -> Option<(Real, Vec3)> {
        match &self.body.surface {
            BodySurface::HalfSpace => {
                let normal = self.motion.pose.rotation * Vec3::z();
                Some((normal.dot(arm), normal))
            }
            BodySurface::Shape(surface) => {
                if arm.norm_squared() >= self.body.reach_squared {
                    return None;
                }
                let local = self.motion.pose.rotation.inverse_transform_vector(arm);
                let signed = surface.distance(&local);
                Some((signed.distance, self.motion.pose.rotation * signed.normal))
            }
        }
    }
}
