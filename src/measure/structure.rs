//! Structure of a packing: solid fraction of a region, and radial distribution functions.
//!
//! ```text
//! g(r)  = ⟨pairs at r … r + Δ⟩ / (ρ_n 4/3 π ((r + Δ)³ − r³))        center to center, → 1 far away
//! g₄₂(r) = 1/N Σ_i n_i(r) / (4π (r/R̄)²)                             Götz (2024), eq. 42
//!
//! n_i(r)  grains that intersect the sphere of radius r about grain i  (-)
//! ρ_n     grains per volume                                        (1/m³)
//! R̄       mean radius                                              (m)
//! ```
//!
//! In a bounded sample only the part of each shell inside the sample counts: its exact volume replaces
//! that of the complete shell.
//!
//! Eq. 42 counts with a kernel one diameter wide, so narrow peaks of a lattice are smeared out, and it
//! tends to 3 φ/(2π) (1 + R̄²/(3 r²)) in a packing without correlations, not to 1.

use std::f64::consts::PI;

use super::{grid::index_of as index, overlap::sphere_in_box, search::PointSearch};
use crate::{
    base::{
        Real, Vec3,
        real::{real, real_of},
    },
    physics::contact::grains::closest_image,
};

/// Solid fraction of the box from `low` to `high` (m) with spheres at `positions` (m) with `radii` (m),
/// which are cut exactly at its faces.
pub fn solid_fraction(positions: &[Vec3], radii: &[Real], low: &Vec3, high: &Vec3) -> Real {
    let inside = |(center, &radius): (&Vec3, &Real)| sphere_in_box(center, radius, low, high);
    let solid: Real = positions.iter().zip(radii).map(inside).sum();
    solid / (high - low).product()
}

/// Bins of a histogram of distances.
#[derive(Clone, Copy, Debug)]
pub struct Bins {
    /// Width of a bin (m).
    pub width: Real,
    /// Number of bins.
    pub n_bins: usize,
}

impl Bins {
    /// Center of bin `k` (m).
    pub fn center(&self, k: usize) -> Real {
        (real(k) + 0.5) * self.width
    }

    /// Largest distance that is counted (m).
    pub fn reach(&self) -> Real {
        real(self.n_bins) * self.width
    }

    /// The bin that contains `distance`.
    fn of(&self, distance: Real) -> Option<usize> {
        let k = index(distance / self.width);
        (k < self.n_bins).then_some(k)
    }
}

/// The sample, and which of its grains are centers of shells.
#[derive(Clone, Copy, Debug)]
pub enum Region {
    /// A periodic box with these edges (m). The bins must not exceed half the shortest edge.
    Periodic(Vec3),
    /// Grains in a box inside a larger packing. The packing should extend beyond the box by the largest
    /// distance that is counted.
    Core {
        /// Lowest corner (m).
        low: Vec3,
        /// Highest corner (m).
        high: Vec3,
    },
    /// All grains whose center is in a box that bounds the centers: for a container with walls, the
    /// container minus one radius on each side. Shells are cut at its faces.
    Bounded {
        /// Lowest corner (m).
        low: Vec3,
        /// Highest corner (m).
        high: Vec3,
    },
}

impl Region {
    /// The box (m).
    fn corners(&self) -> [Vec3; 2] {
        match *self {
            Self::Periodic(period) => [Vec3::zeros(), period],
            Self::Core { low, high } | Self::Bounded { low, high } => [low, high],
        }
    }

    fn volume(&self) -> Real {
        let [low, high] = self.corners();
        (high - low).product()
    }

    /// True if the grain at `point` (m) is in the sample.
    fn contains(&self, point: &Vec3) -> bool {
        let [low, high] = self.corners();
        matches!(self, Self::Periodic(_))
            || (0..3).all(|k| low[k] <= point[k] && point[k] < high[k])
    }

    fn period(&self) -> Option<&Vec3> {
        if let Self::Periodic(period) = self { Some(period) } else { None }
    }
}

