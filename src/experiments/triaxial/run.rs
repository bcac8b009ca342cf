//! One specimen from growth to the last strain, slice by slice.

use super::{
    Variant,
    build::{Choice, Kind, Recipe},
    protocol::{Course, Stage, Test, keep_between_plates},
    scene::Setup,
};
use crate::{
    base::{Real, real::real},
    experiments::{Progress, ResumeError, Run, StartError, Stepped, record::Record, saved_run},
    physics::{health::Diverged, state::State},
};

/// Contacts and vertices that a slice goes over: about a tenth of a second.
const SLICE: usize = 600_000;

/// A case that is sheared.
pub(super) struct Sheared {
    name: String,
    test: Test,
}

impl Sheared {
    /// The chosen specimen, as it is or changed.
    pub(super) fn new(
        setup: &Setup,
        name: &str,
        choice: Choice,
        variant: Variant,
    ) -> Result<Self, StartError> {
        let mut setup = setup.clone();
        let (shear, runs) = (&mut setup.shear, &setup.runs);
        let mut speed = shear.speed * shear.speed_factor;
        let strain = match variant {
            Variant::Plain => shear.strain,
            Variant::Check => {
                speed *= 0.5;
                setup.time.rayleigh_share = runs.check_rayleigh_share;
                runs.check_strain
            }
            Variant::Loose => {
                setup.cases[choice.size].spheres.n_grains = [runs.loose_grains; 2];
                runs.loose_strain
            }
        };
        // The points stay where they are: curves are compared point by point.
        let step = shear.strain / real(shear.n_points);
        shear.n_points = whole(strain / step);
        shear.strain = step * real(shear.n_points);
        let aim = (setup.shear.strain, setup.shear.n_points);
        let (recipe, system) = Recipe::new(&setup, choice)?;
        Ok(Self { name: name.to_owned(), test: Test::new(recipe, system, speed, aim) })
    }
}

impl Run for Sheared {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let stage = self.test.course.stage;
        for _ in 0..slice(&self.test) {
            self.test.step();
            if self.test.course.stage != stage {
                break;
            }
        }
        self.test.check()?;
        let is_done = self.test.course.stage == Stage::Done;
        Ok(Progress { stage: stage.name(), share: self.test.share(), is_done })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.name, &self.test.course, [&self.test.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (course, [state]) = saved_run::unpack(&self.name, bytes)?;
        take(&mut self.test, course, state)
    }

    fn record(&self) -> Record {
        let initial = self.test.recipe.choice.initial;
        let seed = self.test.recipe.setup.seeds[initial];
        let mut record = self.test.course.logbook.record(&self.name, seed);
        record.digest = saved_run::digest(&self.test.system.state);
        record
    }

    fn stepped(&self) -> Option<Stepped<'_>> {
        Some(Stepped { system: &self.test.system, after: keep_between_plates })
    }
}

/// Substeps in a slice.
pub(super) fn slice(test: &Test) -> usize {
    let bodies = 4 * test.recipe.final_radii.len();
    let vertices = match test.recipe.choice.kind {
        Kind::Triangles => test.system.model.membrane.mesh.n_vertices(),
        Kind::Spheres => 2 * test.system.model.membrane.mesh.n_vertices(),
    };
    SLICE / (bodies + vertices).max(1) + 1
}

/// Goes on from a course and its state, if they are of the same specimen.
pub(super) fn take(test: &mut Test, course: Course, state: State) -> Result<(), ResumeError> {
    saved_run::of_one_scene(&state, &test.system.state)?;
    test.system.state = state;
    test.resume(course);
    Ok(())
}

/// The next whole number, at least 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small number of points"
)]
fn whole(value: Real) -> usize {
    value.round().max(1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::{
        super::{Triaxial, scene},
        *,
    };
    use crate::{
        experiments::{Experiment, SceneText, Size},
        scene::text::fill,
    };

    /// A specimen of 60 grains.
    fn small() -> Sheared {
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
        let setup = fill(&scene.layers(false), scene::blank()).unwrap();
        let choice = Choice { size: 0, kind: Kind::Triangles, initial: 0 };
        Sheared::new(&setup, "small", choice, Variant::Plain).unwrap()
    }

    /// Goes on until a stage has lasted for three slices.
    fn go_to(run: &mut Sheared, stage: Stage) {
        let mut n_slices = 0;
        while n_slices < 3 {
            run.advance().unwrap();
            n_slices += usize::from(run.test.course.stage == stage);
        }
    }

    /// Oracle: the contract. Under shear a leak ends the test with its curve; before, there is none.
    #[test]
    fn a_leak_under_shear_ends_the_test_with_its_curve() {
        let mut run = small();
        go_to(&mut run, Stage::Growing);
        run.test.system.scratch.leaked = Some(7);
        assert!(run.advance().unwrap_err().is_leak());

        let mut run = small();
        go_to(&mut run, Stage::Shearing);
        let strains = run.record().column("strain").unwrap().to_vec();
        run.test.system.scratch.leaked = Some(7);
        assert!(run.advance().unwrap().is_done);
        let record = run.record();
        assert_eq!(record.validity.n_leaked, 1);
        assert!(record.validity.faults().iter().any(|it| it.contains("left the membrane")));
        let now = record.column("strain").unwrap();
        assert!(now.starts_with(&strains) && !now.is_empty(), "{now:?}");
        assert!(now[now.len() - 1] <= record.scalar("strain_of_leak").unwrap());
    }
}
