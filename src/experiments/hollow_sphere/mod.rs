//! The hollow sphere: an object inside a shell of grains between two membranes, the model of a
//! gripper of Götz (2024), sections 4.3 and 4.4.

mod build; // the system
mod cases; // the list of packings
mod evaluate; // verdicts from the records
mod run; // one case
mod scene; // scene keys

use super::{Experiment, Plan, Run, SceneText, StartError, findings::Findings, record::Record};
use crate::scene::{SceneError, text::read};
use scene::HollowSphereScene;

/// The experiment.
pub struct HollowSphere;

impl Experiment for HollowSphere {
    fn name(&self) -> &'static str {
        "hollow_sphere"
    }

    fn about(&self) -> &'static str {
        "pressure of an evacuated shell of grains on the object inside (Götz 2024, 4.3, 4.4)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (
            "launch_configs/experiments/hollow_sphere.yaml",
            include_str!("../../../launch_configs/experiments/hollow_sphere.yaml"),
        )
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(Shells { scene: read(&scene.layers(false))? }))
    }
}

/// All packings of a scene.
struct Shells {
    scene: HollowSphereScene,
}

impl Plan for Shells {
    fn cases(&self) -> Vec<String> {
        cases::of(&self.scene).into_iter().map(|case| case.name).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let known = cases::of(&self.scene);
        match known.iter().find(|it| it.name == case) {
            Some(case) => Ok(Box::new(run::Shell::new(&self.scene, case)?)),
            None => Err(StartError::NoSuchCase { name: case.to_owned(), known: self.cases() }),
        }
    }

    fn expected_s(&self, case: &str) -> Option<f64> {
        // Substeps go with the levels, and harder grains take more of them.
        cases::of(&self.scene).iter().find(|it| it.name == case).map(|case| {
            let stiffness = (case.modulus / case.mass_factor / 1e8).sqrt().max(0.6);
            let time = self.scene.protocol.total_time();
            110.0 * stiffness * time
        })
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, records)
    }
}
