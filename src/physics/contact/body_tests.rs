//! Tests of contacts between grains and rigid bodies.

use crate::{
    base::{Pose, Quat, Real, Vec3, real::Twist},
    physics::{
        System, SystemBuilder,
        boundary::{body::BodyMotion, shape::Surface as Shape},
        builder::Wall,
        law::{PairLaw, Surface},
        model::{BodyModel, BodySurface},
    },
    scene::Material,
};

const GLASS: Material = Material { youngs_modulus: 1e7, poisson_ratio: 0.25, density: 2500.0 };
const SURFACE: Surface = Surface { friction: 0.5, dissipation_time: 3e-5, tangential_damping: 0.3 };
const RADIUS: Real = 2e-3;
const GRAVITY: Real = 9.81;

fn builder() -> SystemBuilder {
    let mut builder = SystemBuilder::of_material(&GLASS, SURFACE);
    builder.gravity(Vec3::z() * -GRAVITY).substep_of_critical(0.3);
    builder
}

fn touched(shape: Shape) -> BodyModel {
    let law = PairLaw::against_rigid(&GLASS, SURFACE);
    BodyModel::of_shape(shape, law).touches_grains(law).unwrap()
}

fn at(position: Vec3) -> BodyMotion {
    BodyMotion { pose: Pose::translation(position.x, position.y, position.z), twist: Twist::zero() }
}

/// Oracle: a plane. A grain rests on a box, a polyhedron, a cylinder and a half-space as on a floor. Tolerance:
/// rounding.
#[test]
fn a_grain_rests_on_a_body_as_on_a_plane() {
    let half = Vec3::new(0.02, 0.02, 0.01);
    let corner =
        |k: usize| Vec3::from_fn(|axis, _| if k >> axis & 1 == 0 { -half } else { half }[axis]);
    let hull = Shape::convex_hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap();
    let below = Vec3::z() * -half.z;
    let mut half_space = touched(Shape::Cuboid { half });
    half_space.surface = BodySurface::HalfSpace;
    half_space.bounding_radius = Real::INFINITY;
    let bodies = [
        (touched(Shape::Cuboid { half }), below),
        (touched(hull), below),
        (touched(Shape::cylinder(0.02, 0.02)), below),
        (half_space, Vec3::zeros()),
    ];
    let rest = |change: &dyn Fn(&mut SystemBuilder)| {
        let mut builder = builder();
        builder.grain(Vec3::new(1e-3, 0.4e-3, RADIUS), RADIUS);
        change(&mut builder);
        let mut system = builder.build().unwrap();
        (0..10_000).for_each(|_| system.step());
        system
    };
    let on_plane = rest(&|it| {
        it.wall(Wall::floor(0.0));
    });
    let weight = on_plane.state.grains.masses[0] * GRAVITY;
    for (body, origin) in &bodies {
        let system = rest(&|it| {
            it.body(body.clone(), at(*origin));
        });
        let depth = |system: &System| RADIUS - system.state.grains.positions[0].z;
        assert!((depth(&system) / depth(&on_plane) - 1.0).abs() < 1e-9, "{:?}", body.surface);
        let load = system.scratch.body_wrenches[0].force.z;
        assert!((load / weight + 1.0).abs() < 1e-6, "{load}");
    }
    // Oracle: by default, grains do not touch bodies.
    let mut untouched = bodies[0].0.clone();
    untouched.of_grains = None;
    let system = rest(&|it| {
        it.body(untouched.clone(), at(below));
    });
    assert!(system.state.grains.positions[0].z < -half.z);
}

