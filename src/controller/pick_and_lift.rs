//! Pick and lift: travel over the object, come down until it is felt, push in, let the grains
//! settle, evacuate, lift, hold, put back, vent, retreat.
//!
//! Nothing here knows the scene's geometry: the object is found by its pose and by touch, and it
//! is put back where it stood, however much it slipped or sagged on the way.

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
/// How much lower than it stood the object may be put, searching for the table (m).
const SEARCH_DEPTH: Real = 0.003;
/// Speed of that search (m/s).
const SEARCH_SPEED: Real = 0.025;
/// Height over the table in which lowering is slow (m).
const SLOW_HEIGHT: Real = 0.005;

/// What the controller sees.
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

/// What the controller is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// Moving over the object.
    Travel,
    /// Coming down until the object is felt.
    Approach,
    /// Pushing the bag over the object.
    Push,
    /// Letting the grains come to rest.
    Settle,
    /// Evacuating and waiting for the pressure.
    Evacuate,
    /// Lifting.
    Lift,
    /// Holding the object up.
    Hold,
    /// Putting it back.
    Lower,
    /// Letting it go.
    Vent,
    /// Moving away.
    Retreat,
    /// Finished.
    Done,
}

impl Phase {
    /// One word for people and topics.
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
    /// Where the phase leads the flange (m).
    goal: Vec3,
    /// What has been seen and commanded; `None` before the first observation.
    run: Option<Run>,
}

#[derive(Clone, Debug)]
struct Run {
    path: Path,
    /// Flange height at touch (m).
    touch_height: Real,
    /// Height of the object before it was lifted (m).
    rest_height: Real,
    /// When the pressure was reached (s).
    gripped_at: Option<Real>,
    /// Gauge pressure asked for (Pa).
    pressure: Real,
    /// When the last pose was commanded (s).
    commanded_at: Real,
    n_commands: u64,
}

impl PickAndLift {
    /// A machine that starts wherever the flange is when it is first seen.
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

    /// What it is doing.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// True when it has finished.
    pub fn is_done(&self) -> bool {
        self.phase == Phase::Done
    }

    /// What to command now. Call it whenever something new was seen, at 100 Hz or faster:
    /// commands come at most at 100 Hz.
    pub fn decide(&mut self, seen: &Observation) -> Vec<Command> {
        let Some(mut run) = self.run.take().or_else(|| self.begin(seen)) else { return Vec::new() };
        self.react(&mut run, seen);
        let dt = seen.time_s - run.commanded_at;
        let mut commands = Vec::new();
        // Simulated time is in whole milliseconds here; a millionth of one is round-off.
        if PERIOD - 1e-9 <= dt && !self.is_done() {
            self.move_on(&mut run, seen, dt);
            run.commanded_at = seen.time_s;
            commands.push(pose_command(seen, &run.path.position));
            if run.n_commands % PRESSURE_EVERY == 0 {
                commands.push(Command::Vacuum { gauge_pa: run.pressure });
            }
            run.n_commands += 1;
        }
        self.run = Some(run);
        commands
    }

    fn begin(&mut self, seen: &Observation) -> Option<Run> {
        let start = seen.flange_pose.translation.vector;
        let object = seen.object_pose.translation.vector;
        self.since = seen.time_s;
        self.goal = Vec3::new(object.x, object.y, start.z);
        Some(Run {
            path: Path::at(start),
            touch_height: start.z,
            rest_height: object.z,
            gripped_at: None,
            pressure: 0.0,
            commanded_at: seen.time_s - PERIOD,
            n_commands: 0,
        })
    }

    /// Goes to another phase. A new pressure is commanded with the next pose.
    fn enter(&mut self, phase: Phase, run: &mut Run, seen: &Observation, pressure: Real) {
        self.phase = phase;
        self.since = seen.time_s;
        self.goal = run.path.position;
        run.path.stop();
        if run.pressure.to_bits() != pressure.to_bits() {
            run.pressure = pressure;
            run.n_commands = 0;
        }
    }

    /// Ends phases by what was felt, seen or waited for.
    fn react(&mut self, run: &mut Run, seen: &Observation) {
        let p = self.parameters.clone();
        let waited = seen.time_s - self.since;
        let position = run.path.position;
        let object_height = seen.object_pose.translation.vector.z;
        let push_force = (seen.flange_pose.rotation * seen.contact_force).z;
        match self.phase {
            Phase::Approach if p.touch_force <= seen.contact_force.norm() => {
                run.touch_height = position.z;
                self.enter(Phase::Push, run, seen, 0.0);
                self.goal.z = position.z - p.push_depth;
            }
            Phase::Push if p.push_force_max <= push_force => {
                run.path = Path::at(seen.flange_pose.translation.vector);
                self.enter(Phase::Settle, run, seen, 0.0);
            }
            Phase::Settle if p.settle_time <= waited => {
                self.enter(Phase::Evacuate, run, seen, p.grip_pressure);
            }
            Phase::Evacuate => self.wait_for_grip(run, seen, &p),
            Phase::Hold if p.hold_time <= waited => {
                let lifted = object_height - run.rest_height;
                if lifted < p.lift_height / 2.0 {
                    // It fell: there is nothing to put back.
                    self.enter(Phase::Vent, run, seen, p.vent_pressure);
                } else {
                    self.enter(Phase::Lower, run, seen, p.grip_pressure);
                    self.goal.z = position.z - lifted - SEARCH_DEPTH;
                }
            }
            Phase::Lower if p.touch_force <= push_force => {
                run.path = Path::at(seen.flange_pose.translation.vector);
                self.enter(Phase::Vent, run, seen, p.vent_pressure);
            }
            Phase::Vent if p.vent_time <= waited => {
                self.enter(Phase::Retreat, run, seen, 0.0);
                self.goal.z = position.z + p.retreat_height;
            }
            _ => {}
        }
    }

