//! Walls as parts of a system.

use crate::{
    base::{Pose, Real, Vec3},
    physics::{
        boundary::{
            motion::WallMotion,
            triangles::Triangles,
            wall::{CARRIER, WallShape},
        },
        law::PairLaw,
    },
};

/// Index of a wall in its system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct WallId(pub(super) u32);

impl WallId {
    /// The carrier, which is the first wall that is added. See `boundary::wall::CARRIER`.
    pub const CARRIER: Self = Self(0);

    /// The index in `Model::walls`, `Controls::walls` and `State::walls`.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The id of the wall in `MembraneModel::holders`.
    pub fn holder(self) -> u32 {
        self.0
    }
}

const _: () = assert!(CARRIER == 0, "`WallId::CARRIER` is the carrier");

/// A wall: its surface, its pose, its motion, and the law of its contacts with grains.
#[derive(Clone, Debug)]
pub struct Wall {
    pub(super) shape: WallShape,
    pub(super) pose: Pose,
    pub(super) motion: WallMotion,
    pub(super) law: Option<PairLaw>,
}

impl Wall {
    /// A fixed wall whose frame is the world frame.
    pub fn new(shape: WallShape) -> Self {
        Self { shape, pose: Pose::identity(), motion: WallMotion::Fixed, law: None }
    }

    /// A plane through `point` (m); the unit vector `normal` points toward the grains.
    pub fn plane(point: Vec3, normal: Vec3) -> Self {
        let pose = Pose::translation(point.x, point.y, point.z);
        Self::new(WallShape::Plane { normal }).at(pose)
    }

    /// A horizontal floor at `height` (m).
    pub fn floor(height: Real) -> Self {
        Self::plane(Vec3::new(0.0, 0.0, height), Vec3::z())
    }

    /// The six sides of a box between two corners (m): the lower and the upper side along x, then y, then z.
    pub fn sides(low: Vec3, high: Vec3) -> [Self; 6] {
        std::array::from_fn(|k| {
            let (axis, is_high) = (k / 2, k % 2 == 1);
            let (corner, sign) = if is_high { (high, -1.0) } else { (low, 1.0) };
            let mut point = Vec3::zeros();
            point[axis] = corner[axis];
            let mut normal = Vec3::zeros();
            normal[axis] = sign;
            Self::plane(point, normal)
        })
    }

    /// A triangulated surface. It may be open, and grains touch it from both sides.
    pub fn triangles(triangles: Triangles) -> Self {
        Self::new(WallShape::Triangles(Box::new(triangles)))
    }

    /// A frame, which holds vertices of membranes and does not touch grains.
    pub fn frame() -> Self {
        Self::new(WallShape::Frame)
    }

    /// Sets the pose.
    #[must_use]
    pub fn at(mut self, pose: Pose) -> Self {
        self.pose = pose;
        self
    }

    /// Sets the motion, which starts with the first substep of the system.
    #[must_use]
    pub fn moving(mut self, motion: WallMotion) -> Self {
        self.motion = motion;
        self
    }

    /// Sets the law of the contacts with grains.
    #[must_use]
    pub fn law(mut self, law: PairLaw) -> Self {
        self.law = Some(law);
        self
    }
}
