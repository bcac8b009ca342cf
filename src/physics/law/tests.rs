//! A second law, with bridges between grains. It uses everything that a law can do beyond Hertz and Mindlin, so
//! that tests can run it through the passes.

use super::{
    Cohesion, CohesiveForce, CohesivePart, ContactLaw, ContactState, Force, History, PairLaw,
    Surface, WithLaw,
};
use crate::{
    base::{
        Real, Vec3,
        lanes::{Lanes, Mask, Vector},
    },
    scene::Material,
};

/// A bridge of constant force that forms when bodies touch and breaks at a distance.
#[derive(Clone, Copy, Debug)]
pub struct Bridge {
    /// Attractive force (N).
    pub pull: Real,
    /// Distance at which it breaks (m).
    pub rupture: Real,
}

impl CohesiveForce for Bridge {
    /// 1 while the bridge exists.
    type Memory = [Real; 1];
    const ACTS_BEYOND_CONTACT: bool = true;

    fn range(&self) -> Real {
        self.rupture
    }

    #[inline(always)]
    fn force<L: Lanes>(&self, contact: &ContactState<L>, memory: &mut [L; 1]) -> CohesivePart<L> {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let is_near = (-contact.overlap).lt(L::splat(self.rupture));
        let persists = zero.lt(memory[0]).and(is_near);
        memory[0] = one.or_where(contact.touches, one.or_where(persists, zero));
        let acts = zero.lt(memory[0]);
        CohesivePart { pull: L::splat(self.pull).or_where(acts, zero), acts }
    }
}

/// A law with bridges between grains of 100 MPa.
pub(crate) fn bridged(surface: Surface, pull: Real, rupture: Real) -> PairLaw {
    let grain = Material { youngs_modulus: 1e8, poisson_ratio: 0.245, density: 2000.0 };
    let cohesion = Cohesion::Bridge(Bridge { pull, rupture });
    PairLaw { cohesion, ..PairLaw::between(&grain, &grain, surface) }
}

/// Evaluates one contact with any law.
struct SingleContact<'a> {
    overlap: Real,
    spring: &'a mut Vec3,
    memory: &'a mut Vec<Real>,
}

impl WithLaw for SingleContact<'_> {
    type Output = Force<Real>;

    fn run<C: ContactLaw>(self, law: &C) -> Force<Real> {
        use super::Memory;
        let rows = C::Memory::rows(self.memory, 1);
        let contact = ContactState {
            touches: 0.0 < self.overlap,
            overlap: self.overlap,
            normal: Vec3::z().into(),
            velocity: Vec3::new(0.01, 0.0, 0.02).into(),
            radius: 1e-3,
            mass: 1e-5,
        };
        let mut history =
            History { spring: Vector::from(*self.spring), memory: C::Memory::load::<f64>(rows) };
        let force = law.force(&contact, 1e-6, &mut history);
        C::Memory::store::<f64>(history.memory, true, rows);
        *self.spring = history.spring.into();
        force
    }
}

#[test]
fn a_bridge_forms_on_contact_persists_and_breaks() {
    // Oracle: the definition of the law; in contact, the forces of Hertz and Mindlin to the bit, minus the pull.
    let surface = Surface { friction: 0.5, dissipation_time: 1e-6, tangential_damping: 0.3 };
    let (pull, rupture) = (0.02, 1e-5);
    let law = bridged(surface, pull, rupture);
    let plain = PairLaw { cohesion: Cohesion::None, ..law };
    let (mut spring, mut memory) = (Vec3::zeros(), Vec::new());
    let mut at = |law: &PairLaw, overlap: Real| {
        let force = law.with(SingleContact { overlap, spring: &mut spring, memory: &mut memory });
        (force, spring)
    };
    let bits = |it: Vector<Real>| [it.x, it.y, it.z].map(Real::to_bits);

    let (before, _) = at(&law, -0.5 * rupture);
    assert!(!before.acts && before.normal.to_bits() == 0, "a bridge exists before contact");
    let (held, _) = at(&law, 1e-6);
    let (mut plain_spring, mut none) = (Vec3::zeros(), Vec::new());
    let contact = SingleContact { overlap: 1e-6, spring: &mut plain_spring, memory: &mut none };
    let expected = plain.with(contact);
    assert!(none.is_empty() && expected.acts && held.acts);
    assert_eq!(held.normal.to_bits(), (expected.normal - pull).to_bits());
    assert_eq!(bits(held.tangential), bits(expected.tangential));
    let (separated, spring) = at(&law, -0.9 * rupture);
    assert!(separated.acts && !separated.slides);
    assert_eq!(separated.normal.to_bits(), (-pull).to_bits());
    assert!(
        bits(separated.tangential) == [0; 3] && spring == Vec3::zeros(),
        "friction without contact"
    );
    assert!(!at(&law, -1.1 * rupture).0.acts, "the bridge has not broken");
    assert!(!at(&law, -0.5 * rupture).0.acts, "a broken bridge forms again without contact");
}

#[test]
fn a_law_has_a_range_and_the_stiffness_of_its_normal_part() {
    // Oracle: by hand. Hertz: F = 4/3 E* √R* ξ^3/2, so dF/dξ = 3/2 F/ξ, to rounding.
    let surface = Surface { friction: 0.5, dissipation_time: 0.0, tangential_damping: 0.0 };
    let law = bridged(surface, 0.01, 2e-5);
    let plain = PairLaw { cohesion: Cohesion::None, ..law };
    assert_eq!([law.range().to_bits(), plain.range().to_bits()], [2e-5_f64.to_bits(), 0]);
    let (radius, overlap): (Real, Real) = (1e-3, 1e-5);
    let force = 4.0 / 3.0 * law.modulus * radius.sqrt() * overlap.powf(1.5);
    assert!((law.stiffness(radius, force) / (1.5 * force / overlap) - 1.0).abs() < 1e-12);
}
