//! One case from its start, or from where it was saved, to its end.

use std::{
    collections::BTreeMap,
    panic::{AssertUnwindSafe, catch_unwind},
};

use super::{
    folder::{Found, KeptCase, SavedCase},
    workers::Job,
};
use crate::runner::progress::Line;
use crate::{
    experiments::{Run, StartError},
    host::{clock::Stopwatch, shutdown::Shutdown},
};

/// Wall time between two saves (s): what a kill costs at most.
const SAVE_EVERY_S: f64 = 60.0;
/// Under this name the time is counted that a case takes to be set up.
const SETTING_UP: &str = "setting_up";

/// How a case ended.
#[derive(Debug)]
pub(super) enum CaseEnd {
    /// It came to its end, now or in an earlier run.
    Finished(Box<KeptCase>),
    /// It cannot go on, in words.
    Failed(String),
    /// Someone asked it to stop; it is saved if there is a folder.
    Stopped,
}

/// Carries out a case. A panic is a fault of the case: the others go on.
pub(super) fn carry_out(job: &Job<'_>, shutdown: &Shutdown, line: &Line<'_>) -> CaseEnd {
    let work = AssertUnwindSafe(|| {
        if shutdown.is_requested() {
            return Ok(CaseEnd::Stopped);
        }
        match Case::open(job, line)? {
            Opened::Kept(kept) => Ok(CaseEnd::Finished(kept)),
            Opened::Open(mut case) => case.run(shutdown, line),
        }
    });
    let end = catch_unwind(work).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Err(format!("the program failed: {said}"))
    });
    end.unwrap_or_else(|fault| {
        // The same state would lead to the same fault.
        if let Some(folder) = job.folder {
            folder.forget(job.case);
        }
        CaseEnd::Failed(fault)
    })
}

enum Opened<'a> {
    Kept(Box<KeptCase>),
    Open(Case<'a>),
}

/// A case on its way.
struct Case<'a> {
    job: &'a Job<'a>,
    run: Box<dyn Run>,
    watch: Stopwatch,
    wall_s: BTreeMap<String, f64>,
    programs: Vec<String>,
    share_at_start: f64,
    share: f64,
    saved_at_s: f64,
}

impl<'a> Case<'a> {
    fn open(job: &'a Job<'a>, line: &Line<'_>) -> Result<Opened<'a>, String> {
        let found = job.folder.map_or(Found::Nothing, |folder| folder.find(job.case));
        let case = match found {
            Found::Kept(kept) => return Ok(Opened::Kept(kept)),
            Found::Nothing => Self::start(job),
            Found::Damaged(file) => {
                let file = file.display();
                line.say(&format!("{file}: the file is damaged; the case starts anew"));
                Self::start(job)
            }
            Found::Saved(saved) => Self::resume(job, saved, line),
        };
        case.map(Opened::Open).map_err(|error| error.to_string())
    }

    fn start(job: &'a Job<'a>) -> Result<Self, StartError> {
        let mut watch = Stopwatch::start();
        let run = job.loaded.plan.start(job.case)?;
        let wall_s = BTreeMap::from([(SETTING_UP.to_owned(), watch.lap_s())]);
        let programs = vec![job.loaded.identity.program.clone()];
        let (share, saved_at_s) = (0.0, 0.0);
        Ok(Self { job, run, watch, wall_s, programs, share_at_start: share, share, saved_at_s })
    }

    fn resume(job: &'a Job<'a>, saved: SavedCase, line: &Line<'_>) -> Result<Self, StartError> {
        let mut case = Self::start(job)?;
        if let Err(error) = case.run.resume(&saved.run) {
            line.say(&format!("{}: {error}", job.title()));
            return Self::start(job);
        }
        let SavedCase { share, wall_s, mut programs, .. } = saved;
        programs.append(&mut case.programs);
        programs.dedup();
        Ok(Self { share_at_start: share, share, programs, wall_s, ..case })
    }

    fn run(&mut self, shutdown: &Shutdown, line: &Line<'_>) -> Result<CaseEnd, String> {
        loop {
            let progress = self.run.advance().map_err(|fault| fault.to_string())?;
            *self.wall_s.entry(progress.stage.to_owned()).or_default() += self.watch.lap_s();
            self.share = progress.share;
            line.show(&progress, self.share_at_start, self.watch.total_s());
            if progress.is_done {
                return Ok(self.finish(line));
            }
            let is_over = shutdown.is_requested();
            if is_over || SAVE_EVERY_S <= self.watch.total_s() - self.saved_at_s {
                self.save(line);
            }
            if is_over {
                return Ok(CaseEnd::Stopped);
            }
        }
    }

    fn save(&mut self, line: &Line<'_>) {
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
        // Saving is no part of any stage.
        self.watch.lap_s();
    }

    fn finish(&mut self, line: &Line<'_>) -> CaseEnd {
        let mut record = self.run.record();
        record.wall_s = self.wall_s.clone();
        let key = self.job.folder.map_or(0, |folder| folder.case_key(self.job.case));
        let kept = KeptCase::new(key, self.programs.clone(), record);
        if let Some(folder) = self.job.folder
            && let Err(error) = folder.keep(self.job.case, &kept)
        {
            line.say(&error);
        }
        CaseEnd::Finished(Box::new(kept))
    }
}
