//! Tests of the passes over pairs and walls with a law that has cohesion, range and history.

use crate::{
    base::{
        Pose, Real, Vec3,
        digest::Digest,
        lanes::{self, Width},
        random::{Random, Stream},
    },
    physics::{
        System, SystemBuilder,
        boundary::wall::WallShape,
        builder::Wall,
        law::{PairLaw, Surface, tests::bridged},
        state::Grains,
    },
};

const RADIUS: Real = 1e-3;
const MASS: Real = 4.0 / 3.0 * std::f64::consts::PI * RADIUS * RADIUS * RADIUS * 2000.0;
const GRAVITY: Real = 9.81;
const RUPTURE: Real = 0.05 * RADIUS;
const DT: Real = 1e-6;

fn law(pull: Real) -> PairLaw {
    let surface = Surface { friction: 0.5, dissipation_time: 2e-5, tangential_damping: 0.3 };
    bridged(surface, pull, RUPTURE)
}

fn system(law: PairLaw, positions: &[Vec3], walls: &[(WallShape, Vec3)]) -> System {
    let n = positions.len();
    let mut builder = SystemBuilder::new(law);
    builder.substep(DT).grains(Grains::at_rest(positions.to_vec(), vec![RADIUS; n], vec![MASS; n]));
    let wall = |(shape, origin): &(WallShape, Vec3)| {
        Wall::new(shape.clone()).at(Pose::translation(origin.x, origin.y, origin.z))
    };
    builder.walls(walls.iter().map(wall));
    builder.build().unwrap()
}

/// True if a grain of weight m g is still hanging after 60 ms from a fixed grain, or from a ceiling, that
/// attracts it with the force `pull_over_weight` m g.
fn hangs(on_ceiling: bool, pull_over_weight: Real) -> bool {
    let law = law(pull_over_weight * MASS * GRAVITY);
    let touching = Vec3::z() * (-(2.0 - 1e-9) * RADIUS);
    let ceiling =
        (WallShape::Plane { normal: -Vec3::z() }, touching + Vec3::z() * ((1.0 - 1e-9) * RADIUS));
    let mut system = if on_ceiling {
        system(law, &[touching], &[ceiling])
    } else {
        system(law, &[touching, Vec3::zeros()], &[])
    };
    system.model.gravity = Vec3::z() * -GRAVITY;
    for _ in 0..60_000 {
        system.step();
        if !on_ceiling {
            system.state.grains.positions[1] = Vec3::zeros();
            system.state.grains.velocities[1] = Vec3::zeros();
        }
    }
    touching.z - system.state.grains.positions[0].z < RUPTURE
}

#[test]
fn a_hanging_grain_falls_if_its_weight_exceeds_the_cohesion() {
    // Oracle: statics, c = m g, for a pair and at a wall; within 1 %.
    for on_ceiling in [false, true] {
        assert!(hangs(on_ceiling, 1.01), "on ceiling: {on_ceiling}");
        assert!(!hangs(on_ceiling, 0.99), "on ceiling: {on_ceiling}");
    }
}

#[test]
fn lists_include_the_range_of_the_law() {
    // Oracle: contact plus range plus skin, by hand, for a pair and for a wall.
    let floor = || (WallShape::Plane { normal: Vec3::z() }, Vec3::zeros());
    for (share, is_listed) in [(0.999, true), (1.001, false)] {
        let gap = share * (RUPTURE + 0.25 * RADIUS);
        let low = Vec3::z() * (RADIUS + gap);
        let high = low + Vec3::z() * (2.0 * RADIUS + gap);
        let mut system = system(law(1e-3), &[low, high], &[floor()]);
        system.step();
        assert_eq!(system.state.pair_ids.len(), usize::from(is_listed));
        assert_eq!(system.state.springs.walls.ids.len(), usize::from(is_listed));
        assert!(system.scratch.touching_pairs(&system.state).next().is_none());
    }
}

#[test]
fn bridges_survive_a_rebuild_of_the_lists() {
    // Oracle: the cohesive force itself, for a pair and a wall, after a rebuild of the lists.
    let pull = 1e-3;
    let floor = (WallShape::Plane { normal: Vec3::z() }, Vec3::zeros());
    let low = Vec3::z() * (RADIUS * (1.0 - 1e-4));
    let mut system = system(law(pull), &[low, low + Vec3::z() * (RADIUS * (2.0 - 1e-4))], &[floor]);
    system.step();
    let gap = 0.5 * RUPTURE;
    system.state.grains.positions =
        vec![Vec3::z() * (RADIUS + gap), Vec3::z() * (3.0 * RADIUS + 2.0 * gap)];
    system.state.grains.velocities.fill(Vec3::zeros());
    system.scratch.neighbors.is_built = false;
    system.step();
    assert_eq!(system.scratch.neighbors.n_builds, 2);
    assert_eq!(system.scratch.pair_forces[0].normal.to_bits(), (-pull).to_bits());
    assert_eq!(system.scratch.wall_forces[0].normal.to_bits(), (-pull).to_bits());
    assert!(
        system.scratch.pair_flags[0].touches() && system.scratch.wall_forces[0].flags.touches()
    );
}

/// Simulates a cloud of grains that collide and stick in a box of six walls. Returns the digest at the end, the
/// number of builds of the lists, and the number of bridges across a gap.
fn cloud(skin_share: Real) -> (u64, u64, usize) {
    let mut random = Random::new(7, Stream::Position);
    let edge = 12.0 * RADIUS;
    let cell = |k: u32| Vec3::from([k % 5, k / 5 % 5, k / 25].map(Real::from));
    let positions: Vec<Vec3> = (0..75).map(|k| (cell(k) * 2.3).add_scalar(1.2) * RADIUS).collect();
    let walls: Vec<(WallShape, Vec3)> = (0..6)
        .map(|k| {
            let axis = Vec3::ith(k % 3, 1.0);
            let (normal, origin) = if k < 3 { (axis, axis * 0.0) } else { (-axis, axis * edge) };
            (WallShape::Plane { normal }, origin)
        })
        .collect();
    let mut system = system(law(3e-3), &positions, &walls);
    system.model.skin = skin_share * RADIUS;
    for velocity in &mut system.state.grains.velocities {
        *velocity = Vec3::from_fn(|_, _| random.between(-0.5, 0.5));
    }
    for _ in 0..8000 {
        system.step();
    }
    let mut digest = Digest::new();
    system.state.digest(&mut digest);
    let bridges = system.scratch.touching_pairs(&system.state).filter(|(it, _)| it.overlap < 0.0);
    let n_bridges = bridges.count();
    (digest.finish(), system.scratch.neighbors.n_builds, n_bridges)
}

#[test]
fn lists_and_lanes_do_not_change_a_bit_with_cohesion() {
    // Oracle: the same cloud with other lists, and with registers of other widths.
    let (digest, n_builds, n_bridges) = cloud(0.25);
    assert!(n_bridges > 0, "no bridge spans a gap");
    let (of_thin_lists, n_more_builds, _) = cloud(0.05);
    assert!(n_more_builds > n_builds, "{n_more_builds} after {n_builds}");
    assert_eq!(of_thin_lists, digest);
    for width in [Width::One, Width::Four] {
        lanes::limit(width);
        assert_eq!(cloud(0.25).0, digest, "{width:?}");
    }
    lanes::limit(Width::Eight);
}
