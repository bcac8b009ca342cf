//! An experiment that is ready to run: its scene has been read, and its cases are known.

use std::{collections::BTreeSet, fs, path::PathBuf};

use serde::{Deserialize, Serialize};

use super::{
    case::CaseEnd,
    outcome::{Build, CaseFacts, Machine, Outcome, SceneFacts, hex, program_digest},
};
use crate::{
    base::digest::Digest,
    experiments::{
        EXPERIMENTS, Experiment, Plan, SceneText, Size,
        findings::{Expected, Findings, Row, RowText},
        record::{Record, Validity},
    },
    scene::SceneError,
};
use crate::{report::plot, runner::error::RunnerError};

/// What to run.
#[derive(Clone)]
pub struct RunRequest<'a> {
    /// The experiment.
    pub experiment: &'a dyn Experiment,
    /// The size of the experiment.
    pub size: Size,
    /// Overrides of its scene, of the form `key=value`.
    pub overrides: Vec<String>,
    /// A scene file that replaces the built-in one.
    pub scene: Option<PathBuf>,
}

impl std::fmt::Debug for RunRequest<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "RunRequest({}, {:?}, {:?})", self.experiment.name(), self.size, self.overrides)
    }
}

/// The experiment with this name.
///
/// # Errors
/// If there is none; the error lists similar names.
pub fn by_name(name: &str) -> Result<&'static dyn Experiment, RunnerError> {
    let found = EXPERIMENTS.iter().find(|it| it.name() == name);
    found.copied().ok_or_else(|| RunnerError::unknown(name))
}

/// Everything that determines the results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// The experiment.
    pub experiment: String,
    /// The size of the experiment.
    pub size: Size,
    /// The scene and its overrides.
    pub scene: SceneFacts,
    /// Version of the program.
    pub version: String,
    /// Digest of the program file.
    pub program: String,
}

impl Identity {
    /// Describes how the stored identity `other` differs, without the program file.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let mut found = Vec::new();
        let mut compare = |what: &str, here: &str, stored: &str| {
            if here != stored {
                found.push(format!("{what} is {stored} in the folder, but {here} here"));
            }
        };
        let size = super::outcome::size_name;
        let changes = |it: &Self| {
            let text = it.scene.overrides.join(" ");
            if text.is_empty() { "unchanged".to_owned() } else { format!("changed by {text}") }
        };
        compare("the experiment", &self.experiment, &other.experiment);
        compare("the size", size(self.size), size(other.size));
        compare("the scene", &changes(self), &changes(other));
        compare("the digest of the scene's text", &self.scene.digest, &other.scene.digest);
        compare("the version of jamgrip", &self.version, &other.version);
        found
    }

    /// Digest of everything except the program file.
    pub fn key(&self) -> u64 {
        let mut digest = Digest::new();
        let rest = Self { program: String::new(), ..self.clone() };
        digest.bytes(&serde_json::to_vec(&rest).expect("all keys are texts"));
        digest.finish()
    }
}

/// An experiment whose scene has been read.
pub struct LoadedExperiment<'a> {
    pub(super) identity: Identity,
    pub(super) plan: Box<dyn Plan>,
    about: &'a str,
    cases: Vec<String>,
}

impl<'a> LoadedExperiment<'a> {
    /// Reads the scene.
    ///
    /// # Errors
    /// If the scene is invalid.
    pub fn read(request: &RunRequest<'a>) -> Result<Self, RunnerError> {
        let (source, text) = match &request.scene {
            None => {
                let (source, text) = request.experiment.scene();
                (source.to_owned(), text.to_owned())
            }
            Some(file) => {
                let source = file.display().to_string();
                let unreadable = |error: std::io::Error| SceneError::Unreadable {
                    file: source.clone(),
                    reason: error.to_string(),
                };
                let text = fs::read_to_string(file).map_err(unreadable)?;
                (source, text)
            }
        };
        let scene = SceneText {
            text: &text,
            source: &source,
            overrides: &request.overrides,
            size: request.size,
        };
        let plan = request.experiment.read(&scene)?;
        let mut digest = Digest::new();
        digest.bytes(text.as_bytes());
        let scene = SceneFacts {
            source,
            digest: hex(digest.finish()),
            overrides: request.overrides.clone(),
        };
        let identity = Identity {
            experiment: request.experiment.name().to_owned(),
            size: request.size,
            scene,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            program: program_digest(),
        };
        let cases = plan.cases();
        Ok(Self { identity, plan, about: request.experiment.about(), cases })
    }

