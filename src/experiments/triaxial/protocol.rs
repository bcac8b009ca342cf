//! The course of the test: grains grow, the membrane is let go under the rising pressure, the plates
//! follow until they bear as much, everything comes to rest, and then the plates approach steadily.
//!
//! ```text
//! servo of a plate:   v = v_servo (1 − p_plate/p_c), at most v_max     towards the grains
//! shearing:           v = v_shear/2 · min(1, t/t_start)                each plate
//! ```
//!
//! A plate that yields by v/p = 1/(ρ c) swallows the sound that meets it, so v_servo = p_c/(ρ c) is
//! the fastest servo that does not swing. Until the plates start, all speeds decay at a named rate.

use serde::{Deserialize, Serialize};

use super::{
    build::{BOTTOM, Recipe, TOP},
    measure,
    time_series::Logbook,
};
use crate::{
    base::{
        Real, Vec3,
        real::{Twist, real},
    },
    measure as packing_measure,
    physics::{
        System,
        boundary::motion::{Load, Servo, WallMotion},
        health::Diverged,
        packing::{
            Grown, Growth, Laws,
            grow::{self, Progress as Grow},
        },
    },
};

/// Substeps after which the specimen's cross-section is measured anew, and rest is judged.
const LOOK_EVERY: u64 = 50;
/// Substeps after which the free membrane's substep is found anew. In that time grains move by some
/// hundredths of their size, and finding it takes some hundredths of the time of the substeps.
const PACE_EVERY: u64 = 4000;

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Stage {
    /// Grains grow in the held membrane.
    Growing,
    /// Pressure and stiffness climb.
    Confining,
    /// The specimen comes to rest under the confining pressure.
    Resting,
    /// The plates approach.
    Shearing,
    /// The end.
    Done,
}

impl Stage {
    /// Its name in records.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Growing => "growing",
            Self::Confining => "confining",
            Self::Resting => "resting",
            Self::Shearing | Self::Done => "shearing",
        }
    }
}

/// How far the test is: with the `State` all that is needed to go on.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Course {
    pub(super) stage: Stage,
    /// Substeps in this stage.
    pub(super) n_in_stage: u64,
    /// Time in this stage [s].
    pub(super) time_in_stage: Real,
    /// The present substep [s].
    pub(super) substep: Real,
    growth: Grow,
    /// Cross-section when it was last measured [m²].
    area: Real,
    /// Forces on the plates in the last substep [N].
    plate_forces: [Real; 2],
    /// What is recorded.
    pub(super) logbook: Logbook,
}

/// A specimen on its course.
pub(super) struct Test {
    pub(super) recipe: Recipe,
    pub(super) system: System,
    growth: Growth,
    pub(super) course: Course,
    /// Relative speed of the plates while shearing [m/s].
    speed: Real,
    /// Strain at which shearing ends.
    strain: Real,
}

impl Test {
    /// Before the grains grow; shearing goes at `speed` [m/s] to a strain in a number of points.
    pub(super) fn new(
        recipe: Recipe,
        mut system: System,
        speed: Real,
        (strain, n_points): (Real, usize),
    ) -> Self {
        recipe.hold(&mut system.model);
        let growth = growth(&recipe, &system);
        let mut logbook = Logbook::new(strain, n_points);
        logbook.set("n_grains", real(recipe.final_radii.len()), "1");
        logbook.set("n_vertices", real(system.model.membrane.mesh.n_vertices()), "1");
        let course = Course {
            stage: Stage::Growing,
            n_in_stage: 0,
            time_in_stage: 0.0,
            substep: system.model.substep,
            growth: growth.progress(),
            area: measure::volume(&system) / measure::height(&system),
            plate_forces: [0.0; 2],
            logbook,
        };
        Self { recipe, system, growth, course, speed, strain }
    }

    /// Goes on from `course` with the state that belongs to it, which the system holds already.
    pub(super) fn resume(&mut self, course: Course) {
        self.system.controls.walls.clone_from(&self.system.state.walls);
        let walls = &self.system.state.walls;
        self.drive([BOTTOM, TOP].map(|wall| walls[wall as usize].twist.linear.z));
        self.system.controls.gauge_setpoint = self.system.state.gauge;
        self.system.scratch = crate::physics::Scratch::new(&self.system.model);
        if course.stage == Stage::Growing {
            self.recipe.hold(&mut self.system.model);
        } else {
            self.recipe.release(&mut self.system.model);
        }
        self.system.model.substep = course.substep;
        let recipe = growth_recipe(&self.recipe, &self.system);
        self.growth = Growth::resumed(recipe, self.recipe.final_radii.clone(), course.growth);
        self.course = course;
    }

