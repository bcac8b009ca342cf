//! Tests of the complete membrane: conservation, dissipation, threads, and the longest stable substep.

use super::super::critical_step::{critical_step, critical_step_at};
use super::super::mesh::Mesh;
use super::super::{MembraneMaterial, stretch};
use super::{forces_on, model_of, power, rubber, run, shaken, totals};
use crate::base::{Real, Vec3, parallel};

#[test]
fn damping_dissipates_energy_and_internal_forces_conserve_momentum() {
    let material = rubber(1e-3, 1e-4);
    for mesh in [Mesh::half_icosphere(0.04, 6), Mesh::hexagonal_patch(3e-3, 4)] {
        let model = model_of(mesh, material);
        for speed in [0.01, 1.0] {
            let mut state = shaken(&model, 5e-4, speed);
            let moving = forces_on(&model, &state, 0.0);
            let (force, torque, size) = totals(&state, &moving);
            // Oracle: internal forces have no resultant. Tolerance: rounding of ~10³ terms.
            assert!(force < 1e-13 * size, "net force {force} of {size}");
            assert!(torque < 1e-13 * size * 0.04, "net torque {torque}");
            let velocities = std::mem::replace(
                &mut state.velocities,
                vec![Vec3::zeros(); model.mesh.n_vertices()],
            );
            let at_rest = forces_on(&model, &state, 0.0);
            // Oracle: C3 d, power of the dissipative part is negative for any velocities.
            assert!(power(&moving, &velocities) - power(&at_rest, &velocities) < 0.0);
        }
    }
}

#[test]
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let model = model_of(Mesh::half_icosphere(0.04, 16), rubber(1e-3, 1e-4));
    let state = shaken(&model, 1e-4, 0.1);
    let on = |n| {
        parallel::lead(&parallel::ThreadPool::new(n).unwrap(), || forces_on(&model, &state, -9e4))
    };
    let bits = |forces: Vec<Vec3>| -> Vec<[u64; 3]> {
        forces.iter().map(|f| [f.x.to_bits(), f.y.to_bits(), f.z.to_bits()]).collect()
    };
    // Oracle: the same computation on one thread, bit for bit.
    assert_eq!(bits(on(1)), bits(on(3)));
}

#[test]
fn the_critical_step_of_a_lattice_matches_theory() {
    let material = MembraneMaterial { spring_damping: 0.0, ..rubber(0.0, 0.0) };
    let model = model_of(Mesh::hexagonal_patch(3e-3, 12), material);
    let inner = model.masses.iter().copied().fold(0.0, Real::max);
    let found = critical_step(&model, 0.0);
    let oracle = 2.0 / (6.0 * stretch::stiffness(1.25e6, 0.3e-3) / inner).sqrt();
    // Oracle: U11, 2/ω with ω² = 6 k/m. Tolerance: 1 % of margin in the step, the finite patch, and
    // power iteration from below.
    assert!((found / oracle - 1.0).abs() < 0.03, "{found} for {oracle}");
}

#[test]
fn the_critical_step_separates_stable_from_unstable() {
    for material in [
        MembraneMaterial { spring_damping: 0.0, ..rubber(0.0, 0.0) },
        rubber(0.0, 0.0),
        MembraneMaterial { spring_damping: 0.0, ..rubber(1e-3, 0.0) },
        rubber(1e-3, 1e-5),
        rubber(1e-3, 1e-4),
    ] {
        let model = model_of(Mesh::half_icosphere(0.04, 8), material);
        let limit = critical_step(&model, 0.0);
        let speed_after = |share: Real| {
            let mut state = shaken(&model, 1e-8, 0.0);
            run(&model, &mut state, share * limit, 3000, 0.0)
        };
        let stable = speed_after(0.98);
        let unstable = speed_after(1.05);
        // Oracle: the definition of the limit. A displacement of 10⁻⁸ m at ω ~ 10⁵/s cannot reach
        // 10⁻² m/s while the scheme is stable; above the limit, the stiffest mode grows in every step.
        // 5 %: the margin of power iteration is 1 % of the step, and growth must be visible in 3000 steps.
        assert!(stable < 1e-2, "{material:?} at 0.98: {stable} m/s");
        assert!(unstable.is_nan() || unstable > 1.0, "{material:?} at 1.05: {unstable} m/s");
    }
}

#[test]
fn stretching_shortens_the_critical_step_of_hinges_with_reference_areas() {
    let stretch = 1.3;
    // Flat and without bending stiffness: only damping acts on motion normal to the membrane.
    let mut model = model_of(Mesh::hexagonal_patch(3e-3, 8), rubber(0.0, 1e-2));
    model.bend_by_first_areas();
    let stretched: Vec<Vec3> = model.mesh.positions.iter().map(|r| r * stretch).collect();
    let ratio = critical_step_at(&model, &stretched, 0.0) / critical_step(&model, 0.0);
    // Oracle: u = |e| n/|n|·1/|n⁰| grows like the edge, so the damping |e| u uᵀ grows like its cube. These
    // hinges are damped so strongly that nothing else matters: dt = 2/rate. Tolerance: springs add 1e-5.
    assert!((ratio * stretch.powi(3) - 1.0).abs() < 1e-3, "{ratio}");
}
