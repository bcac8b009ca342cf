//! The sheet against lattice elasticity, plate theory, Laplace's law and conservation laws.

use super::critical_step::critical_step;
use super::mesh::{Mesh, MeshFault, NONE};
use super::*;
use crate::base::Mat3;
use crate::base::random::{Random, Stream};

/// Material of the seeds' gripper; bending can be switched off by 0.
fn rubber(bending_stiffness: Real, bending_damping: Real) -> Sheet {
    Sheet {
        thickness: 0.3e-3,
        youngs_modulus: 1.25e6,
        density: 2000.0,
        spring_damping: 0.3,
        bending_stiffness,
        bending_damping,
    }
}

fn model_of(mesh: Result<Mesh, MeshFault>, sheet: Sheet) -> MembraneModel {
    MembraneModel::new(mesh.unwrap(), sheet)
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

/// Sum of forces, of torques about the origin, and of their lengths.
fn totals(state: &MembraneState, forces: &[Vec3]) -> (Real, Real, Real) {
    let force: Vec3 = forces.iter().sum();
    let torque: Vec3 = state.positions.iter().zip(forces).map(|(r, f)| r.cross(f)).sum();
    (force.norm(), torque.norm(), forces.iter().map(|f| f.norm()).sum())
}

/// A short semi-implicit Euler run; returns the largest speed at its end.
fn run(model: &MembraneModel, state: &mut MembraneState, dt: Real, steps: usize, p: Real) -> Real {
    let mut scratch = MembraneScratch::new(model);
    for _ in 0..steps {
        forces(model, state, p, &mut scratch);
        for v in (0..model.mesh.n_vertices()).filter(|&v| !model.is_clamped[v]) {
            state.velocities[v] += scratch.forces[v] * (dt / model.masses[v]);
            state.positions[v] += state.velocities[v] * dt;
        }
    }
    state.velocities.iter().map(|v| v.norm()).fold(0.0, Real::max)
}

#[test]
fn meshes_have_the_published_numbers() {
    let half = Mesh::half_icosphere(0.04, 16).unwrap();
    let whole = Mesh::icosphere(0.04, 16).unwrap();
    let inner = Mesh::icosphere(0.01, 4).unwrap();
    // Oracle: Götz (2024) section 4: 1321 vertices of the gripper, 162 and 2562 of the hollow
    // sphere; 5·16 = 80 on the equator; Euler's formula V − E + F = 1 for a disc, 2 for a sphere.
    assert_eq!((half.n_vertices(), half.rim.len()), (1321, 80));
    assert_eq!((whole.n_vertices(), inner.n_vertices()), (2562, 162));
    assert_eq!(half.n_vertices() + half.triangles.len(), half.edges.len() + 1);
    assert_eq!(whole.n_vertices() + whole.triangles.len(), whole.edges.len() + 2);
    assert_eq!(half.hinges.len() + half.rim.len(), half.edges.len());
    for (v, position) in half.positions.iter().enumerate() {
        // Oracle: construction; the rim lies exactly in the plane, all else strictly below.
        assert!(if half.is_on_rim[v] { position.z.to_bits() == 0 } else { position.z < 0.0 });
        // Oracle: construction. Tolerance: rounding of a normalised vector.
        assert!((position.norm() - 0.04).abs() < 1e-16, "vertex {v} off the sphere");
    }
    let edge_mean =
        half.edges.iter().map(|e| length(&half, e)).sum::<Real>() / half.edges.len() as Real;
    // Oracle: section 4 quotes 3.0 mm to two digits.
    assert!((edge_mean - 3.0e-3).abs() < 0.05e-3, "mean edge {edge_mean}");
}

fn length(mesh: &Mesh, edge: &[u32; 2]) -> Real {
    (mesh.positions[edge[0] as usize] - mesh.positions[edge[1] as usize]).norm()
}

#[test]
fn normals_point_out_and_the_rim_runs_around_the_lid() {
    let mesh = Mesh::half_icosphere(0.04, 8).unwrap();
    for triangle in &mesh.triangles {
        let centre: Vec3 = triangle.iter().map(|&v| mesh.positions[v as usize]).sum();
        // Oracle: a sphere about the origin has its outward normals along the position.
        assert!(area_normal(&mesh.positions, triangle).dot(&centre) > 0.0);
    }
    let lid = pressure::lid_area_vector(&mesh, &mesh.positions);
    // Oracle: area of the regular-ish polygon, between those of inscribed and circumscribed circle.
    assert!(lid.z > 0.99 * std::f64::consts::PI * 0.04 * 0.04 * 0.99 && lid.xy().norm() < 1e-15);
    for k in 0..mesh.rim.len() {
        let (a, b) = (mesh.rim[k], mesh.rim[(k + 1) % mesh.rim.len()]);
        let is_edge = |e: &[u32; 2]| *e == [a, b] || *e == [b, a];
        assert!(mesh.edges[mesh.hinges.len()..].iter().any(is_edge), "{a}-{b} is no boundary edge");
    }
}

#[test]
fn neighbours_agree_with_each_other() {
    let mesh = Mesh::half_icosphere(1.0, 4).unwrap();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            let edge = mesh.edges[mesh.edges_of_triangle[t][k] as usize];
            // Oracle: definition of edge k of a triangle and of the triangle across it.
            assert!(edge == [a, b] || edge == [b, a]);
            let across = mesh.neighbours_of_triangle[t][k];
            if across != NONE {
                let other = mesh.triangles[across as usize];
                assert!(other.contains(&a) && other.contains(&b) && across as usize != t);
            }
        }
    }
    for hinge in &mesh.hinges {
        let [r1, r2, r3, r4] = hinge.vertices;
        let is_turn_of = |t: u32, want: [u32; 3]| {
            let have = mesh.triangles[t as usize];
            (0..3).any(|s| [have[s], have[(s + 1) % 3], have[(s + 2) % 3]] == want)
        };
        // Oracle: the drawing at the top of mesh.rs, which fixes the signs of eqs. 17, 18.
        assert!(is_turn_of(hinge.triangles[0], [r1, r3, r4]));
        assert!(is_turn_of(hinge.triangles[1], [r2, r4, r3]));
    }
}

