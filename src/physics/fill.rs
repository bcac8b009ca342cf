//! Grains into the bag, as Götz (2024), section 4.2, does it: the membrane is held stretched, grains
//! grow in it without friction (Lubachevsky & Stillinger 1990) while they fall, then the membrane
//! is let go, its springs are shortened, and everything comes to rest.
//!
//! The source leaves open how the bag is let go. Here the rest lengths start at the held shape and
//! shrink steadily to their final value, so that the bag closes on the grains without a snap.

use super::{
    Controls, Model, Scratch, State,
    boundary::body::BodyMotion,
    contact::law::PairLaw,
    health::{self, Diverged},
    measure::real,
    membrane::{CARRIER_ID, MembraneState, mesh::Mesh},
    neighbours::weigh_pairs,
    state::{Grains, Springs},
    substep,
};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::Twist,
    },
    scene::Scene,
};

/// Solid fraction of the bowl at which grains are placed before they grow. Random placement
/// without contact gets slow above a third.
const FIRST_SOLID_FRACTION: Real = 0.15;
/// Growth per relaxation time: slow enough that grains get out of each other's way.
const GROWTH_PER_RELAXATION: Real = 0.05;
/// Pressure that the growing grains may exert, for the relaxation time [Pa].
const GROWTH_PRESSURE: Real = 900.0;
/// Time to fall into the bowl [s].
const FALL_TIME: Real = 0.12;
/// Time over which the springs are shortened [s].
const SHRINK_TIME: Real = 0.15;
/// Longest time to come to rest [s].
const REST_TIME_MAX: Real = 0.4;
/// Root mean square speed of grains at rest [m/s].
const REST_SPEED: Real = 2e-3;

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
    let controls = Controls {
        gauge_setpoint: 0.0,
        walls: vec![BodyMotion { pose: scene.flange.pose, twist: Twist::zero() }],
        bodies: Vec::new(),
    };
    let mut held = model.clone();
    held.bodies.clear();
    held.membrane.holders.fill(CARRIER_ID);
    let stretch = scene.membrane.fill_stretch;
    held.held_positions = held_shape(&model.membrane.mesh, stretch);
    let final_radii = final_radii(scene);
    let scale = first_scale(scene, &final_radii);
    let state = scatter(scene, &held, &final_radii, scale);
    let scratch = Scratch::new(model);
    let mut filling = Filling { model: held, controls, state, scratch, done: 0.0, on_progress };
    filling.grow(scene, &final_radii, scale)?;
    filling.run_for(FALL_TIME, "falling", |_, _| {})?;
    filling.model.membrane.holders.clone_from(&model.membrane.holders);
    filling.model.held_positions.clone_from(&model.held_positions);
    let last = 1.0 - scene.membrane.rest_length_shrink;
    filling.run_for(SHRINK_TIME, "closing", |model, share| {
        model.membrane.scale_rest_lengths(stretch + (last - stretch) * share);
    })?;
    filling.rest()?;
    Ok(filling.state)
}

struct Filling<'a> {
    model: Model,
    controls: Controls,
    state: State,
    scratch: Scratch,
    done: Real,
    on_progress: &'a mut dyn FnMut(Progress),
}

/// Substeps between two looks at progress and health.
const LOOK_EVERY: usize = 100;

