//! Random positions for grains that do not touch each other, by random sequential addition.
//!
//! Fast up to a solid fraction of 0.3. Above 0.38 no free position is left (Widom 1966).

use std::collections::BTreeMap;

use crate::{
    base::{Real, Vec3, random::Random, real::real},
    physics::contact::grains::closest_image,
};

/// Number of attempts to place one grain.
const N_TRIES: usize = 100_000;

/// There is no free position for a grain.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("only {n_placed} of {n_grains} grains could be placed; scatter them with smaller radii")]
pub struct NoRoom {
    /// Number of grains that were placed.
    pub n_placed: usize,
    /// Number of all grains.
    pub n_grains: usize,
}

/// A container in which grains are scattered.
#[derive(Clone, Copy, Debug)]
pub enum Room {
    /// A box of six planes.
    Box {
        /// Lowest corner (m).
        low: Vec3,
        /// Highest corner (m).
        high: Vec3,
    },
    /// A cylinder around z, between two planes.
    Tube {
        /// Radius (m).
        radius: Real,
        /// Height of the lower plane (m).
        bottom: Real,
        /// Height of the upper plane (m).
        top: Real,
    },
    /// Between two concentric spheres around the origin, or inside the outer one only.
    Shell {
        /// Radius of the inner sphere (m); 0 if there is none.
        inner: Real,
        /// Radius of the outer sphere (m).
        outer: Real,
    },
    /// A periodic box, `[0, period)` along each axis.
    Periodic {
        /// Edges of the box (m).
        period: Vec3,
    },
}

impl Room {
    /// Volume (m³).
    pub fn volume(&self) -> Real {
        use std::f64::consts::PI;
        match self {
            Self::Box { low, high } => (high - low).product(),
            Self::Tube { radius, bottom, top } => PI * radius * radius * (top - bottom),
            Self::Shell { inner, outer } => 4.0 / 3.0 * PI * (outer.powi(3) - inner.powi(3)),
            Self::Periodic { period } => period.product(),
        }
    }

    /// Edges of the box (m) if it is periodic.
    pub fn period(&self) -> Option<Vec3> {
        match self {
            Self::Periodic { period } => Some(*period),
            _ => None,
        }
    }

    /// Draws a uniformly distributed point at least `margin` (m) away from the walls. Returns `None` if the draw is
    /// outside; draw again then.
    pub fn place(&self, margin: Real, random: &mut Random) -> Option<Vec3> {
        let (low, high) = match self {
            Self::Box { low, high } => (low.add_scalar(margin), high.add_scalar(-margin)),
            Self::Tube { radius, bottom, top } => {
                let reach = radius - margin;
                (Vec3::new(-reach, -reach, bottom + margin), Vec3::new(reach, reach, top - margin))
            }
            Self::Shell { outer, .. } => {
                (Vec3::repeat(margin - outer), Vec3::repeat(outer - margin))
            }
            Self::Periodic { period } => (Vec3::zeros(), *period),
        };
        let point = Vec3::from_fn(|axis, _| random.between(low[axis], high[axis]));
        let is_inside = match self {
            Self::Box { .. } | Self::Periodic { .. } => true,
            Self::Tube { radius, .. } => point.xy().norm() <= radius - margin,
            Self::Shell { inner, outer } => {
                let from_center = point.norm();
                // Without an inner sphere there is no inner wall.
                let closest = if *inner > 0.0 { inner + margin } else { 0.0 };
                (closest..=outer - margin).contains(&from_center)
            }
        };
        is_inside.then_some(point)
    }
}

/// Random positions (m) for spheres of `radii` (m) that do not touch each other. `propose` draws candidates, or
/// `None` for an invalid draw. In a box with edges `period` (m), spheres do not touch the images of others either.
///
/// # Errors
/// If there is no free position for a sphere.
pub fn scatter(
    radii: &[Real],
    period: Option<Vec3>,
    random: &mut Random,
    mut propose: impl FnMut(&mut Random) -> Option<Vec3>,
) -> Result<Vec<Vec3>, NoRoom> {
    let mut positions: Vec<Vec3> = Vec::with_capacity(radii.len());
    let mut cells = Cells::new(radii, period);
    for (i, &radius) in radii.iter().enumerate() {
        let found = (0..N_TRIES).find_map(|_| {
            propose(random).filter(|candidate| cells.is_free(candidate, radius, radii, &positions))
        });
        let Some(position) = found else {
            return Err(NoRoom { n_placed: i, n_grains: radii.len() });
        };
        cells.spheres.entry(cells.key(&position)).or_default().push(i);
        positions.push(position);
    }
    Ok(positions)
}

/// Spheres by the cell of their center. A cell is at least as wide as the largest sphere.
struct Cells {
    width: Vec3,
    /// Number of cells along each edge of a periodic box.
    n_periodic: Option<[i64; 3]>,
    period: Option<Vec3>,
    spheres: BTreeMap<[i64; 3], Vec<usize>>,
}

