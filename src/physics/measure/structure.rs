//! How grains are arranged: solid fraction of a region, and how many are how far from each other.
//!
//! ```text
//! g(r)  = ⟨pairs at r … r + Δ⟩ / (ρ_n 4/3 π ((r + Δ)³ − r³))        centre to centre, → 1 far away
//! g₄₂(r) = 1/N Σ_i n_i(r) / (4π (r/R̄)²)                             Götz (2024), eq. 42
//!
//! n_i(r)  grains that the sphere of radius r about grain i cuts       [-]
//! ρ_n     grains per volume                                          [1/m³]
//! R̄       mean radius                                                [m]
//! ```
//!
//! Eq. 42 counts with a kernel one diameter wide, so narrow peaks of a lattice are smeared out, and it
//! tends to 3 φ/(2π) (1 + R̄²/(3 r²)) in a packing without correlations, not to 1.

use std::f64::consts::PI;

use super::{overlap::sphere_in_box, real, real_of};
use crate::{
    base::{Real, Vec3},
    physics::{contact::grains::closest_image, state::Grains},
};

/// Share of the box from `low` to `high` [m] that grains fill, cut exactly at its faces.
pub fn solid_fraction(grains: &Grains, low: &Vec3, high: &Vec3) -> Real {
    let inside = |(centre, &radius): (&Vec3, &Real)| sphere_in_box(centre, radius, low, high);
    let solid: Real = grains.positions.iter().zip(&grains.radii).map(inside).sum();
    solid / (high - low).product()
}

/// Distances are counted in bins of `width` [m], `n_bins` of them.
#[derive(Clone, Copy, Debug)]
pub struct Bins {
    /// Width of a bin [m].
    pub width: Real,
    /// How many there are.
    pub n_bins: usize,
}

impl Bins {
    /// Middle of bin `k` [m].
    pub fn middle(&self, k: usize) -> Real {
        (real(k) + 0.5) * self.width
    }

    /// Largest distance that is counted [m].
    pub fn reach(&self) -> Real {
        real(self.n_bins) * self.width
    }

    /// The bin of `distance`.
    fn of(&self, distance: Real) -> Option<usize> {
        let k = index(distance / self.width);
        (k < self.n_bins).then_some(k)
    }
}

/// Where grains are looked at.
#[derive(Clone, Copy, Debug)]
pub enum Region {
    /// All of a periodic box with these edges [m]; half the shortest must hold the bins.
    Periodic(Vec3),
    /// Those in a box are the centres of what is counted; it should lie as deep in the packing as the
    /// bins reach.
    Core {
        /// Lowest corner [m].
        low: Vec3,
        /// Highest corner [m].
        high: Vec3,
    },
}

/// g(r) from centre to centre, bin by bin.
pub fn pair_distribution(positions: &[Vec3], region: &Region, bins: &Bins) -> Vec<Real> {
    let mut counts = vec![0_u64; bins.n_bins];
    let n_centres = each_distance(positions, region, bins.reach(), |_, _, distance| {
        if let Some(k) = bins.of(distance) {
            counts[k] += 1;
        }
    });
    let density = real(n_centres) / region_volume(region);
    let shell =
        |k: usize| 4.0 / 3.0 * PI * bins.width.powi(3) * (real(k + 1).powi(3) - real(k).powi(3));
    let g = |(k, &n): (usize, &u64)| real_of(n) / (real(n_centres.max(1)) * density * shell(k));
    counts.iter().enumerate().map(g).collect()
}

/// Eq. 42 at the middles of the bins.
pub fn cut_distribution(grains: &Grains, region: &Region, bins: &Bins) -> Vec<Real> {
    let radii = &grains.radii;
    let largest = radii.iter().copied().fold(0.0, Real::max);
    let mean = radii.iter().sum::<Real>() / real(radii.len().max(1));
    // Cut between distance − R and distance + R: counted by the change at both ends.
    let mut changes = vec![0_i64; bins.n_bins + 1];
    let reach = bins.reach() + largest;
    let n_centres = each_distance(&grains.positions, region, reach, |_, j, distance| {
        let first = |r: Real| index((r / bins.width - 0.5).ceil().max(0.0)).min(bins.n_bins);
        changes[first(distance - radii[j])] += 1;
        changes[first(distance + radii[j])] -= 1;
    });
    let mut cut = 0_i64;
    (0..bins.n_bins)
        .map(|k| {
            cut += changes[k];
            let n = real_of(u64::try_from(cut).unwrap_or(0));
            n / (real(n_centres.max(1)) * 4.0 * PI * (bins.middle(k) / mean).powi(2))
        })
        .collect()
}

