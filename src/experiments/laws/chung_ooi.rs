//! The eight benchmarks of Chung & Ooi (2011) for one and two spheres.
//!
//! Their tests 3, 4 and 6 to 8 assume a constant coefficient of restitution. The law here has none:
//! its dissipation time is chosen so that the theory of `oracles::impact` gives that restitution at
//! that speed. Where a contact slides, the result depends on the restitution alone, not on the law.

use super::{
    Law, RowSpec,
    build::{Encounter, Flight, elastic},
    measure::{push, worst},
    scene::LawsScene,
};
use crate::{
    base::{Real, Vec3},
    experiments::{
        findings::{Expected, Kind, Plot, Series},
        oracles::{
            impact::{Collision, sliding_rebound},
            micro_slip,
        },
        record::Record,
    },
};

pub(super) struct ChungOoi;

/// Restitutions of test 3.
const RESTITUTIONS: [Real; 5] = [0.2, 0.4, 0.6, 0.8, 0.98];
/// Test 4 with aluminium oxide: angle (deg) and e_t of a secant spring of 2/3 · 8 G* √(R* ξ),
/// integrated independently.
const TEST_4: [[Real; 2]; 9] = [
    [5.0, 0.684],
    [10.0, 0.577],
    [15.0, 0.558],
    [20.0, 0.579],
    [25.0, 0.621],
    [30.0, 0.685],
    [40.0, 0.783],
    [60.0, 0.895],
    [80.0, 0.968],
];
/// Tangential over μ times normal speed in test 5.
const RATIOS: [Real; 9] = [0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 20.0];
/// Spins of test 6 (rad/s). A rigid sphere slides throughout from 4.2 rad/s on; with a spring,
/// which sticks for a moment, it takes somewhat more.
const SPINS: [Real; 7] = [0.175, 1.0, 2.5, 4.5, 8.0, 15.0, 22.9];

/// Smallest spin at which the closed form is expected to hold (rad/s).
const SLIDES: Real = 6.0;

/// The points of the case: tests 1 to 8, each for one pair of materials.
const POINTS: [fn(&LawsScene, &mut Record); 8] =
    [test_1, test_2, test_3, test_4, test_5, test_6, test_7, test_8];

impl Law for ChungOoi {
    fn name(&self) -> &'static str {
        "chung_ooi"
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
        Some("laws_chung_ooi")
    }

    fn plot(&self, _: &LawsScene, record: &Record) -> Option<Plot> {
        Some(plot(record))
    }
}

/// Head-on, elastic, two equal spheres of 10 mm at ±10 m/s.
fn test_1(scene: &LawsScene, record: &mut Record) {
    for (name, overlap, force, duration) in
        [("glass", 274.1e-6, 10.697e3, 40.34e-6), ("limestone", 368.3e-6, 7.108e3, 54.20e-6)]
    {
        let encounter = Encounter::equal(0.01, scene.material(name), elastic(0.35), 20.0);
        let (_, extremes) = encounter.meet(scene.steps_per_contact, record);
        worst(record, "U3.test_1", extremes.overlap_max / overlap - 1.0);
        worst(record, "U3.test_1", extremes.force_max / force - 1.0);
        worst(record, "U3.test_1", extremes.duration / duration - 1.0);
    }
}

/// Head-on, elastic, a sphere of 100 mm on a rigid plane at 0.2 m/s.
fn test_2(scene: &LawsScene, record: &mut Record) {
    for (name, overlap, force, duration) in [
        ("aluminium_alloy", 49.72e-6, 11.370e3, 0.7317e-3),
        ("magnesium_alloy", 52.12e-6, 7.233e3, 0.7671e-3),
    ] {
        let flight = Flight {
            radius: 0.1,
            material: scene.material(name),
            surface: elastic(0.0),
            velocity: Vec3::z() * -0.2,
            spin: Vec3::zeros(),
        };
        let (_, extremes) = flight.land(scene.steps_per_contact, record);
        worst(record, "U3.test_2", extremes.overlap_max / overlap - 1.0);
        worst(record, "U3.test_2", extremes.force_max / force - 1.0);
        worst(record, "U3.test_2", extremes.duration / duration - 1.0);
    }
}

