//! Tests of systems built from parts, and of invalid parts.

use super::*;
use crate::{
    base::digest::Digest,
    physics::{
        boundary::motion::{Hinge, Load, Servo, Turn, WallMotion},
        membrane::{MembraneContact, MembraneMaterial, shape::MembraneShape},
    },
};

const GLASS: Material = Material { youngs_modulus: 1e7, poisson_ratio: 0.25, density: 2500.0 };
const SURFACE: Surface = Surface { friction: 0.5, dissipation_time: 3e-5, tangential_damping: 0.3 };
const RADIUS: Real = 2e-3;
const LATEX: MembraneMaterial = MembraneMaterial {
    thickness: 3e-4,
    youngs_modulus: 1e6,
    density: 1e3,
    spring_damping: 0.3,
    bending_stiffness: 1e-5,
    bending_damping: 1e-7,
};

fn builder() -> SystemBuilder {
    let mut builder = SystemBuilder::of_material(&GLASS, SURFACE);
    builder.gravity(Vec3::new(0.0, 0.0, -9.81)).substep_of_critical(0.5);
    builder
}

fn disc() -> Membrane {
    let shape = MembraneShape::Disc { radius: 0.01, n_rings: 3 };
    Membrane::new(&shape, LATEX).unwrap()
}

/// Oracle: Hertz. The contact of a grain at rest on the floor carries its weight. Tolerance: 1e-3, after many
/// damping times.
#[test]
fn a_grain_rests_on_the_floor_with_its_weight() {
    let mut builder = builder();
    builder.grain(Vec3::new(0.0, 0.0, RADIUS), RADIUS).walls([Wall::floor(0.0)]);
    let mut system = builder.build().unwrap();
    let law = system.model.walls[0].law;
    (0..40_000).for_each(|_| system.step());
    let weight = system.state.grains.masses[0] * 9.81;
    let overlap = (0.75 * weight / (law.modulus * RADIUS.sqrt())).powf(2.0 / 3.0);
    let found = RADIUS - system.state.grains.positions[0].z;
    assert!((found / overlap - 1.0).abs() < 1e-3, "{found:e} {overlap:e}");
}

/// Oracle: the target. A plate with a servo presses a grain on the floor until its load is the target. Saving and
/// restoring the state does not change a bit.
#[test]
fn a_servo_reaches_its_load_and_resuming_changes_no_bit() {
    let target = 0.5;
    let build = || {
        let mut builder = builder();
        builder.gravity(Vec3::zeros()).grain(Vec3::new(0.0, 0.0, RADIUS), RADIUS);
        builder.walls([Wall::floor(0.0)]);
        let servo = Servo {
            axis: -Vec3::z(),
            load: Load::Force,
            target,
            full_scale: target,
            gain: 5e-3,
            speed_max: 5e-3,
        };
        let plate = Wall::plane(Vec3::new(0.0, 0.0, 2.02 * RADIUS), -Vec3::z());
        builder.wall(plate.moving(WallMotion::Servo(servo)));
        builder.build().unwrap()
    };
    let mut uninterrupted = build();
    let mut resumed = build();
    for step in 0..60_000 {
        uninterrupted.step();
        if step == 20_000 {
            assert_eq!(uninterrupted.state.wall_memory.len(), 2);
            resumed.restart(uninterrupted.state.clone());
        } else if 20_000 < step {
            resumed.step();
        }
    }
    let load = uninterrupted.scratch.wall_wrenches[1].force.z;
    assert!((load / target - 1.0).abs() < 1e-4, "{load}");
    let digest = |system: &System| {
        let mut digest = Digest::new();
        system.state.digest(&mut digest);
        digest.finish()
    };
    assert_eq!(digest(&resumed), digest(&uninterrupted));
}

/// Oracle: rigid rotation. Vertices that a rotating wall holds keep their positions in its frame. Tolerance:
/// rounding.
#[test]
fn held_vertices_follow_a_hinged_wall() {
    let mut builder = SystemBuilder::of_material(&GLASS, SURFACE);
    let hinge = Hinge {
        point: Vec3::new(-0.02, 0.0, 0.0),
        axis: Vec3::y(),
        turn: Turn::To { angle: 0.7, rate: 50.0 },
    };
    let flap = builder.wall(Wall::frame().moving(WallMotion::Hinge(hinge)));
    builder.substep(1e-5).membrane(disc().hold(Vertices::All, flap));
    let mut system = builder.build().unwrap();
    let first = system.state.membrane.positions.clone();
    let n = 3000;
    (0..n).for_each(|_| system.step());
    let rotation = Pose::rotation(hinge.axis * 0.7).rotation;
    for (now, before) in system.state.membrane.positions.iter().zip(&first) {
        let expected = hinge.point + rotation * (before - hinge.point);
        assert!((now - expected).norm() < 1e-12, "{now} {expected}");
    }
    // Oracle: without walls whose motion depends on time, the state contains no time.
    system.set_wall_motion(flap, WallMotion::Fixed);
    let mut fixed = builder_of_a_floor().build().unwrap();
    fixed.step();
    assert!(fixed.state.wall_memory.is_empty());
}

fn builder_of_a_floor() -> SystemBuilder {
    let mut builder = builder();
    builder.grain(Vec3::new(0.0, 0.0, RADIUS), RADIUS).walls([Wall::floor(0.0)]);
    builder
}

