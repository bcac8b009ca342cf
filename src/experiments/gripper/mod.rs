//! The granular gripper of Götz (2024), section 4.2: a sphere is pushed into the vented bag, the bag
//! is evacuated in steps, the sphere is pulled out. The largest pull is the holding force F_h.
//!
//! The object moves as prescribed and the gripper's plate stands still, so the rigid world has no
//! part in it: grains, membrane and air alone are advanced, and their state is all there is to save.

mod build; // the gripper, ready to run
mod cases; // the list of grips
mod evaluate; // verdicts from the records
mod force_history; // the force over a whole grip
mod measure; // measurements during a grip
mod phase; // phases of a grip
mod plots; // plots for the report
mod run; // one case
mod scene; // scene keys
mod summary; // the summary of a grip

use super::{Experiment, Plan, Run, SceneText, StartError, findings::Findings, record::Record};
use crate::scene::{SceneError, text};
use scene::GripperScene;

/// The scene that comes with the program.
const SCENE: (&str, &str) = (
    "launch_configs/experiments/gripper.yaml",
    include_str!("../../../launch_configs/experiments/gripper.yaml"),
);

/// The experiment.
pub struct Gripper;

impl Experiment for Gripper {
    fn name(&self) -> &'static str {
        "gripper"
    }

    fn about(&self) -> &'static str {
        "holding force of the granular gripper over modulus, vacuum, friction, size (Götz 2024, 4.2)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        SCENE
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        let scene = text::read::<GripperScene>(&scene.layers(false))?;
        let cases = cases::cases(&scene);
        Ok(Box::new(GripperPlan { scene, cases }))
    }
}

struct GripperPlan {
    scene: GripperScene,
    cases: Vec<cases::Case>,
}

impl Plan for GripperPlan {
    fn cases(&self) -> Vec<String> {
        self.cases.iter().map(|case| case.name.clone()).collect()
    }

    fn expected_s(&self, name: &str) -> Option<f64> {
        let case = self.cases.iter().find(|case| case.name == name)?;
        Some(case.expected_s(&self.scene))
    }

    fn start(&self, name: &str) -> Result<Box<dyn Run>, StartError> {
        let Some(case) = self.cases.iter().find(|case| case.name == name) else {
            return Err(StartError::NoSuchCase { name: name.to_owned(), known: self.cases() });
        };
        Ok(Box::new(run::GripRun::new(&self.scene, case)?))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, &self.cases, records)
    }
}
