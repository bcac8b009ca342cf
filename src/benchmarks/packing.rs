//! Grains in a box of six walls, a case that other codes can run too: frictional Hertz–Mindlin
//! spheres, E = 100 MPa, ν = 0.25, μ = 0.5, ρ = 2500 kg/m³, R = 1.8–2.2 mm, grown under 50 kPa.
//!
//! Large boxes are assembled from mirrored copies of a small one. A grain that touches a smooth
//! wall with overlap ξ meets its own mirror image, of half the effective modulus and radius, with 2
//! ξ: the force is the same, 4/3 E*/2 √(R/2 · 2ξ) 2ξ = 4/3 E* √(R ξ) ξ. So the copies support each
//! other like the walls did, and only weight and friction have to settle.

use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
    },
    physics::{
        System, SystemBuilder,
        builder::Wall,
        law::Surface,
        neighbors::update_pair_masses,
        packing::{
            Grown, Growth, Recipe, Room, first_scale, numbering::along_curve, scatter,
            scatter::NoRoom, sphere_volume,
        },
        state::{Grains, State},
    },
    scene::Material,
};

/// The grains' material.
pub(super) const MATERIAL: Material =
    Material { youngs_modulus: 1e8, poisson_ratio: 0.25, density: 2500.0 };
/// Dissipation in the terms of other codes.
pub(super) const RESTITUTION: Real = 0.5;
/// Surface with a dissipation that gives a restitution of about one half.
pub(super) const SURFACE: Surface =
    Surface { friction: 0.5, dissipation_time: 3e-5, tangential_damping: 0.3 };
/// Smallest and largest radius (m).
const RADII: [Real; 2] = [1.8e-3, 2.2e-3];
/// Solid fraction of the box with these radii; grains end slightly above or below.
const SOLID_FRACTION: Real = 0.61;
/// Friction of growing grains: without friction they would be denser than poured grains, with their
/// own friction looser.
const GROWTH_FRICTION: Real = 0.1;
/// Pressure of the grown grains (Pa).
const PRESSURE: Real = 5e4;
/// Solid fraction of the scattered grains.
const THIN: Real = 0.25;
/// Measured substep (s), a tenth of the Rayleigh time.
pub(super) const SUBSTEP: Real = 5e-6;
/// Substep of the preparation (s).
const COARSE_SUBSTEP: Real = 1e-5;
/// Skin of the neighbor lists, as a share of the largest radius.
const SKIN_SHARE: Real = 0.25;
/// Share of the velocities that remains after a substep while grains come to rest: first for grains
/// that push each other, then for loose grains that fall on their neighbors.
const DRAG: [Real; 2] = [0.98, 0.998];
/// Substeps with each drag: for a grown box, a box of copies, and an opened box.
const N_REST: [[u64; 2]; 3] = [[1000, 3000], [200, 400], [500, 4000]];
/// Substeps of 10 us from tilting to the measured state.
const N_FLOW: u64 = 2000;
/// Height of the opened box divided by that of the closed one.
const OPENED: Real = 1.5;
/// Standard gravity (m/s²).
const GRAVITY: Real = 9.81;
/// To be increased when the preparation of a box changes.
const VERSION: u64 = 5;

/// Grains in a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boxed {
    /// Number of grains of one copy.
    pub(super) n_grains: usize,
    /// Number of copies along each axis.
    pub(super) n_tiles: [usize; 3],
    /// What the grains do.
    pub(super) phase: Phase,
}

/// What the grains do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// They lie in the closed box.
    Rest,
    /// They slide down in the opened box, tilted by 45°.
    Flow,
}

impl Boxed {
    /// Key of the state in the cache.
    pub(super) fn key(&self) -> String {
        format!("box {VERSION} {} {:?} {:?}", self.n_grains, self.n_tiles, self.phase)
    }

    /// Key of the closed box of one copy, which the others are made of.
    pub(super) fn tile_key(&self) -> String {
        self.closed_tile().key()
    }

    /// The closed box of one copy.
    pub(super) fn closed_tile(&self) -> Self {
        Self { n_tiles: [1; 3], phase: Phase::Rest, ..*self }
    }

    /// True if this is the closed box of one copy.
    pub(super) fn is_tile(&self) -> bool {
        self.n_tiles == [1; 3] && self.phase == Phase::Rest
    }

