//! What the outside may see: plain, owned SI data, world frame unless a field says otherwise.
//!
//! The small parts are there at every tick; grains, membrane and contacts only when they are due.

pub mod checkpoint; // all that is needed to go on
pub mod due;
pub mod run;
pub mod take;
pub mod view;

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
    /// The tick that ended.
    pub tick: Tick,
    /// Simulated time at its end (ns).
    pub time_ns: u64,
    /// Ticks since the start of the run. Other than `tick` it counts on when time is reset.
    pub run_tick: Tick,
    /// The gripper's flange.
    pub flange: BodySnapshot,
    /// The objects, in the scene's order.
    pub objects: Vec<ObjectSnapshot>,
    /// Contact wrench of the objects on the gripper, about the flange's origin, flange axes,
    /// mean over the tick.
    pub contact_wrench: Wrench,
    /// Wrench that the whole gripper puts on its mount (what a wrist sensor reads), about the
    /// flange's origin, flange axes, mean over the tick.
    pub mount_wrench: Wrench,
    /// The air.
    pub chamber: ChamberSnapshot,
    /// How jammed the grains are, and whether the model is still valid.
    pub jamming: JammingSnapshot,
    /// The membrane's vertices, when due.
    pub membrane: Option<MembraneSnapshot>,
    /// The grains, when due.
    pub grains: Option<GrainsSnapshot>,
    /// Contacts between membrane and objects, when due.
    pub contacts: Option<Vec<ContactSnapshot>>,
    /// Commands that this tick was given, with their fate.
    pub commands: Vec<CommandRecord>,
    /// How many commands were applied, limited and refused so far.
    pub command_counts: CommandCounts,
    /// Digest of the whole state.
    pub digest: u64,
}

impl Snapshot {
    /// Force of the object on the gripper, world axes (N).
    pub fn contact_force_world(&self) -> Vec3 {
        self.flange.pose.rotation * self.contact_wrench.force
    }
}

/// Pose and velocity of a body.
#[derive(Clone, Copy, Debug)]
pub struct BodySnapshot {
    /// Pose in the world.
    pub pose: Pose,
    /// Velocity of the frame's origin.
    pub twist: Twist,
}

/// One object.
#[derive(Clone, Debug)]
pub struct ObjectSnapshot {
    /// Name in the scene.
    pub name: String,
    /// Pose of the body frame, whose origin is the centre of mass, and velocity.
    pub body: BodySnapshot,
    /// Total contact wrench (membrane and table) about the centre of mass, gravity excluded,
    /// mean over the tick; the membrane's share alone while the object is driven.
    pub contact_wrench: Wrench,
    /// The membrane's share of it.
    pub membrane_wrench: Wrench,
    /// True while pose commands drive the object.
    pub is_driven: bool,
}

/// The air in the membrane.
#[derive(Clone, Copy, Debug)]
pub struct ChamberSnapshot {
    /// Commanded gauge pressure after limits (Pa).
    pub gauge_setpoint: f64,
    /// Actual gauge pressure (Pa), negative under vacuum.
    pub gauge: f64,
    /// Ambient pressure, absolute (Pa).
    pub ambient: f64,
    /// Volume enclosed by membrane and flange (m³).
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
    /// Share of grains with at least four contacts, those that can carry load.
    pub jammed_fraction: f64,
    /// Grain volume over enclosed volume.
    pub solid_fraction: f64,
    /// Share of sliding contacts among grain contacts.
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

/// The grains, in order of their ids.
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
    /// Contact point (m).
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

/// Parts of a snapshot that are large and not taken at every tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Parts {
    /// The membrane's vertices.
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