/// Radial distribution function of center-to-center distances in each bin.
pub fn radial_distribution(positions: &[Vec3], region: &Region, bins: &Bins) -> Vec<Real> {
    let mut counts = vec![0_u64; bins.n_bins];
    let n_centers = each_distance(positions, region, bins.reach(), |_, _, distance| {
        if let Some(k) = bins.of(distance) {
            counts[k] += 1;
        }
    });
    let density = real(n_centers) / region.volume();
    let shell =
        |k: usize| 4.0 / 3.0 * PI * bins.width.powi(3) * (real(k + 1).powi(3) - real(k).powi(3));
    let shells = shells_inside(positions, region, bins);
    let g = |(k, &n): (usize, &u64)| {
        let n_shells = shells.as_ref().map_or(real(n_centers), |shells| shells[k]);
        let n_expected = n_shells.max(Real::MIN_POSITIVE) * density * shell(k);
        if n == 0 { 0.0 } else { real_of(n) / n_expected }
    };
    counts.iter().enumerate().map(g).collect()
}

/// Radial distribution of the grains that intersect a sphere, eq. 42, at the centers of the bins.
pub fn cut_distribution(
    positions: &[Vec3],
    radii: &[Real],
    region: &Region,
    bins: &Bins,
) -> Vec<Real> {
    let largest = radii.iter().copied().fold(0.0, Real::max);
    let mean = radii.iter().sum::<Real>() / real(radii.len().max(1));
    // A grain intersects from distance − R to distance + R; the count changes at both ends.
    let mut changes = vec![0_i64; bins.n_bins + 1];
    let reach = bins.reach() + largest;
    let n_centers = each_distance(positions, region, reach, |_, j, distance| {
        let first = |r: Real| index((r / bins.width - 0.5).ceil().max(0.0)).min(bins.n_bins);
        changes[first(distance - radii[j])] += 1;
        changes[first(distance + radii[j])] -= 1;
    });
    let shells = shells_inside(positions, region, bins);
    let mut cut = 0_i64;
    (0..bins.n_bins)
        .map(|k| {
            cut += changes[k];
            let n = real_of(u64::try_from(cut).unwrap_or(0));
            let n_shells = shells.as_ref().map_or(real(n_centers.max(1)), |shells| shells[k]);
            let n_shells = n_shells.max(Real::MIN_POSITIVE);
            if n == 0.0 { 0.0 } else { n / (n_shells * 4.0 * PI * (bins.center(k) / mean).powi(2)) }
        })
        .collect()
}

/// For each bin, the total of the fractions of all shells that are inside a bounded sample; `None` if no
/// shell is cut.
fn shells_inside(positions: &[Vec3], region: &Region, bins: &Bins) -> Option<Vec<Real>> {
    let Region::Bounded { low, high } = region else { return None };
    let mut shells = vec![0.0; bins.n_bins];
    for center in positions.iter().filter(|p| region.contains(p)) {
        let to_wall = (center - low).inf(&(high - center)).min();
        let mut below = 0.0;
        for (k, shells) in shells.iter_mut().enumerate() {
            let (inner, outer) = (real(k) * bins.width, real(k + 1) * bins.width);
            let ball = 4.0 / 3.0 * PI * outer.powi(3);
            let part =
                if outer <= to_wall { ball } else { sphere_in_box(center, outer, low, high) };
            *shells += (part - below) / (ball - 4.0 / 3.0 * PI * inner.powi(3));
            below = part;
        }
    }
    Some(shells)
}

