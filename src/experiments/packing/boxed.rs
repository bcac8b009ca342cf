//! Grains in a periodic box: they grow until they jam, then change their size in steps with rests.
//!
//! ```text
//! grow to p_first      then, while p < p_last:    all diameters + c ⟨ξ/d⟩, rest, record
//! without friction:    grow to p_high, and while p > p_low:   all diameters − c ⟨ξ/d⟩, rest, record
//! moduli:              at each pressure the small strains of `moduli`
//! ```
//!
//! Enlarging all grains by a factor is equivalent to compressing the box by it, since the contact
//! law has no intrinsic length. Friction stays on, so packings with friction jam where grains first
//! hold each other. Without friction the packing is decompressed: that is reversible, and p(φ)
//! follows Hertz.

use serde::{Deserialize, Serialize};

use super::{
    super::{
        Progress, ResumeError, Run, StartError,
        record::{Column, Record},
    },
    build::{self, Residuals, SLICE, Settling},
    cases::Case,
    measure::Probe,
    scene::PackingScene,
};
use crate::experiments::saved_run;
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::real,
    },
    measure::{
        coordination::{NEEDED_ROUGH, NEEDED_SMOOTH, coordination},
        grain_volume, packing, rest, stress,
        structure::{self, Bins, Region},
    },
    physics::{
        Model, System, SystemBuilder,
        contact::grains::closest_image,
        health::Diverged,
        packing::{
            Grown, Growth, Laws, Recipe, Room, first_scale, grow, pressure::normal_pressure,
            scatter, sphere_volume,
        },
    },
};

/// Solid fraction of the final radii in the box.
const FINAL_FRACTION: Real = 0.64;
/// Growth of all diameters in ten relaxation times below which growth has ended.
const STUCK: Real = 1e-3;
/// Share of a pressure at which it counts as reached.
const REACHED: Real = 0.97;
/// Share of the first pressure below which the packing is loose.
const LOOSE: Real = 0.1;
/// Width of a bin of g(r), in mean diameters.
const BIN: Real = 0.02;
/// Bins of g(r): to four diameters.
const N_BINS: usize = 200;

/// Columns of the record, with one row for each state at rest.
const COLUMNS: [(&str, &str); 10] = [
    ("solid_fraction", "1"),
    ("pressure", "Pa"),
    ("coordination", "1"),
    ("coordination_backbone", "1"),
    ("rattler_share", "1"),
    ("sliding_share", "1"),
    ("overlap_mean_over_diameter", "1"),
    ("overlap_max_over_diameter", "1"),
    ("unbalanced_force", "1"),
    ("kinetic_over_elastic", "1"),
];

/// A phase of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Phase {
    Growing,
    /// Sizes or the box change by `step` in every substep; then the grains rest.
    Ramping {
        what: Change,
        time_left: Real,
        step: Real,
    },
    /// Sizes are constant until nothing moves.
    Resting(Settling),
    Done,
}

/// What changes in a ramp.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Change {
    /// All diameters, by a common factor.
    Sizes,
    /// The box: longer along x, and shorter along y by the same factor.
    Shape,
}

/// A state at rest.
pub(super) struct RestState {
    pub(super) pressure: Real,
    /// σ_xx − σ_yy (Pa).
    pub(super) difference: Real,
    /// Mean overlap over diameter.
    pub(super) overlap: Real,
    pub(super) solid_fraction: Real,
    pub(super) coordination: Real,
}

/// Everything needed to resume, in addition to the state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct RunState {
    phase: Phase,
    growth: grow::Progress,
    scale: Real,
    /// Factor by which the box is longer along x than at the start.
    stretch: Real,
    /// The current measurement of a modulus.
    pub(super) probe: Option<Probe>,
    /// Number of pressures at which moduli have been measured.
    pub(super) n_probed: usize,
    pub(super) record: Record,
}

/// A running case in the periodic box.
pub(super) struct BoxRun {
    pub(super) scene: PackingScene,
    case: Case,
    final_radii: Vec<Real>,
    volume: Real,
    growth: Growth,
    system: System,
    pub(super) progress: RunState,
}

