//! The hollow sphere (Götz 2024, sections 4.3 and 4.4): an object inside a shell of grains between
//! two membranes, as a model of a gripper.

mod build; // the system
mod cases; // the list of cases
mod evaluate; // verdicts from the records
mod measure; // measurements on a packing
mod plots; // plots for the report
mod run; // one case
mod scene; // scene keys

use super::{
    Experiment, Plan, Run, SceneText, StartError, find_case, findings::Findings, record::Record,
};
use crate::scene::{SceneError, text::read};
use cases::cases;
use scene::HollowSphereScene;

/// The experiment.
pub struct HollowSphere;

impl Experiment for HollowSphere {
    fn name(&self) -> &'static str {
        "hollow_sphere"
    }

    fn about(&self) -> &'static str {
        "pressure of an evacuated shell of grains on an object inside (Götz 2024, 4.3, 4.4)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (
            "launch_configs/experiments/hollow_sphere.yaml",
            include_str!("../../../launch_configs/experiments/hollow_sphere.yaml"),
        )
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(HollowSpherePlan { scene: read(&scene.layers(false))? }))
    }
}

/// The cases of a scene.
struct HollowSpherePlan {
    scene: HollowSphereScene,
}

impl Plan for HollowSpherePlan {
    fn cases(&self) -> Vec<String> {
        cases(&self.scene).into_iter().map(|case| case.name).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let case = find_case(cases(&self.scene), case, |case| case.name.clone())?;
        Ok(Box::new(run::HollowSphereRun::new(&self.scene, &case)?))
    }

    fn expected_s(&self, case: &str) -> Option<f64> {
        // The number of substeps grows with the time of all levels and with the stiffness.
        cases(&self.scene).iter().find(|it| it.name == case).map(|case| {
            let stiffness = (case.modulus / case.mass_factor / 1e8).sqrt().max(0.6);
            let time = self.scene.protocol.total_time();
            110.0 * stiffness * time
        })
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, records)
    }
}
