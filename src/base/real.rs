//! Number types: double precision and nalgebra's vectors. SI units throughout.

/// A real number.
pub type Real = f64;
/// A vector in three dimensions.
pub type Vec3 = nalgebra::Vector3<Real>;
/// A 3 × 3 matrix.
pub type Mat3 = nalgebra::Matrix3<Real>;
/// A rotation.
pub type Quat = nalgebra::UnitQuaternion<Real>;
/// Position and orientation of a frame.
pub type Pose = nalgebra::Isometry3<Real>;

/// Rounds a positive real up to a count of at least 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts stay far below 2^53"
)]
pub fn count(value: Real) -> usize {
    value.ceil().max(1.0) as usize
}

/// A 64-bit count, such as a number of substeps, as a real number.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
pub fn real_of(count: u64) -> Real {
    count as Real
}

/// A count as a real number.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
pub fn real(count: usize) -> Real {
    count as Real
}

/// A small non-negative integer, stored as a real number, as an index.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the number is a small non-negative integer"
)]
#[inline(always)]
pub fn to_index(value: Real) -> usize {
    value as usize
}

/// Linear and angular velocity of a body, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Velocity of the frame's origin (m/s).
    pub linear: Vec3,
    /// Angular velocity (rad/s).
    pub angular: Vec3,
}

impl Twist {
    /// A body at rest.
    pub fn zero() -> Self {
        Self { linear: Vec3::zeros(), angular: Vec3::zeros() }
    }

    /// Velocity (m/s) of the material point at `arm` (m) from the frame's origin.
    pub fn at(&self, arm: &Vec3) -> Vec3 {
        self.linear + self.angular.cross(arm)
    }
}

/// A force and a torque about a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force (N).
    pub force: Vec3,
    /// Torque about the given point (N m).
    pub torque: Vec3,
}

impl Wrench {
    /// No force, no torque.
    pub fn zero() -> Self {
        Self { force: Vec3::zeros(), torque: Vec3::zeros() }
    }
}
