//! Balance of forces and momentum between grains, membrane, flange and object, also during a lift.
#![expect(clippy::print_stderr, reason = "prints measured values")]

use std::sync::OnceLock;

use jamgrip::{
    base::{Pose, Real, Vec3, parallel},
    command::Command,
    cosim::{Coupled, FLANGE, Inputs},
    measure,
    physics::{Controls, Scratch, State, System, substep},
    session::Session,
    snapshot::Parts,
};

use crate::coarse;

fn inputs(z: Real, gauge: Real) -> Inputs {
    Inputs {
        gauge_setpoint: gauge,
        flange_target: Pose::translation(0.0, 0.0, z),
        drives: vec![None],
    }
}

/// A gripper pushed onto the object with a vacuum, while the flange still moves.
fn pushing() -> Coupled {
    pushing_with(1.0)
}

/// The same with density scaling.
fn pushing_with(scaling: Real) -> Coupled {
    let scaling = format!("time.density_scaling={scaling}");
    let mut coupled = coarse::coupled_of(coarse::compiled(1, &[&scaling]));
    parallel::lead(&parallel::ThreadPool::new(1).unwrap(), || {
        for tick in 0..90 {
            coupled.advance(&inputs(0.08, if tick < 50 { 0.0 } else { -30e3 }));
        }
    });
    coupled
}

/// Momentum, and angular momentum about the origin, of grains and membrane.
fn momenta(coupled: &Coupled) -> (Vec3, Vec3) {
    let System { model, state, .. } = &coupled.system;
    let (mut linear, mut angular) = (Vec3::zeros(), Vec3::zeros());
    let mut add = |mass: Real, position: &Vec3, velocity: &Vec3| {
        linear += velocity * mass;
        angular += position.cross(velocity) * mass;
    };
    let grains = &state.grains;
    for i in 0..grains.len() {
        add(grains.masses[i], &grains.positions[i], &grains.velocities[i]);
    }
    for v in 0..state.membrane.positions.len() {
        let membrane = &state.membrane;
        add(model.membrane.masses[v], &membrane.positions[v], &membrane.velocities[v]);
    }
    for i in 0..grains.len() {
        angular +=
            grains.angular_velocities[i] * (0.4 * grains.masses[i] * grains.radii[i].powi(2));
    }
    (linear, angular)
}

/// The controls of the last substep: all motions continue.
fn held_controls(coupled: &Coupled) -> Controls {
    let mut bodies = vec![coupled.world.motion(0)];
    bodies.push(jamgrip::physics::boundary::body::BodyMotion {
        pose: coupled.system.model.table,
        twist: jamgrip::base::real::Twist::zero(),
    });
    Controls {
        gauge_setpoint: coupled.system.state.gauge,
        walls: coupled.system.state.walls.clone(),
        bodies,
    }
}

#[test]
fn forces_on_membrane_and_object_are_opposite() {
    let coupled = pushing();
    let Scratch { sample_forces, body_wrenches, vertex_forces, patch_forces, .. } =
        &coupled.system.scratch;
    let n_samples = coupled.system.model.n_samples();
    let controls = held_controls(&coupled);
    let mut on_membrane = Vec3::zeros();
    for (body, of_body) in sample_forces.chunks(n_samples).enumerate() {
        let center = controls.bodies[body].pose.translation.vector;
        let (mut force, mut torque, mut size) = (Vec3::zeros(), Vec3::zeros(), 0.0);
        for sample in of_body.iter().filter(|sample| sample.flags.touches()) {
            force += sample.force;
            torque += (sample.point - center).cross(&sample.force);
            size += sample.force.norm();
        }
        on_membrane += force;
        if body == 0 {
            assert!(size > 1.0, "the object is pushed with {size} N");
        }
        // Oracle: Newton's third law. Tolerance: rounding, of the sum of magnitudes; the lever arms
        // are below 0.1 m. The object has moved by one rigid-body step since, at most 10 µm.
        assert!((force + body_wrenches[body].force).norm() <= 1e-12 * size);
        let off = (torque + body_wrenches[body].torque).norm();
        assert!(off <= 1e-9 * size + 1e-5 * size, "torques differ by {off} N m");
    }
    // The forces on all vertices are those of bodies and grains.
    let (mut on_grains, mut size) = (Vec3::zeros(), 0.0);
    for patches in patch_forces {
        for contact in &patches.contacts[..patches.n] {
            on_grains += contact.force;
            size += contact.force.norm();
        }
    }
    let on_vertices: Vec3 = vertex_forces.iter().sum();
    let off = (on_vertices + on_grains - on_membrane).norm() / size;
    eprintln!("vertices: {off:e}");
    assert!(off < 1e-12, "{off:e}");
}

#[test]
fn momentum_changes_by_the_forces_of_flange_objects_and_gravity() {
    check_momentum(1.0);
}

/// Grains and membrane have 16 times their inertia, but the flange accelerates the real mass.
#[test]
fn a_flange_accelerates_the_real_mass_with_density_scaling() {
    check_momentum(16.0);
}

