//! Grows all grains by a common factor until they have their final size or jam.
//!
//! ```text
//! R_i = s R_i,final,   d(ln s)/dt = g · clamp(1 − p/p_stop, −1, 1),   g ≤ 0.05 / √(m/(p_stop d))
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | s | common factor | – |
//! | g | growth rate far from p_stop | 1/s |
//! | p | pressure of the normal forces in the container | Pa |
//! | p_stop | pressure at which the packing counts as jammed | Pa |
//! | m, d | mean final mass and diameter of a grain | kg, m |
//!
//! Source: Lubachevsky & Stillinger (1990) with soft grains, as applied by Götz (2024), section 3.3.1: the
//! ranges of radii are the final ones, and without a given final size growth ends when "the granulate
//! cannot expand any more". The source specifies neither rate nor pressure. Here g is slow enough for grains
//! to move out of each other's way (a twentieth of a radius in the time in which p_stop moves a grain by its
//! diameter), and near p_stop the growth only follows rearrangements.
//!
//! Valid for contact laws whose overlaps at p_stop are small. Grains have their final masses from the start:
//! growth conserves momentum, and no contact is faster than at the end, so one substep suits all sizes.
//!
//! The caller chooses the laws during growth: usually without friction (`Laws::smooth`), and softer than the
//! real ones if those require very short substeps. The laws of the model are restored at the end. If they are
//! stiffer, the grains then shrink by the excess of the mean overlap (Hertz: overlaps scale with
//! (E_soft/E)^(2/3)), so that the packing does not expand explosively.

use serde::{Deserialize, Serialize};

use super::pressure::normal_pressure;
use crate::{
    base::{
        Real,
        real::{real, real_of},
    },
    physics::{Model, System, law::PairLaw, neighbors::update_pair_masses},
};

/// Growth per relaxation time √(m/(p d)).
const GROWTH_PER_RELAXATION: Real = 0.05;
/// Length of the windows at whose ends growth is evaluated, in relaxation times.
const WINDOW: Real = 10.0;
/// Default growth of ln s in a window below which the packing is jammed.
const GROWTH_MIN: Real = 2e-4;
/// Growth to the final size is complete when the pressure is below this fraction of p_stop.
const RELAXED: Real = 0.01;
/// Largest number of windows at the final size to wait for that.
const N_RELAXATION_WINDOWS: u32 = 3;

/// The contact laws during growth.
#[derive(Clone, Copy, Debug)]
pub struct Laws {
    /// Between grains.
    pub grains: PairLaw,
    /// Between grains and every wall.
    pub walls: PairLaw,
    /// Between grains and membrane.
    pub membrane: PairLaw,
    /// Length of a substep (s).
    pub substep: Real,
}

impl Laws {
    /// The laws of `model`. Without walls, their law is that of the grains.
    pub fn of(model: &Model) -> Self {
        Self {
            grains: model.grain_law,
            walls: model.walls.first().map_or(model.grain_law, |wall| wall.law),
            membrane: model.membrane_law,
            substep: model.substep,
        }
    }

    /// The same laws without friction.
    #[must_use]
    pub fn smooth(mut self) -> Self {
        for law in [&mut self.grains, &mut self.walls, &mut self.membrane] {
            law.friction = 0.0;
        }
        self
    }
}

/// Parameters of growth.
#[derive(Clone, Copy, Debug)]
pub struct Recipe {
    /// The laws during growth.
    pub laws: Laws,
    /// Volume of the container (m³), for the pressure.
    pub volume: Real,
    /// Pressure p_stop at which the packing counts as jammed (Pa).
    pub pressure_stop: Real,
    /// Growth rate g far from p_stop (1/s).
    pub rate: Real,
    /// Growth of ln s in ten relaxation times below which the packing is jammed.
    pub stuck: Real,
    /// Common factor at which growth ends: 1 for the final radii; larger to grow until the packing jams.
    pub scale_last: Real,
}

