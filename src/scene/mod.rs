//! A scene that has been read and checked: SI numbers, and everything that the physics needs.
//!
//! `text` reads a scene: `yaml` parses the text into a tree with locations, `schema` visits the keys
//! with their units and limits, `check` applies rules that involve several keys. All errors are
//! reported at once. `print` writes a scene.

pub mod builder; // a base scene with changed keys
pub mod error; // errors in scenes
pub mod json; // YAML to JSON
pub mod print; // scene to text
pub mod quantity; // numbers with units: "2 mm"
pub mod reference; // documentation and JSON Schema of all keys
pub mod resource; // objects and scenes from files: YAML, URDF
pub mod ros_parameters; // ROS 2 parameter files
pub mod text; // text to scene

mod check;
mod extent;
pub(crate) mod keys;
mod mesh_file;
mod read;
pub(crate) mod schema;
mod schema_outputs;
mod tree;
#[cfg(feature = "meshes")]
mod urdf;
pub(crate) mod unset;
pub(crate) mod visit;
mod yaml;

pub use builder::SceneBuilder;
pub use error::SceneError;
pub use print::to_yaml;
pub use text::{load, parse};

use std::path::PathBuf;

use crate::base::{Pose, Real, Vec3};

/// A complete, checked scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Name of the scene.
    pub name: String,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Ticks and substeps.
    pub time: Time,
    /// Gravity (m/s²).
    pub gravity: Vec3,
    /// The grains.
    pub grains: Grains,
    /// The membrane.
    pub membrane: Membrane,
    /// The air inside the membrane.
    pub chamber: Chamber,
    /// The kinematic plate that holds the membrane.
    pub flange: Flange,
    /// The table under the objects.
    pub table: Table,
    /// The objects. A scene file has one, under `object`.
    pub objects: Vec<Object>,
    /// Source of commands.
    pub controller: Controller,
    /// What is published and recorded, and how often.
    pub outputs: Outputs,
}

/// Time stepping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    /// Length of a tick (ns).
    pub tick_ns: u64,
    /// Substep (s); `None` derives it from materials and mesh.
    pub substep: Option<Real>,
    /// Fraction of the critical step that a derived substep takes.
    pub safety: Real,
    /// Factor on the inertia of grains and membrane, for longer substeps (-).
    pub density_scaling: Real,
}

/// Parameters of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus (Pa).
    pub youngs_modulus: Real,
    /// Poisson's ratio.
    pub poisson_ratio: Real,
    /// Density (kg/m³).
    pub density: Real,
}

/// The grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grains {
    /// Number of grains.
    pub count: usize,
    /// Smallest radius (m).
    pub radius_min: Real,
    /// Largest radius (m).
    pub radius_max: Real,
    /// Material of the grains.
    pub material: Material,
    /// Coulomb friction coefficient between grains, and of grains with the plate of the flange.
    pub friction: Real,
    /// Dissipation time A of the viscoelastic normal force (s).
    pub dissipation_time: Real,
    /// Damping ratio γ_t of the tangential spring.
    pub tangential_damping: Real,
}

/// The membrane: the lower half of an icosphere, clamped to the flange at its rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Membrane {
    /// Radius of the half sphere (m).
    pub radius: Real,
    /// Subdivision frequency of the icosphere, even; 16 gives 1321 vertices.
    pub frequency: usize,
    /// Thickness (m).
    pub thickness: Real,
    /// Material of the membrane and of its contacts.
    pub material: Material,
    /// Coulomb friction coefficient with grains.
    pub friction: Real,
    /// Damping ratio γ_sp of the springs.
    pub spring_damping: Real,
    /// Elastic bending constant k_el of the hinges (N m).
    pub bending_stiffness: Real,
    /// Viscous bending constant k_diss of the hinges (N s).
    pub bending_damping: Real,
    /// Fraction by which the rest lengths of the springs shrink after filling.
    pub rest_length_shrink: Real,
    /// Ratio of the radius at which the membrane is held while it is filled to `radius`.
    pub fill_stretch: Real,
    /// Dissipation time A of the contacts (s).
    pub dissipation_time: Real,
    /// Damping ratio γ_t of the tangential spring of the contacts.
    pub tangential_damping: Real,
}

