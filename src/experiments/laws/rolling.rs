//! A grain on a plane: it slides until it rolls, rolls or slips down an incline, overlaps by its
//! weight, and does not creep while it sticks (Götz 2024, eqs. 8–11).

use super::{
    Law, RowSpec,
    build::{G, TestSystem, mass},
    measure::push,
    scene::LawsScene,
};
use crate::{
    base::{Real, Vec3, real::real},
    experiments::{
        findings::{Expected, Kind, Plot, Series},
        record::Record,
    },
    physics::law::{PairLaw, Surface},
};

pub(super) struct Rolling;

/// The points: sliding, inclines, weight, creep and the spring.
const POINTS: [fn(&LawsScene, &mut Record); 5] = [slide, inclines, weight, creep, shear];
/// Steps between two recorded rows.
const EVERY: usize = 20;

impl Law for Rolling {
    fn name(&self) -> &'static str {
        "rolling"
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

    fn table(&self) -> Option<&'static str> {
        Some("laws_rolling")
    }

    fn plot(&self, scene: &LawsScene, record: &Record) -> Option<Plot> {
        Some(plot(scene, record))
    }
}

/// A grain at rest on the plane, which is tilted by `tilt` (rad) about y.
fn resting(scene: &LawsScene, surface: Surface, tilt: Real) -> TestSystem {
    let grain = &scene.grain;
    let mut test = TestSystem::on_plane(&grain.material, surface, scene.rolling.substep);
    test.system.model.gravity = Vec3::new(tilt.sin(), 0.0, -tilt.cos()) * G;
    let height = grain.radius - resting_overlap(scene, tilt);
    test.add_grain(Vec3::z() * height, grain.radius, grain.material.density);
    test
}

/// ξ = (m g cos θ / k)^(2/3).
fn resting_overlap(scene: &LawsScene, tilt: Real) -> Real {
    let grain = &scene.grain;
    let k = 4.0 / 3.0
        * PairLaw::against_rigid(&grain.material, grain.surface).modulus
        * grain.radius.sqrt();
    (mass(grain.radius, grain.material.density) * G * tilt.cos() / k).powf(2.0 / 3.0)
}

/// A grain that starts to slide with v_0 rolls after 2 v_0/(7 μ g).
fn slide(scene: &LawsScene, record: &mut Record) {
    let (grain, v0) = (&scene.grain, scene.rolling.speed);
    let mut test = resting(scene, grain.surface, 0.0);
    test.grains_mut().velocities[0].x = v0;
    let rolls_at = 2.0 * v0 / (7.0 * grain.surface.friction * G);
    let n_steps = (2.0 * rolls_at / scene.rolling.substep).ceil();
    let mut rolled_at = None;
    let mut step = 0;
    while real(step) < n_steps {
        if step % EVERY == 0 {
            push(record, "time", "s", real(step) * scene.rolling.substep);
            push(record, "speed", "m/s", test.grains().velocities[0].x);
            push(record, "rim_speed", "m/s", test.grains().angular_velocities[0].y * grain.radius);
        }
        test.step();
        step += 1;
        let slip =
            test.grains().velocities[0].x - test.grains().angular_velocities[0].y * grain.radius;
        if rolled_at.is_none() && slip < 0.01 * v0 {
            // Extrapolated: the last percent of the slip takes a percent of the time.
            let time = real(step) * scene.rolling.substep / 0.99;
            rolled_at = Some((time, test.grains().positions[0].x));
        }
    }
    let (v, spin) = (test.grains().velocities[0].x, test.grains().angular_velocities[0].y);
    record.set("U5.rolling_speed", v / (5.0 / 7.0 * v0), "1");
    record.set("U5.rolls", spin * grain.radius / v, "1");
    let (time, distance) = rolled_at.unwrap_or((Real::NAN, Real::NAN));
    record.set("U5.time", time / rolls_at, "1");
    record.set("U5.place", distance / (6.0 / 7.0 * v0 * rolls_at), "1");
    let energy = test.kinetic_energy() / (0.5 * test.grains().masses[0] * v0 * v0);
    record.set("U5.energy", energy / (5.0 / 7.0), "1");
}

