//! Grains in a closed membrane under vacuum: the stress in them is the pressure that is put on them.
//!
//! Grains grow smoothly inside a membrane that is held as a sphere; then it is let go, the air is
//! drawn out, and all comes to rest. σ_ij = 1/V Σ f_i l_j over all contacts, those with the membrane
//! included, and V inside the membrane, must be the vacuum's pressure in every direction, but for what
//! the tension of the membrane takes.

use serde::{Deserialize, Serialize};

use super::{
    super::{
        Progress, ResumeError, Run, StartError,
        record::{Column, Record},
    },
    build::{self, SLICE, Settling},
    scene::{Confined as Keys, Scene},
};
use crate::experiments::saved_run;
use crate::{
    base::{
        Real,
        random::{Random, Stream},
    },
    measure::{enclosed_volume, packing, stress},
    physics::{
        System, SystemBuilder,
        builder::{Membrane, Vertices, Wall},
        health::Diverged,
        law::{self, PairLaw},
        membrane::{FREE, MembraneMaterial, shape::MembraneShape},
        model::ChamberModel,
        packing::{Grown, Growth, Recipe, Room, first_scale, grow, scatter, sphere_volume},
        state::Grains,
    },
    scene::Material,
};

/// Solid fraction of the final radii in the sphere: what smooth grains reach in a small one.
const FINAL_FRACTION: Real = 0.58;
/// Poisson's number of a hexagonal net of springs.
const NET_POISSON: Real = 1.0 / 3.0;
/// Time over which the air is drawn out, in drag times.
const DRAW_TIME: Real = 20.0;

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Stage {
    Growing,
    Resting(Settling),
    Done,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Place {
    stage: Stage,
    growth: grow::Progress,
    record: Record,
}

/// The case in the membrane.
pub(super) struct Confined {
    scene: Scene,
    final_radii: Vec<Real>,
    recipe: Recipe,
    growth: Growth,
    system: System,
    place: Place,
}

impl Confined {
    /// Scattered grains in the held membrane.
    pub(super) fn new(scene: &Scene) -> Result<Self, StartError> {
        let keys = &scene.confined;
        let final_radii = build::final_radii(scene, keys.count, false);
        let solid: Real = final_radii.iter().map(|&r| sphere_volume(r)).sum();
        let radius = (solid / FINAL_FRACTION / sphere_volume(1.0)).cbrt();
        let room = Room::Shell { inner: 0.0, outer: radius };
        let scale = first_scale(&final_radii, scene.compression.thin, room.volume());
        let small: Vec<Real> = final_radii.iter().map(|r| scale * r).collect();
        let margin = scene.grains.radius_max;
        let mut random = Random::new(scene.seed, Stream::Position);
        let places = scatter(&small, None, &mut random, |it| room.place(margin, it))?;
        let grains = build::grains(scene, places, &final_radii, scale);
        let system = system(scene, radius, grains)?;
        let mean = scene.grains.radius_mean();
        let mass = scene.grains.material.density * sphere_volume(mean);
        let stop = scene.compression.pressure_first;
        let recipe = Recipe::new(&system.model, room.volume(), stop, mass, mean);
        let recipe = Recipe { scale_last: 2.0, ..recipe };
        let growth = Growth::new(recipe, final_radii.clone(), scale);
        let mut record =
            Record { case: "confined".to_owned(), seed: scene.seed, ..Record::default() };
        record.columns = ["pressure", "stress_x", "stress_y", "stress_z"]
            .map(|name| Column::new(name, "Pa"))
            .to_vec();
        let place = Place { stage: Stage::Growing, growth: growth.progress(), record };
        Ok(Self { scene: scene.clone(), final_radii, recipe, growth, system, place })
    }

    fn step(&mut self) {
        match self.place.stage {
            Stage::Growing => {
                let grown = self.growth.step(&mut self.system);
                self.place.growth = self.growth.progress();
                self.place.record.count("growing", 1);
                if grown != Grown::Growing {
                    self.let_go();
                    self.place.stage = Stage::Resting(Settling::default());
                }
            }
            Stage::Resting(mut settling) => {
                let is_time = settling.step(&mut self.system);
                self.place.stage = Stage::Resting(settling);
                self.place.record.count("resting", 1);
                if is_time {
                    self.look(settling);
                }
                return;
            }
            Stage::Done => return,
        }
        build::drag(&mut self.system, self.scene.compression.drag_time);
    }

    /// The membrane is free and the pump draws.
    fn let_go(&mut self) {
        self.system.model.membrane.holders.fill(FREE);
        self.system.controls.gauge_setpoint = -self.scene.confined.pressure;
    }

    fn look(&mut self, mut settling: Settling) {
        let unrest = settling.unrest(&self.system);
        self.place.stage = Stage::Resting(settling);
        let compression = &self.scene.compression;
        let System { model, state, scratch, .. } = &self.system;
        let n_max = 2.0 * compression.rest_time_max / model.substep;
        let is_drawn = state.gauge <= -self.scene.confined.pressure;
        let is_at_rest = is_drawn && unrest.is_rest();
        if !is_at_rest && !build::is_over(settling.n_done, n_max) {
            return;
        }
        let volume = enclosed_volume(model, state);
        let sigma = stress::contact_stress(model, state, scratch, volume);
        let digest = saved_run::digest(state);
        let packing = packing(state, scratch);
        let row = [-state.gauge, sigma[(0, 0)], sigma[(1, 1)], sigma[(2, 2)]];
        let shear = sigma[(0, 1)].hypot(sigma[(1, 2)]).hypot(sigma[(2, 0)]);
        let overlap = packing.overlap_max / (2.0 * model.radius_mean);
        let record = &mut self.place.record;
        for (column, value) in record.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
        record.set("mean_stress", sigma.trace() / 3.0, "Pa");
        record.set("shear_stress", shear, "Pa");
        record.set("enclosed_volume", volume, "m^3");
        record.set("coordination", packing.coordination_number, "1");
        record.set("unbalanced_force", unrest.unbalanced, "1");
        record.set("kinetic_over_elastic", unrest.kinetic, "1");
        record.validity.overlap_over_diameter_max = overlap;
        record.validity.unbalanced_force = unrest.unbalanced;
        record.digest = digest;
        self.place.stage = Stage::Done;
    }
}

/// Grains and a spherical membrane of `radius` (m) that is held all over.
fn system(scene: &Scene, radius: Real, grains: Grains) -> Result<System, StartError> {
    let (keys, law) = (&scene.confined, build::grain_law(&scene.grains, scene.confined.friction));
    let material = &scene.grains.material;
    let substep = scene.compression.substep;
    let rubber = rubber(keys, material.density);
    let surface = law::Surface { friction: keys.friction_membrane, ..scene.grains.surface(0.0) };
    let n_draw = DRAW_TIME * scene.compression.drag_time / substep;
    let mut builder = SystemBuilder::new(law);
    builder
        .substep(substep)
        .radii_up_to(scene.grains.radius_max, scene.grains.radius_mean())
        .membrane_law(PairLaw::between(material, &rubber, surface))
        .chamber(ChamberModel { lag_factor: 0.0, change_max: keys.pressure / n_draw })
        .grains(grains);
    let frame = builder.wall(Wall::frame());
    let shape = MembraneShape::Icosphere { radius, frequency: keys.frequency };
    let latex = MembraneMaterial {
        thickness: keys.thickness,
        youngs_modulus: rubber.youngs_modulus,
        density: rubber.density,
        spring_damping: keys.spring_damping,
        bending_stiffness: keys.bending_stiffness,
        bending_damping: keys.bending_damping,
    };
    builder.membrane(Membrane::new(&shape, latex)?.hold(Vertices::All, frame));
    Ok(builder.build()?)
}

/// Latex, as dense as the grains in the seeds' tables.
fn rubber(keys: &Keys, density: Real) -> Material {
    Material { youngs_modulus: keys.youngs_modulus, poisson_ratio: NET_POISSON, density }
}

impl Run for Confined {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let (stage, share) = match self.place.stage {
            Stage::Growing => ("growing", 0.5 * self.place.growth.scale.powi(3).min(0.99)),
            Stage::Resting(_) => ("resting", 0.5),
            Stage::Done => ("resting", 1.0),
        };
        for _ in 0..SLICE {
            self.step();
        }
        self.system.check(self.place.record.n_substeps.values().sum())?;
        let is_done = self.place.stage == Stage::Done;
        Ok(Progress { stage, share: if is_done { 1.0 } else { share }, is_done })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.place.record.case, &self.place, [&self.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (place, [state]): (Place, _) = saved_run::unpack(&self.place.record.case, bytes)?;
        saved_run::of_one_scene(&state, &self.system.state)?;
        let mut model = self.system.model.clone();
        model.radius_max = state.grains.radii.iter().copied().fold(model.radius_max, Real::max);
        self.growth = Growth::resumed(self.recipe, self.final_radii.clone(), place.growth);
        self.system = System::new(model, self.system.controls.clone(), state);
        self.place = place;
        if self.place.stage != Stage::Growing {
            self.let_go();
        }
        Ok(())
    }

    fn record(&self) -> Record {
        self.place.record.clone()
    }
}
