//! Contact laws: what two bodies do to each other where they touch.
//!
//! A law consists of three parts: a force along the normal, a tangential force, and cohesion, which may act
//! beyond contact. Passes over contacts are generic over the law. `PairLaw::with` selects it once per pass, so
//! no law slows another one down. A new law is a file beside `hertz_mindlin` and an arm of that `match`.
//!
//! The history of a contact is its tangential spring, which rotates with the bodies, and the numbers that the
//! law declares as its `Memory`, for example whether a liquid bridge exists or how much liquid it holds.

mod hertz_mindlin;
#[cfg(test)]
pub(in crate::physics) mod tests;

pub use hertz_mindlin::{Hertz, HertzMindlin, Mindlin};

use crate::{
    base::{
        Real, Vec3,
        lanes::{Lanes, Mask, Vector},
    },
    scene::{self, Material},
};

/// A contact law.
pub trait ContactLaw: Copy + Send + Sync {
    /// History of a contact besides its tangential spring.
    type Memory: Memory;

    /// How far beyond contact a force may act (m).
    fn range(&self) -> Real;

    /// Force on the first body; `history` is carried on by one substep of `dt` (s). Lanes of bodies that
    /// neither touch nor are within range hold numbers without meaning.
    fn force<L: Lanes>(
        &self,
        contact: &ContactState<L>,
        dt: Real,
        history: &mut History<L, Self::Memory>,
    ) -> Force<L>;

    /// Normal stiffness dF/dξ (N/m) of a contact that carries `force` (N), with the effective radius
    /// `radius` (m): what a stable substep must bear.
    fn stiffness(&self, radius: Real, force: Real) -> Real;
}

/// History of a contact besides its spring: `[Real; N]`, all zero if there is none.
pub trait Memory: bytemuck::Pod + Send + Sync {
    /// The same in lanes.
    type Lanes<L: Lanes>: Copy;
    /// How many numbers.
    const WIDTH: usize;

    /// `n` memories in a list of all their numbers; those that are missing are zero.
    fn rows(numbers: &mut Vec<Real>, n: usize) -> &mut [Self];
    /// Nothing to remember.
    fn nothing<L: Lanes>() -> Self::Lanes<L>;
    /// The first `L::N` memories in lanes.
    fn load<L: Lanes>(rows: &[Self]) -> Self::Lanes<L>;
    /// Writes lanes to the first `L::N` memories, zero where `mask` does not hold.
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
            // Arrays of nothing take no memory: nothing is allocated, and nothing leaks.
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

/// Where and how fast two bodies meet, in each lane.
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

/// What a contact remembers, in each lane.
#[derive(Clone, Copy)]
pub struct History<L: Lanes, M: Memory> {
    /// Tangential spring ξ_t (m).
    pub spring: Vector<L>,
    /// What else the law remembers.
    pub memory: M::Lanes<L>,
}

/// Force on the first body, in each lane.
#[derive(Clone, Copy)]
pub struct Force<L: Lanes> {
    /// Normal force (N), negative where the bodies attract each other.
    pub normal: L,
    /// Tangential force (N).
    pub tangential: Vector<L>,
    /// True where the bodies are in contact: they touch, or a bridge holds them.
    pub acts: L::Mask,
    /// True where the contact slides.
    pub slides: L::Mask,
}

/// A model of the force along the normal while bodies touch.
pub trait NormalForce: Copy + Send + Sync {
    /// Force in each lane; the overlap is not negative where it matters.
    fn force<L: Lanes>(&self, contact: &ContactState<L>) -> NormalPart<L>;
    /// See `ContactLaw::stiffness`.
    fn stiffness(&self, radius: Real, force: Real) -> Real;
}

/// What the normal part hands to the tangential one.
#[derive(Clone, Copy)]
pub struct NormalPart<L> {
    /// Repulsive force (N), at least zero.
    pub force: L,
    /// Radius of the contact area √(R* ξ) (m).
    pub contact_radius: L,
    /// Normal velocity (m/s), positive when parting.
    pub velocity: L,
}

/// A model of the tangential force while bodies touch.
pub trait TangentialForce: Copy + Send + Sync {
    /// Force in each lane; `spring` (m) is carried on by one substep of `dt` (s).
    fn force<L: Lanes>(
        &self,
        contact: &ContactState<L>,
        normal: &NormalPart<L>,
        dt: Real,
        spring: &mut Vector<L>,
    ) -> TangentialPart<L>;
}

/// The tangential part of a force.
#[derive(Clone, Copy)]
pub struct TangentialPart<L: Lanes> {
    /// Force on the first body (N).
    pub force: Vector<L>,
    /// True where the contact slides.
    pub slides: L::Mask,
}

/// A model of what pulls bodies together.
pub trait CohesiveForce: Copy + Send + Sync {
    /// What it remembers of a contact.
    type Memory: Memory;
    /// False if it never acts beyond contact.
    const ACTS_BEYOND_CONTACT: bool;
    /// How far beyond contact it may act (m).
    fn range(&self) -> Real;
    /// Pull in each lane; `memory` is carried on by one substep.
    fn force<L: Lanes>(
        &self,
        contact: &ContactState<L>,
        memory: &mut <Self::Memory as Memory>::Lanes<L>,
    ) -> CohesivePart<L>;
}

/// What pulls bodies together.
#[derive(Clone, Copy)]
pub struct CohesivePart<L: Lanes> {
    /// Attractive force (N), zero where it does not act.
    pub pull: L,
    /// True where it acts, or the bodies touch.
    pub acts: L::Mask,
}

/// Nothing pulls.
#[derive(Clone, Copy, Debug)]
pub struct NoCohesion;

impl CohesiveForce for NoCohesion {
    type Memory = [Real; 0];
    const ACTS_BEYOND_CONTACT: bool = false;