    /// Edge length of the box of one copy (m).
    fn edge(&self) -> Real {
        let solid: Real = self.final_radii().iter().map(|&r| sphere_volume(r)).sum();
        (solid / SOLID_FRACTION).cbrt()
    }

    /// Edge lengths of the box (m), which starts at the origin.
    pub(super) fn size(&self) -> Vec3 {
        let edge = self.edge();
        let lid = if self.phase == Phase::Flow { OPENED } else { 1.0 };
        let n = self.n_tiles.map(crate::base::real::real);
        Vec3::new(n[0] * edge, n[1] * edge, n[2] * edge * lid)
    }

    fn final_radii(&self) -> Vec<Real> {
        let mut random = Random::new(1, Stream::Radius);
        (0..self.n_grains).map(|_| random.between(RADII[0], RADII[1])).collect()
    }

    /// The measured system, from its saved state.
    pub(super) fn system(&self, state: State) -> System {
        let mut system = system(state.grains.clone(), &self.size());
        system.model.substep = SUBSTEP;
        system.model.gravity = self.gravity();
        system.controls.walls.clone_from(&state.walls);
        system.state = state;
        system
    }

    /// Gravity (m/s²).
    pub(super) fn gravity(&self) -> Vec3 {
        match self.phase {
            Phase::Rest => Vec3::new(0.0, 0.0, -GRAVITY),
            Phase::Flow => Vec3::new(1.0, 0.0, -1.0) * (GRAVITY * 0.5_f64.sqrt()),
        }
    }

    /// Prepares one copy at rest in its closed box.
    pub(super) fn grow(&self) -> Result<State, NoRoom> {
        let (last, size) = (self.final_radii(), self.size());
        let room = Room::Box { low: Vec3::zeros(), high: size };
        let scale = first_scale(&last, THIN, room.volume());
        let small: Vec<Real> = last.iter().map(|r| scale * r).collect();
        let mut random = Random::new(1, Stream::Position);
        let places = scatter(&small, None, &mut random, |it| room.place(RADII[1], it))?;
        let order = along_curve(&places, 2.0 * RADII[1]);
        let ordered = |radii: &[Real]| order.iter().map(|&i| radii[i]).collect::<Vec<_>>();
        let (last, small) = (ordered(&last), ordered(&small));
        let places = order.iter().map(|&i| places[i]).collect();
        let masses = masses(&last);
        let mut system = system(Grains::at_rest(places, small, masses), &size);
        let radius = 0.5 * (RADII[0] + RADII[1]);
        let mass = sphere_volume(radius) * MATERIAL.density;
        let mut recipe = Recipe::new(&system.model, room.volume(), PRESSURE, mass, radius);
        recipe.laws.grains.friction = GROWTH_FRICTION;
        recipe.scale_last = 1.2;
        let mut growth = Growth::new(recipe, last, scale);
        while growth.step(&mut system) == Grown::Growing {
            drag(&mut system, DRAG[0]);
        }
        system.state.grains.masses = masses_of(&system.state.grains);
        update_pair_masses(&system.state, &mut system.scratch.neighbors);
        come_to_rest(&mut system, N_REST[0]);
        Ok(system.state)
    }

    /// This box, made from the closed box of one copy.
    pub(super) fn of_tile(&self, tile: &State) -> State {
        let closed = Self { phase: Phase::Rest, ..*self };
        let mut state = if self.n_tiles == [1; 3] {
            tile.clone()
        } else {
            let grains = self.mirrored(&tile.grains);
            let mut system = system(grains, &closed.size());
            come_to_rest(&mut system, N_REST[1]);
            system.state
        };
        if self.phase == Phase::Flow {
            // The lid is moved up at once, and its friction springs are dropped.
            let mut system = system(state.grains.clone(), &self.size());
            system.state.pair_ids.clone_from(&state.pair_ids);
            system.state.springs.pairs.clone_from(&state.springs.pairs);
            come_to_rest(&mut system, N_REST[2]);
            system.model.gravity = self.gravity();
            (0..N_FLOW).for_each(|_| system.step());
            state = system.state;
        }
        state
    }

