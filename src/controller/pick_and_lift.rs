//! Pick and lift: travel over the object, approach until contact, push in, let the grains settle,
//! evacuate, lift, hold, lower, vent, retreat.
//!
//! The controller does not use the geometry of the scene: it finds the object by its pose and by
//! contact, and puts it back where it stood, however much it slipped or sagged.

use super::path::Path;
use crate::{
    base::{Pose, Real, Vec3},
    command::{Command, PoseCommand},
    scene,
};

/// Time between two pose commands (s).
const PERIOD: Real = 0.01;
/// Pose commands between two repetitions of the pressure command.
const PRESSURE_EVERY: u64 = 10;
/// How long to wait for the pressure before giving up (s).
const TIMEOUT: Real = 5.0;
/// Depth below the original height to which the object is lowered in search of the table (m).
const SEARCH_DEPTH: Real = 0.003;
/// Speed of that search (m/s).
const SEARCH_SPEED: Real = 0.025;
/// Height above the table below which lowering is slow (m).
const SLOW_HEIGHT: Real = 0.005;

/// Input of the controller.
#[derive(Clone, Copy, Debug)]
pub struct Observation {
    /// Simulated time (s).
    pub time_s: Real,
    /// Pose of the flange.
    pub flange_pose: Pose,
    /// Force of the object on the gripper, flange axes (N).
    pub contact_force: Vec3,
    /// Gauge pressure in the chamber (Pa).
    pub gauge_pa: Real,
    /// Pose of the object.
    pub object_pose: Pose,
}

/// Phase of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// Moves over the object.
    Travel,
    /// Moves down until contact.
    Approach,
    /// Pushes the gripper onto the object.
    Push,
    /// Waits for the grains to come to rest.
    Settle,
    /// Evacuates and waits for the pressure.
    Evacuate,
    /// Lifts the object.
    Lift,
    /// Holds the object up.
    Hold,
    /// Puts the object back.
    Lower,
    /// Releases the object.
    Vent,
    /// Moves away.
    Retreat,
    /// Finished.
    Done,
}

impl Phase {
    /// Name for people and topics.
    pub fn name(self) -> &'static str {
        match self {
            Self::Travel => "travel",
            Self::Approach => "approach",
            Self::Push => "push",
            Self::Settle => "settle",
            Self::Evacuate => "evacuate",
            Self::Lift => "lift",
            Self::Hold => "hold",
            Self::Lower => "lower",
            Self::Vent => "vent",
            Self::Retreat => "retreat",
            Self::Done => "done",
        }
    }
}

/// The state machine.
#[derive(Clone, Debug)]
pub struct PickAndLift {
    parameters: scene::PickAndLift,
    phase: Phase,
    /// When the phase began (s).
    since: Real,
    /// Goal of the flange in this phase (m).
    goal: Vec3,
    /// Progress; `None` before the first observation.
    run: Option<Run>,
}

#[derive(Clone, Debug)]
struct Run {
    path: Path,
    /// Height of the flange at contact (m).
    touch_height: Real,
    /// Height of the object before it was lifted (m).
    rest_height: Real,
    /// When the pressure was reached (s).
    gripped_at: Option<Real>,
    /// Commanded gauge pressure (Pa).
    pressure: Real,
    /// When the last pose was commanded (s).
    commanded_at: Real,
    n_commands: u64,
}

impl PickAndLift {
    /// A controller that starts from the pose of the flange in the first observation.
    pub fn new(parameters: &scene::PickAndLift) -> Self {
        Self {
            parameters: parameters.clone(),
            phase: Phase::Travel,
            since: 0.0,
            goal: Vec3::zeros(),
            run: None,
        }
    }

    /// Name of the object to lift.
    pub fn object(&self) -> &str {
        &self.parameters.object
    }

    /// The current phase.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// True when it has finished.
    pub fn is_done(&self) -> bool {
        self.phase == Phase::Done
    }

    /// Returns the commands for an observation. Call it at 100 Hz or faster; it returns pose
    /// commands at 100 Hz at most.
    pub fn decide(&mut self, observation: &Observation) -> Vec<Command> {
        let Some(mut run) = self.run.take().or_else(|| self.begin(observation)) else {
            return Vec::new();
        };
        self.react(&mut run, observation);
        let dt = observation.time_s - run.commanded_at;
        let mut commands = Vec::new();
        // Simulated time is in whole milliseconds here; a millionth of one is round-off.
        if PERIOD - 1e-9 <= dt && !self.is_done() {
            self.move_on(&mut run, observation, dt);
            run.commanded_at = observation.time_s;
            commands.push(pose_command(observation, &run.path.position));
            if run.n_commands % PRESSURE_EVERY == 0 {
                commands.push(Command::Vacuum { gauge_pa: run.pressure });
            }
            run.n_commands += 1;
        }
        self.run = Some(run);
        commands
    }

