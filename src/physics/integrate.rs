//! Motion: semi-implicit Euler, v += a dt and then x += v dt, second order in energy.

use super::{Controls, Model, Scratch, State, contact::sums, membrane::MembraneState};
use crate::base::{Real, Vec3, parallel};

/// Moves grains and membrane on by one substep.
pub fn advance(model: &Model, controls: &Controls, scratch: &mut Scratch, state: &mut State) {
    let carried = controls.flange.translation.vector - scratch.neighbours.flange_position;
    let grains = advance_grains(model, scratch, state, &carried);
    let vertices = advance_membrane(model, controls, scratch, state, &carried);
    scratch.neighbours.displacement_squared_max = grains.max(vertices);
    state.flange = controls.flange;
    state.flange_twist = controls.flange_twist;
}

/// Returns the largest squared displacement since the lists were built [m²].
fn advance_grains(model: &Model, scratch: &Scratch, state: &mut State, carried: &Vec3) -> Real {
    let dt = model.substep;
    let mut positions = std::mem::take(&mut state.grains.positions);
    let mut velocities = std::mem::take(&mut state.grains.velocities);
    let mut spins = std::mem::take(&mut state.grains.spins);
    let grains = &state.grains;
    let furthest = parallel::largest_of_three(
        &mut positions,
        &mut velocities,
        &mut spins,
        |i, position, velocity, spin| {
            let (force, torque) = sums::on_grain(grains, scratch, i);
            let (mass, radius) = (grains.masses[i], grains.radii[i]);
            *velocity += force * (dt / mass) + model.gravity * dt;
            *spin += torque * (dt / (0.4 * mass * radius * radius));
            *position += *velocity * dt;
            (*position - scratch.neighbours.grain_positions[i] - carried).norm_squared()
        },
    );
    state.grains.positions = positions;
    state.grains.velocities = velocities;
    state.grains.spins = spins;
    furthest
}

/// Returns the largest squared displacement since the lists were built [m²].
fn advance_membrane(
    model: &Model,
    controls: &Controls,
    scratch: &Scratch,
    state: &mut State,
    carried: &Vec3,
) -> Real {
    let dt = model.substep;
    let MembraneState { positions, velocities } = &mut state.membrane;
    let mut unused = vec![(); positions.len()];
    parallel::largest_of_three(positions, velocities, &mut unused, |v, position, velocity, ()| {
        if model.is_held || model.membrane.is_clamped[v] {
            *position = sums::clamped_position(model, controls, v);
            *velocity = sums::flange_velocity(controls, position);
        } else {
            let force = scratch.membrane.forces[v] + scratch.vertex_forces[v];
            *velocity += force * (dt / model.membrane.masses[v]) + model.gravity * dt;
            *position += *velocity * dt;
        }
        (*position - scratch.neighbours.vertex_positions[v] - carried).norm_squared()
    })
}
