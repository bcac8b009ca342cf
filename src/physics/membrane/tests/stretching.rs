//! Tests of springs: lattice elasticity, and a damped oscillation of two vertices.

use super::super::mesh::Mesh;
use super::super::stretch::{self, Spring};
use super::super::{MembraneModel, MembraneState, pressure};
use super::{forces_on, model_of, rubber, totals};
use crate::base::{Mat3, Real, Vec3};

#[test]
fn a_patch_has_the_modulus_and_poisson_ratio_of_the_lattice() {
    let (a, strain) = (3e-3, 1e-6);
    for rings in [3, 10] {
        let model = model_of(Mesh::hexagonal_patch(a, rings), rubber(0.0, 0.0));
        let k = stretch::stiffness(1.25e6, 0.3e-3);
        // Oracle: k = √3/2 E d, 324.76 N/m to five digits.
        assert!((k - 324.76).abs() < 0.005);
        let area = pressure::area(&model.mesh, &model.mesh.positions);
        for direction in [0.0, 0.2, 0.5, 1.0, 1.4_f64] {
            let (s, c) = direction.sin_cos();
            let along = Vec3::new(c, s, 0.0);
            let across = Vec3::new(-s, c, 0.0);
            let pull =
                along * along.transpose() * strain - across * across.transpose() * (strain / 3.0);
            let stress = stress_at(&model, &(Mat3::identity() + pull), area);
            // Oracle: uniaxial tension of an isotropic membrane with E d = 2/√3 k, ν = 1/3: the strain
            // (ε, −ε/3) causes the stress (E d ε, 0). Tolerance: second order in ε, and rounding of
            // lengths over the strain, 10⁻¹⁰.
            let modulus = stress.dot_along(&along) / strain;
            assert!((modulus / (2.0 / 3.0_f64.sqrt() * k) - 1.0).abs() < 1e-5, "E d = {modulus}");
            assert!((stress.dot_along(&across) / (k * strain)).abs() < 1e-5);
            assert!((along.dot(&(stress * across)) / (k * strain)).abs() < 1e-5);
        }
        // Oracle: U10, T = √3 k ε in every direction under isotropic stretch. Same tolerance.
        let stress = stress_at(&model, &(Mat3::identity() * (1.0 + strain)), area);
        let tension = 3.0_f64.sqrt() * k * strain;
        assert!(
            (stress.m11 / tension - 1.0).abs() < 1e-5 && (stress.m22 / tension - 1.0).abs() < 1e-5
        );
    }
}

/// A component of a tensor.
trait Along {
    fn dot_along(&self, direction: &Vec3) -> Real;
}

impl Along for Mat3 {
    fn dot_along(&self, direction: &Vec3) -> Real {
        direction.dot(&(self * direction))
    }
}

/// Mean stress (N/m) of a patch under an affine deformation: the virial −Σ r ⊗ F / A.
fn stress_at(model: &MembraneModel, deformation: &Mat3, area: Real) -> Mat3 {
    let mut state = MembraneState::at_rest(&model.mesh);
    for position in &mut state.positions {
        *position = deformation * *position;
    }
    let forces = forces_on(model, &state, 0.0);
    let virial: Mat3 = state.positions.iter().zip(&forces).map(|(r, f)| r * f.transpose()).sum();
    -virial / area
}

#[test]
fn a_pair_is_a_damped_oscillator() {
    let (k, gamma, masses) = (324.76, 0.15, [2e-6, 6e-6]);
    let spring = Spring::new(3e-3, k, gamma, masses);
    let reduced = masses[0] * masses[1] / (masses[0] + masses[1]);
    let omega: Real = (k / reduced).sqrt();
    let damped = (1.0 - gamma * gamma).sqrt();
    let period = 2.0 * std::f64::consts::PI / (omega * damped);
    let n_steps = 20_000;
    let dt = period / Real::from(n_steps);
    let (mut x, mut v) = ([0.0, 3e-3 + 1e-5], [0.0, 0.0]);
    for _ in 0..n_steps {
        let tension = stretch::tension(spring.numbers(), x[1] - x[0], v[1] - v[0]);
        v[0] += tension / masses[0] * dt;
        v[1] -= tension / masses[1] * dt;
        x[0] += v[0] * dt;
        x[1] += v[1] * dt;
    }
    let ratio = (x[1] - x[0] - 3e-3) / 1e-5;
    // Oracle: C2, amplitude per period e^(−2πγ/√(1−γ²)) = 0.385. Tolerance: first-order integrator,
    // ω dt = 3·10⁻⁴, over one period.
    assert!((ratio - (-2.0 * std::f64::consts::PI * gamma / damped).exp()).abs() < 1e-3, "{ratio}");
    assert!((ratio - 0.385).abs() < 1.5e-3);
}

#[test]
fn a_membrane_scaled_like_its_rest_lengths_is_stress_free() {
    let mut model = model_of(Mesh::hexagonal_patch(3e-3, 3), rubber(0.0, 0.0));
    model.scale_rest_lengths(0.875);
    let state = MembraneState {
        positions: model.mesh.positions.iter().map(|p| p * 0.875).collect(),
        ..MembraneState::at_rest(&model.mesh)
    };
    let (_, _, size) = totals(&state, &forces_on(&model, &state, 0.0));
    // Oracle: the scaled shape is stress-free. Tolerance: k times rounding of lengths.
    assert!(size < 1e-12, "{size}");
}
