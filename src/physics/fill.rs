//! Fills the gripper's membrane with grains, following Götz (2024), section 4.2.
//!
//! The membrane is held in a stretched shape. Grains grow in it without friction (Lubachevsky &
//! Stillinger 1990) while they fall. Then the membrane is released, its springs are shortened, and
//! everything comes to rest.
//!
//! The source does not specify the release. Here the rest lengths start at those of the held shape
//! and shrink steadily to their final value, so the membrane closes on the grains without a jerk.

use serde::{Deserialize, Serialize};

use super::{
    Controls, Model, State, System,
    boundary::body::BodyMotion,
    health::Diverged,
    law::PairLaw,
    membrane::{CARRIER_ID, MembraneState, mesh::Mesh},
    neighbors::update_pair_masses,
    packing::sphere_volume,
    state::{Grains, Springs},
};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::{Twist, count, real},
    },
    scene::Scene,
};

/// Solid fraction of the held membrane at which grains are placed before they grow. Random placement
/// without contact is slow above a third.
const INITIAL_SOLID_FRACTION: Real = 0.15;
/// Growth per relaxation time: slow enough for grains to move out of each other's way.
const GROWTH_PER_RELAXATION: Real = 0.05;
/// Pressure that growing grains may exert (Pa). It defines the relaxation time.
const GROWTH_PRESSURE: Real = 900.0;
/// Time for grains to fall into the held membrane (s).
const FALL_TIME: Real = 0.12;
/// Time in which the springs are shortened (s).
const SHRINK_TIME: Real = 0.15;
/// Time in which softened grains regain their real stiffness (s).
const HARDEN_TIME: Real = 0.03;
/// Longest time for everything to come to rest (s).
const REST_TIME_MAX: Real = 0.4;
/// Root-mean-square speed below which grains count as at rest (m/s).
const REST_SPEED: Real = 2e-3;

/// Substeps between two checks of progress and health.
const CHECK_INTERVAL: usize = 100;

/// Progress of a filling, for display.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Name of the current stage.
    pub stage: &'static str,
    /// Fraction of the longest duration of the filling.
    pub share: Real,
}

/// Fills the membrane of `model` with the grains of `scene`, with the flange at its initial pose.
///
/// # Errors
/// If the system diverges or a grain leaks.
pub fn fill(
    scene: &Scene,
    model: &Model,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<State, Diverged> {
    let mut filling = Filling::new(scene, model, model);
    while !filling.is_settled() {
        filling.advance(CHECK_INTERVAL)?;
        on_progress(filling.progress());
    }
    Ok(filling.into_state())
}

/// A stage of the filling. The stages follow each other in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Stage {
    /// All radii grow by a common factor, without friction; the membrane is held stretched.
    Growing,
    /// The grains fall into the held membrane.
    Falling,
    /// The membrane is free, and its springs are shortened.
    Closing,
    /// Grains that were softened for the filling regain their real stiffness.
    Hardening,
    /// Everything comes to rest.
    Resting,
    /// The filling is complete.
    Settled,
}

const STAGES: [Stage; 5] =
    [Stage::Growing, Stage::Falling, Stage::Closing, Stage::Hardening, Stage::Resting];

impl Stage {
    /// Name of the stage, as reported.
    pub fn name(self) -> &'static str {
        match self {
            Self::Growing => "growing",
            Self::Falling => "falling",
            Self::Closing => "closing",
            Self::Hardening => "hardening",
            Self::Resting => "coming to rest",
            Self::Settled => "settled",
        }
    }

    fn next(self) -> Self {
        match self {
            Self::Growing => Self::Falling,
            Self::Falling => Self::Closing,
            Self::Closing => Self::Hardening,
            Self::Hardening => Self::Resting,
            Self::Resting | Self::Settled => Self::Settled,
        }
    }
}

/// Position of a filling: with the state, everything needed to resume it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FillPosition {
    /// The current stage.
    pub stage: Stage,
    /// Completed substeps of the stage.
    pub k: usize,
}

