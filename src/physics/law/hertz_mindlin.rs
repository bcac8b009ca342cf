//! The standard contact law: a viscoelastic Hertz force along the normal, and a Mindlin-type spring with history
//! in the tangential direction.
//!
//! ```text
//! F_n = max(0, 4/3 E* √(R* ξ) (ξ − 3/2 A v_n))                       on the first body, repulsive
//! k   = 2/3 · 8 G* √(R* ξ)                                          stiffness of the spring ξ_t
//! stick, k |ξ_t| < μ F_n:  F_t = −k ξ_t − γ_t √(m* 8 G* √(R* ξ)) v_t,  clipped at |F_t| = μ F_n
//! slip:                    F_t = −μ F_n ξ_t/|ξ_t|,                   |ξ_t| reduced to μ F_n / k
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | ξ | overlap, positive in contact | m |
//! | v_n | normal velocity of the first body relative to the second, positive when separating | m/s |
//! | v_t | tangential slip velocity at the contact point | m/s |
//! | ξ_t | tangential spring: slip integrated over the duration of the contact, in the tangent plane | m |
//! | R*, m* | effective radius and mass | m, kg |
//! | E*, G* | effective moduli, 1/E* = Σ (1−ν²)/E, 1/G* = Σ (2−ν)/G | Pa |
//! | A | dissipation time of the material | s |
//! | γ_t, μ | tangential damping ratio, coefficient of Coulomb friction | – |
//!
//! Source: Götz (2024), chapter 2, eqs. 4–11, with its misprints corrected: the prefactor of the
//! spring follows Mindlin and Di Renzo & Di Maio (2005), the dissipative term opposes the motion,
//! and the viscous tangential term acts only while the contact sticks. As in the source, the spring
//! keeps its length when the contact unloads (Thornton 2013 rescales it with the contact radius),
//! and it rotates with the normal but not about it.
//!
//! Valid while the overlap is small compared with R*, about ξ < 0.1 R*.

use super::{
    ContactState, NoCohesion, NormalForce, NormalPart, Parts, TangentialForce, TangentialPart,
};
use crate::base::{
    Real,
    lanes::{Lanes, Mask, Vector},
};

/// The law of this file.
pub type HertzMindlin = Parts<Hertz, Mindlin, NoCohesion>;

/// Viscoelastic Hertz force along the normal.
#[derive(Clone, Copy, Debug)]
pub struct Hertz {
    /// Effective Young's modulus E* (Pa).
    pub modulus: Real,
    /// Dissipation time A (s).
    pub dissipation_time: Real,
}

impl NormalForce for Hertz {
    #[inline(always)]
    fn force<L: Lanes>(&self, contact: &ContactState<L>) -> NormalPart<L> {
        let contact_radius = (contact.radius * contact.overlap).sqrt();
        let v_n = contact.normal.dot(contact.velocity);
        let elastic_and_viscous = contact.overlap - L::splat(1.5 * self.dissipation_time) * v_n;
        let hertz = L::splat(4.0 / 3.0 * self.modulus) * contact_radius * elastic_and_viscous;
        NormalPart { force: hertz.max(L::splat(0.0)), contact_radius, velocity: v_n }
    }

    fn stiffness(&self, radius: Real, force: Real) -> Real {
        let overlap = (0.75 * force / (self.modulus * radius.sqrt())).powf(2.0 / 3.0);
        2.0 * self.modulus * (radius * overlap).sqrt()
    }
}

/// Tangential force: a spring with history, a damper while the contact sticks, and Coulomb's limit.
#[derive(Clone, Copy, Debug)]
pub struct Mindlin {
    /// Effective shear modulus G* (Pa).
    pub shear_modulus: Real,
    /// Coefficient of Coulomb friction μ.
    pub friction: Real,
    /// Tangential damping ratio γ_t.
    pub tangential_damping: Real,
}