    /// Goes on by one substep.
    pub(super) fn step(&mut self) {
        self.course.n_in_stage += 1;
        if self.course.stage != Stage::Growing && self.course.n_in_stage.is_multiple_of(PACE_EVERY)
        {
            self.pace();
        }
        self.course.time_in_stage += self.course.substep;
        match self.course.stage {
            Stage::Growing => self.grow(),
            Stage::Confining => self.confine(),
            Stage::Resting => self.rest(),
            Stage::Shearing => self.shear(),
            Stage::Done => {}
        }
    }

    /// Takes the substep that the membrane bears in its present shape.
    fn pace(&mut self) {
        let System { model, state, .. } = &mut self.system;
        model.substep = self.recipe.step(&model.membrane, &state.membrane.positions);
        self.course.substep = model.substep;
    }

    /// Looks whether it can go on. A membrane that leaks while it is sheared ends the test as it does
    /// in the laboratory: what was recorded up to there counts.
    ///
    /// # Errors
    /// The first fault in a fixed order.
    pub(super) fn check(&mut self) -> Result<(), Diverged> {
        match self.system.check(self.course.n_in_stage) {
            Err(fault) if fault.is_leak() && self.course.stage == Stage::Shearing => {
                self.course.logbook.leak(&self.system);
                self.enter(Stage::Done);
                Ok(())
            }
            other => other,
        }
    }

    /// Share of the whole work that is done, as far as it can be told.
    pub(super) fn share(&self) -> Real {
        let confining = &self.recipe.setup.confining;
        let times =
            [self.growth_time(), confining.ramp, 0.5 * confining.rest_time_max, self.shear_time()];
        let before = match self.course.stage {
            Stage::Growing => 0,
            Stage::Confining => 1,
            Stage::Resting => 2,
            Stage::Shearing => 3,
            Stage::Done => return 1.0,
        };
        // In substeps of the free membrane's first shape, which cost the same in all stages.
        let [growing, free] = [self.recipe.growth_step, self.recipe.first_step];
        let work = |k: usize| times[k] / if k == 0 { growing } else { free };
        let now = (self.course.time_in_stage / times[before]).min(1.0) * work(before);
        let done = (0..before).map(work).sum::<Real>() + now;
        (done / (0..times.len()).map(work).sum::<Real>()).min(0.999)
    }

    /// About the time growth takes [s].
    fn growth_time(&self) -> Real {
        let rate = growth_recipe(&self.recipe, &self.system).rate;
        self.recipe.first_scale.recip().ln() / rate + 1.5 / rate
    }

    /// Time of shearing [s].
    fn shear_time(&self) -> Real {
        let way = self.recipe.size().height * (1.0 - (-self.strain).exp());
        way / self.speed + self.recipe.setup.shear.start_time
    }

    fn grow(&mut self) {
        let grown = self.growth.step(&mut self.system);
        self.course.growth = self.growth.progress();
        if grown == Grown::Growing {
            return;
        }
        let grow::Progress { scale, pressure, .. } = self.growth.progress();
        let logbook = &mut self.course.logbook;
        logbook.set("growth_scale", scale, "1");
        logbook.set("growth_pressure", pressure, "Pa");
        let solid =
            packing_measure::grain_volume(&self.system.state) / measure::volume(&self.system);
        logbook.set("solid_fraction_grown", solid, "1");
        let contacts = measure::carried(&self.system).coordination;
        logbook.set("coordination_grown", contacts, "1");
        self.recipe.release(&mut self.system.model);
        self.course.substep = self.system.model.substep;
        // The lists tell who touches the membrane, and all of it is free to move now.
        self.system.scratch.neighbors.is_built = false;
        self.enter(Stage::Confining);
    }

    fn confine(&mut self) {
        let share = (self.course.time_in_stage / self.recipe.setup.confining.ramp).min(1.0);
        self.recipe.soften(&mut self.system.model, 1.0 - share);
        self.press(share);
        if share >= 1.0 {
            self.enter(Stage::Resting);
        }
    }

    fn rest(&mut self) {
        self.press(1.0);
        if !self.course.n_in_stage.is_multiple_of(LOOK_EVERY) {
            return;
        }
        let confining = self.recipe.setup.confining;
        let carried = measure::carried(&self.system);
        let missing = self.plate_pressure() / confining.pressure - 1.0;
        let moving = measure::grain_energy(&self.system);
        let is_calm = moving < confining.rest_energy * carried.elastic_energy
            && missing.abs() < confining.rest_stress;
        let time = self.course.time_in_stage;
        if is_calm || time >= confining.rest_time_max {
            self.drive([0.0, -0.0]);
            let logbook = &mut self.course.logbook;
            logbook.set("rest_time", time, "s");
            logbook.set("rest_energy", moving / carried.elastic_energy, "1");
            logbook.set("rest_unbalanced", carried.unbalanced, "1");
            logbook.validity.unbalanced_force = carried.unbalanced;
            logbook.start(&self.system, confining.pressure, self.course.plate_forces);
            self.enter(Stage::Shearing);
        }
    }

