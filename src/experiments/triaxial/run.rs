//! One specimen from growth to the last strain, slice by slice.

use serde::{Deserialize, Serialize};

use super::{
    Variant,
    course::{Course, Stage, Test},
    setup::Setup,
    specimen::{Choice, Kind, Recipe},
};
use crate::{
    base::{Real, digest::Digest},
    cosim::saved_state,
    experiments::{Progress, ResumeError, Run, record::Record},
    physics::{health::Diverged, measure::real, membrane::mesh::MeshFault, state::State},
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
    ) -> Result<Self, MeshFault> {
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

/// All that is needed to go on.
#[derive(Serialize, Deserialize)]
struct Saved {
    name: String,
    course: Course,
    state: Vec<u8>,
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
        let saved = Saved {
            name: self.name.clone(),
            course: self.test.course.clone(),
            state: saved_state::write(&self.test.system.state),
        };
        postcard::to_stdvec(&saved).expect("numbers and texts always serialise")
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let refused = |reason: String| ResumeError { reason };
        let saved: Saved =
            postcard::from_bytes(bytes).map_err(|error| refused(error.to_string()))?;
        if saved.name != self.name {
            return Err(refused(format!("it is of case `{}`", saved.name)));
        }
        let state = saved_state::read(&saved.state).map_err(|error| refused(error.to_string()))?;
        take(&mut self.test, saved.course, state).map_err(refused)
    }

    fn record(&self) -> Record {
        let initial = self.test.recipe.choice.initial;
        let seed = self.test.recipe.setup.seeds[initial];
        let mut record = self.test.course.logbook.record(&self.name, seed);
        let mut digest = Digest::new();
        self.test.system.state.digest(&mut digest);
        record.digest = digest.finish();
        record
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
pub(super) fn take(test: &mut Test, course: Course, state: State) -> Result<(), String> {
    let now = &test.system.state;
    let same = state.grains.len() == now.grains.len()
        && state.membrane.positions.len() == now.membrane.positions.len()
        && state.walls.len() == now.walls.len();
    if !same {
        return Err("it is of another specimen".to_owned());
    }
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
