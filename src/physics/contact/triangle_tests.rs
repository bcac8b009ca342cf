//! Tests of contacts between grains and walls of triangles.

use super::surfaces;
use crate::{
    base::{Pose, Real, Vec3, digest::Digest, parallel, real::Twist},
    physics::{
        System, SystemBuilder,
        boundary::{
            motion::{Hinge, Turn, WallMotion},
            triangles::Triangles,
        },
        builder::Wall,
        law::Surface,
    },
    scene::Material,
};

const GLASS: Material = Material { youngs_modulus: 1e7, poisson_ratio: 0.25, density: 2500.0 };
const SURFACE: Surface = Surface { friction: 0.5, dissipation_time: 3e-5, tangential_damping: 0.3 };
const RADIUS: Real = 2e-3;
const GRAVITY: Real = 9.81;

fn builder(gravity: Vec3) -> SystemBuilder {
    let mut builder = SystemBuilder::of_material(&GLASS, SURFACE);
    builder.gravity(gravity).substep_of_critical(0.2);
    builder
}

/// Squares with edges of `edge` (m), from -n to n along two axes, each divided into two triangles.
fn squares(n: i32, edge: Real, [along, across]: [Vec3; 2]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let width = u32::try_from(2 * n + 1).unwrap();
    let line = || (-n..=n).map(|k| Real::from(k) * edge);
    let vertices = line().flat_map(|y| line().map(move |x| along * x + across * y)).collect();
    let square = |k: u32| {
        let [a, b] = [k, k + width];
        [[a, a + 1, b], [a + 1, b + 1, b]]
    };
    let cells = (0..width - 1).flat_map(|y| (0..width - 1).map(move |x| y * width + x));
    (vertices, cells.flat_map(square).collect())
}

fn floor(n: i32, edge: Real) -> Wall {
    let (vertices, triangles) = squares(n, edge, [Vec3::x(), Vec3::y()]);
    Wall::triangles(Triangles::new(vertices, triangles).unwrap())
}

/// Overlap (m) of a grain that is pressed on a wall with `force` (N).
fn overlap(system: &System, wall: usize, force: Real) -> Real {
    let law = system.model.walls[wall].law;
    (0.75 * force / (law.modulus * RADIUS.sqrt())).powf(2.0 / 3.0)
}

/// Force (N) on the only grain of a system with one wall, and its friction spring (m).
fn force_and_spring(system: &System) -> (Vec3, Vec3) {
    let mut contacts = system.scratch.touching_walls(&system.state);
    let force = contacts.next().map_or_else(Vec3::zeros, |(contact, _)| contact.force);
    assert!(contacts.next().is_none(), "more than one contact");
    let springs = &system.state.springs;
    let spring = springs.surfaces.histories.first().map(|it| it.spring);
    (force, spring.or(springs.walls.springs.first().copied()).unwrap())
}

/// Oracle: a plane. A grain at rest on a face, an edge or a vertex has the same overlap. Tolerance: rounding.
#[test]
fn a_grain_rests_on_triangles_as_on_a_plane() {
    for point in [Vec3::new(0.3e-3, 0.7e-3, 0.0), Vec3::new(1e-3, 0.0, 0.0), Vec3::zeros()] {
        let rest = |wall: Wall| {
            let mut builder = builder(Vec3::z() * -GRAVITY);
            builder.grain(point + Vec3::z() * RADIUS, RADIUS).wall(wall);
            let mut system = builder.build().unwrap();
            (0..20_000).for_each(|_| system.step());
            system
        };
        let (on_plane, on_triangles) = (rest(Wall::floor(0.0)), rest(floor(5, 2e-3)));
        let weight = on_plane.state.grains.masses[0] * GRAVITY;
        let expected = overlap(&on_plane, 0, weight);
        let depth = |system: &System| RADIUS - system.state.grains.positions[0].z;
        assert!((depth(&on_plane) / expected - 1.0).abs() < 1e-6);
        assert!((depth(&on_triangles) / depth(&on_plane) - 1.0).abs() < 1e-9);
        let load = on_triangles.scratch.wall_wrenches[0].force.z;
        assert!((load / weight + 1.0).abs() < 1e-6, "{load}");
    }
}

