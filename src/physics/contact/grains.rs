//! Contacts between grains: the pair pass.
//!
//! In a periodic box a pair meets by its closest image. Whether there is a box is decided once for all
//! pairs, so that open systems do not pay for it.

use super::law::{self, Touch};
use crate::{
    base::{
        Real, Vec3,
        lanes::{self, Kernel, Lanes, Mask, Vector},
        parallel,
    },
    physics::{
        Model,
        scratch::{GrainRow, Neighbours, PairForce},
        state::{Grains, State},
    },
};

/// Forces of all pairs; carries their springs on by one substep.
pub fn forces(
    model: &Model,
    state: &State,
    springs: &mut [Vec3],
    lists: &Neighbours,
    (rows, pair_forces): (&mut Vec<GrainRow>, &mut Vec<PairForce>),
) {
    line_up(&state.grains, rows);
    pair_forces.resize(state.pair_ids.len(), PairForce::default());
    let rows = &*rows;
    parallel::for_parts_of_two(pair_forces, springs, |start, forces, springs| {
        let pairs = Pairs {
            model,
            rows,
            ids: &state.pair_ids[start..start + forces.len()],
            radii: &lists.pair_radii[start..start + forces.len()],
            masses: &lists.pair_masses[start..start + forces.len()],
        };
        lanes::widest(Pass { pairs, forces, springs });
    });
}

/// What pairs need of each grain, in one place in memory.
fn line_up(grains: &Grains, rows: &mut Vec<GrainRow>) {
    rows.resize(grains.len(), GrainRow::default());
    parallel::for_each(rows, |i, row| {
        let (position, velocity, spin) =
            (&grains.positions[i], &grains.velocities[i], &grains.spins[i]);
        row.place = [position.x, position.y, position.z, grains.radii[i]];
        row.velocity = [velocity.x, velocity.y, velocity.z, 0.0];
        row.spin = [spin.x, spin.y, spin.z, 0.0];
    });
}

/// Pairs and their grains.
struct Pairs<'a> {
    model: &'a Model,
    rows: &'a [GrainRow],
    ids: &'a [[u32; 2]],
    /// R* [m].
    radii: &'a [Real],
    /// m* [kg].
    masses: &'a [Real],
}

/// Forces and springs of pairs.
struct Pass<'a> {
    pairs: Pairs<'a>,
    forces: &'a mut [PairForce],
    springs: &'a mut [Vec3],
}

impl Kernel for Pass<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { pairs, forces, springs } = self;
        let forces = bytemuck::cast_slice_mut(forces);
        let springs = bytemuck::cast_slice_mut(springs);
        let n_whole = forces.len() / L::N * L::N;
        match &pairs.model.period {
            None => {
                let image = Open;
                pairs.blocks::<L, _>(0..n_whole, &image, forces, springs);
                pairs.blocks::<f64, _>(n_whole..forces.len(), &image, forces, springs);
            }
            Some(period) => {
                let image = Periodic(period);
                pairs.blocks::<L, _>(0..n_whole, &image, forces, springs);
                pairs.blocks::<f64, _>(n_whole..forces.len(), &image, forces, springs);
            }
        }
    }
}

/// Which image of a partner is meant.
trait Image {
    /// The vector between two centres [m], to the image meant.
    fn apart<L: Lanes>(&self, apart: Vector<L>) -> Vector<L>;
}

/// No images.
struct Open;

impl Image for Open {
    #[inline(always)]
    fn apart<L: Lanes>(&self, apart: Vector<L>) -> Vector<L> {
        apart
    }
}

/// Images in a box with these edges [m].
struct Periodic<'a>(&'a Vec3);

impl Image for Periodic<'_> {
    #[inline(always)]
    fn apart<L: Lanes>(&self, apart: Vector<L>) -> Vector<L> {
        let Vector { x, y, z } = apart;
        let Vector { x: a, y: b, z: c } = Vector::splat(self.0);
        Vector::new(x - (x / a).round() * a, y - (y / b).round() * b, z - (z / c).round() * c)
    }
}

/// The shortest of the vectors `apart` [m] between the images of two points.
pub fn closest_image(apart: Vec3, period: &Vec3) -> Vec3 {
    Periodic(period).apart(Vector::from(apart)).into()
}

impl Pairs<'_> {
    /// The pairs of a range, `L::N` at a time.
    #[inline(always)]
    fn blocks<L: Lanes, I: Image>(
        &self,
        range: std::ops::Range<usize>,
        image: &I,
        forces: &mut [[f64; 8]],
        springs: &mut [[f64; 3]],
    ) {
        let mut k = range.start;
        while k < range.end {
            let springs = &mut springs[k..k + L::N];
            let mut spring = Vector::of(L::from_rows_of_3(springs));
            let force = self.block(k, image, &mut spring);
            L::to_rows_of_3([spring.x, spring.y, spring.z], springs);
            L::to_rows_of_8(force, &mut forces[k..k + L::N]);
            k += L::N;
        }
    }

    /// Rows of `PairForce` of the pairs from `k` on.
    #[inline(always)]
    fn block<L: Lanes, I: Image>(&self, k: usize, image: &I, spring: &mut Vector<L>) -> [L; 8] {
        let ids = &self.ids[k..k + L::N];
        let grain = |lane: usize, side: usize| &self.rows[ids[lane][side] as usize];
        let [x_i, y_i, z_i, radius_i] = L::from_rows_of_4(|lane| &grain(lane, 0).place);
        let [x_j, y_j, z_j, radius_j] = L::from_rows_of_4(|lane| &grain(lane, 1).place);
        let apart = image.apart(Vector::new(x_i, y_i, z_i) - Vector::new(x_j, y_j, z_j));
        let reach = radius_i + radius_j;
        let distance_squared = apart.dot(apart);
        let touches = distance_squared.lt(reach * reach);
        let zero = L::splat(0.0);
        if !touches.any() {
            *spring = Vector::zero();
            return [zero; 8];
        }
        let distance = distance_squared.sqrt();
        let overlap = reach - distance;
        let normal = apart * (L::splat(1.0) / distance);
        // Levers from the centres to the contact point: −(R_i − ξ/2) n and +(R_j − ξ/2) n.
        let half = overlap / L::splat(2.0);
        let vector = |[x, y, z, _]: [L; 4]| Vector::new(x, y, z);
        let spin = vector(L::from_rows_of_4(|lane| &grain(lane, 0).spin)) * (radius_i - half)
            + vector(L::from_rows_of_4(|lane| &grain(lane, 1).spin)) * (radius_j - half);
        let velocity = vector(L::from_rows_of_4(|lane| &grain(lane, 0).velocity))
            - vector(L::from_rows_of_4(|lane| &grain(lane, 1).velocity))
            - spin.cross(normal);
        let radius = L::load(&self.radii[k..]);
        let mass = L::load(&self.masses[k..]);
        let touch = Touch { overlap, normal, velocity, radius, mass };
        let force = law::force(&self.model.grain_law, &touch, self.model.substep, spring);
        *spring = spring.or_where(touches, Vector::zero());
        let on_first = normal * force.normal + force.tangential;
        let couple = normal.cross(force.tangential);
        let signed_normal = (-force.normal).or_where(force.slides, force.normal);
        [on_first.x, on_first.y, on_first.z, couple.x, couple.y, couple.z, overlap, signed_normal]
            .map(|it| it.or_where(touches, zero))
    }
}