    /// Lifts once the pressure was reached and the grains have settled under it.
    fn wait_for_grip(&mut self, run: &mut Run, seen: &Observation, p: &scene::PickAndLift) {
        if seen.gauge_pa <= p.grip_pressure * p.grip_pressure_reached {
            run.gripped_at.get_or_insert(seen.time_s);
        }
        match run.gripped_at {
            Some(since) if p.settle_time <= seen.time_s - since => {
                run.rest_height = seen.object_pose.translation.vector.z;
                self.enter(Phase::Lift, run, seen, p.grip_pressure);
                self.goal.z += p.lift_height;
            }
            None if TIMEOUT <= seen.time_s - self.since => {
                self.enter(Phase::Vent, run, seen, p.vent_pressure);
            }
            _ => {}
        }
    }

    /// Moves the set-point on, and ends phases on arrival.
    fn move_on(&mut self, run: &mut Run, seen: &Observation, dt: Real) {
        let speed = self.speed(run);
        let arrived = run.path.walk(&self.goal, speed, dt);
        if !arrived {
            return;
        }
        match self.phase {
            Phase::Travel => {
                self.enter(Phase::Approach, run, seen, 0.0);
                // The object's centre: the bag must have touched long before.
                self.goal.z = seen.object_pose.translation.vector.z;
            }
            // It went all the way down and felt nothing.
            Phase::Approach => {
                self.enter(Phase::Retreat, run, seen, 0.0);
                self.goal.z += self.parameters.retreat_height;
            }
            Phase::Push => self.enter(Phase::Settle, run, seen, 0.0),
            Phase::Lift => self.enter(Phase::Hold, run, seen, self.parameters.grip_pressure),
            Phase::Lower => self.enter(Phase::Vent, run, seen, self.parameters.vent_pressure),
            Phase::Retreat => self.enter(Phase::Done, run, seen, 0.0),
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

/// The flange keeps the orientation it is seen with.
fn pose_command(seen: &Observation, position: &Vec3) -> Command {
    let q = seen.flange_pose.rotation.coords;
    #[expect(clippy::cast_possible_truncation, reason = "2^63 ns are 292 years")]
    let stamp_ns = (seen.time_s * 1e9).round() as i64;
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

    /// Runs to the end; returns the phases in the order they came.
    fn play(toy: &mut MockPlant, parameters: &scene::PickAndLift) -> Vec<Phase> {
        let mut controller = PickAndLift::new(parameters);
        let mut phases = vec![controller.phase()];
        for _ in 0..60_000 {
            let commands = controller.decide(&toy.observe());
            toy.tick(&commands);
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

    /// Oracles: the lift height asked for, the object's place before, and the speed limit times
    /// the command period.
    #[test]
    fn lifts_holds_and_puts_back() {
        let mut toy = MockPlant::new(start());
        let phases = play(&mut toy, &parameters());
        assert!(phases.is_sorted(), "{phases:?}");
        assert_eq!(phases.len(), 11, "every phase once: {phases:?}");
        assert!((toy.lifted_max - 0.1).abs() < 1e-6, "lifted {} m", toy.lifted_max);
        assert!(toy.lifted().abs() < 1e-9, "put back");
        assert!(toy.step_max <= 0.05 * PERIOD * 1.0001, "steps of {} m", toy.step_max);
    }

    #[test]
    fn an_object_that_slips_is_put_down_on_the_table_not_above_it() {
        let mut toy = MockPlant::new(start());
        toy.slip = 0.002;
        let phases = play(&mut toy, &parameters());
        assert!(phases.contains(&Phase::Lower), "{phases:?}");
        assert!(0.09 < toy.lifted_max, "lifted {} m", toy.lifted_max);
        // Lowering at the wrong depth would press with 500 N/m times the slip of 8 mm, 4 N more.
        assert!(toy.push_max < 500.0 * 0.0291, "pushed with {} N", toy.push_max);
    }

    #[test]
    fn without_vacuum_nothing_is_lifted_and_the_run_still_ends() {
        let mut toy = MockPlant::new(start());
        let phases = play(&mut toy, &scene::PickAndLift { grip_pressure: 0.0, ..parameters() });
        assert!(toy.lifted_max.abs() < 1e-12, "lifted {} m", toy.lifted_max);
        assert!(!phases.contains(&Phase::Lower), "nothing to put back: {phases:?}");
    }

    #[test]
    fn a_pump_that_never_gets_there_is_given_up() {
        let mut toy = MockPlant::new(start());
        let phases =
            play(&mut toy, &scene::PickAndLift { grip_pressure_reached: 1.1, ..parameters() });
        assert!(!phases.contains(&Phase::Lift), "{phases:?}");
    }

    #[test]
    fn the_push_stops_at_its_force_limit() {
        let mut toy = MockPlant::new(start());
        play(&mut toy, &scene::PickAndLift { push_force_max: 5.0, ..parameters() });
        // Tolerance: one period at push speed, 0.1 mm, times the toy's 500 N/m; and putting back
        // presses until the touch force of 0.1 N is felt, which adds as much and a period more.
        assert!(toy.push_max < 5.0 + 0.05 + 0.15, "pushed with {} N", toy.push_max);
    }
}
