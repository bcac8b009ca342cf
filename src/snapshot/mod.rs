//! Results of a tick: plain, owned SI data in the world frame unless a field says otherwise.
//!
//! The small parts are always present; grains, membrane and contacts only when selected.

pub mod checkpoint; // a saved session with its tick
pub mod due; // what is due at which tick
pub mod run; // wall-clock statistics
mod take; // copies a session
pub mod view; // results, borrowed

use crate::{
    base::{
        Pose, Tick, Vec3,
        real::{Twist, Wrench},
    },
    command::{CommandCounts, CommandRecord},
};

/// The coupled system at the end of one tick.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Number of the tick that ended.
    pub tick: Tick,
    /// Simulated time at its end (ns).
    pub time_ns: u64,
    /// Ticks since the start of the run. Unlike `tick` it is not reset with simulated time.
    pub run_tick: Tick,
    /// The gripper's flange.
    pub flange: BodySnapshot,
    /// The objects, in the order of the scene.
    pub objects: Vec<ObjectSnapshot>,
    /// Contact wrench of the objects on the gripper (N, N m), about the origin of the flange,
    /// flange axes, mean over the tick.
    pub contact_wrench: Wrench,
    /// Reading of a wrist sensor: wrench of the whole gripper on its mount (N, N m), about the
    /// origin of the flange, flange axes, mean over the tick.
    pub mount_wrench: Wrench,
    /// The air in the membrane.
    pub chamber: ChamberSnapshot,
    /// State of the packing, and whether it is within the validity of the contact law.
    pub jamming: JammingSnapshot,
    /// The vertices of the membrane, if selected.
    pub membrane: Option<MembraneSnapshot>,
    /// The grains, if selected.
    pub grains: Option<GrainsSnapshot>,
    /// Contacts between membrane and objects, if selected.
    pub contacts: Option<Vec<ContactSnapshot>>,
    /// Commands applied in this tick and their outcomes.
    pub commands: Vec<CommandRecord>,
    /// Number of commands applied, limited and rejected so far.
    pub command_counts: CommandCounts,
    /// Digest of the whole state.
    pub digest: u64,
}

impl Snapshot {
    /// Contact force of the objects on the gripper (N), world axes, mean over the tick.
    #[must_use]
    pub fn contact_force_world(&self) -> Vec3 {
        self.flange.pose.rotation * self.contact_wrench.force
    }
}

/// Pose and velocity of a body.
#[derive(Clone, Copy, Debug)]
pub struct BodySnapshot {
    /// Pose in the world.
    pub pose: Pose,
    /// Velocity of its origin (m/s, rad/s), world axes.
    pub twist: Twist,
}

/// One object.
#[derive(Clone, Debug)]
pub struct ObjectSnapshot {
    /// Name in the scene.
    pub name: String,
    /// Pose and velocity of the body frame; its origin is the center of mass.
    pub body: BodySnapshot,
    /// Contact wrench of membrane and table on the object (N, N m) about its center of mass,
    /// without gravity, mean over the tick. While the object is driven, the table is excluded.
    pub contact_wrench: Wrench,
    /// The part of it that the membrane exerts (N, N m).
    pub membrane_wrench: Wrench,
    /// True while pose commands drive the object.
    pub is_driven: bool,
}

/// The air in the membrane.
#[derive(Clone, Copy, Debug)]
pub struct ChamberSnapshot {
    /// Commanded gauge pressure, clamped to the range of the pump (Pa).
    pub gauge_setpoint: f64,
    /// Actual gauge pressure (Pa), negative under vacuum.
    pub gauge: f64,
    /// Ambient pressure, absolute (Pa).
    pub ambient: f64,
    /// Volume enclosed by the membrane and the flange (m³).
    pub volume: f64,
}

/// State of the packing.
#[derive(Clone, Copy, Debug, Default)]
pub struct JammingSnapshot {
    /// Contacts between grains.
    pub n_grain_contacts: usize,
    /// Contacts between grains and membrane.
    pub n_membrane_contacts: usize,
    /// Contacts between membrane and objects.
    pub n_object_contacts: usize,
    /// Mean number of contacts per grain.
    pub coordination_number: f64,
    /// Fraction of grains with at least four contacts, which can carry load.
    pub jammed_fraction: f64,
    /// Ratio of the volume of the grains to the enclosed volume.
    pub solid_fraction: f64,
    /// Fraction of the grain contacts that slide.
    pub sliding_fraction: f64,
    /// Kinetic energy of grains and membrane (J).
    pub kinetic_energy: f64,
    /// Largest overlap between grains over the mean grain diameter.
    pub overlap_ratio_max: f64,
    /// Largest overlap between a grain and the membrane over the mean grain diameter.
    pub membrane_overlap_ratio_max: f64,
}

/// The membrane, vertex by vertex in mesh order.
#[derive(Clone, Debug, Default)]
pub struct MembraneSnapshot {
    /// Positions (m).
    pub positions: Vec<Vec3>,
    /// Unit normals, outward.
    pub normals: Vec<Vec3>,
    /// Magnitude of the contact force on each vertex over its area (Pa).
    pub contact_pressures: Vec<f64>,
    /// Mean strain of the springs at each vertex.
    pub strains: Vec<f64>,
}

/// The grains, in the order of their ids.
#[derive(Clone, Debug, Default)]
pub struct GrainsSnapshot {
    /// Positions (m).
    pub positions: Vec<Vec3>,
    /// Radii (m).
    pub radii: Vec<f64>,
    /// Velocities (m/s).
    pub velocities: Vec<Vec3>,
    /// Sum of normal force magnitudes on each grain (N).
    pub normal_forces: Vec<f64>,
}

/// One contact between membrane and object.
#[derive(Clone, Copy, Debug)]
pub struct ContactSnapshot {
    /// Index of the object in the scene.
    pub object: usize,
    /// Contact point, world (m).
    pub point: Vec3,
    /// Unit normal, from the object to the membrane.
    pub normal: Vec3,
    /// Force on the object (N).
    pub force: Vec3,
    /// Normal force, at least zero (N).
    pub normal_force: f64,
    /// Overlap (m).
    pub overlap: f64,
}

/// Selects the large parts of a snapshot. `Parts::default()` selects none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Parts {
    /// The vertices of the membrane.
    pub membrane: bool,
    /// The grains.
    pub grains: bool,
    /// The contacts between membrane and objects.
    pub contacts: bool,
}

impl Parts {
    /// All of them.
    pub const ALL: Self = Self { membrane: true, grains: true, contacts: true };
}
