//! Applies commands: checks, limits or rejects them, and keeps the setpoints.

use super::{
    Command, CommandCounts, CommandError, CommandRecord, JOINTS, Limit, Outcome, PoseCommand,
};
use crate::{
    base::{Pose, Quat, Real, Vec3},
    cosim::Inputs,
    scene::{Object, Scene},
};

/// Largest deviation of the length of a quaternion from 1.
const NORMALIZED: Real = 1e-3;
/// The world frame.
pub const WORLD: &str = "world";
/// The frame of the flange, in the plane of the rim.
pub const FLANGE: &str = "gripper_flange";

/// The frame of an object, at its center of mass.
pub fn object_frame(name: &str) -> String {
    format!("object/{name}")
}

/// Poses that commands may refer to, as they were at the end of the last tick.
pub struct Frames {
    /// The flange in the world.
    pub flange: Pose,
    /// The objects in the world, in the order of the scene.
    pub objects: Vec<Pose>,
}

/// Setpoints and counts of the commands so far.
pub struct CommandProcessor {
    names: Vec<String>,
    gauge_range: [Real; 2],
    speed_max: Real,
    drive_timeouts_ns: Vec<u64>,
    pub(super) gauge_setpoint: Real,
    pub(super) flange: Target,
    pub(super) drives: Vec<Option<Target>>,
    pub(super) counts: CommandCounts,
}

/// A commanded pose and its time.
#[derive(Clone, Copy)]
pub(super) struct Target {
    pub(super) pose: Pose,
    pub(super) time_ns: u64,
}

impl CommandProcessor {
    /// A processor for `scene`; the flange stays where it is.
    pub fn new(scene: &Scene) -> Self {
        Self {
            names: scene.objects.iter().map(|object| object.name.clone()).collect(),
            gauge_range: [scene.chamber.gauge_min, scene.chamber.gauge_max],
            speed_max: scene.flange.speed_max,
            drive_timeouts_ns: scene.objects.iter().map(drive_timeout_ns).collect(),
            gauge_setpoint: 0.0,
            flange: Target { pose: scene.flange.pose, time_ns: 0 },
            drives: vec![None; scene.objects.len()],
            counts: CommandCounts::default(),
        }
    }

    /// Resets the setpoints but not the counts.
    pub fn restart(&mut self, scene: &Scene) {
        let counts = self.counts;
        *self = Self { counts, ..Self::new(scene) };
    }

    /// Continues counting from `counts`.
    pub fn count_on(&mut self, counts: CommandCounts) {
        self.counts = counts;
    }

    /// Adds an object behind all others.
    pub fn insert(&mut self, object: &Object) {
        self.names.push(object.name.clone());
        self.drive_timeouts_ns.push(drive_timeout_ns(object));
        self.drives.push(None);
    }

    /// Removes object `i`.
    pub fn remove(&mut self, i: usize) {
        self.names.remove(i);
        self.drive_timeouts_ns.remove(i);
        self.drives.remove(i);
    }

    /// Stops driving object `i`.
    pub fn release(&mut self, i: usize) {
        self.drives[i] = None;
    }

    /// Sets the pose of the flange after it was teleported.
    pub fn place_flange(&mut self, pose: Pose, now_ns: u64) {
        self.flange = Target { pose, time_ns: now_ns };
    }

    /// Simulated time was reset: earlier commands count as commanded at the start.
    pub fn restart_time(&mut self) {
        self.flange.time_ns = 0;
        self.drives.iter_mut().flatten().for_each(|drive| drive.time_ns = 0);
    }

    /// Number of commands so far, by outcome.
    pub fn counts(&self) -> CommandCounts {
        self.counts
    }

    /// Setpoint of the gauge pressure, within the range of the pump (Pa).
    pub fn gauge_setpoint(&self) -> Real {
        self.gauge_setpoint
    }

    /// True while pose commands drive object `i`.
    pub fn is_driven(&self, i: usize) -> bool {
        self.drives[i].is_some()
    }

    /// Applies the commands that arrived before the tick that starts at `now_ns` (ns).
    pub fn take(
        &mut self,
        commands: &[Command],
        frames: &Frames,
        now_ns: u64,
    ) -> (Inputs, Vec<CommandRecord>) {
        let mut records = Vec::with_capacity(commands.len());
        for command in commands {
            let outcome = match self.apply(command, frames, now_ns) {
                Ok(None) => Outcome::Applied,
                Ok(Some(limit)) => Outcome::Limited(limit),
                Err(error) => Outcome::Rejected(error),
            };
            match outcome {
                Outcome::Applied => self.counts.n_applied += 1,
                Outcome::Limited(_) => self.counts.n_limited += 1,
                Outcome::Rejected(_) => self.counts.n_rejected += 1,
            }
            records.push(CommandRecord { command: command.clone(), outcome });
        }
        for (drive, timeout) in self.drives.iter_mut().zip(&self.drive_timeouts_ns) {
            if drive.is_some_and(|target| now_ns - target.time_ns > *timeout) {
                *drive = None;
            }
        }
        let inputs = Inputs {
            gauge_setpoint: self.gauge_setpoint,
            flange_target: self.flange.pose,
            drives: self.drives.iter().map(|drive| drive.map(|target| target.pose)).collect(),
        };
        (inputs, records)
    }

