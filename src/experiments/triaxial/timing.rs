//! Both membrane models side by side: the same time of the laboratory in turns of slices, whose time on
//! the clock is counted apart.

use serde::{Deserialize, Serialize};

use super::{
    build::{Choice, Kind, Recipe},
    protocol::{Course, Stage, Test},
    run::{slice, take},
    scene::Setup,
};
use crate::{
    base::{
        Real,
        digest::Digest,
        real::{real, real_of},
    },
    experiments::{Progress, ResumeError, Run, StartError, record::Record, saved_run},
    physics::{State, health::Diverged},
};

/// Stage in which both are made ready.
const READY: &str = "growing";

/// Two specimens in turns.
pub(super) struct Timed {
    name: String,
    tests: [Test; 2],
    /// Time each has gone on since its grains were grown (s).
    times: [Real; 2],
    /// Substeps in that time.
    n_substeps: [u64; 2],
    /// Time each is to go on (s).
    last: Real,
}

/// All that is needed to go on, besides the states.
#[derive(Serialize, Deserialize)]
struct Saved {
    courses: [Course; 2],
    times: [Real; 2],
    n_substeps: [u64; 2],
}

const KINDS: [Kind; 2] = [Kind::Triangles, Kind::Spheres];

impl Timed {
    /// Both models of the same size, in the initial state A, with the source's hinge damping and a
    /// substep that needs no other argument.
    pub(super) fn new(setup: &Setup, name: &str, size: usize) -> Result<Self, StartError> {
        let mut setup = setup.clone();
        setup.membrane.bending_damping_spheres = setup.membrane.bending_damping;
        setup.time.rayleigh_share = setup.runs.check_rayleigh_share;
        let shear = &setup.shear;
        let test = |kind: Kind| -> Result<Test, StartError> {
            let (recipe, system) = Recipe::new(&setup, Choice { size, kind, initial: 0 })?;
            let speed = shear.speed * shear.speed_factor;
            Ok(Test::new(recipe, system, speed, (shear.strain, shear.n_points)))
        };
        Ok(Self {
            name: name.to_owned(),
            tests: [test(KINDS[0])?, test(KINDS[1])?],
            times: [0.0; 2],
            n_substeps: [0; 2],
            last: setup.runs.timing,
        })
    }

    /// The specimen whose turn it is; `None` at the end.
    fn next(&self) -> Option<usize> {
        let growing = |test: &Test| test.course.stage == Stage::Growing;
        if let Some(which) = self.tests.iter().position(growing) {
            return Some(which);
        }
        let behind = usize::from(self.times[1] < self.times[0]);
        (self.times[behind] < self.last).then_some(behind)
    }
}

impl Run for Timed {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let done = |stage| Progress { stage, share: 1.0, is_done: true };
        let Some(which) = self.next() else { return Ok(done(READY)) };
        let test = &mut self.tests[which];
        let is_growing = test.course.stage == Stage::Growing;
        let stage = if is_growing { READY } else { KINDS[which].name() };
        let n = slice(test);
        let mut time = 0.0;
        for _ in 0..n {
            test.step();
            time += test.course.substep;
            if is_growing && test.course.stage != Stage::Growing {
                break;
            }
        }
        if !is_growing {
            self.times[which] += time;
            self.n_substeps[which] += n as u64;
        }
        test.check()?;
        if self.next().is_none() {
            return Ok(done(stage));
        }
        let grown = self.tests.iter().filter(|it| it.course.stage != Stage::Growing).count();
        let timed = (self.times[0] + self.times[1]) / (2.0 * self.last);
        Ok(Progress { stage, share: 0.1 * real(grown) + 0.8 * timed.min(1.0), is_done: false })
    }

    fn save(&self) -> Vec<u8> {
        let [first, second] = &self.tests;
        let saved = Saved {
            courses: [first.course.clone(), second.course.clone()],
            times: self.times,
            n_substeps: self.n_substeps,
        };
        saved_run::pack(&self.name, &saved, [&first.system.state, &second.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (saved, states): (Saved, [State; 2]) = saved_run::unpack(&self.name, bytes)?;
        for ((test, course), state) in self.tests.iter_mut().zip(saved.courses).zip(states) {
            take(test, course, state)?;
        }
        (self.times, self.n_substeps) = (saved.times, saved.n_substeps);
        Ok(())
    }

    fn record(&self) -> Record {
        let seed = self.tests[0].recipe.setup.seeds[0];
        let mut digest = Digest::new();
        let mut record = Record { case: self.name.clone(), seed, ..Record::default() };
        for (which, test) in self.tests.iter().enumerate() {
            let name = KINDS[which].name();
            test.system.state.digest(&mut digest);
            record.n_substeps.insert(name.to_owned(), self.n_substeps[which]);
            record.set(&format!("time_{name}"), self.times[which], "s");
            let n = real_of(self.n_substeps[which]);
            record.set(&format!("substep_{name}"), self.times[which] / n, "s");
        }
        record.digest = digest.finish();
        record
    }
}
