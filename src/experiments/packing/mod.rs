//! Dense packings: where spheres jam, how many contacts they have and how far apart they are, over
//! friction; how stiff a packing is; and whether its stress is the pressure that is put on it.
//!
//! One protocol for all cases in the periodic box: grains grow quasi-statically from a dilute state,
//! with the friction of the case switched on all the time, until they jam; then their size changes
//! in small steps with a rest after each. The solid fraction at which the pressure vanishes comes
//! from Hertz' p ~ (φ − φ_J)^(3/2).

mod boxed; // grains in a periodic box
mod build; // grains, drag, rest
mod confined; // grains in a closed membrane
mod evaluate; // verdicts from the records
mod fit; // straight lines
mod moduli; // bulk and shear modulus of a packing at rest
mod plots; // plots for the report

mod scene; // scene keys

use super::{Experiment, Plan, Run, SceneText, StartError, findings::Findings, record::Record};
use crate::{
    base::{Real, real::real},
    scene::{SceneError, text::fill},
};
use scene::Scene;

const SCENE_FILE: &str = "launch_configs/experiments/packing.yaml";
const SCENE_TEXT: &str = include_str!("../../../launch_configs/experiments/packing.yaml");

/// The experiment.
pub struct Packing;

impl Experiment for Packing {
    fn name(&self) -> &'static str {
        "packing"
    }

    fn about(&self) -> &'static str {
        "spheres grown until they jam: solid fraction, contacts and stiffness over friction"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (SCENE_FILE, SCENE_TEXT)
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(Packings { scene: fill(&scene.layers(false), scene::blank())? }))
    }
}

/// One packing.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Case {
    /// Grains of one size in a periodic box.
    Mono {
        /// Coulomb friction.
        friction: Real,
    },
    /// Grains of many sizes in a periodic box, without friction.
    Poly,
    /// Grains of one size, compressed further, whose bulk modulus is measured.
    Moduli,
    /// Grains of many sizes in a closed membrane under vacuum.
    Confined,
}

impl Case {
    /// Its name, also of files.
    fn name(self) -> String {
        match self {
            Self::Mono { friction } => format!("mono_friction_{friction}"),
            Self::Poly => "poly_smooth".to_owned(),
            Self::Moduli => "moduli".to_owned(),
            Self::Confined => "confined".to_owned(),
        }
    }
}

struct Packings {
    scene: Scene,
}

impl Packings {
    fn all(&self) -> Vec<Case> {
        let mono = self.scene.frictions.iter().map(|&friction| Case::Mono { friction });
        mono.chain([Case::Poly, Case::Moduli, Case::Confined]).collect()
    }
}

impl Plan for Packings {
    fn cases(&self) -> Vec<String> {
        self.all().into_iter().map(Case::name).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let found = self.all().into_iter().find(|it| it.name() == case);
        match found {
            Some(Case::Confined) => Ok(Box::new(confined::Confined::new(&self.scene)?)),
            Some(it) => Ok(Box::new(boxed::Boxed::new(&self.scene, it)?)),
            None => Err(StartError::NoSuchCase { name: case.to_owned(), known: self.cases() }),
        }
    }

    fn expected_s(&self, case: &str) -> Option<f64> {
        let case = self.all().into_iter().find(|it| it.name() == case)?;
        let grains = &self.scene.grains;
        // Seconds for a thousand grains, measured on one thread of a shared core.
        let (count, per_thousand) = match case {
            Case::Mono { friction: 0.0 } => (grains.count_smooth, 12.0),
            Case::Mono { .. } => (grains.count, 8.0),
            Case::Poly => (grains.count, 12.0),
            Case::Moduli => (grains.count, 16.0),
            Case::Confined => (self.scene.confined.count, 15.0),
        };
        Some(per_thousand * real(count) / 1000.0)
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, records)
    }
}