fn check_momentum(scaling: Real) {
    let mut coupled = pushing_with(scaling);
    let mass = measure::mass(&coupled.system.model, &coupled.system.state);
    let tick = coupled.plan.tick;
    let (mut worst, mut scale) = (0.0_f64, 0.0_f64);
    parallel::lead(&parallel::ThreadPool::new(1).unwrap(), || {
        for k in 0..40 {
            let (before, _) = momenta(&coupled);
            let carried_before = coupled.system.state.walls[FLANGE].twist.linear;
            let means = coupled.advance(&inputs(if k < 15 { 0.08 } else { 0.1 }, -50e3));
            let (after, _) = momenta(&coupled);
            let accelerated = coupled.system.state.walls[FLANGE].twist.linear - carried_before;
            assert!(
                coupled.system.scratch.body_wrenches[1].force == Vec3::zeros(),
                "no contact with the table"
            );
            let applied = means.objects_on_gripper.force - means.gripper_on_mount.force
                + coupled.system.model.gravity * mass;
            // With density scaling, a part of the acceleration comes with the moving frame of the flange.
            let carried = accelerated * mass * (1.0 - 1.0 / scaling);
            let gained = (after - before - carried) / tick;
            worst = worst.max((gained - applied).norm());
            scale = scale.max(gained.norm());
        }
    });
    eprintln!("momentum: {worst:e} N of {scale} N");
    // Oracle: Newton's second law for the whole gripper. Tolerance 1e-9: rounding of sums of
    // thousands of forces, some of which are a hundred times the total.
    assert!(worst < 1e-9 * scale, "{worst:e} N of {scale} N missing");
}

#[test]
fn angular_momentum_changes_by_the_forces_of_flange_objects_and_gravity() {
    let mut coupled = pushing();
    let mut controls = held_controls(&coupled);
    let dt = coupled.system.model.substep;
    let (mut worst, mut scale) = (0.0_f64, 0.0_f64);
    parallel::lead(&parallel::ThreadPool::new(1).unwrap(), || {
        for _ in 0..40 {
            let (_, before) = momenta(&coupled);
            let weight = moment_of_weight(&coupled);
            controls.walls[FLANGE].advance(dt);
            let old_flange = coupled.system.state.walls[FLANGE].pose.translation.vector;
            let System { model, state, scratch, .. } = &mut coupled.system;
            substep(model, &controls, state, scratch);
            let mut applied = weight - about_origin(&scratch.wall_wrenches[FLANGE], &old_flange);
            for (wrench, body) in scratch.body_wrenches.iter().zip(&controls.bodies) {
                applied -= about_origin(wrench, &body.pose.translation.vector);
            }
            let (_, after) = momenta(&coupled);
            worst = worst.max(((after - before) / dt - applied).norm());
            scale = scale.max(spin_torque(&coupled.system.state, &coupled.system.scratch));
        }
    });
    eprintln!("angular momentum: {worst:e} N m, torques on grains {scale} N m");
    // Oracle: internal forces exert no net torque. Tolerance 1e-9 of the torques of membrane contacts on
    // grains: rounding.
    assert!(worst < 1e-9 * scale, "{worst:e} of {scale} N m unexplained");
}

fn about_origin(wrench: &jamgrip::base::real::Wrench, point: &Vec3) -> Vec3 {
    wrench.torque + point.cross(&wrench.force)
}

fn moment_of_weight(coupled: &Coupled) -> Vec3 {
    let System { model, state, .. } = &coupled.system;
    let of_grains: Vec3 =
        state.grains.positions.iter().zip(&state.grains.masses).map(|(r, m)| r * *m).sum();
    let of_membrane: Vec3 =
        state.membrane.positions.iter().zip(&model.membrane.masses).map(|(r, m)| r * *m).sum();
    (of_grains + of_membrane).cross(&model.gravity)
}

/// Sum of the magnitudes of the membrane's torques on grains [N m].
fn spin_torque(state: &State, scratch: &Scratch) -> Real {
    assert_eq!(state.grains.len(), scratch.patch_forces.len());
    scratch.patch_forces.iter().filter(|p| p.n > 0).map(|p| p.torque.norm()).sum()
}

#[test]
fn the_mount_carries_the_weight_of_a_gripper_at_rest() {
    let mut session = coarse::session(1, &[]);
    let n_ticks = 100;
    let mut sum = Vec3::zeros();
    for _ in 0..n_ticks {
        session.tick(&[]).unwrap();
        sum += session.means().gripper_on_mount.force;
    }
    let mean = sum / f64::from(n_ticks);
    let weight = session.coupled().system.model.gravity
        * measure::mass(&session.coupled().system.model, &session.coupled().system.state);
    let error = (mean - weight).norm() / weight.norm();
    eprintln!("mount at rest: error {:e} of the weight", error);
    // Oracle: statics. Tolerance 0.5 %: the requirement for the wrench topics.
    assert!(error < 5e-3, "mount {mean:?}, weight {weight:?}");
}

