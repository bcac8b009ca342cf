//! A minimal plant for tests of the controller: an elastic gripper, an object on a table, and a grip
//! that holds under vacuum.

use super::Observation;
use crate::{
    base::{Pose, Real, Vec3},
    command::Command,
};

const TICK: Real = 0.001;
const GRIPPER_LENGTH: Real = 0.04;
const OBJECT_HEIGHT: Real = 0.07;
const STIFFNESS: Real = 500.0;
const WEIGHT: Real = 2.5;
const LAG: Real = 0.05;

/// State of the plant.
pub(super) struct MockPlant {
    n_ticks: u32,
    flange: Vec3,
    object: Vec3,
    gauge: Real,
    gauge_setpoint: Real,
    force: Real,
    /// Height of the flange above the object while it is gripped (m).
    grip: Option<Real>,
    /// Speed at which a gripped object slips down (m/s).
    pub(super) slip: Real,
    /// Vacuum below which the grip holds (Pa).
    pub(super) gauge_holding: Real,
    /// Greatest height of the object above its start (m).
    pub(super) lifted_max: Real,
    /// Greatest change of the flange setpoint in a tick (m).
    pub(super) step_max: Real,
    /// Greatest push force (N).
    pub(super) push_max: Real,
}

impl MockPlant {
    pub(super) fn new(flange: Vec3) -> Self {
        Self {
            n_ticks: 0,
            flange,
            object: Vec3::new(0.01, -0.02, OBJECT_HEIGHT / 2.0),
            gauge: 0.0,
            gauge_setpoint: 0.0,
            force: 0.0,
            grip: None,
            slip: 0.0,
            gauge_holding: -50e3,
            lifted_max: 0.0,
            step_max: 0.0,
            push_max: 0.0,
        }
    }

    pub(super) fn observe(&self) -> Observation {
        Observation {
            time_s: Real::from(self.n_ticks) * TICK,
            flange_pose: Pose::from(self.flange),
            contact_force: Vec3::new(0.0, 0.0, self.force),
            gauge_pa: self.gauge,
            object_pose: Pose::from(self.object),
        }
    }

    /// Height of the object over its place (m).
    pub(super) fn lifted(&self) -> Real {
        self.object.z - OBJECT_HEIGHT / 2.0
    }

    pub(super) fn tick(&mut self, commands: &[Command]) {
        for command in commands {
            match command {
                Command::Vacuum { gauge_pa } => self.gauge_setpoint = *gauge_pa,
                Command::FlangePose(pose) => {
                    let goal = Vec3::from(pose.position);
                    self.step_max = self.step_max.max((goal - self.flange).norm());
                    self.flange = goal;
                }
                _ => panic!("the controller moves the flange and the pump only"),
            }
        }
        self.gauge += (self.gauge_setpoint - self.gauge) * TICK / LAG;
        self.n_ticks += 1;
        let overlap = self.object.z + OBJECT_HEIGHT / 2.0 - (self.flange.z - GRIPPER_LENGTH);
        let is_above = (self.flange - self.object).xy().norm() < 1e-3;
        let holds = self.gauge < self.gauge_holding && is_above;
        self.grip = match self.grip {
            Some(grip) if holds => Some(grip + self.slip * TICK),
            None if holds && 0.01 < overlap => Some(self.flange.z - self.object.z),
            _ => None,
        };
        self.force = match self.grip {
            Some(grip) => {
                let hanging = self.flange.z - grip;
                self.object.z = hanging.max(OBJECT_HEIGHT / 2.0);
                let pressed = self.object.z - hanging;
                if 0.0 < pressed { STIFFNESS * pressed } else { -WEIGHT }
            }
            None => {
                self.object.z = OBJECT_HEIGHT / 2.0;
                if is_above { STIFFNESS * overlap.max(0.0) } else { 0.0 }
            }
        };
        self.lifted_max = self.lifted_max.max(self.lifted());
        self.push_max = self.push_max.max(self.force);
    }
}
