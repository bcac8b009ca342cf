//! The triaxial test of Götz (2024), section 3.3.1: stress over strain of grains in a membrane under a
//! confining pressure, with both membrane models, two sizes and two initial states; and how long both
//! models take.

mod build; // grains, membrane, plates
mod evaluate; // verdicts from the records
mod measure; // measurements on a specimen
mod plots; // plots for the report
mod protocol; // from grown grains to the last strain
mod run; // one case
mod scene; // scene keys
mod time_series; // the recorded series
mod timing; // both models side by side

use super::{Experiment, Plan, Run, SceneText, StartError, findings::Findings, record::Record};
use crate::scene::{SceneError, text::read};
use build::{Choice, Kind};
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
        Ok(Box::new(Triaxials { setup: read(&scene.layers(false))? }))
    }
}

/// The cases of a scene.
struct Triaxials {
    setup: TriaxialScene,
}

/// A case.
#[derive(Clone, Copy)]
enum Case {
    /// One specimen, as the scene has it or changed.
    Sheared { choice: Choice, variant: Variant },
    /// Both membrane models side by side, of a size.
    Timed { size: usize },
}

/// What is changed of a specimen.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Variant {
    /// Nothing.
    Plain,
    /// Half the speed, and a substep that needs no other argument.
    Check,
    /// As many grains as fill the room that spheres leave as densely as the other model's.
    Loose,
}

/// What is appended to the name of a specimen with spheres that is filled less densely.
const LOOSE: &str = "_loose";
/// What is appended to the name of a specimen that checks the speed-ups.
const CHECK: &str = "_check";

impl Triaxials {
    fn all(&self) -> Vec<(String, Case)> {
        let mut cases = Vec::new();
        let runs = &self.setup.runs;
        let n_sizes = if runs.case2 { 2 } else { 1 };
        for size in 0..n_sizes {
            for kind in [Kind::Triangles, Kind::Spheres] {
                for initial in 0..2 {
                    let choice = Choice { size, kind, initial };
                    cases.push((name(choice), Case::Sheared { choice, variant: Variant::Plain }));
                }
            }
        }
        if runs.check_strain > 0.0 {
            let choice = Choice { size: 0, kind: Kind::Triangles, initial: 0 };
            let check = Case::Sheared { choice, variant: Variant::Check };
            cases.push((name(choice) + CHECK, check));
        }
        if runs.loose_strain > 0.0 {
            let choice = Choice { size: 0, kind: Kind::Spheres, initial: 0 };
            let loose = Case::Sheared { choice, variant: Variant::Loose };
            cases.push((name(choice) + LOOSE, loose));
        }
        if runs.timing > 0.0 {
            for size in 0..n_sizes {
                cases.push((timing_name(size), Case::Timed { size }));
            }
        }
        cases
    }
}

/// Name of a specimen, `case1_triangles_A`.
fn name(choice: Choice) -> String {
    let initial = ["A", "B"][choice.initial];
    format!("case{}_{}_{initial}", choice.size + 1, choice.kind.name())
}

/// Name of the comparison of run times.
fn timing_name(size: usize) -> String {
    format!("case{}_timing", size + 1)
}

impl Plan for Triaxials {
    fn cases(&self) -> Vec<String> {
        self.all().into_iter().map(|(name, _)| name).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let found = self.all().into_iter().find(|(name, _)| name == case);
        let Some((name, chosen)) = found else {
            return Err(StartError::NoSuchCase { name: case.to_owned(), known: self.cases() });
        };
        Ok(match chosen {
            Case::Sheared { choice, variant } => {
                Box::new(run::Sheared::new(&self.setup, &name, choice, variant)?)
            }
            Case::Timed { size } => Box::new(timing::Timed::new(&self.setup, &name, size)?),
        })
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        evaluate::findings(&self.setup, records)
    }
}
