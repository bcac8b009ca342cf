//! A grip ready to run: its model, and where object and pump are at any time.

use super::{
    cases::{Case, Change, Grip},
    phase::{Phase, Way, staircase},
    scene::GripperScene,
};
use crate::{
    base::{
        Pose, Real, Vec3,
        real::{Twist, real},
    },
    cosim::compile::{self, CompileError, Gripper},
    physics::{Controls, Model, State, System, boundary::body::BodyMotion},
};

/// How far the object goes down beyond its starting point if the bag does not let go of it (m).
const WAY_OUT_BEYOND: Real = 0.02;

/// A grip ready to run.
pub(super) struct Ready {
    pub(super) scene: GripperScene,
    model: Model,
    pub(super) change: Change,
    pub(super) is_inserted: bool,
    /// True if it may end before the object is free.
    pub(super) is_cut: bool,
    /// Substeps in a tick.
    pub(super) n_substeps: usize,
    /// Length of a tick (s).
    pub(super) tick: Real,
}

impl Ready {
    /// The first grip of the case of several pressures goes on until the object is free: it shows
    /// the whole record.
    pub(super) fn new(
        scene: &GripperScene,
        grip: &Grip,
        case: &Case,
    ) -> Result<Self, CompileError> {
        let is_cut = grip.is_inserted || !case.grips.iter().any(|it| it.is_inserted);
        let scene = grip.change.apply(scene);
        let (model, n_substeps, tick) = compile(&scene)?;
        let (change, is_inserted) = (grip.change, grip.is_inserted);
        Ok(Self { scene, model, change, is_inserted, is_cut, n_substeps, tick })
    }

    /// The system of this grip, beginning with `state`.
    pub(super) fn system(&self, mut state: State) -> System {
        // The bag was filled without any body.
        state.springs.bodies.resize(self.model.n_samples(), Vec3::zeros());
        let object = BodyMotion { pose: Pose::identity(), twist: Twist::zero() };
        let controls =
            Controls { gauge_setpoint: 0.0, walls: state.walls.clone(), bodies: vec![object] };
        System::new(self.model.clone(), controls, state)
    }

    fn way_in(&self) -> Way {
        let protocol = &self.scene.protocol;
        let speed = protocol.insert_speed * self.scene.accelerations.insert_speed_factor;
        let length = protocol.clearance + protocol.penetration;
        Way { length, speed, ramp: protocol.ramp_time }
    }

    fn way_out(&self) -> Way {
        let protocol = &self.scene.protocol;
        let speed = protocol.withdraw_speed * self.scene.accelerations.withdraw_speed_factor;
        let length = protocol.penetration + WAY_OUT_BEYOND;
        Way { length, speed, ramp: protocol.ramp_time }
    }

    /// How long a phase takes at most (s).
    pub(super) fn duration(&self, phase: Phase) -> Real {
        let protocol = &self.scene.protocol;
        match phase {
            Phase::Insert => self.way_in().duration(),
            Phase::Relax => protocol.relax_time,
            Phase::Evacuate => protocol.step_time * real(protocol.n_pressure_steps),
            Phase::Hold => protocol.hold_time,
            Phase::Withdraw => self.way_out().duration(),
        }
    }

    pub(super) fn n_substeps_expected(&self) -> usize {
        let first = if self.is_inserted { Phase::Evacuate } else { Phase::Insert };
        let n_ticks = |phase| {
            let ticks = self.duration(phase) / self.tick;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a positive number of ticks far below 2^53"
            )]
            let ticks = ticks.ceil() as usize;
            ticks
        };
        let phases = Phase::ALL.iter().filter(|it| first <= **it);
        phases.map(|&phase| n_ticks(phase) * self.n_substeps).sum()
    }

    /// Where the object and the pump's set-point are at `time` (s) of `phase`; `low` is the height
    /// of the settled bag's lowest point (m).
    pub(super) fn control(&self, controls: &mut Controls, phase: Phase, time: Real, low: Real) {
        let protocol = &self.scene.protocol;
        let (start, inside) = (-protocol.clearance, protocol.penetration);
        let (top, speed) = match phase {
            Phase::Insert => {
                let (way, speed) = self.way_in().at(time);
                (start + way, speed)
            }
            Phase::Relax | Phase::Evacuate | Phase::Hold => (inside, 0.0),
            Phase::Withdraw => {
                let (way, speed) = self.way_out().at(time);
                (inside - way, -speed)
            }
        };
        let z = low + top - self.scene.object_radius();
        controls.bodies[0].pose.translation.vector = Vec3::new(0.0, 0.0, z);
        controls.bodies[0].twist.linear = Vec3::new(0.0, 0.0, speed);
        let steps = protocol.n_pressure_steps;
        controls.gauge_setpoint = match phase {
            Phase::Insert | Phase::Relax => 0.0,
            Phase::Evacuate => staircase(protocol.pressure, steps, protocol.step_time, time),
            Phase::Hold | Phase::Withdraw => protocol.pressure,
        };
    }

    /// I = γ̇ d √(ρ/p): the object's speed shears the grains over its diameter.
    pub(super) fn inertial_number(&self, speed: Real, pressure: Real) -> Real {
        let rate = speed / (2.0 * self.scene.object_radius());
        let density = self.scene.gripper.grains.material.density * self.model.density_scaling;
        rate * 2.0 * self.model.radius_mean * (density / pressure).sqrt()
    }
}

/// The model of a scene, without the table, the substeps in a tick, and the tick (s).
pub(super) fn compile(scene: &GripperScene) -> Result<(Model, usize, Real), CompileError> {
    let Gripper { mut model, plan, .. } = compile::gripper(&scene.gripper)?;
    model.bodies.truncate(1);
    Ok((model, plan.n_substeps, plan.tick))
}
