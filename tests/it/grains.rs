//! One, two and three grains against rigid-body mechanics and Hertz.
#![expect(clippy::print_stderr, reason = "prints measured values")]

use std::f64::consts::PI;

use jamgrip::{
    base::{Real, Vec3, parallel},
    physics::law::Surface,
    scene::Material,
};

use crate::rig::{G, GRAIN, Rig, elastic, hertz_constant};

const RADIUS: Real = 2e-3;

/// Runs `test` on one thread, which is fastest for so few grains.
fn on_one_thread(test: impl FnOnce() + Send) {
    parallel::lead(&parallel::ThreadPool::new(1).unwrap(), test);
}

/// Overlap (m) at which the plate carries a grain's weight: Hertz, ξ = (m g / k)^(2/3).
fn resting_overlap(rig: &Rig) -> Real {
    let weight = rig.state.grains.masses[0] * G;
    (weight / hertz_constant(&rig.model.walls[0].law, RADIUS)).powf(2.0 / 3.0)
}

/// One grain in equilibrium on the plate, `tilt` (rad) about y.
fn resting(surface: Surface, tilt: Real) -> Rig {
    let mut rig = Rig::on_plate(&GRAIN, surface, 1e-5);
    rig.model.gravity = Vec3::new(tilt.sin(), 0.0, -tilt.cos()) * G;
    rig.add_grain(Vec3::zeros(), Vec3::zeros(), RADIUS, GRAIN.density);
    rig.state.grains.positions[0].z = RADIUS - resting_overlap(&rig) * tilt.cos().powf(2.0 / 3.0);
    rig
}

#[test]
fn a_sliding_grain_starts_to_roll() {
    on_one_thread(|| {
        let surface = Surface { friction: 0.25, dissipation_time: 5e-5, tangential_damping: 0.3 };
        let mut rig = resting(surface, 0.0);
        let v0 = 0.1;
        rig.state.grains.velocities[0].x = v0;
        let rolling_at = 2.0 * v0 / (7.0 * 0.25 * G);
        let mut time = 0.0;
        while time < 2.0 * rolling_at {
            rig.step();
            time += rig.model.substep;
            let (v, spin) =
                (rig.state.grains.velocities[0].x, rig.state.grains.angular_velocities[0].y);
            if (0.1..0.95).contains(&(time / rolling_at)) {
                // Oracle: v = v0 − μ g t, ω = 5/2 μ g t / R. Tolerance 0.2 %: the lever arm is
                // R − ξ/2 with ξ/R = 0.1 %, and the spring needs the first 0.1 ms to stretch.
                assert!((v / (v0 - 0.25 * G * time) - 1.0).abs() < 2e-3, "v {v} at {time}");
                let expected = 2.5 * 0.25 * G * time / RADIUS;
                assert!(spin > 0.0, "rolls forward");
                if time > 0.5 * rolling_at {
                    assert!((spin / expected - 1.0).abs() < 1e-2, "{spin} {expected}");
                }
            }
        }
        let (v, spin) =
            (rig.state.grains.velocities[0].x, rig.state.grains.angular_velocities[0].y);
        // Oracle: angular momentum about a point of the plate, v = 5/7 v0, and ω R = v.
        // Tolerance 0.2 %: the same lever arm.
        eprintln!("rolling: v/v0·7/5 {}, ωR/v {}", v / v0 * 1.4, spin * RADIUS / v);
        assert!((v / (5.0 / 7.0 * v0) - 1.0).abs() < 2e-3, "{v}");
        assert!((spin * RADIUS / v - 1.0).abs() < 2e-3, "{spin}");
    });
}

#[test]
fn a_grain_rolls_or_slips_down_an_incline() {
    on_one_thread(|| {
        let surface = Surface { friction: 0.25, dissipation_time: 5e-5, tangential_damping: 0.3 };
        // Oracle: a = 5/7 g sin θ while tan θ < 7/2 μ = 0.875, else g (sin θ − μ cos θ).
        for (tan, slips) in [(0.4, false), (1.5, true)] {
            let tilt = Real::atan(tan);
            let mut rig = resting(surface, tilt);
            let n_steps = 4000;
            for _ in 0..n_steps {
                rig.step();
            }
            let time = 4000.0 * rig.model.substep;
            let a = rig.state.grains.velocities[0].x / time;
            let expected = if slips {
                G * (tilt.sin() - 0.25 * tilt.cos())
            } else {
                5.0 / 7.0 * G * tilt.sin()
            };
            eprintln!("incline tan {tan}: a/expected {}", a / expected);
            // Tolerance 0.3 %: lever arm R − ξ/2, and the initial stretch of the spring in 40 ms.
            assert!((a / expected - 1.0).abs() < 3e-3, "{a} instead of {expected}");
        }
    });
}

