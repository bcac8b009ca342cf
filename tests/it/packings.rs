//! Periodic boxes, and packings that are resumed after an interruption.

use jamgrip::{
    base::{
        Mat3, Real, Vec3,
        digest::Digest,
        parallel,
        random::{Random, Stream},
    },
    experiments::{Experiment, Plan, SceneText, Size, packing::Packing},
    measure::{
        coordination::{NEEDED_SMOOTH, coordination},
        rest, stress,
    },
    physics::{
        System, SystemBuilder,
        contact::grains::closest_image,
        law::{PairLaw, Surface},
        packing::{Grown, Growth, Recipe, Room, pressure::normal_pressure, scatter, sphere_volume},
        state::Grains,
    },
};

use crate::rig::GRAIN;

const RADIUS: Real = 2e-3;
const EDGE: Real = 22e-3;
const N_GRAINS: usize = 200;

/// Grains in a periodic box; their final solid fraction is 0.63.
fn box_of_grains(friction: Real) -> (System, Growth) {
    let surface = Surface { friction, dissipation_time: 5e-5, tangential_damping: 0.3 };
    let law = PairLaw::between(&GRAIN, &GRAIN, surface);
    let room = Room::Periodic { period: Vec3::repeat(EDGE) };
    let mut random = Random::new(3, Stream::Position);
    let small = vec![0.65 * RADIUS; N_GRAINS];
    let places = scatter(&small, room.period(), &mut random, |it| room.place(0.0, it)).unwrap();
    let mass = GRAIN.density * sphere_volume(RADIUS);
    let mut builder = SystemBuilder::new(law);
    builder.substep(2e-5).radii_up_to(RADIUS, RADIUS).period(Vec3::repeat(EDGE));
    builder.grains(Grains::at_rest(places, small, vec![mass; N_GRAINS]));
    let system = builder.build().unwrap();
    let recipe = Recipe::new(&system.model, room.volume(), 1e3, mass, RADIUS);
    let recipe = Recipe { laws: jamgrip::physics::packing::Laws::of(&system.model), ..recipe };
    (system, Growth::new(recipe, vec![RADIUS; N_GRAINS], 0.65))
}

fn digest(system: &System) -> u64 {
    let mut digest = Digest::new();
    system.state.digest(&mut digest);
    digest.finish()
}

#[test]
fn a_periodic_box_has_no_walls_and_lists_every_pair() {
    let (mut system, mut growth) = box_of_grains(0.3);
    for k in 0..6000 {
        if growth.step(&mut system) != Grown::Growing {
            break;
        }
        if k % 1500 != 1499 {
            continue;
        }
        let grains = &system.state.grains;
        // Oracle: Newton's third law; tolerance 1e-12 of the sum of magnitudes: rounding.
        let momentum: Vec3 =
            grains.velocities.iter().zip(&grains.masses).map(|(v, m)| v * *m).sum();
        let all: Real = grains.velocities.iter().map(|v| v.norm() * grains.masses[0]).sum();
        assert!(momentum.norm() < 1e-12 * all, "{momentum:?} of {all}");
        // Oracle: brute force over all pairs and images, against the pairs that are listed.
        let period = Vec3::repeat(EDGE);
        for i in 0..N_GRAINS {
            for j in i + 1..N_GRAINS {
                let delta = closest_image(grains.positions[i] - grains.positions[j], &period);
                if delta.norm() < grains.radii[i] + grains.radii[j] {
                    let ids = [i, j].map(|id| u32::try_from(id).unwrap());
                    assert!(system.state.pair_ids.binary_search(&ids).is_ok(), "{i} {j} at {k}");
                }
            }
        }
    }
    let pressure = normal_pressure(&system.state, &system.scratch, EDGE.powi(3));
    assert!(pressure > 0.0, "the grains touch");
    let furthest =
        system.state.grains.positions.iter().map(|p| (p - Vec3::repeat(EDGE / 2.0)).amax());
    assert!(
        furthest.fold(0.0, Real::max) > EDGE / 2.0,
        "some grains left the box without consequences"
    );
}

#[test]
fn a_periodic_box_has_the_same_bits_for_any_number_of_threads_and_any_origin_of_images() {
    let run = |n_threads: usize, skin: Real| {
        parallel::lead(&parallel::ThreadPool::new(n_threads).unwrap(), || {
            let (mut system, mut growth) = box_of_grains(0.3);
            system.model.skin *= skin;
            for _ in 0..4000 {
                growth.step(&mut system);
            }
            (digest(&system), system.scratch.neighbors.n_builds)
        })
    };
    let (expected, n_builds) = run(1, 1.0);
    for n_threads in [2, 7] {
        // Oracle: the run on one thread, to the last bit.
        assert_eq!(run(n_threads, 1.0).0, expected, "{n_threads} threads");
    }
    let (other, n_builds_now) = run(1, 2.0);
    assert_ne!(n_builds_now, n_builds, "the lists were built at other times");
    assert_eq!(other, expected, "contacts were missed between two builds");
}

