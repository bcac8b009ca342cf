//! How several contacts of a grain with the membrane share the force, so that it is continuous.
//!
//! A grain touches the membrane at the local minima of its distance to it. When the grain moves, a minimum
//! can vanish: it merges at a saddle with a deeper minimum next to it. Its force must have decreased to
//! zero by then.
//!
//! ```text
//! F_i = c_i F(ξ_i),   c_i = q_i / (q_i + Σ_(j≠i) s_ij q_j),   q_i = ξ_i h_i
//! h_i = min_j w_ij / (w_ij + w_ji),   w_ij = √(b_ij² − d_i²)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | F(ξ) | force of the contact law | N |
//! | c_i | share of minimum i, from 0 to 1 | – |
//! | ξ_i | overlap of minimum i | m |
//! | d_i | distance of the grain's center from minimum i | m |
//! | b_ij | height of the saddle between i and j: the smallest possible maximum of the distance along a path on the membrane from i to j; R if every path leaves the grain | m |
//! | w_ij | separation of minimum i from the saddle to j; on flat triangles the distance along the surface | m |
//! | h_i | persistence of minimum i: 0 at a saddle, 1 if it is alone | – |
//! | s_ij | similarity: 1 if the normals differ by up to 10°, 0.05 from 45° on | – |
//!
//! Two minima in a shallow valley have s = 1. They are one patch of a smooth membrane: their shares add up
//! to 1, and the force passes from one to the other as the grain crosses the valley. Two sides of a fold
//! each have nearly their full force until one of them is about to vanish. A single minimum has c = 1: on a
//! flat membrane nothing is shared. The shares are continuous in the grain's position, because saddle
//! heights are.
//!
//! Source: none; this rule was developed for jamgrip. Like other sharing rules it is not the gradient of an
//! energy. Measured: a jammed gripper comes to rest down to 10⁻¹³ J, and the oscillation of a gripped object
//! decays. Valid for at most `N_TOUCHED` triangles per grain.
//!
//! Rejected: shares by the distance from the triangle's edge. They cannot distinguish a ridge, where the
//! contact continues, from a valley, where it ends, and left jumps of a fifth of the force. A vertex of 5 mg
//! responds to such a jump as to an impact.

use crate::{
    base::{Real, Vec3},
    physics::state::N_PATCHES,
};

/// Cosine of the angle between normals up to which two contacts are one patch (10°).
const ONE_PATCH: Real = 0.985;
/// Cosine of the angle beyond which they are two patches (45°).
const TWO_PATCHES: Real = 0.707;
/// Similarity of two distinct patches. It must not be zero, so that the force of a vanishing one decreases to zero.
const SIMILARITY_MIN: Real = 0.05;
/// Lower limit of h: three minima that vanish at once must not cause a division by zero.
const PERSISTENCE_MIN: Real = 1e-9;
/// Largest number of triangles that one grain can touch at a time; the deepest are kept. A grain much larger
/// than the triangles would need more.
pub(super) const N_TOUCHED: usize = 24;
/// Largest number of edges shared by that many triangles.
const N_SADDLES: usize = 3 * N_TOUCHED / 2;

/// A local minimum of a grain's distance to the membrane.
#[derive(Clone, Copy)]
pub(super) struct Minimum {
    /// Its index in the list of touched triangles.
    pub(super) index: usize,
    /// Unit normal from membrane to grain.
    pub(super) normal: Vec3,
    /// Overlap ξ = R − d (m).
    pub(super) overlap: Real,
    /// Squared distance d² of the grain's center (m²).
    pub(super) distance_squared: Real,
}

/// All edges between touched triangles, which may be saddles.
#[derive(Clone, Copy)]
pub(super) struct Saddles {
    n: usize,
    /// Squared distances of the grain's center from the edges (m²); infinite from index `n` on.
    heights_squared: [Real; N_SADDLES],
    /// Indices of both triangles in the list of touched triangles.
    between: [[u8; 2]; N_SADDLES],
}

impl Saddles {
    /// No edges.
    pub(super) const fn new() -> Self {
        Self { n: 0, heights_squared: [Real::INFINITY; N_SADDLES], between: [[0; 2]; N_SADDLES] }
    }

    /// Adds an edge between the triangles with these indices.
    #[inline(always)]
    pub(super) fn add(&mut self, between: [u8; 2], height_squared: Real) {
        self.heights_squared[self.n] = height_squared;
        self.between[self.n] = between;
        self.n += 1;
    }

