//! Bounding box of the centers of all grains. Surfaces far from the box are far from every grain.

use crate::{
    base::{Real, Vec3},
    physics::{
        boundary::{
            body::BodyMotion,
            wall::{PlacedSurface, WallModel, WallShape},
        },
        state::Grains,
    },
};

/// Bounding box of the centers of all grains.
pub(super) struct Bounds {
    low: Vec3,
    high: Vec3,
    /// Radius of the largest grain (m).
    pub(super) radius_max: Real,
}

impl Bounds {
    pub(super) fn of(grains: &Grains) -> Self {
        let mut low = Vec3::repeat(Real::INFINITY);
        let mut high = Vec3::repeat(Real::NEG_INFINITY);
        for position in &grains.positions {
            low = low.inf(position);
            high = high.sup(position);
        }
        if grains.is_empty() {
            (low, high) = (Vec3::zeros(), Vec3::zeros());
        }
        let radius_max = grains.radii.iter().copied().fold(0.0, Real::max);
        Self { low, high, radius_max }
    }

    /// True if the box from `low` to `high` (m) overlaps this one.
    pub(super) fn overlap(&self, low: &Vec3, high: &Vec3) -> bool {
        (0..3).all(|k| low[k] <= self.high[k] && self.low[k] <= high[k])
    }

    /// Distance of a point from the box (m); 0 inside.
    pub(super) fn distance_from(&self, point: &Vec3) -> Real {
        (self.low - point).sup(&(point - self.high)).sup(&Vec3::zeros()).norm()
    }

    /// Upper bound of the distance of grains' centers from a point (m).
    pub(super) fn furthest_from(&self, point: &Vec3) -> Real {
        (self.low - point).abs().sup(&(self.high - point).abs()).norm()
    }

    /// Distance (m) by which a wall can move before it may be within `beyond` (m) of contact with a grain, at
    /// least 0.
    pub(super) fn gap_to_wall(
        &self,
        wall: &WallModel,
        placed: &PlacedSurface,
        motion: &BodyMotion,
        beyond: Real,
    ) -> Real {
        let origin = motion.pose.translation.vector;
        let distance = match &wall.shape {
            WallShape::Frame => Real::INFINITY,
            WallShape::Triangles(triangles) => {
                self.distance_from(&origin) - triangles.bounding_radius()
            }
            // Within the box, the distance differs from that of its center by at most half the diagonal.
            _ => {
                let of_center = placed.distance(&(0.5 * (self.low + self.high) - origin));
                let half = 0.5 * (self.high - self.low).norm();
                of_center.map_or(Real::NEG_INFINITY, |(distance, _)| distance - half)
            }
        };
        (distance - self.radius_max - beyond).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        base::{
            Pose,
            random::{Random, Stream},
            real::Twist,
        },
        physics::law::{PairLaw, Surface},
        scene::Material,
    };

    #[test]
    fn distances_are_bounded_by_the_box() {
        // Oracle: the distances of all grains, by brute force.
        let mut random = Random::new(5, Stream::Position);
        let mut point = |size: Real| Vec3::from_fn(|_, _| random.between(-size, size));
        let material = Material { youngs_modulus: 1e7, poisson_ratio: 0.25, density: 2500.0 };
        let surface = Surface { friction: 0.5, dissipation_time: 0.0, tangential_damping: 0.0 };
        let law = PairLaw::against_rigid(&material, surface);
        let shapes = [
            WallShape::Plane { normal: Vec3::z() },
            WallShape::Tube { radius: 0.5 },
            WallShape::Bowl { radius: 2.0 },
            WallShape::Ball { radius: 0.3 },
        ];
        let mut n_far = 0;
        for _ in 0..200 {
            let middle = point(1.0);
            let positions: Vec<Vec3> = (0..20).map(|_| middle + point(0.2)).collect();
            let grains = Grains::at_rest(positions, vec![0.01; 20], vec![1.0; 20]);
            let bounds = Bounds::of(&grains);
            let motion =
                BodyMotion { pose: Pose::new(point(1.0), point(1.0)), twist: Twist::zero() };
            let origin = motion.pose.translation.vector;
            for position in &grains.positions {
                let distance = (position - origin).norm();
                assert!(bounds.distance_from(&origin) <= distance + 1e-12);
                assert!(distance <= bounds.furthest_from(&origin) + 1e-12);
            }
            for shape in &shapes {
                let wall = WallModel::fixed(shape.clone(), law);
                let placed = shape.placed(&motion);
                let gap = bounds.gap_to_wall(&wall, &placed, &motion, 0.005);
                n_far += usize::from(gap > 0.0);
                for position in &grains.positions {
                    let (distance, _) = placed.distance(&(position - origin)).unwrap();
                    assert!(gap == 0.0 || gap + 0.015 <= distance + 1e-12, "{shape:?}");
                }
            }
        }
        assert!(n_far > 100, "{n_far}");
    }
}
