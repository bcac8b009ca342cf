//! Oblique elastic impact of a sphere on a rigid plane with micro-slip: Hertz, Cattaneo and Mindlin
//! for any history of loading, by the method of dimensionality reduction.
//!
//! ```text
//! independent springs at |x| ≤ √(R ξ), per length of the line:
//!   normal      E* (ξ − x²/R)
//!   tangential  4 G* u,  du/dt = slip velocity w,  |4 G* u| ≤ μ E* (ξ − x²/R),  u = 0 out of contact
//!
//! in units of the largest overlap, the contact radius there and √(m/(E* a)):
//!   z'' = −∫ (z − s²) ds,   w' = −7/2 ∫ q ds,   |s| ≤ √z
//! ```
//!
//! Only G*/E*, μ and the angle of incidence matter. The contact law of the simulation replaces the
//! springs by a single one of 2/3 of Mindlin's stiffness, which is exact while the slip is
//! proportional to the overlap; this solution shows the error of that. Source: Popov & Heß
//! (2013); equivalent to Maw, Barber & Fawcett (1976). Valid for ξ ≪ R, without damping.

use super::impact::Rebound;
use crate::base::Real;

/// Springs on half of the line.
const N_SPRINGS: usize = 300;
/// Steps for the duration of the impact.
const N_STEPS: usize = 3000;

/// 4 G*/E* of an elastic sphere of `poisson_ratio` on a rigid plane: 2 (1 − ν)/(2 − ν).
pub fn stiffness_ratio(poisson_ratio: Real) -> Real {
    2.0 * (1.0 - poisson_ratio) / (2.0 - poisson_ratio)
}

/// Rebound of a sphere without spin at `angle` (rad) from the normal; `ratio` is 4 G*/E*.
pub fn rebound(ratio: Real, friction: Real, angle: Real) -> Rebound {
    let approach = (16.0_f64 / 15.0).sqrt();
    let (mut z, mut falling) = (0.0, approach);
    let slip_before = approach * angle.tan();
    let (mut slip, mut impulse) = (slip_before, 0.0);
    let (ds, dt) = (1.0 / real(N_SPRINGS), 2.943_275 / approach / real(N_STEPS));
    let mut springs = [0.0; N_SPRINGS];
    while z >= 0.0 {
        z += 0.5 * dt * falling;
        let (mut normal, mut tangential) = (0.0, 0.0);
        for (k, u) in springs.iter_mut().enumerate() {
            let s = (real(k) + 0.5) * ds;
            let pressed = z - s * s;
            if pressed <= 0.0 {
                *u = 0.0;
                continue;
            }
            let limit = friction * pressed / ratio;
            *u = (*u + slip * dt).clamp(-limit, limit);
            normal += pressed;
            tangential += ratio * *u;
        }
        falling -= 2.0 * ds * normal * dt;
        slip -= 3.5 * 2.0 * ds * tangential * dt;
        impulse += 2.0 * ds * tangential * dt;
        z += 0.5 * dt * falling;
    }
    Rebound {
        tangential: 1.0 - impulse / slip_before,
        spin: 2.5 * impulse * angle.cos() / approach,
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts of a few thousand")]
fn real(n: usize) -> Real {
    n as Real
}

#[cfg(test)]
mod tests {
    use super::super::impact::sliding_rebound;
    use super::*;

    #[test]
    fn the_tabulated_rebounds_are_reproduced() {
        // Oracle: an independent integration of the same model: for ν = 0.245, μ = 0.25, and for
        // aluminium oxide, ν = 0.23, μ = 0.092. Tolerance 2·10⁻³: springs and steps of either.
        for (nu, friction, degrees, expected) in [
            (0.245, 0.25, 5.0, 0.7765),
            (0.245, 0.25, 20.0, 0.6869),
            (0.245, 0.25, 40.0, 0.5874),
            (0.245, 0.25, 60.0, 0.7113),
            (0.23, 0.092, 5.0, 0.742),
            (0.23, 0.092, 15.0, 0.593),
            (0.23, 0.092, 30.0, 0.681),
        ] {
            let angle = Real::to_radians(degrees);
            let found = rebound(stiffness_ratio(nu), friction, angle).tangential;
            assert!((found - expected).abs() < 2e-3, "{degrees}: {found} for {expected}");
        }
    }

    #[test]
    fn impacts_that_slide_throughout_are_those_of_a_rigid_body() {
        // Oracle: rigid-body impact, e = 1. Tolerance: 10⁻³, from springs, steps, and the end of
        // contact.
        for degrees in [65.0, 75.0, 85.0] {
            let angle = Real::to_radians(degrees);
            let found = rebound(stiffness_ratio(0.245), 0.25, angle);
            let rigid = sliding_rebound(0.25, 1.0, angle).unwrap();
            assert!((found.tangential - rigid.tangential).abs() < 1e-3, "{found:?} {rigid:?}");
            assert!((found.spin - rigid.spin).abs() < 1e-3, "{found:?} {rigid:?}");
        }
    }
}
