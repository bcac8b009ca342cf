//! What the outside may do to the world between two ticks, and no body could do by moving: put
//! things elsewhere, add and remove them, go back to the start.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{
    base::{Pose, real::Twist},
    scene::{Object, Scene},
};

/// One change. Like a command it is a plain value: equal changes at equal ticks give equal bits.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Goes back to the start.
    Reset(Scope),
    /// Puts an object elsewhere, at once.
    PlaceObject {
        /// Name of the object.
        object: String,
        /// Pose of its centre of mass in the world.
        pose: Pose,
        /// Velocity of its centre of mass, world axes.
        twist: Twist,
    },
    /// Puts the gripper elsewhere, at once: flange, membrane and grains as one, and at rest.
    PlaceFlange {
        /// Pose of the flange in the world.
        pose: Pose,
    },
    /// What the wrist sensor reads now is zero from here on.
    ZeroForceSensor,
    /// Changes a property of materials or pump.
    SetParameter {
        /// Which.
        parameter: TunableParameter,
        /// Its new value, SI.
        value: f64,
    },
    /// Adds an object. Its pose is that of its shape's origin.
    Insert(Box<Object>),
    /// Takes an object away.
    Remove {
        /// Name of the object.
        object: String,
    },
    /// Another scene takes the place of this one.
    LoadScene(Box<SettledScene>),
}

/// A scene that can begin at once.
#[derive(Clone, PartialEq)]
pub struct SettledScene {
    /// The scene; its ticks are as long as those of the one before.
    pub scene: Scene,
    /// Its settled bag, as a cache of start states keeps it.
    pub start: Vec<u8>,
    /// True lets simulated time go on; otherwise it is zero again.
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
            Self::PlaceObject { object, .. } => write!(f, "`{object}` put elsewhere"),
            Self::PlaceFlange { .. } => f.write_str("the gripper put elsewhere"),
            Self::Insert(object) => write!(f, "object `{}` added", object.name),
            Self::Remove { object } => write!(f, "object `{object}` taken away"),
            Self::ZeroForceSensor => f.write_str("wrist sensor set to zero"),
            Self::SetParameter { parameter, value } => write!(f, "{parameter:?} set to {value}"),
            Self::LoadScene(it) => write!(f, "scene `{}` loaded", it.scene.name),
        }
    }
}

/// A property that may change while time goes on. New ones come last: recordings hold their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TunableParameter {
    /// Time constant of pump and line (s).
    ChamberLag,
    /// Largest rate of the pressure (Pa/s).
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
    /// Its value in a scene, SI.
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

    /// Changes a scene.
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

    /// Smallest and largest sensible value, SI.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::ChamberLag => [1e-3, 60.0],
            Self::ChamberRateMax => [1e3, 1e8],
            Self::GrainDissipationTime => [0.0, 1e-4],
            Self::GrainFriction | Self::MembraneFriction | Self::ObjectFriction => [0.0, 5.0],
        }
    }
}

/// What goes back to the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Scope {
    /// Simulated time becomes zero.
    pub time: bool,
    /// Poses, velocities, forces, pressure and commands are those of the start; objects of the
    /// scene that were removed are back.
    pub state: bool,
    /// Objects that were added are gone.
    pub spawned: bool,
}

impl Scope {
    /// Everything goes back.
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