/// Head-on with restitution, 2.5 mm at 3.9 m/s on a rigid plane.
fn test_3(scene: &LawsScene, record: &mut Record) {
    for name in ["aluminium_oxide", "cast_iron"] {
        for prescribed in RESTITUTIONS {
            let mut flight = Flight {
                radius: 2.5e-3,
                material: scene.material(name),
                surface: elastic(0.0),
                velocity: Vec3::z() * -3.9,
                spin: Vec3::zeros(),
            };
            flight.surface.dissipation_time = dissipation_time(&flight.collision(), prescribed);
            let (test, _) = flight.land(scene.steps_per_contact, record);
            worst(record, "U3.test_3", test.grains().velocities[0].z / 3.9 - prescribed);
        }
    }
}

/// Oblique, 2.5 mm at 3.9 m/s, μ = 0.092, e = 0.98.
fn test_4(scene: &LawsScene, record: &mut Record) {
    for [degrees, expected] in TEST_4 {
        let angle = degrees.to_radians();
        let found = test_4_at(scene, "aluminium_oxide", angle, record);
        worst(record, "U3.test_4", found / expected - 1.0);
        let nu = scene.material("aluminium_oxide").poisson_ratio;
        let exact = micro_slip::rebound(micro_slip::stiffness_ratio(nu), 0.092, angle).tangential;
        worst(record, "U3.test_4_micro_slip", found / exact - 1.0);
        push(record, "test_4_angle", "deg", degrees);
        push(record, "test_4_e_t", "1", found);
        push(record, "test_4_e_t_micro_slip", "1", exact);
        for name in ["aluminium_oxide", "aluminium_alloy_of_test_4"] {
            if let Some(rigid) = sliding_rebound(0.092, 0.98, angle) {
                let found = test_4_at(scene, name, angle, record);
                worst(record, "U3.test_4_sliding", found / rigid.tangential - 1.0);
            }
        }
    }
}

fn test_4_at(scene: &LawsScene, name: &str, angle: Real, record: &mut Record) -> Real {
    let mut flight = Flight {
        radius: 2.5e-3,
        material: scene.material(name),
        surface: elastic(0.092),
        velocity: Vec3::new(angle.sin(), 0.0, -angle.cos()) * 3.9,
        spin: Vec3::zeros(),
    };
    flight.surface.dissipation_time = dissipation_time(&flight.collision(), 0.98);
    let (test, _) = flight.land(scene.steps_per_contact, record);
    test.grains().velocities[0].x / flight.velocity.x
}

/// Oblique, elastic, 10 µm at a normal speed of 5 m/s, μ = 0.3.
fn test_5(scene: &LawsScene, record: &mut Record) {
    for (name, id) in [("steel", "U3.test_5_steel"), ("polyethylene", "U3.test_5_polyethylene")] {
        for ratio in RATIOS {
            let flight = Flight {
                radius: 10e-6,
                material: scene.material(name),
                surface: elastic(0.3),
                velocity: Vec3::new(ratio * 0.3 * 5.0, 0.0, -5.0),
                spin: Vec3::zeros(),
            };
            let (test, _) = flight.land(scene.steps_per_contact, record);
            // Sign convention of the source: the spin of a sphere that rolls forward is negative.
            let spin = -test.grains().angular_velocities[0].y * flight.radius / (0.3 * 5.0);
            if ratio >= 7.0 {
                worst(record, id, spin / -5.0 - 1.0);
            }
            if name == "steel" {
                push(record, "test_5_ratio", "1", ratio);
                push(record, "test_5_spin", "1", spin);
            }
        }
    }
}

/// A spinning sphere of 100 mm falls on a rigid plane at 0.2 m/s, μ = 0.4, e = 0.5.
fn test_6(scene: &LawsScene, record: &mut Record) {
    for name in ["aluminium_alloy", "copper"] {
        for spin in SPINS {
            let mut flight = Flight {
                radius: 0.1,
                material: scene.material(name),
                surface: elastic(0.4),
                velocity: Vec3::z() * -0.2,
                spin: Vec3::y() * spin,
            };
            flight.surface.dissipation_time = dissipation_time(&flight.collision(), 0.5);
            let (test, _) = flight.land(scene.steps_per_contact, record);
            let gained = test.grains().velocities[0].x;
            let lost = spin - test.grains().angular_velocities[0].y;
            if spin > SLIDES {
                worst(record, "U3.test_6", gained / 0.12 - 1.0);
                worst(record, "U3.test_6", lost / 3.0 - 1.0);
            }
        }
    }
}

