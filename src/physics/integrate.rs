//! Motion: semi-implicit Euler, v += a dt and then x += v dt, second order in energy.

use rayon::prelude::*;

use super::{Controls, Model, Scratch, State, contact::sums};
use crate::base::{Real, Vec3};

/// Elements a thread takes at a time.
const CHUNK: usize = 128;

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
    let furthest = positions
        .par_chunks_mut(CHUNK)
        .zip(velocities.par_chunks_mut(CHUNK))
        .zip(spins.par_chunks_mut(CHUNK))
        .enumerate()
        .map(|(chunk, ((positions, velocities), spins))| {
            let mut furthest: Real = 0.0;
            for k in 0..positions.len() {
                let i = chunk * CHUNK + k;
                let (force, torque) = sums::on_grain(state, scratch, i);
                let (mass, radius) = (state.grains.masses[i], state.grains.radii[i]);
                velocities[k] += (force / mass + model.gravity) * dt;
                positions[k] += velocities[k] * dt;
                spins[k] += torque * (dt / (0.4 * mass * radius * radius));
                let moved = positions[k] - scratch.neighbours.grain_positions[i] - carried;
                furthest = furthest.max(moved.norm_squared());
            }
            furthest
        })
        .reduce(|| 0.0, Real::max);
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
    let membrane = &mut state.membrane;
    membrane
        .positions
        .par_chunks_mut(CHUNK)
        .zip(membrane.velocities.par_chunks_mut(CHUNK))
        .enumerate()
        .map(|(chunk, (positions, velocities))| {
            let mut furthest: Real = 0.0;
            for k in 0..positions.len() {
                let v = chunk * CHUNK + k;
                if model.is_held || model.membrane.is_clamped[v] {
                    positions[k] = sums::clamped_position(model, controls, v);
                    velocities[k] = sums::flange_velocity(controls, &positions[k]);
                } else {
                    let force = scratch.membrane.forces[v] + scratch.vertex_forces[v];
                    velocities[k] += (force / model.membrane.masses[v] + model.gravity) * dt;
                    positions[k] += velocities[k] * dt;
                }
                let moved = positions[k] - scratch.neighbours.vertex_positions[v] - carried;
                furthest = furthest.max(moved.norm_squared());
            }
            furthest
        })
        .reduce(|| 0.0, Real::max)
}
