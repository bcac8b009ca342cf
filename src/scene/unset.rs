//! A scene before it is read. Every number is NaN, so that a value that is never read is noticed.

use super::{
    Bag, BagCompression, Chamber, Controller, Flange, Grains, Lockstep, Material, Membrane, Object,
    OnError, OnFull, Outputs, Ros, Scene, Shape, Table, Time,
};
use crate::base::{Pose, Real, Vec3};

/// A value before it is read: NaN, zero or empty.
pub(crate) trait Unset {
    /// Returns the unset value.
    fn unset() -> Self;
}

/// Types with the constant that stands for their unset value.
macro_rules! unset {
    ($($type:ty = $value:expr),* $(,)?) => { $(
        impl Unset for $type {
            fn unset() -> Self {
                $value
            }
        }
    )* };
}

unset!(
    Real = NAN,
    u64 = 0,
    usize = 0,
    bool = false,
    String = String::new(),
    Vec3 = Vec3::repeat(NAN),
    Time = TIME,
    Material = MATERIAL,
    Grains = GRAINS,
    Membrane = MEMBRANE,
    Chamber = CHAMBER,
);

impl<T> Unset for Vec<T> {
    fn unset() -> Self {
        Self::new()
    }
}

impl<T> Unset for Option<T> {
    fn unset() -> Self {
        None
    }
}

impl<T: Unset, const N: usize> Unset for [T; N] {
    fn unset() -> Self {
        std::array::from_fn(|_| T::unset())
    }
}

const NAN: Real = Real::NAN;
const TIME: Time = Time { tick_ns: 0, substep: None, safety: NAN, density_scaling: NAN };
const MATERIAL: Material = Material { youngs_modulus: NAN, poisson_ratio: NAN, density: NAN };
const GRAINS: Grains = Grains {
    count: 0,
    radius_min: NAN,
    radius_max: NAN,
    material: MATERIAL,
    friction: NAN,
    dissipation_time: NAN,
    tangential_damping: NAN,
};
const MEMBRANE: Membrane = Membrane {
    radius: NAN,
    frequency: 0,
    thickness: NAN,
    material: MATERIAL,
    friction: NAN,
    spring_damping: NAN,
    bending_stiffness: NAN,
    bending_damping: NAN,
    rest_length_shrink: NAN,
    fill_stretch: NAN,
    dissipation_time: NAN,
    tangential_damping: NAN,
};
const CHAMBER: Chamber =
    Chamber { ambient: NAN, gauge_min: NAN, gauge_max: NAN, lag: NAN, rate_max: NAN };

/// The unset scene, with one unset object.
pub(crate) fn scene() -> Scene {
    Scene {
        name: String::new(),
        seed: 0,
        time: TIME,
        gravity: Vec3::repeat(NAN),
        grains: GRAINS,
        membrane: MEMBRANE,
        chamber: CHAMBER,
        flange: Flange {
            pose: Pose::identity(),
            speed_max: NAN,
            acceleration_max: NAN,
            angular_speed_max: NAN,
            angular_acceleration_max: NAN,
        },
        table: Table { height: NAN, friction: NAN },
        objects: vec![object()],
        controller: Controller::Topics { duration: None, lockstep: Lockstep::OFF },
        outputs: outputs(),
    }
}

fn object() -> Object {
    Object {
        name: String::new(),
        shape: Shape::Sphere { radius: NAN },
        material: MATERIAL,
        friction: NAN,
        pose: Pose::identity(),
        drive_timeout: NAN,
    }
}

fn outputs() -> Outputs {
    Outputs {
        state_rate: NAN,
        pressure_rate: NAN,
        membrane_rate: NAN,
        grains_rate: NAN,
        contacts_rate: NAN,
        statistics_rate: NAN,
        grains_count_max: 0,
        ros: Ros::OFF,
        stream: false,
        bag: Bag {
            enabled: false,
            folder: None,
            on_full: OnFull::Wait,
            on_error: OnError::Continue,
            checkpoint_rate: None,
            compression: BagCompression::Zstd,
            split_size: None,
            split_duration: None,
        },
        real_time: false,
    }
}
