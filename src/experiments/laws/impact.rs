//! Head-on collisions of two equal grains: Hertz's elastic impact, and the restitution of the
//! viscoelastic law over speed and modulus (Götz 2024, eqs. 4–6).

use super::{
    Law, Line,
    build::{Encounter, elastic},
    judge, push,
    scene::Scene,
    worst,
};
use crate::{
    base::{Real, real::real},
    experiments::{
        findings::{Curve, Expected, Findings, Kind, Plot, Series},
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

    fn n_points(&self, scene: &Scene) -> usize {
        3 * scene.restitution.n_speeds + TABLE.len() + 2
    }

    fn measure(&self, scene: &Scene, point: usize, record: &mut Record) {
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

    fn evaluate(&self, scene: &Scene, record: &Record, findings: &mut Findings) {
        judge(ROWS, &compare_sweep(scene, record), findings);
        let names = ["modulus", "speed", "restitution", "restitution_theory"];
        let columns = record.columns.iter().filter(|it| names.contains(&it.name.as_str()));
        findings.curves.push(Curve {
            name: "laws_restitution".to_owned(),
            columns: columns.cloned().collect(),
        });
        findings.plots.push(plot(scene, record));
    }
}

fn surface(scene: &Scene, dissipation_time: Real) -> Surface {
    Surface { friction: 0.0, dissipation_time, ..scene.grain.surface }
}

fn restitution(scene: &Scene, set: [Real; 4], record: &mut Record) -> Real {
    let [modulus, radius, time, speed] = set;
    let material = Material { youngs_modulus: modulus, ..scene.grain.material };
    let encounter = Encounter::equal(radius, material, surface(scene, time), speed);
    let (bench, met) = encounter.meet(scene.steps_per_contact, record);
    worst(record, "C1.repulsive", met.force_min.min(0.0));
    encounter.restitution(&bench)
}

/// One modulus and one speed.
fn sweep(scene: &Scene, point: usize, record: &mut Record) {
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

fn elastic_impact(scene: &Scene, record: &mut Record) {
    let encounter = Encounter::equal(scene.grain.radius, scene.grain.material, elastic(0.0), 1.0);
    let oracle = encounter.collision();
    let (bench, met) = encounter.meet(scene.steps_per_contact, record);
    record.set("U1.overlap", met.overlap_max / oracle.overlap_max(), "1");
    record.set("U1.force", met.force_max / oracle.force_max(), "1");
    record.set("U1.duration", met.duration / oracle.duration(), "1");
    record.set("U1.restitution", encounter.restitution(&bench), "1");
}

/// How far the swept restitutions are from theory, and whether they fall with speed and modulus.
fn compare_sweep(scene: &Scene, record: &Record) -> Record {
    let mut found = record.clone();
    let column = |name: &str| record.column(name).unwrap_or(&[]);
    let (measured, theory) = (column("restitution"), column("restitution_theory"));
    for (a, b) in measured.iter().zip(theory) {
        worst(&mut found, "U2.pade", a - b);
    }
    let n = scene.restitution.n_speeds;
    if measured.len() == 3 * n {
        let rises = |less: usize, more: usize| measured[more] >= measured[less];
        let over_speed = (0..3 * n).filter(|k| k % n != 0 && rises(k - 1, *k)).count();
        let over_modulus = (n..3 * n).filter(|&k| rises(k - n, k)).count();
        found.set("C1.falls_with_speed", real(over_speed), "1");
        found.set("C1.falls_with_modulus", real(over_modulus), "1");
    }
    found
}

const HERTZ: &str = "Hertz: (5 m v²/4k)^(2/5), k ξ^(3/2), 2.943275 ξ/v; Götz (2024) eq. 4";
const STEP: &str = "0.5 %: time step; at 500 steps per contact the duration is known to 0.2 %";

const ROWS: &[Line] = &[
    (
        "U1.overlap",
        "largest overlap of an elastic head-on impact, over Hertz",
        HERTZ,
        Expected::within(1.0, 5e-3),
        STEP,
    ),
    (
        "U1.force",
        "largest force of an elastic head-on impact, over Hertz",
        HERTZ,
        Expected::within(1.0, 5e-3),
        STEP,
    ),
    (
        "U1.duration",
        "duration of an elastic head-on impact, over Hertz",
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
        "largest distance of the restitution from its theory, over speeds and moduli",
        "rational form of Müller & Pöschel (2011) for the law with F_n ≥ 0; Götz (2024) eq. 6",
        Expected::at_most(2e-3),
        "2e-3: time step, first order in the damping; the form itself is right to 2e-4",
    ),
    (
        "U2.table",
        "largest distance of the restitution from eight integrated collisions",
        "Runge–Kutta integration of the law, ν = 0.245, 2000 kg/m³",
        Expected::at_most(2e-3),
        "2e-3: time step of 500 steps per contact",
    ),
    (
        "C1.beam_grain_restitution",
        "restitution of the largest grain of the beam at 2 m/s",
        "Götz & Pöschel (2023), section 3.1: 0.875; only with A in microseconds",
        Expected::within(0.875, 0.2e-2 * 0.875),
        "0.2 %: the last digit is 0.06 %, the time step 0.1 %",
    ),
    (
        "C1.falls_with_speed",
        "steps of speed at which the restitution does not fall",
        "viscoelastic law, Götz (2024) chapter 2",
        Expected::at_most(0.0),
        "counted",
    ),
    (
        "C1.falls_with_modulus",
        "steps of modulus at which the restitution does not fall",
        "viscoelastic law, Götz (2024) chapter 2",
        Expected::at_most(0.0),
        "counted",
    ),
    (
        "C1.repulsive",
        "largest attractive normal force [N] in all collisions",
        "Götz (2024) eq. 6: F_n is at least zero",
        Expected::at_most(0.0),
        "exact: the law takes the larger of zero and the sum",
    ),
];

fn plot(scene: &Scene, record: &Record) -> Plot {
    let column = |name: &str| record.column(name).unwrap_or(&[]);
    let n = scene.restitution.n_speeds;
    let mut series = Vec::new();
    for (m, modulus) in scene.restitution.moduli.iter().enumerate() {
        for (name, kind, label) in [
            ("restitution", Kind::Points, "measured"),
            ("restitution_theory", Kind::Analytic, "theory"),
        ] {
            let values = column("speed").iter().zip(column(name));
            series.push(Series {
                label: format!("{label}, {} MPa", modulus / 1e6),
                kind,
                points: values.skip(m * n).take(n).map(|(&x, &y)| [x, y]).collect(),
                deviations: Vec::new(),
            });
        }
    }
    Plot {
        title: "Restitution over closing speed".to_owned(),
        source_says: "Götz (2024), chapter 2: falls with speed and modulus; 0.875 for the beam's \
                      grain at 2 m/s (Götz & Pöschel 2023)"
            .to_owned(),
        x_label: "closing speed [m/s]".to_owned(),
        y_label: "coefficient of restitution [-]".to_owned(),
        log_x: true,
        log_y: false,
        series,
    }
}