/// Oracle: a plane. A grain slides and then rolls over a hundred edges of a tilted floor. Tolerance: its force
/// differs by less than 1e-9 of its weight at any time, its friction spring by less than 1e-9 of its radius.
#[test]
fn a_grain_slides_and_rolls_over_flat_triangles_as_on_a_plane() {
    let pose = Pose::new(Vec3::new(0.01, -0.02, 0.03), Vec3::new(0.3, -0.5, 0.2));
    let rotation = pose.rotation;
    let system = |wall: Wall| {
        let mut builder = builder(rotation * Vec3::z() * -GRAVITY);
        let middle = rotation * Vec3::new(-0.029, -0.011, RADIUS) + pose.translation.vector;
        builder.grain(middle, RADIUS).wall(wall.at(pose));
        let mut system = builder.build().unwrap();
        let sunk = overlap(&system, 0, system.state.grains.masses[0] * GRAVITY);
        system.state.grains.positions[0] -= rotation * Vec3::z() * sunk;
        system.state.grains.velocities[0] = rotation * Vec3::new(0.3, 0.11, 0.0);
        system
    };
    let mut on_plane = system(Wall::plane(Vec3::zeros(), Vec3::z()));
    let mut on_triangles = system(floor(40, 1e-3));
    let weight = on_plane.state.grains.masses[0] * GRAVITY;
    let (mut has_slid, mut has_rolled) = (false, false);
    let first = on_plane.state.grains.positions[0];
    while (on_plane.state.grains.positions[0] - first).norm() < 0.05 {
        on_plane.step();
        on_triangles.step();
        let (force, spring) = force_and_spring(&on_plane);
        let (found, found_spring) = force_and_spring(&on_triangles);
        assert!((found - force).norm() < 1e-9 * weight, "{found} {force}");
        assert!((found_spring - spring).norm() < 1e-9 * RADIUS, "{found_spring} {spring}");
        let slides = on_plane.scratch.wall_forces[0].flags.slides();
        (has_slid, has_rolled) = (has_slid || slides, !slides);
    }
    assert!(has_slid && has_rolled);
}

/// Oracle: two planes. A grain in a corner of triangles rests on both sides with the same forces.
#[test]
fn a_grain_in_a_corner_touches_both_sides() {
    let gravity = Vec3::new(0.0, -0.6, -0.8) * GRAVITY;
    let (mut vertices, mut triangles) = squares(3, 3e-3, [Vec3::x(), Vec3::y()]);
    // Half of the floor is folded up at y = 0.
    for vertex in &mut vertices {
        if vertex.y < 0.0 {
            *vertex = Vec3::new(vertex.x, 0.0, -vertex.y);
        }
    }
    triangles.rotate_left(7);
    let corner = Wall::triangles(Triangles::new(vertices, triangles).unwrap());
    let sides = [Wall::floor(0.0), Wall::plane(Vec3::zeros(), Vec3::y())];
    let rest = |walls: Vec<Wall>| {
        let mut builder = builder(gravity);
        builder.grain(Vec3::new(0.4e-3, RADIUS, RADIUS), RADIUS).walls(walls);
        let mut system = builder.build().unwrap();
        (0..20_000).for_each(|_| system.step());
        let touching = system.scratch.touching_walls(&system.state);
        let mut forces: Vec<Vec3> = touching.map(|(contact, _)| contact.force).collect();
        forces.sort_by(|a, b| a.y.total_cmp(&b.y));
        (forces, system.state.grains.positions[0])
    };
    let (expected, position) = rest(sides.to_vec());
    let (found, found_position) = rest(vec![corner]);
    assert_eq!((expected.len(), found.len()), (2, 2));
    assert!((found_position - position).norm() < 1e-9 * RADIUS);
    for (force, expected) in found.iter().zip(&expected) {
        assert!((force - expected).norm() < 1e-9 * expected.norm(), "{force} {expected}");
    }
}

