//! Walls: rigid surfaces with prescribed motion that grains touch and that hold vertices of
//! membranes. Forces act on them but do not move them.

use super::{body::BodyMotion, motion::WallMotion, triangles::Triangles};
use crate::{
    base::{Real, Vec3},
    physics::law::PairLaw,
};

/// The carrier: the first wall. A gripper's is the flange, whose inner face is the plate.
///
/// It is the frame of reference of the system in two ways. Lists of neighbours are kept in terms
/// of positions relative to it, so carrying the whole system through the room costs no rebuild.
/// And with density scaling grains and free vertices gain its velocity directly, so that heavier
/// ones follow it as real ones do. Where the container moves, it should be the first wall.
pub const CARRIER: usize = 0;

/// What a wall is made of, and how it moves.
#[derive(Clone, Debug)]
pub struct WallModel {
    /// Its surface.
    pub shape: WallShape,
    /// Law between grains and the wall.
    pub law: PairLaw,
    /// How it moves.
    pub motion: WallMotion,
}

impl WallModel {
    /// A wall that does not move.
    pub fn fixed(shape: WallShape, law: PairLaw) -> Self {
        Self { shape, law, motion: WallMotion::Fixed }
    }
}

/// The surface of a wall in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum WallShape {
    /// A plane through the frame's origin.
    Plane {
        /// Unit normal, towards the grains.
        normal: Vec3,
    },
    /// The inner side of a cylinder around z, without ends.
    Tube {
        /// Radius (m).
        radius: Real,
    },
    /// The inner side of a sphere.
    Bowl {
        /// Radius (m).
        radius: Real,
    },
    /// The outer side of a sphere.
    Ball {
        /// Radius (m).
        radius: Real,
    },
    /// Triangles, touched from both sides. There is no single distance from them; see
    /// `Triangles::touching`.
    Triangles(Box<Triangles>),
    /// Holds vertices and touches no grain.
    Frame,
}

impl WallShape {
    /// The surface where a motion has brought it.
    #[inline]
    pub fn placed(&self, motion: &BodyMotion) -> Placed {
        match self {
            Self::Plane { normal } => Placed::Plane { normal: motion.pose.rotation * normal },
            Self::Tube { radius } => {
                Placed::Tube { radius: *radius, axis: motion.pose.rotation * Vec3::z() }
            }
            Self::Bowl { radius } => Placed::Bowl { radius: *radius },
            Self::Ball { radius } => Placed::Ball { radius: *radius },
            Self::Triangles(_) | Self::Frame => Placed::Frame,
        }
    }

    /// Distance (m) of the point at `arm` (m) from the wall's origin, and the normal towards it,
    /// world axes. `None` where the wall has no surface, or more than one distance.
    pub fn distance(&self, motion: &BodyMotion, arm: &Vec3) -> Option<(Real, Vec3)> {
        self.placed(motion).distance(arm)
    }
}

/// The surface of a wall, with its directions in world axes; see `WallShape`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "as in `WallShape`")]
pub enum Placed {
    Plane { normal: Vec3 },
    Tube { radius: Real, axis: Vec3 },
    Bowl { radius: Real },
    Ball { radius: Real },
    Frame,
}

impl Placed {
    /// As that of `WallShape`.
    #[inline(always)]
    pub fn distance(&self, arm: &Vec3) -> Option<(Real, Vec3)> {
        match self {
            Self::Plane { normal } => Some((normal.dot(arm), *normal)),
            Self::Tube { radius, axis } => inside(*radius, arm - axis * axis.dot(arm)),
            Self::Bowl { radius } => inside(*radius, *arm),
            Self::Ball { radius } => {
                let length = arm.norm();
                (length > 0.0).then(|| (length - radius, arm / length))
            }
            Self::Frame => None,
        }
    }
}

impl WallShape {
    /// No point within `extent` (m) of the wall's origin has come nearer to its surface by more than
    /// this (m) while the wall went from one motion to another, seen from something that went by
    /// `carried` (m).
    pub fn displacement(
        &self,
        from: &BodyMotion,
        to: &BodyMotion,
        carried: &Vec3,
        extent: Real,
    ) -> Real {
        let origin = |it: &BodyMotion| it.pose.translation.vector;
        let shifted = (origin(to) - origin(from) - carried).norm();
        let turned = |axis: &Vec3| (to.pose.rotation * axis - from.pose.rotation * axis).norm();
        // No vector changes by more than the largest change of a unit vector, 2 sin(angle/2).
        let turned_most = || 2.0 * (0.5 * to.pose.rotation.angle_to(&from.pose.rotation)).sin();
        match self {
            Self::Plane { normal } => shifted + turned(normal) * extent,
            Self::Tube { .. } => shifted + turned(&Vec3::z()) * extent,
            Self::Bowl { .. } | Self::Ball { .. } => shifted,
            Self::Triangles(_) => shifted + turned_most() * extent,
            Self::Frame => 0.0,
        }
    }
}

/// From the axis or the centre there is no nearest point of the wall.
#[inline(always)]
fn inside(radius: Real, outward: Vec3) -> Option<(Real, Vec3)> {
    let length = outward.norm();
    (length > 0.0).then(|| (radius - length, outward / -length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{Pose, real::Twist};

    /// Oracle: the surfaces' own equations in a turned and shifted frame; to rounding.
    #[test]
    fn distances_and_normals_are_those_of_the_surfaces() {
        let pose = Pose::new(Vec3::new(0.1, -0.2, 0.3), Vec3::new(0.4, 0.5, -0.6));
        let motion = BodyMotion { pose, twist: Twist::zero() };
        let local = Vec3::new(0.03, -0.04, 0.2);
        let arm = pose.rotation * local;
        let expect = |shape: WallShape, distance: Real, normal: Vec3| {
            let (found, direction) = shape.distance(&motion, &arm).unwrap();
            assert!((found - distance).abs() < 1e-15, "{shape:?}: {found}");
            assert!((direction - pose.rotation * normal).norm() < 1e-14, "{shape:?}");
        };
        expect(WallShape::Plane { normal: -Vec3::z() }, -0.2, -Vec3::z());
        expect(WallShape::Tube { radius: 0.08 }, 0.03, Vec3::new(-0.6, 0.8, 0.0));
        let length = local.norm();
        expect(WallShape::Bowl { radius: 0.3 }, 0.3 - length, -local / length);
        expect(WallShape::Ball { radius: 0.1 }, length - 0.1, local / length);
        assert!(WallShape::Frame.distance(&motion, &arm).is_none());
    }
}
