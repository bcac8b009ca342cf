//! One tick of the coupled system: body motion in, substeps, wrenches out, rigid-body step.
//!
//! Grains and membrane take many substeps per tick. Every few of them (an exchange, at most
//! 0.1 ms) the rigid world takes one step under the membrane's mean wrench; in between, bodies
//! keep their velocity. A staggered exchange once per tick would be unstable: a light body between
//! stiff contacts oscillates faster than 1 kHz.

mod change; // discontinuous changes between ticks
pub mod compile;
pub mod flange;
pub mod rapier_world;
pub mod change_error; // why a change is rejected
pub mod saved_state;
pub mod volume; // overlap of simple volumes

use crate::{
    base::{
        Pose, Real, Vec3,
        real::{Twist, Wrench, real},
    },
    physics::{
        Controls, Model, State, System,
        boundary::{body::BodyMotion, wall::CARRIER},
    },
};
use flange::Limits;
use rapier_world::RapierWorld;

/// The wall that is the gripper's flange.
pub const FLANGE: usize = CARRIER;

/// How a tick is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Length of a tick (s).
    pub tick: Real,
    /// Substeps in a tick, a multiple of `n_per_exchange`.
    pub n_substeps: usize,
    /// Substeps between two steps of the rigid world.
    pub n_per_exchange: usize,
}

/// Setpoints during a tick.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Gauge pressure setpoint of the chamber (Pa).
    pub gauge_setpoint: Real,
    /// Target pose of the flange.
    pub flange_target: Pose,
    /// Target pose of each driven object.
    pub drives: Vec<Option<Pose>>,
}

/// Wrenches averaged over a tick, in world axes.
#[derive(Clone, Debug)]
pub struct Means {
    /// Wrench of the membrane on each object about its center of mass.
    pub membrane_on_objects: Vec<Wrench>,
    /// Wrench of all contacts on each object about its center of mass, computed from its change of
    /// momentum; for a driven object only that of the membrane, because the drive sets its momentum.
    pub contacts_on_objects: Vec<Wrench>,
    /// Wrench of all objects on the gripper about the flange's origin.
    pub objects_on_gripper: Wrench,
    /// Wrench of the whole gripper on its mount about the flange's origin.
    pub gripper_on_mount: Wrench,
}

/// Grains, membrane and chamber coupled with the rigid-body world.
pub struct Coupled {
    /// Grains, membrane and chamber.
    pub system: System,
    /// How a tick is divided.
    pub plan: Plan,
    /// Objects and table.
    pub world: RapierWorld,
    limits: Limits,
    n_objects: usize,
}

impl Coupled {
    /// Couples a settled state with the rigid-body world. The last body of `model` is the table; the
    /// motion of the flange is `WallMotion::External`.
    pub fn new(model: Model, plan: Plan, state: State, world: RapierWorld, limits: Limits) -> Self {
        let controls = controls(&model, &state, &world);
        let n_objects = model.bodies.len() - 1;
        Self { system: System::new(model, controls, state), plan, world, limits, n_objects }
    }

    /// Continues from another state and another rigid-body world of the same model.
    fn restart(&mut self, state: State, world: RapierWorld) {
        self.system.restart(state);
        self.world = world;
        self.rebuild_scratch();
    }

    /// Number of objects.
    pub fn n_objects(&self) -> usize {
        self.n_objects
    }

    /// Advances everything by one tick.
    pub fn advance(&mut self, inputs: &Inputs) -> Means {
        let n = self.plan.n_substeps;
        let flange = self.system.state.walls[FLANGE];
        let twist_end = self.limits.follow(&inputs.flange_target, &flange, self.plan.tick);
        self.drive_objects(inputs);
        self.system.controls.gauge_setpoint = inputs.gauge_setpoint;
        let before: Vec<_> = (0..self.n_objects).map(|i| self.world.momentum(i)).collect();
        let mut sums = Sums::new(self.n_objects);
        let mut exchange = vec![Wrench::zero(); self.n_objects];
        for s in 0..n {
            self.set_flange_twist(&flange.twist, &twist_end, s);
            self.system.step();
            self.add_wrenches(&mut sums, &mut exchange);
            for body in &mut self.system.controls.bodies[..self.n_objects] {
                body.advance(self.system.model.substep);
            }
            if (s + 1).is_multiple_of(self.plan.n_per_exchange) {
                self.exchange(&mut exchange);
            }
        }
        self.means(&sums, &before, inputs)
    }

