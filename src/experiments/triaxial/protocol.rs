//! The protocol of the test: grains grow, the membrane is released under rising pressure, the
//! plates follow until they carry the same pressure, the specimen comes to rest, and then the
//! plates approach at constant speed.
//!
//! ```text
//! servo of a plate:   v = v_servo (1 − p_plate/p_c), at most v_max     toward the grains
//! shearing:           v = v_shear/2 · min(1, t/t_start)                each plate
//! ```
//!
//! A plate that yields by v/p = 1/(ρ c) absorbs sound waves, so v_servo = p_c/(ρ c) is the fastest
//! servo that does not oscillate. Until shearing starts, all velocities decay at a given rate.

use serde::{Deserialize, Serialize};

use super::{
    build::{BOTTOM, Recipe, TOP},
    measure,
    time_series::TimeSeries,
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

/// Substeps between two measurements of the specimen's cross-section and of rest.
const CHECK_EVERY: u64 = 50;
/// Substeps between two updates of the free membrane's substep. In that time grains move by a few
/// hundredths of their size, and the update costs a few hundredths of the time of the substeps.
const UPDATE_SUBSTEP_EVERY: u64 = 4000;

/// A phase of the test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum Phase {
    /// Grains grow inside the held membrane.
    Growing,
    /// Pressure and stiffness rise.
    Confining,
    /// The specimen comes to rest under the confining pressure.
    Resting,
    /// The plates approach.
    Shearing,
    /// The test is over.
    Done,
}

impl Phase {
    /// Name in records.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Growing => "growing",
            Self::Confining => "confining",
            Self::Resting => "resting",
            Self::Shearing | Self::Done => "shearing",
        }
    }
}

/// Progress of the test: together with the `State`, everything needed to resume.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct TestProgress {
    pub(super) phase: Phase,
    /// Substeps in this phase.
    pub(super) n_in_phase: u64,
    /// Time in this phase (s).
    pub(super) time_in_phase: Real,
    /// The current substep (s).
    pub(super) substep: Real,
    growth: Grow,
    /// Cross-section at its last measurement (m²).
    area: Real,
    /// Forces on the plates in the last substep (N).
    plate_forces: [Real; 2],
    /// The recorded series.
    pub(super) series: TimeSeries,
}

/// A specimen and its protocol.
pub(super) struct TriaxialTest {
    pub(super) recipe: Recipe,
    pub(super) system: System,
    growth: Growth,
    pub(super) progress: TestProgress,
    /// Relative speed of the plates while shearing (m/s).
    speed: Real,
    /// Strain at which shearing ends.
    strain: Real,
}

impl TriaxialTest {
    /// Before the grains grow. Shearing goes at `speed` (m/s) up to a strain, with a number of
    /// recorded points.
    pub(super) fn new(
        recipe: Recipe,
        mut system: System,
        speed: Real,
        (strain, n_points): (Real, usize),
    ) -> Self {
        recipe.hold(&mut system.model);
        let growth = growth(&recipe, &system);
        let mut series = TimeSeries::new(strain, n_points);
        series.set("n_grains", real(recipe.final_radii.len()), "1");
        series.set("n_vertices", real(system.model.membrane.mesh.n_vertices()), "1");
        let progress = TestProgress {
            phase: Phase::Growing,
            n_in_phase: 0,
            time_in_phase: 0.0,
            substep: system.model.substep,
            growth: growth.progress(),
            area: measure::volume(&system) / measure::height(&system),
            plate_forces: [0.0; 2],
            series,
        };
        Self { recipe, system, growth, progress, speed, strain }
    }

    /// Resumes from `progress`; the system already holds the state that belongs to it.
    pub(super) fn resume(&mut self, progress: TestProgress) {
        self.system.controls.walls.clone_from(&self.system.state.walls);
        let walls = &self.system.state.walls;
        self.drive([BOTTOM, TOP].map(|wall| walls[wall as usize].twist.linear.z));
        self.system.controls.gauge_setpoint = self.system.state.gauge;
        self.system.scratch = crate::physics::Scratch::new(&self.system.model);
        if progress.phase == Phase::Growing {
            self.recipe.hold(&mut self.system.model);
        } else {
            self.recipe.release(&mut self.system.model);
        }
        self.system.model.substep = progress.substep;
        let recipe = growth_recipe(&self.recipe, &self.system);
        self.growth = Growth::resumed(recipe, self.recipe.final_radii.clone(), progress.growth);
        self.progress = progress;
    }

