//! Grains into the bag, as Götz (2024), section 4.2, does it: the membrane is held stretched, grains
//! grow in it without friction (Lubachevsky & Stillinger 1990) while they fall, then the membrane
//! is let go, its springs are shortened, and everything comes to rest.
//!
//! The source leaves open how the bag is let go. Here the rest lengths start at the held shape and
//! shrink steadily to their final value, so that the bag closes on the grains without a snap.

use serde::{Deserialize, Serialize};

use super::{
    Controls, Model, State, System,
    boundary::body::BodyMotion,
    health::Diverged,
    law::PairLaw,
    membrane::{CARRIER_ID, MembraneState, mesh::Mesh},
    neighbours::update_pair_masses,
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

/// Solid fraction of the bowl at which grains are placed before they grow. Random placement
/// without contact gets slow above a third.
const FIRST_SOLID_FRACTION: Real = 0.15;
/// Growth per relaxation time: slow enough that grains get out of each other's way.
const GROWTH_PER_RELAXATION: Real = 0.05;
/// Pressure that the growing grains may exert, for the relaxation time (Pa).
const GROWTH_PRESSURE: Real = 900.0;
/// Time to fall into the bowl (s).
const FALL_TIME: Real = 0.12;
/// Time over which the springs are shortened (s).
const SHRINK_TIME: Real = 0.15;
/// Time over which softer grains become as hard as they are (s).
const HARDEN_TIME: Real = 0.03;
/// Longest time to come to rest (s).
const REST_TIME_MAX: Real = 0.4;
/// Root mean square speed of grains at rest (m/s).
const REST_SPEED: Real = 2e-3;

/// Substeps between two looks at progress and health.
const LOOK_EVERY: usize = 100;

/// How far the filling is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// What is being done.
    pub stage: &'static str,
    /// Share of the longest time the filling can take.
    pub share: Real,
}

/// Fills the bag of `model` with the grains of `scene`; the flange stands at its first pose.
///
/// # Errors
/// If the system blows up or a grain leaks.
pub fn fill(
    scene: &Scene,
    model: &Model,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<State, Diverged> {
    let mut filling = Filling::new(scene, model, model);
    while !filling.is_settled() {
        filling.advance(LOOK_EVERY)?;
        on_progress(filling.progress());
    }
    Ok(filling.into_state())
}

/// What is done to the bag, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Stage {
    /// All radii grow by a common factor, without friction; the membrane is held stretched.
    Growing,
    /// The grains fall into the held bowl.
    Falling,
    /// The membrane is free, its springs are shortened.
    Closing,
    /// Grains that were filled in softer than they are become as hard as they are.
    Hardening,
    /// Everything comes to rest.
    Resting,
    /// Done.
    Settled,
}

const STAGES: [Stage; 5] =
    [Stage::Growing, Stage::Falling, Stage::Closing, Stage::Hardening, Stage::Resting];

impl Stage {
    /// Its name.
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

/// Progress of a filling. With the state it is all that a filling resumes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Place {
    /// What is being done.
    pub stage: Stage,
    /// Substeps of the stage that are done.
    pub k: usize,
}

/// A bag that is being filled, substep by substep.
pub struct Filling {
    /// The system while it is filled, and when it is.
    soft: Model,
    goal: Model,
    /// With the model of the present stage.
    system: System,
    place: Place,
    recipe: Recipe,
}

/// Parameters of the filling, from the scene.
struct Recipe {
    final_radii: Vec<Real>,
    /// Share of the final radii at which the growth begins.
    first: Real,
    density: Real,
    /// Rest lengths of the springs over those of the reference shape, before and after closing.
    rest_lengths: [Real; 2],
    held_shape: Vec<Vec3>,
    /// Substeps of each stage, of the last one the most.
    n_substeps: [usize; STAGES.len()],
}