    #[inline(always)]
    fn range(&self) -> Real {
        0.0
    }

    #[inline(always)]
    fn force<L: Lanes>(&self, contact: &ContactState<L>, _: &mut [L; 0]) -> CohesivePart<L> {
        CohesivePart { pull: L::splat(0.0), acts: contact.touches }
    }
}

/// A law made of its parts. Friction is limited by the repulsive part of the normal force.
#[derive(Clone, Copy, Debug)]
pub struct Parts<N, T, C> {
    /// Along the normal.
    pub normal: N,
    /// In the tangent plane.
    pub tangential: T,
    /// What pulls the bodies together.
    pub cohesion: C,
}

impl<N: NormalForce, T: TangentialForce, C: CohesiveForce> ContactLaw for Parts<N, T, C> {
    type Memory = C::Memory;

    #[inline(always)]
    fn range(&self) -> Real {
        self.cohesion.range()
    }

    #[inline(always)]
    fn force<L: Lanes>(
        &self,
        contact: &ContactState<L>,
        dt: Real,
        history: &mut History<L, C::Memory>,
    ) -> Force<L> {
        let zero = L::splat(0.0);
        let mut pressed = *contact;
        if C::ACTS_BEYOND_CONTACT {
            pressed.overlap = contact.overlap.or_where(contact.touches, zero);
        }
        let mut normal = self.normal.force(&pressed);
        if C::ACTS_BEYOND_CONTACT {
            normal.force = normal.force.or_where(contact.touches, zero);
        }
        let mut tangential = self.tangential.force(&pressed, &normal, dt, &mut history.spring);
        if C::ACTS_BEYOND_CONTACT {
            let none = Vector::zero();
            tangential.force = tangential.force.or_where(contact.touches, none);
            tangential.slides = tangential.slides.and(contact.touches);
            history.spring = history.spring.or_where(contact.touches, none);
        }
        let CohesivePart { pull, acts } = self.cohesion.force(contact, &mut history.memory);
        Force {
            normal: normal.force - pull,
            tangential: tangential.force,
            acts,
            slides: tangential.slides,
        }
    }

    fn stiffness(&self, radius: Real, force: Real) -> Real {
        self.normal.stiffness(radius, force)
    }
}

/// Constants of one pair of materials, and the choice of their law.
#[derive(Clone, Copy, Debug)]
pub struct PairLaw {
    /// Effective Young's modulus E* (Pa).
    pub modulus: Real,
    /// Effective shear modulus G* (Pa).
    pub shear_modulus: Real,
    /// Coulomb friction μ.
    pub friction: Real,
    /// Dissipation time A (s).
    pub dissipation_time: Real,
    /// Tangential damping γ_t.
    pub tangential_damping: Real,
    /// What pulls the two together, between grains and at walls.
    pub cohesion: Cohesion,
}

/// The cohesive part of a law.
#[derive(Clone, Copy, Debug)]
pub enum Cohesion {
    /// Nothing pulls: Hertz and Mindlin alone.
    None,
    /// Bridges of constant force: a law that tests run through the passes.
    #[cfg(test)]
    Bridge(tests::Bridge),
}

/// Work that can be done under any law: what a pass over contacts is.
pub trait UnderLaw {
    /// What comes out.
    type Output;
    /// Does it under `law`.
    fn run<C: ContactLaw>(self, law: &C) -> Self::Output;
}

impl PairLaw {
    /// The law between two materials.
    pub fn between(first: &Material, second: &Material, surface: Surface) -> Self {
        let normal = |m: &Material| (1.0 - m.poisson_ratio.powi(2)) / m.youngs_modulus;
        let shear = |m: &Material| {
            (2.0 - m.poisson_ratio) * 2.0 * (1.0 + m.poisson_ratio) / m.youngs_modulus
        };
        Self {
            modulus: 1.0 / (normal(first) + normal(second)),
            shear_modulus: 1.0 / (shear(first) + shear(second)),
            friction: surface.friction,
            dissipation_time: surface.dissipation_time,
            tangential_damping: surface.tangential_damping,
            cohesion: Cohesion::None,
        }
    }

