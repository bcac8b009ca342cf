//! Contacts between grains: the pair pass.
//!
//! In a periodic box a pair interacts through its closest images. Whether there is a box, and which law acts, is
//! decided once for all pairs, so open systems do not pay for periodic ones, nor one law for another.

use crate::{
    base::{
        Real, Vec3,
        lanes::{self, Kernel, Lanes, Mask, Vector},
        parallel,
    },
    physics::{
        Model,
        law::{ContactLaw, ContactState, History, Memory, WithLaw},
        scratch::{ContactFlags, GrainRow, PairForce, Scratch},
        state::{Grains, Springs},
    },
};

/// Computes the forces of all pairs `ids`, and updates their history by one substep.
pub fn forces(
    model: &Model,
    grains: &Grains,
    ids: &[[u32; 2]],
    springs: &mut Springs,
    scratch: &mut Scratch,
) {
    gather(grains, &mut scratch.grain_rows);
    model.grain_law.with(AllPairs { model, ids, springs, scratch });
}

/// Gathers the data of each grain that pairs read in one row.
fn gather(grains: &Grains, rows: &mut Vec<GrainRow>) {
    rows.resize(grains.len(), GrainRow::default());
    parallel::for_each(rows, |i, row| {
        let (position, velocity, angular_velocity) =
            (&grains.positions[i], &grains.velocities[i], &grains.angular_velocities[i]);
        row.position_radius = [position.x, position.y, position.z, grains.radii[i]];
        row.velocity = [velocity.x, velocity.y, velocity.z, 0.0];
        row.angular_velocity = [angular_velocity.x, angular_velocity.y, angular_velocity.z, 0.0];
    });
}

/// The pass over all pairs.
struct AllPairs<'a> {
    model: &'a Model,
    ids: &'a [[u32; 2]],
    springs: &'a mut Springs,
    scratch: &'a mut Scratch,
}

impl WithLaw for AllPairs<'_> {
    type Output = ();

    fn run<C: ContactLaw>(self, law: &C) {
        let Self { model, ids, springs, scratch } = self;
        let Scratch { neighbors, grain_rows, pair_forces, pair_flags, .. } = scratch;
        pair_forces.resize(ids.len(), PairForce::default());
        pair_flags.resize(ids.len(), ContactFlags::NONE);
        let memories = C::Memory::rows(&mut springs.pair_memories, ids.len());
        let (lists, rows) = (&*neighbors, &**grain_rows);
        let columns = (&mut **pair_forces, &mut **pair_flags, &mut *springs.pairs, memories);
        parallel::for_parts_of_four(columns, |start, forces, flags, springs, memories| {
            let here = start..start + forces.len();
            let pairs = Pairs {
                model,
                law,
                rows,
                ids: &ids[here.clone()],
                radii: &lists.pair_radii[here.clone()],
                masses: &lists.pair_masses[here],
            };
            let forces = bytemuck::cast_slice_mut(forces);
            let flags = bytemuck::cast_slice_mut(flags);
            let springs = bytemuck::cast_slice_mut(springs);
            lanes::widest(Pass { pairs, results: Results { forces, flags, springs, memories } });
        });
    }
}

/// Input of a pass: pairs and their grains.
struct Pairs<'a, C> {
    model: &'a Model,
    law: &'a C,
    rows: &'a [GrainRow],
    ids: &'a [[u32; 2]],
    /// Effective radii R* (m).
    radii: &'a [Real],
    /// Effective masses m* (kg).
    masses: &'a [Real],
}

/// Output of a pass over pairs.
struct Results<'a, M> {
    /// Rows of `PairForce`.
    forces: &'a mut [[f64; 8]],
    /// `ContactFlags`.
    flags: &'a mut [u8],
    springs: &'a mut [[f64; 3]],
    memories: &'a mut [M],
}

/// A pass over a range of pairs.
struct Pass<'a, C: ContactLaw> {
    pairs: Pairs<'a, C>,
    results: Results<'a, C::Memory>,
}

impl<C: ContactLaw> Kernel for Pass<'_, C> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { pairs, mut results } = self;
        let n = pairs.ids.len();
        let n_whole = n / L::N * L::N;
        match &pairs.model.period {
            None => {
                let image = Open;
                pairs.blocks::<L, _>(0..n_whole, &image, &mut results);
                pairs.blocks::<f64, _>(n_whole..n, &image, &mut results);
            }
            Some(period) => {
                let image = Periodic(period);
                pairs.blocks::<L, _>(0..n_whole, &image, &mut results);
                pairs.blocks::<f64, _>(n_whole..n, &image, &mut results);
            }
        }
    }
}

/// Selects the image of a grain that a pair interacts with.
trait Image {
    /// Maps the vector between two centers (m) to the one between the selected images.
    fn separation<L: Lanes>(&self, separation: Vector<L>) -> Vector<L>;
}

/// An open system: there are no images.
struct Open;

impl Image for Open {
    #[inline(always)]
    fn separation<L: Lanes>(&self, separation: Vector<L>) -> Vector<L> {
        separation
    }
}

/// A periodic box with these edges (m): the closest image is selected.
struct Periodic<'a>(&'a Vec3);

