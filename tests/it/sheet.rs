//! A grain on the sheet: what crosses edges and vertices, what leaks, and how it slides.
#![expect(clippy::print_stderr, reason = "what was measured is shown with the result")]

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
/// grains lie on it as they lie in a bag.
pub(crate) fn hexagon(n: i32, edge: Real) -> Mesh {
    let place = |i: i32, j: i32| {
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
    Mesh::new(cells.iter().map(|&(i, j)| place(i, j)).collect(), triangles).unwrap()
}

/// One grain on a held sheet of the shape of `mesh`.
fn rig(mesh: Mesh, surface: Surface, radius: Real, dt: Real) -> Rig {
    let mut rig = Rig::on_sheet(&GRAIN, surface, mesh, dt);
    rig.add_grain(Vec3::z() * radius, Vec3::zeros(), radius, GRAIN.density);
    rig
}

/// The contacts of the grain if it is put at `position`, at rest.
fn contacts_at(rig: &mut Rig, position: Vec3) -> Vec<PatchForce> {
    rig.state.grains.positions[0] = position;
    rig.state.grains.velocities[0] = Vec3::zeros();
    // The lists are told of motion by the integrator alone.
    rig.scratch.neighbors.is_built = false;
    rig.step();
    let patches = &rig.scratch.patch_forces[0];
    patches.contacts[..patches.n].to_vec()
}

/// Sum of forces, and where their resultant acts.
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

/// Runs on one thread, where forking costs next to nothing.
pub(crate) fn alone(test: impl FnOnce() + Send) {
    parallel::lead(&parallel::ThreadPool::new(1).unwrap(), test);
}

/// Three ways over the patch: along an edge and over its vertices, through vertices along a height,
/// and in no special direction.
fn ways() -> [(Vec3, Vec3); 3] {
    [
        (Vec3::new(-2.5 * EDGE, 0.0, 0.0), Vec3::x() * 5.0 * EDGE),
        (Vec3::new(0.0, -3.0 * EDGE, 0.0), Vec3::y() * 6.0 * EDGE),
        (Vec3::new(-2.1 * EDGE, -0.7 * EDGE, 0.0), Vec3::new(4.3, 1.7, 0.0) * EDGE),
    ]
}

#[test]
fn on_a_flat_sheet_force_direction_and_point_do_not_know_the_mesh() {
    alone(|| {
        let mut rig = rig(hexagon(4, EDGE), elastic(0.0), RADIUS, 1e-6);
        let overlap = 0.1 * RADIUS;
        // Oracle: Hertz for one contact, straight up, under the centre. Tolerance: rounding of
        // positions (1e-16 of 10 mm over an overlap of 0.2 mm).
        let expected = hertz_constant(&rig.model.membrane_law, RADIUS) * overlap.powf(1.5);
        let mut worst = [0.0_f64; 3];
        for (from, along) in ways() {
            for step in 0..=2000 {
                let mut position = from + along * (Real::from(step) / 2000.0);
                position.z = RADIUS - overlap;
                let contacts = contacts_at(&mut rig, position);
                assert_eq!(contacts.len(), 1, "one contact at {position:?}");
                let (force, point) = resultant(&rig, &contacts);
                worst[0] = worst[0].max((force.norm() / expected - 1.0).abs());
                worst[1] = worst[1].max((force.xy().norm() / expected).abs());
                worst[2] = worst[2].max((point.xy() - position.xy()).norm() / EDGE);
                // Oracle: what the grain gets, the vertices give, force and moment.
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
fn friction_does_not_see_edges() {
    alone(|| {
        // The slide test: R = 2 mm over triangles of 1.33 mm at 50 mm/s, only the height is free.
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
        let (mut least, mut most, mut n, mut sum) = (Real::INFINITY, 0.0_f64, 0, 0.0);
        let n_steps = 16_000;
        for step in 0..n_steps {
            let velocity = &mut rig.state.grains.velocities[0];
            (velocity.x, velocity.y) = (0.05, 0.0);
            rig.state.grains.angular_velocities[0] = Vec3::zeros();
            rig.step();
            if 0.05 * 1e-5 * Real::from(step) > 2.0 * stick {
                let patches = &rig.scratch.patch_forces[0];
                let force: Vec3 = patches.contacts[..patches.n].iter().map(|it| it.force).sum();
                (least, most) = (least.min(-force.x), most.max(-force.x));
                (n, sum) = (n + 1, sum - force.x);
            }
        }
        assert!(n > n_steps / 2, "the stick phase ends after {stick} m");
        let mean = sum / Real::from(n);
        let travelled = rig.state.grains.positions[0].x / edge + 6.1;
        eprintln!(
            "slide over {travelled:.1} edges: F/(mu N) {}, ripple {:e}",
            mean / (1.2 * load),
            (most - least) / mean
        );
        // Oracle: Coulomb, F = μ N. Tolerances: those of the source's slide test.
        assert!((mean / (1.2 * load) - 1.0).abs() < 1e-3, "{mean} N");
        assert!((most - least) / mean < 5e-3, "between {least} and {most} N");
    });
}

/// A grain under `pressure` [Pa] on its square, laid on the sheet at `place`; its substeps.
fn press(radius: Real, pressure: Real, place: Vec3) -> Result<Rig, health::Diverged> {
    let surface = Surface { friction: 0.25, dissipation_time: 1e-5, tangential_damping: 0.3 };
    let mut rig = Rig::on_sheet(&GRAIN, surface, hexagon(3, EDGE), 2e-7);
    rig.add_grain(place + Vec3::z() * radius, Vec3::zeros(), radius, GRAIN.density);
    let load = pressure * (2.0 * radius).powi(2);
    for step in 0..20_000 {
        // Slowly, so that the load is that load and not an impact.
        let share = (Real::from(step) / 10_000.0).min(1.0);
        rig.model.gravity = Vec3::z() * -(share * load / rig.state.grains.masses[0]);
        rig.step();
        health::check(&rig.state, &rig.scratch, 0)?;
    }
    Ok(rig)
}

/// On a face, an edge and a vertex.
fn places() -> [Vec3; 3] {
    [Vec3::new(0.4, 0.25, 0.0) * EDGE, Vec3::new(0.37, 0.0, 0.0) * EDGE, Vec3::zeros()]
}

#[test]
fn a_grain_of_a_tenth_of_an_edge_does_not_leak_at_100_kpa() {
    alone(|| {
        let radius = 0.1 * EDGE;
        for place in places() {
            let rig = press(radius, 100e3, place).unwrap();
            let load = 100e3 * (2.0 * radius).powi(2);
            let overlap = radius - rig.state.grains.positions[0].z;
            let expected = (load / hertz_constant(&rig.model.membrane_law, radius)).powf(2.0 / 3.0);
            eprintln!(
                "overlap / radius {:.3}, / Hertz − 1 {:e}",
                overlap / radius,
                overlap / expected - 1.0
            );
            // Oracle: Hertz. Tolerance: what is left of the swing after the ramp.
            assert!((overlap / expected - 1.0).abs() < 1e-3, "{overlap:e} m");
        }
    });
}

#[test]
fn a_grain_pushed_through_is_found() {
    alone(|| {
        // Oracle: F(ξ = R) = k R²; at 20 times the load the contact cannot hold it.
        for place in places() {
            let fault = press(0.1 * EDGE, 2e6, place).map(|_| ()).unwrap_err();
            eprintln!("{place:?}: {fault}");
            assert!(fault.what.contains("leaks"), "{fault}");
            assert_eq!(fault.which, 0);
        }
    });
}

/// Lays a grain on a taut hexagon of `n` edges along each side; the share of all weight that the
/// rim carries, and how deep the grain has sunk.
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
        // Only the end counts: what swings is damped, and the grain may not roll away.
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
fn a_taut_sheet_carries_the_whole_weight_wherever_the_grain_lies() {
    alone(|| {
        // On a vertex, an edge, a face; the gripper's mesh, and one much finer than the grain.
        for (n, edge) in [(4, EDGE), (9, 0.5e-3)] {
            let mut depths = Vec::new();
            for offset in [[0.0, 0.0], [0.5, 0.0], [0.5, 0.288_675]] {
                let (carried, depth) = sag(n, edge, offset);
                eprintln!(
                    "{n} {offset:?}: carried/weight − 1 {:e}, depth {depth:e}",
                    carried - 1.0
                );
                // Oracle: vertical equilibrium. Tolerance 0.1 %: what still swings.
                assert!((carried - 1.0).abs() < 1e-3, "{carried} of the weight");
                depths.push(depth);
            }
            let least = depths.iter().copied().fold(Real::INFINITY, Real::min);
            let most = depths.iter().copied().fold(0.0, Real::max);
            eprintln!("{n}: depth varies by {:.3} %", 100.0 * (most / least - 1.0));
            // Oracle: a continuous sheet has no mesh. Tolerance 1 %, where the mesh is fine; a grain
            // smaller than an edge does know whether it lies on a vertex or on a face.
            assert!(edge > RADIUS / 2.0 || most / least < 1.01, "depths {depths:?}");
        }
    });
}
