//! Overlap of simple volumes, for requests about regions of space.

use std::panic::catch_unwind;

use rapier3d_f64::{
    math::{Pose as ParryPose, Vector},
    parry::{
        query::intersection_test,
        shape::{Ball, ConvexPolyhedron, Cuboid, Shape},
    },
};

use crate::base::{Pose, Real, Vec3};

/// A volume in the world.
#[derive(Clone, Debug)]
pub enum Volume {
    /// A ball.
    Ball {
        /// The center (m).
        center: Vec3,
        /// The radius (m).
        radius: Real,
    },
    /// An oriented box.
    Box {
        /// Pose of the center.
        pose: Pose,
        /// Half of the edges (m).
        half: Vec3,
    },
    /// The convex hull of points.
    Hull {
        /// The points (m).
        points: Vec<Vec3>,
    },
}

impl Volume {
    /// True if the volumes intersect.
    ///
    /// # Errors
    /// If the points of a hull do not span a volume.
    pub fn overlaps(&self, other: &Self) -> Result<bool, String> {
        let ((a, pose_a), (b, pose_b)) = (self.shape()?, other.shape()?);
        let found = intersection_test(&pose_a, &*a, &pose_b, &*b);
        found.map(|it| it.intersecting).map_err(|it| it.to_string())
    }

    fn shape(&self) -> Result<(Box<dyn Shape>, ParryPose), String> {
        Ok(match self {
            Self::Ball { center, radius } => {
                let pose = Pose::translation(center.x, center.y, center.z);
                (Box::new(Ball::new(*radius)), pose.into())
            }
            Self::Box { pose, half } => {
                (Box::new(Cuboid::new(Vector::new(half.x, half.y, half.z))), (*pose).into())
            }
            Self::Hull { points } => (Box::new(hull(points)?), Pose::identity().into()),
        })
    }
}

/// The vertices of the convex hull of some points.
///
/// # Errors
/// If the points do not span a volume.
pub fn hull_corners(points: &[Vec3]) -> Result<Vec<Vec3>, String> {
    let hull = hull(points)?;
    Ok(hull.points().iter().map(|p| Vec3::new(p.x, p.y, p.z)).collect())
}

fn hull(points: &[Vec3]) -> Result<ConvexPolyhedron, String> {
    // Checked here, because the hull algorithm expects points that span a volume.
    if !are_not_collinear(points) {
        return Err("the points are collinear: give at least four that span a volume".into());
    }
    let points: Vec<Vector> = points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    // The algorithm panics on some nearly coincident points; invalid input must not end the run. Coplanar
    // points may give a hull without volume.
    let result = catch_unwind(|| ConvexPolyhedron::from_convex_hull(&points));
    let hull = result.ok().flatten().filter(|hull| hull.mass_properties(1.0).mass() > 0.0);
    hull.ok_or_else(|| {
        "the points do not span a convex hull: give at least four that are not coplanar".into()
    })
}

/// True if the points do not lie on a line.
fn are_not_collinear(points: &[Vec3]) -> bool {
    let Some(first) = points.first() else { return false };
    let by_length = |a: &Vec3, b: &Vec3| a.norm_squared().total_cmp(&b.norm_squared());
    let longest = points.iter().map(|it| it - first).max_by(by_length).unwrap_or_default();
    let across = points.iter().map(|it| (it - first).cross(&longest).norm()).fold(0.0, Real::max);
    1e-9 * longest.norm_squared() < across
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: elementary geometry, 1 mm on either side of contact.
    #[test]
    fn overlap_begins_where_surfaces_touch() {
        let turned = Pose::rotation(Vec3::z() * std::f64::consts::FRAC_PI_4);
        let cube = Volume::Box { pose: turned, half: Vec3::repeat(0.1) };
        let reach = 0.1 * 2.0_f64.sqrt();
        for (gap, expected) in [(-1e-3, true), (1e-3, false)] {
            let center = Vec3::x() * (reach + 0.05 + gap);
            let ball = Volume::Ball { center, radius: 0.05 };
            assert_eq!(cube.overlaps(&ball), Ok(expected), "ball, {gap}");
            let tip = Vec3::x() * (reach + gap);
            let corners = [Vec3::zeros(), Vec3::y(), Vec3::z(), Vec3::x()].map(|it| tip + it * 0.1);
            // The tip of the hull reaches the edge of the rotated cube first.
            let hull = Volume::Hull { points: corners.to_vec() };
            assert_eq!(cube.overlaps(&hull), Ok(expected), "hull, {gap}");
        }
        for points in [vec![], vec![Vec3::x(); 5], vec![Vec3::zeros(), Vec3::x(), Vec3::x() * 2.0]]
        {
            assert!(cube.overlaps(&Volume::Hull { points }).is_err(), "a line has no volume");
        }
        let corners =
            [0.0, 1.0].map(|x| [0.0, 1.0].map(|y| [0.0, 1.0].map(|z| Vec3::new(x, y, z))));
        let inside = [Vec3::repeat(0.5), Vec3::new(0.2, 0.4, 0.9)];
        let points: Vec<Vec3> = corners.into_iter().flatten().flatten().chain(inside).collect();
        assert_eq!(hull_corners(&points).map(|it| it.len()), Ok(8), "only vertices are left");
        let flat = Volume::Hull { points: vec![Vec3::zeros(), Vec3::x(), Vec3::y()] };
        assert!(cube.overlaps(&flat).is_err(), "a triangle has no volume");
    }
}
