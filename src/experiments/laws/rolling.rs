//! A grain on a plane that slides until it rolls, rolls or slips down an incline, sinks in by its
//! weight, and does not creep where it sticks (Götz 2024, eqs. 8–11).

use super::{
    Law, Line,
    build::{Bench, G, mass},
    judge, push,
    scene::Scene,
};
use crate::{
    base::{Real, Vec3, real::real},
    experiments::{
        findings::{Curve, Expected, Findings, Kind, Plot, Series},
        record::Record,
    },
    physics::law::{PairLaw, Surface},
};

pub(super) struct Rolling;

/// Points: the slide, then inclines, weight, creep and the spring.
const POINTS: [fn(&Scene, &mut Record); 5] = [slide, inclines, weight, creep, shear];
/// Steps between recorded ones.
const EVERY: usize = 20;

impl Law for Rolling {
    fn name(&self) -> &'static str {
        "rolling"
    }

    fn n_points(&self, _: &Scene) -> usize {
        POINTS.len()
    }

    fn measure(&self, scene: &Scene, point: usize, record: &mut Record) {
        POINTS[point](scene, record);
    }

    fn evaluate(&self, scene: &Scene, record: &Record, findings: &mut Findings) {
        judge(ROWS, record, findings);
        findings
            .curves
            .push(Curve { name: "laws_rolling".to_owned(), columns: record.columns.clone() });
        findings.plots.push(plot(scene, record));
    }
}

/// One grain that lies on the plane in equilibrium, `tilt` (rad) about y.
fn resting(scene: &Scene, surface: Surface, tilt: Real) -> Bench {
    let grain = &scene.grain;
    let mut bench = Bench::on_plane(&grain.material, surface, scene.rolling.substep);
    bench.system.model.gravity = Vec3::new(tilt.sin(), 0.0, -tilt.cos()) * G;
    let height = grain.radius - resting_overlap(scene, tilt);
    bench.add_grain(Vec3::z() * height, grain.radius, grain.material.density);
    bench
}

/// ξ = (m g cos θ / k)^(2/3).
fn resting_overlap(scene: &Scene, tilt: Real) -> Real {
    let grain = &scene.grain;
    let k = 4.0 / 3.0
        * PairLaw::against_rigid(&grain.material, grain.surface).modulus
        * grain.radius.sqrt();
    (mass(grain.radius, grain.material.density) * G * tilt.cos() / k).powf(2.0 / 3.0)
}

/// A grain that begins to slide at v_0 rolls from 2 v_0/(7 μ g) on.
fn slide(scene: &Scene, record: &mut Record) {
    let (grain, v0) = (&scene.grain, scene.rolling.speed);
    let mut bench = resting(scene, grain.surface, 0.0);
    bench.grains_mut().velocities[0].x = v0;
    let rolls_at = 2.0 * v0 / (7.0 * grain.surface.friction * G);
    let n_steps = (2.0 * rolls_at / scene.rolling.substep).ceil();
    let mut rolled_at = None;
    let mut step = 0;
    while real(step) < n_steps {
        if step % EVERY == 0 {
            push(record, "time", "s", real(step) * scene.rolling.substep);
            push(record, "speed", "m/s", bench.grains().velocities[0].x);
            push(record, "rim_speed", "m/s", bench.grains().angular_velocities[0].y * grain.radius);
        }
        bench.step();
        step += 1;
        let slip =
            bench.grains().velocities[0].x - bench.grains().angular_velocities[0].y * grain.radius;
        if rolled_at.is_none() && slip < 0.01 * v0 {
            // The last percent of the slip would take a percent of the time.
            let time = real(step) * scene.rolling.substep / 0.99;
            rolled_at = Some((time, bench.grains().positions[0].x));
        }
    }
    let (v, spin) = (bench.grains().velocities[0].x, bench.grains().angular_velocities[0].y);
    record.set("U5.rolling_speed", v / (5.0 / 7.0 * v0), "1");
    record.set("U5.rolls", spin * grain.radius / v, "1");
    let (time, place) = rolled_at.unwrap_or((Real::NAN, Real::NAN));
    record.set("U5.time", time / rolls_at, "1");
    record.set("U5.place", place / (6.0 / 7.0 * v0 * rolls_at), "1");
    let energy = bench.kinetic_energy() / (0.5 * bench.grains().masses[0] * v0 * v0);
    record.set("U5.energy", energy / (5.0 / 7.0), "1");
}

