//! Walls: rigid surfaces with prescribed motion.
//!
//! Grains touch walls, and walls can hold vertices of membranes. Forces on a wall are measured but do not move
//! it, except through a servo.

use super::{body::BodyMotion, motion::WallMotion, triangles::Triangles};
use crate::{
    base::{Real, Vec3},
    physics::law::PairLaw,
};

/// Index of the carrier, the first wall. The carrier of a gripper is its flange.
///
/// The carrier is the frame of reference of the system in two ways. Neighbor lists use positions relative to it,
/// so moving the whole system does not cause rebuilds. And with density scaling, grains and free vertices gain
/// its changes of velocity directly, so they follow it as the real ones do in spite of their larger inertia. If a
/// system has a moving container, it should be the first wall.
pub const CARRIER: usize = 0;

/// A wall: its surface, its contact law and its motion.
#[derive(Clone, Debug)]
pub struct WallModel {
    /// Its surface.
    pub shape: WallShape,
    /// Contact law between grains and the wall.
    pub law: PairLaw,
    /// Its motion.
    pub motion: WallMotion,
}

impl WallModel {
    /// A wall that does not move.
    pub fn fixed(shape: WallShape, law: PairLaw) -> Self {
        Self { shape, law, motion: WallMotion::Fixed }
    }
}

/// The surface of a wall, in the frame of the wall.
#[derive(Clone, Debug, PartialEq)]
pub enum WallShape {
    /// A plane through the origin of the frame.
    Plane {
        /// Unit normal, toward the grains.
        normal: Vec3,
    },
    /// The inner side of an infinite cylinder around z.
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
    /// Triangles, which grains touch from both sides. There is no single distance; see `Triangles::touching`.
    Triangles(Box<Triangles>),
    /// No surface: a frame that holds vertices and that grains do not touch.
    Frame,
}

impl WallShape {
    /// The surface at the pose of `motion`.
    #[inline]
    pub fn placed(&self, motion: &BodyMotion) -> PlacedSurface {
        match self {
            Self::Plane { normal } => {
                PlacedSurface::Plane { normal: motion.pose.rotation * normal }
            }
            Self::Tube { radius } => {
                PlacedSurface::Tube { radius: *radius, axis: motion.pose.rotation * Vec3::z() }
            }
            Self::Bowl { radius } => PlacedSurface::Bowl { radius: *radius },
            Self::Ball { radius } => PlacedSurface::Ball { radius: *radius },
            Self::Triangles(_) | Self::Frame => PlacedSurface::Frame,
        }
    }

    /// Distance (m) of the surface from the point at `arm` (m) from the wall's origin, and the unit normal toward
    /// the point, world axes. `None` if the wall has no surface or no single distance.
    pub fn distance(&self, motion: &BodyMotion, arm: &Vec3) -> Option<(Real, Vec3)> {
        self.placed(motion).distance(arm)
    }
}

/// The surface of a wall with directions in world axes, see `WallShape`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "as in `WallShape`")]
pub enum PlacedSurface {
    Plane { normal: Vec3 },
    Tube { radius: Real, axis: Vec3 },
    Bowl { radius: Real },
    Ball { radius: Real },
    Frame,
}

impl PlacedSurface {
    /// See `WallShape::distance`.
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
    /// Upper bound of the distance (m) by which points within `extent` (m) of the wall's origin have approached
    /// its surface while the wall moved from one pose to another. The points moved by `carried` (m) meanwhile.
    pub fn displacement(
        &self,
        from: &BodyMotion,
        to: &BodyMotion,
        carried: &Vec3,
        extent: Real,
    ) -> Real {
        let origin = |it: &BodyMotion| it.pose.translation.vector;
        let shifted = (origin(to) - origin(from) - carried).norm();
        let rotated = |axis: &Vec3| (to.pose.rotation * axis - from.pose.rotation * axis).norm();
        // A rotation moves a unit vector by at most 2 sin(angle/2).
        let rotated_most = || 2.0 * (0.5 * to.pose.rotation.angle_to(&from.pose.rotation)).sin();
        match self {
            Self::Plane { normal } => shifted + rotated(normal) * extent,
            Self::Tube { .. } => shifted + rotated(&Vec3::z()) * extent,
            Self::Bowl { .. } | Self::Ball { .. } => shifted,
            Self::Triangles(_) => shifted + rotated_most() * extent,
            Self::Frame => 0.0,
        }
    }
}

/// Distance from the inner side of a tube or a sphere. `None` on the axis or at the center, where no point of
/// the wall is closest.
#[inline(always)]
fn inside(radius: Real, outward: Vec3) -> Option<(Real, Vec3)> {
    let length = outward.norm();
    (length > 0.0).then(|| (radius - length, outward / -length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{Pose, real::Twist};

    /// Oracle: the equations of the surfaces in a rotated and shifted frame. Tolerance: rounding.
    #[test]
    fn distances_and_normals_match_the_surfaces() {
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