/// Two equal spheres of 100 mm at ±0.2 m/s that spin in opposite directions, or in the same.
fn test_7(scene: &LawsScene, record: &mut Record) {
    for name in ["aluminium_alloy", "copper"] {
        for spin in [1.0, 8.0, 22.9] {
            let mut encounter = Encounter::equal(0.1, scene.material(name), elastic(0.4), 0.4);
            encounter.surface.dissipation_time = dissipation_time(&encounter.collision(), 0.5);
            encounter.spins = [Vec3::z() * spin, Vec3::z() * -spin];
            let (test, _) = encounter.meet(scene.steps_per_contact, record);
            for i in 0..2 {
                let changed = test.grains().angular_velocities[i] - encounter.spins[i];
                worst(record, "U3.test_7_no_slip", changed.norm() / spin);
                worst(record, "U3.test_7_no_slip", test.grains().velocities[i].yz().norm() / 0.2);
            }
            if spin > SLIDES {
                encounter.spins = [Vec3::z() * spin; 2];
                let (test, _) = encounter.meet(scene.steps_per_contact, record);
                for i in 0..2 {
                    worst(
                        record,
                        "U3.test_7_slip",
                        (spin - test.grains().angular_velocities[i].z) / 3.0 - 1.0,
                    );
                    let sideways = test.grains().velocities[i].y.abs();
                    worst(record, "U3.test_7_slip", sideways / 0.12 - 1.0);
                }
            }
        }
    }
}

/// A spinning sphere of 100 mm hits one five times as large and a thousand times as dense, at rest.
fn test_8(scene: &LawsScene, record: &mut Record) {
    for name in ["aluminium_alloy", "nylon"] {
        let material = scene.material(name);
        for spin in [8.0, 22.9] {
            let mut encounter = Encounter::equal(0.1, material, elastic(0.4), 0.2);
            encounter.radii = [0.1, 0.5];
            encounter.densities = [material.density, 1000.0 * material.density];
            encounter.speeds = [0.2, 0.0];
            encounter.spins = [Vec3::z() * spin, Vec3::zeros()];
            encounter.surface.dissipation_time = dissipation_time(&encounter.collision(), 0.5);
            let (test, _) = encounter.meet(scene.steps_per_contact, record);
            let grains = test.grains();
            worst(record, "U3.test_8", (spin - grains.angular_velocities[0].z) / 3.0 - 1.0);
            worst(record, "U3.test_8", grains.velocities[0].y.abs() / 0.12 - 1.0);
        }
    }
}

fn dissipation_time(collision: &Collision, restitution: Real) -> Real {
    collision.dissipation_time_for(restitution)
}

const HERTZ: &str = "Hertz, with the benchmark's numbers (Chung & Ooi 2011)";
const SLIDING: &str = "rigid-body impact: v_t' = μ (1 + e) v_n = 0.12 m/s, ω − ω' = 3.0 rad/s";
const STEP: &str = "0.5 %: time step, and the last digits of the benchmark";

