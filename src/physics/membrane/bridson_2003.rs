//! Bending: every hinge resists folding about its edge.
//!
//! ```text
//! F_i = k_el |e|²/(|n1| + |n2|) (sin θ/2 − sin θ⁰/2) u_i  −  k_diss |e| θ̇ u_i,   θ̇ := Σ u_j · v_j
//!
//! u1 = |e| n1/|n1|²                    u3 =    a1  u1 +    a2  u2
//! u2 = |e| n2/|n2|²                    u4 = −(1+a1) u1 − (1+a2) u2
//! a1 = (r1 − r4)·e/|e|²,  a2 = (r2 − r4)·e/|e|²
//!
//! e      edge r4 − r3                                            (m)
//! n1, n2 area normals of the two triangles, |n| = 2 · area       (m²)
//! θ      angle between the normals, sign of (n1 × n2) · e        (rad)
//! k_el   elastic bending constant                                (N m)
//! k_diss dissipative bending constant                            (N s)
//! ```
//!
//! Source: Bridson, Marino, Fedkiw (2003), in the form of Götz (2024) eqs. 17–25. With this sign of
//! θ the u_i are −∂θ/∂r_i, so θ̇ above is minus the true rate; the true rate would feed energy in.
//! Current areas are taken: with initial areas the torques of a stretched hinge do not cancel. They can
//! be had where a scene asks for them (`Fold::with_areas`).
//! A regular lattice has the plate stiffness D = k_el/4 and the bending Poisson's ratio −1/3.
//!
//! No angle is computed: sin θ = −|e| n1·(r2 − r3)/(|n1||n2|) and cos θ give sin θ/2 by one square
//! root, through cos θ/2 while |θ| ≤ 90° and directly beyond, so that neither end loses digits.

use super::Side;
use crate::base::lanes::{Lanes, Mask, Vector};

/// The geometry of a hinge at one instant, in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Fold<L> {
    /// −∂θ/∂r_1 (1/m).
    pub u1: Vector<L>,
    /// −∂θ/∂r_2 (1/m).
    pub u2: Vector<L>,
    /// Where the foot of r1 lies along the edge: 0 at r4, −1 at r3.
    pub a1: L,
    /// Where the foot of r2 lies along the edge.
    pub a2: L,
    /// sin θ/2, signed.
    pub half_sine: L,
    /// |e|²/(|n1| + |n2|).
    pub slenderness: L,
}

impl<L: Lanes> Fold<L> {
    /// Folds the triangles `sides` with corners r1 to r4 about the edge e = r4 − r3, whose length
    /// and inverse length are known already.
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

    /// The same hinge with the areas that its triangles once had: `first` are twice those (m²), `sides`
    /// and `length` (m) the present triangles and edge. Triangles that are squeezed flat then keep a
    /// finite stiffness, at the price of a torque on itself where the two are stretched differently.
    #[inline(always)]
    pub fn with_areas(mut self, first: [L; 2], sides: [Side<L>; 2], length: L) -> Self {
        self.u1 = self.u1 / (sides[0].inverse_norm * first[0]);
        self.u2 = self.u2 / (sides[1].inverse_norm * first[1]);
        self.slenderness = length * length / (first[0] + first[1]);
        self
    }

    /// Σ u_i · x_i for vectors x at the four vertices.
    #[inline(always)]
    pub fn project(&self, x: [Vector<L>; 4]) -> L {
        let along = x[3] - x[2];
        self.u1.dot(x[0] - x[3] - along * self.a1) + self.u2.dot(x[1] - x[3] - along * self.a2)
    }

    /// `scale` · u_i at the four vertices; their sum is zero.
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
