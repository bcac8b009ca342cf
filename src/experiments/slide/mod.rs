//! The friction test: a ball is drawn over a flat membrane and must not turn (Götz 2024, section 3.3.2).
//!
//! It shows what a membrane of triangles is good for: a constant friction force and a constant
//! height, where the spheres of the classic mass-spring membrane make the ball go up and down.

mod build; // the lattice
mod evaluate; // verdicts from the records
mod expected; // predictions from geometry and Hertz contact
mod measure; // quantities from a record
mod plots; // plots for the report
mod run; // one case
mod scene; // scene keys
#[cfg(test)]
mod tests;

use super::{Experiment, Plan, Run, SceneText, StartError, findings::Findings, record::Record};
use crate::scene::{SceneError, text};
use build::Way;
use run::{Case, Ride};
use scene::SlideScene;

/// The scene that comes with the program.
const SCENE_FILE: &str = "launch_configs/experiments/slide.yaml";
/// Its text.
const SCENE_TEXT: &str = include_str!("../../../launch_configs/experiments/slide.yaml");

/// The experiment.
pub struct Slide;

impl Experiment for Slide {
    fn name(&self) -> &'static str {
        "slide"
    }

    fn about(&self) -> &'static str {
        "a ball drawn over membranes of triangles and of spheres (Götz 2024, section 3.3.2, Fig. 8)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (SCENE_FILE, SCENE_TEXT)
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(Rides { scene: text::read(&scene.layers(false))? }))
    }
}

/// All rides of a scene.
struct Rides {
    scene: SlideScene,
}

impl Plan for Rides {
    fn cases(&self) -> Vec<String> {
        cases(&self.scene).iter().map(|case| case.name.to_owned()).collect()
    }

    fn start(&self, name: &str) -> Result<Box<dyn Run>, StartError> {
        let case = cases(&self.scene)
            .into_iter()
            .find(|case| case.name == name)
            .ok_or_else(|| StartError::NoSuchCase { name: name.to_owned(), known: self.cases() })?;
        Ok(Box::new(Ride::new(&self.scene, case)?))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, &cases(&self.scene), records)
    }
}

/// Both membranes along and across the rows and askew; more load; stiff contacts; a free sheet.
fn cases(scene: &SlideScene) -> Vec<Case> {
    let plain = Case {
        name: "triangles_rows",
        has_spheres: false,
        way: Way::ROWS,
        load: scene.load,
        stiffening: 1.0,
        pull: scene.pull,
        is_framed: false,
        edge: scene.membrane.edge,
    };
    let mut framed = Case { is_framed: true, ..plain };
    framed.pull.length = scene.frame.length;
    let hard = Case { stiffening: scene.hard.stiffening, pull: scene.hard.pull, ..plain };
    let mut cases = vec![
        plain,
        Case { name: "triangles_across", way: Way::ACROSS, ..plain },
        Case { name: "triangles_skew", way: Way::SKEW, ..plain },
        Case { name: "triangles_heavy", load: scene.heavy_load, ..plain },
        Case { name: "spheres_rows", has_spheres: true, ..plain },
        Case { name: "spheres_across", has_spheres: true, way: Way::ACROSS, ..plain },
        Case { name: "spheres_skew", has_spheres: true, way: Way::SKEW, ..plain },
        Case { name: "hard_spheres_rows", has_spheres: true, ..hard },
        Case { name: "hard_spheres_across", has_spheres: true, way: Way::ACROSS, ..hard },
        Case { name: "triangles_framed", ..framed },
        Case { name: "spheres_framed", has_spheres: true, ..framed },
    ];
    if scene.frame.is_refined {
        let edge = scene.membrane.edge / 2.0;
        cases.push(Case { name: "small_triangles_framed", edge, ..framed });
    }
    cases
}