impl TangentialForce for Mindlin {
    #[inline(always)]
    fn force<L: Lanes>(
        &self,
        contact: &ContactState<L>,
        normal: &NormalPart<L>,
        dt: Real,
        spring: &mut Vector<L>,
    ) -> TangentialPart<L> {
        let v_t = contact.velocity - contact.normal * normal.velocity;
        let mut xi_t = into_tangent_plane(*spring, contact.normal) + v_t * L::splat(dt);
        let k_t = L::splat(8.0 * self.shear_modulus) * normal.contact_radius;
        let k = L::splat(2.0 / 3.0) * k_t;
        let limit = L::splat(self.friction) * normal.force;
        // Compares squares: most contacts stick, and then no square root is needed.
        let stretch_squared = xi_t.dot(xi_t);
        let slides = (limit * limit).le(k * k * stretch_squared);
        let damping = L::splat(self.tangential_damping) * (contact.mass * k_t).sqrt();
        let mut tangential = -xi_t * k - v_t * damping;
        let squared = tangential.dot(tangential);
        let is_clipped = (limit * limit).lt(squared).and(slides.not());
        if is_clipped.any() {
            tangential = (tangential * (limit / squared.sqrt())).or_where(is_clipped, tangential);
        }
        if slides.any() {
            let is_stretched = slides.and(L::splat(0.0).lt(stretch_squared));
            xi_t = (xi_t * (limit / (k * stretch_squared.sqrt()))).or_where(is_stretched, xi_t);
            tangential = (-xi_t * k).or_where(slides, tangential);
        }
        *spring = xi_t;
        TangentialPart { force: tangential, slides }
    }
}