/// Oracle: the balances of momentum and angular momentum in every substep. Tolerance: rounding.
#[test]
fn bodies_and_grains_exchange_momentum() {
    let points = [Vec3::x(), Vec3::y(), Vec3::z(), -Vec3::x(), -Vec3::y(), -Vec3::z()];
    let hull = Shape::convex_hull(&points.map(|p| p * 5e-3)).unwrap();
    let mut builder = builder();
    for k in 0..27 {
        let steps = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1].map(Real::from);
        builder.grain(Vec3::from(steps) * (2.02 * RADIUS), RADIUS);
    }
    let shapes = [
        Shape::cuboid(&Vec3::repeat(8e-3)),
        Shape::Sphere { radius: 5e-3 },
        hull,
        Shape::capsule(2e-3, 9e-3),
    ];
    let directions = [Vec3::x(), -Vec3::x(), Vec3::y(), Vec3::z()];
    for (k, (shape, direction)) in shapes.into_iter().zip(directions).enumerate() {
        let angular = Vec3::new(5.0, -3.0, 4.0) * (1.0 - 0.4 * k as Real);
        let twist = Twist { linear: direction * -0.3, angular };
        builder.body(touched(shape), BodyMotion { twist, ..at(direction * 0.0112) });
    }
    let mut system = builder.build().unwrap();
    let (dt, mut most) = (system.model.substep, 0.0_f64);
    let mut n_contacts = 0;
    for _ in 0..800 {
        let before = system.state.grains.clone();
        let bodies = system.controls.bodies.clone();
        system.step();
        n_contacts += system.scratch.touching_walls(&system.state).count();
        let (mut impulse, mut angular_impulse) = (Vec3::zeros(), Vec3::zeros());
        for (wrench, body) in system.scratch.body_wrenches.iter().zip(&bodies) {
            impulse += wrench.force * dt;
            angular_impulse +=
                (wrench.torque + body.pose.translation.vector.cross(&wrench.force)) * dt;
            most = most.max(wrench.force.norm() * dt);
        }
        let now = &system.state.grains;
        for i in 0..now.len() {
            let mass = now.masses[i];
            let gain = (now.velocities[i] - before.velocities[i]) * mass;
            let rotation = (now.angular_velocities[i] - before.angular_velocities[i])
                * (0.4 * mass * RADIUS * RADIUS);
            let weight = system.model.gravity * (mass * dt);
            impulse += gain - weight;
            angular_impulse += before.positions[i].cross(&(gain - weight)) + rotation;
        }
        assert!(impulse.norm() <= 1e-12 * most.max(1e-7), "{} {most}", impulse.norm());
        assert!(
            angular_impulse.norm() <= 1e-12 * 0.02 * most.max(1e-7),
            "{} {most}",
            angular_impulse.norm()
        );
        system.controls.bodies.iter_mut().for_each(|body| body.advance(dt));
    }
    assert!(most > 0.0 && n_contacts > 1000, "{n_contacts}");
}

/// Oracle: statics. A cube that has fallen on a bed of grains comes to rest, and the grains carry its weight.
#[test]
fn a_cube_on_a_bed_of_grains_comes_to_rest() {
    let mut builder = builder();
    builder.substep_of_critical(0.5);
    let (edge, bed) = (0.016, 0.0205);
    builder.walls(Wall::sides(Vec3::new(-bed, -bed, 0.0), Vec3::new(bed, bed, 1.0)));
    for k in 0..10 * 10 * 4 {
        let steps = [k % 10, k / 10 % 10, k / 100].map(Real::from);
        let shift = 0.01 * RADIUS * Real::from(k).sin();
        let position = Vec3::from(steps).add_scalar(0.5) * (2.04 * RADIUS) + Vec3::repeat(shift);
        builder.grain(position - Vec3::new(0.0204, 0.0204, 0.0), RADIUS);
    }
    let start = BodyMotion {
        pose: Pose::new(Vec3::z() * 0.032, Vec3::new(0.3, 0.2, 0.1)),
        twist: Twist::zero(),
    };
    builder.body(touched(Shape::cuboid(&Vec3::repeat(edge))), start);
    let mut system = builder.build().unwrap();
    let (dt, mass) = (system.model.substep, 1500.0 * edge * edge * edge);
    let inertia = mass * edge * edge / 6.0;
    let (n, n_last) = (20_000, 4000);
    let mut load = Vec3::zeros();
    for k in 0..n {
        system.step();
        let wrench = &system.scratch.body_wrenches[0];
        if n - n_last <= k {
            load += wrench.force / Real::from(n_last);
        }
        // A cube has the same moment of inertia about every axis.
        let body = &mut system.controls.bodies[0];
        body.twist.linear += (wrench.force / mass + system.model.gravity) * dt;
        body.twist.angular += wrench.torque * (dt / inertia);
        body.pose.translation.vector += body.twist.linear * dt;
        body.pose.rotation = Quat::from_scaled_axis(body.twist.angular * dt) * body.pose.rotation;
    }
    let body = &system.controls.bodies[0];
    assert!(body.twist.linear.norm() < 5e-3, "{}", body.twist.linear);
    assert!((load.z / (mass * GRAVITY) - 1.0).abs() < 0.01, "{load}");
    assert!(load.xy().norm() < 0.01 * mass * GRAVITY, "{load}");
    assert!(0.016 < body.pose.translation.z, "{}", body.pose.translation);
}
