//! Contacts between grains and spheres around the membrane's vertices: the classic mass–spring
//! membrane, for comparison with contacts on triangles.
//!
//! ```text
//! ξ = R + r − |x − x_v|,   n = (x − x_v) / |x − x_v|,   R* = R r / (R + r),   m* = m m_v / (m + m_v)
//! b = −(R − ξ/2) n,        v = ẋ + ω × b − ẋ_v,         force on the vertex −F,   torque b × F
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | R, m, x, ω | radius, mass, center and angular velocity of the grain | m, kg, m, rad/s |
//! | r, m_v, x_v | radius of the spheres, mass and position of the vertex | m, kg, m |
//! | b | from the grain's center to the contact point | m |
//! | ξ, n, v | overlap, normal from sphere to grain, relative velocity | m, –, m/s |
//! | R*, m* | effective radius and mass | m, kg |
//! | F | force of the contact law on the grain | N |
//!
//! Source: Götz (2024), section 3.3, "MFS Partikel", after de Bono, McDowell & Wanatowski (2012);
//! springs, hinges and pressure are those of the triangle membrane. A vertex has a position but no
//! orientation, so its sphere does not rotate: the couple −(r − ξ/2) n × F, which would rotate it,
//! has no effect. The source does not specify whether spheres rotate; a rotating sphere would roll
//! under the grain and transmit almost no friction. Spheres do not touch each other: the springs
//! determine their distances.
//!
//! Valid while the gaps between the spheres are smaller than the grains. Grains that slip through
//! are detected by `neighbors::crossings`.

use crate::{
    base::{Real, Vec3, parallel},
    physics::{
        Model,
        law::{self, ContactState},
        membrane::{MembraneContact, MembraneState},
        scratch::{ContactFlags, SphereForce},
        state::{Grains, ListedSprings},
    },
};

/// Computes the forces of all listed vertex spheres on grains, and updates their springs by one substep.
pub fn forces(
    model: &Model,
    grains: &Grains,
    membrane: &MembraneState,
    listed: &mut ListedSprings,
    forces: &mut Vec<SphereForce>,
) {
    forces.resize(listed.ids.len(), SphereForce::default());
    let MembraneContact::Spheres { radius } = model.membrane.contact else { return };
    let ListedSprings { ids, springs, .. } = listed;
    parallel::for_each_of_two(forces, springs, |k, force, spring| {
        let [grain, vertex] = ids[k].map(|id| id as usize);
        *force = SphereForce { vertex: ids[k][1], ..SphereForce::default() };
        let pair = Pair { model, grains, membrane, grain, vertex, radius };
        pair.force(force, spring);
    });
}

/// A grain and a vertex sphere that it may touch.
struct Pair<'a> {
    model: &'a Model,
    grains: &'a Grains,
    membrane: &'a MembraneState,
    grain: usize,
    vertex: usize,
    radius: Real,
}

impl Pair<'_> {
    #[inline(always)]
    fn force(&self, result: &mut SphereForce, spring: &mut Vec3) {
        let &Self { model, grains, membrane, grain, vertex, radius } = self;
        let separation = grains.positions[grain] - membrane.positions[vertex];
        let reach = grains.radii[grain] + radius;
        let distance_squared = separation.norm_squared();
        if distance_squared >= reach * reach || distance_squared == 0.0 {
            *spring = Vec3::zeros();
            return;
        }
        let distance = distance_squared.sqrt();
        let overlap = reach - distance;
        let normal = separation * distance.recip();
        let arm = normal * -(grains.radii[grain] - overlap / 2.0);
        let velocity = grains.velocities[grain] + grains.angular_velocities[grain].cross(&arm)
            - membrane.velocities[vertex];
        let parallel = |a: Real, b: Real| a * b / (a + b);
        let contact = ContactState {
            touches: true,
            overlap,
            normal: normal.into(),
            velocity: velocity.into(),
            radius: parallel(grains.radii[grain], radius),
            mass: parallel(grains.masses[grain], model.membrane.masses[vertex]),
        };
        let force = law::scalar(&model.membrane_law, &contact, model.substep, spring);
        result.force = normal * force.normal + force.tangential;
        result.torque = arm.cross(&force.tangential);
        result.overlap = overlap;
        result.normal = force.normal;
        result.flags = ContactFlags::contact(force.slides);
    }
}