    /// Removes and returns the lowest edge.
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

/// A small index as a byte.
#[expect(clippy::cast_possible_truncation, reason = "indices are below N_TOUCHED")]
pub(super) fn short(index: usize) -> u8 {
    index as u8
}

/// Share c of each minimum of a grain with R = `radius` (m).
pub(super) fn shares(minima: &[Minimum], saddles: &mut Saddles, radius: Real) -> [Real; N_PATCHES] {
    let heights = heights(minima, saddles, radius * radius);
    // Quantities of pairs of minima, computed once for both.
    let (mut widths, mut similarities) =
        ([[0.0; N_PATCHES]; N_PATCHES], [[0.0; N_PATCHES]; N_PATCHES]);
    for (i, one) in minima.iter().enumerate() {
        for (j, other) in minima[..i].iter().enumerate() {
            let width = |it: &Minimum| (heights[i][j] - it.distance_squared).max(0.0).sqrt();
            (widths[i][j], widths[j][i]) = (width(one), width(other));
            let similarity = similarity(&one.normal, &other.normal);
            (similarities[i][j], similarities[j][i]) = (similarity, similarity);
        }
    }
    let mut weights = [0.0; N_PATCHES];
    for (i, own) in minima.iter().enumerate() {
        weights[i] = own.overlap * persistence(i, minima.len(), &widths);
    }
    let mut shares = [0.0; N_PATCHES];
    for i in 0..minima.len() {
        let mut all = weights[i];
        for j in (0..minima.len()).filter(|&j| j != i) {
            all += similarities[i][j] * weights[j];
        }
        shares[i] = weights[i] / all;
    }
    shares
}

/// Similarity s of two normals.
fn similarity(a: &Vec3, b: &Vec3) -> Real {
    let share = (a.dot(b) - TWO_PATCHES) * (1.0 / (ONE_PATCH - TWO_PATCHES));
    let share = share.clamp(0.0, 1.0);
    SIMILARITY_MIN + (1.0 - SIMILARITY_MIN) * share * share * (3.0 - 2.0 * share)
}

/// Persistence h of the `i`-th of `n` minima with separations w = `widths` (m).
fn persistence(i: usize, n: usize, widths: &[[Real; N_PATCHES]; N_PATCHES]) -> Real {
    let mut persistence: Real = 1.0;
    for j in (0..n).filter(|&j| j != i) {
        let (own, others) = (widths[i][j], widths[j][i]);
        if own < persistence * (own + others) {
            persistence = own / (own + others);
        }
    }
    persistence.max(PERSISTENCE_MIN)
}

/// Squared saddle heights b² (m²) of all pairs of minima: basins are merged at saddles in order of height until
/// all minima are in one basin.
fn heights(
    minima: &[Minimum],
    saddles: &mut Saddles,
    radius_squared: Real,
) -> [[Real; N_PATCHES]; N_PATCHES] {
    let mut heights = [[radius_squared; N_PATCHES]; N_PATCHES];
    let mut basins: [u8; N_TOUCHED] = std::array::from_fn(short);
    let mut n_basins = minima.len();
    while n_basins > 1 {
        let (height, between) = saddles.take_lowest();
        if height >= radius_squared {
            break;
        }
        let [a, b] = between.map(|index| basins[usize::from(index)]);
        if a == b {
            continue;
        }
        let mut is_joined = false;
        for (i, one) in minima.iter().enumerate() {
            if basins[one.index] == a {
                for (j, other) in minima.iter().enumerate() {
                    if basins[other.index] == b {
                        (heights[i][j], heights[j][i]) = (height, height);
                        is_joined = true;
                    }
                }
            }
        }
        n_basins -= usize::from(is_joined);
        for basin in &mut basins {
            *basin = if *basin == b { a } else { *basin };
        }
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two minima at these distances (in units of R), with `angle` (rad) between their normals.
    fn two(distances: [Real; 2], angle: Real) -> Vec<Minimum> {
        let at = |index: usize| {
            let direction = if index == 0 { 0.0 } else { angle };
            Minimum {
                index,
                normal: Vec3::new(direction.sin(), 0.0, direction.cos()),
                overlap: 1.0 - distances[index],
                distance_squared: distances[index].powi(2),
            }
        };
        vec![at(0), at(1)]
    }

    fn shares_over(saddle: Real, minima: &[Minimum]) -> [Real; 2] {
        let mut saddles = Saddles::new();
        saddles.add([0, 1], saddle * saddle);
        let [a, b, ..] = shares(minima, &mut saddles, 1.0);
        [a, b]
    }

    #[test]
    fn similar_normals_share_one_force_and_different_ones_do_not() {
        // Oracle: c = 1/2 each by symmetry, and 1/(1 + 0.05). Tolerance: rounding.
        let similar = shares_over(0.95, &two([0.9, 0.9], 0.1));
        assert!(
            (similar[0] - 0.5).abs() < 1e-12 && (similar[1] - 0.5).abs() < 1e-12,
            "{similar:?}"
        );
        let different = shares_over(0.95, &two([0.9, 0.9], 1.0));
        assert!((different[0] - 1.0 / 1.05).abs() < 1e-12, "{different:?}");
    }

    #[test]
    fn a_minimum_at_the_saddle_has_no_share() {
        for angle in [0.1, 0.4, 1.0] {
            // Oracle: h = 0 and 1. Tolerance: the smallest persistence over the smallest similarity.
            let [vanishing, remaining] = shares_over(0.95, &two([0.95, 0.9], angle));
            assert!(vanishing < 2e-8, "{vanishing}");
            assert!((remaining - 1.0).abs() < 2e-8, "{remaining}");
        }
    }

    #[test]
    fn the_lowest_path_over_saddles_counts() {
        // Triangles 0 and 1 have minima; 2 to 4 lie between them on two paths.
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
