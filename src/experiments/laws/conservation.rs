//! Invariants of every contact law: momentum, angular momentum, energy, and invariance under
//! rotation of the whole scene.

use super::{
    Law, RowSpec,
    build::{Encounter, G, TestSystem, elastic},
    scene::LawsScene,
};
use crate::{
    base::real::real,
    base::{Real, Vec3},
    experiments::{findings::Expected, record::Record},
};

pub(super) struct Conservation;

const POINTS: [fn(&LawsScene, &mut Record); 4] = [momenta, stack, rotated, rigid_rotation];

impl Law for Conservation {
    fn name(&self) -> &'static str {
        "conservation"
    }

    fn n_points(&self, _: &LawsScene) -> usize {
        POINTS.len()
    }

    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record) {
        POINTS[point](scene, record);
    }

    fn rows(&self) -> &'static [RowSpec] {
        ROWS
    }
}

/// Off-center collision of two unequal grains, one of which spins; everything rotated by `turn`.
fn off_center(scene: &LawsScene, rotation: &nalgebra::Rotation3<Real>) -> (TestSystem, Real) {
    let grain = &scene.grain;
    let encounter = Encounter::equal(grain.radius, grain.material, grain.surface, 0.5);
    let dt = encounter.collision().duration() / real(scene.steps_per_contact);
    let mut test = TestSystem::on_plane(&grain.material, grain.surface, dt);
    // Just clear of the plane: rounding grows with the distance from the origin.
    let high = Vec3::z() * (4.0 * grain.radius);
    for (offset, radius) in [(Vec3::zeros(), 1.0), (Vec3::new(1.46, 0.25, 0.3), 0.5)] {
        let position = high + rotation * offset * grain.radius;
        test.add_grain(position, radius * grain.radius, grain.material.density);
    }
    test.grains_mut().velocities[0] = rotation * Vec3::new(0.5, 0.1, 0.0);
    test.grains_mut().angular_velocities[0] = rotation * Vec3::new(30.0, -60.0, 100.0);
    (test, 3.0 * real(scene.steps_per_contact))
}

fn momenta(scene: &LawsScene, record: &mut Record) {
    let (mut test, n_steps) = off_center(scene, &nalgebra::Rotation3::identity());
    let about_center = |test: &TestSystem| {
        let (linear, angular) = test.momenta();
        let grains = test.grains();
        let mass: Real = grains.masses.iter().sum();
        let moment =
            grains.positions[0] * grains.masses[0] + grains.positions[1] * grains.masses[1];
        (linear, angular - (moment / mass).cross(&linear))
    };
    let before = about_center(&test);
    let mut step = 0;
    while real(step) < n_steps {
        test.step();
        step += 1;
    }
    let after = about_center(&test);
    let has_collided = test.grains().velocities[1].norm() > 0.1;
    let change =
        |a: Vec3, b: Vec3| if has_collided { (a - b).norm() / b.norm() } else { Real::NAN };
    record.set("U6.momentum", change(after.0, before.0), "1");
    record.set("U6.angular_momentum", change(after.1, before.1), "1");
}

/// Two elastic grains on top of each other over a plane, for a hundred contacts.
fn stack(scene: &LawsScene, record: &mut Record) {
    let grain = &scene.grain;
    let radius = grain.radius;
    let mut test = TestSystem::on_plane(&grain.material, elastic(0.0), 1e-6);
    test.system.model.gravity = Vec3::z() * -G;
    test.add_grain(Vec3::z() * (1.25 * radius), radius, grain.material.density);
    test.add_grain(Vec3::z() * (3.5 * radius), radius, grain.material.density);
    let energy = |test: &TestSystem| {
        let grains = test.grains();
        let height = |i: usize| grains.masses[i] * G * (grains.positions[i].z - radius);
        height(0) + height(1) + test.kinetic_energy()
    };
    let start = energy(&test);
    let (mut n_contacts, mut touched, mut worst) = (0, false, 0.0_f64);
    while n_contacts < 100 {
        test.step();
        let scratch = &test.system.scratch;
        let touching = scratch.wall_forces.iter().any(|it| it.flags.touches())
            || scratch.pair_flags.iter().any(|it| it.touches());
        n_contacts += usize::from(touching && !touched);
        if !touching && !touched {
            worst = worst.max((energy(&test) / start - 1.0).abs());
        }
        touched = touching;
    }
    record.set("U6.energy", worst, "1");
}