/// Down an incline: rolling if tan θ < 7/2 μ, otherwise slipping.
fn inclines(scene: &LawsScene, record: &mut Record) {
    let friction = scene.grain.surface.friction;
    for (id, tan) in [("U5.rolls_down", 1.6 * friction), ("U5.slips_down", 6.0 * friction)] {
        let tilt = tan.atan();
        let mut test = resting(scene, scene.grain.surface, tilt);
        let n_steps = 4000;
        for _ in 0..n_steps {
            test.step();
        }
        let expected = if tan < 3.5 * friction {
            5.0 / 7.0 * G * tilt.sin()
        } else {
            G * (tilt.sin() - friction * tilt.cos())
        };
        let time = real(n_steps) * scene.rolling.substep;
        record.set(id, test.grains().velocities[0].x / time / expected, "1");
    }
}

/// A grain placed without overlap settles until the plane carries its weight.
fn weight(scene: &LawsScene, record: &mut Record) {
    let surface = Surface { dissipation_time: 1e-4, ..scene.grain.surface };
    let mut test = resting(scene, surface, 0.0);
    test.grains_mut().positions[0].z = scene.grain.radius;
    for _ in 0..40_000 {
        test.step();
    }
    record.set("U8.weight", test.overlap() / resting_overlap(scene, 0.0), "1");
}

/// A grain that cannot roll, at 0.9 of the friction angle.
fn creep(scene: &LawsScene, record: &mut Record) {
    let surface = Surface { dissipation_time: 1e-4, ..scene.grain.surface };
    let mut test = resting(scene, surface, (0.9 * surface.friction).atan());
    let mut go = |n_steps: usize| {
        for _ in 0..n_steps {
            test.step();
            test.grains_mut().angular_velocities[0] = Vec3::zeros();
        }
        test.grains().positions[0].x
    };
    let settled = go(scene.rolling.n_creep_steps / 10 + 20_000);
    let end = go(scene.rolling.n_creep_steps);
    record.set("U8.creep", (end - settled).abs() / scene.grain.radius, "1");
}

/// A contact that is sheared slightly at constant overlap: the stiffness of the spring.
fn shear(scene: &LawsScene, record: &mut Record) {
    let grain = &scene.grain;
    let surface = Surface { tangential_damping: 0.0, dissipation_time: 0.0, ..grain.surface };
    let (overlap, n_steps) = (0.01 * grain.radius, 1000);
    let mut test = TestSystem::on_plane(&grain.material, surface, 1e-6);
    test.add_grain(Vec3::zeros(), grain.radius, grain.material.density);
    let law = PairLaw::against_rigid(&grain.material, surface);
    let mindlin = 8.0 * law.shear_modulus * (grain.radius * overlap).sqrt();
    let normal = 4.0 / 3.0 * law.modulus * grain.radius.sqrt() * overlap.powf(1.5);
    let sliding = surface.friction * normal / (2.0 / 3.0 * mindlin);
    let mut sheared = |distance: Real| {
        for _ in 0..n_steps {
            let grains = test.grains_mut();
            grains.positions[0].z = grain.radius - overlap;
            grains.velocities[0] = Vec3::x() * (distance / (real(n_steps) * 1e-6));
            grains.angular_velocities[0] = Vec3::zeros();
            test.step();
        }
        -test.system.scratch.wall_forces.first().map_or(0.0, |wall| wall.force.x)
    };
    record.set("C1.shear_stiffness", sheared(0.5 * sliding) / (mindlin * 0.5 * sliding), "1");
    record.set("C1.coulomb", sheared(5.0 * sliding) / (surface.friction * normal), "1");
}