impl Recipe {
    /// Growth up to the final radii at the largest advisable rate, with the laws of `model` without friction.
    /// `mass` (kg) and `radius` (m) are those of a mean grain at its final size.
    pub fn new(model: &Model, volume: Real, pressure_stop: Real, mass: Real, radius: Real) -> Self {
        let relaxation = (mass / (pressure_stop * 2.0 * radius)).sqrt();
        Self {
            laws: Laws::of(model).smooth(),
            volume,
            pressure_stop,
            rate: GROWTH_PER_RELAXATION / relaxation,
            stuck: GROWTH_MIN,
            scale_last: 1.0,
        }
    }
}

/// Status of growth after a substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Grown {
    /// Growth continues.
    Growing,
    /// The final size is reached.
    Full,
    /// The pressure is reached, and the grains hardly grow any more.
    Jammed,
}

/// Progress of growth: with the `State`, everything needed to resume it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Common factor s.
    pub scale: Real,
    /// Pressure after the last substep (Pa).
    pub pressure: Real,
    /// Substeps so far.
    pub n_substeps: u64,
    /// Whether growth has ended, and why.
    pub grown: Grown,
    /// Substeps in the current window.
    n_in_window: u64,
    /// Common factor at the start of the window.
    window_scale: Real,
    /// Sum of the pressures in the window (Pa).
    window_pressure: Real,
    /// Number of windows at the final size.
    n_at_last: u32,
}

/// Grains growing in a `System`. Until growth ends, only `Growth::step` may step the system.
#[derive(Clone, Debug)]
pub struct Growth {
    recipe: Recipe,
    final_radii: Vec<Real>,
    progress: Progress,
    /// The laws of the model, while those of the recipe replace them.
    saved_laws: Option<SavedLaws>,
}

#[derive(Clone, Debug)]
struct SavedLaws {
    laws: Laws,
    walls: Vec<PairLaw>,
}

impl Growth {
    /// Starts growth to `final_radii` (m) of grains whose radii are now `scale` times the final ones.
    pub fn new(recipe: Recipe, final_radii: Vec<Real>, scale: Real) -> Self {
        let progress = Progress {
            scale,
            pressure: 0.0,
            n_substeps: 0,
            grown: Grown::Growing,
            n_in_window: 0,
            window_scale: scale,
            window_pressure: 0.0,
            n_at_last: 0,
        };
        Self::resumed(recipe, final_radii, progress)
    }

    /// Resumes growth at `progress`, with the `State` of the same substep.
    pub fn resumed(recipe: Recipe, final_radii: Vec<Real>, progress: Progress) -> Self {
        Self { recipe, final_radii, progress, saved_laws: None }
    }

    /// The progress, with which growth can be resumed.
    pub fn progress(&self) -> Progress {
        self.progress
    }

    /// Advances by one substep. The laws of the model are restored when the result is not `Growing`.
    pub fn step(&mut self, system: &mut System) -> Grown {
        if self.progress.grown != Grown::Growing {
            return self.progress.grown;
        }
        self.replace_laws(system);
        let dt = self.recipe.laws.substep;
        let push = 1.0 - self.progress.pressure / self.recipe.pressure_stop;
        let grown = self.progress.scale * (self.recipe.rate * dt * push.clamp(-1.0, 1.0)).exp();
        self.resize(system, grown.min(self.recipe.scale_last));
        system.step();
        let pressure = normal_pressure(&system.state, &system.scratch, self.recipe.volume);
        self.progress.pressure = pressure;
        self.progress.n_substeps += 1;
        self.update_status();
        if self.progress.grown != Grown::Growing {
            self.restore_laws(system);
        }
        self.progress.grown
    }

