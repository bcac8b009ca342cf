//! A grain on the membrane: contact forces across edges and vertices, leaks, and sliding.
#![expect(clippy::print_stderr, reason = "prints measured values")]

use jamgrip::{
    base::{Real, Vec3, parallel},
    physics::{
        health,
        law::Surface,
        membrane::{CARRIER_ID, FREE, mesh::Mesh},
        scratch::PatchForce,
    },
};

use crate::rig::{G, GRAIN, Rig, elastic, hertz_constant};

const EDGE: Real = 3e-3;
const RADIUS: Real = 2e-3;

/// A hexagon of equilateral triangles in z = 0, `n` edges along each side. Its outside is below:
/// grains lie on its inside.
pub(crate) fn hexagon(n: i32, edge: Real) -> Mesh {
    let position = |i: i32, j: i32| {
        let (i, j) = (Real::from(i), Real::from(j));
        Vec3::new(i + 0.5 * j, 0.75_f64.sqrt() * j, 0.0) * edge
    };
    let is_inside = |i: i32, j: i32| i.abs() <= n && j.abs() <= n && (i + j).abs() <= n;
    let cells: Vec<(i32, i32)> = (-n..=n)
        .flat_map(|j| (-n..=n).map(move |i| (i, j)))
        .filter(|&(i, j)| is_inside(i, j))
        .collect();
    let id = |i: i32, j: i32| {
        let at = cells.iter().position(|&cell| cell == (i, j))?;
        Some(u32::try_from(at).unwrap())
    };
    let mut triangles = Vec::new();
    for &(i, j) in &cells {
        for corners in [[(i, j), (i, j + 1), (i + 1, j)], [(i, j), (i + 1, j), (i + 1, j - 1)]] {
            let ids: Vec<u32> = corners.iter().filter_map(|&(i, j)| id(i, j)).collect();
            if let Ok(triangle) = <[u32; 3]>::try_from(ids) {
                triangles.push(triangle);
            }
        }
    }
    Mesh::new(cells.iter().map(|&(i, j)| position(i, j)).collect(), triangles).unwrap()
}

/// One grain on a fixed membrane with the shape of `mesh`.
fn rig(mesh: Mesh, surface: Surface, radius: Real, dt: Real) -> Rig {
    let mut rig = Rig::on_membrane(&GRAIN, surface, mesh, dt);
    rig.add_grain(Vec3::z() * radius, Vec3::zeros(), radius, GRAIN.density);
    rig
}

/// The contacts of the grain at rest at `position`.
fn contacts_at(rig: &mut Rig, position: Vec3) -> Vec<PatchForce> {
    rig.state.grains.positions[0] = position;
    rig.state.grains.velocities[0] = Vec3::zeros();
    // Only the integrator tracks motion for the neighbor lists.
    rig.scratch.neighbors.is_built = false;
    rig.step();
    let patches = &rig.scratch.patch_forces[0];
    patches.contacts[..patches.n].to_vec()
}

/// Sum of the forces, and its point of application.
fn resultant(rig: &Rig, contacts: &[PatchForce]) -> (Vec3, Vec3) {
    let (mut force, mut moment) = (Vec3::zeros(), Vec3::zeros());
    for contact in contacts {
        let corners = rig.model.membrane.mesh.triangles[contact.triangle as usize];
        let mut point = Vec3::zeros();
        for (vertex, weight) in corners.iter().zip(contact.weights) {
            point += rig.model.membrane.mesh.positions[*vertex as usize] * weight;
        }
        force += contact.force;
        moment += point * contact.force.norm();
    }
    (force, moment / force.norm())
}

/// Runs `test` on one thread, which is fastest for so few grains.
pub(crate) fn on_one_thread(test: impl FnOnce() + Send) {
    parallel::lead(&parallel::ThreadPool::new(1).unwrap(), test);
}

/// Three paths over the patch, as start and displacement: along edges, along heights through vertices,
/// and in a general direction.
fn paths() -> [(Vec3, Vec3); 3] {
    [
        (Vec3::new(-2.5 * EDGE, 0.0, 0.0), Vec3::x() * 5.0 * EDGE),
        (Vec3::new(0.0, -3.0 * EDGE, 0.0), Vec3::y() * 6.0 * EDGE),
        (Vec3::new(-2.1 * EDGE, -0.7 * EDGE, 0.0), Vec3::new(4.3, 1.7, 0.0) * EDGE),
    ]
}