#[test]
fn the_resting_overlap_is_that_of_hertz() {
    on_one_thread(|| {
        let surface = Surface { friction: 0.25, dissipation_time: 1e-4, tangential_damping: 0.3 };
        let mut rig = resting(surface, 0.0);
        let expected = resting_overlap(&rig);
        rig.state.grains.positions[0].z = RADIUS;
        for _ in 0..40_000 {
            rig.step();
        }
        let overlap = RADIUS - rig.state.grains.positions[0].z;
        eprintln!("resting overlap / Hertz − 1 = {:e}", overlap / expected - 1.0);
        // Tolerance: R − z loses 1e-13 of the overlap; the bounce has decayed to e^−40.
        assert!((overlap / expected - 1.0).abs() < 1e-9, "{overlap:e} instead of {expected:e}");
    });
}

#[test]
fn a_grain_that_cannot_roll_sticks_below_the_friction_angle_and_does_not_creep() {
    on_one_thread(|| {
        let surface = Surface { friction: 0.25, dissipation_time: 1e-4, tangential_damping: 0.3 };
        // Position and velocity at half time and at the end.
        let slide = |share: Real, n_steps: usize| {
            let mut rig = resting(surface, Real::atan(share * 0.25));
            let mut samples = Vec::new();
            for _ in 0..2 {
                for _ in 0..n_steps / 2 {
                    rig.step();
                    rig.state.grains.angular_velocities[0] = Vec3::zeros();
                }
                let grains = &rig.state.grains;
                samples.push((grains.positions[0].x, grains.velocities[0].x));
            }
            (samples[0], samples[1])
        };
        // Oracle: Coulomb. Below the friction angle, the position after 10^5 more steps is the same to
        // rounding of positions of a millimeter, 2e-19 m per step at worst.
        let ((halfway, _), (end, _)) = slide(0.9, 200_000);
        eprintln!("creep {:e} m in 1e5 steps", end - halfway);
        assert!((end - halfway).abs() < 1e-15, "crept {:e} m", end - halfway);
        // Above it, the grain slides with a = g (sin θ − μ cos θ). Tolerance 0.1 %: the plate's reaction
        // still oscillates by this amount after the start.
        let ((_, first), (_, last)) = slide(1.2, 20_000);
        let tilt = Real::atan(0.3);
        let expected = G * (tilt.sin() - 0.25 * tilt.cos()) * 10_000.0 * 1e-5;
        let gained = last - first;
        eprintln!("slide: a/expected − 1 = {:e}", gained / expected - 1.0);
        assert!((gained / expected - 1.0).abs() < 1e-3, "{gained} instead of {expected}");
    });
}

#[test]
fn oblique_impacts_match_the_table() {
    // Oracle: independent integration of the law for ν = 0.245, μ = 0.25, A = 0, γ_t = 0 on a rigid
    // plane; (angle from the normal, e_t, −R ω'/v). Tolerance 1 % of e_t, and 1 % of the largest
    // spin, since the smallest ones are differences.
    let table = [
        (5.0, 0.7474, 0.0550),
        (10.0, 0.7121, 0.1250),
        (20.0, 0.6177, 0.3269),
        (30.0, 0.5594, 0.5507),
        (40.0, 0.5614, 0.7048),
        (50.0, 0.6051, 0.7564),
        (60.0, 0.7113, 0.6250),
        (70.0, 0.8180, 0.4275),
        (80.0, 0.9118, 0.2171),
    ];
    on_one_thread(|| {
        // Hard and slow, so that overlap and lever arm do not matter: the table is for ξ ≪ R.
        let hard = Material { youngs_modulus: 1e10, ..GRAIN };
        let speed = 0.1;
        for (angle, e_t, spin) in table {
            let theta = Real::to_radians(angle);
            let mut rig = Rig::on_plate(&hard, elastic(0.25), 1e-8);
            let velocity = Vec3::new(theta.sin(), 0.0, -theta.cos()) * speed;
            rig.add_grain(Vec3::z() * RADIUS, velocity, RADIUS, hard.density);
            let before = rig.kinetic_energy();
            while rig.state.grains.velocities[0].z < 0.0 || rig.state.grains.positions[0].z < RADIUS
            {
                rig.step();
            }
            let after = rig.kinetic_energy();
            let found = rig.state.grains.velocities[0].x / velocity.x;
            let rolled = rig.state.grains.angular_velocities[0].y * RADIUS / speed;
            eprintln!(
                "{angle}°: e_t {found:.4} ({e_t}), Rω/v {rolled:.4} ({spin}), E {:.4}",
                after / before
            );
            assert!((found / e_t - 1.0).abs() < 0.01, "{angle}°: e_t {found} instead of {e_t}");
            assert!((rolled - spin).abs() < 0.01 * 0.7564, "{angle}°: {rolled} instead of {spin}");
            // Oracle: friction only dissipates energy. Tolerance: error of 3000 steps.
            assert!(after < before * (1.0 + 1e-4), "energy grew by {:e}", after / before - 1.0);
        }
    });
}

