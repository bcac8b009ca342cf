//! The laws against closed forms: one or two grains, or a piece of sheet, for every equation of
//! chapters 2 and 3.1, 3.2 of Götz (2024) that gives a number.
//!
//! Each law is a case. A case is a list of points, collisions or pieces of sheet, each done in a
//! moment; what is saved of a case are the points that are done.

mod build; // one or two grains, a flat membrane
mod chung_ooi; // published benchmark impacts
mod conservation; // momentum and energy
mod crossing; // a grain over edges and vertices
mod impact; // head-on collisions
mod inflation; // the membrane under pressure
mod oblique; // collisions at an angle
mod plate; // bending of the membrane
mod rolling; // sliding, rolling, sticking
mod scene; // scene keys
mod stretching; // in-plane stretching of the membrane
#[cfg(test)]
mod tests;

use super::{
    Experiment, Plan, Progress, ResumeError, Run, SceneText, StartError,
    findings::{Expected, Findings, RowText, Row},
    record::{Column, Record},
    saved_run,
};
use crate::{
    base::digest::Digest,
    physics::health::Diverged,
    scene::{SceneError, text::read},
};
use scene::LawsScene;

/// The scene that comes with the program.
const SCENE_FILE: &str = "launch_configs/experiments/laws.yaml";
/// Its text.
const SCENE_TEXT: &str = include_str!("../../../launch_configs/experiments/laws.yaml");

/// The experiment.
pub struct Laws;

/// One law: how it is measured point by point, and what must come out.
trait Law: Sync {
    /// Its name as a case.
    fn name(&self) -> &'static str;

    /// How many points there are.
    fn n_points(&self, scene: &LawsScene) -> usize;

    /// Measures one point.
    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record);

    /// What the record shows.
    fn evaluate(&self, scene: &LawsScene, record: &Record, findings: &mut Findings);
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
        "contact law, membrane and hinges against closed forms (Götz 2024, chapters 2, 3.1, 3.2)"
    }

    fn scene(&self) -> (&'static str, &'static str) {
        (SCENE_FILE, SCENE_TEXT)
    }

    fn read(&self, scene: &SceneText<'_>) -> Result<Box<dyn Plan>, SceneError> {
        Ok(Box::new(Book { scene: read(&scene.layers(false))? }))
    }
}

/// All laws with their scene.
struct Book {
    scene: LawsScene,
}

impl Plan for Book {
    fn cases(&self) -> Vec<String> {
        LAWS.iter().map(|law| law.name().to_owned()).collect()
    }

    fn start(&self, case: &str) -> Result<Box<dyn Run>, StartError> {
        let law = LAWS
            .iter()
            .find(|law| law.name() == case)
            .ok_or_else(|| StartError::NoSuchCase { name: case.to_owned(), known: self.cases() })?;
        let record = Record { case: case.to_owned(), ..Record::default() };
        Ok(Box::new(Pages { law: *law, scene: self.scene.clone(), n_done: 0, record }))
    }

    fn evaluate(&self, records: &[Record]) -> Findings {
        let mut findings = Findings::default();
        for law in LAWS {
            match records.iter().find(|record| record.case == law.name()) {
                Some(record) => law.evaluate(&self.scene, record, &mut findings),
                None => findings.notes.push(format!("{}: no record, no rows", law.name())),
            }
        }
        findings
    }
}

/// A law on its way through its points.
struct Pages {
    law: &'static dyn Law,
    scene: LawsScene,
    n_done: usize,
    record: Record,
}

impl Run for Pages {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let n_points = self.law.n_points(&self.scene);
        if self.n_done < n_points {
            self.law.measure(&self.scene, self.n_done, &mut self.record);
            self.n_done += 1;
            self.record.digest = digest(&self.record);
        }
        #[expect(clippy::cast_precision_loss, reason = "some hundred points")]
        let share = self.n_done as f64 / n_points.max(1) as f64;
        Ok(Progress { phase: "points", share, is_done: self.n_done == n_points })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.record.case, &(self.n_done, &self.record), [])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let ((n_done, record), []) = saved_run::unpack(&self.record.case, bytes)?;
        let n_points = self.law.n_points(&self.scene);
        if n_done > n_points {
            return Err(saved_run::error(format!(
                "it has {n_done} points, the scene {n_points}"
            )));
        }
        (self.n_done, self.record) = (n_done, record);
        Ok(())
    }

    fn record(&self) -> Record {
        self.record.clone()
    }
}

/// All numbers of a record. There is no state at the end: the points are independent.
fn digest(record: &Record) -> u64 {
    let mut digest = Digest::new();
    for column in &record.columns {
        digest.reals(&column.values);
    }
    for scalar in record.scalars.values() {
        digest.real(scalar.value);
    }
    digest.finish()
}

/// Adds a value to the column `name`.
fn push(record: &mut Record, name: &str, unit: &str, value: f64) {
    let place = record.columns.iter().position(|it| it.name == name).unwrap_or_else(|| {
        record.columns.push(Column::new(name, unit));
        record.columns.len() - 1
    });
    record.columns[place].values.push(value);
}

/// Keeps the larger of a deviation and the one that is there under `name`.
fn worst(record: &mut Record, name: &str, deviation: f64) {
    let so_far = record.scalar(name).unwrap_or(0.0);
    let is_larger = deviation.abs() > so_far || deviation.is_nan();
    record.set(name, if is_larger { deviation.abs() } else { so_far }, "1");
}

/// A row that judges the scalar of its own name: id, quantity, oracle, what is expected, reason.
type Line = (&'static str, &'static str, &'static str, Expected, &'static str);

/// Rows of numbers without unit from the scalars of a record.
fn judge(lines: &[Line], record: &Record, findings: &mut Findings) {
    for (id, quantity, oracle, expected, reason) in lines {
        let told = RowText { id, quantity, unit: "1", oracle, reason };
        let measured = record.scalar(id).unwrap_or(f64::NAN);
        findings.rows.push(Row::new(&told, *expected, measured));
    }
}
