//! Dense packings: where spheres jam, their contacts and structure over friction, the elastic
//! moduli of a packing, and whether its stress equals the applied pressure.
//!
//! All cases in the periodic box follow one protocol: grains grow quasi-statically from a dilute
//! state, with the friction of the case, until they jam; then their size changes in small steps
//! with a rest after each. The solid fraction at which the pressure vanishes follows from Hertz'
//! law, p ~ (φ − φ_J)^(3/2).

mod boxed; // grains in a periodic box
mod build; // grains, drag, rest
mod cases; // the list of cases
mod confined; // grains in a closed membrane
mod evaluate; // verdicts from the records
mod fit; // straight lines
mod measure; // quantities from records
mod moduli; // elastic moduli of a packing at rest
mod plots; // plots for the report
mod scene; // scene keys

use super::{
    Experiment, Plan, Run, SceneText, StartError, find_case, findings::Findings, record::Record,
};
use crate::scene::{SceneError, text::read};
use cases::{Case, cases};
use scene::PackingScene;

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
        (
            "launch_configs/experiments/packing.yaml",
            include_str!("../../../launch_configs/experiments/packing.yaml"),
        )
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(PackingPlan { scene: read(&scene.layers(false))? }))
    }
}

/// The cases of a scene.
struct PackingPlan {
    scene: PackingScene,
}

impl Plan for PackingPlan {
    fn cases(&self) -> Vec<String> {
        cases(&self.scene).into_iter().map(Case::name).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        Ok(match find_case(cases(&self.scene), case, |case| case.name())? {
            Case::Confined => Box::new(confined::ConfinedRun::new(&self.scene)?),
            case => Box::new(boxed::BoxRun::new(&self.scene, case)?),
        })
    }

    fn expected_s(&self, case: &str) -> Option<f64> {
        let case = cases(&self.scene).into_iter().find(|it| it.name() == case)?;
        Some(case.expected_s(&self.scene))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, records)
    }
}
