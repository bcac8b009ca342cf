//! Grains on a membrane with vertex spheres instead of triangles.

use jamgrip::{
    base::{Real, Vec3, digest::Digest, parallel},
    cosim::saved_state,
    physics::{
        Scratch, health,
        law::Surface,
        membrane::{FREE, MembraneContact},
        scratch::SphereForce,
    },
};

use crate::{
    membrane::{hexagon, on_one_thread},
    rig::{GRAIN, Rig, elastic, hertz_constant},
};

const EDGE: Real = 1.33e-3;
const SPHERE: Real = 0.67e-3;
const RADIUS: Real = 2e-3;

/// A fixed hexagon of spheres, `n` edges along each side; its outside is below.
fn rig(n: i32, surface: Surface, dt: Real) -> Rig {
    let mut rig = Rig::on_membrane(&GRAIN, surface, hexagon(n, EDGE), dt);
    rig.model.membrane.contact = MembraneContact::Spheres { radius: SPHERE };
    rig
}

/// The contacts with a force.
fn loaded(rig: &Rig) -> Vec<SphereForce> {
    rig.scratch.sphere_forces.iter().filter(|it| it.flags.touches()).copied().collect()
}

fn shared_radius() -> Real {
    RADIUS * SPHERE / (RADIUS + SPHERE)
}

#[test]
fn the_force_is_that_of_two_spheres() {
    on_one_thread(|| {
        // A grain above a vertex, an edge and a triangle, at a height at which it overlaps one, two or
        // three spheres by the same ξ.
        let overlap = 1e-5;
        let distance = RADIUS + SPHERE - overlap;
        let positions = [
            (1, Vec3::zeros()),
            (2, Vec3::new(0.5, 0.0, 0.0) * EDGE),
            (3, Vec3::new(0.5, 0.75_f64.sqrt() / 3.0, 0.0) * EDGE),
        ];
        for (n, position) in positions {
            let mut rig = rig(3, elastic(0.0), 1e-6);
            let height = (distance * distance - position.norm_squared()).sqrt();
            rig.add_grain(position + Vec3::z() * height, Vec3::zeros(), RADIUS, GRAIN.density);
            rig.step();
            let contacts = loaded(&rig);
            assert_eq!(contacts.len(), n, "spheres below {position:?}");
            // Oracle: Hertz, F = 4/3 E* √R* ξ^(3/2) with R* = R r/(R + r), along the line of
            // centers. Tolerance: rounding of positions (1e-16 of 3 mm over an overlap of 10 µm).
            let expected =
                hertz_constant(&rig.model.membrane_law, shared_radius()) * overlap.powf(1.5);
            for contact in &contacts {
                let vertex = rig.model.membrane.mesh.positions[contact.vertex as usize];
                let direction = (position + Vec3::z() * height - vertex).normalize();
                assert!((contact.force - direction * expected).norm() < 1e-9 * expected);
                assert!((contact.overlap / overlap - 1.0).abs() < 1e-9);
            }
        }
    });
}

