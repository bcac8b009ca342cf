//! An experiment to be run: its scene has been read, its cases are known.

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

/// What shall be run.
#[derive(Clone)]
pub struct RunRequest<'a> {
    /// The experiment.
    pub experiment: &'a dyn Experiment,
    /// How much of it.
    pub size: Size,
    /// Changes of its scene, of the form `key=value`.
    pub overrides: Vec<String>,
    /// A scene file instead of the one that comes with the program.
    pub scene: Option<PathBuf>,
}

impl std::fmt::Debug for RunRequest<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Order({}, {:?}, {:?})", self.experiment.name(), self.size, self.overrides)
    }
}

/// The experiment of this name.
///
/// # Errors
/// If there is none; names spelled alike are told.
pub fn by_name(name: &str) -> Result<&'static dyn Experiment, RunnerError> {
    let found = EXPERIMENTS.iter().find(|it| it.name() == name);
    found.copied().ok_or_else(|| RunnerError::unknown(name))
}

/// All that decides what comes out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// The experiment.
    pub experiment: String,
    /// How much of it.
    pub size: Size,
    /// The scene and its changes.
    pub scene: SceneFacts,
    /// Version of the program.
    pub version: String,
    /// Digest of the program file.
    pub program: String,
}

impl Identity {
    /// What a folder of `other` holds that this does not want, in words; the program apart.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let mut found = Vec::new();
        let mut compare = |what: &str, here: &str, there: &str| {
            if here != there {
                found.push(format!("{what} is {there} there, {here} here"));
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

    /// Digest of all but the program file.
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
    /// If it is wrong.
    pub fn read(order: &RunRequest<'a>) -> Result<Self, RunnerError> {
        let (source, text) = match &order.scene {
            None => {
                let (source, text) = order.experiment.scene();
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
            overrides: &order.overrides,
            size: order.size,
        };
        let plan = order.experiment.read(&scene)?;
        let mut digest = Digest::new();
        digest.bytes(text.as_bytes());
        let scene =
            SceneFacts { source, digest: hex(digest.finish()), overrides: order.overrides.clone() };
        let identity = Identity {
            experiment: order.experiment.name().to_owned(),
            size: order.size,
            scene,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            program: program_digest(),
        };
        let cases = plan.cases();
        Ok(Self { identity, plan, about: order.experiment.about(), cases })
    }

    /// Names of the cases.
    pub fn cases(&self) -> &[String] {
        &self.cases
    }

    /// What the cases show, given how each of them ended. A case that failed is a red row.
    pub(super) fn conclude(&self, ends: Vec<CaseEnd>) -> (Outcome, Findings) {
        let mut programs = BTreeSet::new();
        let (mut facts, mut records, mut failures) = (Vec::new(), Vec::new(), Vec::new());
        for (name, end) in self.cases.iter().zip(ends) {
            match end {
                CaseEnd::Finished(kept) => {
                    facts.push(facts_of(&kept.record));
                    programs.extend(kept.programs);
                    records.push(kept.record);
                }
                CaseEnd::Failed(fault) => {
                    failures.push(self.failure(name, &fault));
                    let record = Record { case: name.clone(), ..Record::default() };
                    facts.push(CaseFacts { fault: Some(fault), ..facts_of(&record) });
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

    /// A case that did not come to its end, as a row.
    fn failure(&self, case: &str, fault: &str) -> Row {
        let told = RowText {
            id: &format!("{}.{case}.ran_to_its_end", self.identity.experiment),
            quantity: &format!("case {case} ran to its end"),
            unit: "1",
            oracle: "every case must",
            reason: fault,
        };
        Row::new(&told, Expected::at_least(1.0), 0.0)
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
            let faults = case.validity.violations();
            left_validity.extend(faults.iter().map(|fault| format!("{}: {fault}", case.case)));
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
        fault: None,
        seed: record.seed,
        digest: hex(record.digest),
        n_substeps: record.n_substeps.clone(),
        wall_s: record.wall_s.clone(),
        validity: record.validity,
    }
}