/// The air inside the membrane, and its pump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chamber {
    /// Ambient pressure, absolute (Pa).
    pub ambient: Real,
    /// Strongest vacuum, a negative gauge pressure (Pa).
    pub gauge_min: Real,
    /// Strongest overpressure, a gauge pressure of at least 0 (Pa).
    pub gauge_max: Real,
    /// Time constant of the first-order lag (s).
    pub lag: Real,
    /// Largest rate of change of the pressure (Pa/s).
    pub rate_max: Real,
}

/// The plate from which the membrane hangs. The origin of its frame `gripper_flange` lies in the
/// plane of the rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flange {
    /// Initial pose.
    pub pose: Pose,
    /// Largest linear speed (m/s).
    pub speed_max: Real,
    /// Largest linear acceleration (m/s²).
    pub acceleration_max: Real,
    /// Largest angular speed (rad/s).
    pub angular_speed_max: Real,
    /// Largest angular acceleration (rad/s²).
    pub angular_acceleration_max: Real,
}

/// A horizontal table: the upper face of a rigid slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// Height of the upper face (m).
    pub height: Real,
    /// Coulomb friction coefficient with objects.
    pub friction: Real,
}

/// A rigid body to grip.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Name; part of the names of its topics and of its frame.
    pub name: String,
    /// Shape, in the object's own frame.
    pub shape: Shape,
    /// Material; the density gives the mass.
    pub material: Material,
    /// Coulomb friction coefficient with the membrane.
    pub friction: Real,
    /// Initial pose of the shape's origin.
    pub pose: Pose,
    /// Simulated time without pose commands after which a driven object moves freely again (s).
    pub drive_timeout: Real,
}

/// Shape of an object. The axis of a cylinder or capsule is z.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A sphere.
    Sphere {
        /// Radius (m).
        radius: Real,
    },
    /// A box.
    Box {
        /// Edge lengths (m).
        size: Vec3,
    },
    /// A cylinder.
    Cylinder {
        /// Radius (m).
        radius: Real,
        /// Height (m).
        height: Real,
    },
    /// A cylinder with hemispheres at its ends.
    Capsule {
        /// Radius (m).
        radius: Real,
        /// Total height (m).
        height: Real,
    },
    /// The convex hull of points.
    ConvexHull {
        /// Points (m).
        points: Vec<Vec3>,
    },
    /// A closed triangle mesh with outward orientation.
    Mesh {
        /// The file it was read from.
        file: PathBuf,
        /// Length of one unit of the file (m).
        unit: Real,
        /// Vertices (m).
        vertices: Vec<Vec3>,
        /// Vertex indices of each triangle.
        triangles: Vec<[u32; 3]>,
    },
}

/// Source of commands.
#[derive(Clone, Debug, PartialEq)]
pub enum Controller {
    /// The built-in pick-and-lift state machine.
    Builtin(PickAndLift),
    /// ROS 2 topics. The run waits for the first command before it starts.
    Topics {
        /// Simulated time after which the run ends (s); `None` runs until it is stopped.
        duration: Option<Real>,
        /// What time waits for.
        lockstep: Lockstep,
    },
}

/// Lockstep: whether ticks wait for commands or for the clock of another simulator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lockstep {
    /// True if ticks wait for commands: a command stamped not before the current time advances it.
    pub is_on: bool,
    /// True if time follows `/clock` of another simulator. This node then does not publish it.
    pub follows_clock: bool,
    /// Number of ticks per command.
    pub steps_per_command: u64,
    /// Wall-clock time to wait for a command (s); `None` waits without limit.
    pub timeout: Option<Real>,
    /// What happens after this time.
    pub on_timeout: OnTimeout,
}

impl Lockstep {
    /// Ticks do not wait.
    pub const OFF: Self = Self {
        is_on: false,
        follows_clock: false,
        steps_per_command: 1,
        timeout: None,
        on_timeout: OnTimeout::Hold,
    };
}

/// What happens when a command does not arrive in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnTimeout {
    /// Keep waiting; log once.
    Hold,
    /// Pause the simulation.
    Pause,
    /// End the run.
    End,
}