/// Oracle: the numbers of each membrane. Two of different materials are held by different walls, one of them rotated
/// and shifted.
#[test]
fn several_membranes_share_a_system() {
    let mut builder = builder();
    builder.substep(1e-5).grain(Vec3::new(0.0, 0.0, 0.1), RADIUS);
    let (left, right) = (builder.wall(Wall::frame()), builder.wall(Wall::frame()));
    let pose = Pose::new(Vec3::new(0.1, 0.0, 0.0), Vec3::x() * 0.5);
    let shape = MembraneShape::Disc { radius: 0.01, n_rings: 3 };
    let heavy =
        Membrane::placed(&shape, &pose, MembraneMaterial { density: 3e3, ..LATEX }).unwrap();
    let mass = heavy.model.mass();
    let first = builder.membrane(disc().hold(Vertices::Rim(0), left));
    let second = builder.membrane(heavy.hold(Vertices::Rims, right));
    let system = builder.build().unwrap();
    let membrane = &system.model.membrane;
    assert_eq!(membrane.mesh.rims.len(), 2);
    let holders: Vec<u32> =
        membrane.mesh.rims.iter().map(|rim| membrane.holders[rim[0] as usize]).collect();
    assert_eq!(holders, [left.holder(), right.holder()]);
    assert!((membrane.mass() / mass - 4.0 / 3.0).abs() < 1e-12);
    assert_eq!((first.start, first.end, second.end), (0, second.start, membrane.mesh.n_vertices()));
    let positions = &system.state.membrane.positions[second];
    let center = positions.iter().sum::<Vec3>() / positions.len() as Real;
    assert!((center - pose.translation.vector).norm() < 1e-12);
}

/// The error of a builder with a floor and one change.
fn error(change: &dyn Fn(&mut SystemBuilder)) -> BuildError {
    let mut builder = builder_of_a_floor();
    change(&mut builder);
    builder.build().err().unwrap()
}

#[test]
fn inconsistent_grains_and_walls_are_rejected() {
    // Oracle: the one error of each builder.
    let message = |it: &dyn Fn(&mut SystemBuilder)| error(it).to_string();
    let text = message(&|it| {
        it.grain(Vec3::zeros(), -1e-3);
    });
    assert_eq!(text, "radius (m) of grain 1: -1e-3 is not positive; give a value above 0");
    let text = message(&|it| {
        it.grain(Vec3::x() * Real::NAN, RADIUS);
    });
    assert_eq!(text, "position (m) of grain 1: NaN is not finite; give a finite number");
    assert_eq!(
        error(&|it| {
            it.wall(Wall::frame());
        }),
        BuildError::IdleWall { wall: 1 }
    );
    let tube = WallShape::Tube { radius: 1e-3 };
    let narrow = BuildError::NarrowWall { wall: 1, radius: 1e-3, limit: RADIUS };
    assert_eq!(
        error(&|it| {
            it.wall(Wall::new(tube.clone()));
        }),
        narrow
    );
    let tilted = |it: &mut SystemBuilder| {
        it.wall(Wall::plane(Vec3::zeros(), Vec3::x() * 2.0));
    };
    assert_eq!(error(&tilted), BuildError::Normal { wall: 1, length: 2.0 });
}

#[test]
fn inconsistent_membranes_and_boxes_are_rejected() {
    // Oracle: the one error of each builder.
    let loose = error(&|it| {
        it.membrane(disc());
    });
    assert!(matches!(loose, BuildError::FreeRim { membrane: 0, .. }), "{loose}");
    assert_eq!(
        error(&|it| {
            it.membrane(disc().hold(Vertices::All, WallId(3)));
        }),
        BuildError::NoSuchWall { membrane: 0, wall: 3, n_walls: 1 }
    );
    assert_eq!(
        error(&|it| {
            it.membrane(disc().hold(Vertices::Rim(1), WallId::CARRIER));
        }),
        BuildError::NoSuchVertices { membrane: 0, what: "rim", index: 1, limit: 1 }
    );
    let spheres = || disc().touched_at(MembraneContact::Spheres { radius: 1e-3 }).free_rims();
    let different =
        BuildError::MembranesDiffer { membrane: 1, what: "the contact geometry for grains" };
    assert_eq!(
        error(&|it| {
            it.membrane(disc().free_rims());
            it.membrane(spheres());
        }),
        different
    );
    assert!(matches!(
        error(&|it| {
            it.radii_up_to(1e-3, 1e-3);
        }),
        BuildError::Radius { grain: 0, .. }
    ));
    assert_eq!(
        error(&|it| {
            it.period(Vec3::repeat(1.0));
        }),
        BuildError::NotAlone { n_walls: 1, n_membranes: 0 }
    );
    let mut boxed = builder();
    boxed.grain(Vec3::zeros(), RADIUS).period(Vec3::new(1.0, 0.005, 1.0));
    assert!(matches!(boxed.build().err().unwrap(), BuildError::Period { axis: 1, .. }));
    let mut unknown = SystemBuilder::new(PairLaw::between(&GLASS, &GLASS, SURFACE));
    unknown.substep_of_critical(0.5);
    assert_eq!(unknown.build().err().unwrap(), BuildError::NoSubstep);
}