    /// Names of the cases.
    pub fn cases(&self) -> &[String] {
        &self.cases
    }

    /// Evaluates the cases, given how each of them ended. A failed case is reported as a row that
    /// does not pass.
    pub(super) fn evaluate(&self, ends: Vec<CaseEnd>) -> (Outcome, Findings) {
        let mut programs = BTreeSet::new();
        let (mut facts, mut records, mut failures) = (Vec::new(), Vec::new(), Vec::new());
        for (name, end) in self.cases.iter().zip(ends) {
            match end {
                CaseEnd::Finished(finished) => {
                    facts.push(facts_of(&finished.record));
                    programs.extend(finished.programs);
                    records.push(finished.record);
                }
                CaseEnd::Failed(error) => {
                    failures.push(self.failure(name, &error));
                    let record = Record { case: name.clone(), ..Record::default() };
                    facts.push(CaseFacts { error: Some(error), ..facts_of(&record) });
                }
                CaseEnd::Stopped => {}
            }
        }
        let mut findings = self.plan.evaluate(&records);
        findings.rows.extend(failures);
        if 1 < programs.len() {
            let n = programs.len();
            findings.notes.push(format!("The cases were run by {n} different builds of jamgrip."));
        }
        let outcome = self.outcome(facts, &findings, programs.into_iter().collect());
        (outcome, findings)
    }

    /// A failed case as a row.
    fn failure(&self, case: &str, error: &str) -> Row {
        let report = RowText {
            id: &format!("{}.{case}.ran_to_its_end", self.identity.experiment),
            quantity: &format!("case {case} ran to its end"),
            unit: "1",
            oracle: "every case must",
            reason: error,
        };
        Row::new(&report, Expected::at_least(1.0), 0.0)
    }

    fn outcome(
        &self,
        cases: Vec<CaseFacts>,
        findings: &Findings,
        programs: Vec<String>,
    ) -> Outcome {
        let mut validity = Validity::default();
        let mut left_validity = Vec::new();
        let mut digest = Digest::new();
        for case in &cases {
            validity.join(&case.validity);
            let violations = case.validity.violations();
            left_validity.extend(violations.iter().map(|error| format!("{}: {error}", case.case)));
            digest.bytes(case.case.as_bytes());
            digest.bytes(case.digest.as_bytes());
        }
        let Findings { quantities, curves, plots, rows, notes } = findings.clone();
        Outcome {
            experiment: self.identity.experiment.clone(),
            about: self.about.to_owned(),
            size: self.identity.size,
            scene: self.identity.scene.clone(),
            rows,
            quantities,
            notes,
            validity,
            left_validity,
            digest: hex(digest.finish()),
            wall_s: cases.iter().flat_map(|case| case.wall_s.values()).sum(),
            cases,
            build: Build::of_this_program(programs),
            machine: Machine::here(),
            curves: curves.into_iter().map(|curve| curve.name).collect(),
            plots: plots.into_iter().map(plot::reduced).collect(),
        }
    }
}

fn facts_of(record: &Record) -> CaseFacts {
    CaseFacts {
        case: record.case.clone(),
        error: None,
        seed: record.seed,
        digest: hex(record.digest),
        n_substeps: record.n_substeps.clone(),
        wall_s: record.wall_s.clone(),
        validity: record.validity,
    }
}