impl Recipe {
    fn new(scene: &Scene, models: [&Model; 2]) -> Self {
        let [soft, goal] = models;
        let density = scene.grains.material.density * goal.density_scaling;
        let slower = goal.density_scaling.sqrt();
        let stretch = scene.membrane.fill_stretch;
        let final_radii = final_radii(scene);
        let first = first_scale(scene, &final_radii);
        let mass = sphere_volume(goal.radius_mean) * density;
        let relaxation = (mass / (GROWTH_PRESSURE * 2.0 * goal.radius_mean)).sqrt();
        let rate = GROWTH_PER_RELAXATION / relaxation;
        let growth = first.recip().ln() / rate;
        let of_soft = |time: Real| count(slower * time / soft.substep);
        let is_softer = soft.grain_law.modulus < goal.grain_law.modulus;
        Self {
            first,
            density,
            rest_lengths: [stretch, 1.0 - scene.membrane.rest_length_shrink],
            held_shape: held_shape(&goal.membrane.mesh, stretch),
            n_substeps: [
                count(growth / soft.substep),
                of_soft(FALL_TIME),
                of_soft(SHRINK_TIME),
                if is_softer { count(slower * HARDEN_TIME / goal.substep) } else { 0 },
                count(slower * REST_TIME_MAX / goal.substep),
            ],
            final_radii,
        }
    }
}

impl Filling {
    /// Grains at random places in the held bowl, before they grow. `soft` and `goal` are the model
    /// while it is filled and in the end: with softer grains the substep is longer.
    pub fn new(scene: &Scene, soft: &Model, goal: &Model) -> Self {
        let recipe = Recipe::new(scene, [soft, goal]);
        let state = scatter(scene, &recipe);
        Self::with([soft, goal], recipe, Place { stage: Stage::Growing, k: 0 }, state)
    }

    /// Resumes `(place, state)` of a filling of the same scene.
    pub fn resume(
        scene: &Scene,
        soft: &Model,
        goal: &Model,
        (place, state): (Place, State),
    ) -> Self {
        Self::with([soft, goal], Recipe::new(scene, [soft, goal]), place, state)
    }

    fn with(models: [&Model; 2], recipe: Recipe, place: Place, state: State) -> Self {
        let [soft, goal] = models.map(|it| Model { bodies: Vec::new(), ..it.clone() });
        let controls =
            Controls { gauge_setpoint: 0.0, walls: state.walls.clone(), bodies: Vec::new() };
        let system = System::new(goal.clone(), controls, state);
        let mut filling = Self { soft, goal, system, place, recipe };
        filling.enter();
        filling
    }

    /// Goes on by at most `n_substeps`.
    ///
    /// # Errors
    /// If the system blows up or a grain leaks.
    pub fn advance(&mut self, n_substeps: usize) -> Result<(), Diverged> {
        for _ in 0..n_substeps {
            if self.is_settled() {
                break;
            }
            self.step()?;
        }
        Ok(())
    }

    /// How far it is.
    pub fn place(&self) -> Place {
        self.place
    }

    /// The state so far.
    pub fn state(&self) -> &State {
        &self.system.state
    }

    /// True when everything has come to rest.
    pub fn is_settled(&self) -> bool {
        self.place.stage == Stage::Settled
    }

    /// The state at the end.
    pub fn into_state(self) -> State {
        self.system.state
    }

    /// Most substeps that the whole filling can take.
    pub fn n_substeps_max(&self) -> usize {
        self.recipe.n_substeps.iter().sum()
    }

    /// How far it is, in words and as a share.
    pub fn progress(&self) -> Progress {
        let stages = STAGES.iter().zip(&self.recipe.n_substeps);
        let before: usize =
            stages.filter(|(stage, _)| **stage < self.place.stage).map(|(_, n)| n).sum();
        let share = real(before + self.place.k) / real(self.n_substeps_max());
        Progress { stage: self.place.stage.name(), share }
    }

