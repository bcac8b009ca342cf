//! Runs one case, from its start or from its saved state to its end.

use std::{
    collections::BTreeMap,
    panic::{AssertUnwindSafe, catch_unwind},
};

use super::{
    folder::{FinishedCase, SavedCase, Stored},
    workers::Job,
};
use crate::runner::progress::CaseProgress;
use crate::{
    experiments::{Run, StartError},
    host::{clock::Stopwatch, shutdown::Shutdown},
};

/// Wall-clock time between two saves (s); a killed process loses at most this much work.
const SAVE_PERIOD_S: f64 = 60.0;
/// Name under which the setup time of a case is counted.
const SETUP_STAGE: &str = "setting_up";

/// How a case ended.
#[derive(Debug)]
pub(super) enum CaseEnd {
    /// It finished, now or in an earlier run.
    Finished(Box<FinishedCase>),
    /// It failed, with the reason.
    Failed(String),
    /// The user stopped it; its state is saved if there is a folder.
    Stopped,
}

/// Runs a case. If it panics, only this case fails.
pub(super) fn run_case(job: &Job<'_>, shutdown: &Shutdown, line: &CaseProgress<'_>) -> CaseEnd {
    let work = AssertUnwindSafe(|| {
        if shutdown.is_requested() {
            return Ok(CaseEnd::Stopped);
        }
        match Case::open(job, line)? {
            Opened::Finished(case) => Ok(CaseEnd::Finished(case)),
            Opened::Unfinished(mut case) => case.run(shutdown, line),
        }
    });
    let end = catch_unwind(work).unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str);
        let message = message.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("the program panicked: {}", message.unwrap_or("no message")))
    });
    end.unwrap_or_else(|reason| {
        // Resuming the saved state would lead to the same failure.
        if let Some(folder) = job.folder {
            folder.remove_state(job.case);
        }
        CaseEnd::Failed(reason)
    })
}

enum Opened<'a> {
    Finished(Box<FinishedCase>),
    Unfinished(Case<'a>),
}

/// A case that is running.
struct Case<'a> {
    job: &'a Job<'a>,
    run: Box<dyn Run>,
    watch: Stopwatch,
    wall_s: BTreeMap<String, f64>,
    programs: Vec<String>,
    start_share: f64,
    share: f64,
    saved_at_s: f64,
}

impl<'a> Case<'a> {
    fn open(job: &'a Job<'a>, line: &CaseProgress<'_>) -> Result<Opened<'a>, String> {
        let found = job.folder.map_or(Stored::Nothing, |folder| folder.find(job.case));
        let case = match found {
            Stored::Finished(case) => return Ok(Opened::Finished(case)),
            Stored::Nothing => Self::start(job),
            Stored::Damaged(file) => {
                let file = file.display();
                line.say(&format!("{file}: the file is damaged; the case is restarted"));
                Self::start(job)
            }
            Stored::Saved(saved) => Self::resume(job, saved, line),
        };
        case.map(Opened::Unfinished).map_err(|error| error.to_string())
    }

    fn start(job: &'a Job<'a>) -> Result<Self, StartError> {
        let mut watch = Stopwatch::start();
        let run = job.loaded.plan.start(job.case)?;
        let wall_s = BTreeMap::from([(SETUP_STAGE.to_owned(), watch.lap_s())]);
        let programs = vec![job.loaded.identity.program.clone()];
        let (share, saved_at_s) = (0.0, 0.0);
        Ok(Self { job, run, watch, wall_s, programs, start_share: share, share, saved_at_s })
    }

    fn resume(
        job: &'a Job<'a>,
        saved: SavedCase,
        line: &CaseProgress<'_>,
    ) -> Result<Self, StartError> {
        let mut case = Self::start(job)?;
        if let Err(error) = case.run.resume(&saved.run) {
            line.say(&format!("{}: {error}", job.title()));
            return Self::start(job);
        }
        let SavedCase { share, wall_s, mut programs, .. } = saved;
        programs.append(&mut case.programs);
        programs.dedup();
        Ok(Self { start_share: share, share, programs, wall_s, ..case })
    }

    fn run(&mut self, shutdown: &Shutdown, line: &CaseProgress<'_>) -> Result<CaseEnd, String> {
        loop {
            let progress = self.run.advance().map_err(|error| error.to_string())?;
            *self.wall_s.entry(progress.phase.to_owned()).or_default() += self.watch.lap_s();
            self.share = progress.share;
            line.show(&progress, self.start_share, self.watch.total_s());
            if progress.is_done {
                return Ok(self.finish(line));
            }
            let must_stop = shutdown.is_requested();
            if must_stop || SAVE_PERIOD_S <= self.watch.total_s() - self.saved_at_s {
                self.save(line);
            }
            if must_stop {
                return Ok(CaseEnd::Stopped);
            }
        }
    }

    fn save(&mut self, line: &CaseProgress<'_>) {
        let Some(folder) = self.job.folder else { return };
        let saved = SavedCase {
            share: self.share,
            wall_s: self.wall_s.clone(),
            programs: self.programs.clone(),
            run: self.run.save(),
        };
        if let Err(error) = folder.save(self.job.case, &saved) {
            line.say(&error);
        }
        self.saved_at_s = self.watch.total_s();
        // The time for saving is not part of any stage.
        self.watch.lap_s();
    }

    fn finish(&mut self, line: &CaseProgress<'_>) -> CaseEnd {
        let mut record = self.run.record();
        record.wall_s = self.wall_s.clone();
        let key = self.job.folder.map_or(0, |folder| folder.case_key(self.job.case));
        let finished = FinishedCase::new(key, self.programs.clone(), record);
        if let Some(folder) = self.job.folder
            && let Err(error) = folder.store_finished(self.job.case, &finished)
        {
            line.say(&error);
        }
        CaseEnd::Finished(Box::new(finished))
    }
}