#[test]
fn on_a_flat_membrane_the_force_does_not_depend_on_the_mesh() {
    on_one_thread(|| {
        let mut rig = rig(hexagon(4, EDGE), elastic(0.0), RADIUS, 1e-6);
        let overlap = 0.1 * RADIUS;
        // Oracle: Hertz for one contact, straight up, under the center. Tolerance: rounding of
        // positions (1e-16 of 10 mm over an overlap of 0.2 mm).
        let expected = hertz_constant(&rig.model.membrane_law, RADIUS) * overlap.powf(1.5);
        let mut worst = [0.0_f64; 3];
        for (from, along) in paths() {
            for step in 0..=2000 {
                let mut position = from + along * (Real::from(step) / 2000.0);
                position.z = RADIUS - overlap;
                let contacts = contacts_at(&mut rig, position);
                assert_eq!(contacts.len(), 1, "one contact at {position:?}");
                let (force, point) = resultant(&rig, &contacts);
                worst[0] = worst[0].max((force.norm() / expected - 1.0).abs());
                worst[1] = worst[1].max((force.xy().norm() / expected).abs());
                worst[2] = worst[2].max((point.xy() - position.xy()).norm() / EDGE);
                // Oracle: Newton's third law for grain and vertices, force and moment.
                let vertices = &rig.scratch.vertex_forces;
                let sum: Vec3 = vertices.iter().sum();
                let moment: Vec3 = (rig.model.membrane.mesh.positions.iter().zip(vertices))
                    .map(|(r, f)| r.cross(f))
                    .sum();
                assert!((sum + force).norm() < 1e-12 * expected);
                assert!((moment + point.cross(&force)).norm() < 1e-12 * expected * EDGE);
            }
        }
        eprintln!("flat: force {:e}, direction {:e}, point {:e}", worst[0], worst[1], worst[2]);
        assert!(worst.iter().all(|&it| it < 1e-9), "{worst:?}");
    });
}

#[test]
fn friction_does_not_depend_on_edges() {
    on_one_thread(|| {
        // The slide test: R = 2 mm over triangles of 1.33 mm at 50 mm/s; only the height is free.
        let edge = 1.33e-3;
        let surface = Surface { friction: 1.2, dissipation_time: 1e-4, tangential_damping: 0.3 };
        let mut rig = rig(hexagon(8, edge), surface, RADIUS, 1e-5);
        rig.model.gravity = Vec3::z() * -G;
        let load = rig.state.grains.masses[0] * G + 0.1;
        rig.model.gravity = Vec3::z() * -(load / rig.state.grains.masses[0]);
        let overlap = (load / hertz_constant(&rig.model.membrane_law, RADIUS)).powf(2.0 / 3.0);
        rig.state.grains.positions[0] = Vec3::new(-6.1 * edge, 0.31 * edge, RADIUS - overlap);
        let stick = 1.2 * load
            / (2.0 / 3.0 * 8.0 * rig.model.membrane_law.shear_modulus * (RADIUS * overlap).sqrt());
        let (mut lowest, mut highest, mut n, mut sum) = (Real::INFINITY, 0.0_f64, 0, 0.0);
        let n_steps = 16_000;
        for step in 0..n_steps {
            let velocity = &mut rig.state.grains.velocities[0];
            (velocity.x, velocity.y) = (0.05, 0.0);
            rig.state.grains.angular_velocities[0] = Vec3::zeros();
            rig.step();
            if 0.05 * 1e-5 * Real::from(step) > 2.0 * stick {
                let patches = &rig.scratch.patch_forces[0];
                let force: Vec3 = patches.contacts[..patches.n].iter().map(|it| it.force).sum();
                (lowest, highest) = (lowest.min(-force.x), highest.max(-force.x));
                (n, sum) = (n + 1, sum - force.x);
            }
        }
        assert!(n > n_steps / 2, "the stick phase ends after {stick} m");
        let mean = sum / Real::from(n);
        let traveled = rig.state.grains.positions[0].x / edge + 6.1;
        eprintln!(
            "slide over {traveled:.1} edges: F/(mu N) {}, ripple {:e}",
            mean / (1.2 * load),
            (highest - lowest) / mean
        );
        // Oracle: Coulomb, F = μ N. Tolerances: those of the source's slide test.
        assert!((mean / (1.2 * load) - 1.0).abs() < 1e-3, "{mean} N");
        assert!((highest - lowest) / mean < 5e-3, "between {lowest} and {highest} N");
    });
}

/// Loads a grain at `position` on the membrane with `pressure` (Pa) on its square.
fn press(radius: Real, pressure: Real, position: Vec3) -> Result<Rig, health::Diverged> {
    let surface = Surface { friction: 0.25, dissipation_time: 1e-5, tangential_damping: 0.3 };
    let mut rig = Rig::on_membrane(&GRAIN, surface, hexagon(3, EDGE), 2e-7);
    rig.add_grain(position + Vec3::z() * radius, Vec3::zeros(), radius, GRAIN.density);
    let load = pressure * (2.0 * radius).powi(2);
    for step in 0..20_000 {
        // Slowly, so that there is no impact.
        let share = (Real::from(step) / 10_000.0).min(1.0);
        rig.model.gravity = Vec3::z() * -(share * load / rig.state.grains.masses[0]);
        rig.step();
        health::check(&rig.state, &rig.scratch, 0)?;
    }
    Ok(rig)
}