const ROWS: &[RowSpec] = &[
    (
        "U3.test_1",
        "largest relative error of overlap, force and duration: two elastic spheres",
        HERTZ,
        Expected::at_most(5e-3),
        STEP,
    ),
    (
        "U3.test_2",
        "largest relative error of overlap, force and duration: elastic sphere on plane",
        HERTZ,
        Expected::at_most(5e-3),
        STEP,
    ),
    (
        "U3.test_3",
        "largest error of v'/v for prescribed restitutions from 0.2 to 0.98",
        "the prescribed restitution, with the dissipation time that gives it in theory",
        Expected::at_most(1e-2),
        "0.01: time step at strong damping, and the rational form of the theory, which is \
        accurate up to v* = 1.2, e ≥ 0.4. The tolerance 0.001 suits laws with a constant \
        restitution, which this law does not have",
    ),
    (
        "U3.test_4",
        "largest relative error of e_t over angles, aluminium oxide",
        "independent integration of a secant spring of 2/3 · 8 G* √(R* ξ), e = 0.98",
        Expected::at_most(1e-2),
        "1 %: time step, three digits, another damping law with the same e. The commonly quoted \
        curve for this test belongs to a spring without the factor 2/3 and is no oracle below 25°",
    ),
    (
        "U3.test_4_micro_slip",
        "largest relative deviation of e_t from the exact solution with micro-slip, aluminium \
        oxide",
        "method of dimensionality reduction, e = 1",
        Expected::at_most(0.12),
        "12 %: the single spring; it is 10 % below the exact solution at 10°, and would be 29 % \
        above it without the factor 2/3",
    ),
    (
        "U3.test_4_sliding",
        "largest relative error of e_t where the contact slides throughout, both materials",
        "e_t = 1 − μ (1 + e)/tan θ for tan θ ≥ 7/2 μ (1 + e)",
        Expected::at_most(1e-2),
        "1 %: time step and restitution",
    ),
    (
        "U3.test_5_steel",
        "largest relative error of R ω'/(μ v_n) where the contact slides throughout, steel",
        "rigid-body impact: −5/2 (1 + e) = −5",
        Expected::at_most(1e-2),
        "1 %: the lever arm is R − ξ/2, with ξ/R up to 0.7 %",
    ),
    (
        "U3.test_5_polyethylene",
        "largest relative error of R ω'/(μ v_n) where the contact slides throughout, polyethylene",
        "rigid-body impact: −5/2 (1 + e) = −5",
        Expected::at_most(1.5e-2),
        "1.5 %: the lever arm is R − ξ/2, and ξ/R reaches 2.7 % in this soft sphere",
    ),
    (
        "U3.test_6",
        "largest relative error of v_t' and of the lost spin where the contact slides throughout",
        SLIDING,
        Expected::at_most(1e-2),
        "1 %: time step at a restitution of 0.5",
    ),
    (
        "U3.test_7_no_slip",
        "largest relative change of spins and lateral velocity of spheres that spin without slip",
        "nothing changes",
        Expected::at_most(1e-9),
        "rounding over the steps of a collision",
    ),
    (
        "U3.test_7_slip",
        "largest relative error of lateral velocity and lost spin of spheres that spin in the \
        same direction",
        SLIDING,
        Expected::at_most(1e-2),
        "1 %: time step at a restitution of 0.5",
    ),
    (
        "U3.test_8",
        "largest relative error of v_t' and of the lost spin on a large, dense sphere",
        SLIDING,
        Expected::at_most(1.5e-2),
        "1.5 %: time step; nylon overlaps by 0.2 % of R, and the large sphere recoils by 1/125000",
    ),
];

fn plot(record: &Record) -> Plot {
    let exact = record.points("test_4_angle", "test_4_e_t_micro_slip");
    let law = "independent integration of the law";
    Plot::new(
        "Chung & Ooi (2011), test 4: aluminium oxide on a plane",
        "the commonly quoted curve falls from 0.948 at 5° to 0.616 at 20° and rises to 1; below \
        25° it belongs to a law without the factor 2/3",
        ["angle from the normal [deg]", "tangential restitution e_t [-]"],
        vec![
            Series::new("measured", Kind::Points, record.points("test_4_angle", "test_4_e_t")),
            Series::new("exact solution with micro-slip", Kind::Analytic, exact),
            Series::new(law, Kind::Source, TEST_4.to_vec()),
            Series::new("commonly quoted curve", Kind::Source, COMMONLY_QUOTED.to_vec()),
        ],
    )
}

/// Test 4 as re-implementations commonly quote it.
const COMMONLY_QUOTED: [[Real; 2]; 9] = [
    [5.0, 0.948],
    [10.0, 0.687],
    [15.0, 0.624],
    [20.0, 0.616],
    [25.0, 0.634],
    [30.0, 0.684],
    [40.0, 0.781],
    [60.0, 0.893],
    [80.0, 0.966],
];
