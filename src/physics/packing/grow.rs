//! Growth of all grains by a common factor, until they are as large as wanted or nothing gives way.
//!
//! ```text
//! R_i = s R_i,final,   d(ln s)/dt = g · clamp(1 − p/p_stop, −1, 1),   g ≤ 0.05 / √(m/(p_stop d))
//!
//! s       common factor
//! p       pressure of the normal forces in the room           (Pa)
//! p_stop  pressure at which nothing more fits                 (Pa)
//! m, d    mean final mass and diameter of a grain             (kg), (m)
//! ```
//!
//! Source: Lubachevsky & Stillinger (1990) with soft grains, as Götz (2024), section 3.3.1, takes it:
//! the ranges of radii are the final ones, and where no size is asked for, growth ends when "the
//! granulate cannot expand any more". The source gives neither rate nor pressure; g lets grains get
//! out of each other's way (a twentieth of a radius in the time in which p_stop moves a grain by its
//! diameter), and near p_stop the growth only follows the rearrangements.
//!
//! Grains have their final masses from the start: growing them keeps momentum, and no contact is
//! faster than those at the end, so one substep suits all. The laws are the caller's: without
//! friction (`Laws::smooth`) as a rule, and softer than the real ones where those ask for very short
//! substeps. The model's own laws are put back at the end. If they are stiffer, the grains then shrink
//! by what the overlaps are too deep (Hertz: (E_soft/E)^(2/3) of each), so that nothing springs apart.

use serde::{Deserialize, Serialize};

use super::pressure::normal_pressure;
use crate::{
    base::{
        Real,
        real::{real, real_of},
    },
    physics::{Model, System, law::PairLaw, neighbours::update_pair_masses},
};

/// Growth per relaxation time √(m/(p d)).
const GROWTH_PER_RELAXATION: Real = 0.05;
/// Length of a window in which growth is judged, in relaxation times.
const WINDOW: Real = 10.0;
/// Growth of ln s in a window below which nothing gives way any more, as a rule.
const STUCK: Real = 2e-4;
/// Share of p_stop that grains at their last size may still exert when they are let go.
const CALM: Real = 0.01;
/// Windows for which grains at their last size are given time to get calm.
const N_CALM_WINDOWS: u32 = 3;

/// The contact laws that hold while grains grow.
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
    /// Those of `model`; without walls theirs are those of the grains.
    pub fn of(model: &Model) -> Self {
        Self {
            grains: model.grain_law,
            walls: model.walls.first().map_or(model.grain_law, |wall| wall.law),
            membrane: model.membrane_law,
            substep: model.substep,
        }
    }

    /// The same without friction.
    #[must_use]
    pub fn smooth(mut self) -> Self {
        for law in [&mut self.grains, &mut self.walls, &mut self.membrane] {
            law.friction = 0.0;
        }
        self
    }
}

/// How grains grow.
#[derive(Clone, Copy, Debug)]
pub struct Recipe {
    /// The laws while they grow.
    pub laws: Laws,
    /// Volume of the room, by which forces become a pressure (m³).
    pub volume: Real,
    /// Pressure at which nothing more fits, p_stop (Pa).
    pub pressure_stop: Real,
    /// Growth rate g far from p_stop (1/s).
    pub rate: Real,
    /// Growth of ln s in ten relaxation times below which nothing gives way any more.
    pub stuck: Real,
    /// Common factor at which growth ends: 1 for the final radii, more for as large as fits.
    pub scale_last: Real,
}

impl Recipe {
    /// Growth at the advised rate up to the final radii, with the laws of `model` without friction;
    /// `mass` (kg) and `radius` (m) are those of a mean grain at the end.
    pub fn new(model: &Model, volume: Real, pressure_stop: Real, mass: Real, radius: Real) -> Self {
        let relaxation = (mass / (pressure_stop * 2.0 * radius)).sqrt();
        Self {
            laws: Laws::of(model).smooth(),
            volume,
            pressure_stop,
            rate: GROWTH_PER_RELAXATION / relaxation,
            stuck: STUCK,
            scale_last: 1.0,
        }
    }
}

