//! Thickness of the skin of the lists. A thin skin lists fewer pairs that do not touch, but is used up sooner.
//!
//! ```text
//! cost of a substep = 1 + a s / d + b v / s,   least at   s = √(b/a · d v)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | s | skin | m |
//! | d | largest diameter | m |
//! | v | how much of the skin a substep uses up | m |
//! | a | what a skin of a diameter would cost in each substep, in substeps | – |
//! | b | what building the lists costs, in substeps | – |
//!
//! `v` is measured since the last build, so no clock is involved. Results do not depend on which pairs are
//! listed besides those in contact.

use crate::{
    base::Real,
    physics::{Model, scratch::Neighbours},
};

/// b/a: measured with boxes at rest and flowing.
const BUILD_OVER_SKIN: Real = 10.0;
/// Substeps after which a skin that is too thick is replaced.
const PROBATION: u64 = 100;
/// How much too thick it must be for that.
const TOO_THICK: Real = 2.0;
/// The thinnest skin, as a share of the model's, which is the thickest.
const THINNEST: Real = 1.0 / 8.0;

/// The skin (m) that costs least if it goes on as since the last build, in which `used` (m) of the skin
/// were used up.
pub(super) fn cheapest(model: &Model, lists: &Neighbours, used: Real) -> Real {
    let n = lists.n_since_build.max(1);
    #[expect(clippy::cast_precision_loss, reason = "a count of substeps")]
    let per_substep = used / n as Real;
    let skin = (BUILD_OVER_SKIN * 2.0 * model.radius_max * per_substep).sqrt();
    // NaN gives the thickest skin.
    if skin < model.skin { skin.max(THINNEST * model.skin) } else { model.skin }
}

/// True if complete lists should be rebuilt with a thinner skin.
pub(super) fn is_too_thick(model: &Model, lists: &Neighbours, used: Real) -> bool {
    lists.n_since_build == PROBATION && TOO_THICK * cheapest(model, lists, used) < lists.skin
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::{SystemBuilder, law::Surface},
        scene::Material,
    };

    fn model() -> Model {
        let material = Material { youngs_modulus: 1e8, poisson_ratio: 0.25, density: 2500.0 };
        let surface = Surface { friction: 0.5, dissipation_time: 0.0, tangential_damping: 0.0 };
        let mut builder = SystemBuilder::of_material(&material, surface);
        builder.substep(1e-6).radii_up_to(2e-3, 2e-3);
        builder.build_model().unwrap()
    }

    fn lists(skin: Real, n_since_build: u64) -> Neighbours {
        Neighbours { is_built: true, skin, n_since_build, ..Neighbours::default() }
    }

    /// Oracle: the cost formula above, evaluated for many skins.
    #[test]
    fn no_skin_costs_less() {
        let model = model();
        let (diameter, per_substep) = (2.0 * model.radius_max, 2e-7);
        let found = cheapest(&model, &lists(model.skin, 1000), 1000.0 * per_substep);
        let cost = |skin: Real| skin / diameter + BUILD_OVER_SKIN * per_substep / skin;
        assert!(THINNEST * model.skin < found && found < model.skin, "{found} m");
        for k in 1..100 {
            assert!(cost(found) <= cost(f64::from(k) / 50.0 * found) * (1.0 + 1e-12));
        }
    }

    #[test]
    fn it_stays_within_its_limits() {
        // Oracle: the limits; NaN is the worst case.
        let model = model();
        let of = |used: Real| cheapest(&model, &lists(model.skin, 1000), used);
        let equal = |a: Real, b: Real| a.to_bits() == b.to_bits();
        assert!(equal(of(0.0), THINNEST * model.skin));
        assert!(equal(of(1.0), model.skin) && equal(of(Real::NAN), model.skin));
    }

    #[test]
    fn it_is_given_up_once_and_only_if_it_is_much_too_thick() {
        // Oracle: at rest the thinnest is cheapest, and lists that have it are kept.
        let model = model();
        let at_rest = |skin, n| is_too_thick(&model, &lists(skin, n), 0.0);
        assert!(at_rest(model.skin, PROBATION));
        assert!(!at_rest(model.skin, PROBATION - 1) && !at_rest(model.skin, PROBATION + 1));
        assert!(!at_rest(THINNEST * model.skin, PROBATION));
        assert!(!is_too_thick(&model, &lists(model.skin, PROBATION), model.skin));
    }
}