/// On a face, an edge and a vertex.
fn positions() -> [Vec3; 3] {
    [Vec3::new(0.4, 0.25, 0.0) * EDGE, Vec3::new(0.37, 0.0, 0.0) * EDGE, Vec3::zeros()]
}

#[test]
fn a_grain_of_a_tenth_of_an_edge_does_not_leak_at_100_kpa() {
    on_one_thread(|| {
        let radius = 0.1 * EDGE;
        for position in positions() {
            let rig = press(radius, 100e3, position).unwrap();
            let load = 100e3 * (2.0 * radius).powi(2);
            let overlap = radius - rig.state.grains.positions[0].z;
            let expected = (load / hertz_constant(&rig.model.membrane_law, radius)).powf(2.0 / 3.0);
            eprintln!(
                "overlap / radius {:.3}, / Hertz − 1 {:e}",
                overlap / radius,
                overlap / expected - 1.0
            );
            // Oracle: Hertz. Tolerance: the residual oscillation after the ramp.
            assert!((overlap / expected - 1.0).abs() < 1e-3, "{overlap:e} m");
        }
    });
}

#[test]
fn a_grain_pushed_through_is_detected() {
    on_one_thread(|| {
        // Oracle: F(ξ = R) = k R²; at 20 times the load the contact cannot hold it.
        for position in positions() {
            let error = press(0.1 * EDGE, 2e6, position).map(|_| ()).unwrap_err();
            eprintln!("{position:?}: {error}");
            assert!(error.what.contains("leaks"), "{error}");
            assert_eq!(error.which, 0);
        }
    });
}

/// A grain on a taut hexagon with `n` edges along each side: the fraction of the weight that the rim
/// carries, and the depth of the grain (m).
fn sag(n: i32, edge: Real, offset: [Real; 2]) -> (Real, Real) {
    let surface = Surface { friction: 0.0, dissipation_time: 1e-4, tangential_damping: 0.3 };
    let mut rig = rig(hexagon(n, edge), surface, RADIUS, 4e-6);
    let on_rim = |&it: &bool| if it { CARRIER_ID } else { FREE };
    rig.model.membrane.holders = rig.model.membrane.mesh.is_on_rim.iter().map(on_rim).collect();
    rig.model.membrane.material.bending_stiffness = 1e-7;
    rig.model.membrane.scale_rest_lengths(0.9);
    rig.state.grains.masses[0] = 1.3e-3;
    rig.state.grains.positions[0] += Vec3::new(offset[0], offset[1], 0.0) * edge;
    let (n_steps, n_last) = (25_000, 5000);
    let (mut carried, mut depth) = (0.0, 0.0);
    for step in 0..n_steps {
        let share = (Real::from(step) / 8000.0).min(1.0);
        rig.model.gravity = Vec3::z() * -(share * 150.0);
        // Only the final state matters: oscillations are damped, and the grain must not roll away.
        for v in &mut rig.state.membrane.velocities {
            *v *= 0.998;
        }
        let v = &mut rig.state.grains.velocities[0];
        *v = Vec3::new(0.0, 0.0, v.z * 0.998);
        rig.step();
        health::check(&rig.state, &rig.scratch, 0).unwrap();
        if step >= n_steps - n_last {
            carried -= rig.scratch.wall_wrenches[0].force.z / Real::from(n_last);
            depth += (RADIUS - rig.state.grains.positions[0].z) / Real::from(n_last);
        }
    }
    let weight = (rig.state.grains.masses[0] + rig.model.membrane.mass()) * 150.0;
    (carried / weight, depth)
}

#[test]
fn a_taut_membrane_carries_the_weight_at_any_position_of_the_grain() {
    on_one_thread(|| {
        // On a vertex, an edge, a face; the gripper's mesh, and one much finer than the grain.
        for (n, edge) in [(4, EDGE), (9, 0.5e-3)] {
            let mut depths = Vec::new();
            for offset in [[0.0, 0.0], [0.5, 0.0], [0.5, 0.288_675]] {
                let (carried, depth) = sag(n, edge, offset);
                eprintln!(
                    "{n} {offset:?}: carried/weight − 1 {:e}, depth {depth:e}",
                    carried - 1.0
                );
                // Oracle: vertical equilibrium. Tolerance 0.1 %: residual oscillation.
                assert!((carried - 1.0).abs() < 1e-3, "{carried} of the weight");
                depths.push(depth);
            }
            let lowest = depths.iter().copied().fold(Real::INFINITY, Real::min);
            let highest = depths.iter().copied().fold(0.0, Real::max);
            eprintln!("{n}: depth varies by {:.3} %", 100.0 * (highest / lowest - 1.0));
            // Oracle: a continuous membrane. Tolerance 1 % for the fine mesh; for a grain smaller than an
            // edge, the depth differs between vertex and face.
            assert!(edge > RADIUS / 2.0 || highest / lowest < 1.01, "depths {depths:?}");
        }
    });
}