/// A membrane being filled, substep by substep.
pub struct Filling {
    /// Models during the filling and at its end; they differ if grains are softened.
    soft: Model,
    target: Model,
    /// The system, with the model of the current stage.
    system: System,
    position: FillPosition,
    recipe: Recipe,
}

/// Parameters of the filling, from the scene.
struct Recipe {
    final_radii: Vec<Real>,
    /// Fraction of the final radii at which growth begins.
    initial_scale: Real,
    density: Real,
    /// Rest lengths of the springs divided by those of the reference shape, before and after closing.
    rest_lengths: [Real; 2],
    held_shape: Vec<Vec3>,
    /// Substeps of each stage; for the last stage, the largest number.
    n_substeps: [usize; STAGES.len()],
}

impl Recipe {
    fn new(scene: &Scene, models: [&Model; 2]) -> Self {
        let [soft, target] = models;
        let density = scene.grains.material.density * target.density_scaling;
        let slower = target.density_scaling.sqrt();
        let stretch = scene.membrane.fill_stretch;
        let final_radii = final_radii(scene);
        let initial_scale = initial_scale(scene, &final_radii);
        let mass = sphere_volume(target.radius_mean) * density;
        let relaxation = (mass / (GROWTH_PRESSURE * 2.0 * target.radius_mean)).sqrt();
        let rate = GROWTH_PER_RELAXATION / relaxation;
        let growth = initial_scale.recip().ln() / rate;
        let of_soft = |time: Real| count(slower * time / soft.substep);
        let is_softer = soft.grain_law.modulus < target.grain_law.modulus;
        Self {
            initial_scale,
            density,
            rest_lengths: [stretch, 1.0 - scene.membrane.rest_length_shrink],
            held_shape: held_shape(&target.membrane.mesh, stretch),
            n_substeps: [
                count(growth / soft.substep),
                of_soft(FALL_TIME),
                of_soft(SHRINK_TIME),
                if is_softer { count(slower * HARDEN_TIME / target.substep) } else { 0 },
                count(slower * REST_TIME_MAX / target.substep),
            ],
            final_radii,
        }
    }
}

impl Filling {
    /// Starts a filling with grains at random positions in the held membrane, before they grow. `soft` is the
    /// model during the filling, `target` the model at its end. Softer grains allow a longer substep.
    pub fn new(scene: &Scene, soft: &Model, target: &Model) -> Self {
        let recipe = Recipe::new(scene, [soft, target]);
        let state = scatter(scene, &recipe);
        Self::with([soft, target], recipe, FillPosition { stage: Stage::Growing, k: 0 }, state)
    }

    /// Resumes a filling of the same scene at `(position, state)`.
    pub fn resume(
        scene: &Scene,
        soft: &Model,
        target: &Model,
        (position, state): (FillPosition, State),
    ) -> Self {
        Self::with([soft, target], Recipe::new(scene, [soft, target]), position, state)
    }

    fn with(models: [&Model; 2], recipe: Recipe, position: FillPosition, state: State) -> Self {
        let [soft, target] = models.map(|it| Model { bodies: Vec::new(), ..it.clone() });
        let controls =
            Controls { gauge_setpoint: 0.0, walls: state.walls.clone(), bodies: Vec::new() };
        let system = System::new(target.clone(), controls, state);
        let mut filling = Self { soft, target, system, position, recipe };
        filling.enter_stage();
        filling
    }

    /// Advances by at most `n_substeps`.
    ///
    /// # Errors
    /// If the system diverges or a grain leaks.
    pub fn advance(&mut self, n_substeps: usize) -> Result<(), Diverged> {
        for _ in 0..n_substeps {
            if self.is_settled() {
                break;
            }
            self.step()?;
        }
        Ok(())
    }

    /// Where the filling is; with `state` it can be resumed.
    pub fn position(&self) -> FillPosition {
        self.position
    }

    /// The current state.
    pub fn state(&self) -> &State {
        &self.system.state
    }