/// Calls `see` with centre, partner and their distance, for all closer than `reach`; returns the
/// number of centres.
fn each_distance(
    positions: &[Vec3],
    region: &Region,
    reach: Real,
    mut see: impl FnMut(usize, usize, Real),
) -> usize {
    let is_centre = |p: &Vec3| match region {
        Region::Periodic(_) => true,
        Region::Core { low, high } => (0..3).all(|k| low[k] <= p[k] && p[k] < high[k]),
    };
    let mut n_centres = 0;
    for (i, centre) in positions.iter().enumerate().filter(|(_, p)| is_centre(p)) {
        n_centres += 1;
        for (j, other) in positions.iter().enumerate() {
            let apart = match region {
                Region::Periodic(period) => closest_image(other - centre, period),
                Region::Core { .. } => other - centre,
            };
            let squared = apart.norm_squared();
            if i != j && squared < reach * reach {
                see(i, j, squared.sqrt());
            }
        }
    }
    n_centres
}

fn region_volume(region: &Region) -> Real {
    match region {
        Region::Periodic(period) => period.product(),
        Region::Core { low, high } => (high - low).product(),
    }
}

/// A non-negative real as an index.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and what is too large is in no bin"
)]
fn index(value: Real) -> usize {
    value as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::{Random, Stream};

    /// Face-centred cubic, touching spheres of diameter 1: `n` cells along each edge.
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

    /// Oracle: the shells of the lattice, 12 neighbours at 1, 6 at √2, 24 at √3, 12 at 2; nothing
    /// between. Exact: the pairs are counted back from g.
    #[test]
    fn a_lattice_has_its_shells() {
        let (positions, period) = fcc(4);
        let bins = Bins { width: 0.02, n_bins: 130 };
        let density = real(positions.len()) / period.product();
        let expect = [(1.0, 12.0), (2.0_f64.sqrt(), 6.0), (3.0_f64.sqrt(), 24.0), (2.0, 12.0)];
        let core = Region::Core { low: period * 0.3, high: period * 0.55 };
        for region in [Region::Periodic(period), core] {
            let g = pair_distribution(&positions, &region, &bins);
            for (at, neighbours) in expect {
                let k = index(at / bins.width);
                // The shell may fall on the border of two bins.
                let n: Real = (k - 1..=k + 1)
                    .map(|k| {
                        let (r, s) = (real(k) * bins.width, real(k + 1) * bins.width);
                        g[k] * density_in(&region, &positions, density) * 4.0 / 3.0
                            * PI
                            * (s.powi(3) - r.powi(3))
                    })
                    .sum();
                assert!((n - neighbours).abs() < 1e-6, "{region:?} {at}: {n}");
            }
            assert!(g[60] == 0.0 && g[80] == 0.0, "between the shells");
        }
    }

    /// Density that the distribution was normalised by.
    fn density_in(region: &Region, positions: &[Vec3], whole: Real) -> Real {
        match region {
            Region::Periodic(_) => whole,
            Region::Core { low, high } => {
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
        let radius = 0.03;
        let (radii, masses) = (vec![radius; 4000], vec![1.0; 4000]);
        let grains = Grains::at_rest(positions, radii, masses);
        let bins = Bins { width: 0.01, n_bins: 40 };
        let region = Region::Periodic(period);
        let g = pair_distribution(&grains.positions, &region, &bins);
        let mean = g[20..].iter().sum::<Real>() / 20.0;
        assert!((mean - 1.0).abs() < 0.02, "{mean}");
        let phi = 4000.0 * 4.0 / 3.0 * PI * radius.powi(3);
        let eq42 = cut_distribution(&grains, &region, &bins);
        for k in [20, 30, 39] {
            let r = bins.middle(k);
            let expected = 3.0 * phi / (2.0 * PI) * (1.0 + radius * radius / (3.0 * r * r));
            assert!((eq42[k] / expected - 1.0).abs() < 0.02, "{} {expected}", eq42[k]);
        }
    }

    /// Oracle: φ = π/√18 for touching spheres on the lattice; exact cuts make it hold for any cell
    /// of the lattice inside, to rounding.
    #[test]
    fn a_lattice_has_its_solid_fraction_wherever_it_is_cut() {
        let (positions, period) = fcc(4);
        let n = positions.len();
        let grains = Grains::at_rest(positions, vec![0.5; n], vec![1.0; n]);
        let edge = period.x / 4.0;
        for shift in [Vec3::zeros(), Vec3::new(0.13, -0.2, 0.31)] {
            let low = Vec3::repeat(edge) + shift;
            let high = low + Vec3::repeat(edge);
            let phi = solid_fraction(&grains, &low, &high);
            assert!((phi - PI / 18.0_f64.sqrt()).abs() < 1e-13, "{phi}");
        }
    }
}