impl BoxRun {
    /// The case with scattered grains.
    pub(super) fn new(scene: &PackingScene, case: Case) -> Result<Self, StartError> {
        let is_mono = !matches!(case, Case::Poly);
        let is_smooth = friction(scene, case) == 0.0;
        let grains = &scene.grains;
        let count = if is_mono && is_smooth { grains.count_smooth } else { grains.count };
        let final_radii = build::final_radii(scene, count, is_mono);
        let solid: Real = final_radii.iter().map(|&r| sphere_volume(r)).sum();
        let volume = solid / FINAL_FRACTION;
        let period = period(volume, 1.0);
        let room = Room::Periodic { period };
        let scale = first_scale(&final_radii, scene.compression.thin, volume);
        let small: Vec<Real> = final_radii.iter().map(|r| scale * r).collect();
        let mut random = Random::new(scene.seed, Stream::Position);
        let positions = scatter(&small, room.period(), &mut random, |it| room.place(0.0, it))?;
        let grains = build::grains(scene, positions, &final_radii, scale);
        let friction = friction(scene, case);
        let law = build::grain_law(&scene.grains, friction);
        let (mean, largest) = (scene.grains.radius_mean(), scene.grains.radius_max);
        let mut builder = SystemBuilder::new(law);
        builder.substep(scene.compression.substep).radii_up_to(largest, mean).period(period);
        // Dense grains hardly move: short lists are rebuilt soon, but quick to go through.
        builder.skin(0.1 * mean).grains(grains);
        let system = builder.build()?;
        let recipe = recipe(scene, &system.model, volume, friction);
        let growth = Growth::new(recipe, final_radii.clone(), scale);
        let mut record = Record { case: case.name(), seed: scene.seed, ..Record::default() };
        record.columns = COLUMNS.iter().map(|(name, unit)| Column::new(name, unit)).collect();
        record.set("friction", friction, "1");
        let progress = RunState {
            phase: Phase::Growing,
            growth: growth.progress(),
            scale,
            stretch: 1.0,
            probe: None,
            n_probed: 0,
            record,
        };
        let (scene, case) = (scene.clone(), case);
        Ok(Self { scene, case, final_radii, volume, growth, system, progress })
    }