    /// True when everything has come to rest.
    pub fn is_settled(&self) -> bool {
        self.position.stage == Stage::Settled
    }

    /// Ends the filling and returns its state.
    pub fn into_state(self) -> State {
        self.system.state
    }

    /// Largest number of substeps that the whole filling can take.
    pub fn n_substeps_max(&self) -> usize {
        self.recipe.n_substeps.iter().sum()
    }

    /// Name of the stage, and progress as a fraction.
    pub fn progress(&self) -> Progress {
        let stages = STAGES.iter().zip(&self.recipe.n_substeps);
        let before: usize =
            stages.filter(|(stage, _)| **stage < self.position.stage).map(|(_, n)| n).sum();
        let share = real(before + self.position.k) / real(self.n_substeps_max());
        Progress { stage: self.position.stage.name(), share }
    }

    /// Sets up the model of the current stage.
    fn enter_stage(&mut self) {
        let stage = self.position.stage;
        let is_soft = stage <= Stage::Closing;
        self.system.model = if is_soft { self.soft.clone() } else { self.target.clone() };
        if stage <= Stage::Falling {
            self.system.model.membrane.holders.fill(CARRIER_ID);
            self.system.model.held_positions.clone_from(&self.recipe.held_shape);
        }
        if stage == Stage::Growing {
            let smooth = |law: &mut PairLaw| law.friction = 0.0;
            smooth(&mut self.system.model.grain_law);
            self.system.model.walls.iter_mut().for_each(|wall| smooth(&mut wall.law));
            smooth(&mut self.system.model.membrane_law);
        }
        if Stage::Closing < stage {
            self.close(1.0);
        }
    }

    /// Sets the rest lengths for a fraction `share` of the closing.
    fn close(&mut self, share: Real) {
        let [first, last] = self.recipe.rest_lengths;
        self.system.model.membrane.scale_rest_lengths(first + (last - first) * share);
    }

    /// Sets the laws for a fraction `share` of the hardening. Moduli rise by equal factors in equal times.
    fn harden(&mut self, share: Real) {
        let between = |soft: &PairLaw, hard: &PairLaw| {
            let blend = |a: Real, b: Real| a * (b / a).powf(share);
            PairLaw {
                modulus: blend(soft.modulus, hard.modulus),
                shear_modulus: blend(soft.shear_modulus, hard.shear_modulus),
                ..*hard
            }
        };
        let (soft, target) = (&self.soft, &self.target);
        self.system.model.grain_law = between(&soft.grain_law, &target.grain_law);
        self.system.model.membrane_law = between(&soft.membrane_law, &target.membrane_law);
        for (k, wall) in self.system.model.walls.iter_mut().enumerate() {
            wall.law = between(&soft.walls[k].law, &target.walls[k].law);
        }
    }

    /// Sets the radii for a fraction `share` of the growth.
    fn grow(&mut self, share: Real) {
        let scale = self.recipe.initial_scale.powf(1.0 - share);
        for (i, &radius) in self.recipe.final_radii.iter().enumerate() {
            self.system.state.grains.radii[i] = scale * radius;
            self.system.state.grains.masses[i] =
                sphere_volume(scale * radius) * self.recipe.density;
        }
        update_pair_masses(&self.system.state, &mut self.system.scratch.neighbors);
    }

    /// The stage after `stage`, skipping stages without substeps.
    fn stage_after(&self, stage: Stage) -> Stage {
        let next = stage.next();
        let is_empty = |it: Stage| self.recipe.n_substeps.get(it as usize) == Some(&0);
        if is_empty(next) { next.next() } else { next }
    }

