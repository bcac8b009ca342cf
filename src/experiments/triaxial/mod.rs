//! The triaxial test (Götz 2024, section 3.3.1): stress over strain of grains in a membrane under a
//! confining pressure, with both membrane models, two sizes and two initial states, and the run
//! times of both models.

mod build; // grains, membrane, plates
mod cases; // the list of cases
mod evaluate; // verdicts from the records
mod measure; // measurements on a specimen
mod plots; // plots for the report
mod protocol; // from grown grains to the last strain
mod run; // one case
mod scene; // scene keys
mod time_series; // the recorded series
mod timing; // comparison of the run times of both models

use super::{
    Experiment, Plan, Run, SceneText, StartError, find_case, findings::Findings, record::Record,
};
use crate::scene::{SceneError, text::read};
use cases::{Case, cases};
use scene::TriaxialScene;

/// The experiment.
pub struct Triaxial;

impl Experiment for Triaxial {
    fn name(&self) -> &'static str {
        "triaxial"
    }

    fn about(&self) -> &'static str {
        "stress over strain of confined grains, both membrane models (Götz 2024, section 3.3.1)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (
            "launch_configs/experiments/triaxial.yaml",
            include_str!("../../../launch_configs/experiments/triaxial.yaml"),
        )
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(TriaxialPlan { scene: read(&scene.layers(false))? }))
    }
}

/// The cases of a scene.
struct TriaxialPlan {
    scene: TriaxialScene,
}

impl Plan for TriaxialPlan {
    fn cases(&self) -> Vec<String> {
        cases(&self.scene).into_iter().map(|(name, _)| name).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let (name, case) = find_case(cases(&self.scene), case, |(name, _)| name.clone())?;
        Ok(match case {
            Case::Sheared { choice, variant } => {
                Box::new(run::TriaxialRun::new(&self.scene, &name, choice, variant)?)
            }
            Case::Timed { size } => Box::new(timing::TimingRun::new(&self.scene, &name, size)?),
        })
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, records)
    }
}