    /// Replaces the laws of the model by those of the recipe.
    fn replace_laws(&mut self, system: &mut System) {
        if self.saved_laws.is_some() {
            return;
        }
        let model = &mut system.model;
        let walls = model.walls.iter().map(|wall| wall.law).collect();
        self.saved_laws = Some(SavedLaws { laws: Laws::of(model), walls });
        let laws = &self.recipe.laws;
        model.grain_law = laws.grains;
        model.membrane_law = laws.membrane;
        model.substep = laws.substep;
        model.walls.iter_mut().for_each(|wall| wall.law = laws.walls);
    }

    /// Restores the laws of the model.
    fn restore_laws(&mut self, system: &mut System) {
        let Some(SavedLaws { laws, walls }) = self.saved_laws.take() else { return };
        let model = &mut system.model;
        model.grain_law = laws.grains;
        model.membrane_law = laws.membrane;
        model.substep = laws.substep;
        for (wall, law) in model.walls.iter_mut().zip(walls) {
            wall.law = law;
        }
        let softness = self.recipe.laws.grains.modulus / laws.grains.modulus;
        if softness < 1.0 {
            let excess = mean_overlap(system) * (1.0 - softness.powf(2.0 / 3.0));
            self.resize(system, self.progress.scale * (1.0 - excess));
        }
    }

    /// Sets all radii to `scale` times the final ones.
    fn resize(&mut self, system: &mut System, scale: Real) {
        self.progress.scale = scale;
        resize(system, &self.final_radii, scale);
    }

    /// Updates the status at the end of a window.
    fn update_status(&mut self) {
        let Recipe { rate, pressure_stop, stuck, scale_last, laws, .. } = self.recipe;
        let window = WINDOW * GROWTH_PER_RELAXATION / rate;
        let it = &mut self.progress;
        it.n_in_window += 1;
        it.window_pressure += it.pressure;
        if real_of(it.n_in_window) * laws.substep < window {
            return;
        }
        let pressure = it.window_pressure / real_of(it.n_in_window);
        let grown = (it.scale / it.window_scale).ln();
        if it.scale >= scale_last {
            it.n_at_last += 1;
            if pressure < RELAXED * pressure_stop || it.n_at_last >= N_RELAXATION_WINDOWS {
                it.grown = Grown::Full;
            }
        } else if grown < stuck && pressure > 0.5 * pressure_stop {
            it.grown = Grown::Jammed;
        }
        (it.n_in_window, it.window_scale, it.window_pressure) = (0, it.scale, 0.0);
    }
}

/// Sets all radii of `system` to `scale` times `final_radii` (m).
pub fn resize(system: &mut System, final_radii: &[Real], scale: Real) {
    let System { model, state, scratch, .. } = system;
    for (radius, last) in state.grains.radii.iter_mut().zip(final_radii) {
        *radius = scale * last;
        model.radius_max = model.radius_max.max(*radius);
    }
    // This also records how much of the skin of the neighbor lists the growth has used.
    update_pair_masses(state, &mut scratch.neighbors);
}

