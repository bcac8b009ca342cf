//! Tests of pressure: resultant, power, volume, and Laplace's law.

use super::super::critical_step::critical_step;
use super::super::mesh::Mesh;
use super::super::{
    MembraneMaterial, MembraneModel, MembraneScratch, MembraneState, forces, pressure, stretch,
};
use super::{forces_on, model_of, power, rubber, run, shaken, totals};
use crate::base::{Real, Vec3};

#[test]
fn pressure_on_a_closed_mesh_has_no_resultant_and_the_right_power() {
    let model = model_of(Mesh::icosphere(0.04, 6), rubber(1e-3, 0.0));
    let p = -9e4;
    let mut state = shaken(&model, 1e-3, 0.1);
    for position in &mut state.positions {
        *position += Vec3::new(0.3, -0.2, 0.5); // the result must not depend on the origin
    }
    let mut loads = forces_on(&model, &state, p);
    for (load, inner) in loads.iter_mut().zip(forces_on(&model, &state, 0.0)) {
        *load -= inner;
    }
    let (force, torque, size) = totals(&state, &loads);
    // Oracle: C5, a closed surface under uniform pressure. Tolerance: rounding of ~10³ terms, and
    // of the internal forces that were subtracted.
    assert!(force < 1e-12 * size && torque < 1e-12 * size, "{force} {torque} of {size}");
    check_power(&model, &state, &loads, p);
}

#[test]
fn the_gradient_of_a_lidded_volume_is_consistent() {
    let model = model_of(Mesh::half_icosphere(0.04, 6), rubber(1e-3, 0.0));
    let state = shaken(&model, 1e-3, 0.1); // the rim as well
    let gradient = pressure::volume_gradient(&model.mesh, &state.positions);
    let p = 700.0;
    let loads: Vec<Vec3> = gradient.iter().map(|g| g * p).collect();
    check_power(&model, &state, &loads, p);
    let (force, torque, size) = totals(&state, &gradient);
    // Oracle: the volume is invariant under translation and rotation. Tolerance: rounding.
    assert!(force < 1e-13 * size && torque < 1e-13 * size);
    let mut scratch = MembraneScratch::new(&model);
    let slack = MembraneModel::new(
        model.mesh.clone(),
        MembraneMaterial { youngs_modulus: 0.0, ..rubber(0.0, 0.0) },
    );
    forces(&slack, &state, p, &mut scratch);
    for v in (0..model.mesh.n_vertices()).filter(|&v| !model.mesh.is_on_rim[v]) {
        // Oracle: away from the rim, load = p · gradient. Tolerance: rounding.
        assert!((scratch.forces[v] - loads[v]).norm() < 1e-13 * loads[v].norm().max(1e-3));
    }
    let lid = pressure::lid_area_vector(&model.mesh.rims[0], &state.positions);
    let on_membrane: Vec3 = scratch.forces.iter().sum();
    // Oracle: membrane and lid form a closed surface. Tolerance: rounding.
    assert!((on_membrane + lid * p).norm() < 1e-13 * on_membrane.norm());
}

/// Oracle: C5, the power of the load is the gauge pressure times the rate of the volume, by central differences.
fn check_power(model: &MembraneModel, state: &MembraneState, loads: &[Vec3], p: Real) {
    let h = 1e-6;
    let at = |time: Real| {
        let moved = state.positions.iter().zip(&state.velocities);
        pressure::volume(&model.mesh, &moved.map(|(r, v)| r + v * time).collect::<Vec<_>>())
    };
    let rate = (at(h) - at(-h)) / (2.0 * h);
    let oracle = p * rate;
    let found = power(loads, &state.velocities);
    // Tolerance: the volume is cubic in time; rounding of V ~ 10⁻⁴ m³ divided by 2h, relative to the rate.
    let size: Real = loads.iter().zip(&state.velocities).map(|(f, v)| f.dot(v).abs()).sum();
    assert!((found - oracle).abs() < 1e-6 * size, "{found} for {oracle}");
}

#[test]
fn half_a_sphere_has_half_the_volume() {
    let whole = Mesh::icosphere(0.04, 16).unwrap();
    let half = Mesh::half_icosphere(0.04, 16).unwrap();
    let (v_whole, v_half) =
        (pressure::volume(&whole, &whole.positions), pressure::volume(&half, &half.positions));
    let sphere = 4.0 / 3.0 * std::f64::consts::PI * 0.04_f64.powi(3);
    // Oracle: 4/3 π R³. Tolerance: chords of 3 mm lie up to a²/8R below the sphere, 0.5 % of V.
    assert!((v_whole / sphere - 1.0).abs() < 5e-3 && v_whole < sphere);
    // Oracle: symmetry. Tolerance: rounding.
    assert!((2.0 * v_half / v_whole - 1.0).abs() < 1e-13);
}

