//! How one grain's contacts with the membrane share out its force, so that it has no jumps.
//!
//! A grain touches the membrane where its distance to the membrane has local minima. When the grain moves, a
//! minimum can be lost: it runs over a saddle into a deeper place beside it. By then its force must
//! have faded out.
//!
//! ```text
//! F_i = c_i F(ξ_i),   c_i = q_i / (q_i + Σ_(j≠i) s_ij q_j),   q_i = ξ_i h_i
//! h_i = min_j w_ij / (w_ij + w_ji),   w_ij = √(b_ij² − d_i²)
//!
//! ξ_i  overlap of minimum i                                                       (m)
//! d_i  distance of the grain's center from it                                     (m)
//! b_ij height of the saddle between i and j: the least that the largest distance on a way over the
//!      membrane from i to j can be; R if every way leaves the grain                  (m)
//! w_ij what separates i from the saddle to j; on flat triangles the way there       (m)
//! s_ij likeness: 1 if the normals differ by up to 10°, 0.05 from 45° on
//! ```
//!
//! Two minima in a shallow valley have s = 1: they are one patch of a smooth membrane, their c add up to
//! 1, and the force passes from one to the other as the grain crosses the valley. Two sides of a fold
//! have nearly their full force each until one of them is about to be lost. A minimum that is alone
//! has c = 1: on a flat membrane nothing is shared. All of it is continuous in the grain's place, since
//! heights of saddles are. It is not the gradient of an energy, as little as other rules of sharing;
//! what was measured: a jammed bag comes to rest to 10⁻¹³ J, and an object that swings in it decays.
//!
//! Rejected: a share by the distance from the triangle's edge, which cannot tell a ridge, where the
//! contact goes on, from a valley, where it is lost; it left jumps of a fifth of the force. A vertex
//! of 5 mg feels such a jump as an impact.

use crate::{
    base::{Real, Vec3},
    physics::state::N_PATCHES,
};

/// Cosine of the angle between normals up to which two contacts are one patch (10°).
const ONE_PATCH: Real = 0.985;
/// Cosine of the angle beyond which they are two (45°).
const TWO_PATCHES: Real = 0.707;
/// What two patches far apart still know of each other: it lets a lost one fade out.
const APART: Real = 0.05;
/// Least hold: three that are lost at once must not divide by zero.
const HOLD_MIN: Real = 1e-9;
/// Triangles one grain may touch at once, the deepest; a grain much larger than the mesh would
/// need more.
pub(super) const N_TOUCHED: usize = 24;
/// Edges that so many triangles can share.
const N_SADDLES: usize = 3 * N_TOUCHED / 2;

/// A local minimum of a grain's distance to the membrane.
#[derive(Clone, Copy)]
pub(super) struct Minimum {
    /// Its index in the list of touched triangles.
    pub(super) index: usize,
    /// From membrane to grain.
    pub(super) normal: Vec3,
    /// R − d (m).
    pub(super) overlap: Real,
    /// d² (m²).
    pub(super) distance_squared: Real,
}

/// All edges between touched triangles.
#[derive(Clone, Copy)]
pub(super) struct Saddles {
    n: usize,
    /// Squared distances of the grain's center from the edges (m²); infinite from `n` on.
    heights_squared: [Real; N_SADDLES],
    /// Indices of both triangles in the list of touched ones.
    between: [[u8; 2]; N_SADDLES],
}

impl Saddles {
    /// None yet.
    pub(super) const fn new() -> Self {
        Self { n: 0, heights_squared: [Real::INFINITY; N_SADDLES], between: [[0; 2]; N_SADDLES] }
    }

    /// Adds an edge between the triangles at two indices.
    #[inline(always)]
    pub(super) fn add(&mut self, between: [u8; 2], height_squared: Real) {
        self.heights_squared[self.n] = height_squared;
        self.between[self.n] = between;
        self.n += 1;
    }

    /// Takes the lowest one out.
    #[inline(always)]
    fn take_lowest(&mut self) -> (Real, [u8; 2]) {
        let (mut lowest, mut at) = (Real::INFINITY, 0);
        for (k, &height) in self.heights_squared[..self.n].iter().enumerate() {
            if height < lowest {
                (lowest, at) = (height, k);
            }
        }
        self.heights_squared[at] = Real::INFINITY;
        (lowest, self.between[at])
    }
}

/// An index among few.
#[expect(clippy::cast_possible_truncation, reason = "indices are below N_TOUCHED")]
pub(super) fn short(index: usize) -> u8 {
    index as u8
}

/// Share c of each of several minima of a grain of radius R = `radius` (m).
pub(super) fn shares(minima: &[Minimum], saddles: &mut Saddles, radius: Real) -> [Real; N_PATCHES] {
    let heights = heights(minima, saddles, radius * radius);
    // What depends on two minima, once for both.
    let (mut to_pass, mut likenesses) =
        ([[0.0; N_PATCHES]; N_PATCHES], [[0.0; N_PATCHES]; N_PATCHES]);
    for (i, one) in minima.iter().enumerate() {
        for (j, other) in minima[..i].iter().enumerate() {
            let width = |it: &Minimum| (heights[i][j] - it.distance_squared).max(0.0).sqrt();
            (to_pass[i][j], to_pass[j][i]) = (width(one), width(other));
            let likeness = likeness(&one.normal, &other.normal);
            (likenesses[i][j], likenesses[j][i]) = (likeness, likeness);
        }
    }
    let mut weights = [0.0; N_PATCHES];
    for (i, own) in minima.iter().enumerate() {
        weights[i] = own.overlap * hold(i, minima.len(), &to_pass);
    }
    let mut shares = [0.0; N_PATCHES];
    for i in 0..minima.len() {
        let mut all = weights[i];
        for j in (0..minima.len()).filter(|&j| j != i) {
            all += likenesses[i][j] * weights[j];
        }
        shares[i] = weights[i] / all;
    }
    shares
}