/// Parameters of the pick-and-lift state machine.
#[derive(Clone, Debug, PartialEq)]
pub struct PickAndLift {
    /// Object to pick.
    pub object: String,
    /// Height of the flange above the table while it travels: its initial height (m).
    pub approach_speed: Real,
    /// Contact force that counts as touch (N).
    pub touch_force: Real,
    /// Speed while it pushes onto the object (m/s).
    pub push_speed: Real,
    /// Distance to push after touch (m).
    pub push_depth: Real,
    /// Force at which it stops pushing earlier (N).
    pub push_force_max: Real,
    /// Pause after pushing (s).
    pub settle_time: Real,
    /// Gauge pressure while it grips (Pa).
    pub grip_pressure: Real,
    /// Fraction of the grip pressure that must be reached before it lifts.
    pub grip_pressure_reached: Real,
    /// Lifting speed (m/s).
    pub lift_speed: Real,
    /// Lifting height (m).
    pub lift_height: Real,
    /// Time to hold the object up (s).
    pub hold_time: Real,
    /// Gauge pressure to release the object (Pa).
    pub vent_pressure: Real,
    /// Time to vent (s).
    pub vent_time: Real,
    /// Distance to retreat at the end (m).
    pub retreat_height: Real,
}

/// What is published and recorded. Rates are in simulated time.
#[derive(Clone, Debug, PartialEq)]
pub struct Outputs {
    /// Rate of wrenches, object and flange states, tf and joint states (Hz).
    pub state_rate: Real,
    /// Rate of pressure and vacuum state (Hz).
    pub pressure_rate: Real,
    /// Rate of the membrane's vertices (Hz).
    pub membrane_rate: Real,
    /// Rate of grains (Hz).
    pub grains_rate: Real,
    /// Rate of contacts and their markers (Hz).
    pub contacts_rate: Real,
    /// Rate of statistics (Hz).
    pub statistics_rate: Real,
    /// Maximum number of grains in one ROS 2 message; larger packings are thinned out.
    pub grains_count_max: usize,
    /// The ROS 2 node.
    pub ros: Ros,
    /// Whether shared memory streams are published.
    pub stream: bool,
    /// The recording.
    pub bag: Bag,
    /// True if the run must not be faster than real time.
    pub real_time: bool,
}

/// The ROS 2 node.
#[derive(Clone, Debug, PartialEq)]
pub struct Ros {
    /// False disables ROS 2.
    pub enabled: bool,
    /// DDS domain; `None` takes `ROS_DOMAIN_ID`, or 0.
    pub domain_id: Option<u16>,
    /// True discovers nodes on the local network; false only on this host.
    pub lan: bool,
    /// Full name of the node.
    pub node: String,
    /// Remapped names: from, to. Only the command line sets them.
    pub remaps: Vec<(String, String)>,
    /// Wire format of `simulation_interfaces`, 1 or 2; `None` takes that of `ROS_DISTRO`, or 2.
    pub interfaces_version: Option<u8>,
    /// Second prefix for the services of `simulation_interfaces`, such as `/gzserver`.
    pub interfaces_prefix: Option<String>,
    /// True keeps time running through resets, so that controllers and tf buffers survive them.
    pub monotonic_clock: bool,
}

impl Ros {
    /// ROS 2 disabled, all else unset.
    pub const OFF: Self = Self {
        enabled: false,
        domain_id: None,
        lan: false,
        node: String::new(),
        remaps: Vec::new(),
        interfaces_version: None,
        interfaces_prefix: None,
        monotonic_clock: false,
    };
}

/// The recording of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Bag {
    /// False disables recording.
    pub enabled: bool,
    /// Folder of the recording; `None` creates `bags/SCENE_TIME`.
    pub folder: Option<PathBuf>,
    /// What to do when the disk is too slow.
    pub on_full: OnFull,
    /// What to do when the disk is full or the folder cannot be written.
    pub on_error: OnError,
    /// Rate of checkpoints, from which a run can be resumed, in simulated time (Hz); `None` keeps
    /// only the start.
    pub checkpoint_rate: Option<Real>,
    /// Compression of the messages.
    pub compression: BagCompression,
    /// Size at which a new file is started (MiB).
    pub split_size: Option<u64>,
    /// Simulated time after which a new file is started (s).
    pub split_duration: Option<Real>,
}

/// Compression of the messages of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BagCompression {
    /// Zstandard: smaller files.
    Zstd,
    /// LZ4: faster, larger files.
    Lz4,
    /// No compression.
    Uncompressed,
}

/// What a recording does when its queue is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnFull {
    /// The run waits; nothing is lost.
    Wait,
    /// The oldest snapshot is dropped and counted.
    DropOldest,
}

/// What a run does when its recording fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnError {
    /// The run continues without recording.
    Continue,
    /// The run stops.
    Stop,
}