/// Mean overlap of touching pairs, divided by the sum of their radii.
pub fn mean_overlap(system: &System) -> Real {
    let radii = &system.state.grains.radii;
    let (mut sum, mut n_contacts) = (0.0, 0);
    for (pair, [i, j]) in system.scratch.touching_pairs(&system.state) {
        sum += pair.overlap / (radii[*i as usize] + radii[*j as usize]);
        n_contacts += 1;
    }
    sum / real(n_contacts.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        base::{
            Vec3,
            random::{Random, Stream},
        },
        physics::{
            SystemBuilder,
            builder::Wall,
            law::Surface,
            packing::{Room, first_scale, scatter, sphere_volume},
            state::Grains,
        },
        scene::Material,
    };

    const EDGE: Real = 20e-3;

    /// Grains of about 2 mm radius in a box of planes.
    fn boxed(n_grains: usize, softness: Real) -> (System, Recipe, Vec<Real>, Real) {
        let stiff = Material { youngs_modulus: 1e8, poisson_ratio: 0.245, density: 2000.0 };
        let soft = Material { youngs_modulus: softness * 1e8, ..stiff };
        let surface = Surface { friction: 0.3, dissipation_time: 2e-5, tangential_damping: 0.3 };
        let law = PairLaw::between(&stiff, &stiff, surface);
        let mut random = Random::new(11, Stream::Radius);
        let final_radii: Vec<Real> =
            (0..n_grains).map(|_| random.between(1.9e-3, 2.1e-3)).collect();
        let (low, high) = (Vec3::zeros(), Vec3::repeat(EDGE));
        let room = Room::Box { low, high };
        let scale = first_scale(&final_radii, 0.15, room.volume());
        let small: Vec<Real> = final_radii.iter().map(|r| scale * r).collect();
        let mut random = Random::new(11, Stream::Position);
        let positions = scatter(&small, None, &mut random, |it| room.place(2.1e-3, it)).unwrap();
        let masses: Vec<Real> = final_radii.iter().map(|&r| 2000.0 * sphere_volume(r)).collect();
        let first_mass = masses[0];
        let mut builder = SystemBuilder::new(law);
        builder.substep(5e-6).radii_up_to(2.1e-3, 2e-3).walls(Wall::sides(low, high));
        builder.grains(Grains::at_rest(positions, small, masses));
        let system = builder.build().unwrap();
        let mut recipe = Recipe::new(&system.model, room.volume(), 500.0, first_mass, 2e-3);
        recipe.laws.grains.modulus = PairLaw::between(&soft, &soft, surface).modulus;
        (system, recipe, final_radii, scale)
    }

    /// Oracle: the final radii; 60 grains of 2 mm fill a quarter of the box, so they fit.
    #[test]
    fn grains_that_fit_reach_their_final_radii_and_the_laws_are_restored() {
        let (mut system, recipe, radii, scale) = boxed(60, 1.0);
        let mut growth = Growth::new(recipe, radii.clone(), scale);
        while growth.step(&mut system) == Grown::Growing {
            assert_eq!(
                system.model.grain_law.friction.to_bits(),
                0,
                "there is friction during growth"
            );
        }
        assert_eq!(growth.progress().grown, Grown::Full);
        assert_eq!(system.state.grains.radii, radii);
        let walls = system.model.walls.iter().map(|wall| wall.law.friction);
        assert!(
            walls
                .chain([system.model.grain_law.friction])
                .all(|it| it.to_bits() == 0.3_f64.to_bits())
        );
    }

    /// Oracle: in a box only five diameters wide, smooth grains jam below the solid fraction of 0.64 of large
    /// systems and above that of a simple cubic lattice, π/6; the stop pressure; the bits of an
    /// uninterrupted run.
    #[test]
    fn grains_grow_until_they_jam_and_resuming_changes_no_bit() {
        let (mut system, mut recipe, radii, scale) = boxed(160, 0.1);
        recipe.scale_last = 2.0;
        let mut growth = Growth::new(recipe, radii.clone(), scale);
        let mut saved = None;
        while growth.step(&mut system) == Grown::Growing {
            if growth.progress().n_substeps == 5000 {
                saved = Some((system.state.clone(), growth.progress()));
            }
        }
        let jammed = growth.progress();
        let grains = system.state.grains.radii.iter();
        let solid = grains.map(|&r| sphere_volume(r)).sum::<Real>() / EDGE.powi(3);
        assert_eq!(jammed.grown, Grown::Jammed);
        assert!((std::f64::consts::FRAC_PI_6..0.63).contains(&solid), "{solid}");
        assert!((jammed.pressure / 500.0 - 1.0).abs() < 0.2, "{}", jammed.pressure);
        let (state, progress) = saved.expect("growth takes longer than 5000 substeps");
        let mut resumed = System::new(system.model.clone(), system.controls.clone(), state);
        let mut growth = Growth::resumed(recipe, radii, progress);
        while growth.step(&mut resumed) == Grown::Growing {}
        assert_eq!(growth.progress(), jammed);
        assert_eq!(resumed.state.grains.positions, system.state.grains.positions);
    }
}
