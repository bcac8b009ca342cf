//! What a scene is once its text has been read and checked: SI numbers, nothing optional that the
//! physics needs.
//!
//! `text` is the way from YAML to here: `yaml` makes a tree with places, `schema` walks its keys
//! with their units and limits, `check` joins them; all faults come at once. `print` goes back.

pub mod builder; // a base scene with changed keys
pub mod error; // what can be wrong with a scene
pub mod json; // YAML to JSON
pub mod print; // scene to text
pub mod quantity; // "2 mm"
pub mod reference; // keys for documentation and editors
pub mod resource; // objects described in other files
pub mod ros_parameters; // parameter files
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
    /// Seed of all random streams.
    pub seed: u64,
    /// Ticks and substeps.
    pub time: Time,
    /// Gravity (m/s²).
    pub gravity: Vec3,
    /// The grains.
    pub grains: Grains,
    /// The flexible bag.
    pub membrane: Membrane,
    /// The air in the bag.
    pub chamber: Chamber,
    /// The kinematic plate that holds the bag.
    pub flange: Flange,
    /// The table under the objects.
    pub table: Table,
    /// The objects. The YAML has one, under `object`.
    pub objects: Vec<Object>,
    /// Who gives commands.
    pub controller: Controller,
    /// What is published, and how often.
    pub outputs: Outputs,
}

/// How time is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    /// Length of a tick (ns).
    pub tick_ns: u64,
    /// Substep set by hand (s); `None` derives it from material and mesh.
    pub substep: Option<Real>,
    /// Fraction of the critical step that a derived substep takes.
    pub safety: Real,
    /// Inertia of grains and membrane over their real one, for longer substeps [-].
    pub density_scaling: Real,
}

/// Surface and bulk of a material in the contact law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus (Pa).
    pub youngs_modulus: Real,
    /// Poisson's ratio.
    pub poisson_ratio: Real,
    /// Density (kg/m³).
    pub density: Real,
}

/// The granulate.
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
    /// Coulomb friction between grains, and of grains with the flange's plate.
    pub friction: Real,
    /// Dissipation time A of the viscoelastic normal force (s).
    pub dissipation_time: Real,
    /// Damping of the tangential spring γ_t.
    pub tangential_damping: Real,
}

/// The bag: the lower half of an icosphere, clamped to the flange at its rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Membrane {
    /// Radius of the half sphere (m).
    pub radius: Real,
    /// Subdivision frequency of the icosphere, even; 16 gives 1321 vertices.
    pub frequency: usize,
    /// Thickness (m).
    pub thickness: Real,
    /// Material of the sheet and of its contacts.
    pub material: Material,
    /// Coulomb friction with grains.
    pub friction: Real,
    /// Damping ratio of the springs γ_sp.
    pub spring_damping: Real,
    /// Elastic bending constant of the hinges k_el (N m).
    pub bending_stiffness: Real,
    /// Dissipative bending constant of the hinges k_diss (N s).
    pub bending_damping: Real,
    /// Share by which the springs' rest lengths are shortened after filling.
    pub rest_length_shrink: Real,
    /// Radius the bag is held at while it is filled, over `radius`.
    pub fill_stretch: Real,
    /// Dissipation time A of the contacts (s).
    pub dissipation_time: Real,
    /// Damping of the tangential spring γ_t of the contacts.
    pub tangential_damping: Real,
}

/// The air and its pump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chamber {
    /// Ambient pressure, absolute (Pa).
    pub ambient: Real,
    /// Strongest vacuum [Pa gauge], negative.
    pub gauge_min: Real,
    /// Strongest overpressure [Pa gauge], at least 0.
    pub gauge_max: Real,
    /// Time constant of the first-order lag (s).
    pub lag: Real,
    /// Largest rate of the pressure (Pa/s).
    pub rate_max: Real,
}

/// The plate that the bag hangs from. Its frame `gripper_flange` lies in the rim's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flange {
    /// Pose at the start.
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
    /// Coulomb friction with objects.
    pub friction: Real,
}

/// A rigid body to be gripped.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Name, part of topic and frame names.
    pub name: String,
    /// Its shape, about the shape's own origin.
    pub shape: Shape,
    /// Material of the contact law; the density gives the mass.
    pub material: Material,
    /// Coulomb friction with the membrane.
    pub friction: Real,
    /// Pose of the shape's origin at the start.
    pub pose: Pose,
    /// Time without pose commands after which a driven object is given back to dynamics (s).
    pub drive_timeout: Real,
}

/// Shape of an object. Cylinder and capsule have their axis along z.
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
    /// A cylinder with half spheres at its ends.
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
    /// A closed triangle mesh, outward oriented.
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

/// Who gives commands.
#[derive(Clone, Debug, PartialEq)]
pub enum Controller {
    /// The pick-and-lift state machine inside the process.
    Builtin(PickAndLift),
    /// Commands come from ROS 2 topics; the run waits at its start for a first one.
    Topics {
        /// Simulated time after which the run ends; `None` runs until it is stopped (s).
        duration: Option<Real>,
        /// Whether ticks wait for commands.
        lockstep: Lockstep,
    },
}

