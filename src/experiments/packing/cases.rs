//! The cases: packings of one and of many sizes, of several frictions, and in a membrane.

use super::scene::PackingScene;
use crate::{base::Real, base::real::real};

/// One packing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Case {
    /// Grains of one size in a periodic box.
    Mono {
        /// Coulomb friction.
        friction: Real,
    },
    /// Grains of many sizes in a periodic box, without friction.
    Poly,
    /// Grains of one size, compressed further, whose elastic moduli are measured.
    Moduli,
    /// Grains of many sizes in a closed membrane under vacuum.
    Confined,
}

impl Case {
    /// Name of the case.
    pub(super) fn name(self) -> String {
        match self {
            Self::Mono { friction } => format!("mono_friction_{friction}"),
            Self::Poly => "poly_smooth".to_owned(),
            Self::Moduli => "moduli".to_owned(),
            Self::Confined => "confined".to_owned(),
        }
    }

    /// Expected run time on one thread (s).
    pub(super) fn expected_s(self, scene: &PackingScene) -> Real {
        let grains = &scene.grains;
        // Seconds for a thousand grains, measured on one thread of a shared core.
        let (count, per_thousand) = match self {
            Self::Mono { friction: 0.0 } => (grains.count_smooth, 12.0),
            Self::Mono { .. } => (grains.count, 8.0),
            Self::Poly => (grains.count, 12.0),
            Self::Moduli => (grains.count, 16.0),
            Self::Confined => (scene.confined.count, 15.0),
        };
        per_thousand * real(count) / 1000.0
    }
}

/// All cases.
pub(super) fn cases(scene: &PackingScene) -> Vec<Case> {
    let mono = scene.frictions.iter().map(|&friction| Case::Mono { friction });
    mono.chain([Case::Poly, Case::Moduli, Case::Confined]).collect()
}
