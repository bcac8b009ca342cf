//! Head-on collisions of two equal grains: Hertz's elastic impact, and the restitution of the
//! viscoelastic law over speed and modulus (Götz 2024, eqs. 4–6).

use super::{
    Law, RowSpec,
    build::{Encounter, elastic},
    measure::{push, worst},
    scene::LawsScene,
};
use crate::{
    base::{Real, real::real},
    experiments::{
        findings::{Expected, Kind, Plot, Series},
        record::Record,
    },
    physics::law::Surface,
    scene::Material,
};

pub(super) struct Impact;

/// Young's modulus (Pa), radius (m), dissipation time (s), speed (m/s), restitution: Runge–Kutta
/// integration of the law for equal spheres, ν = 0.245, 2000 kg/m³.
const TABLE: [[Real; 5]; 8] = [
    [1e8, 2.7e-3, 4.3e-6, 2.0, 0.875_83],
    [5e6, 2.0e-3, 7e-6, 1.0, 0.925_63],
    [5e6, 2.0e-3, 7e-6, 0.1, 0.952_19],
    [1e8, 2.0e-3, 7e-6, 1.0, 0.780_43],
    [1e8, 2.0e-3, 7e-6, 0.1, 0.852_79],
    [1e9, 2.0e-3, 7e-6, 1.0, 0.561_56],
    [1e10, 2.0e-3, 7e-6, 1.0, 0.296_05],
    [1e8, 0.7e-3, 7e-6, 0.5, 0.564_35],
];

impl Law for Impact {
    fn name(&self) -> &'static str {
        "impact"
    }

    fn n_points(&self, scene: &LawsScene) -> usize {
        3 * scene.restitution.n_speeds + TABLE.len() + 2
    }

    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record) {
        let n_swept = 3 * scene.restitution.n_speeds;
        if point < n_swept {
            sweep(scene, point, record);
        } else if point < n_swept + TABLE.len() {
            let [modulus, radius, time, speed, expected] = TABLE[point - n_swept];
            let found = restitution(scene, [modulus, radius, time, speed], record);
            worst(record, "U2.table", found - expected);
        } else if point == n_swept + TABLE.len() {
            let it = &scene.beam_grain;
            let set = [it.youngs_modulus, it.radius, it.dissipation_time, it.speed];
            let found = restitution(scene, set, record);
            record.set("C1.beam_grain_restitution", found, "1");
        } else {
            elastic_impact(scene, record);
        }
    }

    fn complete(&self, scene: &LawsScene, record: &mut Record) {
        compare_sweep(scene, record);
    }

    fn rows(&self) -> &'static [RowSpec] {
        ROWS
    }

    fn table(&self) -> Option<&'static str> {
        Some("laws_restitution")
    }

    fn plot(&self, scene: &LawsScene, record: &Record) -> Option<Plot> {
        Some(plot(scene, record))
    }
}

fn surface(scene: &LawsScene, dissipation_time: Real) -> Surface {
    Surface { friction: 0.0, dissipation_time, ..scene.grain.surface }
}

fn restitution(scene: &LawsScene, set: [Real; 4], record: &mut Record) -> Real {
    let [modulus, radius, time, speed] = set;
    let material = Material { youngs_modulus: modulus, ..scene.grain.material };
    let encounter = Encounter::equal(radius, material, surface(scene, time), speed);
    let (test, extremes) = encounter.meet(scene.steps_per_contact, record);
    worst(record, "C1.repulsive", extremes.force_min.min(0.0));
    encounter.restitution(&test)
}

/// One modulus and one speed.
fn sweep(scene: &LawsScene, point: usize, record: &mut Record) {
    let swept = &scene.restitution;
    let (m, s) = (point / swept.n_speeds, point % swept.n_speeds);
    let share = real(s) / real(swept.n_speeds - 1);
    let speed = swept.speed_min * (swept.speed_max / swept.speed_min).powf(share);
    let (modulus, time) = (swept.moduli[m], scene.grain.surface.dissipation_time);
    let found = restitution(scene, [modulus, scene.grain.radius, time, speed], record);
    let material = Material { youngs_modulus: modulus, ..scene.grain.material };
    let encounter = Encounter::equal(scene.grain.radius, material, surface(scene, time), speed);
    push(record, "modulus", "Pa", modulus);
    push(record, "speed", "m/s", speed);
    push(record, "restitution", "1", found);
    push(record, "restitution_theory", "1", encounter.collision().restitution(time));
}

fn elastic_impact(scene: &LawsScene, record: &mut Record) {
    let encounter = Encounter::equal(scene.grain.radius, scene.grain.material, elastic(0.0), 1.0);
    let oracle = encounter.collision();
    let (test, extremes) = encounter.meet(scene.steps_per_contact, record);
    record.set("U1.overlap", extremes.overlap_max / oracle.overlap_max(), "1");
    record.set("U1.force", extremes.force_max / oracle.force_max(), "1");
    record.set("U1.duration", extremes.duration / oracle.duration(), "1");
    record.set("U1.restitution", encounter.restitution(&test), "1");
}