#[test]
fn forces_on_grain_and_vertices_are_opposite() {
    on_one_thread(|| {
        let surface = Surface { friction: 1.2, dissipation_time: 1e-5, tangential_damping: 0.3 };
        let mut rig = rig(4, surface, 1e-6);
        let position = Vec3::new(0.62e-3, 0.35e-3, RADIUS + 0.52e-3);
        rig.add_grain(position, Vec3::new(0.2, -0.1, -0.05), RADIUS, GRAIN.density);
        rig.state.grains.angular_velocities[0] = Vec3::new(20.0, 30.0, -40.0);
        let mut n_touched = 0;
        for _ in 0..300 {
            let (x, velocity) = (rig.state.grains.positions[0], rig.state.grains.velocities[0]);
            let spin = rig.state.grains.angular_velocities[0];
            rig.step();
            let mass = rig.state.grains.masses[0];
            let gained = (rig.state.grains.velocities[0] - velocity) * (mass / rig.model.substep);
            let inertia = 0.4 * mass * RADIUS * RADIUS;
            let turned =
                (rig.state.grains.angular_velocities[0] - spin) * (inertia / rig.model.substep);
            let (mut moment, mut couple, mut scale) = (Vec3::zeros(), Vec3::zeros(), 0.0);
            for (r, f) in rig.model.membrane.mesh.positions.iter().zip(&rig.scratch.vertex_forces) {
                moment += r.cross(f);
            }
            for contact in loaded(&rig) {
                let vertex = rig.model.membrane.mesh.positions[contact.vertex as usize];
                let normal = (x - vertex).normalize();
                couple += normal.cross(&contact.force) * (SPHERE - contact.overlap / 2.0);
                scale += contact.force.norm();
            }
            n_touched = n_touched.max(loaded(&rig).len());
            // Oracle: Newton's third law, with force and reaction at the same point. The difference of
            // the moments about the vertices is the couple that keeps their spheres from rotating.
            // Tolerance: rounding of velocities of 0.2 m/s.
            let sum: Vec3 = rig.scratch.vertex_forces.iter().sum();
            let rounding = 1e-15 * mass / rig.model.substep;
            assert!((sum + gained).norm() <= 1e-12 * scale + rounding, "{sum:?} {gained:?}");
            let total = moment + x.cross(&gained) + turned;
            let spin_rounding = 1e-13 * inertia / rig.model.substep;
            let close = 1e-12 * scale * RADIUS + rounding * RADIUS + spin_rounding;
            assert!((total - couple).norm() <= close, "{total:?} {couple:?}");
        }
        assert!(n_touched > 2, "the grain was in a hollow");
    });
}

#[test]
fn a_free_membrane_and_a_smooth_grain_conserve_momentum() {
    on_one_thread(|| {
        let mut rig = rig(4, elastic(0.0), 1e-6);
        rig.model.membrane.holders.fill(FREE);
        rig.add_grain(
            Vec3::new(0.3e-3, 0.2e-3, RADIUS + 0.7e-3),
            Vec3::new(0.0, 0.0, -0.5),
            RADIUS,
            GRAIN.density,
        );
        let total = |rig: &Rig| {
            let (mut linear, mut angular) = rig.momenta();
            let membrane = &rig.state.membrane;
            for ((r, v), m) in
                membrane.positions.iter().zip(&membrane.velocities).zip(&rig.model.membrane.masses)
            {
                linear += v * *m;
                angular += r.cross(v) * *m;
            }
            (linear, angular)
        };
        let (linear, angular) = total(&rig);
        for _ in 0..3000 {
            rig.step();
        }
        let (linear_now, angular_now) = total(&rig);
        assert!(rig.state.grains.velocities[0].z > -0.4, "the membrane has slowed the grain");
        // Oracle: conservation. Tolerance: rounding of 3000 substeps.
        assert!((linear_now - linear).norm() < 1e-12 * linear.norm());
        assert!((angular_now - angular).norm() < 1e-12 * linear.norm() * RADIUS);
    });
}

/// A heap of grains that falls onto a taut membrane of spheres.
fn heap() -> Rig {
    let surface = Surface { friction: 0.5, dissipation_time: 1e-5, tangential_damping: 0.3 };
    let mut rig = rig(9, surface, 4e-6);
    rig.model.gravity = Vec3::z() * -9.81;
    let rim = rig.model.membrane.mesh.is_on_rim.clone();
    for (holder, is_on_rim) in rig.model.membrane.holders.iter_mut().zip(rim) {
        *holder = if is_on_rim { *holder } else { FREE };
    }
    rig.model.membrane.scale_rest_lengths(0.9);
    for layer in 0..3 {
        for column in 0..9 {
            let (x, y) = (Real::from(column % 3 - 1), Real::from(column / 3 - 1));
            let shift = 0.3 * Real::from(layer);
            let position = Vec3::new(
                (x * 2.1 + shift) * RADIUS,
                (y * 2.1 - shift) * RADIUS,
                (1.4 + 2.1 * Real::from(layer)) * RADIUS,
            );
            let velocity = Vec3::new(0.1 * y, -0.1 * x, -0.3);
            rig.add_grain(position, velocity, RADIUS, GRAIN.density);
        }
    }
    rig.model.skin = 0.25 * RADIUS;
    rig
}

