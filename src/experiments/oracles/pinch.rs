//! Holding force of a rigid glove that presses on a sphere with uniform pressure.
//!
//! ```text
//! F_h = 2π R² p [ μ (θ_c/2 − sin 2θ_c /4) − sin² θ_c /2 ]
//!
//! F_h  force with which the sphere can be pulled, negative if it is pushed out   [N]
//! θ_c  polar angle up to which the glove touches, from the pole it came from     [rad]
//! R    radius of the sphere                                                      [m]
//! p    normal pressure on it                                                     [Pa]
//! μ    friction, everywhere at its limit                                         [-]
//! ```
//!
//! It is the integral of (μ sin θ − cos θ) p over the sphere up to θ_c. Valid where the pressure is
//! uniform and the whole contact slides; suction and bending of the glove are neglected.

use std::f64::consts::PI;

use crate::base::Real;

/// Force (N) with which a sphere of `radius` (m) can be pulled out of a glove that presses with
/// `pressure` (Pa) up to the polar angle `contact_angle` (rad).
pub fn pinch_holding_force(
    friction: Real,
    contact_angle: Real,
    radius: Real,
    pressure: Real,
) -> Real {
    2.0 * PI * radius * radius * pressure * bracket(friction, contact_angle)
}

/// The smallest contact angle (rad) at which a glove holds.
pub fn pinch_threshold(friction: Real) -> Real {
    let (mut fails, mut holds) = (1e-6, PI);
    for _ in 0..60 {
        let middle = 0.5 * (fails + holds);
        if bracket(friction, middle) < 0.0 {
            fails = middle;
        } else {
            holds = middle;
        }
    }
    holds
}

fn bracket(friction: Real, angle: Real) -> Real {
    friction * (0.5 * angle - 0.25 * (2.0 * angle).sin()) - 0.5 * angle.sin().powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Vec3;

    #[test]
    fn thresholds_and_values_match_the_table() {
        // Oracle: roots and values of the formula, computed by hand. Tolerance: their last digit.
        for (friction, degrees) in
            [(0.25, 125.4), (0.5, 100.5), (0.8, 79.5), (1.0, 69.1), (1.2, 60.8)]
        {
            let found = pinch_threshold(friction).to_degrees();
            assert!((found - degrees).abs() < 0.051, "{friction}: {found}");
        }
        for (degrees, value) in [(90.0, 0.443), (120.0, 1.141), (135.0, 1.464), (180.0, 1.885)] {
            let found = bracket(1.2, Real::to_radians(degrees));
            assert!((found - value).abs() < 7e-4, "{degrees}: {found}");
        }
    }

    #[test]
    fn a_glove_of_facets_has_the_same_holding_force() {
        // Oracle: forces summed facet by facet over a prescribed glove that moves up, away from the
        // sphere. Each facet has normal pressure and friction against its slip. Tolerance: 2·10⁻⁴,
        // facets of 1° are flat.
        let (radius, pressure) = (0.01, 9e4);
        for (friction, degrees) in [(1.2, 50), (1.2, 61), (1.2, 120), (0.25, 90), (0.5, 180)] {
            let mut pull = Vec3::zeros();
            for ring in 0..degrees {
                for sector in 0..360 {
                    pull += on_facet(friction, ring, sector) * (pressure * radius * radius);
                }
            }
            let angle = Real::from(degrees).to_radians();
            let expected = pinch_holding_force(friction, angle, radius, pressure);
            let scale = 2.0 * PI * radius * radius * pressure;
            assert!((pull.z - expected).abs() < 2e-4 * scale, "{} {expected}", pull.z);
            assert!(pull.xy().norm() < 1e-9 * scale);
        }
    }

    /// Force on the sphere per pressure and squared radius.
    fn on_facet(friction: Real, ring: i32, sector: i32) -> Vec3 {
        let point = |ring: i32, sector: i32| {
            let (theta, phi) = (Real::from(ring).to_radians(), Real::from(sector).to_radians());
            Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        };
        let (a, b) = (point(ring, sector), point(ring + 1, sector));
        let (c, d) = (point(ring + 1, sector + 1), point(ring, sector + 1));
        let area = 0.5 * (c - a).cross(&(d - b));
        let normal = area.normalize();
        let slip = Vec3::z() - normal * normal.z;
        (slip.normalize() * friction - normal) * area.norm()
    }
}