    /// The law of one material against something much stiffer.
    pub fn against_rigid(material: &Material, surface: Surface) -> Self {
        let rigid = Material { youngs_modulus: Real::INFINITY, ..*material };
        Self::between(material, &rigid, surface)
    }

    /// Does `work` under the law that was chosen: one `match` for all contacts of a pass.
    #[inline]
    pub fn with<W: UnderLaw>(&self, work: W) -> W::Output {
        match self.cohesion {
            Cohesion::None => work.run(&self.hertz_mindlin()),
            #[cfg(test)]
            Cohesion::Bridge(bridge) => {
                let HertzMindlin { normal, tangential, .. } = self.hertz_mindlin();
                work.run(&Parts { normal, tangential, cohesion: bridge })
            }
        }
    }

    /// The law without cohesion: that of grains on the membrane and of the membrane on bodies.
    #[inline(always)]
    pub fn hertz_mindlin(&self) -> HertzMindlin {
        let &Self { modulus, shear_modulus, friction, dissipation_time, .. } = self;
        Parts {
            normal: Hertz { modulus, dissipation_time },
            tangential: Mindlin {
                shear_modulus,
                friction,
                tangential_damping: self.tangential_damping,
            },
            cohesion: NoCohesion,
        }
    }

    /// How far beyond contact a force may act (m): what lists of neighbors must know.
    pub fn range(&self) -> Real {
        self.with(Range)
    }

    /// How many numbers a contact remembers besides its spring.
    pub fn memory_width(&self) -> usize {
        self.with(MemoryWidth)
    }

    /// See `ContactLaw::stiffness`.
    pub fn stiffness(&self, radius: Real, force: Real) -> Real {
        self.with(Stiffness { radius, force })
    }
}

struct Range;

impl UnderLaw for Range {
    type Output = Real;
    fn run<C: ContactLaw>(self, law: &C) -> Real {
        law.range()
    }
}

struct MemoryWidth;

impl UnderLaw for MemoryWidth {
    type Output = usize;
    fn run<C: ContactLaw>(self, _: &C) -> usize {
        C::Memory::WIDTH
    }
}

struct Stiffness {
    radius: Real,
    force: Real,
}

impl UnderLaw for Stiffness {
    type Output = Real;
    fn run<C: ContactLaw>(self, law: &C) -> Real {
        law.stiffness(self.radius, self.force)
    }
}

/// What two surfaces have in common.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Coulomb friction μ.
    pub friction: Real,
    /// Dissipation time A (s).
    pub dissipation_time: Real,
    /// Tangential damping γ_t.
    pub tangential_damping: Real,
}

impl Surface {
    /// Among the grains of a scene, and of grains with walls.
    pub fn of_grains(grains: &scene::Grains) -> Self {
        Self {
            friction: grains.friction,
            dissipation_time: grains.dissipation_time,
            tangential_damping: grains.tangential_damping,
        }
    }

    /// Of a scene's membrane with something, with which it has this friction.
    pub fn of_membrane(membrane: &scene::Membrane, friction: Real) -> Self {
        Self {
            friction,
            dissipation_time: membrane.dissipation_time,
            tangential_damping: membrane.tangential_damping,
        }
    }
}

/// Force on the first body of a single contact of bodies that touch, under the law without cohesion;
/// `spring` (m) is carried on by one substep of `dt` (s).
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
    /// That of the only lane.
    #[inline(always)]
    pub fn of(force: &Force<Real>) -> Self {
        let &Force { normal, tangential, acts, slides } = force;
        Self { normal, tangential: tangential.into(), acts, slides }
    }
}