    /// Advances by one substep.
    pub(super) fn step(&mut self) {
        self.progress.n_in_phase += 1;
        if self.progress.phase != Phase::Growing
            && self.progress.n_in_phase.is_multiple_of(UPDATE_SUBSTEP_EVERY)
        {
            self.update_substep();
        }
        self.progress.time_in_phase += self.progress.substep;
        match self.progress.phase {
            Phase::Growing => self.grow(),
            Phase::Confining => self.confine(),
            Phase::Resting => self.rest(),
            Phase::Shearing => self.shear(),
            Phase::Done => {}
        }
    }

    /// Sets the substep that is stable for the current shape of the membrane.
    fn update_substep(&mut self) {
        let System { model, state, .. } = &mut self.system;
        model.substep = self.recipe.step(&model.membrane, &state.membrane.positions);
        self.progress.substep = model.substep;
    }

    /// Checks the state. A leak of the membrane while shearing ends the test as in the laboratory:
    /// the curve up to that point is valid.
    ///
    /// # Errors
    /// If the simulation has diverged, or leaks before shearing.
    pub(super) fn check(&mut self) -> Result<(), Diverged> {
        match self.system.check(self.progress.n_in_phase) {
            Err(error) if error.is_leak() && self.progress.phase == Phase::Shearing => {
                self.progress.series.leak(&self.system);
                self.enter(Phase::Done);
                Ok(())
            }
            other => other,
        }
    }

    /// Estimated share of the work that is done.
    pub(super) fn share(&self) -> Real {
        let confining = &self.recipe.scene.confining;
        let times =
            [self.growth_time(), confining.ramp, 0.5 * confining.rest_time_max, self.shear_time()];
        let before = match self.progress.phase {
            Phase::Growing => 0,
            Phase::Confining => 1,
            Phase::Resting => 2,
            Phase::Shearing => 3,
            Phase::Done => return 1.0,
        };
        // In substeps of the undeformed free membrane, which cost the same in all phases.
        let [growing, free] = [self.recipe.growth_step, self.recipe.first_step];
        let work = |k: usize| times[k] / if k == 0 { growing } else { free };
        let now = (self.progress.time_in_phase / times[before]).min(1.0) * work(before);
        let done = (0..before).map(work).sum::<Real>() + now;
        (done / (0..times.len()).map(work).sum::<Real>()).min(0.999)
    }

    /// Estimated time of growth (s).
    fn growth_time(&self) -> Real {
        let rate = growth_recipe(&self.recipe, &self.system).rate;
        self.recipe.first_scale.recip().ln() / rate + 1.5 / rate
    }

    /// Time of shearing (s).
    fn shear_time(&self) -> Real {
        let distance = self.recipe.size().height * (1.0 - (-self.strain).exp());
        distance / self.speed + self.recipe.scene.shear.start_time
    }

    fn grow(&mut self) {
        let grown = self.growth.step(&mut self.system);
        self.progress.growth = self.growth.progress();
        if grown == Grown::Growing {
            return;
        }
        let grow::Progress { scale, pressure, .. } = self.growth.progress();
        let series = &mut self.progress.series;
        series.set("growth_scale", scale, "1");
        series.set("growth_pressure", pressure, "Pa");
        let solid =
            packing_measure::grain_volume(&self.system.state) / measure::volume(&self.system);
        series.set("solid_fraction_grown", solid, "1");
        let contacts = measure::contacts(&self.system).coordination;
        series.set("coordination_grown", contacts, "1");
        self.recipe.release(&mut self.system.model);
        self.progress.substep = self.system.model.substep;
        // The lists were built for a held membrane; now all of it can move.
        self.system.scratch.neighbors.is_built = false;
        self.enter(Phase::Confining);
    }

    fn confine(&mut self) {
        let share = (self.progress.time_in_phase / self.recipe.scene.confining.ramp).min(1.0);
        self.recipe.soften(&mut self.system.model, 1.0 - share);
        self.press(share);
        if share >= 1.0 {
            self.enter(Phase::Resting);
        }
    }

    fn rest(&mut self) {
        self.press(1.0);
        if !self.progress.n_in_phase.is_multiple_of(CHECK_EVERY) {
            return;
        }
        let confining = self.recipe.scene.confining;
        let contacts = measure::contacts(&self.system);
        let stress_error = self.plate_pressure() / confining.pressure - 1.0;
        let kinetic = measure::grain_energy(&self.system);
        let is_at_rest = kinetic < confining.rest_energy * contacts.elastic_energy
            && stress_error.abs() < confining.rest_stress;
        let time = self.progress.time_in_phase;
        if is_at_rest || time >= confining.rest_time_max {
            self.drive([0.0, -0.0]);
            let series = &mut self.progress.series;
            series.set("rest_time", time, "s");
            series.set("rest_energy", kinetic / contacts.elastic_energy, "1");
            series.set("rest_unbalanced", contacts.unbalanced, "1");
            series.validity.unbalanced_force = contacts.unbalanced;
            series.start(&self.system, confining.pressure, self.progress.plate_forces);
            self.enter(Phase::Shearing);
        }
    }