/// Triangles of a box between two corners (m), normals outward.
fn box_mesh(low: Vec3, high: Vec3) -> Triangles {
    let corner =
        |k: usize| Vec3::from_fn(|axis, _| if k >> axis & 1 == 0 { low } else { high }[axis]);
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    Triangles::new((0..8).map(corner).collect(), faces.into_iter().flat_map(halves).collect())
        .unwrap()
}

/// Oracle: the geometry of a box. On an edge and at a corner there is one contact, with the normal from the
/// closest point to the grain.
#[test]
fn a_grain_on_an_edge_or_corner_has_one_contact() {
    let direction = Vec3::new(0.2, 0.0, 0.9).normalize();
    let at_corner = Vec3::new(0.3, 0.4, 0.8).normalize();
    for (point, normal) in
        [(Vec3::new(0.01, 1e-3, 0.02), direction), (Vec3::new(0.01, 0.01, 0.02), at_corner)]
    {
        let mut builder = builder(Vec3::zeros());
        builder.grain(point + normal * (0.999 * RADIUS), RADIUS);
        builder.wall(Wall::triangles(box_mesh(
            Vec3::new(-0.01, -0.01, 0.0),
            Vec3::new(0.01, 0.01, 0.02),
        )));
        let mut system = builder.build().unwrap();
        system.step();
        let contacts: Vec<_> = system.scratch.surface_contacts_with_ids().collect();
        assert_eq!(contacts.len(), 1);
        let (contact, ids) = contacts[0];
        assert_eq!(*ids, [0, 0]);
        assert!((contact.history.normal - normal).norm() < 1e-12);
        let overlap = contact.force.overlap;
        assert!((overlap / (0.001 * RADIUS) - 1.0).abs() < 1e-9, "{overlap}");
    }
}

/// Oracle: rigid rotation. A grain on a plate that rotates about a hinge rises at the rate times its distance from
/// the axis, with the overlap of a grain at rest.
#[test]
fn a_hinged_plate_lifts_a_grain() {
    let rate = 0.02;
    let hinge = Hinge { point: Vec3::zeros(), axis: -Vec3::y(), turn: Turn::Steady { rate } };
    let mut builder = builder(Vec3::z() * -GRAVITY);
    builder.grain(Vec3::new(0.03, 0.5e-3, RADIUS), RADIUS);
    builder.wall(floor(20, 2e-3).moving(WallMotion::Hinge(hinge)));
    let mut system = builder.build().unwrap();
    let sunk = overlap(&system, 0, system.state.grains.masses[0] * GRAVITY);
    system.state.grains.positions[0].z -= sunk;
    let dt = system.model.substep;
    let (mut time, mut before) = (0.0, 0.0);
    for k in 0..8000 {
        if k == 4000 {
            before = system.state.grains.positions[0].z;
            time = 0.0;
        }
        system.step();
        time += dt;
    }
    let position = system.state.grains.positions[0];
    let speed = (position.z - before) / time;
    assert!((speed / (rate * position.x) - 1.0).abs() < 0.01, "{speed}");
    let normal = surfaces::motion(&system.model, &system.controls, &system.state, 0).pose.rotation
        * Vec3::z();
    let depth = RADIUS - normal.dot(&position);
    assert!((depth / sunk - 1.0).abs() < 0.05, "{depth} {sunk}");
}

const HEIGHT: Real = 0.05;
const BASE: Real = 0.022;
const TOP: Real = 0.012;

/// Inner radius of the cone at a height above its lower rim (m).
fn cone_radius(height: Real) -> Real {
    BASE + (TOP - BASE) * height / HEIGHT
}

