//! The outcome of an experiment: the contents of its result file, from which tables, reports and
//! documents are made.

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

/// The outcome of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the experiment.
    pub experiment: String,
    /// What is simulated, and the authors of the experiment.
    pub about: String,
    /// The size that was run.
    pub size: Size,
    /// The scene.
    pub scene: SceneFacts,
    /// Comparisons of measured with expected values.
    pub rows: Vec<Row>,
    /// Named results.
    pub quantities: Vec<Quantity>,
    /// Notes for the reader.
    pub notes: Vec<String>,
    /// The worst values of all cases.
    pub validity: Validity,
    /// Violations of the model's validity, by case; empty if there are none.
    pub left_validity: Vec<String>,
    /// The cases.
    pub cases: Vec<CaseFacts>,
    /// Digest of all cases together.
    pub digest: String,
    /// Wall-clock time, summed over all cases, each on one thread (s).
    pub wall_s: f64,
    /// The program.
    pub build: Build,
    /// The machine that ran the last part.
    pub machine: Machine,
    /// Names of the curves; each is a CSV file.
    pub curves: Vec<String>,
    /// Plots.
    pub plots: Vec<Plot>,
}

/// The scene of an experiment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SceneFacts {
    /// Path of its file.
    pub source: String,
    /// Digest of its text.
    pub digest: String,
    /// Overrides of the form `key=value`.
    pub overrides: Vec<String>,
}

/// The facts about a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseFacts {
    /// Name of the case.
    pub case: String,
    /// Why it failed, if it did; the other numbers are then meaningless.
    #[serde(rename = "fault")]
    pub error: Option<String>,
    /// Seed of its random numbers.
    pub seed: u64,
    /// Digest of its last state.
    pub digest: String,
    /// Number of substeps of each stage.
    pub n_substeps: BTreeMap<String, u64>,
    /// Wall-clock time of each stage, on one thread (s).
    pub wall_s: BTreeMap<String, f64>,
    /// How far it stayed within the validity of the model.
    pub validity: Validity,
}

/// The build of the program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Build {
    /// Version.
    pub version: String,
    /// Commit, if known to the build.
    pub commit: String,
    /// Processor and operating system that it was built for.
    pub target: String,
    /// Digests of the program files that ran the cases; several if it was rebuilt in between.
    pub programs: Vec<String>,
}

/// The machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Name of the processor.
    pub cpu: String,
    /// Number of processors.
    pub n_processors: usize,
}

impl Outcome {
    /// True if no case failed.
    pub fn is_complete(&self) -> bool {
        self.cases.iter().all(|case| case.error.is_none())
    }

    /// Number of rows that do not pass.
    pub fn n_failed(&self) -> usize {
        self.rows.iter().filter(|row| !row.pass).count()
    }

    /// The name with its size, such as `slide_quick`; also the name of its folder.
    pub fn name(&self) -> String {
        sized_name(&self.experiment, self.size)
    }

    /// The text of the result file: one line for each value, and for each series of a plot.
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
    /// If the text is not a result.
    pub fn from_text(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// The outcome without plots as JSON on one line.
    pub fn to_line(&self) -> String {
        let mut value = serde_json::to_value(self).expect("all keys are texts");
        if let Some(map) = value.as_object_mut() {
            map.remove("plots");
        }
        value.to_string()
    }

    /// The rows as JSON.
    pub fn rows_as_json(&self) -> impl Iterator<Item = Value> {
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

/// A plot with one line for each series.
fn plot_text(plot: &Plot) -> String {
    let series = |it: &Series| format!("\n    {}", json(it));
    let series: Vec<String> = plot.series.iter().map(series).collect();
    let text = json(&Plot { series: Vec::new(), ..plot.clone() });
    let head = text.strip_suffix("[]}").expect("the series are the last field");
    format!("\n   {head}[{}]}}", series.join(","))
}

/// Name and size, such as `slide_quick`.
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

/// A digest as hexadecimal text.
pub fn hex(digest: u64) -> String {
    format!("{digest:016x}")
}

impl Build {
    /// The build of this program, with the program files that ran the cases.
    pub fn of_this_program(programs: Vec<String>) -> Self {
        let profile = if cfg!(debug_assertions) { "debug" } else { "release" };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("JAMGRIP_COMMIT").unwrap_or("unknown").to_owned(),
            target: format!("{}-{} {profile}", std::env::consts::ARCH, std::env::consts::OS),
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

/// Number of processors that this process may use.
pub fn n_processors() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}
