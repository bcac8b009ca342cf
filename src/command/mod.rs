//! Commands: the continuous inputs of a session. Sources create them, `apply` applies them.
//!
//! A command holds the values exactly as they arrived, even invalid ones, because rejected
//! commands are recorded too.

pub mod apply; // commands to setpoints
pub mod change; // discontinuous changes between ticks
mod saved_change; // changes as bytes
mod saved_setpoints; // setpoints as bytes

pub use apply::{FLANGE, WORLD, object_frame};

/// A command to the gripper or an object.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Setpoint of the gauge pressure in the membrane: negative is vacuum, positive inflates.
    Vacuum {
        /// Gauge pressure (Pa).
        gauge_pa: f64,
    },
    /// Pose to which the flange moves, within its speed and acceleration limits.
    FlangePose(PoseCommand),
    /// Pose that drives an object kinematically until its timeout or a release.
    ObjectPose {
        /// Name of the object.
        object: String,
        /// Pose of its center of mass.
        pose: PoseCommand,
    },
    /// Setpoints of the joints of the gripper, named as in [`JOINTS`]; the other joints keep theirs.
    Joints {
        /// Stamp of the message (ns).
        stamp_ns: i64,
        /// Names of the joints.
        names: Vec<String>,
        /// Position of each: fraction of the strongest vacuum (1), m, rad.
        positions: Vec<f64>,
    },
    /// Stops driving an object; it moves freely again.
    ObjectRelease {
        /// Name of the object.
        object: String,
    },
}

/// Names of the joints of the gripper: the vacuum, then the flange along and about the world axes.
pub const JOINTS: [&str; 7] =
    ["vacuum", "flange_x", "flange_y", "flange_z", "flange_roll", "flange_pitch", "flange_yaw"];

impl Command {
    /// Stamp of the command, if it has one (ns).
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
    /// Frame of the pose: `world` (also if empty), `gripper_flange` or `object/NAME`.
    pub frame_id: String,
    /// Stamp of the message (ns); used by lockstep and recorded.
    pub stamp_ns: i64,
    /// Position x, y, z (m).
    pub position: [f64; 3],
    /// Orientation as a unit quaternion x, y, z, w.
    pub orientation: [f64; 4],
}

/// Outcome of a command.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Applied as requested.
    Applied,
    /// Applied within a limit.
    Limited(Limit),
    /// Rejected.
    Rejected(CommandError),
}

/// The limit that a command exceeded.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// The pressure was outside the range of the pump and was clamped.
    PumpRange {
        /// Requested (Pa).
        requested_pa: f64,
        /// Applied (Pa).
        set_pa: f64,
    },
    /// The pose is too far from the previous one for the time between them; it is approached at the
    /// speed limit.
    PoseJump {
        /// Distance to the previously commanded pose (m).
        distance_m: f64,
        /// Distance that the speed limit allows in the time since then (m).
        allowed_m: f64,
    },
}

/// Why a command was rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CommandError {
    /// A value is NaN or infinite.
    #[error("{field} is {value}: send finite numbers")]
    NotFinite {
        /// The field.
        field: &'static str,
        /// The value.
        value: f64,
    },
    /// The length of the quaternion is not one.
    #[error("orientation has length {length}, more than 1e-3 from 1: normalize the quaternion")]
    NotNormalized {
        /// Length of the quaternion.
        length: f64,
    },
    /// The frame is unknown.
    #[error("unknown frame `{frame_id}`: use one of {known}")]
    UnknownFrame {
        /// The requested name.
        frame_id: String,
        /// The known names.
        known: String,
    },
    /// The joint is unknown.
    #[error("unknown joint `{joint}`: use some of {known}")]
    UnknownJoint {
        /// The requested name.
        joint: String,
        /// The known names.
        known: String,
    },
    /// The number of positions differs from the number of joints.
    #[error("{n_positions} positions for {n_names} joints: send one for each")]
    JointsWithoutPosition {
        /// Number of joints.
        n_names: usize,
        /// Number of positions.
        n_positions: usize,
    },
    /// The object is unknown.
    #[error("unknown object `{object}`: the scene has {known}")]
    UnknownObject {
        /// The requested name.
        object: String,
        /// The known names.
        known: String,
    },
}

/// A command and its outcome, as recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandRecord {
    /// The command.
    pub command: Command,
    /// The outcome.
    pub outcome: Outcome,
}

/// Number of commands so far, by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CommandCounts {
    /// Applied as requested.
    pub n_applied: u64,
    /// Applied within a limit.
    pub n_limited: u64,
    /// Rejected.
    pub n_rejected: u64,
}
