//! The granular gripper (Götz 2024, section 4.2): a sphere is pushed into the vented gripper, the
//! gripper is evacuated in steps, and the sphere is pulled out. The largest pull is the holding
//! force.
//!
//! The motion of the object is prescribed and the flange does not move, so there is no rigid-body
//! dynamics: only grains, membrane and air are advanced and saved.

mod build; // a prepared grip
mod cases; // the list of cases
mod evaluate; // verdicts from the records
mod force_history; // the force over a whole grip
mod measure; // measurements during a grip and its results
mod phase; // phases of a grip
mod plots; // plots for the report
mod results; // results by what was varied
mod run; // one case
mod scene; // scene keys

use super::{
    Experiment, Plan, Run, SceneText, StartError, find_case, findings::Findings, record::Record,
};
use crate::scene::{SceneError, text};
use scene::GripperScene;

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
        (
            "launch_configs/experiments/gripper.yaml",
            include_str!("../../../launch_configs/experiments/gripper.yaml"),
        )
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        let scene = text::read::<GripperScene>(&scene.layers(false))?;
        let cases = cases::cases(&scene);
        Ok(Box::new(GripperPlan { scene, cases }))
    }
}

/// The cases of a scene.
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
        let case = find_case(&self.cases, name, |case| case.name.clone())?;
        Ok(Box::new(run::GripperRun::new(&self.scene, case)?))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, &self.cases, records)
    }
}