impl Filling<'_> {
    /// Growth of all radii by a common factor, without friction.
    fn grow(&mut self, scene: &Scene, final_radii: &[Real], first: Real) -> Result<(), Diverged> {
        let with_friction = self.model.clone();
        let smooth = |law: &mut PairLaw| law.friction = 0.0;
        smooth(&mut self.model.grain_law);
        self.model.walls.iter_mut().for_each(|wall| smooth(&mut wall.law));
        smooth(&mut self.model.membrane_law);
        let radius = self.model.radius_mean;
        let mass = sphere_volume(radius) * scene.grains.material.density;
        let relaxation = (mass / (GROWTH_PRESSURE * 2.0 * radius)).sqrt();
        let rate = GROWTH_PER_RELAXATION / relaxation;
        let n_substeps = count((first.recip().ln() / rate) / self.model.substep);
        let density = scene.grains.material.density;
        for k in 0..n_substeps {
            let scale = first.powf(1.0 - real(k + 1) / real(n_substeps));
            for (i, &radius) in final_radii.iter().enumerate() {
                self.state.grains.radii[i] = scale * radius;
                self.state.grains.masses[i] = sphere_volume(scale * radius) * density;
            }
            weigh_pairs(&self.state, &mut self.scratch.neighbours);
            self.step(k, "growing")?;
        }
        self.model.grain_law = with_friction.grain_law;
        self.model.walls = with_friction.walls;
        self.model.membrane_law = with_friction.membrane_law;
        Ok(())
    }

    /// Runs for `time` [s]; `change` is given the share of it that has passed.
    fn run_for(
        &mut self,
        time: Real,
        stage: &'static str,
        change: impl Fn(&mut Model, Real),
    ) -> Result<(), Diverged> {
        let n_substeps = count(time / self.model.substep);
        for k in 0..n_substeps {
            change(&mut self.model, real(k + 1) / real(n_substeps));
            self.step(k, stage)?;
        }
        Ok(())
    }

    /// Runs until the grains are at rest.
    fn rest(&mut self) -> Result<(), Diverged> {
        let n_substeps = count(REST_TIME_MAX / self.model.substep);
        for k in 0..n_substeps {
            self.step(k, "coming to rest")?;
            if k.is_multiple_of(LOOK_EVERY) && self.speed() < REST_SPEED {
                break;
            }
        }
        Ok(())
    }

    /// Root mean square speed of the grains [m/s].
    fn speed(&self) -> Real {
        let velocities = &self.state.grains.velocities;
        let sum: Real = velocities.iter().map(|v| v.norm_squared()).sum();
        (sum / real(velocities.len().max(1))).sqrt()
    }

    fn step(&mut self, k: usize, stage: &'static str) -> Result<(), Diverged> {
        substep(&self.model, &self.controls, &mut self.state, &mut self.scratch);
        self.done += self.model.substep;
        if k.is_multiple_of(LOOK_EVERY) {
            health::check(&self.model, &self.state, &self.scratch, 0)?;
            let longest = 0.05 + FALL_TIME + SHRINK_TIME + REST_TIME_MAX;
            (self.on_progress)(Progress { stage, share: (self.done / longest).min(1.0) });
        }
        Ok(())
    }
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
fn scatter(scene: &Scene, held: &Model, final_radii: &[Real], scale: Real) -> State {
    let mut random = Random::new(scene.seed, Stream::Position);
    let pose = scene.flange.pose;
    // One final diameter away from wall and plate: the growing grains reach them later.
    let margin = 2.0 * held.radius_max;
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
    let density = scene.grains.material.density;
    let radii: Vec<Real> = final_radii.iter().map(|r| scale * r).collect();
    let in_world = |p: &Vec3| pose.rotation * p + pose.translation.vector;
    let mut membrane = MembraneState::at_rest(&held.membrane.mesh);
    membrane.positions = held.held_positions.iter().map(in_world).collect();
    State {
        grains: Grains {
            positions: local.iter().map(in_world).collect(),
            velocities: vec![Vec3::zeros(); n],
            spins: vec![Vec3::zeros(); n],
            masses: radii.iter().map(|&r| sphere_volume(r) * density).collect(),
            radii,
        },
        membrane,
        springs: Springs::none(n, 1, 0),
        pair_ids: Vec::new(),
        gauge: 0.0,
        walls: vec![BodyMotion { pose, twist: Twist::zero() }],
    }
}

fn sphere_volume(radius: Real) -> Real {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}

/// A positive real rounded up to a count.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "durations over substeps stay far below 2^53"
)]
fn count(value: Real) -> usize {
    value.ceil().max(1.0) as usize
}
