//! Tests of the membrane against lattice elasticity, plate theory, Laplace's law and conservation laws.

mod mesh;
mod stretching;
mod bending;
mod inflation;
mod motion;

use super::mesh::{Mesh, MeshError};
use super::{FREE, MembraneMaterial, MembraneModel, MembraneScratch, MembraneState, forces};
use crate::base::random::{Random, Stream};
use crate::base::{Real, Vec3};

/// Rubber of the gripper's membrane, with these bending constants.
fn rubber(bending_stiffness: Real, bending_damping: Real) -> MembraneMaterial {
    MembraneMaterial {
        thickness: 0.3e-3,
        youngs_modulus: 1.25e6,
        density: 2000.0,
        spring_damping: 0.3,
        bending_stiffness,
        bending_damping,
    }
}

fn model_of(mesh: Result<Mesh, MeshError>, material: MembraneMaterial) -> MembraneModel {
    MembraneModel::new(mesh.unwrap(), material)
}

fn shaken(model: &MembraneModel, distance: Real, speed: Real) -> MembraneState {
    let mut random = Random::new(7, Stream::Position);
    let mut draw = |size: Real| Vec3::from_fn(|_, _| random.between(-size, size));
    let mut state = MembraneState::at_rest(&model.mesh);
    for (position, velocity) in state.positions.iter_mut().zip(&mut state.velocities) {
        *position += draw(distance);
        *velocity = draw(speed);
    }
    state
}

fn forces_on(model: &MembraneModel, state: &MembraneState, gauge_pressure: Real) -> Vec<Vec3> {
    let mut scratch = MembraneScratch::new(model);
    forces(model, state, gauge_pressure, &mut scratch);
    scratch.forces
}

fn power(forces: &[Vec3], velocities: &[Vec3]) -> Real {
    forces.iter().zip(velocities).map(|(f, v)| f.dot(v)).sum()
}

/// Norm of the sum of forces, norm of the sum of torques about the origin, and sum of the norms of forces.
fn totals(state: &MembraneState, forces: &[Vec3]) -> (Real, Real, Real) {
    let force: Vec3 = forces.iter().sum();
    let torque: Vec3 = state.positions.iter().zip(forces).map(|(r, f)| r.cross(f)).sum();
    (force.norm(), torque.norm(), forces.iter().map(|f| f.norm()).sum())
}

/// Integrates the membrane with the semi-implicit Euler method. Returns the largest speed at the end (m/s).
fn run(model: &MembraneModel, state: &mut MembraneState, dt: Real, steps: usize, p: Real) -> Real {
    let mut scratch = MembraneScratch::new(model);
    for _ in 0..steps {
        forces(model, state, p, &mut scratch);
        for v in (0..model.mesh.n_vertices()).filter(|&v| model.holders[v] == FREE) {
            state.velocities[v] += scratch.forces[v] * (dt / model.masses[v]);
            state.positions[v] += state.velocities[v] * dt;
        }
    }
    // Unlike `Real::max`, this propagates NaN.
    let larger = |a: Real, b: Real| if b > a || b.is_nan() { b } else { a };
    state.velocities.iter().map(|v| v.norm()).fold(0.0, larger)
}
