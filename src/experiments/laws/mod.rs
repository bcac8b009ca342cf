//! The laws compared with closed forms: one or two grains, or a piece of membrane, for every
//! equation of chapters 2, 3.1 and 3.2 of Götz (2024) that yields a number.
//!
//! Each law is a case. A case is a list of points, collisions or pieces of membrane, each measured
//! within a moment; a saved case consists of the points that are done.

mod build; // one or two grains, a flat membrane
mod chung_ooi; // published benchmark impacts
mod conservation; // momentum and energy
mod crossing; // a grain over edges and vertices
mod evaluate; // rows, tables and plots of all laws
mod impact; // head-on collisions
mod inflation; // the membrane under pressure
mod measure; // how a point is recorded
mod oblique; // collisions at an angle
mod plate; // bending of the membrane
mod rolling; // sliding, rolling, sticking
mod run; // one law, point by point
mod scene; // scene keys
mod stretching; // in-plane stretching of the membrane
#[cfg(test)]
mod tests;

use super::{
    Experiment, Plan, Run, SceneText, StartError, find_case,
    findings::{Findings, Plot},
    record::Record,
};
use crate::scene::{SceneError, text::read};
use evaluate::RowSpec;
use run::LawRun;
use scene::LawsScene;

/// The experiment.
pub struct Laws;

/// One law: its points, and what is expected of them.
trait Law: Sync {
    /// Name of the law as a case.
    fn name(&self) -> &'static str;

    /// Number of points.
    fn n_points(&self, scene: &LawsScene) -> usize;

    /// Measures one point.
    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record);

    /// Adds numbers that need all points.
    fn complete(&self, _scene: &LawsScene, _record: &mut Record) {}

    /// The rows; each compares the scalar with its id.
    fn rows(&self) -> &'static [RowSpec];

    /// Name of the table with all columns, if there is one.
    fn table(&self) -> Option<&'static str> {
        None
    }

    /// The plot, if there is one.
    fn plot(&self, _scene: &LawsScene, _record: &Record) -> Option<Plot> {
        None
    }
}

static LAWS: &[&dyn Law] = &[
    &impact::Impact,
    &oblique::Oblique,
    &chung_ooi::ChungOoi,
    &rolling::Rolling,
    &conservation::Conservation,
    &stretching::Stretching,
    &plate::Plate,
    &inflation::Inflation,
    &crossing::Crossing,
];

impl Experiment for Laws {
    fn name(&self) -> &'static str {
        "laws"
    }

    fn about(&self) -> &'static str {
        "contact law, membrane and hinges compared with closed forms (Götz 2024, chapters 2, 3.1, \
        3.2)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (
            "launch_configs/experiments/laws.yaml",
            include_str!("../../../launch_configs/experiments/laws.yaml"),
        )
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(LawsPlan { scene: read(&scene.layers(false))? }))
    }
}

/// The cases of a scene.
struct LawsPlan {
    scene: LawsScene,
}

impl Plan for LawsPlan {
    fn cases(&self) -> Vec<String> {
        LAWS.iter().map(|law| law.name().to_owned()).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let law = find_case(LAWS, case, |law| law.name().to_owned())?;
        Ok(Box::new(LawRun::new(*law, &self.scene)))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.scene, records)
    }
}
