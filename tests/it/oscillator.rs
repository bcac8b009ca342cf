//! A small experiment with closed-form results: a damped oscillator.
//!
//! ```text
//! x'' = −2 ζ ω x' − ω² x,   x(0) = 1 m, x'(0) = 0
//! x(t) = e^(−ζωt) (cos ω't + ζω/ω' sin ω't),   ω' = ω √(1 − ζ²)
//! ```
//! It is integrated with symplectic Euler; one case has negative damping and grows until it
//! diverges, one panics. A case can request a shutdown after some slices.

use std::collections::BTreeMap;

use jamgrip::{
    experiments::{
        Experiment, Plan, Progress, ResumeError, Run, SceneText, StartError,
        findings::{Curve, Expected, Findings, Kind, Plot, Quantity, Row, RowText, Series},
        record::{Column, Record, Validity},
    },
    host::shutdown::Shutdown,
    physics::health::Diverged,
    scene::SceneError,
};
use serde::{Deserialize, Serialize};

const OMEGA: f64 = 3.0;
const DT: f64 = 1e-3;
const N_STEPS: u64 = 4000;
const PER_SLICE: u64 = 100;
const SCENE: &str = "# ω = 3 /s\ndampings: [0.05, 0.1, 0.2]\n";

/// The experiment.
#[derive(Clone, Default)]
pub(crate) struct Oscillator {
    /// Additional cases: `growing`, `panicking`.
    pub(crate) also: Vec<String>,
    /// Requests a shutdown after this number of slices of the second case.
    pub(crate) stop: Option<(Shutdown, u64)>,
}

impl Experiment for Oscillator {
    fn name(&self) -> &'static str {
        "oscillator"
    }

    fn about(&self) -> &'static str {
        "A damped oscillator <with> angles & ampersands"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        ("launch_configs/experiments/oscillator.yaml", SCENE)
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        let known = |text: &&String| !text.contains('=');
        match scene.overrides.iter().find(known) {
            Some(text) => Err(SceneError::NotAnOverride { text: text.clone() }),
            None => Ok(Box::new(self.clone())),
        }
    }
}

impl Plan for Oscillator {
    fn cases(&self) -> Vec<String> {
        let usual = ["damping_0.05", "damping_0.1", "damping_0.2"].map(str::to_owned);
        usual.into_iter().chain(self.also.iter().cloned()).collect()
    }

    fn expected_s(&self, case: &str) -> Option<f64> {
        (case == "damping_0.2").then_some(0.1)
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let mut cases = self.cases();
        let Some(i) = cases.iter().position(|it| it == case) else {
            return Err(StartError::NoSuchCase { name: case.to_owned(), known: self.cases() });
        };
        let zeta = case.strip_prefix("damping_").map_or(-0.9, |it| it.parse().unwrap());
        let state = State { x: 1.0, v: 0.0, step: 0, times: Vec::new(), heights: Vec::new() };
        let stop = self.stop.clone().filter(|_| i == 1);
        Ok(Box::new(Swing { case: cases.remove(i), zeta, state, stop }))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        let mut findings = Findings::default();
        let mut series = Vec::new();
        for record in records {
            let (times, heights) =
                (record.column("time").unwrap(), record.column("height").unwrap());
            let zeta: f64 = record.scalar("zeta").unwrap();
            let analytic: Vec<f64> = times.iter().map(|t| exact(zeta, *t)).collect();
            let worst = |worst: f64, (a, b): (&f64, &f64)| worst.max((a - b).abs());
            let distance = heights.iter().zip(&analytic).fold(0.0, worst);
            let text = RowText {
                id: &format!("T1.{}", record.case),
                quantity: "largest distance from the exact solution",
                unit: "m",
                oracle: "closed form of the damped oscillator, <eq. 1>",
                reason: "symplectic Euler errs by ω dt/2 = 0.15 % of the amplitude, twice that at most",
            };
            findings.rows.push(Row::new(&text, Expected::at_most(0.003), distance));
            findings.quantities.push(Quantity {
                name: format!("last_height_{zeta}"),
                meaning: "height at the end | of the run".to_owned(),
                value: *heights.last().unwrap(),
                deviation: Some(distance),
                n: heights.len(),
                unit: "m".to_owned(),
            });
            findings.curves.push(Curve {
                name: format!("height_{}", record.case),
                columns: record.columns.clone(),
            });
            let line = |label: &str, kind, heights: &[f64]| Series {
                label: format!("{label}, ζ = {zeta}"),
                kind,
                points: times.iter().zip(heights).map(|(t, x)| [*t, *x]).collect(),
                deviations: vec![0.05; if kind == Kind::Points { times.len() } else { 0 }],
            };
            series.push(line("measured", Kind::Points, heights));
            series.push(line("closed form", Kind::Analytic, &analytic));
        }
        findings.plots.push(Plot {
            title: "Height over time".to_owned(),
            source_says: "It swings & fades.".to_owned(),
            x_label: "time [s]".to_owned(),
            y_label: "height [m]".to_owned(),
            log_x: false,
            log_y: false,
            series,
        });
        findings.notes.push("A note.".to_owned());
        findings
    }
}

fn exact(zeta: f64, t: f64) -> f64 {
    let omega = OMEGA * (1.0 - zeta * zeta).sqrt();
    let decay = (-zeta * OMEGA * t).exp();
    decay * ((omega * t).cos() + zeta * OMEGA / omega * (omega * t).sin())
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    x: f64,
    v: f64,
    step: u64,
    times: Vec<f64>,
    heights: Vec<f64>,
}

struct Swing {
    case: String,
    zeta: f64,
    state: State,
    stop: Option<(Shutdown, u64)>,
}

impl Run for Swing {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        assert!(self.case != "panicking", "expected panic");
        let state = &mut self.state;
        for _ in 0..PER_SLICE {
            state.v += DT * (-2.0 * self.zeta * OMEGA * state.v - OMEGA * OMEGA * state.x);
            state.x += DT * state.v;
            state.step += 1;
        }
        state.times.push(state.step as f64 * DT);
        state.heights.push(state.x);
        if let Some((shutdown, after)) = &self.stop
            && state.step / PER_SLICE == *after
        {
            shutdown.request();
        }
        if 10.0 < state.x.abs() {
            let (what, remedy) = ("height [m] of oscillator", "damp it");
            let (value, limit) = (state.x.abs(), 10.0);
            return Err(Diverged {
                tick: state.step,
                what,
                which: 0,
                value,
                limit: Some(limit),
                remedy,
            });
        }
        let share = state.step as f64 / N_STEPS as f64;
        Ok(Progress { phase: "swinging", share, is_done: state.step == N_STEPS })
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.state).unwrap()
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let invalid = |error: postcard::Error| ResumeError { reason: error.to_string() };
        self.state = postcard::from_bytes(bytes).map_err(invalid)?;
        Ok(())
    }

    fn record(&self) -> Record {
        let column = |name: &str, unit: &str, values: &[f64]| Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: values.to_vec(),
        };
        let State { x, v, step, times, heights } = &self.state;
        let mut record = Record {
            case: self.case.clone(),
            seed: 7,
            columns: vec![column("time", "s", times), column("height", "m", heights)],
            digest: x.to_bits() ^ v.to_bits().rotate_left(1),
            n_substeps: BTreeMap::from([("swinging".to_owned(), *step)]),
            validity: Validity {
                overlap_over_diameter_max: if self.zeta > 0.15 { 0.11 } else { 0.01 },
                ..Validity::default()
            },
            ..Record::default()
        };
        record.set("zeta", self.zeta, "1");
        record
    }
}
