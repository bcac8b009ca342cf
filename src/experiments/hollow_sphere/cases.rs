//! The cases: one packing of one kind of grain each.

use super::scene::Scene;
use crate::base::Real;

/// One packing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Case {
    /// Its name.
    pub(super) name: String,
    /// Young's modulus of the grains (Pa).
    pub(super) modulus: Real,
    /// How much heavier than real the grains are.
    pub(super) mass_factor: Real,
    /// What is different from the plain sweep.
    pub(super) kind: Kind,
    /// Which packing, from 0.
    pub(super) filling: usize,
}

/// A kind of case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The sweep of the source.
    Plain,
    /// No grain feels friction.
    Frictionless,
    /// Hard grains have their true mass.
    Unscaled,
    /// In its contacts with grains the sheet is as hard as they are.
    StiffContacts,
}

impl Kind {
    /// Begin of the names of its cases.
    fn prefix(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Frictionless => "frictionless_",
            Self::Unscaled => "unscaled_",
            Self::StiffContacts => "stiff_contacts_",
        }
    }

    /// What is said of it after the modulus.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Frictionless => " without friction",
            Self::Unscaled => " with true mass",
            Self::StiffContacts => " on a sheet with contacts as hard",
        }
    }
}

/// All cases of a scene.
pub(super) fn of(scene: &Scene) -> Vec<Case> {
    let mut cases = Vec::new();
    let sweep = &scene.sweep;
    let kinds = [
        (&sweep.youngs_moduli, Kind::Plain),
        (&sweep.frictionless, Kind::Frictionless),
        (&sweep.unscaled, Kind::Unscaled),
        (&sweep.stiff_contacts, Kind::StiffContacts),
    ];
    for (moduli, kind) in kinds {
        for &modulus in moduli {
            let heavier = (modulus / scene.protocol.mass_scaled_above).max(1.0);
            let mass_factor = if kind == Kind::Unscaled { 1.0 } else { heavier };
            // What is only a check needs no repetition.
            let is_check = matches!(kind, Kind::Unscaled | Kind::StiffContacts);
            let n_fillings = if is_check { 1 } else { scene.n_fillings };
            cases.extend((0..n_fillings).map(|filling| Case {
                name: format!("{}{}_packing_{}", kind.prefix(), in_words(modulus), filling + 1),
                modulus,
                mass_factor,
                kind,
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
