//! Collision of two bodies: Hertz's elastic impact, restitution of the viscoelastic law, and
//! oblique impacts that slide throughout.
//!
//! ```text
//! F = k ξ^(3/2),  k = 4/3 E* √R*
//! ξ_max = (5 m* v²/4k)^(2/5),  F_max = k ξ_max^(3/2),  T = 2.943275 ξ_max/v
//!
//! v* = √β v^(1/10),  β = 3/2 A (k/m*)^(2/5)
//! ε  = (1 + c1 v* + c2 v*² + c3 v*³) / (1 + b1 v* + … + b6 v*⁶)
//!
//! slides throughout if tan θ ≥ 7/2 μ (1 + e):  e_t = 1 − μ (1 + e)/tan θ,  R ω' = 5/2 μ (1 + e) v_n
//!
//! ξ, T       overlap, duration of the impact                 [m], [s]
//! E*, R*, m* effective modulus, radius, mass                 [Pa], [m], [kg]
//! A          dissipation time                                [s]
//! θ          angle of incidence from the normal              [rad]
//! e, e_t     restitution of the normal, of the tangential velocity of the center
//! ω'         spin after the impact of a body that had none   [rad/s]
//! ```
//!
//! Sources: Hertz (1881); Müller & Pöschel (2011) for the rational form with the end condition F ≥
//! 0 (its error against an integration of the law is 10⁻⁵ below v* = 0.5 and 2·10⁻⁴ at 1.2);
//! rigid-body impact with Coulomb's friction for the last line.

use crate::base::Real;

/// Two bodies before a collision.
#[derive(Clone, Copy, Debug)]
pub struct Collision {
    /// Effective Young's modulus E* (Pa).
    pub modulus: Real,
    /// Effective radius R* (m).
    pub radius: Real,
    /// Effective mass m* (kg).
    pub mass: Real,
    /// Closing speed (m/s).
    pub speed: Real,
}

impl Collision {
    /// k of F = k ξ^(3/2) (N/m^(3/2)).
    pub fn stiffness(&self) -> Real {
        4.0 / 3.0 * self.modulus * self.radius.sqrt()
    }

    /// Largest overlap without damping (m).
    pub fn overlap_max(&self) -> Real {
        (1.25 * self.mass * self.speed * self.speed / self.stiffness()).powf(0.4)
    }

    /// Largest force without damping (N).
    pub fn force_max(&self) -> Real {
        self.stiffness() * self.overlap_max().powf(1.5)
    }

    /// Duration without damping (s).
    pub fn duration(&self) -> Real {
        2.943_275 * self.overlap_max() / self.speed
    }

    /// Coefficient of restitution for the dissipation time A (s).
    pub fn restitution(&self, dissipation_time: Real) -> Real {
        let beta = 1.5 * dissipation_time * (self.stiffness() / self.mass).powf(0.4);
        restitution(beta.sqrt() * self.speed.powf(0.1))
    }

    /// The dissipation time (s) that gives this restitution at this speed.
    pub fn dissipation_time_for(&self, restitution: Real) -> Real {
        let (mut less, mut more) = (0.0, 10.0 * self.duration());
        for _ in 0..100 {
            let middle = 0.5 * (less + more);
            if self.restitution(middle) > restitution {
                less = middle;
            } else {
                more = middle;
            }
        }
        0.5 * (less + more)
    }
}

/// Restitution ε of the viscoelastic law over the scaled speed v*.
pub fn restitution(scaled_speed: Real) -> Real {
    let polynomial = |coefficients: &[Real]| {
        coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * scaled_speed + coefficient)
    };
    polynomial(&[1.0, 1.072_32, 0.574_198, 0.141_552])
        / polynomial(&[1.0, 1.072_32, 1.727_65, 1.378_42, 1.194_49, 0.467_273, 0.235_585])
}

/// Result of an impact: tangential restitution, and spin times radius over the speed of incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebound {
    /// e_t.
    pub tangential: Real,
    /// R ω'/v, positive if the body rolls forward.
    pub spin: Real,
}

/// Rebound at `angle` (rad) from the normal if the impact slides throughout; else `None`.
pub fn sliding_rebound(friction: Real, normal_restitution: Real, angle: Real) -> Option<Rebound> {
    let impulse = friction * (1.0 + normal_restitution);
    (angle.tan() >= 3.5 * impulse).then(|| Rebound {
        tangential: 1.0 - impulse / angle.tan(),
        spin: 2.5 * impulse * angle.cos(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Equal grains of the source: ν = 0.245, ρ = 2000 kg/m³.
    fn equal(modulus: Real, radius: Real, speed: Real) -> Collision {
        let mass = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * 2000.0;
        let modulus = modulus / (2.0 * (1.0 - 0.245 * 0.245));
        Collision { modulus, radius: radius / 2.0, mass: mass / 2.0, speed }
    }

    #[test]
    fn the_rational_form_gives_the_tabulated_restitution() {
        // Oracle: Runge–Kutta integration of the law. Tolerance: quoted error of the rational form,
        // 10⁻⁵ below v* = 0.5, and 2·10⁻⁴ at 1.2, with the last digit of the table.
        for (modulus, radius, a, speed, expected, tolerance) in [
            (1e8, 2.7e-3, 4.3e-6, 2.0, 0.875_83, 1.6e-5),
            (5e6, 2e-3, 7e-6, 1.0, 0.925_63, 1.6e-5),
            (1e8, 2e-3, 7e-6, 1.0, 0.780_43, 5e-5),
            (1e10, 2e-3, 7e-6, 1.0, 0.296_05, 4e-4),
        ] {
            let found = equal(modulus, radius, speed).restitution(a);
            assert!((found - expected).abs() < tolerance, "{found} for {expected}");
            let time = equal(modulus, radius, speed).dissipation_time_for(found);
            assert!((time / a - 1.0).abs() < 1e-9, "{time} for {a}");
        }
    }

    #[test]
    fn small_dissipation_follows_the_series() {
        // Oracle: Ramírez et al. (1999), ε ≈ 1 − 1.153449 x² + 0.798267 x⁴ with x² = A κ^(2/5)
        // v^(1/5). κ = (3/2)^(5/2) k/m*, so x² is β v^(1/5) = v*². Tolerance: the next term, x⁶.
        for x in [0.05, 0.1, 0.2] {
            let x: Real = x;
            let series = 1.0 - 1.153_449 * x.powi(2) + 0.798_267 * x.powi(4);
            assert!((restitution(x) - series).abs() < x.powi(5), "{x}");
        }
    }
}
