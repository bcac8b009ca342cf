//! One case: a law, point by point.

use super::{Law, scene::LawsScene};
use crate::{
    base::digest::Digest,
    experiments::{Progress, ResumeError, Run, record::Record, saved_run},
    physics::health::Diverged,
};

/// A running case.
pub(super) struct LawRun {
    law: &'static dyn Law,
    scene: LawsScene,
    n_done: usize,
    record: Record,
}

impl LawRun {
    /// The case before its first point.
    pub(super) fn new(law: &'static dyn Law, scene: &LawsScene) -> Self {
        let record = Record { case: law.name().to_owned(), ..Record::default() };
        Self { law, scene: scene.clone(), n_done: 0, record }
    }
}

impl Run for LawRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let n_points = self.law.n_points(&self.scene);
        if self.n_done < n_points {
            self.law.measure(&self.scene, self.n_done, &mut self.record);
            self.n_done += 1;
            self.record.digest = digest(&self.record);
        }
        #[expect(clippy::cast_precision_loss, reason = "a few hundred points")]
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
            return Err(saved_run::error(format!("it has {n_done} points, the scene {n_points}")));
        }
        (self.n_done, self.record) = (n_done, record);
        Ok(())
    }

    fn record(&self) -> Record {
        self.record.clone()
    }
}

/// Digest of all numbers of a record. There is no final state: the points are independent.
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
