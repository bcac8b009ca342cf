//! Walls as parts of a system to be built.

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

/// A wall of a system, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct WallId(pub(super) u32);

impl WallId {
    /// The carrier: the first wall that is added. See `boundary::wall::CARRIER`.
    pub const CARRIER: Self = Self(0);

    /// Its place in `Model::walls`, `Controls::walls` and `State::walls`.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The number by which a membrane names its holder.
    pub fn holder(self) -> u32 {
        self.0
    }
}

const _: () = assert!(CARRIER == 0, "`WallId::CARRIER` is the carrier");

/// A wall: surface, place, motion, and the law of its contacts with grains.
#[derive(Clone, Debug)]
pub struct Wall {
    pub(super) shape: WallShape,
    pub(super) pose: Pose,
    pub(super) motion: WallMotion,
    pub(super) law: Option<PairLaw>,
}

impl Wall {
    /// A wall that stands still with its frame in the world's.
    pub fn new(shape: WallShape) -> Self {
        Self { shape, pose: Pose::identity(), motion: WallMotion::Fixed, law: None }
    }

    /// A plane through `point` (m); the unit vector `normal` points towards the grains.
    pub fn plane(point: Vec3, normal: Vec3) -> Self {
        let pose = Pose::translation(point.x, point.y, point.z);
        Self::new(WallShape::Plane { normal }).at(pose)
    }

    /// A horizontal floor at `height` (m).
    pub fn floor(height: Real) -> Self {
        Self::plane(Vec3::new(0.0, 0.0, height), Vec3::z())
    }

    /// The six sides of a box between two corners (m): low and high side along x, then y, then z.
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

    /// A surface of triangles, which may be open and is touched from both sides.
    pub fn triangles(triangles: Triangles) -> Self {
        Self::new(WallShape::Triangles(Box::new(triangles)))
    }

    /// A frame, which holds vertices of membranes and touches no grain.
    pub fn frame() -> Self {
        Self::new(WallShape::Frame)
    }

    /// The same at another pose.
    #[must_use]
    pub fn at(mut self, pose: Pose) -> Self {
        self.pose = pose;
        self
    }

    /// The same with a motion, which begins when the system takes its first substep.
    #[must_use]
    pub fn moving(mut self, motion: WallMotion) -> Self {
        self.motion = motion;
        self
    }

    /// The same with a law of its own for contacts with grains.
    #[must_use]
    pub fn law(mut self, law: PairLaw) -> Self {
        self.law = Some(law);
        self
    }
}