/// What a substep of growth came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Grown {
    /// Goes on.
    Growing,
    /// The last size is reached.
    Full,
    /// The pressure is reached and nothing gives way any more.
    Jammed,
}

/// Progress of growth. With the `State` it is all that growth resumes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Common factor s.
    pub scale: Real,
    /// Pressure in the last substep (Pa).
    pub pressure: Real,
    /// Substeps so far.
    pub n_substeps: u64,
    /// Whether it is over, and why.
    pub grown: Grown,
    /// Substeps in the present window.
    n_in_window: u64,
    /// Common factor at the begin of the window.
    window_scale: Real,
    /// Sum of the pressures in the window (Pa).
    window_pressure: Real,
    /// Windows spent at the last size.
    n_at_last: u32,
}

/// Grains that grow in a `System`; only this may step it meanwhile.
#[derive(Clone, Debug)]
pub struct Growth {
    recipe: Recipe,
    final_radii: Vec<Real>,
    progress: Progress,
    /// The model's own laws while those of the recipe hold.
    kept: Option<Kept>,
}

#[derive(Clone, Debug)]
struct Kept {
    laws: Laws,
    walls: Vec<PairLaw>,
}

impl Growth {
    /// Growth of the grains to `final_radii` (m), which are now `scale` times as large.
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

    /// Resumes growth at `progress` with the `State` that belongs to it.
    pub fn resumed(recipe: Recipe, final_radii: Vec<Real>, progress: Progress) -> Self {
        // Nothing is known about lists: the first substep builds them.
        Self { recipe, final_radii, progress, kept: None }
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        self.progress
    }

    /// One substep; the model's own laws are restored once the result is not `Growing`.
    pub fn step(&mut self, system: &mut System) -> Grown {
        if self.progress.grown != Grown::Growing {
            return self.progress.grown;
        }
        self.enter(system);
        let dt = self.recipe.laws.substep;
        let push = 1.0 - self.progress.pressure / self.recipe.pressure_stop;
        let grown = self.progress.scale * (self.recipe.rate * dt * push.clamp(-1.0, 1.0)).exp();
        self.resize(system, grown.min(self.recipe.scale_last));
        system.step();
        let pressure = normal_pressure(&system.state, &system.scratch, self.recipe.volume);
        self.progress.pressure = pressure;
        self.progress.n_substeps += 1;
        self.judge();
        if self.progress.grown != Grown::Growing {
            self.leave(system);
        }
        self.progress.grown
    }

    /// Puts the laws of the recipe in place of the model's own.
    fn enter(&mut self, system: &mut System) {
        if self.kept.is_some() {
            return;
        }
        let model = &mut system.model;
        let walls = model.walls.iter().map(|wall| wall.law).collect();
        self.kept = Some(Kept { laws: Laws::of(model), walls });
        let laws = &self.recipe.laws;
        model.grain_law = laws.grains;
        model.membrane_law = laws.membrane;
        model.substep = laws.substep;
        model.walls.iter_mut().for_each(|wall| wall.law = laws.walls);
    }

    /// Puts the model's own laws back.
    fn leave(&mut self, system: &mut System) {
        let Some(Kept { laws, walls }) = self.kept.take() else { return };
        let model = &mut system.model;
        model.grain_law = laws.grains;
        model.membrane_law = laws.membrane;
        model.substep = laws.substep;
        for (wall, law) in model.walls.iter_mut().zip(walls) {
            wall.law = law;
        }
        let softness = self.recipe.laws.grains.modulus / laws.grains.modulus;
        if softness < 1.0 {
            let too_deep = mean_overlap(system) * (1.0 - softness.powf(2.0 / 3.0));
            self.resize(system, self.progress.scale * (1.0 - too_deep));
        }
    }

    /// Makes all grains `scale` times their final size.
    fn resize(&mut self, system: &mut System, scale: Real) {
        self.progress.scale = scale;
        resize(system, &self.final_radii, scale);
    }

