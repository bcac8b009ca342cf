//! Tests of hinges: the geometry of a fold, and plate theory.

use super::super::bridson_2003::{self, Fold};
use super::super::mesh::Mesh;
use super::super::{Facet, MembraneMaterial, MembraneModel, MembraneState};
use super::{forces_on, model_of, rubber, shaken, totals};
use crate::base::random::{Random, Stream};
use crate::base::{Real, Vec3, lanes::Vector};

/// Two random, non-degenerate triangles at an edge, with random velocities.
fn random_hinge(random: &mut Random) -> MembraneState {
    let corners = [[0.3, 1.0, 0.0], [0.6, -0.8, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let mut draw = |size: Real| Vec3::from_fn(|_, _| random.between(-size, size));
    let positions = corners.map(|c| Vec3::from(c) + draw(0.25)).to_vec();
    let velocities = corners.map(|_| draw(1.0)).to_vec();
    MembraneState { positions, velocities }
}

fn hinge_model(material: MembraneMaterial) -> MembraneModel {
    let corners = [[0.5, 1.0, 0.0], [0.5, -1.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let mesh = Mesh::new(corners.map(Vec3::from).to_vec(), vec![[0, 2, 3], [1, 3, 2]]);
    MembraneModel::new(mesh.unwrap(), material)
}

/// Fold of the only hinge, and its angle (rad) by the arctangent.
fn fold_of(model: &MembraneModel, positions: &[Vec3]) -> (Fold<Real>, Real) {
    let link = &model.links[0];
    let facets = link.triangles.map(|t| Facet::new(positions, &model.mesh.triangles[t as usize]));
    let (n1, n2) = (facets[0].normal(), facets[1].normal());
    let e = (positions[3] - positions[2]).normalize();
    let angle = n1.cross(&n2).dot(&e).atan2(n1.dot(&n2));
    (link.fold(positions, [&facets[0], &facets[1]]), angle)
}

#[test]
fn the_fold_vectors_are_the_gradient_of_the_angle() {
    let model = hinge_model(rubber(1e-3, 1e-4));
    let mut random = Random::new(3, Stream::Position);
    for _ in 0..200 {
        let mut state = random_hinge(&mut random);
        let (fold, angle) = fold_of(&model, &state.positions);
        // Oracle: sin of half the arctangent's angle. Tolerance: rounding.
        assert!((fold.half_sine - (0.5 * angle).sin()).abs() < 1e-14);
        let u = fold.spread(1.0).map(Vec3::from);
        // Oracle: C3 a, no net force and no net torque. Tolerance: rounding of numbers of order 1–10.
        let torque: Vec3 = (0..4).map(|i| state.positions[i].cross(&u[i])).sum();
        assert!(u.iter().sum::<Vec3>().norm() < 1e-14 && torque.norm() < 1e-13);
        for i in 0..4 {
            for axis in 0..3 {
                let h = 1e-5;
                let at = state.positions[i][axis];
                state.positions[i][axis] = at + h;
                let (_, above) = fold_of(&model, &state.positions);
                state.positions[i][axis] = at - h;
                let (_, below) = fold_of(&model, &state.positions);
                state.positions[i][axis] = at;
                // Oracle: C3 b, u = −∂θ/∂r by central differences. Tolerance: h² times third
                // derivatives of order 10–10³.
                assert!((u[i][axis] + (above - below) / (2.0 * h)).abs() < 1e-6);
            }
        }
        let v: [&Vec3; 4] = std::array::from_fn(|i| &state.velocities[i]);
        let direct: Real = (0..4).map(|i| u[i].dot(v[i])).sum();
        // Oracle: the definition Σ u·v. Tolerance: rounding of terms of order 10.
        assert!((fold.project(v.map(|v| Vector::from(*v))) - direct).abs() < 1e-13);
    }
}

#[test]
fn half_sine_is_accurate_at_both_ends() {
    for angle in [1e-9, -1e-9, 1e-3, 1.0, -1.5, 1.6, 3.0, -3.1, 3.13] {
        let angle: Real = angle;
        let found = bridson_2003::half_sine(angle.sin(), angle.cos());
        // Oracle: sin(θ/2). Tolerance: a few units in the last place, relative.
        assert!((found / (0.5 * angle).sin() - 1.0).abs() < 4e-15, "{angle}: {found}");
    }
}

#[test]
fn bending_restores_the_rest_angle_from_both_sides_without_stretching() {
    for rest in [0.0, 0.4, -0.4] {
        let mut model = hinge_model(rubber(1e-3, 0.0));
        let folded = |angle: Real| {
            let mut positions = model.mesh.positions.clone();
            // Rotate r1 about the x axis. Lifting it rotates n1 such that θ has the sign of −angle.
            positions[0] = Vec3::new(0.5, angle.cos(), -angle.sin());
            positions
        };
        let at_rest = folded(rest);
        let tilted = [rest + 0.2, rest - 0.2].map(folded);
        model.rest_angles_from(&at_rest);
        let (_, angle) = fold_of(&model, &at_rest);
        // Oracle: the construction of the fold. Tolerance: rounding.
        assert!((angle.abs() - rest.abs()).abs() < 1e-15);
        let bend = |positions: &[Vec3]| {
            let (fold, angle) = fold_of(&model, positions);
            let opening = fold.half_sine - model.links[0].law.rest_half_sine;
            (fold.spread(1e-3 * fold.slenderness * opening).map(Vec3::from), angle)
        };
        // Oracle: C3 c, no force at the rest angle. Tolerance: rounding.
        assert!(bend(&at_rest).0[0].norm() < 1e-18);
        for positions in tilted {
            let (f, angle_before) = bend(&positions);
            let mut moved = positions.clone();
            for i in 0..4 {
                moved[i] += f[i];
            }
            let (_, angle_after) = bend(&moved);
            // Oracle: C3 c, moving along the force brings the angle closer to that at rest.
            assert!((angle_after - angle).abs() < (angle_before - angle).abs());
            for [of, a, b] in [[0, 0, 2], [0, 0, 3], [0, 2, 3], [1, 1, 2], [1, 1, 3], [1, 2, 3]] {
                let along = f[of].dot(&(positions[b] - positions[a]));
                // Oracle: C3 e, the force on r1 (r2) is normal to triangle 1 (2). Tolerance: rounding.
                assert!(along.abs() < 1e-15 * f[of].norm());
            }
        }
    }
}

#[test]
fn the_restoring_moment_does_not_depend_on_the_mesh_size() {
    let model = hinge_model(rubber(1e-3, 0.0));
    let moment = |size: Real| {
        let mut positions: Vec<Vec3> = model.mesh.positions.iter().map(|p| p * size).collect();
        positions[0].z += 0.3 * size;
        let (fold, _) = fold_of(&model, &positions);
        let force = fold.u1 * (fold.slenderness * fold.half_sine);
        (positions[0] - positions[2]).cross(&force.into()).x
    };
    // Oracle: C3 g. Tolerance: rounding.
    assert!((moment(1e-3) / moment(1.0) - 1.0).abs() < 1e-13);
}

#[test]
fn a_lattice_of_hinges_is_a_plate() {
    let (a, k_el) = (3e-3, 1e-3);
    let d = k_el / 4.0;
    let model = model_of(Mesh::hexagonal_patch(a, 12), rubber(k_el, 0.0));
    let area = model.mesh.hinges.len() as Real * a * a * 0.75_f64.sqrt() / 3.0;
    let curvature = 1e-4;
    let energy = |xx: Real, xy: Real, yy: Real| {
        let mut state = MembraneState::at_rest(&model.mesh);
        for p in &mut state.positions {
            p.z = 0.5 * curvature * (xx * p.x * p.x + 2.0 * xy * p.x * p.y + yy * p.y * p.y);
        }
        let forces = forces_on(&model, &state, 0.0);
        -0.5 * state.positions.iter().zip(&forces).map(|(r, f)| r.z * f.z).sum::<Real>()
            / (area * curvature * curvature)
    };
    // Oracle: U12, energy per area of a plate with D = k_el/4, ν = −1/3 (Seung & Nelson 1988):
    // cylinder D κ²/2 in any direction, sphere 2/3 D κ², saddle 4/3 D κ². Hinges see uniform
    // curvature exactly; tolerance: (κ·36 mm)² ~ 10⁻¹¹ and rounding over a height of 10⁻⁷ m.
    for (xx, xy, yy, oracle) in [
        (1.0, 0.0, 0.0, d / 2.0),
        (0.0, 0.0, 1.0, d / 2.0),
        (0.75, 0.1875_f64.sqrt(), 0.25, d / 2.0),
        (1.0, 0.0, 1.0, 2.0 / 3.0 * d),
        (1.0, 0.0, -1.0, 4.0 / 3.0 * d),
        (0.0, 1.0, 0.0, 4.0 / 3.0 * d),
    ] {
        let found = energy(xx, xy, yy);
        assert!((found / oracle - 1.0).abs() < 1e-6, "{xx} {xy} {yy}: {found} for {oracle}");
    }
}

/// Oracle: dimensional analysis of eqs. 20 to 25. In a membrane scaled by s, |e|²/(|n1| + |n2|) · u scales with 1/s
/// for current areas and with s³ for reference areas: the forces differ by s⁴.
#[test]
fn reference_areas_keep_a_compressed_hinge_soft() {
    let scale: Real = 0.5;
    let material = MembraneMaterial { youngs_modulus: 0.0, ..rubber(1e-3, 0.0) };
    let current = model_of(Mesh::hexagonal_patch(4e-3, 2), material);
    let mut reference = current.clone();
    reference.bend_by_first_areas();
    let mut state = shaken(&current, 4e-4, 0.0);
    let at_first = [&current, &reference].map(|model| forces_on(model, &state, 0.0));
    for position in &mut state.positions {
        *position *= scale;
    }
    let squeezed = [&current, &reference].map(|model| forces_on(model, &state, 0.0));
    let (of_current, of_reference) = (totals(&state, &squeezed[0]), totals(&state, &squeezed[1]));
    // Tolerance: rounding. The deformed areas differ from the reference areas, so the ratio itself is not s⁴.
    let ratio = |forces: &[Vec<Vec3>; 2]| forces[1][5].norm() / forces[0][5].norm();
    assert!((ratio(&squeezed) / ratio(&at_first) / scale.powi(4) - 1.0).abs() < 1e-9);
    // Oracle: internal forces have no resultant. Tolerance: rounding.
    assert!(of_current.0 < 1e-12 * of_current.2 && of_reference.0 < 1e-12 * of_reference.2);
}