/// Whether ticks wait for commands or another simulator's clock, and for how long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lockstep {
    /// True if they do: a command stamped not before the present time lets time go on.
    pub is_on: bool,
    /// True if time follows `/clock`, which another simulator publishes; it is not published here.
    pub follows_clock: bool,
    /// How many ticks such a command lets pass.
    pub steps_per_command: u64,
    /// Wall time after which a command is missed; `None` waits for ever (s).
    pub timeout: Option<Real>,
    /// What is done then.
    pub on_timeout: OnTimeout,
}

impl Lockstep {
    /// Ticks wait for nobody.
    pub const OFF: Self = Self {
        is_on: false,
        follows_clock: false,
        steps_per_command: 1,
        timeout: None,
        on_timeout: OnTimeout::Hold,
    };
}

/// What is done when a command is missed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnTimeout {
    /// One goes on waiting; it is said once.
    Hold,
    /// The simulation is paused.
    Pause,
    /// The run ends.
    End,
}

/// Parameters of the pick-and-lift state machine.
#[derive(Clone, Debug, PartialEq)]
pub struct PickAndLift {
    /// Object to pick.
    pub object: String,
    /// Height of the flange over the table while it travels [m]: where it starts.
    pub approach_speed: Real,
    /// Contact force that counts as touch (N).
    pub touch_force: Real,
    /// Speed while pushing in (m/s).
    pub push_speed: Real,
    /// How far the flange goes on after touch (m).
    pub push_depth: Real,
    /// Push force at which it stops earlier (N).
    pub push_force_max: Real,
    /// Time to relax after pushing (s).
    pub settle_time: Real,
    /// Gauge pressure while gripping (Pa).
    pub grip_pressure: Real,
    /// Share of the grip pressure that must be reached before lifting.
    pub grip_pressure_reached: Real,
    /// Lifting speed (m/s).
    pub lift_speed: Real,
    /// Lifting height (m).
    pub lift_height: Real,
    /// Time to hold the object up (s).
    pub hold_time: Real,
    /// Blow-off pressure for letting go [Pa gauge].
    pub vent_pressure: Real,
    /// Time to vent (s).
    pub vent_time: Real,
    /// How far the flange retreats at the end (m).
    pub retreat_height: Real,
}

/// What leaves the process. Rates are in simulated time.
#[derive(Clone, Debug, PartialEq)]
pub struct Outputs {
    /// Wrenches, object and flange state, tf, joint states (Hz).
    pub state_rate: Real,
    /// Pressure and vacuum state (Hz).
    pub pressure_rate: Real,
    /// Membrane vertices (Hz).
    pub membrane_rate: Real,
    /// Grains (Hz).
    pub grains_rate: Real,
    /// Contacts and their markers (Hz).
    pub contacts_rate: Real,
    /// Statistics (Hz).
    pub statistics_rate: Real,
    /// Most grains in one ROS 2 message; larger packings are thinned out there.
    pub grains_count_max: usize,
    /// ROS 2.
    pub ros: Ros,
    /// Zero-copy streams.
    pub stream: bool,
    /// Recording.
    pub bag: Bag,
    /// True keeps to real time where the machine is faster than that.
    pub real_time: bool,
}

/// How the node joins ROS 2.
#[derive(Clone, Debug, PartialEq)]
pub struct Ros {
    /// False leaves ROS 2 out.
    pub enabled: bool,
    /// Domain; `None` takes `ROS_DOMAIN_ID`, else 0.
    pub domain_id: Option<u16>,
    /// True joins the local network; otherwise only this host.
    pub lan: bool,
    /// Full name of the node.
    pub node: String,
    /// Names that are replaced, and by what; said on the command line only.
    pub remaps: Vec<(String, String)>,
    /// Wire format of `simulation_interfaces`, 1 or 2; `None` takes that of `ROS_DISTRO`, else 2.
    pub interfaces_version: Option<u8>,
    /// Where else the services of `simulation_interfaces` are offered, such as `/gzserver`.
    pub interfaces_prefix: Option<String>,
    /// True keeps time going through resets, so that controllers and frames survive them.
    pub monotonic_clock: bool,
}

impl Ros {
    /// ROS 2 left out, and nothing chosen.
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

/// Recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Bag {
    /// False records nothing.
    pub enabled: bool,
    /// Folder of the recording; `None` makes one under `bags/` named by scene and time.
    pub folder: Option<PathBuf>,
    /// What to do when the writer is behind.
    pub on_full: OnFull,
    /// What to do when the disk is full or the folder cannot be written.
    pub on_error: OnError,
    /// How often all that is needed to go on is kept, in simulated time (Hz); `None` keeps only
    /// the start.
    pub checkpoint_rate: Option<Real>,
    /// How messages are compressed.
    pub compression: BagCompression,
    /// A file that has become as long as this is followed by another [MiB].
    pub split_size: Option<u64>,
    /// A file that has become as old as this is followed by another, in simulated time (s).
    pub split_duration: Option<Real>,
}

/// How a recording compresses its messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BagCompression {
    /// Small, and fast enough.
    Zstd,
    /// Faster, larger.
    Lz4,
    /// As they are.
    Uncompressed,
}

/// What a recording does when its queue is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnFull {
    /// The run waits: nothing is lost.
    Wait,
    /// The oldest snapshot is dropped and counted.
    DropOldest,
}

/// What a run does when its recording fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnError {
    /// It goes on without recording.
    Continue,
    /// It stops.
    Stop,
}