    /// Looks at the window when it is over.
    fn judge(&mut self) {
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
            if pressure < CALM * pressure_stop || it.n_at_last >= N_CALM_WINDOWS {
                it.grown = Grown::Full;
            }
        } else if grown < stuck && pressure > 0.5 * pressure_stop {
            it.grown = Grown::Jammed;
        }
        (it.n_in_window, it.window_scale, it.window_pressure) = (0, it.scale, 0.0);
    }
}

/// Makes all grains of `system` `scale` times as large as `final_radii` (m).
pub fn resize(system: &mut System, final_radii: &[Real], scale: Real) {
    let System { model, state, scratch, .. } = system;
    for (radius, last) in state.grains.radii.iter_mut().zip(final_radii) {
        *radius = scale * last;
        model.radius_max = model.radius_max.max(*radius);
    }
    // The lists of neighbours stay complete only until a grain has grown too far.
    update_pair_masses(state, &mut scratch.neighbours);
}

/// Mean overlap of touching grains over their distance at first touch.
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

    /// Grains of about 2 mm radius in a box of planes with `edge`.
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
        let places = scatter(&small, None, &mut random, |it| room.place(2.1e-3, it)).unwrap();
        let masses: Vec<Real> = final_radii.iter().map(|&r| 2000.0 * sphere_volume(r)).collect();
        let first_mass = masses[0];
        let mut builder = SystemBuilder::new(law);
        builder.substep(5e-6).radii_up_to(2.1e-3, 2e-3).walls(Wall::sides(low, high));
        builder.grains(Grains::at_rest(places, small, masses));
        let system = builder.build().unwrap();
        let mut recipe = Recipe::new(&system.model, room.volume(), 500.0, first_mass, 2e-3);
        recipe.laws.grains.modulus = PairLaw::between(&soft, &soft, surface).modulus;
        (system, recipe, final_radii, scale)
    }

    /// Oracle: what is asked for. 60 grains of 2 mm fill a quarter of the box, so they fit.
    #[test]
    fn grains_that_fit_get_their_final_radii_and_the_laws_come_back() {
        let (mut system, recipe, radii, scale) = boxed(60, 1.0);
        let mut growth = Growth::new(recipe, radii.clone(), scale);
        while growth.step(&mut system) == Grown::Growing {
            assert_eq!(system.model.grain_law.friction.to_bits(), 0, "smooth while growing");
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

    /// Oracle: in a box only five diameters wide smooth grains jam below the 0.64 of a large one, and
    /// above the simple cubic lattice that any box holds, π/6; the stop pressure itself; the bits of a
    /// run that was not broken off.
    #[test]
    fn grains_grow_until_they_jam_and_a_break_costs_no_bit() {
        let (mut system, mut recipe, radii, scale) = boxed(160, 0.1);
        recipe.scale_last = 2.0;
        let mut growth = Growth::new(recipe, radii.clone(), scale);
        let mut again = None;
        while growth.step(&mut system) == Grown::Growing {
            if growth.progress().n_substeps == 5000 {
                again = Some((system.state.clone(), growth.progress()));
            }
        }
        let jammed = growth.progress();
        let grains = system.state.grains.radii.iter();
        let solid = grains.map(|&r| sphere_volume(r)).sum::<Real>() / EDGE.powi(3);
        assert_eq!(jammed.grown, Grown::Jammed);
        assert!((std::f64::consts::FRAC_PI_6..0.63).contains(&solid), "{solid}");
        assert!((jammed.pressure / 500.0 - 1.0).abs() < 0.2, "{}", jammed.pressure);
        let (state, progress) = again.expect("it takes longer than 5000 substeps");
        let mut other = System::new(system.model.clone(), system.controls.clone(), state);
        let mut growth = Growth::resumed(recipe, radii, progress);
        while growth.step(&mut other) == Grown::Growing {}
        assert_eq!(growth.progress(), jammed);
        assert_eq!(other.state.grains.positions, system.state.grains.positions);
    }
}
