//! Run times of both membrane models: the same simulated time, in alternating slices whose
//! wall-clock times are counted separately.

use serde::{Deserialize, Serialize};

use super::{
    build::Recipe,
    cases::{Choice, Kind},
    protocol::{Phase, TestProgress, TriaxialTest},
    run::{restore, slice},
    scene::TriaxialScene,
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

/// Phase in which both are prepared.
const GROWING: &str = "growing";

/// Two specimens that advance alternately.
pub(super) struct TimingRun {
    name: String,
    tests: [TriaxialTest; 2],
    /// Simulated time of each after growth (s).
    times: [Real; 2],
    /// Substeps in that time.
    n_substeps: [u64; 2],
    /// Simulated time at which each ends (s).
    last: Real,
}

/// Everything needed to resume, in addition to the states.
#[derive(Serialize, Deserialize)]
struct Saved {
    progress: [TestProgress; 2],
    times: [Real; 2],
    n_substeps: [u64; 2],
}

const KINDS: [Kind; 2] = [Kind::Triangles, Kind::Spheres];

impl TimingRun {
    /// Both models of the same size, in the initial state A, with the source's hinge damping and a
    /// substep that is safe without further arguments.
    pub(super) fn new(scene: &TriaxialScene, name: &str, size: usize) -> Result<Self, StartError> {
        let mut scene = scene.clone();
        scene.membrane.bending_damping_spheres = scene.membrane.bending_damping;
        scene.time.rayleigh_share = scene.runs.check_rayleigh_share;
        let shear = &scene.shear;
        let test = |kind: Kind| -> Result<TriaxialTest, StartError> {
            let (recipe, system) = Recipe::new(&scene, Choice { size, kind, initial: 0 })?;
            let speed = shear.speed * shear.speed_factor;
            Ok(TriaxialTest::new(recipe, system, speed, (shear.strain, shear.n_points)))
        };
        Ok(Self {
            name: name.to_owned(),
            tests: [test(KINDS[0])?, test(KINDS[1])?],
            times: [0.0; 2],
            n_substeps: [0; 2],
            last: scene.runs.timing,
        })
    }

    /// Index of the specimen that advances next; `None` at the end.
    fn next(&self) -> Option<usize> {
        let growing = |test: &TriaxialTest| test.progress.phase == Phase::Growing;
        if let Some(which) = self.tests.iter().position(growing) {
            return Some(which);
        }
        let behind = usize::from(self.times[1] < self.times[0]);
        (self.times[behind] < self.last).then_some(behind)
    }
}

impl Run for TimingRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let done = |phase| Progress { phase, share: 1.0, is_done: true };
        let Some(which) = self.next() else { return Ok(done(GROWING)) };
        let test = &mut self.tests[which];
        let is_growing = test.progress.phase == Phase::Growing;
        let phase = if is_growing { GROWING } else { KINDS[which].name() };
        let n = slice(test);
        let mut time = 0.0;
        for _ in 0..n {
            test.step();
            time += test.progress.substep;
            if is_growing && test.progress.phase != Phase::Growing {
                break;
            }
        }
        if !is_growing {
            self.times[which] += time;
            self.n_substeps[which] += n as u64;
        }
        test.check()?;
        if self.next().is_none() {
            return Ok(done(phase));
        }
        let grown = self.tests.iter().filter(|it| it.progress.phase != Phase::Growing).count();
        let timed = (self.times[0] + self.times[1]) / (2.0 * self.last);
        Ok(Progress { phase, share: 0.1 * real(grown) + 0.8 * timed.min(1.0), is_done: false })
    }

    fn save(&self) -> Vec<u8> {
        let [first, second] = &self.tests;
        let saved = Saved {
            progress: [first.progress.clone(), second.progress.clone()],
            times: self.times,
            n_substeps: self.n_substeps,
        };
        saved_run::pack(&self.name, &saved, [&first.system.state, &second.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (saved, states): (Saved, [State; 2]) = saved_run::unpack(&self.name, bytes)?;
        for ((test, progress), state) in self.tests.iter_mut().zip(saved.progress).zip(states) {
            restore(test, progress, state)?;
        }
        (self.times, self.n_substeps) = (saved.times, saved.n_substeps);
        Ok(())
    }

    fn record(&self) -> Record {
        let seed = self.tests[0].recipe.scene.seeds[0];
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