const ROWS: &[RowSpec] = &[
    (
        "U5.rolling_speed",
        "speed at which a sliding grain rolls, divided by 5/7 of its initial speed",
        "angular momentum about a point of the plane; Götz (2024) eq. 11",
        Expected::within(1.0, 2e-3),
        "0.2 %: the lever arm is R − ξ/2 with ξ/R = 0.1 %, and the spring needs time to stretch",
    ),
    (
        "U5.rolls",
        "rim speed divided by speed at the end",
        "rolling; forward, so that the torque is b × F (Götz 2024, eq. 11), not −b × F",
        Expected::within(1.0, 2e-3),
        "0.2 %: the same lever arm",
    ),
    (
        "U5.time",
        "time until it rolls, divided by 2 v_0/(7 μ g)",
        "Coulomb friction of a rigid sphere",
        Expected::within(1.0, 2e-2),
        "2 %: the spring takes 0.1 ms of 12 ms to stretch, and equally long to relax",
    ),
    (
        "U5.place",
        "distance until it rolls, divided by 12 v_0²/(49 μ g)",
        "Coulomb friction of a rigid sphere",
        Expected::within(1.0, 2e-2),
        "2 %: as for the time",
    ),
    (
        "U5.energy",
        "kinetic energy including rotation at the end, divided by 5/7 of the initial one",
        "Coulomb friction of a rigid sphere",
        Expected::within(1.0, 4e-3),
        "0.4 %: twice that of the speed",
    ),
    (
        "U5.rolls_down",
        "acceleration down an incline of 1.6 μ, divided by 5/7 g sin θ",
        "rigid sphere that rolls",
        Expected::within(1.0, 3e-3),
        "0.3 %: lever arm, and the time to stretch the spring out of 40 ms",
    ),
    (
        "U5.slips_down",
        "acceleration down an incline of 6 μ, divided by g (sin θ − μ cos θ)",
        "rigid sphere that slips",
        Expected::within(1.0, 3e-3),
        "0.3 %: lever arm, and the time to stretch the spring out of 40 ms",
    ),
    (
        "U8.weight",
        "overlap of a grain that lies on a plane, divided by (m g/k)^(2/3)",
        "Hertz",
        Expected::within(1.0, 1e-9),
        "rounding of R − z; the bounce has died out",
    ),
    (
        "U8.creep",
        "creep of a grain that cannot roll at 0.9 of the friction angle, divided by its radius",
        "Coulomb: none",
        Expected::at_most(1e-9),
        "rounding of positions, at worst 2e-19 m in each of up to 10^6 steps",
    ),
    (
        "C1.shear_stiffness",
        "tangential stiffness at constant overlap, divided by Mindlin's 8 G* √(R* ξ)",
        "2/3 (Götz & Pöschel 2023, eqs. 7, 9). Götz (2024) eqs. 9, 10 as printed would give 8/9",
        Expected::within(2.0 / 3.0, 1e-6),
        "rounding; the spring is linear at constant overlap",
    ),
    (
        "C1.coulomb",
        "tangential force of a contact sheared beyond its limit, divided by μ F_n",
        "Coulomb; Götz (2024) eq. 10",
        Expected::within(1.0, 1e-9),
        "rounding: the limit is exact",
    ),
];

fn plot(scene: &LawsScene, record: &Record) -> Plot {
    let (v0, decay) = (scene.rolling.speed, scene.grain.surface.friction * G);
    let rolls_at = 2.0 * v0 / (7.0 * decay);
    let analytic = |label: &str, at_start: Real| {
        let end = 5.0 / 7.0 * v0;
        let points = vec![[0.0, at_start], [rolls_at, end], [2.0 * rolls_at, end]];
        Series::new(label, Kind::Analytic, points)
    };
    Plot::new(
        "A grain slides until it rolls",
        "no figure; the torque's sign in Götz (2024) eq. 11 makes it roll forward",
        ["time [s]", "speed, rim speed [m/s]"],
        vec![
            Series::new("speed", Kind::Line, record.points("time", "speed")),
            Series::new("spin times radius", Kind::Line, record.points("time", "rim_speed")),
            analytic("v_0 − μ g t", v0),
            analytic("5/2 μ g t", 0.0),
        ],
    )
}
