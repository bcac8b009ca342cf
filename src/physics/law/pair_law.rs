//! Constants of the contact between two materials, and the choice of their law.

use super::{ContactLaw, Hertz, HertzMindlin, Mindlin, NoCohesion, Parts};
use crate::{
    base::Real,
    scene::{self, Material},
};

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
    Bridge(super::tests::Bridge),
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