/// A truncated cone, open at both ends.
fn cone() -> Triangles {
    let (n_around, n_up) = (24_u32, 8_u32);
    let vertex = |k: u32| {
        let angle = Real::from(k % n_around) * std::f64::consts::TAU / Real::from(n_around);
        let height = Real::from(k / n_around) * HEIGHT / Real::from(n_up);
        Vec3::new(angle.cos(), angle.sin(), 0.0) * cone_radius(height) + Vec3::z() * height
    };
    let quad = |k: u32| {
        let next = if k % n_around == n_around - 1 { k + 1 - n_around } else { k + 1 };
        [[k, next, k + n_around], [next, next + n_around, k + n_around]]
    };
    let vertices = (0..n_around * (n_up + 1)).map(vertex).collect();
    Triangles::new(vertices, (0..n_around * n_up).flat_map(quad).collect()).unwrap()
}

/// Grains in a cone on a floor; the cone is the second wall.
fn filled_cone() -> SystemBuilder {
    let mut builder = builder(Vec3::z() * -GRAVITY);
    builder.substep_of_critical(0.5);
    builder.wall(Wall::floor(0.0));
    builder.wall(Wall::triangles(cone()));
    let spacing = 2.05 * RADIUS;
    for k in 0..12 * 11 * 11 {
        let steps = [k % 11 - 5, k / 11 % 11 - 5, k / 121].map(Real::from);
        let point = Vec3::new(steps[0], steps[1], steps[2] + 0.5) * spacing;
        let room = cone_radius(point.z) * 0.98 - point.xy().norm();
        if 1.05 * RADIUS < room && point.z + RADIUS < HEIGHT {
            // Slightly irregular, so that columns of grains are not stable.
            let shift = 0.02 * RADIUS * Real::from(k).sin();
            builder.grain(point + Vec3::new(shift, -shift, 0.0), RADIUS);
        }
    }
    builder
}

/// Numbers of grains within the height of the cone: inside it, and outside. Grains that may have rolled out under
/// the rim are not counted.
fn inside_and_outside(system: &System) -> (usize, usize) {
    let bottom = system.state.walls[1].pose.translation.z;
    let (mut n_inside, mut n_outside) = (0, 0);
    for position in &system.state.grains.positions {
        let height = position.z - bottom;
        let is_inside = position.xy().norm() < cone_radius(height);
        n_inside += usize::from(is_inside && (0.0..HEIGHT).contains(&height));
        n_outside += usize::from(!is_inside && (RADIUS..HEIGHT).contains(&height));
    }
    (n_inside, n_outside)
}

/// Oracle: counts. Grains stay in a slump cone at rest and leave it when it is lifted; none crosses its side.
#[test]
fn grains_stay_in_a_slump_cone_until_it_is_lifted() {
    let mut system = filled_cone().build().unwrap();
    let n = system.state.grains.len();
    assert!(n > 200, "{n}");
    let steps = |time: Real, dt: Real| (0..).take_while(move |k| Real::from(*k) * dt < time);
    let dt = system.model.substep;
    let (mut load, mut n_loads) = (0.0, 0.0);
    for k in steps(0.2, dt) {
        system.step();
        if 0.15 < Real::from(k) * dt {
            load += system.scratch.wall_wrenches.iter().map(|it| it.force.z).sum::<Real>();
            n_loads += 1.0;
        }
    }
    assert_eq!(inside_and_outside(&system), (n, 0));
    let height_before = system.state.grains.positions.iter().map(|p| p.z).fold(0.0, Real::max);
    let up = Twist { linear: Vec3::z() * 0.3, angular: Vec3::zeros() };
    let weight = system.state.grains.masses.iter().sum::<Real>() * GRAVITY;
    assert!((load / n_loads / weight + 1.0).abs() < 0.05, "{load} {weight}");
    system.model.walls[1].motion = WallMotion::Velocity(up);
    for k in steps(0.25, dt) {
        system.step();
        if k % 50 == 0 {
            assert_eq!(inside_and_outside(&system).1, 0, "step {k}");
        }
    }
    let (inside, _) = inside_and_outside(&system);
    assert!(inside == 0, "{inside} of {n}");
    let height = system.state.grains.positions.iter().map(|p| p.z).fold(0.0, Real::max);
    assert!(height < 0.7 * height_before, "{height} {height_before}");
    let furthest = system.state.grains.positions.iter().map(|p| p.xy().norm()).fold(0.0, Real::max);
    assert!(furthest > 1.1 * BASE, "{furthest}");
}