/// Rotates the spring into the tangent plane, preserving its length.
#[inline(always)]
fn into_tangent_plane<L: Lanes>(spring: Vector<L>, normal: Vector<L>) -> Vector<L> {
    let before = spring.dot(spring);
    let is_loaded = L::splat(0.0).lt(before);
    if !is_loaded.any() {
        return spring;
    }
    let flat = spring - normal * spring.dot(normal);
    let after = flat.dot(flat);
    // Below this the direction is lost to rounding; the spring becomes zero.
    let keeps_direction = (L::splat(1e-12) * before).lt(after);
    let rotated = flat * (before / after).sqrt();
    rotated.or_where(keeps_direction, Vector::zero()).or_where(is_loaded, spring)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        base::Vec3,
        physics::law::{PairLaw, Surface, scalar},
        scene::Material,
    };

    fn grain() -> Material {
        Material { youngs_modulus: 1e8, poisson_ratio: 0.245, density: 2000.0 }
    }

    fn law(dissipation_time: Real, friction: Real) -> PairLaw {
        let surface = Surface { friction, dissipation_time, tangential_damping: 0.3 };
        PairLaw::between(&grain(), &grain(), surface)
    }

    /// Simulates a head-on collision of two equal grains. Returns coefficient of restitution, largest overlap (m) and
    /// duration (s).
    fn collide(law: &PairLaw, radius: Real, v: Real, dt: Real) -> (Real, Real, Real) {
        let mass = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * grain().density;
        let (mut overlap, mut closing, mut deepest, mut time) = (0.0_f64, v, 0.0_f64, 0.0);
        let mut spring = Vec3::zeros();
        loop {
            // Velocity Verlet, so that the error of the integrator is negligible.
            let force_at = |overlap: Real, closing: Real, spring: &mut Vec3| {
                let contact = ContactState {
                    overlap: overlap.max(1e-300),
                    normal: Vec3::z().into(),
                    velocity: (Vec3::z() * -closing).into(),
                    radius: radius / 2.0,
                    touches: true,
                    mass: mass / 2.0,
                };
                scalar(law, &contact, dt, spring).normal
            };
            let a = force_at(overlap, closing, &mut spring) / (mass / 2.0);
            let half = closing - a * dt / 2.0;
            overlap += half * dt;
            closing = half - force_at(overlap, half, &mut spring) / (mass / 2.0) * dt / 2.0;
            deepest = deepest.max(overlap);
            time += dt;
            if overlap <= 0.0 || (closing < 0.0 && force_at(overlap, closing, &mut spring) <= 0.0) {
                return (-closing / v, deepest, time);
            }
        }
    }

    #[test]
    fn elastic_impact_follows_hertz() {
        // Oracle: Hertz, ξ_max = (5 m* v² / 4 k)^(2/5), T = 2.943275 ξ_max / v.
        // Tolerance 0.1 %: 2000 steps per collision leave a discretization error of that order.
        let law = law(0.0, 0.0);
        let (radius, v): (Real, Real) = (2e-3, 1.0);
        let mass = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * grain().density / 2.0;
        let k = 4.0 / 3.0 * law.modulus * (radius / 2.0).sqrt();
        let deepest = (5.0 * mass * v * v / (4.0 * k)).powf(0.4);
        let (restitution, overlap, time) = collide(&law, radius, v, 7.5e-8);
        assert!((overlap / deepest - 1.0).abs() < 1e-3, "{overlap} {deepest}");
        assert!((time * v / (2.943_275 * deepest) - 1.0).abs() < 1e-3, "{time}");
        assert!((restitution - 1.0).abs() < 1e-4, "{restitution}");
    }

    #[test]
    fn restitution_follows_viscoelastic_theory() {
        // Oracle: integration of the law by Müller & Pöschel (2011); values for equal spheres,
        // ν = 0.245, ρ = 2000 kg/m³. Tolerance 2e-4: step error at 2000 steps per collision.
        for (radius, a, v, expected) in [
            (2.7e-3, 4.3e-6, 2.0, 0.87583),
            (2.0e-3, 7e-6, 1.0, 0.78043),
            (2.0e-3, 7e-6, 0.1, 0.85279),
            (0.7e-3, 7e-6, 0.5, 0.56435),
        ] {
            let (restitution, _, _) = collide(&law(a, 0.0), radius, v, 5e-8);
            assert!((restitution - expected).abs() < 2e-4, "{restitution} instead of {expected}");
        }
    }

    #[test]
    fn friction_obeys_coulombs_limit_and_opposes_slip() {
        // Oracle: |F_t| ≤ μ F_n, exact up to rounding; the sliding force opposes the slip.
        let law = law(7e-6, 0.25);
        let mut spring = Vec3::zeros();
        let velocity = Vec3::new(0.05, 0.02, 0.0);
        for step in 0..1000 {
            let contact = ContactState {
                overlap: 1e-5,
                normal: Vec3::z().into(),
                velocity: velocity.into(),
                radius: 1e-3,
                touches: true,
                mass: 3e-5,
            };
            let f = scalar(&law, &contact, 1e-6, &mut spring);
            assert!(f.tangential.norm() <= 0.25 * f.normal * (1.0 + 1e-12));
            if step > 900 {
                assert!(f.slides);
                let direction = f.tangential.normalize();
                assert!((direction + velocity.normalize()).norm() < 1e-12);
            }
        }
    }

    #[test]
    fn the_force_is_objective() {
        // Oracle: rotating everything rotates the force. Tolerance: rounding of a few operations.
        let law = law(7e-6, 0.25);
        let rotation = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0);
        let (normal, velocity) = (Vec3::new(0.0, 0.6, 0.8), Vec3::new(0.05, 0.02, -0.1));
        let contact = ContactState {
            overlap: 1e-5,
            normal: normal.into(),
            velocity: velocity.into(),
            radius: 1e-3,
            touches: true,
            mass: 3e-5,
        };
        let rotated = ContactState {
            normal: (rotation * normal).into(),
            velocity: (rotation * velocity).into(),
            ..contact
        };
        let mut spring = Vec3::new(1e-7, 2e-7, -1.5e-7);
        let mut rotated_spring = rotation * spring;
        let f = scalar(&law, &contact, 1e-6, &mut spring);
        let g = scalar(&law, &rotated, 1e-6, &mut rotated_spring);
        assert!((rotation * f.tangential - g.tangential).norm() < 1e-12 * f.normal);
        assert!((f.normal - g.normal).abs() < 1e-12 * f.normal);
        assert!((rotation * spring - rotated_spring).norm() < 1e-18);
    }
}