/// Results while the object hangs at rest.
struct Hanging {
    /// Mean force of the object on the gripper, flange axes [N].
    contact: Vec3,
    /// Mean force of all contacts on the object, world axes [N].
    on_object: Vec3,
    /// Mean force of the gripper on its mount, flange axes [N].
    mount: Vec3,
    /// Weight of the object [N].
    weight: Real,
    /// Mean force of the object's residual swing, from its velocities [N].
    swing: Vec3,
    /// Weight of grains and membrane [N].
    own_weight: Real,
    /// Kinetic energy of grains and membrane at the end [J].
    energy: Real,
    /// Height by which the object was lifted [m].
    lifted: Real,
    /// Largest penetration of the object into the table during the push [m].
    sunk: Real,
}

fn hanging() -> &'static Hanging {
    static HANGING: OnceLock<Hanging> = OnceLock::new();
    HANGING.get_or_init(|| lift(&mut coarse::session(1, &[])))
}

/// Pushes, evacuates, lifts by 15 mm, waits, and measures.
fn lift(session: &mut Session) -> Hanging {
    let height = |session: &Session| session.coupled().world.motion(0).pose.translation.z;
    let mut lowest = height(session);
    for tick in 0..1000_u32 {
        let command = match tick {
            0 => Some(coarse::flange_to(0.066)),
            160 => Some(Command::Vacuum { gauge_pa: -80e3 }),
            // At 50 mm/s, so that the object does not swing for long.
            321..=620 => Some(coarse::flange_to(0.066 + 5e-5 * f64::from(tick - 320))),
            _ => None,
        };
        session.tick(command.as_slice()).unwrap();
        lowest = lowest.min(height(session));
    }
    let n_ticks = 300;
    let velocity = |session: &Session| session.coupled().world.motion(0).twist.linear;
    let before = velocity(session);
    let (mut contact, mut on_object, mut mount) = (Vec3::zeros(), Vec3::zeros(), Vec3::zeros());
    for _ in 0..n_ticks {
        session.tick(&[]).unwrap();
        let snapshot = session.snapshot(Parts::default());
        contact += snapshot.contact_wrench.force / f64::from(n_ticks);
        on_object += snapshot.objects[0].contact_wrench.force / f64::from(n_ticks);
        mount += snapshot.mount_wrench.force / f64::from(n_ticks);
    }
    let coupled = session.coupled();
    let g = -coupled.system.model.gravity.z;
    let gained = velocity(session) - before;
    Hanging {
        contact,
        on_object,
        mount,
        weight: coupled.world.mass(0) * g,
        swing: gained * (coupled.world.mass(0) / (f64::from(n_ticks) * coupled.plan.tick)),
        own_weight: measure::mass(&coupled.system.model, &coupled.system.state) * g,
        energy: measure::kinetic_energy(&coupled.system.model, &coupled.system.state),
        lifted: height(session) - 0.025,
        sunk: 0.025 - lowest,
    }
}

#[test]
fn wrenches_of_a_hanging_object_are_its_weight() {
    let Hanging { contact, on_object, mount, weight, swing, own_weight, lifted, .. } = hanging();
    eprintln!(
        "lifted {lifted}, contact {}, object {}, mount {}, weights {weight} {own_weight}",
        contact.z / weight,
        on_object.z / weight,
        (mount.z + own_weight) / weight
    );
    assert!(*lifted > 0.01, "lifted by {lifted} m");
    // Oracle: Newton's second law. Sign: force of the object on the gripper, so −m g. The object swings
    // like a pendulum with little damping, so its mean acceleration is part of the balance. Tolerance
    // 0.5 %: the requirement for the wrench topics.
    let up = Vec3::z() * *weight;
    for (what, error) in [
        ("contact", contact + up + swing),
        ("object", on_object - up - swing),
        ("mount", mount + up + swing + Vec3::z() * *own_weight),
    ] {
        eprintln!("{what}: error {:e} of the weight", error.norm() / weight);
        assert!(error.norm() < 5e-3 * weight, "{what}: error {error:?} N");
    }
}

#[test]
fn the_object_does_not_sink_into_the_table() {
    // Oracle: a rigid table. Tolerance 0.2 mm: twice the slop of 0.1 mm that rapier allows.
    let sunk = hanging().sunk;
    eprintln!("sunk {sunk:e} m");
    assert!(sunk < 2e-4, "the object sank into the table by {sunk} m");
}

#[test]
fn a_jammed_gripper_comes_to_rest() {
    // Oracle: no energy is supplied. Bound: a single vertex of 19 mg that oscillates at 0.5 m/s has
    // 2e-6 J; grains at rest have far less.
    let energy = hanging().energy;
    eprintln!("energy at rest {energy:e} J");
    assert!(energy < 2e-6, "kinetic energy {energy:e} J");
}
