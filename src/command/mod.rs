//! What the outside may ask. A closed list: sources make commands, `apply` carries them out.
//!
//! A command holds the values exactly as they arrived, even senseless ones: what is refused is
//! recorded too.

pub mod apply; // commands to setpoints
pub mod change; // discontinuous changes between ticks
mod saved_change; // changes as bytes
mod saved_setpoints; // setpoints as bytes

pub use apply::{FLANGE, WORLD, object_frame};

/// One wish of the outside.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Set-point of the chamber's gauge pressure (Pa): negative is vacuum, positive blows off.
    Vacuum {
        /// Gauge pressure (Pa).
        gauge_pa: f64,
    },
    /// Pose that the flange shall move to.
    FlangePose(PoseCommand),
    /// Pose that drives an object kinematically until its time-out or a release.
    ObjectPose {
        /// Name of the object.
        object: String,
        /// Where it shall be.
        pose: PoseCommand,
    },
    /// Set-points of the gripper's joints, as `~/joint_states` names them; joints that are not named
    /// keep theirs.
    Joints {
        /// Stamp of the message (ns).
        stamp_ns: i64,
        /// Names of the joints.
        names: Vec<String>,
        /// Position of each: share of the strongest vacuum, m, rad.
        positions: Vec<f64>,
    },
    /// Gives a driven object back to dynamics at once.
    ObjectRelease {
        /// Name of the object.
        object: String,
    },
}

/// Names of the gripper's joints: the vacuum, then the flange along and about the world's axes.
pub const JOINTS: [&str; 7] =
    ["vacuum", "flange_x", "flange_y", "flange_z", "flange_roll", "flange_pitch", "flange_yaw"];

impl Command {
    /// Stamp of a command that has one (ns).
    pub fn stamp_ns(&self) -> Option<i64> {
        match self {
            Self::FlangePose(pose) | Self::ObjectPose { pose, .. } => Some(pose.stamp_ns),
            Self::Joints { stamp_ns, .. } => Some(*stamp_ns),
            Self::Vacuum { .. } | Self::ObjectRelease { .. } => None,
        }
    }
}

/// A pose as it arrived.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseCommand {
    /// Frame the pose is given in; empty means `world`.
    pub frame_id: String,
    /// Stamp of the message (ns); recorded, not used.
    pub stamp_ns: i64,
    /// Position x, y, z (m).
    pub position: [f64; 3],
    /// Orientation x, y, z, w.
    pub orientation: [f64; 4],
}

/// What became of a command.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Carried out as asked.
    Applied,
    /// Carried out within a limit; says which.
    Limited(Limit),
    /// Not carried out; says why.
    Refused(Refusal),
}

/// Why a command was carried out only in part.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// The pressure was beyond the pump's range and was clamped.
    PumpRange {
        /// Asked for (Pa).
        asked_pa: f64,
        /// Set instead (Pa).
        set_pa: f64,
    },
    /// The pose is further away than one command period allows; it is approached at the limits.
    PoseJump {
        /// Distance to the pose commanded before (m).
        distance_m: f64,
        /// Distance that the velocity limit allows in the time since then (m).
        allowed_m: f64,
    },
}

/// Why a command was not carried out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// A value is NaN or infinite.
    #[error("{field} is {value}: send finite numbers")]
    NotFinite {
        /// Which value.
        field: &'static str,
        /// The value.
        value: f64,
    },
    /// The quaternion's length is not one.
    #[error("orientation has length {length}, more than 1e-3 from 1: normalise the quaternion")]
    NotNormalised {
        /// Length of the quaternion.
        length: f64,
    },
    /// The frame is not one of this scene's.
    #[error("unknown frame `{frame_id}`: use one of {known}")]
    UnknownFrame {
        /// What was asked for.
        frame_id: String,
        /// What there is.
        known: String,
    },
    /// The joint is not one of the gripper's.
    #[error("unknown joint `{joint}`: use some of {known}")]
    UnknownJoint {
        /// What was asked for.
        joint: String,
        /// What there is.
        known: String,
    },
    /// There is not one position for each joint.
    #[error("{n_positions} positions for {n_names} joints: send one for each")]
    JointsWithoutPosition {
        /// How many joints.
        n_names: usize,
        /// How many positions.
        n_positions: usize,
    },
    /// The object is not one of this scene's.
    #[error("unknown object `{object}`: the scene has {known}")]
    UnknownObject {
        /// What was asked for.
        object: String,
        /// What there is.
        known: String,
    },
}

/// A command and its fate, as recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandRecord {
    /// What was asked.
    pub command: Command,
    /// What became of it.
    pub outcome: Outcome,
}

/// Commands so far, by fate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CommandCounts {
    /// Carried out as asked.
    pub n_applied: u64,
    /// Carried out within a limit.
    pub n_limited: u64,
    /// Not carried out.
    pub n_refused: u64,
}
