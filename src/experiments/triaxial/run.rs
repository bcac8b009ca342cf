//! A case: one specimen from growth to the last strain, slice by slice.

use super::{
    build::Recipe,
    cases::{Choice, Kind, Variant},
    protocol::{Phase, TestProgress, TriaxialTest, keep_between_plates},
    scene::TriaxialScene,
};
use crate::{
    base::{Real, real::real},
    experiments::{Progress, ResumeError, Run, StartError, Stepped, record::Record, saved_run},
    physics::{health::Diverged, state::State},
};

/// Contacts and vertices computed in a slice: about a tenth of a second.
const SLICE: usize = 600_000;

/// A specimen that is sheared.
pub(super) struct TriaxialRun {
    name: String,
    test: TriaxialTest,
}

impl TriaxialRun {
    /// The chosen specimen, with the changes of `variant`.
    pub(super) fn new(
        scene: &TriaxialScene,
        name: &str,
        choice: Choice,
        variant: Variant,
    ) -> Result<Self, StartError> {
        let mut scene = scene.clone();
        let (shear, runs) = (&mut scene.shear, &scene.runs);
        let mut speed = shear.speed * shear.speed_factor;
        let strain = match variant {
            Variant::Plain => shear.strain,
            Variant::Check => {
                speed *= 0.5;
                scene.time.rayleigh_share = runs.check_rayleigh_share;
                runs.check_strain
            }
            Variant::Loose => {
                scene.cases[choice.size].spheres.n_grains = [runs.loose_grains; 2];
                runs.loose_strain
            }
        };
        // The strains of the points stay the same: curves are compared point by point.
        let step = shear.strain / real(shear.n_points);
        shear.n_points = rounded(strain / step);
        shear.strain = step * real(shear.n_points);
        let end = (scene.shear.strain, scene.shear.n_points);
        let (recipe, system) = Recipe::new(&scene, choice)?;
        Ok(Self { name: name.to_owned(), test: TriaxialTest::new(recipe, system, speed, end) })
    }
}

impl Run for TriaxialRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let phase = self.test.progress.phase;
        for _ in 0..slice(&self.test) {
            self.test.step();
            if self.test.progress.phase != phase {
                break;
            }
        }
        self.test.check()?;
        let is_done = self.test.progress.phase == Phase::Done;
        Ok(Progress { phase: phase.name(), share: self.test.share(), is_done })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.name, &self.test.progress, [&self.test.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (progress, [state]) = saved_run::unpack(&self.name, bytes)?;
        restore(&mut self.test, progress, state)
    }

    fn record(&self) -> Record {
        let initial = self.test.recipe.choice.initial;
        let seed = self.test.recipe.scene.seeds[initial];
        let mut record = self.test.progress.series.to_record(&self.name, seed);
        record.digest = saved_run::digest(&self.test.system.state);
        record
    }

    fn stepped(&self) -> Option<Stepped<'_>> {
        Some(Stepped { system: &self.test.system, after: keep_between_plates })
    }
}

/// Substeps in a slice.
pub(super) fn slice(test: &TriaxialTest) -> usize {
    let bodies = 4 * test.recipe.final_radii.len();
    let vertices = match test.recipe.choice.kind {
        Kind::Triangles => test.system.model.membrane.mesh.n_vertices(),
        Kind::Spheres => 2 * test.system.model.membrane.mesh.n_vertices(),
    };
    SLICE / (bodies + vertices).max(1) + 1
}

/// Resumes a test from its progress and state, if they belong to the same specimen.
pub(super) fn restore(
    test: &mut TriaxialTest,
    progress: TestProgress,
    state: State,
) -> Result<(), ResumeError> {
    saved_run::check_scene(&state, &test.system.state)?;
    test.system.state = state;
    test.resume(progress);
    Ok(())
}

/// The nearest whole number, at least 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small number of points"
)]
fn rounded(value: Real) -> usize {
    value.round().max(1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::{super::Triaxial, *};
    use crate::{
        experiments::{Experiment, SceneText, Size},
        scene::text::read,
    };

    /// A specimen of 60 grains.
    fn small() -> TriaxialRun {
        let overrides = [
            "case1.radius=8 mm",
            "case1.height=30 mm",
            "case1.triangles.n_around=14",
            "case1.triangles.n_rows=10",
            "case1.triangles.n_grains_a=50",
        ]
        .map(str::to_owned);
        let (source, text) = Triaxial.scene();
        let scene = SceneText { text, source, overrides: &overrides, size: Size::Quick };
        let scene: TriaxialScene = read(&scene.layers(false)).unwrap();
        let choice = Choice { size: 0, kind: Kind::Triangles, initial: 0 };
        TriaxialRun::new(&scene, "small", choice, Variant::Plain).unwrap()
    }

    /// Advances until a phase has lasted for three slices.
    fn advance_to(run: &mut TriaxialRun, phase: Phase) {
        let mut n_slices = 0;
        while n_slices < 3 {
            run.advance().unwrap();
            n_slices += usize::from(run.test.progress.phase == phase);
        }
    }

    /// Oracle: the definition. A leak while shearing ends the test with its curve; an earlier one
    /// is an error.
    #[test]
    fn a_leak_while_shearing_ends_the_test_and_keeps_the_curve() {
        let mut run = small();
        advance_to(&mut run, Phase::Growing);
        run.test.system.scratch.leaked = Some(7);
        assert!(run.advance().unwrap_err().is_leak());

        let mut run = small();
        advance_to(&mut run, Phase::Shearing);
        let strains = run.record().column("strain").unwrap().to_vec();
        run.test.system.scratch.leaked = Some(7);
        assert!(run.advance().unwrap().is_done);
        let record = run.record();
        assert_eq!(record.validity.n_leaked, 1);
        assert!(record.validity.violations().iter().any(|it| it.contains("left the membrane")));
        let now = record.column("strain").unwrap();
        assert!(now.starts_with(&strains) && !now.is_empty(), "{now:?}");
        assert!(now[now.len() - 1] <= record.scalar("strain_of_leak").unwrap());
    }
}
