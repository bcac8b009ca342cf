//! Bending: each hinge resists folding about its edge.
//!
//! ```text
//! F_i = k_el |e|²/(|n1| + |n2|) (sin θ/2 − sin θ⁰/2) u_i  −  k_diss |e| θ̇ u_i,   θ̇ := Σ u_j · v_j
//!
//! u1 = |e| n1/|n1|²                    u3 =    a1  u1 +    a2  u2
//! u2 = |e| n2/|n2|²                    u4 = −(1+a1) u1 − (1+a2) u2
//! a1 = (r1 − r4)·e/|e|²,  a2 = (r2 − r4)·e/|e|²
//!
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | F_i, r_i, v_i | force, position and velocity of the hinge's vertices: r3, r4 at the ends of the edge, r1, r2 opposite | N, m, m/s |
//! | e | edge r4 − r3 | m |
//! | n1, n2 | area normals of the two triangles, \|n\| = 2 · area | m² |
//! | θ, θ⁰ | angle between the normals, with the sign of (n1 × n2) · e; θ⁰ at rest | rad |
//! | u_i | −∂θ/∂r_i | 1/m |
//! | k_el | elastic bending constant | N m |
//! | k_diss | dissipative bending constant | N s |
//!
//! Source: Bridson, Marino & Fedkiw (2003), in the form of Götz (2024), eqs. 17–25. With this sign of
//! θ, the u_i are −∂θ/∂r_i, so θ̇ above is minus the true rate; the true rate would add energy.
//! The current areas are used: with initial areas the torques of a stretched hinge do not cancel.
//! Initial areas are available for scenes that require them (`Fold::with_areas`).
//!
//! Valid for |θ| < π and triangles with positive area. A regular lattice has the plate stiffness
//! D = k_el/4 and the bending Poisson's ratio −1/3.
//!
//! No angle is computed: sin θ = −|e| n1·(r2 − r3)/(|n1||n2|) and cos θ give sin θ/2 with one square
//! root, via cos θ/2 for |θ| ≤ 90° and directly above, so that no digits are lost at either end.

use super::Side;
use crate::base::lanes::{Lanes, Mask, Vector};

/// The geometry of a hinge at one instant, in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Fold<L> {
    /// −∂θ/∂r_1 (1/m).
    pub u1: Vector<L>,
    /// −∂θ/∂r_2 (1/m).
    pub u2: Vector<L>,
    /// Position of the foot of r1 along the edge: 0 at r4, −1 at r3.
    pub a1: L,
    /// Position of the foot of r2 along the edge.
    pub a2: L,
    /// sin θ/2, with sign.
    pub half_sine: L,
    /// |e|²/(|n1| + |n2|), without unit.
    pub slenderness: L,
}

impl<L: Lanes> Fold<L> {
    /// The hinge of the triangles `sides` with corners r1 to r4 (m) and the edge e = r4 − r3 (m). `lengths` are
    /// the length of the edge (m) and its inverse (1/m).
    #[inline(always)]
    pub fn new(r: [Vector<L>; 4], sides: [Side<L>; 2], edge: Vector<L>, lengths: [L; 2]) -> Self {
        let [f1, f2] = sides;
        let [length, inverse] = lengths;
        let inverse_square = inverse * inverse;
        let both = f1.inverse_norm * f2.inverse_norm;
        let cosine = f1.area_normal.dot(f2.area_normal) * both;
        let sine = -length * both * f1.area_normal.dot(r[1] - r[2]);
        Self {
            u1: f1.area_normal * (length * f1.inverse_norm * f1.inverse_norm),
            u2: f2.area_normal * (length * f2.inverse_norm * f2.inverse_norm),
            a1: (r[0] - r[3]).dot(edge) * inverse_square,
            a2: (r[1] - r[3]).dot(edge) * inverse_square,
            half_sine: half_sine(sine, cosine),
            slenderness: length * length * both / (f1.inverse_norm + f2.inverse_norm),
        }
    }

    /// The same hinge with the areas of its triangles in the reference shape: `first` are twice these areas
    /// (m²), `sides` and `length` (m) the current triangles and edge. Strongly compressed triangles then keep a
    /// finite stiffness, but the internal torques do not cancel if the two are stretched differently.
    #[inline(always)]
    pub fn with_areas(mut self, first: [L; 2], sides: [Side<L>; 2], length: L) -> Self {
        self.u1 = self.u1 / (sides[0].inverse_norm * first[0]);
        self.u2 = self.u2 / (sides[1].inverse_norm * first[1]);
        self.slenderness = length * length / (first[0] + first[1]);
        self
    }

    /// Σ u_i · x_i for vectors x_i at the four vertices.
    #[inline(always)]
    pub fn project(&self, x: [Vector<L>; 4]) -> L {
        let along = x[3] - x[2];
        self.u1.dot(x[0] - x[3] - along * self.a1) + self.u2.dot(x[1] - x[3] - along * self.a2)
    }

    /// `scale` · u_i at the four vertices. The sum is zero.
    #[inline(always)]
    pub fn spread(&self, scale: L) -> [Vector<L>; 4] {
        let (f1, f2) = (self.u1 * scale, self.u2 * scale);
        let f3 = f1 * self.a1 + f2 * self.a2;
        [f1, f2, f3, -(f1 + f2 + f3)]
    }
}

/// sin θ/2 from sin θ and cos θ for −π < θ < π.
#[inline(always)]
pub fn half_sine<L: Lanes>(sine: L, cosine: L) -> L {
    let half = L::splat(0.5);
    let larger = (half + half * cosine.copysign(L::splat(1.0))).sqrt();
    let is_wide = cosine.lt(L::splat(0.0));
    let mut half_sine = half * sine / larger;
    if is_wide.any() {
        half_sine = larger.copysign(sine).or_where(is_wide, half_sine);
    }
    half_sine
}
