//! Contact forces summed for those who are touched: each grain, each vertex, each body, the
//! flange. Every sum has a fixed order.

use crate::{
    base::{
        Vec3,
        real::{Twist, Wrench},
    },
    physics::{
        Controls, Model, Scratch,
        membrane::pressure,
        scratch::PairForce,
        state::{Grains, State},
    },
};

/// Force [N] and torque [N m] of all contacts on grain `i`.
#[inline]
pub fn on_grain(grains: &Grains, scratch: &Scratch, i: usize) -> (Vec3, Vec3) {
    let lists = &scratch.neighbours;
    let radius = grains.radii[i];
    let mut force = Vec3::zeros();
    let mut torque = Vec3::zeros();
    let lever = |pair: &PairForce| radius - pair.overlap / 2.0;
    for k in lists.first_starts[i] as usize..lists.first_starts[i + 1] as usize {
        let pair = &scratch.pair_forces[k];
        if pair.overlap > 0.0 {
            force += pair.force;
            torque -= pair.couple * lever(pair);
        }
    }
    for s in lists.second_starts[i] as usize..lists.second_starts[i + 1] as usize {
        let pair = &scratch.pair_forces[lists.second_pairs[s] as usize];
        if pair.overlap > 0.0 {
            force -= pair.force;
            torque -= pair.couple * lever(pair);
        }
    }
    let patches = &scratch.patch_forces[i];
    for patch in &patches.contacts[..patches.n] {
        force += patch.force;
    }
    torque += patches.torque;
    let plate = &scratch.plate_forces[i];
    if plate.normal > 0.0 {
        force += plate.force;
        torque += plate.arm.cross(&plate.force);
    }
    (force, torque)
}

/// Contact forces on the vertices, and the reactions on the bodies.
pub fn on_membrane(model: &Model, controls: &Controls, scratch: &mut Scratch) {
    let mesh = &model.membrane.mesh;
    let n_vertices = mesh.n_vertices();
    let Scratch { vertex_forces, patch_forces, sample_forces, body_wrenches, leaked, .. } = scratch;
    vertex_forces.clear();
    vertex_forces.resize(n_vertices, Vec3::zeros());
    for (grain, patches) in patch_forces.iter().enumerate() {
        if patches.n == 0 {
            continue;
        }
        if patches.is_outside && leaked.is_none() {
            *leaked = Some(grain);
        }
        for patch in &patches.contacts[..patches.n] {
            let corners = mesh.triangles[patch.triangle as usize];
            for (&vertex, &weight) in corners.iter().zip(&patch.weights) {
                vertex_forces[vertex as usize] -= patch.force * weight;
            }
        }
    }
    let n_samples = n_vertices + mesh.triangles.len();
    body_wrenches.clear();
    body_wrenches.resize(model.bodies.len(), Wrench::zero());
    for (s, sample) in sample_forces.iter().enumerate() {
        if sample.overlap <= 0.0 {
            continue;
        }
        let (body, sample_of_sheet) = (s / n_samples, s % n_samples);
        if sample_of_sheet < n_vertices {
            vertex_forces[sample_of_sheet] += sample.force;
        } else {
            for vertex in mesh.triangles[sample_of_sheet - n_vertices] {
                vertex_forces[vertex as usize] += sample.force / 3.0;
            }
        }
        let arm = sample.point - controls.bodies[body].pose.translation.vector;
        body_wrenches[body].force -= sample.force;
        body_wrenches[body].torque -= arm.cross(&sample.force);
    }
}

/// What bag and grains put on the flange: the plate's contacts, the clamped vertices' forces and
/// weight less what accelerates them, and the pressure on the plate.
pub fn on_flange(model: &Model, controls: &Controls, state: &State, scratch: &mut Scratch) {
    let origin = state.flange.translation.vector;
    let mut wrench = Wrench::zero();
    let mut add = |point: &Vec3, force: Vec3| {
        wrench.force += force;
        wrench.torque += (point - origin).cross(&force);
    };
    for (i, plate) in scratch.plate_forces.iter().enumerate() {
        if plate.normal > 0.0 {
            add(&(state.grains.positions[i] + plate.arm), -plate.force);
        }
    }
    let rim = &model.membrane.mesh.rim;
    for &vertex in rim {
        let v = vertex as usize;
        let force = scratch.membrane.forces[v] + scratch.vertex_forces[v];
        let gained = clamped_velocity(model, controls, v) - state.membrane.velocities[v];
        let own = model.gravity - gained / model.substep;
        add(&state.membrane.positions[v], force + own * model.membrane.masses[v]);
    }
    let positions = &state.membrane.positions;
    let lid = pressure::lid_area_vector(&model.membrane.mesh, positions);
    add(&pressure::lid_centre(&model.membrane.mesh, positions), lid * state.gauge);
    scratch.flange_wrench = wrench;
}

/// Where the flange holds vertex `v` at the end of this substep [m].
pub fn clamped_position(model: &Model, controls: &Controls, v: usize) -> Vec3 {
    controls.flange.rotation * model.clamped_positions[v] + controls.flange.translation.vector
}

/// Velocity of vertex `v` if the flange holds it [m/s].
fn clamped_velocity(model: &Model, controls: &Controls, v: usize) -> Vec3 {
    flange_velocity(controls, &clamped_position(model, controls, v))
}

/// Velocity of a point fixed to the flange [m/s].
pub fn flange_velocity(controls: &Controls, point: &Vec3) -> Vec3 {
    let twist: &Twist = &controls.flange_twist;
    twist.at(&(point - controls.flange.translation.vector))
}