    fn shear(&mut self) {
        let start = self.recipe.setup.shear.start_time;
        let speed = 0.5 * self.speed * (self.course.time_in_stage / start).min(1.0);
        self.drive([speed, -speed]);
        self.advance();
        let forces = measure::plate_forces(&self.system);
        let density = self.recipe.setup.grains.material.density;
        let is_over =
            self.course.logbook.look(&self.system, forces, (2.0 * speed, self.strain, density));
        if is_over {
            self.enter(Stage::Done);
        }
    }

    /// One substep under `share` of the confining pressure, which the plates follow.
    fn press(&mut self, share: Real) {
        let confining = self.recipe.setup.confining;
        let (damping, pressure) = (confining.damping, confining.pressure * share);
        let (gain, fastest) = (confining.servo_speed, confining.servo_speed_max);
        self.system.controls.gauge_setpoint = -pressure;
        let servo = Servo {
            axis: Vec3::z(),
            load: Load::Pressure { area: self.course.area },
            target: pressure,
            full_scale: confining.pressure,
            gain,
            speed_max: fastest,
        };
        let [bottom, top] = self.course.plate_forces.map(|force| servo.speed(force));
        self.drive([bottom, -top]);
        self.advance();
        self.damp(damping);
        self.course.plate_forces = measure::plate_forces(&self.system);
        if self.course.n_in_stage.is_multiple_of(LOOK_EVERY) {
            self.course.area = measure::volume(&self.system) / measure::height(&self.system);
        }
    }

    /// One substep of the system.
    fn advance(&mut self) {
        self.system.step();
        keep_between_plates(&mut self.system);
    }

    /// Mean pressure on both plates in the last substep [Pa].
    fn plate_pressure(&self) -> Real {
        let [bottom, top] = self.course.plate_forces;
        0.5 * (bottom + top) / self.course.area
    }

    /// Velocities of the lower and the upper plate along z [m/s].
    fn drive(&mut self, [bottom, top]: [Real; 2]) {
        for (wall, speed) in [(BOTTOM, bottom), (TOP, top)] {
            let linear = Vec3::new(0.0, 0.0, speed);
            let twist = Twist { linear, angular: Vec3::zeros() };
            self.system.model.walls[wall as usize].motion = WallMotion::Velocity(twist);
        }
    }

    /// Lets all speeds decay at `rate` [1/s] for a substep.
    fn damp(&mut self, rate: Real) {
        let left = 1.0 - rate * self.course.substep;
        let state = &mut self.system.state;
        let of_grains =
            state.grains.velocities.iter_mut().chain(&mut state.grains.angular_velocities);
        of_grains.chain(&mut state.membrane.velocities).for_each(|it| *it *= left);
    }

    fn enter(&mut self, stage: Stage) {
        self.course.logbook.count(self.course.stage.name(), self.course.n_in_stage);
        self.course.stage = stage;
        self.course.n_in_stage = 0;
        self.course.time_in_stage = 0.0;
    }
}

/// A vertex that would pass a plate stays where it meets it: air presses the sheet on the plates
/// wherever no grain holds it off, and its friction there is high.
pub(super) fn keep_between_plates(system: &mut System) {
    let state = &mut system.state;
    let [bottom, top] = [BOTTOM, TOP].map(|wall| {
        let motion = &state.walls[wall as usize];
        (motion.pose.translation.z, motion.twist.linear)
    });
    let sheet = &mut state.membrane;
    for (position, velocity) in sheet.positions.iter_mut().zip(&mut sheet.velocities) {
        if position.z < bottom.0 {
            (position.z, *velocity) = bottom;
        } else if position.z > top.0 {
            (position.z, *velocity) = top;
        }
    }
}

fn growth(recipe: &Recipe, system: &System) -> Growth {
    Growth::new(growth_recipe(recipe, system), recipe.final_radii.clone(), recipe.first_scale)
}

/// Growth under the model's laws, with the friction that the scene names.
fn growth_recipe(recipe: &Recipe, system: &System) -> grow::Recipe {
    let setup = &recipe.setup;
    let radius = system.model.radius_mean;
    let mass = crate::physics::packing::sphere_volume(radius) * setup.grains.material.density;
    let volume = std::f64::consts::PI * recipe.size().radius.powi(2) * recipe.size().height;
    let stop = setup.growth.pressure_stop;
    let mut growth = grow::Recipe::new(&system.model, volume, stop, mass, radius);
    growth.laws = Laws::of(&system.model);
    // `Laws` has one law for all walls, and the frame touches no grain.
    for law in [&mut growth.laws.grains, &mut growth.laws.walls, &mut growth.laws.membrane] {
        law.friction = setup.growth.friction;
    }
    growth
}