/// Compares the swept restitutions with theory, and checks that they fall with speed and modulus.
fn compare_sweep(scene: &LawsScene, record: &mut Record) {
    for [measured, theory] in record.points("restitution", "restitution_theory") {
        worst(record, "U2.pade", measured - theory);
    }
    let measured = record.column("restitution").unwrap_or_default();
    let n = scene.restitution.n_speeds;
    if measured.len() == 3 * n {
        let rises = |less: usize, more: usize| measured[more] >= measured[less];
        let over_speed = (0..3 * n).filter(|k| k % n != 0 && rises(k - 1, *k)).count();
        let over_modulus = (n..3 * n).filter(|&k| rises(k - n, k)).count();
        record.set("C1.falls_with_speed", real(over_speed), "1");
        record.set("C1.falls_with_modulus", real(over_modulus), "1");
    }
}

const HERTZ: &str = "Hertz: (5 m v²/4k)^(2/5), k ξ^(3/2), 2.943275 ξ/v; Götz (2024) eq. 4";
const STEP: &str = "0.5 %: time step; at 500 steps per contact the duration is known to 0.2 %";

const ROWS: &[RowSpec] = &[
    (
        "U1.overlap",
        "largest overlap of an elastic head-on impact divided by that of Hertz",
        HERTZ,
        Expected::within(1.0, 5e-3),
        STEP,
    ),
    (
        "U1.force",
        "largest force of an elastic head-on impact divided by that of Hertz",
        HERTZ,
        Expected::within(1.0, 5e-3),
        STEP,
    ),
    (
        "U1.duration",
        "duration of an elastic head-on impact divided by that of Hertz",
        HERTZ,
        Expected::within(1.0, 5e-3),
        STEP,
    ),
    (
        "U1.restitution",
        "restitution of an elastic head-on impact",
        "conservation of energy",
        Expected::within(1.0, 1e-3),
        "1e-3: time step",
    ),
    (
        "U2.pade",
        "largest deviation of the restitution from theory over all speeds and moduli",
        "rational form of Müller & Pöschel (2011) for the law with F_n ≥ 0; Götz (2024) eq. 6",
        Expected::at_most(2e-3),
        "2e-3: time step, first order in the damping; the form itself is accurate to 2e-4",
    ),
    (
        "U2.table",
        "largest deviation of the restitution from eight integrated collisions",
        "Runge–Kutta integration of the law, ν = 0.245, 2000 kg/m³",
        Expected::at_most(2e-3),
        "2e-3: time step of 500 steps per contact",
    ),
    (
        "C1.beam_grain_restitution",
        "restitution of the largest grain of the beam at 2 m/s",
        "Götz & Pöschel (2023), section 3.1: 0.875, which requires A in microseconds",
        Expected::within(0.875, 0.2e-2 * 0.875),
        "0.2 %: the last digit is 0.06 %, the time step 0.1 %",
    ),
    (
        "C1.falls_with_speed",
        "number of steps in speed at which the restitution does not fall",
        "viscoelastic law, Götz (2024) chapter 2",
        Expected::at_most(0.0),
        "a count",
    ),
    (
        "C1.falls_with_modulus",
        "number of steps in modulus at which the restitution does not fall",
        "viscoelastic law, Götz (2024) chapter 2",
        Expected::at_most(0.0),
        "a count",
    ),
    (
        "C1.repulsive",
        "largest attractive normal force [N] in all collisions",
        "Götz (2024) eq. 6: F_n is at least zero",
        Expected::at_most(0.0),
        "exact: the law takes the maximum of zero and the sum",
    ),
];

fn plot(scene: &LawsScene, record: &Record) -> Plot {
    let n = scene.restitution.n_speeds;
    let mut series = Vec::new();
    for (m, modulus) in scene.restitution.moduli.iter().enumerate() {
        for (name, kind, label) in [
            ("restitution", Kind::Points, "measured"),
            ("restitution_theory", Kind::Analytic, "theory"),
        ] {
            let points = record.points("speed", name).into_iter().skip(m * n).take(n).collect();
            series.push(Series::new(&format!("{label}, {} MPa", modulus / 1e6), kind, points));
        }
    }
    Plot::new(
        "Restitution over closing speed",
        "Götz (2024), chapter 2: falls with speed and modulus; 0.875 for the beam's grain at 2 m/s \
         (Götz & Pöschel 2023)",
        ["closing speed [m/s]", "coefficient of restitution [-]"],
        series,
    )
    .with_logs([true, false])
}
