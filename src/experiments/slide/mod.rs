//! The slide test (Götz 2024, section 3.3.2): a ball that cannot turn is pulled over a flat
//! membrane.
//!
//! With triangles, friction force and height are constant. With spheres on the vertices, the
//! classic mass-spring membrane, the ball goes up and down.

mod build; // the lattice, the ball on it
mod cases; // the list of cases
mod evaluate; // verdicts from the records
mod expected; // predictions from geometry and Hertz contact
mod measure; // quantities from a record
mod plots; // plots for the report
mod run; // one case
mod scene; // scene keys
#[cfg(test)]
mod tests;

use super::{
    Experiment, Plan, Run, SceneText, StartError, find_case, findings::Findings, record::Record,
};
use crate::scene::{SceneError, text};
use cases::{Case, cases};
use run::SlideRun;
use scene::SlideScene;

/// The experiment.
pub struct Slide;

impl Experiment for Slide {
    fn name(&self) -> &'static str {
        "slide"
    }

    fn about(&self) -> &'static str {
        "a ball pulled over membranes of triangles and of spheres (Götz 2024, section 3.3.2, Fig. 8)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (
            "launch_configs/experiments/slide.yaml",
            include_str!("../../../launch_configs/experiments/slide.yaml"),
        )
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        let scene: SlideScene = text::read(&scene.layers(false))?;
        Ok(Box::new(SlidePlan { cases: cases(&scene), scene }))
    }
}

/// The cases of a scene.
struct SlidePlan {
    scene: SlideScene,
    cases: Vec<Case>,
}

impl Plan for SlidePlan {
    fn cases(&self) -> Vec<String> {
        self.cases.iter().map(|case| case.name.to_owned()).collect()
    }

    fn start(&self, name: &str) -> Result<Box<dyn Run>, StartError> {
        let case = find_case(&self.cases, name, |case| case.name.to_owned())?;
        Ok(Box::new(SlideRun::new(&self.scene, *case)?))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, &self.cases, records)
    }
}
