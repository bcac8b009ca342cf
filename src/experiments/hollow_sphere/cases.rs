//! The cases: one packing of one kind of grains each.

use super::scene::HollowSphereScene;
use crate::base::Real;

/// One case.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Case {
    /// Name of the case.
    pub(super) name: String,
    /// Young's modulus of the grains (Pa).
    pub(super) modulus: Real,
    /// Factor on the mass of the grains.
    pub(super) mass_factor: Real,
    /// What differs from the plain sweep.
    pub(super) kind: Kind,
    /// Index of the packing.
    pub(super) filling: usize,
}

/// A kind of case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The sweep of the source.
    Plain,
    /// Grains without friction.
    Frictionless,
    /// Grains of their true mass.
    Unscaled,
    /// In contacts with grains the membrane is as stiff as they are.
    StiffContacts,
}

impl Kind {
    /// Prefix of the names of its cases.
    fn prefix(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Frictionless => "frictionless_",
            Self::Unscaled => "unscaled_",
            Self::StiffContacts => "stiff_contacts_",
        }
    }

    /// Its description, to follow the modulus.
    pub(super) fn description(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Frictionless => " without friction",
            Self::Unscaled => " with true mass",
            Self::StiffContacts => " with equally stiff membrane contacts",
        }
    }

    /// Suffix of the names of its quantities.
    pub(super) fn suffix(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Frictionless => "_without_friction",
            Self::Unscaled => "_with_true_mass",
            Self::StiffContacts => "_on_a_sheet_with_contacts_as_hard",
        }
    }
}

/// All cases of a scene.
pub(super) fn cases(scene: &HollowSphereScene) -> Vec<Case> {
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
            // A check needs no repetition.
            let is_check = matches!(kind, Kind::Unscaled | Kind::StiffContacts);
            let n_fillings = if is_check { 1 } else { scene.n_fillings };
            cases.extend((0..n_fillings).map(|filling| Case {
                name: format!("{}{}_packing_{}", kind.prefix(), modulus_text(modulus), filling + 1),
                modulus,
                mass_factor,
                kind,
                filling,
            }));
        }
    }
    cases
}

/// A modulus as part of a file name.
pub(super) fn modulus_text(modulus: Real) -> String {
    if modulus < 1e9 { format!("{}MPa", modulus / 1e6) } else { format!("{}GPa", modulus / 1e9) }
}
