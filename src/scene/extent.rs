//! Extent of a posed shape, for checks of the initial configuration.

use super::Shape;
use crate::base::{Pose, Real, Vec3};

/// Heights of the lowest and the highest point of a posed shape (m).
pub(super) fn heights(shape: &Shape, pose: &Pose) -> (Real, Real) {
    let up = pose.rotation.inverse_transform_vector(&Vec3::z());
    let z = pose.translation.vector.z;
    let symmetric = |reach: Real| (z - reach, z + reach);
    match shape {
        Shape::Sphere { radius } => symmetric(*radius),
        Shape::Box { size } => symmetric(up.abs().dot(size) / 2.0),
        Shape::Cylinder { radius, height } => {
            let across = up.x.hypot(up.y);
            symmetric(up.z.abs() * height / 2.0 + across * radius)
        }
        Shape::Capsule { radius, height } => {
            symmetric(up.z.abs() * (height / 2.0 - radius) + radius)
        }
        Shape::ConvexHull { points } => of_points(points, &up, z),
        Shape::Mesh { vertices, .. } => of_points(vertices, &up, z),
    }
}

/// Approximate radius of a vertical cylinder about the origin that contains the shape (m).
pub(super) fn radius_across(shape: &Shape) -> Real {
    let farthest = |points: &[Vec3]| points.iter().map(Vec3::norm).fold(0.0, Real::max);
    match shape {
        Shape::Sphere { radius } => *radius,
        Shape::Box { size } => size.norm() / 2.0,
        Shape::Cylinder { radius, height } => radius.hypot(height / 2.0),
        Shape::Capsule { height, .. } => height / 2.0,
        Shape::ConvexHull { points } => farthest(points),
        Shape::Mesh { vertices, .. } => farthest(vertices),
    }
}

fn of_points(points: &[Vec3], up: &Vec3, z: Real) -> (Real, Real) {
    let reaches = points.iter().map(|point| up.dot(point));
    reaches.fold((Real::NAN, Real::NAN), |(low, high), it| (low.min(z + it), high.max(z + it)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// Oracle: elementary geometry. Tolerance: round-off of one rotation.
    #[test]
    fn lying_and_standing_shapes() {
        let lying = Pose::rotation(Vec3::x() * FRAC_PI_2);
        let cases = [
            (Shape::Cylinder { radius: 0.01, height: 0.07 }, Pose::identity(), 0.035),
            (Shape::Cylinder { radius: 0.01, height: 0.07 }, lying, 0.01),
            (Shape::Capsule { radius: 0.01, height: 0.07 }, Pose::identity(), 0.035),
            (Shape::Capsule { radius: 0.01, height: 0.07 }, lying, 0.01),
            (Shape::Box { size: Vec3::new(0.02, 0.04, 0.06) }, lying, 0.02),
            (Shape::Sphere { radius: 0.01 }, lying, 0.01),
        ];
        for (shape, pose, reach) in cases {
            let (low, high) = heights(&shape, &pose);
            assert!((low + reach).abs() < 1e-15, "{shape:?}: {low}");
            assert!((high - reach).abs() < 1e-15, "{shape:?}: {high}");
        }
    }
}