#[test]
fn two_unequal_grains_conserve_momentum_and_angular_momentum() {
    on_one_thread(|| {
        let surface = Surface { friction: 0.25, dissipation_time: 7e-6, tangential_damping: 0.3 };
        let mut rig = Rig::on_plate(&GRAIN, surface, 1e-6);
        let high = Vec3::new(0.0, 0.0, 0.01);
        rig.add_grain(high, Vec3::new(0.5, 0.1, 0.0), 2e-3, 2000.0);
        rig.add_grain(high + Vec3::new(3.0e-3, 0.5e-3, 0.6e-3), Vec3::zeros(), 1e-3, 2000.0);
        rig.state.grains.angular_velocities[0] = Vec3::new(30.0, -60.0, 100.0);
        let (momentum, _) = rig.momenta();
        let mass: Real = rig.state.grains.masses.iter().sum();
        let about_center = |rig: &Rig| {
            let (linear, angular) = rig.momenta();
            let grains = &rig.state.grains;
            let moment =
                grains.positions[0] * grains.masses[0] + grains.positions[1] * grains.masses[1];
            angular - (moment / mass).cross(&linear)
        };
        let spin_before = about_center(&rig);
        let mut touched = 0;
        for _ in 0..3000 {
            rig.step();
            touched += usize::from(rig.scratch.pair_flags.iter().any(|it| it.touches()));
        }
        assert!(touched > 100, "the grains collide");
        assert!((rig.state.grains.velocities[1] - Vec3::zeros()).norm() > 0.1, "and separate");
        // Oracle: Newton's third law. Tolerance: rounding over the collision's steps.
        let (now, _) = rig.momenta();
        let lost = (now - momentum).norm() / momentum.norm();
        let gained = (about_center(&rig) - spin_before).norm() / spin_before.norm();
        eprintln!("momentum {lost:e}, angular momentum {gained:e}");
        assert!(lost < 1e-13, "momentum changed by {lost:e}");
        assert!(gained < 1e-12, "angular momentum changed by {gained:e}");
    });
}

#[test]
fn an_elastic_stack_conserves_energy_over_a_hundred_contacts() {
    on_one_thread(|| {
        let mut rig = Rig::on_plate(&GRAIN, elastic(0.0), 1e-6);
        rig.model.gravity = Vec3::z() * -G;
        rig.add_grain(Vec3::z() * 2.5e-3, Vec3::zeros(), RADIUS, GRAIN.density);
        rig.add_grain(Vec3::z() * 7.0e-3, Vec3::zeros(), RADIUS, GRAIN.density);
        let potential = |rig: &Rig| -> Real {
            let grains = &rig.state.grains;
            (0..2).map(|i| grains.masses[i] * G * (grains.positions[i].z - RADIUS)).sum()
        };
        let start = potential(&rig);
        let (mut n_contacts, mut touches, mut worst) = (0, false, 0.0_f64);
        while n_contacts < 100 {
            rig.step();
            let touching = rig.scratch.wall_forces.iter().any(|it| it.flags.touches())
                || rig.scratch.pair_flags.iter().any(|it| it.touches());
            n_contacts += usize::from(touching && !touches);
            if !touching && !touches {
                let energy = potential(&rig) + rig.kinetic_energy();
                worst = worst.max((energy / start - 1.0).abs());
            }
            touches = touching;
        }
        eprintln!("energy drift {worst:e}");
        // Oracle: conservation of energy. Tolerance 1e-4: the bound for this scheme at 1000 steps
        // per contact.
        assert!(worst < 1e-4, "energy changed by {worst:e}");
    });
}

#[test]
fn impact_on_the_plate_has_the_theoretical_restitution() {
    on_one_thread(|| {
        // Oracle: series of Müller & Pöschel (2011) for the law with F ≥ 0, as a rational function of
        // v* = √β v^(1/10), β = 3/2 A (k/m)^(2/5). Here for a grain on a plane: m* = m, R* = R.
        // Tolerance 0.2 %: semi-implicit Euler at about 1000 steps per contact.
        let surface = Surface { friction: 0.0, dissipation_time: 7e-6, tangential_damping: 0.3 };
        for speed in [0.1, 1.0] {
            let mut rig = Rig::on_plate(&GRAIN, surface, 1e-6);
            rig.add_grain(Vec3::z() * RADIUS, Vec3::z() * -speed, RADIUS, GRAIN.density);
            let mass = 4.0 / 3.0 * PI * RADIUS.powi(3) * GRAIN.density;
            let k = hertz_constant(&rig.model.walls[0].law, RADIUS);
            let v = (1.5 * 7e-6 * (k / mass).powf(0.4)).sqrt() * Real::powf(speed, 0.1);
            let above = 1.0 + 1.07232 * v + 0.574198 * v.powi(2) + 0.141552 * v.powi(3);
            let below = 1.0
                + 1.07232 * v
                + 1.72765 * v.powi(2)
                + 1.37842 * v.powi(3)
                + 1.19449 * v.powi(4)
                + 0.467273 * v.powi(5)
                + 0.235585 * v.powi(6);
            for _ in 0..3000 {
                rig.step();
            }
            let restitution = rig.state.grains.velocities[0].z / speed;
            eprintln!("restitution at {speed} m/s: {restitution} ({})", above / below);
            assert!((restitution / (above / below) - 1.0).abs() < 2e-3, "{restitution}");
        }
    });
}
