//! In-plane elasticity: a damped spring along every edge.
//!
//! ```text
//! F_1 = −r̂ [ k (r − r⁰) + 2 γ √(k m*) (r̂ · ṙ) ],   r = r_1 − r_2,   F_2 = −F_1
//! k = √3/2 E d,   m* = m_1 m_2 / (m_1 + m_2)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | F_1, F_2 | forces on the two vertices of an edge | N |
//! | r_1, r_2, m_1, m_2 | their positions and masses | m, kg |
//! | r, r̂, r⁰ | length and direction of the edge, rest length | m, –, m |
//! | k | stiffness | N/m |
//! | γ | damping ratio of the pair; 1 is critical | – |
//! | E, d | Young's modulus and thickness | Pa, m |
//!
//! Source: Götz (2024), eqs. 12–16, with the elastic sign such that a stretched spring pulls.
//! A regular lattice of such springs is an isotropic membrane with the modulus E d = 2/√3 k and
//! Poisson's ratio 1/3. A boundary edge has one triangle instead of two and gets k/2, so the
//! properties of the membrane are the same up to its boundary. Valid for small strains and nearly
//! equilateral triangles.

use crate::base::{Real, lanes::Lanes};

/// A damped spring.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Spring {
    /// Rest length (m).
    pub rest_length: Real,
    /// Stiffness k (N/m).
    pub stiffness: Real,
    /// Damping 2 γ √(k m*) (N s/m).
    pub damping: Real,
}

impl Spring {
    /// The spring between two vertices of mass `mass_1` and `mass_2` (kg) with damping ratio γ.
    pub fn new(rest_length: Real, stiffness: Real, damping_ratio: Real, masses: [Real; 2]) -> Self {
        let mass = masses[0] * masses[1] / (masses[0] + masses[1]);
        Self { rest_length, stiffness, damping: 2.0 * damping_ratio * (stiffness * mass).sqrt() }
    }

    /// Rest length (m), stiffness (N/m) and damping (N s/m).
    pub fn numbers(&self) -> [Real; 3] {
        [self.rest_length, self.stiffness, self.damping]
    }
}

/// Tension (N) of springs with the given rest length (m), stiffness (N/m) and damping (N s/m), at `length` (m)
/// increasing at `rate` (m/s). A positive tension pulls the ends together.
#[inline(always)]
pub fn tension<L: Lanes>([rest_length, stiffness, damping]: [L; 3], length: L, rate: L) -> L {
    stiffness * (length - rest_length) + damping * rate
}

/// Stiffness k = √3/2 E d of an edge between two triangles (N/m).
pub fn stiffness(youngs_modulus: Real, thickness: Real) -> Real {
    0.75_f64.sqrt() * youngs_modulus * thickness
}
