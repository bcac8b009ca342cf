//! The point of a triangle closest to a given point, and the feature on which it lies.
//!
//! ```text
//! x_c = w_1 r_1 + w_2 r_2 + w_3 r_3,   w_1 + w_2 + w_3 = 1
//!
//! face     if all w > ε
//! edge     if some w_k ≤ ε: the given point is outside the opposite edge, and x_c is clamped to that edge
//! vertex   if x_c is clamped to within ε of an end of the edge
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | x_c | closest point | m |
//! | r_k, w_k | corners of the triangle, barycentric weights | m, – |
//! | ε | 10⁻¹² | – |
//!
//! Source: Götz (2024), eqs. 26, 27. The source tests for exact zeros. Here ε makes two triangles agree
//! on a point on their common edge in spite of rounding, so that a contact there is counted once. A
//! point outside one edge is closest to that edge; a point outside two, to the nearer one. The closest
//! point is continuous across all regions. Valid for triangles with positive area.

use crate::base::{
    Real, Vec3,
    lanes::{Lanes, Mask, Vector},
    real::to_index,
};

/// Weights up to this count as zero: far above rounding, far below any relevant length.
const ZERO_WEIGHT: Real = 1e-12;

/// A part of a triangle. Edge `k` joins vertices `k` and `k + 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Vertex 0, 1 or 2.
    Vertex(u8),
    /// Edge 0, 1 or 2.
    Edge(u8),
    /// The interior.
    Face,
}

impl Feature {
    /// The feature with this number, see `ClosestLanes::feature`.
    #[inline(always)]
    pub fn of_number(number: Real) -> Self {
        const ALL: [Feature; 7] = [
            Feature::Vertex(0),
            Feature::Vertex(1),
            Feature::Vertex(2),
            Feature::Edge(0),
            Feature::Edge(1),
            Feature::Edge(2),
            Feature::Face,
        ];
        ALL[to_index(number)]
    }

    /// Face 3, edge 2, vertex 1. Of equal contacts with adjacent triangles, the one with the highest priority counts.
    pub fn priority(self) -> u8 {
        match self {
            Self::Vertex(_) => 1,
            Self::Edge(_) => 2,
            Self::Face => 3,
        }
    }
}

/// The point of a triangle that is closest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The closest point (m).
    pub point: Vec3,
    /// Its barycentric weights: not negative, with the sum 1.
    pub weights: [Real; 3],
    /// The feature on which it lies.
    pub feature: Feature,
}

/// The closest point of one triangle in each lane.
#[derive(Clone, Copy)]
pub struct ClosestLanes<L> {
    /// Vector from the closest point to the given one (m).
    pub to_given: Vector<L>,
    /// Squared distance (m²).
    pub distance_squared: L,
    /// Barycentric weights of the closest point.
    pub weights: [L; 3],
    /// Number of the `Feature`: 0 to 2 for vertices, 3 to 5 for edges, 6 for the face.
    pub feature: L,
}

/// The point of `triangle` (m) closest to `p` (m).
#[inline(always)]
pub fn closest_on_triangle(p: &Vec3, triangle: [&Vec3; 3]) -> Closest {
    let found = closest(Vector::from(*p), triangle.map(|corner| Vector::from(*corner)));
    Closest {
        point: p - Vec3::from(found.to_given),
        weights: found.weights,
        feature: Feature::of_number(found.feature),
    }
}

/// The points of triangles closest to the points `p` (m), in each lane.
#[inline(always)]
pub fn closest<L: Lanes>(p: Vector<L>, triangle: [Vector<L>; 3]) -> ClosestLanes<L> {
    let [a, b, c] = triangle;
    let (zero, one, zero_weight) = (L::splat(0.0), L::splat(1.0), L::splat(ZERO_WEIGHT));
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (bb, bc, cc) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
    let (pb, pc) = (ap.dot(ab), ap.dot(ac));
    let inverse = one / (bb * cc - bc * bc);
    let w1 = (cc * pb - bc * pc) * inverse;
    let w2 = (bb * pc - bc * pb) * inverse;
    let w0 = one - w1 - w2;
    let mut weights = [w0, w1, w2];
    let mut point = a + ab * w1 + ac * w2;
    let mut feature = L::splat(FACE);
    let is_face = zero_weight.lt(w0).and(zero_weight.lt(w1)).and(zero_weight.lt(w2));
    if is_face.not().any() {
        // Vertex k is opposite to edge k + 1. Selects the nearest of the edges that have `p` on their outer side.
        let opposite_weights = [w2, w0, w1];
        let mut nearest = L::splat(Real::INFINITY);
        for edge in 0..3 {
            let next = (edge + 1) % 3;
            let is_outside = is_face.not().and(zero_weight.lt(opposite_weights[edge]).not());
            if !is_outside.any() {
                continue;
            }
            let (from, to) = (triangle[edge], triangle[next]);
            let side = to - from;
            let share = ((p - from).dot(side) / side.dot(side)).max(zero).min(one);
            let offset = p - (from + side * share);
            let distance_squared = offset.dot(offset);
            let is_nearer = is_outside.and(distance_squared.lt(nearest));
            nearest = distance_squared.or_where(is_nearer, nearest);
            // Within rounding of an end, it is the end.
            let (at_from, at_to) = (share.le(zero_weight), (L::splat(1.0 - ZERO_WEIGHT)).le(share));
            let share = zero.or_where(at_from, one.or_where(at_to, share));
            let number = L::splat(VERTEX[edge])
                .or_where(at_from, L::splat(VERTEX[next]).or_where(at_to, L::splat(EDGE[edge])));
            let on_edge = from * (one - share) + to * share;
            point = on_edge.or_where(is_nearer, point);
            feature = number.or_where(is_nearer, feature);
            weights[edge] = (one - share).or_where(is_nearer, weights[edge]);
            weights[next] = share.or_where(is_nearer, weights[next]);
            let opposite = (edge + 2) % 3;
            weights[opposite] = zero.or_where(is_nearer, weights[opposite]);
        }
    }
    let to_given = p - point;
    ClosestLanes { to_given, distance_squared: to_given.dot(to_given), weights, feature }
}

