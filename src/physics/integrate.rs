//! Integrates the motion of grains and membrane with the semi-implicit Euler method.
//!
//! ```text
//! v ← v + dt F/m + g dt + a,   x ← x + v dt,   ω ← ω + dt τ / (2/5 m R²)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | x, v, ω | position, velocity, angular velocity | m, m/s, rad/s |
//! | F, τ, m, R | force, torque, mass, radius | N, N m, kg, m |
//! | g | gravity | m/s² |
//! | a | velocity gained with the carrier under density scaling, else 0 | m/s |
//!
//! The method is symplectic; its energy error is of second order in dt. Vertices held by a wall
//! follow the wall instead.

use super::{
    Controls, Model, Scratch, State,
    boundary::wall::CARRIER,
    contact::sums::{self, PairSums},
    membrane::{FREE, MembraneState},
    state::Grains,
};
use crate::base::{
    Real, Vec3, lanes,
    parallel::{self, PART},
};

/// Advances grains and membrane by one substep.
pub fn advance(model: &Model, controls: &Controls, scratch: &mut Scratch, state: &mut State) {
    let target = carrier_target(controls);
    let carrier = CarrierMotion {
        gain: model.gravity * model.substep + velocity_gained_with_carrier(model, controls, state),
        step: target - state.carrier_position(),
        since_build: target - scratch.neighbors.carrier_position,
    };
    let grains = advance_grains(model, scratch, state, &carrier);
    let vertices = advance_membrane(model, controls, scratch, state, &carrier);
    let lists = &mut scratch.neighbors;
    lists.displacement_squared_max = grains[0].max(vertices[0]);
    lists.travel += grains[1].sqrt() + vertices[1].sqrt();
    lists.vertex_travel += vertices[1].sqrt();
    state.walls.clone_from(&controls.walls);
}

/// Position of the carrier at the end of this substep (m).
fn carrier_target(controls: &Controls) -> Vec3 {
    controls.walls.get(CARRIER).map_or_else(Vec3::zeros, |it| it.pose.translation.vector)
}

/// Velocity that grains and free vertices gain with the carrier in this substep (m/s). With density
/// scaling they have more inertia than the real ones, and this makes them follow the carrier as the real ones
/// do; see `cosim::compile::density_scaling`.
fn velocity_gained_with_carrier(model: &Model, controls: &Controls, state: &State) -> Vec3 {
    let gained = match (controls.walls.get(CARRIER), state.walls.get(CARRIER)) {
        (Some(to), Some(from)) => to.twist.linear - from.twist.linear,
        _ => Vec3::zeros(),
    };
    gained * (1.0 - model.density_scaling.recip())
}

/// Effect of gravity and of the carrier's motion on all grains and free vertices.
struct CarrierMotion {
    /// Velocity that grains and free vertices gain (m/s).
    gain: Vec3,
    /// Displacement of the carrier in this substep (m).
    step: Vec3,
    /// Displacement of the carrier since the lists were built (m).
    since_build: Vec3,
}

impl CarrierMotion {
    /// Updates `furthest`, the largest squared displacements relative to the carrier (m²): since the lists
    /// were built, and in this substep. NaN counts as the largest.
    #[inline(always)]
    fn record_displacement(
        &self,
        built: &Vec3,
        before: &Vec3,
        now: &Vec3,
        furthest: &mut [Real; 2],
    ) {
        let since_build = (now - built - self.since_build).norm_squared();
        let step = (now - before - self.step).norm_squared();
        // The bits of non-negative doubles are ordered like the numbers.
        for (furthest, new) in furthest.iter_mut().zip([since_build, step]) {
            *furthest = Real::from_bits(furthest.to_bits().max(new.to_bits()));
        }
    }
}

/// Advances the grains. Returns the largest squared displacements (m²), see `record_displacement`.
fn advance_grains(
    model: &Model,
    scratch: &Scratch,
    state: &mut State,
    carrier: &CarrierMotion,
) -> [Real; 2] {
    let dt = model.substep;
    let Grains { positions, velocities, angular_velocities, radii, masses } = &mut state.grains;
    let (radii, masses) = (&*radii, &*masses);
    parallel::largest_of_three(
        positions,
        velocities,
        angular_velocities,
        |start, positions, velocities, angular_velocities| {
            let mut sums = [[0.0; 8]; PART];
            let sums = &mut sums[..positions.len()];
            lanes::widest(PairSums { scratch, radii, first: start, sums });
            let mut furthest = [0.0; 2];
            for (k, of_pairs) in sums.iter().enumerate() {
                let i = start + k;
                let (force, torque) = sums::add_other_contacts(scratch, i, of_pairs);
                let (mass, radius) = (masses[i], radii[i]);
                let (before, velocity) = (positions[k], &mut velocities[k]);
                *velocity += force * (dt / mass) + carrier.gain;
                angular_velocities[k] += torque * (dt / (0.4 * mass * radius * radius));
                positions[k] += *velocity * dt;
                let built = &scratch.neighbors.grain_positions[i];
                carrier.record_displacement(built, &before, &positions[k], &mut furthest);
            }
            furthest
        },
    )
}

/// Advances the vertices. Returns the largest squared displacements (m²), see `record_displacement`.
fn advance_membrane(
    model: &Model,
    controls: &Controls,
    scratch: &Scratch,
    state: &mut State,
    carrier: &CarrierMotion,
) -> [Real; 2] {
    let dt = model.substep;
    let MembraneState { positions, velocities } = &mut state.membrane;
    let mut unused = vec![(); positions.len()];
    parallel::largest_of_three(
        positions,
        velocities,
        &mut unused,
        |start, positions, velocities, _| {
            let mut furthest = [0.0; 2];
            for (k, (position, velocity)) in positions.iter_mut().zip(velocities).enumerate() {
                let (v, before) = (start + k, *position);
                let holder = model.membrane.holders[v];
                if holder != FREE {
                    let wall = &controls.walls[holder as usize];
                    *position = sums::held_position(model, wall, v);
                    *velocity = sums::wall_velocity(wall, position);
                } else {
                    let force = scratch.membrane.forces[v] + scratch.vertex_forces[v];
                    *velocity += force * (dt / model.membrane.masses[v]) + carrier.gain;
                    *position += *velocity * dt;
                }
                let built = &scratch.neighbors.vertex_positions[v];
                carrier.record_displacement(built, &before, position, &mut furthest);
            }
            furthest
        },
    )
}
