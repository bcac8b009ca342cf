//! Dense packings: grains are scattered at a low density and then grow until the packing jams.
//!
//! ```text
//! let radii: Vec<Real> = …                             // final radii
//! let room = Room::Tube { radius, bottom, top };       // or Box, Shell, Periodic
//! let first = first_scale(&radii, 0.2, room.volume()); // small enough to scatter
//! let small: Vec<Real> = radii.iter().map(|r| first * r).collect();
//! let positions = scatter(&small, room.period(), &mut random, |random| room.place(margin, random))?;
//! … a system with these positions, the radii `small`, and the masses of the final radii …
//! let mut growth = Growth::new(recipe, radii, first);
//! while growth.step(&mut system) == Grown::Growing {}  // check health regularly
//! ```
//!
//! `Growth::resumed` resumes from `growth.progress()` and the `State`.

pub mod grow;
pub mod numbering; // order of grains in memory
pub mod pressure; // mean pressure of contacts
pub mod scatter;

pub use grow::{Grown, Growth, Laws, Recipe};
pub use scatter::{Room, scatter};

use crate::base::Real;

/// Factor on the final radii at which grains have `solid_fraction` in `volume` (m³), at most 0.9.
pub fn first_scale(final_radii: &[Real], solid_fraction: Real, volume: Real) -> Real {
    let grains: Real = final_radii.iter().map(|&r| sphere_volume(r)).sum();
    (solid_fraction * volume / grains).cbrt().min(0.9)
}

/// Volume (m³) of a sphere of `radius` (m).
pub fn sphere_volume(radius: Real) -> Real {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}