/// s of two normals.
fn likeness(a: &Vec3, b: &Vec3) -> Real {
    let share = (a.dot(b) - TWO_PATCHES) * (1.0 / (ONE_PATCH - TWO_PATCHES));
    let share = share.clamp(0.0, 1.0);
    APART + (1.0 - APART) * share * share * (3.0 - 2.0 * share)
}

/// h of the `i`-th of `n` minima that are separated by these w.
fn hold(i: usize, n: usize, to_pass: &[[Real; N_PATCHES]; N_PATCHES]) -> Real {
    let mut hold: Real = 1.0;
    for j in (0..n).filter(|&j| j != i) {
        let (own, others) = (to_pass[i][j], to_pass[j][i]);
        if own < hold * (own + others) {
            hold = own / (own + others);
        }
    }
    hold.max(HOLD_MIN)
}

/// b² between all pairs of minima: saddles are opened from the lowest up, and what they join is one,
/// until all minima are joined.
fn heights(
    minima: &[Minimum],
    saddles: &mut Saddles,
    radius_squared: Real,
) -> [[Real; N_PATCHES]; N_PATCHES] {
    let mut heights = [[radius_squared; N_PATCHES]; N_PATCHES];
    let mut basins: [u8; N_TOUCHED] = std::array::from_fn(short);
    let mut n_apart = minima.len();
    while n_apart > 1 {
        let (height, between) = saddles.take_lowest();
        if height >= radius_squared {
            break;
        }
        let [a, b] = between.map(|index| basins[usize::from(index)]);
        if a == b {
            continue;
        }
        let mut joined = false;
        for (i, one) in minima.iter().enumerate() {
            if basins[one.index] == a {
                for (j, other) in minima.iter().enumerate() {
                    if basins[other.index] == b {
                        (heights[i][j], heights[j][i]) = (height, height);
                        joined = true;
                    }
                }
            }
        }
        n_apart -= usize::from(joined);
        for basin in &mut basins {
            *basin = if *basin == b { a } else { *basin };
        }
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Minima in one plane, `angle` apart (rad) as seen from the grain, at these distances over R.
    fn two(distances: [Real; 2], angle: Real) -> Vec<Minimum> {
        let at = |index: usize| {
            let turn = if index == 0 { 0.0 } else { angle };
            Minimum {
                index,
                normal: Vec3::new(turn.sin(), 0.0, turn.cos()),
                overlap: 1.0 - distances[index],
                distance_squared: distances[index].powi(2),
            }
        };
        vec![at(0), at(1)]
    }

    fn shares_over(pass: Real, minima: &[Minimum]) -> [Real; 2] {
        let mut saddles = Saddles::new();
        saddles.add([0, 1], pass * pass);
        let [a, b, ..] = shares(minima, &mut saddles, 1.0);
        [a, b]
    }

    #[test]
    fn one_patch_is_counted_once_and_two_sides_twice() {
        // Oracle: c = 1/2 each by symmetry, and 1/(1 + 0.05). Tolerance: rounding.
        let near = shares_over(0.95, &two([0.9, 0.9], 0.1));
        assert!((near[0] - 0.5).abs() < 1e-12 && (near[1] - 0.5).abs() < 1e-12, "{near:?}");
        let apart = shares_over(0.95, &two([0.9, 0.9], 1.0));
        assert!((apart[0] - 1.0 / 1.05).abs() < 1e-12, "{apart:?}");
    }

    #[test]
    fn who_reaches_the_pass_has_nothing_left_and_the_other_all() {
        for angle in [0.1, 0.4, 1.0] {
            // Oracle: h = 0 and 1. Tolerance: the least hold over the smallest likeness.
            let [lost, kept] = shares_over(0.95, &two([0.95, 0.9], angle));
            assert!(lost < 2e-8 && (kept - 1.0).abs() < 2e-8, "{lost} {kept}");
        }
    }

    #[test]
    fn the_lowest_chain_of_saddles_counts() {
        // Triangles 0 and 1 hold minima, 2 to 4 lie between them on two ways.
        let minima = two([0.8, 0.85], 0.3);
        let mut saddles = Saddles::new();
        for (between, height) in
            [([0, 2], 0.9), ([2, 1], 0.97), ([0, 3], 0.93), ([3, 4], 0.86), ([4, 1], 0.91)]
        {
            saddles.add(between, height * height);
        }
        // Oracle: by hand, min(max(0.9, 0.97), max(0.93, 0.86, 0.91)). Tolerance: rounding.
        let found = heights(&minima, &mut saddles, 1.0);
        assert!((found[0][1].sqrt() - 0.93).abs() < 1e-12);
        assert!((found[1][0].sqrt() - 0.93).abs() < 1e-12);
    }
}