/// The same collision in a rotated scene, rotated back.
fn rotated(scene: &LawsScene, record: &mut Record) {
    let rotation = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0);
    let (mut test, n_steps) = off_center(scene, &nalgebra::Rotation3::identity());
    let (mut other, _) = off_center(scene, &rotation);
    let mut step = 0;
    while real(step) < n_steps {
        test.step();
        other.step();
        step += 1;
    }
    let mut worst = 0.0_f64;
    for i in 0..2 {
        let (a, b) = (test.grains(), other.grains());
        let speed = (rotation * a.velocities[i] - b.velocities[i]).norm() / a.velocities[i].norm();
        let spin = (rotation * a.angular_velocities[i] - b.angular_velocities[i]).norm()
            / a.angular_velocities[i].norm();
        worst = worst.max(speed).max(spin);
    }
    record.set("U7.turned_scene", worst, "1");
}

/// A pair that rotates as one body about an axis perpendicular to its normal, once without and once
/// with a stretched friction spring.
fn rigid_rotation(scene: &LawsScene, record: &mut Record) {
    let (force, normal) = rotate_pair(scene, 0.0);
    record.set("U7.unsheared_pair", force[1].norm() / normal, "1");
    let (force, _) = rotate_pair(scene, 1e-3);
    // After a full rotation the force must be the same.
    record.set("U7.sheared_pair", (force[1] - force[0]).norm() / force[0].norm(), "1");
}

/// Tangential force at the start and after a full rotation (N), and the normal force (N).
fn rotate_pair(scene: &LawsScene, shear_over_overlap: Real) -> ([Vec3; 2], Real) {
    let grain = &scene.grain;
    let (radius, n_steps) = (grain.radius, 20_000);
    let overlap = 0.01 * radius;
    let mut test = TestSystem::on_plane(&grain.material, elastic(grain.surface.friction), 1e-6);
    let high = Vec3::z() * (20.0 * radius);
    let half = radius - 0.5 * overlap;
    for side in [-1.0, 1.0] {
        test.add_grain(high + Vec3::x() * (side * half), radius, grain.material.density);
    }
    let mut tangential = [Vec3::zeros(); 2];
    let mut normal = 0.0;
    let spin = 2.0 * std::f64::consts::PI / (real(n_steps) * 1e-6);
    for step in 0..=n_steps {
        let angle = spin * real(step) * 1e-6;
        let along = Vec3::new(angle.cos(), angle.sin(), 0.0);
        let grains = test.grains_mut();
        for (i, side) in [-1.0, 1.0].into_iter().enumerate() {
            let arm = along * (side * half);
            grains.positions[i] = high + arm;
            grains.angular_velocities[i] = Vec3::z() * spin;
            grains.velocities[i] = (Vec3::z() * spin).cross(&arm);
        }
        if step == 0 {
            // One step of shear, parallel and perpendicular to the plane of rotation.
            let shear = Vec3::new(0.0, 1.0, 0.5) * (shear_over_overlap * overlap / 1e-6);
            grains.velocities[0] += shear;
        }
        test.step();
        let pair = &test.system.scratch.pair_forces[0];
        let found = pair.force - along * pair.force.dot(&along);
        normal = pair.normal;
        if step == 0 {
            tangential[0] = found;
        }
        tangential[1] = found;
    }
    (tangential, normal)
}

const ROWS: &[RowSpec] = &[
    (
        "U6.momentum",
        "relative change of momentum in a collision of two unequal, spinning grains",
        "action equals reaction; Götz (2024) eqs. 4–11",
        Expected::at_most(1e-12),
        "rounding over the steps of a collision",
    ),
    (
        "U6.angular_momentum",
        "relative change of angular momentum about the center of mass",
        "the torques on both grains act at the same contact point",
        Expected::at_most(1e-12),
        "rounding over the steps of a collision",
    ),
    (
        "U6.energy",
        "largest relative energy drift of two elastic grains over a hundred contacts",
        "conservation of energy",
        Expected::at_most(1e-4),
        "1e-4: time step; the integrator is symplectic, so the drift does not grow",
    ),
    (
        "U7.turned_scene",
        "largest relative difference of velocities and spins after a collision in a rotated scene",
        "isotropy of space",
        Expected::at_most(1e-9),
        "rounding of 1e-16 of positions relative to overlaps, propagated through a collision",
    ),
    (
        "U7.unsheared_pair",
        "tangential divided by normal force of a pair that rotates as one body",
        "a rigid rotation causes no shear",
        Expected::at_most(1e-9),
        "rounding, summed over 20000 steps",
    ),
    (
        "U7.sheared_pair",
        "relative change of the friction force of a sheared pair after a full rigid rotation \
        about an axis perpendicular to its normal",
        "the spring rotates with the tangent plane",
        Expected::at_most(1e-3),
        "1e-3: a step of 3e-4 rad shortens one component of the spring, and keeping its length \
        lengthens both; 4e-4 in a full rotation, ten times less with ten times the steps. For \
        rotation about the normal itself the spring does not rotate, as in the source, which only \
        projects it",
    ),
];
