//! What came of an experiment: all that its result file says, and all that tables, reports and
//! documents are made of.

use std::{collections::BTreeMap, fs};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::{
    base::digest::Digest,
    experiments::{
        Size,
        findings::{Plot, Quantity, Row, Series},
        record::Validity,
    },
};

/// What came of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the experiment.
    pub experiment: String,
    /// What is done, and whose experiment it is.
    pub about: String,
    /// How much of it was run.
    pub size: Size,
    /// The scene.
    pub scene: SceneFacts,
    /// Measured against expected.
    pub rows: Vec<Row>,
    /// Named results.
    pub quantities: Vec<Quantity>,
    /// What a reader must know.
    pub notes: Vec<String>,
    /// The worst of all cases.
    pub validity: Validity,
    /// What left the validity of the model, case by case; empty if nothing did.
    pub left_validity: Vec<String>,
    /// The cases.
    pub cases: Vec<CaseFacts>,
    /// Digest of all cases together.
    pub digest: String,
    /// Time on the clock, summed over all cases, each on one thread (s).
    pub wall_s: f64,
    /// The program.
    pub build: Build,
    /// The machine that ran the last of it.
    pub machine: Machine,
    /// Names of the curves, each a CSV file.
    pub curves: Vec<String>,
    /// Pictures.
    pub plots: Vec<Plot>,
}

/// Which scene it was.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SceneFacts {
    /// Path of its file.
    pub source: String,
    /// Digest of its text.
    pub digest: String,
    /// Changes of the form `key=value`.
    pub overrides: Vec<String>,
}

/// One case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseFacts {
    /// Its name.
    pub case: String,
    /// Why it did not come to its end, if it did not; all numbers below are then meaningless.
    pub fault: Option<String>,
    /// Seed of its random numbers.
    pub seed: u64,
    /// Digest of the state at its end.
    pub digest: String,
    /// Substeps of each stage.
    pub n_substeps: BTreeMap<String, u64>,
    /// Time on the clock of each stage, on one thread (s).
    pub wall_s: BTreeMap<String, f64>,
    /// How far it kept within the validity of the model.
    pub validity: Validity,
}

/// The program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Build {
    /// Its version.
    pub version: String,
    /// Its commit, if the build knew it.
    pub commit: String,
    /// Processor and system that it was built for.
    pub target: String,
    /// Digests of the program files that ran the cases; more than one if it was rebuilt meanwhile.
    pub programs: Vec<String>,
}

/// The machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Its processor.
    pub cpu: String,
    /// Processors that it offers.
    pub n_processors: usize,
}

impl Outcome {
    /// True if every case came to its end.
    pub fn is_complete(&self) -> bool {
        self.cases.iter().all(|case| case.fault.is_none())
    }

    /// Rows that are red.
    pub fn n_red(&self) -> usize {
        self.rows.iter().filter(|row| !row.pass).count()
    }

    /// Its name with its size, `slide_quick`: also the name of its folder.
    pub fn name(&self) -> String {
        sized_name(&self.experiment, self.size)
    }

    /// The result file: a line for each value, but one for each series of a picture.
    pub fn to_text(&self) -> String {
        let rest = Self { plots: Vec::new(), ..self.clone() };
        let text = serde_json::to_string_pretty(&rest).expect("all keys are texts");
        let head = text.strip_suffix("[]\n}").expect("the plots are the last field");
        let plots: Vec<String> = self.plots.iter().map(plot_text).collect();
        format!("{head}[{}]\n}}\n", plots.join(","))
    }

    /// Reads a result file.
    ///
    /// # Errors
    /// If the text is no result.
    pub fn from_text(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// The outcome for machines, on one line: all but the pictures.
    pub fn to_line(&self) -> String {
        let mut value = serde_json::to_value(self).expect("all keys are texts");
        if let Some(map) = value.as_object_mut() {
            map.remove("plots");
        }
        value.to_string()
    }

    /// The rows for machines.
    pub fn rows_for_machines(&self) -> impl Iterator<Item = Value> {
        self.rows.iter().map(|row| {
            let mut value = serde_json::to_value(row).expect("all keys are texts");
            value["experiment"] = json!(self.experiment);
            value["wall_s"] = json!(self.wall_s);
            value["left_validity"] = json!(self.left_validity);
            value
        })
    }
}

fn json(it: &impl Serialize) -> String {
    serde_json::to_string(it).expect("all keys are texts")
}

/// A picture with one line for each series.
fn plot_text(plot: &Plot) -> String {
    let series = |it: &Series| format!("\n    {}", json(it));
    let series: Vec<String> = plot.series.iter().map(series).collect();
    let text = json(&Plot { series: Vec::new(), ..plot.clone() });
    let head = text.strip_suffix("[]}").expect("the series are the last field");
    format!("\n   {head}[{}]}}", series.join(","))
}

/// `slide_quick`.
pub fn sized_name(experiment: &str, size: Size) -> String {
    format!("{experiment}_{}", size_name(size))
}

/// `quick` or `full`.
pub fn size_name(size: Size) -> &'static str {
    match size {
        Size::Quick => "quick",
        Size::Full => "full",
    }
}

/// A digest as text.
pub fn hex(digest: u64) -> String {
    format!("{digest:016x}")
}

impl Build {
    /// This program, with the program files that ran the cases.
    pub fn of_this_program(programs: Vec<String>) -> Self {
        let kind = if cfg!(debug_assertions) { "debug" } else { "release" };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("JAMGRIP_COMMIT").unwrap_or("unknown").to_owned(),
            target: format!("{}-{} {kind}", std::env::consts::ARCH, std::env::consts::OS),
            programs,
        }
    }
}

/// Digest of the program file, or `unknown` if it cannot be read.
pub fn program_digest() -> String {
    let Ok(bytes) = std::env::current_exe().and_then(fs::read) else { return "unknown".to_owned() };
    let mut digest = Digest::new();
    digest.bytes(&bytes);
    hex(digest.finish())
}

impl Machine {
    /// This machine.
    pub fn here() -> Self {
        let model = |text: String| {
            let line = text.lines().find(|line| line.starts_with("model name"))?.to_owned();
            Some(line.split_once(':')?.1.trim().to_owned())
        };
        let cpu = fs::read_to_string("/proc/cpuinfo").ok().and_then(model);
        Self {
            cpu: cpu.unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            n_processors: n_processors(),
        }
    }
}

/// Processors that this process may use.
pub fn n_processors() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}