/// Down an incline: rolling while tan θ < 7/2 μ, else slipping.
fn inclines(scene: &Scene, record: &mut Record) {
    let friction = scene.grain.surface.friction;
    for (id, tan) in [("U5.rolls_down", 1.6 * friction), ("U5.slips_down", 6.0 * friction)] {
        let tilt = tan.atan();
        let mut bench = resting(scene, scene.grain.surface, tilt);
        let n_steps = 4000;
        for _ in 0..n_steps {
            bench.step();
        }
        let expected = if tan < 3.5 * friction {
            5.0 / 7.0 * G * tilt.sin()
        } else {
            G * (tilt.sin() - friction * tilt.cos())
        };
        let time = real(n_steps) * scene.rolling.substep;
        record.set(id, bench.grains().velocities[0].x / time / expected, "1");
    }
}

/// Laid down without overlap, it sinks in until the plane carries it.
fn weight(scene: &Scene, record: &mut Record) {
    let surface = Surface { dissipation_time: 1e-4, ..scene.grain.surface };
    let mut bench = resting(scene, surface, 0.0);
    bench.grains_mut().positions[0].z = scene.grain.radius;
    for _ in 0..40_000 {
        bench.step();
    }
    record.set("U8.weight", bench.overlap() / resting_overlap(scene, 0.0), "1");
}

/// A grain that may not roll, at 0.9 of the angle of friction.
fn creep(scene: &Scene, record: &mut Record) {
    let surface = Surface { dissipation_time: 1e-4, ..scene.grain.surface };
    let mut bench = resting(scene, surface, (0.9 * surface.friction).atan());
    let mut go = |n_steps: usize| {
        for _ in 0..n_steps {
            bench.step();
            bench.grains_mut().angular_velocities[0] = Vec3::zeros();
        }
        bench.grains().positions[0].x
    };
    let settled = go(scene.rolling.n_creep_steps / 10 + 20_000);
    let end = go(scene.rolling.n_creep_steps);
    record.set("U8.creep", (end - settled).abs() / scene.grain.radius, "1");
}

/// A contact held at one overlap and sheared by a little: the stiffness of the spring.
fn shear(scene: &Scene, record: &mut Record) {
    let grain = &scene.grain;
    let surface = Surface { tangential_damping: 0.0, dissipation_time: 0.0, ..grain.surface };
    let (overlap, n_steps) = (0.01 * grain.radius, 1000);
    let mut bench = Bench::on_plane(&grain.material, surface, 1e-6);
    bench.add_grain(Vec3::zeros(), grain.radius, grain.material.density);
    let law = PairLaw::against_rigid(&grain.material, surface);
    let mindlin = 8.0 * law.shear_modulus * (grain.radius * overlap).sqrt();
    let normal = 4.0 / 3.0 * law.modulus * grain.radius.sqrt() * overlap.powf(1.5);
    let full = surface.friction * normal / (2.0 / 3.0 * mindlin);
    let mut sheared = |distance: Real| {
        for _ in 0..n_steps {
            let grains = bench.grains_mut();
            grains.positions[0].z = grain.radius - overlap;
            grains.velocities[0] = Vec3::x() * (distance / (real(n_steps) * 1e-6));
            grains.angular_velocities[0] = Vec3::zeros();
            bench.step();
        }
        -bench.system.scratch.wall_forces.first().map_or(0.0, |wall| wall.force.x)
    };
    record.set("C1.shear_stiffness", sheared(0.5 * full) / (mindlin * 0.5 * full), "1");
    record.set("C1.coulomb", sheared(5.0 * full) / (surface.friction * normal), "1");
}