#[test]
fn a_sphere_under_pressure_obeys_laplace() {
    let p = 10.0;
    let material = MembraneMaterial { spring_damping: 0.5, ..rubber(0.0, 0.0) };
    let model = model_of(Mesh::icosphere(0.04, 8), material);
    let mut state = MembraneState::at_rest(&model.mesh);
    let dt = 0.5 * critical_step(&model, 0.0);
    let mut last = Real::INFINITY;
    for _ in 0..40 {
        run(&model, &mut state, dt, 50, p);
        last = state.velocities.iter().map(|v| v.norm()).fold(0.0, Real::max);
        // Springs hardly damp slow modes: this damps them.
        for velocity in &mut state.velocities {
            *velocity *= 0.3;
        }
    }
    let volume = |r: &[Vec3]| pressure::volume(&model.mesh, r);
    let ratio = volume(&state.positions) / volume(&model.mesh.positions);
    let found = ratio.cbrt() - 1.0;
    let oracle = p * 0.04 / (2.0 * 3.0_f64.sqrt() * stretch::stiffness(1.25e6, 0.3e-3));
    // Oracle: U13, ΔR/R = p R/(2√3 k) = 3.556·10⁻⁴. Tolerance: 1 % for the mesh at frequency 8.
    assert!((oracle - 3.556e-4).abs() < 1e-7);
    assert!(last < 1e-4, "still moving at {last} m/s");
    assert!((found / oracle - 1.0).abs() < 0.01, "{found} for {oracle}");
}

/// A tube whose end rings are pulled by two lids: ε_θ = pR/(Ed) (1 − ν/2) and ε_z = pR/(Ed) (1/2 − ν). The rings
/// are held at these strains.
#[test]
fn a_closed_cylinder_under_pressure_obeys_laplace() {
    let (p, radius, n_around) = (100.0, 0.04, 40);
    let edge = 2.0 * radius * (std::f64::consts::PI / 40.0).sin();
    let n_rows = 17;
    let height = 16.0 * edge * 0.75_f64.sqrt();
    let material = MembraneMaterial { spring_damping: 0.5, ..rubber(0.0, 0.0) };
    let model = model_of(Mesh::tube(radius, height, n_around, n_rows), material);
    let strain = p * radius / (material.youngs_modulus * material.thickness);
    let (hoop, axial) = (strain * (1.0 - 1.0 / 6.0), strain * (0.5 - 1.0 / 3.0));
    let held = Vec3::new(1.0 + hoop, 1.0 + hoop, 1.0 + axial);
    let mut state = MembraneState::at_rest(&model.mesh);
    for v in (0..model.mesh.n_vertices()).filter(|&v| model.mesh.is_on_rim[v]) {
        state.positions[v].component_mul_assign(&held);
    }
    let dt = 0.5 * critical_step(&model, 0.0);
    for _ in 0..60 {
        run(&model, &mut state, dt, 50, p);
        for velocity in &mut state.velocities {
            *velocity *= 0.3;
        }
    }
    let radial = |r: &Vec3| r.xy().norm();
    let middle = |v: &usize| model.mesh.positions[*v].z.abs() < 0.3 * height;
    let all: Vec<usize> = (0..model.mesh.n_vertices()).filter(middle).collect();
    let found: Real = all.iter().map(|&v| radial(&state.positions[v]) / radius - 1.0).sum::<Real>()
        / all.len() as Real;
    // Oracle: U13, 8.89·10⁻³ at 100 Pa. Tolerance: 2 %, because p acts on a polygon of 40 chords, and strains of
    // 1 % change length and area by 1 %.
    assert!((hoop - 8.89e-3).abs() < 1e-5);
    assert!((found / hoop - 1.0).abs() < 0.02, "{found} for {hoop}");
    let loads = forces_on(&model, &state, p);
    for rim in &model.mesh.rims {
        let lid = pressure::lid_area_vector(rim, &state.positions) * p;
        let ring: Vec3 = rim.iter().map(|&v| loads[v as usize]).sum();
        // Oracle: the pull on the ring balances the pressure on its lid along the axis. Tolerance: 3 %, as
        // above, plus the effect of the rotated row next to the ring.
        assert!((ring.z + lid.z).abs() < 0.03 * lid.z.abs(), "{} and {}", ring.z, lid.z);
    }
}