impl Cells {
    fn new(radii: &[Real], period: Option<Vec3>) -> Self {
        let diameter = 2.0 * radii.iter().copied().fold(Real::MIN_POSITIVE, Real::max);
        let n_periodic = period.map(|period| [0, 1, 2].map(|k| floor(period[k] / diameter).max(1)));
        let width = match (period, n_periodic) {
            (Some(period), Some(n)) => Vec3::from_fn(|k, _| period[k] / real(count(n[k]))),
            _ => Vec3::repeat(diameter),
        };
        Self { width, n_periodic, period, spheres: BTreeMap::new() }
    }

    fn key(&self, position: &Vec3) -> [i64; 3] {
        self.wrap([0, 1, 2].map(|k| floor(position[k] / self.width[k])))
    }

    fn wrap(&self, key: [i64; 3]) -> [i64; 3] {
        match self.n_periodic {
            Some(n) => [0, 1, 2].map(|k| key[k].rem_euclid(n[k])),
            None => key,
        }
    }

    fn is_free(&self, candidate: &Vec3, radius: Real, radii: &[Real], positions: &[Vec3]) -> bool {
        let [x, y, z] = self.key(candidate);
        let keys = (0..27).map(|k| self.wrap([x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]));
        keys.filter_map(|key| self.spheres.get(&key)).flatten().all(|&other| {
            let mut separation = candidate - positions[other];
            if let Some(period) = self.period {
                separation = closest_image(separation, &period);
            }
            let reach = radius + radii[other];
            separation.norm_squared() > reach * reach
        })
    }
}

/// The largest integer not above `value`.
#[expect(
    clippy::cast_possible_truncation,
    reason = "coordinates are a few thousand diameters at most"
)]
fn floor(value: Real) -> i64 {
    value.floor() as i64
}

fn count(n: i64) -> usize {
    usize::try_from(n).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{base::random::Stream, physics::packing::sphere_volume};

    /// Oracle: the distance of every pair, and the equations of the walls.
    #[test]
    fn scattered_grains_touch_neither_each_other_nor_the_walls() {
        let rooms = [
            Room::Box { low: Vec3::new(-1.0, -2.0, 0.0), high: Vec3::new(1.0, 2.0, 3.0) },
            Room::Tube { radius: 1.2, bottom: -1.0, top: 2.0 },
            Room::Shell { inner: 0.8, outer: 2.0 },
            Room::Periodic { period: Vec3::new(2.0, 2.5, 3.0) },
        ];
        for room in rooms {
            let mut random = Random::new(5, Stream::Position);
            let radii: Vec<Real> = (0..600).map(|_| random.between(0.08, 0.1)).collect();
            let positions = scatter(&radii, room.period(), &mut random, |it| room.place(0.1, it));
            let positions = positions.unwrap();
            let solid: Real = radii.iter().map(|&r| sphere_volume(r)).sum();
            assert!(
                0.05 < solid / room.volume(),
                "the test is too easy: {}",
                solid / room.volume()
            );
            for (i, a) in positions.iter().enumerate() {
                let distance = clearance(&room, a);
                assert!(distance >= 0.1 - 1e-12, "{room:?} {a:?}");
                for (j, b) in positions[..i].iter().enumerate() {
                    let mut separation = a - b;
                    if let Some(period) = room.period() {
                        for k in 0..3 {
                            let shifted =
                                (-1..=1).map(|n| separation[k] + f64::from(n) * period[k]);
                            separation[k] = shifted.map(Real::abs).fold(Real::INFINITY, Real::min);
                        }
                    }
                    assert!(separation.norm() > radii[i] + radii[j], "{room:?} {i} {j}");
                }
            }
        }
    }

    /// Distance from the nearest wall (m).
    fn clearance(room: &Room, point: &Vec3) -> Real {
        match room {
            Room::Box { low, high } => (point - low).min().min((high - point).min()),
            Room::Tube { radius, bottom, top } => {
                (radius - point.x.hypot(point.y)).min(point.z - bottom).min(top - point.z)
            }
            Room::Shell { inner, outer } => (point.norm() - inner).min(outer - point.norm()),
            Room::Periodic { .. } => Real::INFINITY,
        }
    }

    /// Oracle: five spheres of radius 0.9 do not fit in a cube of edge 2.
    #[test]
    fn grains_that_do_not_fit_are_an_error() {
        let room = Room::Box { low: Vec3::zeros(), high: Vec3::repeat(2.0) };
        let mut random = Random::new(5, Stream::Position);
        let result = scatter(&[0.9; 5], None, &mut random, |it| room.place(0.9, it));
        assert_eq!(result, Err(NoRoom { n_placed: 1, n_grains: 5 }));
    }
}
