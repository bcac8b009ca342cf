//! A prepared grip: its model, and the setpoints of object and pump at any time.

use super::{
    cases::{Case, Change, Grip},
    phase::{Phase, Stroke, staircase},
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

/// Distance below its start to which the object is withdrawn if it is not released before (m).
const BEYOND_START: Real = 0.02;

/// A prepared grip.
pub(super) struct PreparedGrip {
    pub(super) scene: GripperScene,
    model: Model,
    pub(super) change: Change,
    pub(super) is_inserted: bool,
    /// True if it may end before the object is free.
    pub(super) is_cut: bool,
    /// Number of substeps in a tick.
    pub(super) n_substeps: usize,
    /// Length of a tick (s).
    pub(super) tick: Real,
}

impl PreparedGrip {
    /// Prepares a grip. The first grip of a case with several pressures continues until the object is
    /// free: it shows the complete record.
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

    /// The system of this grip, starting from `state`.
    pub(super) fn system(&self, mut state: State) -> System {
        // The membrane was filled without any body.
        state.springs.bodies.resize(self.model.n_samples(), Vec3::zeros());
        let object = BodyMotion { pose: Pose::identity(), twist: Twist::zero() };
        let controls =
            Controls { gauge_setpoint: 0.0, walls: state.walls.clone(), bodies: vec![object] };
        System::new(self.model.clone(), controls, state)
    }

    fn insertion(&self) -> Stroke {
        let protocol = &self.scene.protocol;
        let speed = protocol.insert_speed * self.scene.accelerations.insert_speed_factor;
        let length = protocol.clearance + protocol.penetration;
        Stroke { length, speed, ramp: protocol.ramp_time }
    }

    fn withdrawal(&self) -> Stroke {
        let protocol = &self.scene.protocol;
        let speed = protocol.withdraw_speed * self.scene.accelerations.withdraw_speed_factor;
        let length = protocol.penetration + BEYOND_START;
        Stroke { length, speed, ramp: protocol.ramp_time }
    }

    /// Maximum duration of a phase (s).
    pub(super) fn duration(&self, phase: Phase) -> Real {
        let protocol = &self.scene.protocol;
        match phase {
            Phase::Insert => self.insertion().duration(),
            Phase::Relax => protocol.relax_time,
            Phase::Evacuate => protocol.step_time * real(protocol.n_pressure_steps),
            Phase::Hold => protocol.hold_time,
            Phase::Withdraw => self.withdrawal().duration(),
        }
    }

    /// Expected number of substeps.
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

    /// Sets the motion of the object and the pump's setpoint at `time` (s) of `phase`; `low` is
    /// the height of the settled membrane's lowest point (m).
    pub(super) fn control(&self, controls: &mut Controls, phase: Phase, time: Real, low: Real) {
        let protocol = &self.scene.protocol;
        let (start, inside) = (-protocol.clearance, protocol.penetration);
        let (top, speed) = match phase {
            Phase::Insert => {
                let (distance, speed) = self.insertion().at(time);
                (start + distance, speed)
            }
            Phase::Relax | Phase::Evacuate | Phase::Hold => (inside, 0.0),
            Phase::Withdraw => {
                let (distance, speed) = self.withdrawal().at(time);
                (inside - distance, -speed)
            }
        };
        let z = low + top - self.scene.gripper.object.radius;
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
        let rate = speed / (2.0 * self.scene.gripper.object.radius);
        let density = self.scene.gripper.grains.material.density * self.model.density_scaling;
        rate * 2.0 * self.model.radius_mean * (density / pressure).sqrt()
    }
}

/// The model of a scene without the table, the number of substeps in a tick, and the tick (s).
pub(super) fn compile(scene: &GripperScene) -> Result<(Model, usize, Real), CompileError> {
    let Gripper { mut model, plan, .. } = compile::gripper(&scene.gripper.scene())?;
    model.bodies.truncate(1);
    Ok((model, plan.n_substeps, plan.tick))
}
