//! The cases: one packing of one kind of grain each.

use super::keys::Scene;
use crate::base::Real;

/// One packing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Case {
    /// Its name.
    pub(super) name: String,
    /// Young's modulus of the grains [Pa].
    pub(super) modulus: Real,
    /// How much heavier than real the grains are.
    pub(super) mass_factor: Real,
    /// True if no grain feels friction.
    pub(super) is_frictionless: bool,
    /// Which packing, from 0.
    pub(super) filling: usize,
}

/// All cases of a scene.
pub(super) fn of(scene: &Scene) -> Vec<Case> {
    let mut cases = Vec::new();
    let sweep = &scene.sweep;
    let kinds = [
        (&sweep.youngs_moduli, "", false, true),
        (&sweep.frictionless, "frictionless_", true, true),
        (&sweep.unscaled, "unscaled_", false, false),
    ];
    for (moduli, prefix, is_frictionless, is_scaled) in kinds {
        for &modulus in moduli {
            let heavier = (modulus / scene.protocol.mass_scaled_above).max(1.0);
            // What is only a check needs no repetition.
            let n_fillings = if is_scaled { scene.n_fillings } else { 1 };
            cases.extend((0..n_fillings).map(|filling| Case {
                name: format!("{prefix}{}_packing_{}", in_words(modulus), filling + 1),
                modulus,
                mass_factor: if is_scaled { heavier } else { 1.0 },
                is_frictionless,
                filling,
            }));
        }
    }
    cases
}

/// A modulus as part of a file's name.
pub(super) fn in_words(modulus: Real) -> String {
    if modulus < 1e9 { format!("{}MPa", modulus / 1e6) } else { format!("{}GPa", modulus / 1e9) }
}
