//! Random places for grains that do not touch each other: random sequential addition on a grid.
//!
//! Quick up to a solid fraction of 0.3; beyond 0.38 no place is left (Widom 1966).

use std::collections::BTreeMap;

use crate::{
    base::{Real, Vec3, random::Random, real::real},
    physics::contact::grains::closest_image,
};

/// Candidates for one grain before it is given up.
const N_TRIES: usize = 100_000;

/// No place is left.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("only {n_placed} of {n_grains} grains found a place; scatter them at smaller radii")]
pub struct NoRoom {
    /// Grains that have a place.
    pub n_placed: usize,
    /// How many there are.
    pub n_grains: usize,
}

/// Where grains may be scattered.
#[derive(Clone, Copy, Debug)]
pub enum Room {
    /// Between six planes.
    Box {
        /// Lowest corner (m).
        low: Vec3,
        /// Highest corner (m).
        high: Vec3,
    },
    /// Around z, between two planes.
    Tube {
        /// Radius (m).
        radius: Real,
        /// Height of the lower plane (m).
        bottom: Real,
        /// Height of the upper plane (m).
        top: Real,
    },
    /// Between two spheres around the origin; a ball without the inner one.
    Shell {
        /// Radius of the inner sphere, 0 without (m).
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

    /// Edges of the periodic box (m), if it is one.
    pub fn period(&self) -> Option<Vec3> {
        match self {
            Self::Periodic { period } => Some(*period),
            _ => None,
        }
    }

    /// A uniformly random point at least `margin` (m) away from the walls; `None` if the draw fell
    /// outside.
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
        let place = Vec3::from_fn(|axis, _| random.between(low[axis], high[axis]));
        let is_inside = match self {
            Self::Box { .. } | Self::Periodic { .. } => true,
            Self::Tube { radius, .. } => place.xy().norm() <= radius - margin,
            Self::Shell { inner, outer } => {
                let from_center = place.norm();
                // A ball has no inner wall to keep away from.
                let closest = if *inner > 0.0 { inner + margin } else { 0.0 };
                (closest..=outer - margin).contains(&from_center)
            }
        };
        is_inside.then_some(place)
    }
}

/// Random places for spheres of `radii` (m), none of which touch; candidates come from `offer`, which
/// gives `None` for those that are of no use. With a `period` (m) the images keep away as well.
///
/// # Errors
/// If a sphere finds no place.
pub fn scatter(
    radii: &[Real],
    period: Option<Vec3>,
    random: &mut Random,
    mut offer: impl FnMut(&mut Random) -> Option<Vec3>,
) -> Result<Vec<Vec3>, NoRoom> {
    let mut places: Vec<Vec3> = Vec::with_capacity(radii.len());
    let mut cells = Cells::new(radii, period);
    for (i, &radius) in radii.iter().enumerate() {
        let found = (0..N_TRIES).find_map(|_| {
            offer(random).filter(|place| cells.is_free(place, radius, radii, &places))
        });
        let Some(place) = found else {
            return Err(NoRoom { n_placed: i, n_grains: radii.len() });
        };
        cells.taken.entry(cells.key(&place)).or_default().push(i);
        places.push(place);
    }
    Ok(places)
}

/// Spheres by the cell of their center; a cell is as wide as the largest sphere.
struct Cells {
    width: Vec3,
    /// Number of cells along each edge of a periodic box.
    n_periodic: Option<[i64; 3]>,
    period: Option<Vec3>,
    taken: BTreeMap<[i64; 3], Vec<usize>>,
}

impl Cells {
    fn new(radii: &[Real], period: Option<Vec3>) -> Self {
        let diameter = 2.0 * radii.iter().copied().fold(Real::MIN_POSITIVE, Real::max);
        let n_periodic = period.map(|period| [0, 1, 2].map(|k| floor(period[k] / diameter).max(1)));
        let width = match (period, n_periodic) {
            (Some(period), Some(n)) => Vec3::from_fn(|k, _| period[k] / real(count(n[k]))),
            _ => Vec3::repeat(diameter),
        };
        Self { width, n_periodic, period, taken: BTreeMap::new() }
    }

    fn key(&self, place: &Vec3) -> [i64; 3] {
        self.wrap([0, 1, 2].map(|k| floor(place[k] / self.width[k])))
    }

    fn wrap(&self, key: [i64; 3]) -> [i64; 3] {
        match self.n_periodic {
            Some(n) => [0, 1, 2].map(|k| key[k].rem_euclid(n[k])),
            None => key,
        }
    }

    fn is_free(&self, place: &Vec3, radius: Real, radii: &[Real], places: &[Vec3]) -> bool {
        let [x, y, z] = self.key(place);
        let keys = (0..27).map(|k| self.wrap([x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]));
        keys.filter_map(|key| self.taken.get(&key)).flatten().all(|&other| {
            let mut apart = place - places[other];
            if let Some(period) = self.period {
                apart = closest_image(apart, &period);
            }
            let reach = radius + radii[other];
            apart.norm_squared() > reach * reach
        })
    }
}

/// The next whole number below.
#[expect(clippy::cast_possible_truncation, reason = "places are a few thousand diameters away")]
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

    /// Oracle: the distance of every pair, and the walls' own equations.
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
            let places = scatter(&radii, room.period(), &mut random, |it| room.place(0.1, it));
            let places = places.unwrap();
            let solid: Real = radii.iter().map(|&r| sphere_volume(r)).sum();
            assert!(0.05 < solid / room.volume(), "not too easy: {}", solid / room.volume());
            for (i, a) in places.iter().enumerate() {
                let (is_free, far) = clearance(&room, a);
                assert!(is_free >= 0.1 - 1e-12, "{room:?} {far:?}");
                for (j, b) in places[..i].iter().enumerate() {
                    let mut apart = a - b;
                    if let Some(period) = room.period() {
                        for k in 0..3 {
                            let shifted = (-1..=1).map(|n| apart[k] + f64::from(n) * period[k]);
                            apart[k] = shifted.map(Real::abs).fold(Real::INFINITY, Real::min);
                        }
                    }
                    assert!(apart.norm() > radii[i] + radii[j], "{room:?} {i} {j}");
                }
            }
        }
    }

    /// Distance from the nearest wall, and where.
    fn clearance(room: &Room, place: &Vec3) -> (Real, Vec3) {
        let distance = match room {
            Room::Box { low, high } => (place - low).min().min((high - place).min()),
            Room::Tube { radius, bottom, top } => {
                (radius - place.x.hypot(place.y)).min(place.z - bottom).min(top - place.z)
            }
            Room::Shell { inner, outer } => (place.norm() - inner).min(outer - place.norm()),
            Room::Periodic { .. } => Real::INFINITY,
        };
        (distance, *place)
    }

    /// Oracle: five spheres of radius 0.9 cannot be in a cube of edge 2.
    #[test]
    fn a_full_room_is_an_error() {
        let room = Room::Box { low: Vec3::zeros(), high: Vec3::repeat(2.0) };
        let mut random = Random::new(5, Stream::Position);
        let refused = scatter(&[0.9; 5], None, &mut random, |it| room.place(0.9, it));
        assert_eq!(refused, Err(NoRoom { n_placed: 1, n_grains: 5 }));
    }
}
