//! Constants of contacts between two materials, and the selection of their law.

use super::{ContactLaw, Hertz, HertzMindlin, Mindlin, NoCohesion, Parts};
use crate::{
    base::Real,
    scene::{self, Material},
};

/// Constants of contacts between two materials. `with` selects their law.
#[derive(Clone, Copy, Debug)]
pub struct PairLaw {
    /// Effective Young's modulus E* (Pa).
    pub modulus: Real,
    /// Effective shear modulus G* (Pa).
    pub shear_modulus: Real,
    /// Coefficient of Coulomb friction μ.
    pub friction: Real,
    /// Dissipation time A (s).
    pub dissipation_time: Real,
    /// Tangential damping ratio γ_t.
    pub tangential_damping: Real,
    /// Cohesion between grains and at walls.
    pub cohesion: Cohesion,
}

/// The cohesive part of a law.
#[derive(Clone, Copy, Debug)]
pub enum Cohesion {
    /// No cohesion: Hertz and Mindlin only.
    None,
    /// Bridges of constant force, for tests.
    #[cfg(test)]
    Bridge(super::tests::Bridge),
}

/// A computation that is generic over the contact law, such as a pass over contacts.
pub trait WithLaw {
    /// Its result.
    type Output;
    /// Runs with `law`.
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

    /// The law between a material and something much stiffer.
    pub fn against_rigid(material: &Material, surface: Surface) -> Self {
        let rigid = Material { youngs_modulus: Real::INFINITY, ..*material };
        Self::between(material, &rigid, surface)
    }

    /// Runs `work` with the selected law: one `match` for all contacts of a pass.
    #[inline]
    pub fn with<W: WithLaw>(&self, work: W) -> W::Output {
        match self.cohesion {
            Cohesion::None => work.run(&self.hertz_mindlin()),
            #[cfg(test)]
            Cohesion::Bridge(bridge) => {
                let HertzMindlin { normal, tangential, .. } = self.hertz_mindlin();
                work.run(&Parts { normal, tangential, cohesion: bridge })
            }
        }
    }

    /// The law without cohesion, which acts between grains and membrane and between membrane and bodies.
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

    /// Distance beyond contact up to which a force may act (m). Neighbor lists include this range.
    pub fn range(&self) -> Real {
        self.with(Range)
    }

    /// See `ContactLaw::stiffness`.
    pub fn stiffness(&self, radius: Real, force: Real) -> Real {
        self.with(Stiffness { radius, force })
    }
}

struct Range;

impl WithLaw for Range {
    type Output = Real;
    fn run<C: ContactLaw>(self, law: &C) -> Real {
        law.range()
    }
}

struct Stiffness {
    radius: Real,
    force: Real,
}

impl WithLaw for Stiffness {
    type Output = Real;
    fn run<C: ContactLaw>(self, law: &C) -> Real {
        law.stiffness(self.radius, self.force)
    }
}

/// Surface properties of a pair of materials.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Coefficient of Coulomb friction μ.
    pub friction: Real,
    /// Dissipation time A (s).
    pub dissipation_time: Real,
    /// Tangential damping ratio γ_t.
    pub tangential_damping: Real,
}

impl Surface {
    /// Between the grains of a scene, and between grains and walls.
    pub fn of_grains(grains: &scene::Grains) -> Self {
        Self {
            friction: grains.friction,
            dissipation_time: grains.dissipation_time,
            tangential_damping: grains.tangential_damping,
        }
    }

    /// Between a scene's membrane and something else, with this coefficient of friction.
    pub fn of_membrane(membrane: &scene::Membrane, friction: Real) -> Self {
        Self {
            friction,
            dissipation_time: membrane.dissipation_time,
            tangential_damping: membrane.tangential_damping,
        }
    }
}