/// Oracle: a simple cubic lattice of smooth grains, compressed by ξ: each of its three contacts per grain
/// carries F = 4/3 E* √R* ξ^(3/2) over the area a² of a cell and stores 8/15 E* √R* ξ^(5/2). To rounding:
/// balanced grains do not move in the first substep.
#[test]
fn a_compressed_lattice_has_the_stress_and_the_energy_of_its_contacts() {
    let surface = Surface { friction: 0.0, dissipation_time: 0.0, tangential_damping: 0.0 };
    let law = PairLaw::between(&GRAIN, &GRAIN, surface);
    let overlap = 1e-5;
    let cell = 2.0 * RADIUS - overlap;
    let at = |k: usize| {
        Vec3::from([k % 4, k / 4 % 4, k / 16].map(|n| cell * f64::from(u32::try_from(n).unwrap())))
    };
    let grains = Grains::at_rest((0..64).map(at).collect(), vec![RADIUS; 64], vec![1e-4; 64]);
    let mut builder = SystemBuilder::new(law);
    builder.substep(1e-6).period(Vec3::repeat(4.0 * cell)).grains(grains);
    let mut system = builder.build().unwrap();
    system.step();
    let System { model, state, scratch, .. } = &system;
    let volume = (4.0 * cell).powi(3);
    let force = 4.0 / 3.0 * law.modulus * (RADIUS / 2.0).sqrt() * overlap.powf(1.5);
    let sigma = stress::contact_stress(model, state, scratch, volume);
    let expected = Mat3::identity() * (force / (cell * cell));
    assert!((sigma - expected).norm() < 1e-9 * expected.norm(), "{sigma} {expected}");
    let pressure = normal_pressure(state, scratch, volume);
    assert!((pressure / expected[(0, 0)] - 1.0).abs() < 1e-9, "{pressure}");
    let energy = rest::elastic_energy(model, state, scratch);
    assert!((energy / (64.0 * 3.0 * 0.4 * force * overlap) - 1.0).abs() < 1e-9, "{energy}");
    assert!(rest::unbalanced_force(model, state, scratch) < 1e-9);
    let found = coordination(state, scratch, NEEDED_SMOOTH);
    assert!((found.mean - 6.0).abs() < 1e-15 && found.rattler_share.abs() < 1e-15, "{found:?}");
}

fn plan(overrides: &[&str]) -> Box<dyn Plan> {
    let (source, text) = Packing.scene();
    let overrides: Vec<String> = overrides.iter().map(|it| (*it).to_owned()).collect();
    let scene = SceneText { text, source, overrides: &overrides, size: Size::Quick };
    Packing.read(&scene).unwrap()
}

/// Overrides for a small version of the experiment.
const SMALL: [&str; 6] = [
    "grains.count=150",
    "grains.count_smooth=150",
    "confined.count=60",
    "confined.frequency=4",
    "compression.rest_time_max=20ms",
    "compression.pressure_low=5kPa",
];

/// Oracle: the record of the uninterrupted case, to the last bit.
#[test]
fn every_kind_of_case_can_be_resumed_with_the_same_bits() {
    let plan = plan(&SMALL);
    let mut records = Vec::new();
    let cases = ["mono_friction_0", "mono_friction_1", "poly_smooth", "confined", "moduli"];
    for (which, case) in cases.into_iter().enumerate() {
        let mut run = plan.start(case).unwrap();
        let mut saved = Vec::new();
        let mut n_slices = 0;
        while !run.advance().unwrap().is_done {
            n_slices += 1;
            // During growth, and later in other phases.
            if n_slices % 16 == 2 {
                saved.push(run.save());
            }
        }
        let expected = run.record();
        assert!(saved.len() > 1, "{case}: {n_slices} slices");
        for bytes in [&saved[0], &saved[saved.len() - 1]] {
            let mut run = plan.start(case).unwrap();
            run.resume(bytes).unwrap();
            while !run.advance().unwrap().is_done {}
            assert_eq!(run.record(), expected, "{case}");
        }
        let mut other = plan.start(cases[(which + 1) % cases.len()]).unwrap();
        assert!(other.resume(&saved[0]).is_err(), "of another case");
        assert!(other.resume(b"nothing").is_err(), "damaged");
        records.push(expected);
    }
    let findings = plan.evaluate(&records[..cases.len() - 1]);
    assert!(findings.notes.iter().any(|it| it.contains("no record of moduli")), "{findings:?}");
    assert!(findings.rows.iter().any(|it| it.id == "U22.stress"));
    let moduli = &records[cases.len() - 1];
    for name in ["bulk_modulus", "shear_modulus"] {
        let values = moduli.table_column("moduli", name).unwrap();
        assert!(values.len() == 2 && values.iter().all(|it| 0.0 < *it), "{name}: {values:?}");
    }
}