#[test]
fn bad_triangles_are_named() {
    let square = || vec![Vec3::zeros(), Vec3::x(), Vec3::new(1.0, 1.0, 0.0), Vec3::y()];
    let fault = |triangles: Vec<[u32; 3]>| Mesh::new(square(), triangles).unwrap_err();
    // Oracle: each list has exactly the fault that its name says.
    assert!(matches!(fault(vec![[0, 1, 4]]), MeshFault::NoSuchVertex { vertex: 4, .. }));
    assert!(matches!(fault(vec![[0, 1, 1]]), MeshFault::NoArea { triangle: 0 }));
    assert!(matches!(fault(vec![[0, 1, 2]]), MeshFault::Unused { vertex: 3 }));
    let turned = fault(vec![[0, 1, 2], [0, 3, 2]]);
    assert!(matches!(turned, MeshFault::Orientation { from: 0, to: 2, .. }), "{turned}");
    let fan = fault(vec![[0, 1, 2], [0, 2, 3], [0, 2, 1]]);
    assert!(matches!(fan, MeshFault::Branching { count: 3, .. } | MeshFault::Orientation { .. }));
    assert!(matches!(Mesh::half_icosphere(1.0, 3), Err(MeshFault::Frequency { frequency: 3 })));
}

#[test]
fn a_patch_has_the_modulus_and_poisson_ratio_of_the_lattice() {
    let (a, strain) = (3e-3, 1e-6);
    for rings in [3, 10] {
        let model = model_of(Mesh::hexagonal_patch(a, rings), rubber(0.0, 0.0));
        let k = stretch::stiffness(1.25e6, 0.3e-3);
        // Oracle: k = √3/2 E d, 324.76 N/m in five digits.
        assert!((k - 324.76).abs() < 0.005);
        let area = pressure::area(&model.mesh, &model.mesh.positions);
        for direction in [0.0, 0.2, 0.5, 1.0, 1.4_f64] {
            let (s, c) = direction.sin_cos();
            let along = Vec3::new(c, s, 0.0);
            let across = Vec3::new(-s, c, 0.0);
            let pull =
                along * along.transpose() * strain - across * across.transpose() * (strain / 3.0);
            let stress = stress_at(&model, &(Mat3::identity() + pull), area);
            // Oracle: uniaxial tension of an isotropic sheet with E d = 2/√3 k, ν = 1/3: the strain
            // (ε, −ε/3) makes the stress (E d ε, 0). Tolerance: second order in ε, and rounding of
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

trait Along {
    fn dot_along(&self, direction: &Vec3) -> Real;
}

impl Along for Mat3 {
    fn dot_along(&self, direction: &Vec3) -> Real {
        direction.dot(&(self * direction))
    }
}

/// Mean stress [N/m] of a patch under an affine deformation: the virial −Σ r ⊗ F / A.
fn stress_at(model: &MembraneModel, deformation: &Mat3, area: Real) -> Mat3 {
    let mut state = MembraneState::at_rest(&model.mesh);
    for position in &mut state.positions {
        *position = deformation * *position;
    }
    let forces = forces_on(model, &state, 0.0);
    let virial: Mat3 = state.positions.iter().zip(&forces).map(|(r, f)| r * f.transpose()).sum();
    -virial / area
}

/// Two triangles about an edge, arbitrary but not degenerate, with given velocities.
fn random_hinge(random: &mut Random) -> MembraneState {
    let corners = [[0.3, 1.0, 0.0], [0.6, -0.8, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let mut draw = |size: Real| Vec3::from_fn(|_, _| random.between(-size, size));
    let positions = corners.map(|c| Vec3::from(c) + draw(0.25)).to_vec();
    let velocities = corners.map(|_| draw(1.0)).to_vec();
    MembraneState { positions, velocities }
}

fn hinge_model(sheet: Sheet) -> MembraneModel {
    let corners = [[0.5, 1.0, 0.0], [0.5, -1.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let mesh = Mesh::new(corners.map(Vec3::from).to_vec(), vec![[0, 2, 3], [1, 3, 2]]);
    MembraneModel::new(mesh.unwrap(), sheet)
}

/// Fold of the only hinge, and its angle by the arctangent.
fn fold_of(model: &MembraneModel, positions: &[Vec3]) -> (Fold, Real) {
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
        let u = fold.spread(1.0);
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
        assert!((fold.project(v) - direct).abs() < 1e-13);
    }
}

#[test]
fn half_sine_keeps_its_digits_at_both_ends() {
    for angle in [1e-9, -1e-9, 1e-3, 1.0, -1.5, 1.6, 3.0, -3.1, 3.141_592] {
        let angle: Real = angle;
        let found = bridson_2003::half_sine(angle.sin(), angle.cos());
        // Oracle: sin(θ/2). Tolerance: a few units in the last place, relative.
        assert!((found / (0.5 * angle).sin() - 1.0).abs() < 4e-15, "{angle}: {found}");
    }
}

#[test]
fn bending_restores_from_both_sides_and_leaves_lengths_alone() {
    for rest in [0.0, 0.4, -0.4] {
        let mut model = hinge_model(rubber(1e-3, 0.0));
        let folded = |angle: Real| {
            let mut positions = model.mesh.positions.clone();
            // Turn r1 about the x axis. Lifting it turns n1 so that θ has the sign of −angle.
            positions[0] = Vec3::new(0.5, angle.cos(), -angle.sin());
            positions
        };
        let at_rest = folded(rest);
        let tilted = [rest + 0.2, rest - 0.2].map(folded);
        model.rest_angles_from(&at_rest);
        let (_, angle) = fold_of(&model, &at_rest);
        // Oracle: construction of the fold. Tolerance: rounding.
        assert!((angle.abs() - rest.abs()).abs() < 1e-15);
        let bend = |positions: &[Vec3]| {
            let (fold, angle) = fold_of(&model, positions);
            let opened = fold.half_sine - model.links[0].rest_half_sine;
            (fold.spread(1e-3 * fold.slenderness * opened), angle)
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
            // Oracle: C3 c, following the force brings the angle nearer to rest.
            assert!((angle_after - angle).abs() < (angle_before - angle).abs());
            for [a, b] in [[0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] {
                let side: Vec3 = positions[b] - positions[a];
                // Oracle: C3 e, forces are normal to the triangles, so no side is stretched by its
                // own triangle's share. The shared edge has both. Tolerance: rounding.
                let own = (f[b] - f[a]).dot(&side);
                let other = [[0, 2], [0, 3]].contains(&[a, b]);
                let across = if other {
                    fold_of(&model, &positions).0.u2
                } else {
                    fold_of(&model, &positions).0.u1
                };
                let foreign = across.dot(&side).abs() * f[1].norm().max(f[0].norm());
                assert!(own.abs() <= 2.0 * foreign + 1e-18);
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
        (positions[0] - positions[2]).cross(&force).x
    };
    // Oracle: C3 g. Tolerance: rounding.
    assert!((moment(1e-3) / moment(1.0) - 1.0).abs() < 1e-13);
}

#[test]
fn damping_takes_energy_and_internal_forces_keep_momentum() {
    let sheet = rubber(1e-3, 1e-4);
    for mesh in [Mesh::half_icosphere(0.04, 6), Mesh::hexagonal_patch(3e-3, 4)] {
        let model = model_of(mesh, sheet);
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
            let still = forces_on(&model, &state, 0.0);
            // Oracle: C3 d, power of the dissipative part is negative for any velocities.
            assert!(power(&moving, &velocities) - power(&still, &velocities) < 0.0);
        }
    }
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

#[test]
fn pressure_on_a_closed_mesh_has_no_resultant_and_the_power_of_the_volume() {
    let model = model_of(Mesh::icosphere(0.04, 6), rubber(1e-3, 0.0));
    let p = -9e4;
    let mut state = shaken(&model, 1e-3, 0.1);
    for position in &mut state.positions {
        *position += Vec3::new(0.3, -0.2, 0.5); // the origin must not matter
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
fn the_volume_under_a_lid_has_its_gradient() {
    let model = model_of(Mesh::half_icosphere(0.04, 6), rubber(1e-3, 0.0));
    let state = shaken(&model, 1e-3, 0.1); // the rim as well
    let gradient = pressure::volume_gradient(&model.mesh, &state.positions);
    let p = 700.0;
    let loads: Vec<Vec3> = gradient.iter().map(|g| g * p).collect();
    check_power(&model, &state, &loads, p);
    let (force, torque, size) = totals(&state, &gradient);
    // Oracle: volume does not change under translation and rotation. Tolerance: rounding.
    assert!(force < 1e-13 * size && torque < 1e-13 * size);
    let mut scratch = MembraneScratch::new(&model);
    let slack =
        MembraneModel::new(model.mesh.clone(), Sheet { youngs_modulus: 0.0, ..rubber(0.0, 0.0) });
    forces(&slack, &state, p, &mut scratch);
    for v in (0..model.mesh.n_vertices()).filter(|&v| !model.mesh.is_on_rim[v]) {
        // Oracle: inside the sheet, load = p · gradient. Tolerance: rounding.
        assert!((scratch.forces[v] - loads[v]).norm() < 1e-13 * loads[v].norm().max(1e-3));
    }
    let lid = pressure::lid_area_vector(&model.mesh, &state.positions);
    let on_sheet: Vec3 = scratch.forces.iter().sum();
    // Oracle: sheet and lid together are closed. Tolerance: rounding.
    assert!((on_sheet + lid * p).norm() < 1e-13 * on_sheet.norm());
}

/// Oracle: C5, power of the load = gauge pressure times rate of volume, by central differences.
fn check_power(model: &MembraneModel, state: &MembraneState, loads: &[Vec3], p: Real) {
    let h = 1e-6;
    let at = |time: Real| {
        let moved = state.positions.iter().zip(&state.velocities);
        pressure::volume(&model.mesh, &moved.map(|(r, v)| r + v * time).collect::<Vec<_>>())
    };
    let rate = (at(h) - at(-h)) / (2.0 * h);
    let oracle = p * rate;
    let found = power(loads, &state.velocities);
    // Tolerance: the volume is a cubic in time; rounding of V ~ 10⁻⁴ m³ over 2h against the rate.
    let size: Real = loads.iter().zip(&state.velocities).map(|(f, v)| f.dot(v).abs()).sum();
    assert!((found - oracle).abs() < 1e-6 * size, "{found} for {oracle}");
}

#[test]
fn the_volume_of_the_whole_and_half_sphere_meet() {
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
    let sheet = Sheet { spring_damping: 0.5, ..rubber(0.0, 0.0) };
    let model = model_of(Mesh::icosphere(0.04, 8), sheet);
    let mut state = MembraneState::at_rest(&model.mesh);
    let dt = 0.5 * critical_step(&model, 0.0);
    let mut last = Real::INFINITY;
    for _ in 0..40 {
        run(&model, &mut state, dt, 50, p);
        last = state.velocities.iter().map(|v| v.norm()).fold(0.0, Real::max);
        // Slow modes are barely damped by springs: take out what they have gained.
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

#[test]
fn a_pair_rings_down_as_a_damped_oscillator() {
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
        let tension = spring.tension(x[1] - x[0], v[1] - v[0]);
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
fn the_bits_do_not_depend_on_the_number_of_threads() {
    let model = model_of(Mesh::half_icosphere(0.04, 16), rubber(1e-3, 1e-4));
    let state = shaken(&model, 1e-4, 0.1);
    let on = |n| parallel::pool(n).unwrap().install(|| forces_on(&model, &state, -9e4));
    let bits = |forces: Vec<Vec3>| -> Vec<[u64; 3]> {
        forces.iter().map(|f| [f.x.to_bits(), f.y.to_bits(), f.z.to_bits()]).collect()
    };
    // Oracle: the same computation on one thread, bit by bit.
    assert_eq!(bits(on(1)), bits(on(3)));
}

#[test]
fn rest_lengths_scale() {
    let mut model = model_of(Mesh::hexagonal_patch(3e-3, 3), rubber(0.0, 0.0));
    model.scale_rest_lengths(0.875);
    let state = MembraneState {
        positions: model.mesh.positions.iter().map(|p| p * 0.875).collect(),
        ..MembraneState::at_rest(&model.mesh)
    };
    let (_, _, size) = totals(&state, &forces_on(&model, &state, 0.0));
    // Oracle: the scaled shape is free of stress. Tolerance: k times rounding of lengths.
    assert!(size < 1e-12, "{size}");
}

#[test]
fn the_critical_step_of_a_lattice_is_known() {
    let sheet = Sheet { spring_damping: 0.0, ..rubber(0.0, 0.0) };
    let model = model_of(Mesh::hexagonal_patch(3e-3, 12), sheet);
    let inner = model.masses.iter().copied().fold(0.0, Real::max);
    let found = critical_step(&model, 0.0);
    let oracle = 2.0 / (6.0 * stretch::stiffness(1.25e6, 0.3e-3) / inner).sqrt();
    // Oracle: U11, 2/ω with ω² = 6 k/m. Tolerance: 1 % of margin in the step, the finite patch, and
    // power iteration from below.
    assert!((found / oracle - 1.0).abs() < 0.03, "{found} for {oracle}");
}

#[test]
fn the_critical_step_separates_rest_from_blow_up() {
    for sheet in [
        Sheet { spring_damping: 0.0, ..rubber(0.0, 0.0) },
        rubber(0.0, 0.0),
        Sheet { spring_damping: 0.0, ..rubber(1e-3, 0.0) },
        rubber(1e-3, 1e-5),
        rubber(1e-3, 1e-4),
    ] {
        let model = model_of(Mesh::half_icosphere(0.04, 8), sheet);
        let limit = critical_step(&model, 0.0);
        let speed_after = |share: Real| {
            let mut state = shaken(&model, 1e-8, 0.0);
            run(&model, &mut state, share * limit, 3000, 0.0)
        };
        let stable = speed_after(0.98);
        let unstable = speed_after(1.15);
        // Oracle: definition of the limit. A displacement of 10⁻⁸ m at ω ~ 10⁵/s cannot pass
        // 10⁻² m/s while the scheme is stable. Above the limit the stiffest mode grows by some
        // 10 % in each step. 15 %: margin, and κ and c from different modes.
        assert!(stable < 1e-2, "{sheet:?} at 0.98: {stable} m/s");
        assert!(unstable.is_nan() || unstable > 1.0, "{sheet:?} at 1.15: {unstable} m/s");
    }
}
