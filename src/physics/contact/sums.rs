//! Sums of contact forces on grains, vertices, bodies and walls, each in a fixed order.

use crate::{
    base::{
        Real, Vec3,
        lanes::{self, Kernel, Lanes},
        real::Wrench,
    },
    physics::{
        Controls, Model, Scratch,
        boundary::body::BodyMotion,
        membrane::{FREE, pressure},
        scratch::SampleForce,
        state::{Grains, State},
    },
};

/// Force (N) and torque (N m) of all contacts on grain `i`.
pub fn on_grain(grains: &Grains, scratch: &Scratch, i: usize) -> (Vec3, Vec3) {
    let mut sum = [[0.0; 8]];
    lanes::widest(PairSums { scratch, radii: &grains.radii, first: i, sums: &mut sum });
    add_other_contacts(scratch, i, &sum[0])
}

/// Sums over the pairs of each grain from `first` on: force, torque, and two unused numbers.
pub struct PairSums<'a> {
    /// Contact forces of this substep.
    pub scratch: &'a Scratch,
    /// Radii of all grains (m).
    pub radii: &'a [Real],
    /// Index of the first grain.
    pub first: usize,
    /// One row per grain: force (N), torque (N m).
    pub sums: &'a mut [[Real; 8]],
}

impl Kernel for PairSums<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let lists = &self.scratch.neighbors;
        let rows: &[[Real; 8]] = bytemuck::cast_slice(&self.scratch.pair_forces);
        // Hidden from the optimizer, which would otherwise turn each row into an addition and a dependent
        // subtraction.
        let reversed = std::hint::black_box(-1.0);
        for (i, result) in (self.first..).zip(self.sums) {
            let mut sum = [0.0; 8];
            let radius = self.radii[i];
            // The row of a pair without contact is zero: adding it is cheaper than a branch.
            let first = lists.first_starts[i] as usize..lists.first_starts[i + 1] as usize;
            for row in &rows[first] {
                sum = add_row(sum, row, 1.0, radius);
            }
            let second = lists.second_starts[i] as usize..lists.second_starts[i + 1] as usize;
            for &k in &lists.second_pairs[second] {
                sum = add_row(sum, &rows[k as usize], reversed, radius);
            }
            *result = sum;
        }
    }
}

/// Adds a row of `PairForce` to force and torque of a grain with `radius` (m).
#[inline(always)]
fn add_row(sum: [Real; 8], row: &[Real; 8], sign: Real, radius: Real) -> [Real; 8] {
    let lever = row[6] / 2.0 - radius;
    let factors = [sign, sign, sign, lever, lever, lever, 0.0, 0.0];
    std::array::from_fn(|c| sum[c] + row[c] * factors[c])
}

/// Adds the contacts with membrane, spheres and walls to the sum over the pairs of grain `i`. Returns force (N)
/// and torque (N m).
#[inline(always)]
pub fn add_other_contacts(scratch: &Scratch, i: usize, of_pairs: &[Real; 8]) -> (Vec3, Vec3) {
    let lists = &scratch.neighbors;
    let mut force = Vec3::new(of_pairs[0], of_pairs[1], of_pairs[2]);
    let mut torque = Vec3::new(of_pairs[3], of_pairs[4], of_pairs[5]);
    if lists.triangle_starts[i] < lists.triangle_starts[i + 1] {
        let patches = &scratch.patch_forces[i];
        for patch in &patches.contacts[..patches.n] {
            force += patch.force;
        }
        torque += patches.torque;
    }
    let spheres = lists.sphere_starts[i] as usize..lists.sphere_starts[i + 1] as usize;
    for sphere in &scratch.sphere_forces[spheres] {
        if sphere.flags.touches() {
            force += sphere.force;
            torque += sphere.torque;
        }
    }
    let walls = lists.wall_starts[i] as usize..lists.wall_starts[i + 1] as usize;
    for &k in &lists.wall_contacts[walls] {
        let wall = &scratch.wall_forces[k as usize];
        if wall.flags.touches() {
            force += wall.force;
            torque += wall.arm.cross(&wall.force);
        }
    }
    if !scratch.surface_contacts.is_empty() {
        let entries =
            lists.surfaces.grain_starts[i] as usize..lists.surfaces.grain_starts[i + 1] as usize;
        for &k in &lists.surfaces.by_grain[entries] {
            for contact in &scratch.surface_contacts[k as usize] {
                if contact.force.flags.touches() {
                    force += contact.force.force;
                    torque += contact.force.arm.cross(&contact.force.force);
                }
            }
        }
    }
    (force, torque)
}