/// Oracle: the same run with other lists, other numbers of threads, and resumed from a saved state.
#[test]
fn lists_threads_and_resuming_do_not_change_a_bit_on_triangles() {
    let run = |skin_share: Real, n_threads: usize, is_resumed: bool| {
        let mut builder = filled_cone();
        builder.skin(skin_share * RADIUS);
        let mut system = builder.build().unwrap();
        let twist = Twist { linear: Vec3::new(0.3, 0.0, 0.1), angular: Vec3::new(0.2, 0.0, 3.0) };
        system.model.walls[1].motion = WallMotion::Velocity(twist);
        let pool = parallel::ThreadPool::new(n_threads).unwrap();
        parallel::lead(&pool, || {
            for k in 0..600 {
                system.step();
                if is_resumed && k == 400 {
                    let state = system.state.clone();
                    assert!(!state.springs.surfaces.ids.is_empty());
                    system.restart(state);
                }
            }
        });
        let mut digest = Digest::new();
        system.state.digest(&mut digest);
        (digest.finish(), system.scratch.neighbors.n_builds)
    };
    let (digest, n_builds) = run(0.25, 1, false);
    let (thin, n_more_builds) = run(0.06, 2, false);
    assert!(n_more_builds > n_builds, "{n_more_builds} after {n_builds}");
    assert_eq!(thin, digest);
    assert_eq!(run(0.25, 7, true).0, digest);
}

/// Oracle: brute force over all triangles, for ten thousand grains above a wavy, rotating surface of five thousand
/// triangles. The lists contain all contacts, and few other entries.
#[test]
fn lists_contain_all_contacts_with_a_large_surface() {
    let edge = 4e-3;
    let (mut vertices, triangles) = squares(25, edge, [Vec3::x(), Vec3::y()]);
    for vertex in &mut vertices {
        vertex.z = 3e-3 * (70.0 * vertex.x).sin() * (50.0 * vertex.y).cos();
    }
    let surface = Triangles::new(vertices, triangles).unwrap();
    assert_eq!(surface.mesh().triangles.len(), 5000);
    let twist = Twist { linear: Vec3::z() * 2.0, angular: Vec3::new(3.0, 0.0, 2.0) };
    let mut builder = builder(Vec3::zeros());
    for k in 0..10_000 {
        let steps = [k % 40, k / 40 % 40, k / 1600].map(Real::from);
        let position = Vec3::new(steps[0] - 19.5, steps[1] - 19.5, steps[2]) * (2.1 * RADIUS);
        builder.grain(position + Vec3::z() * 4.8e-3, RADIUS);
    }
    builder.wall(Wall::triangles(surface.clone()).moving(WallMotion::Velocity(twist)));
    let mut system = builder.build().unwrap();
    let all: Vec<u32> = (0..5000).collect();
    for _ in 0..3 {
        (0..40).for_each(|_| system.step());
        // Forces belong to the positions at the beginning of a substep.
        let (positions, pose) = (system.state.grains.positions.clone(), system.state.walls[0].pose);
        system.step();
        let touches = |p: &Vec3| {
            let local = pose.inverse_transform_point(&(*p).into()).coords;
            surface.touching(&all, &local, RADIUS)
        };
        let expected: Vec<usize> = positions.iter().map(|p| touches(p).len()).collect();
        let mut found = vec![0; positions.len()];
        for (_, ids) in system.scratch.surface_contacts_with_ids() {
            found[ids[1] as usize] += 1;
        }
        assert_eq!(found, expected);
        assert!(found.iter().sum::<usize>() > 20, "few contacts");
    }
    let lists = &system.scratch.neighbors.surfaces;
    assert!(lists.ids.len() < 3200 && lists.triangles.len() < 10 * lists.ids.len());
}