/// Calls `visit` with center, partner and distance of all pairs closer than `reach`. Returns the number
/// of centers.
fn each_distance(
    positions: &[Vec3],
    region: &Region,
    reach: Real,
    mut visit: impl FnMut(usize, usize, Real),
) -> usize {
    let points = PointSearch::new(positions, reach / 2.0, region.period());
    let is_partner =
        |j: usize| !matches!(region, Region::Bounded { .. }) || region.contains(&positions[j]);
    let mut n_centers = 0;
    let mut partners = Vec::new();
    for (i, center) in positions.iter().enumerate().filter(|(_, p)| region.contains(p)) {
        n_centers += 1;
        partners.clear();
        // Because wrapping rounds, the search range is slightly larger.
        points.visit(&points.at(i), reach * (1.0 + 1e-9), |j, _| partners.push(j));
        if region.period().is_some() {
            partners.sort_unstable();
            partners.dedup();
        }
        for &j in partners.iter().filter(|&&j| j != i && is_partner(j)) {
            let delta = positions[j] - center;
            let delta = region.period().map_or(delta, |period| closest_image(delta, period));
            let squared = delta.norm_squared();
            if squared < reach * reach {
                visit(i, j, squared.sqrt());
            }
        }
    }
    n_centers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::{Random, Stream};

    /// Face-centered cubic lattice, touching spheres of diameter 1: `n` cells along each edge.
    fn fcc(n: usize) -> (Vec<Vec3>, Vec3) {
        let edge = 2.0_f64.sqrt();
        let basis = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
        let mut positions = Vec::new();
        for cell in 0..n * n * n {
            let corner = Vec3::new(real(cell % n), real(cell / n % n), real(cell / n / n));
            positions.extend(basis.map(|b| (corner + Vec3::from(b)) * edge));
        }
        (positions, Vec3::repeat(real(n) * edge))
    }

    /// Oracle: the shells of the lattice, 12 neighbors at 1, 6 at √2, 24 at √3, 12 at 2; nothing
    /// between. Exact: the pairs are recovered from g.
    #[test]
    fn a_lattice_has_its_shells() {
        let (positions, period) = fcc(4);
        let bins = Bins { width: 0.02, n_bins: 130 };
        let density = real(positions.len()) / period.product();
        let expect = [(1.0, 12.0), (2.0_f64.sqrt(), 6.0), (3.0_f64.sqrt(), 24.0), (2.0, 12.0)];
        let core = Region::Core { low: period * 0.3, high: period * 0.55 };
        for region in [Region::Periodic(period), core] {
            let g = radial_distribution(&positions, &region, &bins);
            for (at, neighbors) in expect {
                let k = index(at / bins.width);
                // The shell may be on the boundary of two bins.
                let n: Real = (k - 1..=k + 1)
                    .map(|k| {
                        let (r, s) = (real(k) * bins.width, real(k + 1) * bins.width);
                        g[k] * density_in(&region, &positions, density) * 4.0 / 3.0
                            * PI
                            * (s.powi(3) - r.powi(3))
                    })
                    .sum();
                assert!((n - neighbors).abs() < 1e-6, "{region:?} {at}: {n}");
            }
            assert!(g[60] == 0.0 && g[80] == 0.0, "between the shells");
        }
    }

    /// Density by which the distribution was normalized.
    fn density_in(region: &Region, positions: &[Vec3], density: Real) -> Real {
        match region {
            Region::Periodic(_) => density,
            Region::Core { low, high } | Region::Bounded { low, high } => {
                let inside = |p: &&Vec3| (0..3).all(|k| low[k] <= p[k] && p[k] < high[k]);
                real(positions.iter().filter(inside).count()) / (high - low).product()
            }
        }
    }

    /// Oracle: without correlations g = 1, and eq. 42 tends to 3 φ/(2π) (1 + R̄²/(3 r²)). Tolerance
    /// 2 %: 4000 points, half a million pairs in the bins that are averaged.
    #[test]
    fn without_correlations_both_have_their_limits() {
        let mut random = Random::new(2, Stream::Position);
        let period = Vec3::repeat(1.0);
        let positions: Vec<Vec3> = (0..4000).map(|_| Vec3::from_fn(|_, _| random.unit())).collect();
        let radius: Real = 0.03;
        let radii = vec![radius; 4000];
        let bins = Bins { width: 0.01, n_bins: 40 };
        let region = Region::Periodic(period);
        let g = radial_distribution(&positions, &region, &bins);
        let mean = g[20..].iter().sum::<Real>() / 20.0;
        assert!((mean - 1.0).abs() < 0.02, "{mean}");
        let phi = 4000.0 * 4.0 / 3.0 * PI * radius.powi(3);
        let eq42 = cut_distribution(&positions, &radii, &region, &bins);
        for k in [20, 30, 39] {
            let r = bins.center(k);
            let expected = 3.0 * phi / (2.0 * PI) * (1.0 + radius * radius / (3.0 * r * r));
            assert!((eq42[k] / expected - 1.0).abs() < 0.02, "{} {expected}", eq42[k]);
        }
    }

    /// Oracle: φ = π/√18 for touching spheres on the lattice. Because the cuts are exact, it holds for any
    /// cell of the lattice, to rounding.
    #[test]
    fn a_lattice_has_its_solid_fraction_wherever_it_is_cut() {
        let (positions, period) = fcc(4);
        let n = positions.len();
        let radii = vec![0.5; n];
        let edge = period.x / 4.0;
        for shift in [Vec3::zeros(), Vec3::new(0.13, -0.2, 0.31)] {
            let low = Vec3::repeat(edge) + shift;
            let high = low + Vec3::repeat(edge);
            let phi = solid_fraction(&positions, &radii, &low, &high);
            assert!((phi - PI / 18.0_f64.sqrt()).abs() < 1e-13, "{phi}");
        }
    }

    /// Oracle: uncorrelated points have g = 1 also in a box with walls, up to distances at which most
    /// shells leave the box. Tolerance 2 %: as above.
    #[test]
    fn shells_cut_at_the_walls_do_not_thin_the_distribution() {
        let mut random = Random::new(5, Stream::Position);
        let [low, high] = [Vec3::new(-0.5, 0.0, 2.0), Vec3::new(0.5, 1.0, 2.6)];
        let at = |low: Real, high: Real, unit: Real| low + (high - low) * unit;
        let positions: Vec<Vec3> =
            (0..4000).map(|_| Vec3::from_fn(|k, _| at(low[k], high[k], random.unit()))).collect();
        let bins = Bins { width: 0.02, n_bins: 40 };
        let g = radial_distribution(&positions, &Region::Bounded { low, high }, &bins);
        for range in [10..20, 20..30, 30..40] {
            let mean = g[range].iter().sum::<Real>() / 10.0;
            assert!((mean - 1.0).abs() < 0.02, "{mean}");
        }
    }

    /// Oracle: 6, 12 and 8 neighbors at 1, √2 and √3 in the simple cubic lattice; that of eq. 42 by hand:
    /// the sphere of radius 1 about a grain of radius 1/2 intersects its 6 neighbors and the 12 whose centers
    /// are √2 away.
    #[test]
    fn a_simple_cubic_lattice_has_its_coordination_numbers() {
        let n = 10;
        let positions: Vec<Vec3> = (0..n * n * n)
            .map(|k| Vec3::new(real(k % n), real(k / n % n), real(k / n / n)))
            .collect();
        let region = Region::Periodic(Vec3::repeat(real(n)));
        let bins = Bins { width: 0.011, n_bins: 170 };
        let g = radial_distribution(&positions, &region, &bins);
        for (at, neighbors) in [(1.0, 6.0), (2.0_f64.sqrt(), 12.0), (3.0_f64.sqrt(), 8.0)] {
            let k = index(at / bins.width);
            let (r, s) = (real(k) * bins.width, real(k + 1) * bins.width);
            let found = g[k] * 4.0 / 3.0 * PI * (s.powi(3) - r.powi(3));
            assert!((found - neighbors).abs() < 1e-9, "{at}: {found}");
        }
        let wide = Bins { width: 0.08, n_bins: 20 };
        let cut = cut_distribution(&positions, &vec![0.5; n * n * n], &region, &wide);
        // The center of bin 12 is 1.
        let expected = 18.0 / (4.0 * PI * 4.0);
        assert!((cut[12] / expected - 1.0).abs() < 1e-12, "{} {expected}", cut[12]);
    }

    /// Oracle: brute force over all pairs, with points that have moved into other periods.
    #[test]
    fn the_search_finds_every_pair_once() {
        let mut random = Random::new(6, Stream::Position);
        let period = Vec3::new(1.0, 1.3, 0.9);
        let positions: Vec<Vec3> =
            (0..300).map(|_| Vec3::from_fn(|_, _| random.between(-3.0, 3.0))).collect();
        let (mut n_found, mut n_pairs) = (0, 0);
        let n_centers =
            each_distance(&positions, &Region::Periodic(period), 0.44, |_, _, _| n_found += 1);
        for a in &positions {
            for b in &positions {
                let distance = closest_image(a - b, &period).norm();
                n_pairs += usize::from(0.0 < distance && distance < 0.44);
            }
        }
        assert_eq!((n_centers, n_found), (300, n_pairs));
    }
}