    /// Copies side by side, each the mirror image of its neighbors.
    fn mirrored(&self, tile: &Grains) -> Grains {
        let (edge, [nx, ny, nz]) = (self.edge(), self.n_tiles);
        let along = |k: usize, x: Real| {
            let from = crate::base::real::real(k) * edge;
            if k.is_multiple_of(2) { from + x } else { from + edge - x }
        };
        let mut positions = Vec::with_capacity(tile.len() * nx * ny * nz);
        for k in 0..nx * ny * nz {
            let (a, b, c) = (k % nx, k / nx % ny, k / (nx * ny));
            positions.extend(
                tile.positions
                    .iter()
                    .map(|p| Vec3::new(along(a, p.x), along(b, p.y), along(c, p.z))),
            );
        }
        let n = nx * ny * nz;
        Grains::at_rest(positions, tile.radii.repeat(n), tile.masses.repeat(n))
    }
}

/// Grains in the box from the origin to `size` (m), gravity downward.
fn system(grains: Grains, size: &Vec3) -> System {
    let largest = grains.radii.iter().copied().fold(RADII[1], Real::max);
    let mut builder = SystemBuilder::of_material(&MATERIAL, SURFACE);
    builder
        .gravity(Vec3::new(0.0, 0.0, -GRAVITY))
        .substep(COARSE_SUBSTEP)
        .radii_up_to(largest, 0.5 * (RADII[0] + RADII[1]))
        .skin(SKIN_SHARE * largest)
        .grains(grains)
        .walls(Wall::sides(Vec3::zeros(), *size));
    builder.build().expect("six planes and finite grains fit each other")
}

fn masses(radii: &[Real]) -> Vec<Real> {
    radii.iter().map(|&r| sphere_volume(r) * MATERIAL.density).collect()
}

fn masses_of(grains: &Grains) -> Vec<Real> {
    masses(&grains.radii)
}

fn come_to_rest(system: &mut System, n_steps: [u64; 2]) {
    for (share, n) in DRAG.into_iter().zip(n_steps) {
        for _ in 0..n {
            system.step();
            drag(system, share);
        }
    }
}

/// Reduces all velocities to a share.
fn drag(system: &mut System, share: Real) {
    let grains = &mut system.state.grains;
    grains.velocities.iter_mut().chain(&mut grains.angular_velocities).for_each(|it| *it *= share);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{normal_forces, rest::unbalanced_force};

    /// Oracle: the module documentation. Tolerance 1e-9: the overlap, a hundredth of the radius, is
    /// a difference of coordinates of 0.5 m, known to 1e-16 of that.
    #[test]
    fn a_grain_meets_its_mirror_image_as_it_met_the_wall() {
        let (radius, overlap) = (2e-3, 2e-5);
        let force = |xs: &[Real]| {
            let places: Vec<Vec3> = xs.iter().map(|&x| Vec3::new(x, 0.5, 0.5)).collect();
            let radii = vec![radius; xs.len()];
            let grains = Grains::at_rest(places, radii.clone(), masses(&radii));
            let mut system = system(grains, &Vec3::repeat(1.0));
            system.step();
            normal_forces(&system.state, &system.scratch)[0]
        };
        let wall = force(&[radius - overlap]);
        let image = force(&[0.5 - radius + overlap, 0.5 + radius - overlap]);
        assert!(wall > 0.0 && (image / wall - 1.0).abs() < 1e-9, "{image} {wall}");
    }

    /// Oracle: symmetry. Forces on the grains of a copy equal those of the original, both without
    /// friction; tolerance 5 %, since a force on a wall counts once and one between two images for
    /// both. Then they settle: less than a quarter remains.
    #[test]
    fn copies_hold_each_other() {
        let two = Boxed { n_grains: 300, n_tiles: [2, 1, 1], phase: Phase::Rest };
        let tile = two.closed_tile().grow().unwrap();
        let unbalanced = |mut system: System| {
            system.step();
            let System { model, state, scratch, .. } = &system;
            unbalanced_force(model, state, scratch)
        };
        let alone = unbalanced(system(tile.grains.clone(), &two.closed_tile().size()));
        let copies = unbalanced(system(two.mirrored(&tile.grains), &two.size()));
        let settled = unbalanced(two.system(two.of_tile(&tile)));
        assert!((copies / alone - 1.0).abs() < 0.05, "{copies} {alone}");
        assert!(settled < 0.25 * copies, "{settled} {copies}");
    }
}