    fn begin(&mut self, observation: &Observation) -> Option<Run> {
        let start = observation.flange_pose.translation.vector;
        let object = observation.object_pose.translation.vector;
        self.since = observation.time_s;
        self.goal = Vec3::new(object.x, object.y, start.z);
        Some(Run {
            path: Path::at(start),
            touch_height: start.z,
            rest_height: object.z,
            gripped_at: None,
            pressure: 0.0,
            commanded_at: observation.time_s - PERIOD,
            n_commands: 0,
        })
    }

    /// Enters a phase. A new pressure is commanded with the next pose.
    fn enter(&mut self, phase: Phase, run: &mut Run, observation: &Observation, pressure: Real) {
        self.phase = phase;
        self.since = observation.time_s;
        self.goal = run.path.position;
        run.path.stop();
        if run.pressure.to_bits() != pressure.to_bits() {
            run.pressure = pressure;
            run.n_commands = 0;
        }
    }

    /// Ends phases by force, position or time.
    fn react(&mut self, run: &mut Run, observation: &Observation) {
        let p = self.parameters.clone();
        let waited = observation.time_s - self.since;
        let position = run.path.position;
        let object_height = observation.object_pose.translation.vector.z;
        let push_force = (observation.flange_pose.rotation * observation.contact_force).z;
        match self.phase {
            Phase::Approach if p.touch_force <= observation.contact_force.norm() => {
                run.touch_height = position.z;
                self.enter(Phase::Push, run, observation, 0.0);
                self.goal.z = position.z - p.push_depth;
            }
            Phase::Push if p.push_force_max <= push_force => {
                run.path = Path::at(observation.flange_pose.translation.vector);
                self.enter(Phase::Settle, run, observation, 0.0);
            }
            Phase::Settle if p.settle_time <= waited => {
                self.enter(Phase::Evacuate, run, observation, p.grip_pressure);
            }
            Phase::Evacuate => self.wait_for_grip(run, observation, &p),
            Phase::Hold if p.hold_time <= waited => {
                let lifted = object_height - run.rest_height;
                if lifted < p.lift_height / 2.0 {
                    // The object fell: there is nothing to put back.
                    self.enter(Phase::Vent, run, observation, p.vent_pressure);
                } else {
                    self.enter(Phase::Lower, run, observation, p.grip_pressure);
                    self.goal.z = position.z - lifted - SEARCH_DEPTH;
                }
            }
            Phase::Lower if p.touch_force <= push_force => {
                run.path = Path::at(observation.flange_pose.translation.vector);
                self.enter(Phase::Vent, run, observation, p.vent_pressure);
            }
            Phase::Vent if p.vent_time <= waited => {
                self.enter(Phase::Retreat, run, observation, 0.0);
                self.goal.z = position.z + p.retreat_height;
            }
            _ => {}
        }
    }

    /// Lifts once the pressure was reached and the grains have settled under it.
    fn wait_for_grip(&mut self, run: &mut Run, observation: &Observation, p: &scene::PickAndLift) {
        if observation.gauge_pa <= p.grip_pressure * p.grip_pressure_reached {
            run.gripped_at.get_or_insert(observation.time_s);
        }
        match run.gripped_at {
            Some(since) if p.settle_time <= observation.time_s - since => {
                run.rest_height = observation.object_pose.translation.vector.z;
                self.enter(Phase::Lift, run, observation, p.grip_pressure);
                self.goal.z += p.lift_height;
            }
            None if TIMEOUT <= observation.time_s - self.since => {
                self.enter(Phase::Vent, run, observation, p.vent_pressure);
            }
            _ => {}
        }
    }

    /// Advances the setpoint and ends phases on arrival.
    fn move_on(&mut self, run: &mut Run, observation: &Observation, dt: Real) {
        let speed = self.speed(run);
        let arrived = run.path.advance(&self.goal, speed, dt);
        if !arrived {
            return;
        }
        match self.phase {
            Phase::Travel => {
                self.enter(Phase::Approach, run, observation, 0.0);
                // The center of the object: contact must happen long before.
                self.goal.z = observation.object_pose.translation.vector.z;
            }
            // No contact all the way down.
            Phase::Approach => {
                self.enter(Phase::Retreat, run, observation, 0.0);
                self.goal.z += self.parameters.retreat_height;
            }
            Phase::Push => self.enter(Phase::Settle, run, observation, 0.0),
            Phase::Lift => self.enter(Phase::Hold, run, observation, self.parameters.grip_pressure),
            Phase::Lower => {
                self.enter(Phase::Vent, run, observation, self.parameters.vent_pressure)
            }
            Phase::Retreat => self.enter(Phase::Done, run, observation, 0.0),
            _ => {}
        }
    }