/// Numbers of the features: vertices, edges, face.
const VERTEX: [Real; 3] = [0.0, 1.0, 2.0];
const EDGE: [Real; 3] = [3.0, 4.0, 5.0];
const FACE: Real = 6.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::{Random, Stream};

    fn random_vector(random: &mut Random, size: Real) -> Vec3 {
        Vec3::from_fn(|_, _| random.between(-size, size))
    }

    #[test]
    fn no_point_of_the_triangle_is_closer() {
        let mut random = Random::new(1, Stream::Position);
        for _ in 0..2000 {
            let [a, b, c]: [Vec3; 3] = std::array::from_fn(|_| random_vector(&mut random, 1.0));
            let p = random_vector(&mut random, 2.0);
            let found = closest_on_triangle(&p, [&a, &b, &c]);
            // Oracle: the definition of the projection on a convex set, (p − x_c)·(y − x_c) ≤ 0 for all
            // points y of the set; by linearity, the vertices suffice. Tolerance: rounding of
            // products of lengths up to 4, amplified by slender random triangles.
            for y in [a, b, c] {
                assert!((p - found.point).dot(&(y - found.point)) < 1e-9, "{found:?}");
            }
            // Oracle: eq. 27. Tolerance: rounding of lengths about 1, slender triangles.
            let [w0, w1, w2] = found.weights;
            assert!((w0 + w1 + w2 - 1.0).abs() < 1e-15, "the weights do not sum to 1: {found:?}");
            assert!(found.weights.iter().all(|&w| w >= 0.0), "a weight is negative: {found:?}");
            assert!((a * w0 + b * w1 + c * w2 - found.point).norm() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn features_match_their_regions() {
        let (a, b, c) = (Vec3::zeros(), Vec3::x(), Vec3::y());
        let at = |x, y| closest_on_triangle(&Vec3::new(x, y, 0.3), [&a, &b, &c]).feature;
        // Oracle: by hand, for a right triangle at the origin.
        assert_eq!(at(0.2, 0.2), Feature::Face);
        assert_eq!(at(0.5, -0.2), Feature::Edge(0));
        assert_eq!(at(0.8, 0.8), Feature::Edge(1));
        assert_eq!(at(-0.2, 0.5), Feature::Edge(2));
        assert_eq!(at(-0.1, -0.1), Feature::Vertex(0));
        assert_eq!(at(1.5, 0.1), Feature::Vertex(1));
        assert_eq!(at(0.1, 1.5), Feature::Vertex(2));
        // On a border within rounding: the lower feature, the same from both sides.
        assert_eq!(at(0.5, 1e-14), Feature::Edge(0));
        assert_eq!(at(1e-14, -1e-14), Feature::Vertex(0));
    }

    #[test]
    fn the_closest_point_is_continuous_across_regions() {
        let (a, b, c) = (Vec3::zeros(), Vec3::x(), Vec3::new(-0.4, 0.3, 0.0)); // obtuse
        let mut random = Random::new(2, Stream::Position);
        for _ in 0..200 {
            let (from, to) = (random_vector(&mut random, 1.5), random_vector(&mut random, 1.5));
            let n_steps = 1000;
            let mut last = None;
            for k in 0..=n_steps {
                let p = from.lerp(&to, Real::from(k) / Real::from(n_steps));
                let point = closest_on_triangle(&p, [&a, &b, &c]).point;
                if let Some((p_last, point_last)) = last {
                    let (step, result): (Vec3, Vec3) = (p - p_last, point - point_last);
                    // Oracle: projection on a convex set does not lengthen a step. Tolerance:
                    // rounding, and the snap to features within 10⁻¹².
                    assert!(result.norm() <= step.norm() + 1e-11, "jump of {}", result.norm());
                }
                last = Some((p, point));
            }
        }
    }
}