    fn shear(&mut self) {
        let start = self.recipe.scene.shear.start_time;
        let speed = 0.5 * self.speed * (self.progress.time_in_phase / start).min(1.0);
        self.drive([speed, -speed]);
        self.advance();
        let forces = measure::plate_forces(&self.system);
        let density = self.recipe.scene.grains.material.density;
        let is_over =
            self.progress.series.record(&self.system, forces, (2.0 * speed, self.strain, density));
        if is_over {
            self.enter(Phase::Done);
        }
    }

    /// One substep under `share` of the confining pressure, with both plates servo-controlled.
    fn press(&mut self, share: Real) {
        let confining = self.recipe.scene.confining;
        let (damping, pressure) = (confining.damping, confining.pressure * share);
        let (gain, fastest) = (confining.servo_speed, confining.servo_speed_max);
        self.system.controls.gauge_setpoint = -pressure;
        let servo = Servo {
            axis: Vec3::z(),
            load: Load::Pressure { area: self.progress.area },
            target: pressure,
            full_scale: confining.pressure,
            gain,
            speed_max: fastest,
        };
        let [bottom, top] = self.progress.plate_forces.map(|force| servo.speed(force));
        self.drive([bottom, -top]);
        self.advance();
        self.damp(damping);
        self.progress.plate_forces = measure::plate_forces(&self.system);
        if self.progress.n_in_phase.is_multiple_of(CHECK_EVERY) {
            self.progress.area = measure::volume(&self.system) / measure::height(&self.system);
        }
    }

    /// One substep of the system.
    fn advance(&mut self) {
        self.system.step();
        keep_between_plates(&mut self.system);
    }

    /// Mean pressure on both plates in the last substep (Pa).
    fn plate_pressure(&self) -> Real {
        let [bottom, top] = self.progress.plate_forces;
        0.5 * (bottom + top) / self.progress.area
    }

    /// Sets the velocities of the lower and the upper plate along z (m/s).
    fn drive(&mut self, [bottom, top]: [Real; 2]) {
        for (wall, speed) in [(BOTTOM, bottom), (TOP, top)] {
            let linear = Vec3::new(0.0, 0.0, speed);
            let twist = Twist { linear, angular: Vec3::zeros() };
            self.system.model.walls[wall as usize].motion = WallMotion::Velocity(twist);
        }
    }

    /// Lets all velocities decay at `rate` (1/s) for a substep.
    fn damp(&mut self, rate: Real) {
        let left = 1.0 - rate * self.progress.substep;
        let state = &mut self.system.state;
        let of_grains =
            state.grains.velocities.iter_mut().chain(&mut state.grains.angular_velocities);
        of_grains.chain(&mut state.membrane.velocities).for_each(|it| *it *= left);
    }

    fn enter(&mut self, phase: Phase) {
        self.progress.series.count(self.progress.phase.name(), self.progress.n_in_phase);
        self.progress.phase = phase;
        self.progress.n_in_phase = 0;
        self.progress.time_in_phase = 0.0;
    }
}

/// Stops vertices at the plates: air presses the membrane against the plates where no grain holds
/// it off, and its friction there is high.
pub(super) fn keep_between_plates(system: &mut System) {
    let state = &mut system.state;
    let [bottom, top] = [BOTTOM, TOP].map(|wall| {
        let motion = &state.walls[wall as usize];
        (motion.pose.translation.z, motion.twist.linear)
    });
    let membrane = &mut state.membrane;
    for (position, velocity) in membrane.positions.iter_mut().zip(&mut membrane.velocities) {
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

/// Growth under the model's laws, with the friction that the scene sets for it.
fn growth_recipe(recipe: &Recipe, system: &System) -> grow::Recipe {
    let scene = &recipe.scene;
    let radius = system.model.radius_mean;
    let mass = crate::physics::packing::sphere_volume(radius) * scene.grains.material.density;
    let volume = std::f64::consts::PI * recipe.size().radius.powi(2) * recipe.size().height;
    let stop = scene.growth.pressure_stop;
    let mut growth = grow::Recipe::new(&system.model, volume, stop, mass, radius);
    growth.laws = Laws::of(&system.model);
    // `Laws` has one law for all walls, and the frame touches no grain.
    for law in [&mut growth.laws.grains, &mut growth.laws.walls, &mut growth.laws.membrane] {
        law.friction = scene.growth.friction;
    }
    growth
}
