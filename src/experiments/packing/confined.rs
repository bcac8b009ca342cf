//! Grains in a closed membrane under vacuum: their stress equals the applied pressure.
//!
//! Grains grow inside a membrane that is held as a sphere; then it is released and evacuated, and
//! everything comes to rest. σ_ij = 1/V Σ f_i l_j over all contacts, including those with the
//! membrane, with V inside the membrane, must equal the vacuum in every direction, except for the
//! share that the tension of the membrane carries.

use serde::{Deserialize, Serialize};

use super::{
    super::{
        Progress, ResumeError, Run, StartError,
        record::{Column, Record},
    },
    build::{self, SLICE, Settling},
    scene::{Confined as Keys, PackingScene},
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

/// Solid fraction of the final radii in the sphere, as smooth grains reach it in a small one.
const FINAL_FRACTION: Real = 0.58;
/// Poisson's ratio of a hexagonal lattice of springs.
const NET_POISSON: Real = 1.0 / 3.0;
/// Time of evacuation, in drag times.
const DRAW_TIME: Real = 20.0;

/// A phase of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Phase {
    Growing,
    Resting(Settling),
    Done,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct RunState {
    phase: Phase,
    growth: grow::Progress,
    record: Record,
}

/// The running case in the membrane.
pub(super) struct ConfinedRun {
    scene: PackingScene,
    final_radii: Vec<Real>,
    recipe: Recipe,
    growth: Growth,
    system: System,
    progress: RunState,
}

impl ConfinedRun {
    /// The case with scattered grains in the held membrane.
    pub(super) fn new(scene: &PackingScene) -> Result<Self, StartError> {
        let keys = &scene.confined;
        let final_radii = build::final_radii(scene, keys.count, false);
        let solid: Real = final_radii.iter().map(|&r| sphere_volume(r)).sum();
        let radius = (solid / FINAL_FRACTION / sphere_volume(1.0)).cbrt();
        let room = Room::Shell { inner: 0.0, outer: radius };
        let scale = first_scale(&final_radii, scene.compression.thin, room.volume());
        let small: Vec<Real> = final_radii.iter().map(|r| scale * r).collect();
        let margin = scene.grains.radius_max;
        let mut random = Random::new(scene.seed, Stream::Position);
        let positions = scatter(&small, None, &mut random, |it| room.place(margin, it))?;
        let grains = build::grains(scene, positions, &final_radii, scale);
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
        let progress = RunState { phase: Phase::Growing, growth: growth.progress(), record };
        Ok(Self { scene: scene.clone(), final_radii, recipe, growth, system, progress })
    }

    fn step(&mut self) {
        match self.progress.phase {
            Phase::Growing => {
                let grown = self.growth.step(&mut self.system);
                self.progress.growth = self.growth.progress();
                self.progress.record.count("growing", 1);
                if grown != Grown::Growing {
                    self.release();
                    self.progress.phase = Phase::Resting(Settling::default());
                }
            }
            Phase::Resting(mut settling) => {
                let is_time = settling.step(&mut self.system);
                self.progress.phase = Phase::Resting(settling);
                self.progress.record.count("resting", 1);
                if is_time {
                    self.check_rest(settling);
                }
                return;
            }
            Phase::Done => return,
        }
        build::drag(&mut self.system, self.scene.compression.drag_time);
    }

    /// Releases the membrane and evacuates it.
    fn release(&mut self) {
        self.system.model.membrane.holders.fill(FREE);
        self.system.controls.gauge_setpoint = -self.scene.confined.pressure;
    }

    fn check_rest(&mut self, mut settling: Settling) {
        let residuals = settling.residuals(&self.system);
        self.progress.phase = Phase::Resting(settling);
        let compression = &self.scene.compression;
        let System { model, state, scratch, .. } = &self.system;
        let n_max = 2.0 * compression.rest_time_max / model.substep;
        let is_evacuated = state.gauge <= -self.scene.confined.pressure;
        let is_at_rest = is_evacuated && residuals.is_rest();
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
        let record = &mut self.progress.record;
        record.push_row(&row);
        record.set("mean_stress", sigma.trace() / 3.0, "Pa");
        record.set("shear_stress", shear, "Pa");
        record.set("enclosed_volume", volume, "m^3");
        record.set("coordination", packing.coordination_number, "1");
        record.set("unbalanced_force", residuals.unbalanced, "1");
        record.set("kinetic_over_elastic", residuals.kinetic, "1");
        record.validity.overlap_over_diameter_max = overlap;
        record.validity.unbalanced_force = residuals.unbalanced;
        record.digest = digest;
        self.progress.phase = Phase::Done;
    }
}

/// Grains and a spherical membrane of `radius` (m) that is held all over.
fn system(scene: &PackingScene, radius: Real, grains: Grains) -> Result<System, StartError> {
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

/// Latex, as dense as the grains in the source's tables.
fn rubber(keys: &Keys, density: Real) -> Material {
    Material { youngs_modulus: keys.youngs_modulus, poisson_ratio: NET_POISSON, density }
}

impl Run for ConfinedRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let (phase, share) = match self.progress.phase {
            Phase::Growing => ("growing", 0.5 * self.progress.growth.scale.powi(3).min(0.99)),
            Phase::Resting(_) => ("resting", 0.5),
            Phase::Done => ("resting", 1.0),
        };
        for _ in 0..SLICE {
            self.step();
        }
        self.system.check(self.progress.record.n_substeps.values().sum())?;
        let is_done = self.progress.phase == Phase::Done;
        Ok(Progress { phase, share: if is_done { 1.0 } else { share }, is_done })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.progress.record.case, &self.progress, [&self.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (progress, [state]): (RunState, _) =
            saved_run::unpack(&self.progress.record.case, bytes)?;
        saved_run::check_scene(&state, &self.system.state)?;
        let mut model = self.system.model.clone();
        model.radius_max = state.grains.radii.iter().copied().fold(model.radius_max, Real::max);
        self.growth = Growth::resumed(self.recipe, self.final_radii.clone(), progress.growth);
        self.system = System::new(model, self.system.controls.clone(), state);
        self.progress = progress;
        if self.progress.phase != Phase::Growing {
            self.release();
        }
        Ok(())
    }

    fn record(&self) -> Record {
        self.progress.record.clone()
    }
}
