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
        model::{BodyModel, BodySurface},
        scratch::SampleForce,
        state::State,
    },
};

/// Forces of all bodies on all samples; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    controls: &Controls,
    state: &mut State,
    samples: &mut Vec<SampleForce>,
) {
    let n_vertices = model.membrane.mesh.n_vertices();
    let n_samples = n_vertices + model.membrane.mesh.triangles.len();
    samples.resize(n_samples * model.bodies.len(), SampleForce::default());
    let State { membrane, body_springs, .. } = state;
    for (b, (body, motion)) in model.bodies.iter().zip(&controls.bodies).enumerate() {
        let here = b * n_samples..(b + 1) * n_samples;
        let (of_vertices, of_facets) = samples[here.clone()].split_at_mut(n_vertices);
        let (vertex_springs, facet_springs) = body_springs[here].split_at_mut(n_vertices);
        let contact = Contact { body, motion, dt: model.substep };
        parallel::for_each_of_two(of_vertices, vertex_springs, |v, sample, spring| {
            let touch = SheetPoint {
                position: membrane.positions[v],
                velocity: membrane.velocities[v],
                mass: model.membrane.masses[v],
                known_overlap: 0.0,
            };
            *sample = contact.force(&touch, spring);
        });
        let of_vertices = &*of_vertices;
        parallel::for_each_of_two(of_facets, facet_springs, |t, sample, spring| {
            let corners = model.membrane.mesh.triangles[t].map(|v| v as usize);
            let mean = |of: &dyn Fn(usize) -> Vec3| {
                (of(corners[0]) + of(corners[1]) + of(corners[2])) / 3.0
            };
            let known: Real = corners.iter().map(|&v| of_vertices[v].overlap).sum();
            let touch = SheetPoint {
                position: mean(&|v| membrane.positions[v]),
                velocity: mean(&|v| membrane.velocities[v]),
                mass: corners.iter().map(|&v| model.membrane.masses[v]).sum::<Real>() / 3.0,
                known_overlap: known / 3.0,
            };
            *sample = contact.force(&touch, spring);
        });
    }
}

/// A material point of the sheet.
struct SheetPoint {
    position: Vec3,
    velocity: Vec3,
    mass: Real,
    known_overlap: Real,
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
            return SampleForce::default();
        };
        let overlap = -distance - sheet.known_overlap;
        if overlap <= 0.0 {
            *spring = Vec3::zeros();
            return SampleForce::default();
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

    /// Signed distance and outward normal in world axes, if the point can be inside at all.
    #[inline]
    fn distance(&self, arm: &Vec3) -> Option<(Real, Vec3)> {
        match &self.body.surface {
            BodySurface::HalfSpace => {
                let normal = self.motion.pose.rotation * Vec3::z();
                Some((normal.dot(arm), normal))
            }
            BodySurface::Shape(surface) => {
                if arm.norm_squared() >= self.body.bounding_radius.powi(2) {
                    return None;
                }
                let local = self.motion.pose.rotation.inverse_transform_vector(arm);
                let signed = surface.distance(&local);
                Some((signed.distance, self.motion.pose.rotation * signed.normal))
            }
        }
    }
}