    fn apply(
        &mut self,
        command: &Command,
        frames: &Frames,
        now_ns: u64,
    ) -> Result<Option<Limit>, CommandError> {
        match command {
            Command::Vacuum { gauge_pa } => {
                finite("gauge pressure", *gauge_pa)?;
                Ok(self.set_gauge(*gauge_pa))
            }
            Command::Joints { names, positions, .. } => self.set_joints(names, positions, now_ns),
            Command::FlangePose(pose) => {
                let pose = self.pose_in_world(pose, frames)?;
                let limit = self.jump(&self.flange, &pose, now_ns);
                self.flange = Target { pose, time_ns: now_ns };
                Ok(limit)
            }
            Command::ObjectPose { object, pose } => {
                let i = self.find(object)?;
                let pose = self.pose_in_world(pose, frames)?;
                let here = Target { pose: frames.objects[i], time_ns: now_ns };
                let limit = self.jump(&self.drives[i].unwrap_or(here), &pose, now_ns);
                self.drives[i] = Some(Target { pose, time_ns: now_ns });
                Ok(limit)
            }
            Command::ObjectRelease { object } => {
                let i = self.find(object)?;
                self.drives[i] = None;
                Ok(None)
            }
        }
    }

    fn set_gauge(&mut self, requested_pa: Real) -> Option<Limit> {
        let [min, max] = self.gauge_range;
        let set_pa = requested_pa.clamp(min, max);
        self.gauge_setpoint = set_pa;
        let is_limited = requested_pa < min || requested_pa > max;
        is_limited.then_some(Limit::PumpRange { requested_pa, set_pa })
    }

    /// Sets all joints or none: everything is checked first.
    fn set_joints(
        &mut self,
        names: &[String],
        positions: &[Real],
        now_ns: u64,
    ) -> Result<Option<Limit>, CommandError> {
        if names.len() != positions.len() {
            let (n_names, n_positions) = (names.len(), positions.len());
            return Err(CommandError::JointsWithoutPosition { n_names, n_positions });
        }
        let p = self.flange.pose.translation.vector;
        let (roll, pitch, yaw) = self.flange.pose.rotation.euler_angles();
        let mut goals = [Real::NAN, p.x, p.y, p.z, roll, pitch, yaw];
        let mut moves_flange = false;
        for (name, position) in names.iter().zip(positions) {
            finite("joint position, squared,", position * position)?;
            let i = JOINTS.iter().position(|it| it == name).ok_or_else(|| {
                CommandError::UnknownJoint { joint: name.clone(), known: JOINTS.join(", ") }
            })?;
            goals[i] = *position;
            moves_flange |= 0 < i;
        }
        let [vacuum, x, y, z, roll, pitch, yaw] = goals;
        let mut limit = None;
        if moves_flange {
            let rotation = Quat::from_euler_angles(roll, pitch, yaw);
            let pose = Pose::from_parts(Vec3::new(x, y, z).into(), rotation);
            limit = self.jump(&self.flange, &pose, now_ns);
            self.flange = Target { pose, time_ns: now_ns };
        }
        if !vacuum.is_nan() {
            let [min, _] = self.gauge_range;
            limit = self.set_gauge(vacuum * min).or(limit);
        }
        Ok(limit)
    }

    fn find(&self, object: &str) -> Result<usize, CommandError> {
        self.names.iter().position(|name| name == object).ok_or_else(|| {
            CommandError::UnknownObject { object: object.to_owned(), known: self.names.join(", ") }
        })
    }

    fn pose_in_world(&self, command: &PoseCommand, frames: &Frames) -> Result<Pose, CommandError> {
        for value in command.position {
            finite("position", value)?;
        }
        for value in command.orientation {
            finite("orientation", value)?;
        }
        let [x, y, z, w] = command.orientation;
        let quaternion = nalgebra::Quaternion::new(w, x, y, z);
        let length = quaternion.norm();
        if (length - 1.0).abs() > NORMALIZED {
            return Err(CommandError::NotNormalized { length });
        }
        let rotation = Quat::from_quaternion(quaternion);
        let local = Pose::from_parts(Vec3::from(command.position).into(), rotation);
        let object_frames: Vec<String> = self.names.iter().map(|n| object_frame(n)).collect();
        let pose = match command.frame_id.as_str() {
            "" | WORLD => local,
            FLANGE => frames.flange * local,
            other => match object_frames.iter().position(|frame| frame == other) {
                Some(i) => frames.objects[i] * local,
                None => {
                    return Err(CommandError::UnknownFrame {
                        frame_id: other.to_owned(),
                        known: format!("{WORLD}, {FLANGE}, {}", object_frames.join(", ")),
                    });
                }
            },
        };
        // Huge finite numbers may overflow in world coordinates, and an infinite distance has no
        // direction.
        for value in pose.translation.vector.iter() {
            finite("position in the world, squared,", value * value)?;
        }
        Ok(pose)
    }

    /// A pose is a jump if the body cannot reach it in the time since the previous command.
    fn jump(&self, before: &Target, pose: &Pose, now_ns: u64) -> Option<Limit> {
        let delta = pose.translation.vector - before.pose.translation.vector;
        let distance_m = delta.norm();
        let elapsed = std::time::Duration::from_nanos(now_ns - before.time_ns).as_secs_f64();
        // A tolerance of a millimeter and a tick, because stamps fall between ticks.
        let allowed_m = self.speed_max * (elapsed + 1e-3) + 1e-3;
        (distance_m > allowed_m).then_some(Limit::PoseJump { distance_m, allowed_m })
    }
}

fn drive_timeout_ns(object: &Object) -> u64 {
    let nanoseconds = std::time::Duration::from_secs_f64(object.drive_timeout).as_nanos();
    u64::try_from(nanoseconds).unwrap_or(u64::MAX)
}

fn finite(field: &'static str, value: Real) -> Result<(), CommandError> {
    if value.is_finite() { Ok(()) } else { Err(CommandError::NotFinite { field, value }) }
}