    /// Makes the model that of the present stage.
    fn enter(&mut self) {
        let stage = self.place.stage;
        let is_soft = stage <= Stage::Closing;
        self.system.model = if is_soft { self.soft.clone() } else { self.goal.clone() };
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

    /// Rest lengths when `share` of the closing is over.
    fn close(&mut self, share: Real) {
        let [first, last] = self.recipe.rest_lengths;
        self.system.model.membrane.scale_rest_lengths(first + (last - first) * share);
    }

    /// Laws when `share` of the hardening is over: moduli rise by equal factors in equal times.
    fn harden(&mut self, share: Real) {
        let between = |soft: &PairLaw, hard: &PairLaw| {
            let blend = |a: Real, b: Real| a * (b / a).powf(share);
            PairLaw {
                modulus: blend(soft.modulus, hard.modulus),
                shear_modulus: blend(soft.shear_modulus, hard.shear_modulus),
                ..*hard
            }
        };
        let (soft, goal) = (&self.soft, &self.goal);
        self.system.model.grain_law = between(&soft.grain_law, &goal.grain_law);
        self.system.model.membrane_law = between(&soft.membrane_law, &goal.membrane_law);
        for (k, wall) in self.system.model.walls.iter_mut().enumerate() {
            wall.law = between(&soft.walls[k].law, &goal.walls[k].law);
        }
    }

    /// Radii when `share` of the growing is over.
    fn grow(&mut self, share: Real) {
        let scale = self.recipe.first.powf(1.0 - share);
        for (i, &radius) in self.recipe.final_radii.iter().enumerate() {
            self.system.state.grains.radii[i] = scale * radius;
            self.system.state.grains.masses[i] =
                sphere_volume(scale * radius) * self.recipe.density;
        }
        update_pair_masses(&self.system.state, &mut self.system.scratch.neighbours);
    }

    /// The stage after `stage`, without those that have nothing to do.
    fn after(&self, stage: Stage) -> Stage {
        let next = stage.next();
        let is_idle = |it: Stage| self.recipe.n_substeps.get(it as usize) == Some(&0);
        if is_idle(next) { next.next() } else { next }
    }

    fn step(&mut self) -> Result<(), Diverged> {
        let Place { stage, k } = self.place;
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
        if k.is_multiple_of(LOOK_EVERY) {
            self.system.check(0)?;
            is_over |= stage == Stage::Resting && speed(&self.system.state) < REST_SPEED;
        }
        self.place.k += 1;
        if is_over {
            self.place = Place { stage: self.after(stage), k: 0 };
            self.enter();
        }
        Ok(())
    }
}

/// Root mean square speed of the grains (m/s).
fn speed(state: &State) -> Real {
    let velocities = &state.grains.velocities;
    let sum: Real = velocities.iter().map(|v| v.norm_squared()).sum();
    (sum / real(velocities.len().max(1))).sqrt()
}

/// The stretched shape in which the membrane is held, flange frame; the rim stays where it is.
fn held_shape(mesh: &Mesh, stretch: Real) -> Vec<Vec3> {
    let of = |v: usize| mesh.positions[v] * if mesh.is_on_rim[v] { 1.0 } else { stretch };
    (0..mesh.n_vertices()).map(of).collect()
}

fn final_radii(scene: &Scene) -> Vec<Real> {
    let mut random = Random::new(scene.seed, Stream::Radius);
    let grains = &scene.grains;
    (0..grains.count).map(|_| random.between(grains.radius_min, grains.radius_max)).collect()
}

/// Share of their final radii at which the grains fill the bowl only thinly.
fn first_scale(scene: &Scene, final_radii: &[Real]) -> Real {
    let bowl = sphere_volume(scene.membrane.fill_stretch * scene.membrane.radius) / 2.0;
    let grains: Real = final_radii.iter().map(|&r| sphere_volume(r)).sum();
    (FIRST_SOLID_FRACTION * bowl / grains).cbrt().min(0.9)
}

/// Grains at random places in the held bowl, without contact, at rest.
fn scatter(scene: &Scene, recipe: &Recipe) -> State {
    let (final_radii, scale) = (&recipe.final_radii, recipe.first);
    let mut random = Random::new(scene.seed, Stream::Position);
    let pose = scene.flange.pose;
    // One final diameter away from wall and plate: the growing grains reach them later.
    let margin = 2.0 * scene.grains.radius_max;
    let reach = scene.membrane.fill_stretch * scene.membrane.radius - margin;
    let mut local: Vec<Vec3> = Vec::with_capacity(final_radii.len());
    for (i, &radius) in final_radii.iter().enumerate() {
        let place = loop {
            let place = Vec3::new(
                random.between(-reach, reach),
                random.between(-reach, reach),
                random.between(-reach, -margin),
            );
            let is_free = |(other, &position): (&Real, &Vec3)| {
                let apart = scale * (radius + other);
                (place - position).norm_squared() > apart * apart
            };
            if place.norm() < reach && final_radii[..i].iter().zip(&local).all(is_free) {
                break place;
            }
        };
        local.push(place);
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