const ROWS: &[Line] = &[
    (
        "U5.rolling_speed",
        "speed at which a grain that slid rolls, over 5/7 of its first speed",
        "angular momentum about a point of the plane; Götz (2024) eq. 11",
        Expected::within(1.0, 2e-3),
        "0.2 %: the lever is R − ξ/2 with ξ/R = 0.1 %, and the spring takes a moment to stretch",
    ),
    (
        "U5.rolls",
        "rim speed over speed at the end",
        "rolling; forward, so that the torque is b × F (Götz 2024, eq. 11), not −b × F",
        Expected::within(1.0, 2e-3),
        "0.2 %: the same lever",
    ),
    (
        "U5.time",
        "time until it rolls, over 2 v_0/(7 μ g)",
        "Coulomb friction of a rigid sphere",
        Expected::within(1.0, 2e-2),
        "2 %: the spring takes 0.1 ms of 12 ms to stretch, and as long to let go",
    ),
    (
        "U5.place",
        "way until it rolls, over 12 v_0²/(49 μ g)",
        "Coulomb friction of a rigid sphere",
        Expected::within(1.0, 2e-2),
        "2 %: as for the time",
    ),
    (
        "U5.energy",
        "kinetic energy with rotation at the end, over 5/7 of the first",
        "Coulomb friction of a rigid sphere",
        Expected::within(1.0, 4e-3),
        "0.4 %: twice that of the speed",
    ),
    (
        "U5.rolls_down",
        "acceleration down an incline of 1.6 μ, over 5/7 g sin θ",
        "rigid sphere that rolls",
        Expected::within(1.0, 3e-3),
        "0.3 %: lever, and the spring's first stretch out of 40 ms",
    ),
    (
        "U5.slips_down",
        "acceleration down an incline of 6 μ, over g (sin θ − μ cos θ)",
        "rigid sphere that slips",
        Expected::within(1.0, 3e-3),
        "0.3 %: lever, and the spring's first stretch out of 40 ms",
    ),
    (
        "U8.weight",
        "overlap of a grain that lies on a plane, over (m g/k)^(2/3)",
        "Hertz",
        Expected::within(1.0, 1e-9),
        "rounding of R − z; the bounce has died out",
    ),
    (
        "U8.creep",
        "creep over radius of a grain that may not roll, at 0.9 of the angle of friction",
        "Coulomb: none",
        Expected::at_most(1e-9),
        "rounding of positions, at worst 2e-19 m in each of up to 10^6 steps",
    ),
    (
        "C1.shear_stiffness",
        "tangential stiffness at constant overlap, over Mindlin's 8 G* √(R* ξ)",
        "2/3 (Götz & Pöschel 2023, eqs. 7, 9). Götz (2024) eqs. 9, 10 as printed would give 8/9",
        Expected::within(2.0 / 3.0, 1e-6),
        "rounding; the spring is linear at constant overlap",
    ),
    (
        "C1.coulomb",
        "tangential force of a contact sheared beyond its limit, over μ F_n",
        "Coulomb; Götz (2024) eq. 10",
        Expected::within(1.0, 1e-9),
        "rounding: the limit is exact",
    ),
];

fn plot(scene: &Scene, record: &Record) -> Plot {
    let column = |name: &str| record.column(name).unwrap_or(&[]);
    let over_time = |name: &str, kind, label: &str| Series {
        label: label.to_owned(),
        kind,
        points: column("time").iter().zip(column(name)).map(|(&x, &y)| [x, y]).collect(),
        deviations: Vec::new(),
    };
    let (v0, decay) = (scene.rolling.speed, scene.grain.surface.friction * G);
    let rolls_at = 2.0 * v0 / (7.0 * decay);
    let analytic = |label: &str, at_start: Real| Series {
        label: label.to_owned(),
        kind: Kind::Analytic,
        points: vec![[0.0, at_start], [rolls_at, 5.0 / 7.0 * v0], [2.0 * rolls_at, 5.0 / 7.0 * v0]],
        deviations: Vec::new(),
    };
    Plot {
        title: "A grain slides until it rolls".to_owned(),
        source_says: "no figure; the torque's sign in Götz (2024) eq. 11 makes it roll forward"
            .to_owned(),
        x_label: "time [s]".to_owned(),
        y_label: "speed, rim speed [m/s]".to_owned(),
        log_x: false,
        log_y: false,
        series: vec![
            over_time("speed", Kind::Line, "speed"),
            over_time("rim_speed", Kind::Line, "spin times radius"),
            analytic("v_0 − μ g t", v0),
            analytic("5/2 μ g t", 0.0),
        ],
    }
}