impl Image for Periodic<'_> {
    #[inline(always)]
    fn separation<L: Lanes>(&self, separation: Vector<L>) -> Vector<L> {
        let Vector { x, y, z } = separation;
        let Vector { x: a, y: b, z: c } = Vector::splat(self.0);
        Vector::new(x - (x / a).round() * a, y - (y / b).round() * b, z - (z / c).round() * c)
    }
}

/// The shortest vector (m) between images of two points `separation` (m) apart, in a box with edges `period`
/// (m).
pub fn closest_image(separation: Vec3, period: &Vec3) -> Vec3 {
    Periodic(period).separation(Vector::from(separation)).into()
}

/// Results of a block of pairs.
struct Block<L: Lanes> {
    /// Columns of `PairForce`.
    force: [L; 8],
    acts: L::Mask,
    slides: L::Mask,
}

/// Expands one bit per pair to one byte per pair, 0 or 1.
#[inline(always)]
fn spread(bits: u8) -> u64 {
    // Byte k keeps bit k at its position; then the set bit of each byte moves to its lowest bit.
    let in_place = (u64::from(bits) * 0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
    (in_place + 0x7f7f_7f7f_7f7f_7f7f) >> 7 & 0x0101_0101_0101_0101
}

impl<C: ContactLaw> Pairs<'_, C> {
    /// Evaluates the pairs of a range, `L::N` at a time.
    #[inline(always)]
    fn blocks<L: Lanes, I: Image>(
        &self,
        range: std::ops::Range<usize>,
        image: &I,
        results: &mut Results<'_, C::Memory>,
    ) {
        let mut k = range.start;
        while k < range.end {
            let here = k..k + L::N;
            let springs = &mut results.springs[here.clone()];
            let memories = &mut results.memories[here.clone()];
            let mut history = History {
                spring: Vector::of(L::from_rows_of_3(springs)),
                memory: C::Memory::load::<L>(memories),
            };
            let Block { force, acts, slides } = self.block(k, image, &mut history);
            let Vector { x, y, z } = history.spring;
            L::to_rows_of_3([x, y, z], springs);
            C::Memory::store(history.memory, acts, memories);
            L::to_rows_of_8(force, &mut results.forces[here.clone()]);
            let touching = spread(acts.bits()) * u64::from(ContactFlags::TOUCHES);
            let sliding = spread(slides.and(acts).bits()) * u64::from(ContactFlags::SLIDES);
            let flags = touching | sliding;
            results.flags[here].copy_from_slice(&flags.to_le_bytes()[..L::N]);
            k += L::N;
        }
    }

    /// Evaluates `L::N` pairs from index `k` on.
    #[inline(always)]
    fn block<L: Lanes, I: Image>(
        &self,
        k: usize,
        image: &I,
        history: &mut History<L, C::Memory>,
    ) -> Block<L> {
        let ids = &self.ids[k..k + L::N];
        let grain = |lane: usize, side: usize| &self.rows[ids[lane][side] as usize];
        let [x_i, y_i, z_i, radius_i] = L::from_rows_of_4(|lane| &grain(lane, 0).position_radius);
        let [x_j, y_j, z_j, radius_j] = L::from_rows_of_4(|lane| &grain(lane, 1).position_radius);
        let separation = image.separation(Vector::new(x_i, y_i, z_i) - Vector::new(x_j, y_j, z_j));
        let reach = radius_i + radius_j;
        let distance_squared = separation.dot(separation);
        let touches = distance_squared.lt(reach * reach);
        let range = self.law.range();
        let is_near = if range > 0.0 {
            let reach = reach + L::splat(range);
            distance_squared.lt(reach * reach)
        } else {
            touches
        };
        let zero = L::splat(0.0);
        if !is_near.any() {
            history.spring = Vector::zero();
            return Block { force: [zero; 8], acts: is_near, slides: is_near };
        }
        let distance = distance_squared.sqrt();
        let overlap = reach - distance;
        let normal = separation * (L::splat(1.0) / distance);
        // Levers from the centers to the contact point: −(R_i − ξ/2) n and +(R_j − ξ/2) n.
        let half = overlap / L::splat(2.0);
        let vector = |[x, y, z, _]: [L; 4]| Vector::new(x, y, z);
        let rotation = vector(L::from_rows_of_4(|lane| &grain(lane, 0).angular_velocity))
            * (radius_i - half)
            + vector(L::from_rows_of_4(|lane| &grain(lane, 1).angular_velocity))
                * (radius_j - half);
        let velocity = vector(L::from_rows_of_4(|lane| &grain(lane, 0).velocity))
            - vector(L::from_rows_of_4(|lane| &grain(lane, 1).velocity))
            - rotation.cross(normal);
        let radius = L::load(&self.radii[k..]);
        let mass = L::load(&self.masses[k..]);
        let contact = ContactState { touches, overlap, normal, velocity, radius, mass };
        let force = self.law.force(&contact, self.model.substep, history);
        let acts = force.acts.and(is_near);
        history.spring = history.spring.or_where(acts, Vector::zero());
        let on_first = normal * force.normal + force.tangential;
        let couple = normal.cross(force.tangential);
        let row = [
            on_first.x,
            on_first.y,
            on_first.z,
            couple.x,
            couple.y,
            couple.z,
            overlap,
            force.normal,
        ];
        let force_row = row.map(|it| it.or_where(acts, zero));
        Block { force: force_row, acts, slides: force.slides }
    }
}