    fn step(&mut self) -> Result<(), Diverged> {
        let FillPosition { stage, k } = self.position;
        let n_substeps = self.recipe.n_substeps[stage as usize];
        let share = real(k + 1) / real(n_substeps);
        match stage {
            Stage::Growing => self.grow(share),
            Stage::Closing => self.close(share),
            Stage::Hardening => self.harden(share),
            Stage::Falling | Stage::Resting | Stage::Settled => {}
        }
        self.system.step();
        let mut is_over = k + 1 == n_substeps;
        if k.is_multiple_of(CHECK_INTERVAL) {
            self.system.check(0)?;
            is_over |= stage == Stage::Resting && speed(&self.system.state) < REST_SPEED;
        }
        self.position.k += 1;
        if is_over {
            self.position = FillPosition { stage: self.stage_after(stage), k: 0 };
            self.enter_stage();
        }
        Ok(())
    }
}

/// Root-mean-square speed of the grains (m/s).
fn speed(state: &State) -> Real {
    let velocities = &state.grains.velocities;
    let sum: Real = velocities.iter().map(|v| v.norm_squared()).sum();
    (sum / real(velocities.len().max(1))).sqrt()
}

/// The stretched shape in which the membrane is held (m), flange frame. The rim is not stretched.
fn held_shape(mesh: &Mesh, stretch: Real) -> Vec<Vec3> {
    let of = |v: usize| mesh.positions[v] * if mesh.is_on_rim[v] { 1.0 } else { stretch };
    (0..mesh.n_vertices()).map(of).collect()
}

fn final_radii(scene: &Scene) -> Vec<Real> {
    let mut random = Random::new(scene.seed, Stream::Radius);
    let grains = &scene.grains;
    (0..grains.count).map(|_| random.between(grains.radius_min, grains.radius_max)).collect()
}

/// Fraction of their final radii at which grains are placed, from their initial solid fraction.
fn initial_scale(scene: &Scene, final_radii: &[Real]) -> Real {
    let volume = sphere_volume(scene.membrane.fill_stretch * scene.membrane.radius) / 2.0;
    let grains: Real = final_radii.iter().map(|&r| sphere_volume(r)).sum();
    (INITIAL_SOLID_FRACTION * volume / grains).cbrt().min(0.9)
}

/// Grains at rest at random positions in the held membrane, without contact.
fn scatter(scene: &Scene, recipe: &Recipe) -> State {
    let (final_radii, scale) = (&recipe.final_radii, recipe.initial_scale);
    let mut random = Random::new(scene.seed, Stream::Position);
    let pose = scene.flange.pose;
    // Grains start one final diameter away from membrane and plate and grow toward them.
    let margin = 2.0 * scene.grains.radius_max;
    let limit = scene.membrane.fill_stretch * scene.membrane.radius - margin;
    let mut local: Vec<Vec3> = Vec::with_capacity(final_radii.len());
    for (i, &radius) in final_radii.iter().enumerate() {
        let position = loop {
            let candidate = Vec3::new(
                random.between(-limit, limit),
                random.between(-limit, limit),
                random.between(-limit, -margin),
            );
            let is_free = |(other, &position): (&Real, &Vec3)| {
                let reach = scale * (radius + other);
                (candidate - position).norm_squared() > reach * reach
            };
            if candidate.norm() < limit && final_radii[..i].iter().zip(&local).all(is_free) {
                break candidate;
            }
        };
        local.push(position);
    }
    let n = local.len();
    let radii: Vec<Real> = final_radii.iter().map(|r| scale * r).collect();
    let in_world = |p: &Vec3| pose.rotation * p + pose.translation.vector;
    let membrane = MembraneState {
        positions: recipe.held_shape.iter().map(in_world).collect(),
        velocities: vec![Vec3::zeros(); recipe.held_shape.len()],
    };
    State {
        grains: Grains {
            positions: local.iter().map(in_world).collect(),
            velocities: vec![Vec3::zeros(); n],
            angular_velocities: vec![Vec3::zeros(); n],
            masses: radii.iter().map(|&r| sphere_volume(r) * recipe.density).collect(),
            radii,
        },
        membrane,
        springs: Springs::none(n, 0),
        pair_ids: Vec::new(),
        gauge: 0.0,
        walls: vec![BodyMotion { pose, twist: Twist::zero() }],
        wall_memory: Vec::new(),
    }
}
