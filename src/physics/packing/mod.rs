//! Dense packings: grains are scattered thinly and then grow together until nothing more fits.
//!
//! ```text
//! let radii: Vec<Real> = …                             // final radii, drawn uniformly
//! let room = Room::Tube { radius, bottom, top };       // or Box, Shell, Periodic
//! let first = first_scale(&radii, 0.2, room.volume()); // thin enough to scatter
//! let small: Vec<Real> = radii.iter().map(|r| first * r).collect();
//! let places = scatter(&small, room.period(), &mut random, |random| room.place(margin, random))?;
//! … system with these places, radii `small`, and the masses of the final radii …
//! let mut growth = Growth::new(recipe, radii, first);
//! while growth.step(&mut system) == Grown::Growing {}  // a slice at a time; check health between
//! ```
//!
//! `Growth::resumed` continues from `growth.progress()` and the `State`.

pub mod grow;
pub mod numbering; // neighbours in space, neighbours in memory
pub mod pressure; // what grains press with
pub mod scatter;

pub use grow::{Grown, Growth, Laws, Recipe};
pub use scatter::{Room, scatter};

use crate::base::Real;

/// Share of their final radii at which grains have the solid fraction `thin` in `volume` (m³); 0.9
/// if they have less than that when they are that large.
pub fn first_scale(final_radii: &[Real], thin: Real, volume: Real) -> Real {
    let grains: Real = final_radii.iter().map(|&r| sphere_volume(r)).sum();
    (thin * volume / grains).cbrt().min(0.9)
}

/// Volume of a sphere (m³).
pub fn sphere_volume(radius: Real) -> Real {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}
