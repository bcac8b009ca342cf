//! Discontinuous changes between ticks: teleport, insert, remove, reset, load.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{
    base::{Pose, real::Twist},
    scene::{Object, Scene},
};

/// A discontinuous change. Equal changes at equal ticks give equal bits.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Resets to the start.
    Reset(Scope),
    /// Teleports an object.
    PlaceObject {
        /// Name of the object.
        object: String,
        /// Pose of its center of mass in the world.
        pose: Pose,
        /// Velocity of its center of mass (m/s, rad/s), world axes.
        twist: Twist,
    },
    /// Teleports the gripper: flange, membrane and grains as one, and at rest.
    PlaceFlange {
        /// Pose of the flange in the world.
        pose: Pose,
    },
    /// Zeroes the wrist sensor at its current reading.
    ZeroForceSensor,
    /// Sets a parameter of a material or the pump.
    SetParameter {
        /// The parameter.
        parameter: TunableParameter,
        /// Its new value, SI.
        value: f64,
    },
    /// Adds an object. Its pose is that of its shape's origin.
    Insert(Box<Object>),
    /// Removes an object.
    Remove {
        /// Name of the object.
        object: String,
    },
    /// Replaces the scene.
    LoadScene(Box<SettledScene>),
}

/// A scene with its settled state.
#[derive(Clone, PartialEq)]
pub struct SettledScene {
    /// The scene; the length of its ticks is that of the current scene.
    pub scene: Scene,
    /// Its settled state, from `Session::start_state`.
    pub start: Vec<u8>,
    /// True continues simulated time; false resets it to zero.
    pub keeps_time: bool,
}

impl fmt::Debug for SettledScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scene, start, keeps_time } = self;
        write!(f, "{scene:?}, start of {} bytes, keeps time: {keeps_time}", start.len())
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reset(scope) => write!(f, "reset of {scope}"),
            Self::PlaceObject { object, .. } => write!(f, "`{object}` moved"),
            Self::PlaceFlange { .. } => f.write_str("gripper moved"),
            Self::Insert(object) => write!(f, "object `{}` added", object.name),
            Self::Remove { object } => write!(f, "object `{object}` removed"),
            Self::ZeroForceSensor => f.write_str("wrist sensor zeroed"),
            Self::SetParameter { parameter, value } => write!(f, "{parameter:?} set to {value}"),
            Self::LoadScene(it) => write!(f, "scene `{}` loaded", it.scene.name),
        }
    }
}

/// A parameter that may change during a run. New ones go last, because recordings hold their index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TunableParameter {
    /// Time constant of the pump and its line (s).
    ChamberLag,
    /// Maximum rate of the pressure (Pa/s).
    ChamberRateMax,
    /// Dissipation time of contacts between grains (s).
    GrainDissipationTime,
    /// Friction between grains.
    GrainFriction,
    /// Friction of grains on the membrane.
    MembraneFriction,
    /// Friction of all objects on the membrane.
    ObjectFriction,
}

impl TunableParameter {
    /// Its value in a scene (SI).
    pub fn get(self, scene: &Scene) -> f64 {
        match self {
            Self::ChamberLag => scene.chamber.lag,
            Self::ChamberRateMax => scene.chamber.rate_max,
            Self::GrainDissipationTime => scene.grains.dissipation_time,
            Self::GrainFriction => scene.grains.friction,
            Self::MembraneFriction => scene.membrane.friction,
            Self::ObjectFriction => scene.objects.first().map_or(0.0, |it| it.friction),
        }
    }

    /// Sets it in a scene (SI).
    pub fn set(self, scene: &mut Scene, value: f64) {
        match self {
            Self::ChamberLag => scene.chamber.lag = value,
            Self::ChamberRateMax => scene.chamber.rate_max = value,
            Self::GrainDissipationTime => scene.grains.dissipation_time = value,
            Self::GrainFriction => scene.grains.friction = value,
            Self::MembraneFriction => scene.membrane.friction = value,
            Self::ObjectFriction => scene.objects.iter_mut().for_each(|it| it.friction = value),
        }
    }

    /// Smallest and largest allowed value (SI).
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::ChamberLag => [1e-3, 60.0],
            Self::ChamberRateMax => [1e3, 1e8],
            Self::GrainDissipationTime => [0.0, 1e-4],
            Self::GrainFriction | Self::MembraneFriction | Self::ObjectFriction => [0.0, 5.0],
        }
    }
}

/// What a reset restores.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Scope {
    /// Simulated time becomes zero.
    pub time: bool,
    /// Poses, velocities, forces, pressure and setpoints become those of the start; removed objects
    /// of the scene return.
    pub state: bool,
    /// Inserted objects are removed.
    pub spawned: bool,
}

impl Scope {
    /// Everything.
    pub const ALL: Self = Self { time: true, state: true, spawned: true };
}

impl fmt::Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = [(self.time, "time"), (self.state, "state"), (self.spawned, "added objects")];
        let named: Vec<&str> = parts.iter().filter(|(is_in, _)| *is_in).map(|it| it.1).collect();
        f.write_str(if named.is_empty() { "nothing" } else { "" })?;
        f.write_str(&named.join(", "))
    }
}
