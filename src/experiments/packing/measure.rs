//! Quantities from records: where a packing jams, and its structure; and the state of a measurement
//! of elastic moduli.

use serde::{Deserialize, Serialize};

use super::fit;
use crate::{base::Real, experiments::record::Record};

/// Number of lowest pressures that the state without pressure is extrapolated from.
const N_LOWEST: usize = 3;
/// Friction, φ_J and z of Silbert (2010), from memory of its figures.
pub(super) const SILBERT: [[Real; 3]; 5] =
    [[0.0, 0.639, 6.0], [0.1, 0.61, 5.2], [0.3, 0.58, 4.6], [1.0, 0.56, 4.0], [10.0, 0.55, 3.9]];

/// A small strain that measures a modulus, and the stress before it.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) enum Probe {
    /// Bulk modulus, from the pressure (Pa).
    Bulk { strain: Real, pressure: Real },
    /// Shear modulus, from σ_xx − σ_yy (Pa).
    Shear { strain: Real, difference: Real },
}

/// The state of a packing at jamming.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jammed {
    /// Coulomb friction.
    pub(super) friction: Real,
    /// Solid fraction.
    pub(super) phi: Real,
    /// Contacts per grain without rattlers.
    pub(super) z: Real,
}

/// States of a record as (φ, p, z without rattlers), in the order of falling pressure.
pub(super) fn states(record: &Record) -> Vec<[Real; 3]> {
    let column = |name| record.column(name).unwrap_or_default();
    let (phi, pressure) = (column("solid_fraction"), column("pressure"));
    let z = column("coordination_backbone");
    let rows = phi.iter().zip(pressure).zip(z);
    let mut states: Vec<[Real; 3]> = rows.map(|((&phi, &p), &z)| [phi, p, z]).collect();
    states.sort_by(|a, b| b[1].total_cmp(&a[1]));
    states
}

/// The state of a record at vanishing pressure.
pub(super) fn jammed(record: &Record) -> Option<Jammed> {
    let states = states(record);
    let lowest = states.get(states.len().checked_sub(N_LOWEST)?..)?;
    let two_thirds: Vec<[Real; 2]> =
        lowest.iter().map(|[phi, p, _]| [p.powf(2.0 / 3.0), *phi]).collect();
    let phi = fit::line(&two_thirds)?.intercept;
    let roots: Vec<[Real; 2]> =
        lowest.iter().map(|[at, _, z]| [(at - phi).max(0.0).sqrt(), *z]).collect();
    let z = fit::line(&roots)?.intercept;
    Some(Jammed { friction: record.scalar("friction")?, phi, z })
}