    /// One substep of the current phase.
    fn step(&mut self) {
        match self.progress.phase {
            Phase::Growing => {
                let grown = self.growth.step(&mut self.system);
                self.progress.growth = self.growth.progress();
                self.progress.scale = self.progress.growth.scale;
                self.progress.record.count("growing", 1);
                if grown != Grown::Growing {
                    self.begin();
                }
            }
            Phase::Ramping { what, time_left, step } => {
                match what {
                    Change::Sizes => {
                        self.progress.scale += step;
                        grow::resize(&mut self.system, &self.final_radii, self.progress.scale);
                    }
                    Change::Shape => self.stretch(step),
                }
                self.system.step();
                let time_left = time_left - self.system.model.substep;
                self.progress.phase = if time_left > 0.0 {
                    Phase::Ramping { what, time_left, step }
                } else {
                    Phase::Resting(Settling::default())
                };
                self.progress.record.count("ramping", 1);
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

    /// Lets the grown grains rest. Without friction they are decompressed slightly first: under the
    /// full pressure they would creep for a long time.
    fn begin(&mut self) {
        self.progress.phase = Phase::Resting(Settling::default());
        if friction(&self.scene, self.case) == 0.0 {
            let overlap = grow::mean_overlap(&self.system);
            let shrinks = -self.scene.compression.share * overlap;
            self.ramp(Change::Sizes, shrinks, self.progress.growth.pressure);
        }
    }

    /// Records a state at rest and starts the next change.
    fn check_rest(&mut self, mut settling: Settling) {
        let residuals = settling.residuals(&self.system);
        self.progress.phase = Phase::Resting(settling);
        let compression = self.scene.compression.clone();
        let is_smooth = friction(&self.scene, self.case) == 0.0;
        let System { model, state, scratch, .. } = &self.system;
        let pressure = normal_pressure(state, scratch, self.volume);
        if !is_smooth && pressure < LOOSE * compression.pressure_first {
            // Growth ended in motion; at rest the grains do not hold each other yet.
            let more = compression.share * self.first_overlap();
            return self.ramp(Change::Sizes, more, Real::INFINITY);
        }
        let n_max = compression.rest_time_max / model.substep;
        if !residuals.is_rest() && !build::is_over(settling.n_done, n_max) {
            return;
        }
        let rest = self.record_row(&residuals);
        if let Some(probe) = self.progress.probe.take() {
            self.end_probe(probe, &rest);
        }
        let RestState { pressure, overlap, .. } = rest;
        if self.progress.probe.is_some() {
            return;
        }
        let next = next_pressure(&self.scene, self.case, self.progress.n_probed);
        let Some(next) = next else { return self.finish() };
        if is_smooth && pressure > compression.pressure_low {
            self.ramp(Change::Sizes, -compression.share * overlap, pressure);
        } else if !is_smooth && pressure < REACHED * next {
            // By Hertz' law the next pressure needs this additional share of the overlap.
            let share = compression.share.min((next / pressure).powf(2.0 / 3.0) - 1.0);
            self.ramp(Change::Sizes, share * overlap.max(self.first_overlap()), pressure);
        } else if self.case == Case::Moduli {
            self.start_probe(&rest);
        } else {
            self.finish();
        }
    }

    /// Makes the box longer along x and narrower along y, and moves all grains with it. Friction
    /// springs, which integrate velocities, are updated for this motion.
    fn stretch(&mut self, step: Real) {
        let by = 1.0 + step / self.progress.stretch;
        let System { model, state, scratch, .. } = &mut self.system;
        let before = period(self.volume, self.progress.stretch);
        let springs = state.springs.pairs.iter_mut().zip(&state.pair_ids);
        for ((spring, [i, j]), flags) in springs.zip(&scratch.pair_flags) {
            if flags.touches() {
                let [first, second] = [i, j].map(|&it| state.grains.positions[it as usize]);
                let branch = closest_image(first - second, &before);
                let moved = Vec3::new(branch.x * (by - 1.0), branch.y * (by.recip() - 1.0), 0.0);
                let normal = branch.normalize();
                *spring += moved - normal * normal.dot(&moved);
            }
        }
        for position in &mut state.grains.positions {
            position.x *= by;
            position.y /= by;
        }
        self.progress.stretch += step;
        model.period = Some(period(self.volume, self.progress.stretch));
    }

    /// Estimated mean overlap over diameter at the first pressure, within a factor of two.
    fn first_overlap(&self) -> Real {
        let stiffness = self.system.model.grain_law.modulus;
        (self.scene.compression.pressure_first / stiffness).powf(2.0 / 3.0)
    }

    /// Starts a ramp: all grains, which are under `pressure` (Pa), or the box grow by the share
    /// `growth`.
    pub(super) fn ramp(&mut self, what: Change, growth: Real, pressure: Real) {
        let (compression, grains) = (&self.scene.compression, &self.scene.grains);
        let rate = growth / compression.ramp_time;
        let diameter = 2.0 * grains.radius_mean();
        let number = rest::inertial_number(rate, diameter, grains.material.density, pressure);
        let largest = &mut self.progress.record.validity.inertial_number_max;
        *largest = largest.max(number);
        let n = (compression.ramp_time / compression.substep).ceil();
        let from = match what {
            Change::Sizes => self.progress.scale,
            Change::Shape => self.progress.stretch,
        };
        let (step, time_left) = (from * growth / n, compression.ramp_time);
        self.progress.phase = Phase::Ramping { what, time_left, step };
    }

    /// Records a row.
    fn record_row(&mut self, residuals: &Residuals) -> RestState {
        let System { model, state, scratch, .. } = &self.system;
        let sigma = stress::contact_stress(model, state, scratch, self.volume);
        let pressure = sigma.trace() / 3.0;
        let is_smooth = model.grain_law.friction == 0.0;
        let n_needed = if is_smooth { NEEDED_SMOOTH } else { NEEDED_ROUGH };
        let coordination = coordination(state, scratch, n_needed);
        let packing = packing(state, scratch);
        let overlap = grow::mean_overlap(&self.system);
        let overlap_max = packing.overlap_max / (2.0 * self.progress.scale * model.radius_mean);
        let rest = RestState {
            pressure,
            difference: sigma[(0, 0)] - sigma[(1, 1)],
            overlap,
            solid_fraction: grain_volume(state) / self.volume,
            coordination: coordination.mean,
        };
        let row = [
            rest.solid_fraction,
            pressure,
            coordination.mean,
            coordination.backbone,
            coordination.rattler_share,
            packing.sliding_fraction,
            overlap,
            overlap_max,
            residuals.unbalanced,
            residuals.kinetic,
        ];
        let record = &mut self.progress.record;
        record.push_row(&row);
        let validity = &mut record.validity;
        validity.overlap_over_diameter_max = validity.overlap_over_diameter_max.max(overlap_max);
        validity.unbalanced_force = validity.unbalanced_force.max(residuals.unbalanced);
        let anisotropy = (sigma - nalgebra::Matrix3::identity() * pressure).norm() / pressure;
        record.set("stress_anisotropy", anisotropy, "1");
        rest
    }

    /// Records what is only measured in the last state.
    fn finish(&mut self) {
        let System { model, state, .. } = &self.system;
        let Some(period) = model.period else { return };
        let radii = &state.grains.radii;
        let mean = radii.iter().sum::<Real>() / real(radii.len());
        let bins = Bins { width: BIN * 2.0 * mean, n_bins: N_BINS };
        let region = Region::Periodic(period);
        let g = structure::radial_distribution(&state.grains.positions, &region, &bins);
        let cut = structure::cut_distribution(
            &state.grains.positions,
            &state.grains.radii,
            &region,
            &bins,
        );
        let middles = (0..N_BINS).map(|k| bins.center(k) / (2.0 * mean)).collect();
        let column =
            |name: &str, values| Column { name: name.to_owned(), unit: "1".to_owned(), values };
        let table =
            vec![column("distance_over_diameter", middles), column("g", g), column("eq42", cut)];
        let spread = (radii.iter().map(|r| (r / mean - 1.0).powi(2)).sum::<Real>()
            / real(radii.len()))
        .sqrt();
        let digest = saved_run::digest(state);
        let record = &mut self.progress.record;
        record.tables.insert("structure".to_owned(), table);
        record.set("radius_spread", spread, "1");
        record.digest = digest;
        self.progress.phase = Phase::Done;
    }

    /// Estimated share of the work that is done.
    fn share(&self) -> Real {
        let compression = &self.scene.compression;
        let (from, to) = if friction(&self.scene, self.case) == 0.0 {
            (compression.pressure_high, compression.pressure_low)
        } else {
            let last = match self.case {
                Case::Moduli => *self.scene.moduli.pressures.last().unwrap_or(&Real::NAN),
                _ => compression.pressure_last,
            };
            (compression.pressure_first, last)
        };
        let pressures = self.progress.record.column("pressure").unwrap_or_default();
        match (self.progress.phase, pressures.last()) {
            (Phase::Done, _) => 1.0,
            (_, Some(now)) => 0.5 + 0.5 * ((now / from).ln() / (to / from).ln()).clamp(0.0, 0.99),
            (_, None) => 0.5 * self.progress.scale.powi(3).min(0.99),
        }
    }
}

/// Friction of `case`.
fn friction(scene: &PackingScene, case: Case) -> Real {
    match case {
        Case::Mono { friction } => friction,
        Case::Poly => 0.0,
        Case::Moduli => scene.moduli.friction,
        Case::Confined => scene.confined.friction,
    }
}

/// Pressure at which compression with friction rests next, after moduli have been measured
/// `n_probed` times (Pa); `None` at the end.
fn next_pressure(scene: &PackingScene, case: Case, n_probed: usize) -> Option<Real> {
    match case {
        Case::Moduli => scene.moduli.pressures.get(n_probed).copied(),
        _ => Some(scene.compression.pressure_last),
    }
}

/// A cube of `volume` (m³) that is longer along x by the factor `stretch`, and shorter along y.
fn period(volume: Real, stretch: Real) -> Vec3 {
    volume.cbrt() * Vec3::new(stretch, stretch.recip(), 1.0)
}

/// Growth with the friction of the case.
fn recipe(scene: &PackingScene, model: &Model, volume: Real, friction: Real) -> Recipe {
    let compression = &scene.compression;
    let stop = if friction == 0.0 { compression.pressure_high } else { compression.pressure_first };
    let radius = scene.grains.radius_mean();
    let mass = scene.grains.material.density * sphere_volume(radius);
    // All cases grow at the rate of the lower pressure, so that they share one protocol.
    let slow = Recipe::new(model, volume, compression.pressure_first, mass, radius);
    Recipe { laws: Laws::of(model), pressure_stop: stop, stuck: STUCK, scale_last: 2.0, ..slow }
}

impl Run for BoxRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let phase = match self.progress.phase {
            Phase::Growing => "growing",
            Phase::Ramping { .. } | Phase::Resting(_) | Phase::Done => "resting",
        };
        for _ in 0..SLICE {
            self.step();
        }
        self.system.check(self.progress.record.n_substeps.values().sum())?;
        let is_done = self.progress.phase == Phase::Done;
        Ok(Progress { phase, share: self.share(), is_done })
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
        model.period = Some(period(self.volume, progress.stretch));
        let controls = self.system.controls.clone();
        let friction = friction(&self.scene, self.case);
        let recipe = recipe(&self.scene, &model, self.volume, friction);
        self.growth = Growth::resumed(recipe, self.final_radii.clone(), progress.growth);
        self.system = System::new(model, controls, state);
        self.progress = progress;
        Ok(())
    }

    fn record(&self) -> Record {
        self.progress.record.clone()
    }
}