fn digest(rig: &Rig) -> u64 {
    let mut digest = Digest::new();
    rig.state.digest(&mut digest);
    digest.finish()
}

/// Results of a run with a heap.
struct HeapRun {
    digests: Vec<u64>,
    n_builds: u64,
    /// Largest number of simultaneously loaded springs.
    n_loaded_max: usize,
}

fn run(mut rig: Rig, n_threads: usize) -> HeapRun {
    let (mut digests, mut n_loaded_max) = (Vec::new(), 0);
    parallel::lead(&parallel::ThreadPool::new(n_threads).unwrap(), || {
        for step in 0..4000 {
            rig.step();
            if step % 100 == 99 {
                digests.push(digest(&rig));
                let springs = &rig.state.springs.spheres.springs;
                let n_loaded = springs.iter().filter(|it| **it != Vec3::zeros()).count();
                n_loaded_max = n_loaded_max.max(n_loaded);
            }
        }
    });
    health::check(&rig.state, &rig.scratch, 0).unwrap();
    HeapRun { digests, n_builds: rig.scratch.neighbors.n_builds, n_loaded_max }
}

#[test]
fn threads_and_rebuilds_change_no_bit() {
    let expected = run(heap(), 1);
    assert!(expected.n_builds > 3, "lists were built {} times", expected.n_builds);
    assert!(expected.n_loaded_max > 20, "only {} springs were loaded", expected.n_loaded_max);
    for (n_threads, share) in [(2, 1.0), (7, 1.0), (1, 0.2), (2, 3.0)] {
        let mut rig = heap();
        rig.model.skin *= share;
        let found = run(rig, n_threads);
        let same_skin = share.to_bits() == 1.0_f64.to_bits();
        assert_eq!(
            found.n_builds == expected.n_builds,
            same_skin,
            "the lists are built at other times"
        );
        // Oracle: the run on one thread with the usual skin, to the last bit: also the springs,
        // which are transferred at other times.
        assert_eq!(found.digests, expected.digests, "{n_threads} threads, skin × {share}");
    }
}

#[test]
fn a_saved_heap_continues_with_the_same_bits() {
    on_one_thread(|| {
        let mut uninterrupted = heap();
        (0..1500).for_each(|_| uninterrupted.step());
        let mut resumed = heap();
        resumed.state = saved_state::read(&saved_state::write(&uninterrupted.state)).unwrap();
        resumed.scratch = Scratch::new(&resumed.model);
        for _ in 0..500 {
            uninterrupted.step();
            resumed.step();
        }
        // Oracle: the uninterrupted run.
        assert_eq!(digest(&resumed), digest(&uninterrupted));
    });
}

/// A grain much smaller than a hole of the membrane falls through it.
#[test]
fn a_grain_that_falls_through_a_hole_is_detected() {
    on_one_thread(|| {
        let mut rig = rig(3, elastic(0.0), 1e-5);
        let hole = Vec3::new(0.5, 0.75_f64.sqrt() / 3.0, 0.0) * EDGE;
        rig.add_grain(hole + Vec3::z() * 1e-3, Vec3::z() * -0.1, 0.05e-3, GRAIN.density);
        rig.model.skin = 0.25 * 0.05e-3;
        let mut height_found = None;
        for _ in 0..3000 {
            rig.step();
            let height = rig.state.grains.positions[0].z;
            if health::check(&rig.state, &rig.scratch, 0).is_err() {
                height_found = Some(height);
                break;
            }
        }
        // Oracle: the position of the grain. It must be detected after its center has crossed z = 0 and
        // before it is farther away than the skin.
        let height = height_found.unwrap();
        assert!(height < 0.0 && height > -rig.model.skin, "found at {height:e} m");
    });
}