/// Sums the contact forces on each vertex, and the reactions on each body. Records grains outside the membrane.
pub fn on_membrane(model: &Model, controls: &Controls, scratch: &mut Scratch) {
    let mesh = &model.membrane.mesh;
    let n_vertices = mesh.n_vertices();
    let Scratch { neighbors, vertex_forces, patch_forces, sphere_forces, .. } = scratch;
    let Scratch { sample_forces, body_wrenches, leaked, .. } = scratch;
    vertex_forces.clear();
    vertex_forces.resize(n_vertices, Vec3::zeros());
    for sphere in sphere_forces.iter().filter(|it| it.flags.touches()) {
        vertex_forces[sphere.vertex as usize] -= sphere.force;
    }
    for &grain in &neighbors.membrane_grains {
        let grain = grain as usize;
        let patches = &patch_forces[grain];
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
    for (body, near) in neighbors.bodies.near.iter().enumerate() {
        let origin = controls.bodies[body].pose.translation.vector;
        let samples = &sample_forces[body * n_samples..(body + 1) * n_samples];
        let mut react = |sample: &SampleForce| {
            body_wrenches[body].force -= sample.force;
            body_wrenches[body].torque -= (sample.point - origin).cross(&sample.force);
        };
        for &v in &near.vertices {
            let sample = &samples[v as usize];
            if sample.flags.touches() {
                vertex_forces[v as usize] += sample.force;
                react(sample);
            }
        }
        for &t in &near.facets {
            let sample = &samples[n_vertices + t as usize];
            if sample.flags.touches() {
                for vertex in mesh.triangles[t as usize] {
                    vertex_forces[vertex as usize] += sample.force / 3.0;
                }
                react(sample);
            }
        }
    }
}

/// Sums the wrench on each wall: contact forces of grains, forces and weight of held vertices minus what
/// accelerates them, and the pressure on the lids of held rims.
pub fn on_walls(model: &Model, controls: &Controls, state: &State, scratch: &mut Scratch) {
    let mesh = &model.membrane.mesh;
    let Scratch { wall_wrenches, wall_forces, membrane, vertex_forces, .. } = scratch;
    wall_wrenches.clear();
    wall_wrenches.resize(model.walls.len(), Wrench::zero());
    let mut add = |wall: usize, point: &Vec3, force: Vec3| {
        wall_wrenches[wall].force += force;
        let arm = point - state.walls[wall].pose.translation.vector;
        wall_wrenches[wall].torque += arm.cross(&force);
    };
    for (contact, ids) in wall_forces.iter().zip(&state.springs.walls.ids) {
        if contact.flags.touches() {
            let [w, i] = ids.map(|id| id as usize);
            add(w, &(state.grains.positions[i] + contact.arm), -contact.force);
        }
    }
    for (v, &holder) in model.membrane.holders.iter().enumerate().filter(|(_, it)| **it != FREE) {
        let wall = &controls.walls[holder as usize];
        let force = membrane.forces[v] + vertex_forces[v];
        let velocity = wall_velocity(wall, &held_position(model, wall, v));
        let change = velocity - state.membrane.velocities[v];
        let own = model.gravity - change / (model.substep * model.density_scaling);
        let position = &state.membrane.positions[v];
        add(holder as usize, position, force + own * model.membrane.masses[v]);
    }
    let positions = &state.membrane.positions;
    for rim in &mesh.rims {
        let holder = model.membrane.holders[rim[0] as usize];
        if holder != FREE {
            let lid = pressure::lid_area_vector(rim, positions);
            add(holder as usize, &pressure::lid_center(rim, positions), lid * state.gauge);
        }
    }
}

/// Position at which `wall` holds vertex `v` (m).
pub fn held_position(model: &Model, wall: &BodyMotion, v: usize) -> Vec3 {
    wall.pose.rotation * model.held_positions[v] + wall.pose.translation.vector
}

/// Velocity (m/s) of the material point of `wall` at `point` (m).
pub fn wall_velocity(wall: &BodyMotion, point: &Vec3) -> Vec3 {
    wall.twist.at(&(point - wall.pose.translation.vector))
}
