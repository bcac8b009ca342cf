//! Contact laws: the force between two bodies that touch.
//!
//! A law has three parts: a force along the normal, a tangential force, and cohesion, which may act beyond
//! contact. Passes over contacts are generic over the law. `PairLaw::with` selects the law once per pass, so no
//! law slows down another. To add a law, add a file next to `hertz_mindlin` and an arm to that `match`.
//!
//! The history of a contact consists of its tangential spring, which rotates with the bodies, and the numbers that
//! the law declares as its `Memory`, for example whether a liquid bridge exists or how much liquid it contains.

mod hertz_mindlin;
mod pair_law; // constants of two materials; selects their law
mod parts; // normal, tangential and cohesive forces
#[cfg(test)]
pub(in crate::physics) mod tests;

pub use hertz_mindlin::{Hertz, HertzMindlin, Mindlin};
pub use pair_law::{Cohesion, PairLaw, Surface, WithLaw};
pub use parts::{
    CohesiveForce, CohesivePart, NoCohesion, NormalForce, NormalPart, Parts, TangentialForce,
    TangentialPart,
};

use crate::base::{
    Real, Vec3,
    lanes::{Lanes, Vector},
};

/// A contact law.
pub trait ContactLaw: Copy + Send + Sync {
    /// History of a contact in addition to its tangential spring.
    type Memory: Memory;

    /// Distance beyond contact up to which a force may act (m).
    fn range(&self) -> Real;

    /// Force on the first body. Updates `history` by one substep of `dt` (s). Lanes of bodies that are out of
    /// range contain meaningless numbers.
    fn force<L: Lanes>(
        &self,
        contact: &ContactState<L>,
        dt: Real,
        history: &mut History<L, Self::Memory>,
    ) -> Force<L>;

    /// Normal stiffness dF/dξ (N/m) of a contact that carries `force` (N), with the effective radius
    /// `radius` (m). The critical step depends on it.
    fn stiffness(&self, radius: Real, force: Real) -> Real;
}

/// History of a contact in addition to its spring: `[Real; N]`, all zero if there is none.
pub trait Memory: bytemuck::Pod + Send + Sync {
    /// The history of one contact per lane.
    type Lanes<L: Lanes>: Copy;
    /// Number of numbers per contact.
    const WIDTH: usize;

    /// Views a list of numbers as the history of `n` contacts. Resizes the list; new numbers are zero.
    fn rows(numbers: &mut Vec<Real>, n: usize) -> &mut [Self];
    /// The history of a new contact: all zero.
    fn nothing<L: Lanes>() -> Self::Lanes<L>;
    /// Loads the first `L::N` rows into lanes.
    fn load<L: Lanes>(rows: &[Self]) -> Self::Lanes<L>;
    /// Stores lanes in the first `L::N` rows, zero where `mask` is false.
    fn store<L: Lanes>(lanes: Self::Lanes<L>, mask: L::Mask, rows: &mut [Self]);
}

impl<const N: usize> Memory for [Real; N]
where
    Self: bytemuck::Pod,
{
    type Lanes<L: Lanes> = [L; N];
    const WIDTH: usize = N;

    fn rows(numbers: &mut Vec<Real>, n: usize) -> &mut [Self] {
        numbers.resize(n * N, 0.0);
        if N == 0 {
            // Empty arrays take no memory: nothing is allocated, and nothing leaks.
            return Vec::leak(vec![[0.0; N]; n]);
        }
        bytemuck::cast_slice_mut(numbers)
    }

    #[inline(always)]
    fn nothing<L: Lanes>() -> [L; N] {
        [L::splat(0.0); N]
    }

    #[inline(always)]
    fn load<L: Lanes>(rows: &[Self]) -> [L; N] {
        std::array::from_fn(|c| {
            let mut column = [0.0; 8];
            column.iter_mut().zip(&rows[..L::N]).for_each(|(it, row)| *it = row[c]);
            L::load(&column)
        })
    }

    #[inline(always)]
    fn store<L: Lanes>(lanes: [L; N], mask: L::Mask, rows: &mut [Self]) {
        for (c, it) in lanes.into_iter().enumerate() {
            let mut column = [0.0; 8];
            it.or_where(mask, L::splat(0.0)).store(&mut column);
            rows[..L::N].iter_mut().zip(column).for_each(|(row, it)| row[c] = it);
        }
    }
}

/// Geometry and relative velocity of two bodies, in each lane.
#[derive(Clone, Copy)]
pub struct ContactState<L: Lanes> {
    /// True where the bodies touch.
    pub touches: L::Mask,
    /// Overlap ξ (m), positive where they touch.
    pub overlap: L,
    /// Unit normal, from the second body to the first.
    pub normal: Vector<L>,
    /// Velocity of the first body relative to the second at the contact point (m/s).
    pub velocity: Vector<L>,
    /// Effective radius R* (m).
    pub radius: L,
    /// Effective mass m* (kg).
    pub mass: L,
}

/// History of a contact, in each lane.
#[derive(Clone, Copy)]
pub struct History<L: Lanes, M: Memory> {
    /// Tangential spring ξ_t (m).
    pub spring: Vector<L>,
    /// What else the law stores.
    pub memory: M::Lanes<L>,
}

/// Force on the first body, in each lane.
#[derive(Clone, Copy)]
pub struct Force<L: Lanes> {
    /// Normal force (N), negative where the bodies attract each other.
    pub normal: L,
    /// Tangential force (N).
    pub tangential: Vector<L>,
    /// True where the bodies are in contact: they touch, or cohesion acts between them.
    pub acts: L::Mask,
    /// True where the contact slides.
    pub slides: L::Mask,
}

/// Force on the first body of a single contact of bodies that touch, without cohesion. Updates `spring` (m) by
/// one substep of `dt` (s).
#[inline(always)]
pub fn scalar(
    law: &PairLaw,
    contact: &ContactState<Real>,
    dt: Real,
    spring: &mut Vec3,
) -> ScalarForce {
    let mut history = History { spring: Vector::from(*spring), memory: [] };
    let force = law.hertz_mindlin().force(contact, dt, &mut history);
    *spring = history.spring.into();
    ScalarForce::of(&force)
}

/// Force on the first body of a single contact.
#[derive(Clone, Copy, Debug)]
pub struct ScalarForce {
    /// Normal force (N), negative if the bodies attract each other.
    pub normal: Real,
    /// Tangential force (N).
    pub tangential: Vec3,
    /// True while the bodies are in contact.
    pub acts: bool,
    /// True while the contact slides.
    pub slides: bool,
}

impl ScalarForce {
    /// Converts from a single lane.
    #[inline(always)]
    pub fn of(force: &Force<Real>) -> Self {
        let &Force { normal, tangential, acts, slides } = force;
        Self { normal, tangential: tangential.into(), acts, slides }
    }
}