    fn drive_objects(&mut self, inputs: &Inputs) {
        for (i, target) in inputs.drives.iter().enumerate() {
            let twist = target
                .as_ref()
                .map(|target| self.limits.follow(target, &self.world.motion(i), self.plan.tick));
            self.world.drive(i, twist.as_ref());
        }
        for i in 0..self.n_objects {
            self.system.controls.bodies[i] = self.world.motion(i);
        }
    }

    /// Interpolates the velocity of the flange linearly between the start and the end of the tick.
    fn set_flange_twist(&mut self, start: &Twist, end: &Twist, s: usize) {
        let share = real(s + 1) / real(self.plan.n_substeps);
        let twist = Twist {
            linear: start.linear + (end.linear - start.linear) * share,
            angular: start.angular + (end.angular - start.angular) * share,
        };
        self.system.controls.walls[FLANGE].twist = twist;
    }

    fn add_wrenches(&self, sums: &mut Sums, exchange: &mut [Wrench]) {
        let origin = self.system.state.walls[FLANGE].pose.translation.vector;
        for i in 0..self.n_objects {
            let wrench = &self.system.scratch.body_wrenches[i];
            let center = self.system.controls.bodies[i].pose.translation.vector;
            add(&mut exchange[i], wrench);
            add(&mut sums.on_objects[i], wrench);
            sums.on_gripper.force -= wrench.force;
            sums.on_gripper.torque -= wrench.torque + (center - origin).cross(&wrench.force);
        }
        add(&mut sums.on_mount, &self.system.scratch.wall_wrenches[FLANGE]);
    }

    /// One step of the rigid-body world under the mean of the summed wrenches.
    fn exchange(&mut self, sums: &mut [Wrench]) {
        for sum in sums.iter_mut() {
            *sum = scaled(sum, 1.0 / real(self.plan.n_per_exchange));
        }
        self.world.step(sums);
        sums.fill(Wrench::zero());
        for i in 0..self.n_objects {
            self.system.controls.bodies[i] = self.world.motion(i);
        }
    }

    fn means(&self, sums: &Sums, before: &[(Vec3, Vec3)], inputs: &Inputs) -> Means {
        let share = 1.0 / real(self.plan.n_substeps);
        let contacts = before.iter().enumerate().map(|(i, (momentum, spin))| {
            if inputs.drives[i].is_some() {
                return scaled(&sums.on_objects[i], share);
            }
            let (momentum_now, spin_now) = self.world.momentum(i);
            let gravity = self.system.model.gravity * self.system.model.density_scaling;
            let weight = gravity * self.world.mass(i);
            Wrench {
                force: (momentum_now - momentum) / self.plan.tick - weight,
                torque: (spin_now - spin) / self.plan.tick,
            }
        });
        Means {
            membrane_on_objects: sums.on_objects.iter().map(|w| scaled(w, share)).collect(),
            contacts_on_objects: contacts.collect(),
            objects_on_gripper: scaled(&sums.on_gripper, share),
            gripper_on_mount: scaled(&sums.on_mount, share),
        }
    }
}

fn controls(model: &Model, state: &State, world: &RapierWorld) -> Controls {
    let n_objects = model.bodies.len() - 1;
    let table = BodyMotion { pose: model.table, twist: Twist::zero() };
    let mut bodies: Vec<BodyMotion> = (0..n_objects).map(|i| world.motion(i)).collect();
    bodies.push(table);
    Controls { gauge_setpoint: state.gauge, walls: state.walls.clone(), bodies }
}

struct Sums {
    on_objects: Vec<Wrench>,
    on_gripper: Wrench,
    on_mount: Wrench,
}

impl Sums {
    fn new(n_objects: usize) -> Self {
        Self {
            on_objects: vec![Wrench::zero(); n_objects],
            on_gripper: Wrench::zero(),
            on_mount: Wrench::zero(),
        }
    }
}

fn add(sum: &mut Wrench, wrench: &Wrench) {
    sum.force += wrench.force;
    sum.torque += wrench.torque;
}

fn scaled(wrench: &Wrench, share: Real) -> Wrench {
    Wrench { force: wrench.force * share, torque: wrench.torque * share }
}
