//! Expected results from geometry and Hertz contact.
//!
//! ```text
//! triangles    F_n = W,   z = R − ξ,   ξ = (3 W / 4 E* √R)^(2/3),   F_R = μ W,
//!              sticks over  ξ_t = μ W / (2/3 · 8 G* √(R ξ))
//!
//! spheres      Σ F_i (n_i − μ t_i) · e_z = W,   F_R = −Σ F_i (n_i − μ t_i) · d
//!              F_i = 4/3 E* √R* ξ_i^(3/2),   t_i along d + z' e_z in the tangent plane
//!
//! stiff, on a single sphere at u beyond its top (sin θ = u/(R + r), tan φ = μ):
//!              z = √((R + r)² − u²),   F_R = W tan(φ − θ)
//! stiff, between spheres at distance l from each:  z falls by (R + r) − √((R + r)² − l²)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | W | weight plus load of the ball | N |
//! | z, z' | height of its center, slope of its path | m, – |
//! | d, e_z | unit vectors in the direction of the pull and up | – |
//! | n_i, t_i | normal from sphere to ball, direction of slip | – |
//!
//! The motion is quasi-static and all contacts slide. Neglected are inertia (v²/(R + r) is a tenth
//! of gravity), viscous contact forces, and the memory of the friction spring over the last stick
//! length.

use super::{cases::Case, scene::SlideScene};
use crate::{
    base::{Real, Vec3, real::real},
    physics::law::PairLaw,
};

/// Overlap (m) of a Hertz contact with effective radius `radius` (m) under `load` (N).
pub(super) fn overlap(law: &PairLaw, radius: Real, load: Real) -> Real {
    (0.75 * load / (law.modulus * radius.sqrt())).powf(2.0 / 3.0)
}

/// Slip (m) after which a contact under `load` (N) slides.
pub(super) fn stick_length(law: &PairLaw, radius: Real, load: Real) -> Real {
    let contact_radius = (radius * overlap(law, radius, load)).sqrt();
    law.friction * load / (2.0 / 3.0 * 8.0 * law.shear_modulus * contact_radius)
}

/// Spheres that a ball is pulled over.
pub(super) struct Bed<'a> {
    pub(super) law: PairLaw,
    /// R + r (m).
    pub(super) reach: Real,
    /// R* (m).
    pub(super) effective_radius: Real,
    /// Centers of the spheres, with z = 0 (m).
    pub(super) centers: &'a [Vec3],
    /// W (N).
    pub(super) load: Real,
    /// d.
    pub(super) along: Vec3,
}

/// Height of the ball and friction force on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rest {
    /// z (m).
    pub(super) height: Real,
    /// F_R (N).
    pub(super) friction: Real,
}

/// Bisection steps: down to rounding.
const N_HALVINGS: usize = 60;
/// Iterations in which the slope converges.
const N_ROUNDS: usize = 4;

impl<'a> Bed<'a> {
    /// The spheres at `centers` (m) as the ball of `case` touches them.
    pub(super) fn new(scene: &SlideScene, case: &Case, centers: &'a [Vec3]) -> Self {
        let (ball, sphere) = (scene.ball.radius, scene.membrane.sphere_radius);
        Self {
            law: case.law(scene),
            reach: ball + sphere,
            effective_radius: ball * sphere / (ball + sphere),
            centers,
            load: case.weight(scene),
            along: case.period().normalize(),
        }
    }

    /// The ball at `n` positions over one `period` (m) from the origin.
    pub(super) fn curve(&self, period: Real, n: usize) -> Vec<Rest> {
        let step = period / real(n);
        let at = |k: usize| self.along * (step * real(k));
        let mut slopes = vec![0.0; n];
        let mut rests = Vec::new();
        for _ in 0..N_ROUNDS {
            rests = (0..n).map(|k| self.rest(&at(k), slopes[k])).collect::<Vec<Rest>>();
            let height = |k: usize| rests[k % n].height;
            slopes = (0..n).map(|k| (height(k + 1) - height(k + n - 1)) / (2.0 * step)).collect();
        }
        rests
    }

    /// The ball at rest above `position` (m), on a path with this `slope`.
    pub(super) fn rest(&self, position: &Vec3, slope: Real) -> Rest {
        let (mut low, mut high) = (0.3 * self.reach, self.reach);
        for _ in 0..N_HALVINGS {
            let middle = 0.5 * (low + high);
            let force = self.force(&(position + Vec3::z() * middle), slope);
            if force.z > self.load { low = middle } else { high = middle }
        }
        let height = 0.5 * (low + high);
        let force = self.force(&(position + Vec3::z() * height), slope);
        Rest { height, friction: -force.dot(&self.along) }
    }

    /// Force of all spheres on the ball at `position` (m).
    fn force(&self, position: &Vec3, slope: Real) -> Vec3 {
        let path = self.along + Vec3::z() * slope;
        let mut sum = Vec3::zeros();
        for center in self.centers {
            let arm = position - center;
            let overlap = self.reach - arm.norm();
            if overlap > 0.0 {
                let normal = arm.normalize();
                let slip = (path - normal * path.dot(&normal)).normalize();
                let constant = 4.0 / 3.0 * self.law.modulus * self.effective_radius.sqrt();
                sum += (normal - slip * self.law.friction) * (constant * overlap.powf(1.5));
            }
        }
        sum
    }
}

/// How far a ball falls from the top of a sphere to a position at `distance` (m) from the next
/// ones.
pub(super) fn fall(reach: Real, distance: Real) -> Real {
    reach - (reach * reach - distance * distance).sqrt()
}

/// F_R / W of a ball on a single hard sphere, at `behind` (m) beyond its top.
pub(super) fn friction_on_one(friction: Real, reach: Real, behind: Real) -> Real {
    (friction.atan() - (behind / reach).asin()).tan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{physics::law::Surface, scene::Material};

    /// Oracle: the closed forms of one sphere. Tolerance: a difference quotient over 1/4000 of a
    /// period.
    #[test]
    fn one_hard_sphere_matches_the_closed_form() {
        let latex = Material { youngs_modulus: 1e12, poisson_ratio: 0.3, density: 2000.0 };
        let surface = Surface { friction: 1.2, dissipation_time: 0.0, tangential_damping: 0.0 };
        let law = PairLaw::between(&latex, &latex, surface);
        let (reach, effective_radius, load) = (2.67e-3, 0.5e-3, 0.1);
        let centers: Vec<Vec3> = (-3..6).map(|i| Vec3::x() * (1.33e-3 * Real::from(i))).collect();
        let along = Vec3::x();
        let bed = Bed { law, reach, effective_radius, centers: &centers, load, along };
        let curve = bed.curve(1.33e-3, 4000);
        for (k, behind) in [(1000, 0.3325e-3), (3000, -0.3325e-3), (500, 0.16625e-3)] {
            let expected = load * friction_on_one(1.2, reach, behind);
            let measured = curve[k].friction;
            assert!((measured / expected - 1.0).abs() < 1e-4, "{behind}: {measured} {expected}");
        }
        let fallen = curve[0].height - curve[2000].height;
        assert!((fallen / fall(reach, 0.665e-3) - 1.0).abs() < 1e-3, "{fallen}");
    }
}
