//! A law composed of parts: models of the normal, the tangential and the cohesive force.

use super::{ContactLaw, ContactState, Force, History, Memory};
use crate::base::{
    Real,
    lanes::{Lanes, Mask, Vector},
};

/// A model of the force along the normal between bodies that touch.
pub trait NormalForce: Copy + Send + Sync {
    /// Force in each lane. Lanes with a negative overlap may return any number.
    fn force<L: Lanes>(&self, contact: &ContactState<L>) -> NormalPart<L>;
    /// See `ContactLaw::stiffness`.
    fn stiffness(&self, radius: Real, force: Real) -> Real;
}

/// The normal part of a force, and what the tangential part needs.
#[derive(Clone, Copy)]
pub struct NormalPart<L> {
    /// Repulsive force (N), at least zero.
    pub force: L,
    /// Radius of the contact area √(R* ξ) (m).
    pub contact_radius: L,
    /// Normal velocity (m/s), positive when separating.
    pub velocity: L,
}

/// A model of the tangential force between bodies that touch.
pub trait TangentialForce: Copy + Send + Sync {
    /// Force in each lane. Updates `spring` (m) by one substep of `dt` (s).
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

/// A model of cohesion between bodies.
pub trait CohesiveForce: Copy + Send + Sync {
    /// History of a contact.
    type Memory: Memory;
    /// False if it never acts beyond contact.
    const ACTS_BEYOND_CONTACT: bool;
    /// Distance beyond contact up to which it may act (m).
    fn range(&self) -> Real;
    /// Attractive force in each lane. Updates `memory` by one substep.
    fn force<L: Lanes>(
        &self,
        contact: &ContactState<L>,
        memory: &mut <Self::Memory as Memory>::Lanes<L>,
    ) -> CohesivePart<L>;
}

/// The cohesive part of a force.
#[derive(Clone, Copy)]
pub struct CohesivePart<L: Lanes> {
    /// Attractive force (N), zero where it does not act.
    pub pull: L,
    /// True where cohesion acts, or the bodies touch.
    pub acts: L::Mask,
}

/// No cohesion.
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

/// A law composed of parts. Friction is limited by the repulsive part of the normal force.
#[derive(Clone, Copy, Debug)]
pub struct Parts<N, T, C> {
    /// Model of the normal force.
    pub normal: N,
    /// Model of the tangential force.
    pub tangential: T,
    /// Model of cohesion.
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
        let mut touching = *contact;
        if C::ACTS_BEYOND_CONTACT {
            touching.overlap = contact.overlap.or_where(contact.touches, zero);
        }
        let mut normal = self.normal.force(&touching);
        if C::ACTS_BEYOND_CONTACT {
            normal.force = normal.force.or_where(contact.touches, zero);
        }
        let mut tangential = self.tangential.force(&touching, &normal, dt, &mut history.spring);
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