    fn speed(&self, run: &Run) -> Real {
        let p = &self.parameters;
        let is_near_goal = run.path.position.z - self.goal.z < SEARCH_DEPTH + SLOW_HEIGHT;
        match self.phase {
            Phase::Push => p.push_speed,
            Phase::Lower if is_near_goal => SEARCH_SPEED.min(p.lift_speed),
            Phase::Lift | Phase::Lower => p.lift_speed,
            _ => p.approach_speed,
        }
    }
}

/// The flange keeps its observed orientation.
fn pose_command(observation: &Observation, position: &Vec3) -> Command {
    let q = observation.flange_pose.rotation.coords;
    #[expect(clippy::cast_possible_truncation, reason = "2^63 ns are 292 years")]
    let stamp_ns = (observation.time_s * 1e9).round() as i64;
    Command::FlangePose(PoseCommand {
        frame_id: "world".to_owned(),
        stamp_ns,
        position: [position.x, position.y, position.z],
        orientation: [q.x, q.y, q.z, q.w],
    })
}

#[cfg(test)]
mod tests {
    use super::{super::mock_plant::MockPlant, *};

    fn parameters() -> scene::PickAndLift {
        scene::PickAndLift {
            object: "object".to_owned(),
            approach_speed: 0.05,
            touch_force: 0.1,
            push_speed: 0.01,
            push_depth: 0.028,
            push_force_max: 60.0,
            settle_time: 0.2,
            grip_pressure: -90e3,
            grip_pressure_reached: 0.95,
            lift_speed: 0.05,
            lift_height: 0.1,
            hold_time: 1.0,
            vent_pressure: 5e3,
            vent_time: 0.5,
            retreat_height: 0.06,
        }
    }

    /// Runs to the end and returns the phases in order.
    fn play(plant: &mut MockPlant, parameters: &scene::PickAndLift) -> Vec<Phase> {
        let mut controller = PickAndLift::new(parameters);
        let mut phases = vec![controller.phase()];
        for _ in 0..60_000 {
            let commands = controller.decide(&plant.observe());
            plant.tick(&commands);
            if phases.last() != Some(&controller.phase()) {
                phases.push(controller.phase());
            }
            if controller.is_done() {
                return phases;
            }
        }
        panic!("not done after a minute: {phases:?}");
    }

    fn start() -> Vec3 {
        Vec3::new(0.0, 0.0, 0.15)
    }

    /// Oracles: the requested lift height, the original position of the object, and the speed limit times
    /// the command period.
    #[test]
    fn lifts_holds_and_puts_back() {
        let mut plant = MockPlant::new(start());
        let phases = play(&mut plant, &parameters());
        assert!(phases.is_sorted(), "{phases:?}");
        assert_eq!(phases.len(), 11, "every phase once: {phases:?}");
        assert!((plant.lifted_max - 0.1).abs() < 1e-6, "lifted {} m", plant.lifted_max);
        assert!(plant.lifted().abs() < 1e-9, "put back");
        assert!(plant.step_max <= 0.05 * PERIOD * 1.0001, "steps of {} m", plant.step_max);
    }

    #[test]
    fn slipping_object_is_put_down_on_the_table() {
        let mut plant = MockPlant::new(start());
        plant.slip = 0.002;
        let phases = play(&mut plant, &parameters());
        assert!(phases.contains(&Phase::Lower), "{phases:?}");
        assert!(0.09 < plant.lifted_max, "lifted {} m", plant.lifted_max);
        // Lowering at the wrong depth would press with 500 N/m times the slip of 8 mm, 4 N more.
        assert!(plant.push_max < 500.0 * 0.0291, "pushed with {} N", plant.push_max);
    }

    #[test]
    fn without_vacuum_nothing_is_lifted() {
        let mut plant = MockPlant::new(start());
        let phases = play(&mut plant, &scene::PickAndLift { grip_pressure: 0.0, ..parameters() });
        assert!(plant.lifted_max.abs() < 1e-12, "lifted {} m", plant.lifted_max);
        assert!(!phases.contains(&Phase::Lower), "nothing to put back: {phases:?}");
    }

    #[test]
    fn weak_pump_ends_in_venting() {
        let mut plant = MockPlant::new(start());
        let phases =
            play(&mut plant, &scene::PickAndLift { grip_pressure_reached: 1.1, ..parameters() });
        assert!(!phases.contains(&Phase::Lift), "{phases:?}");
    }

    #[test]
    fn push_stops_at_its_force_limit() {
        let mut plant = MockPlant::new(start());
        play(&mut plant, &scene::PickAndLift { push_force_max: 5.0, ..parameters() });
        // Tolerance: one period at push speed, 0.1 mm, times the plant's 500 N/m; and putting back
        // presses until the touch force of 0.1 N is felt, which adds as much and a period more.
        assert!(plant.push_max < 5.0 + 0.05 + 0.15, "pushed with {} N", plant.push_max);
    }
}
