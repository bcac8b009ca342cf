//! Thickness of the skin. With a thin skin fewer pairs without contact are listed, but lists are rebuilt more often.
//!
//! ```text
//! cost of a substep = 1 + a s / d + b v / s,   least at   s = √(b/a · d v)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | s | skin | m |
//! | d | largest diameter of a grain | m |
//! | v | skin used up per substep | m |
//! | a | additional cost of a substep with s = d, in substeps | – |
//! | b | cost of building the lists, in substeps | – |
//!
//! Source: minimum of the cost. Valid while v is steady from one build to the next. `v` is measured since the last
//! build, without a clock. Results do not depend on which pairs without contact are listed.

use crate::{
    base::Real,
    physics::{Model, scratch::Neighbors},
};

/// b/a, measured with boxes of grains at rest and flowing.
const BUILD_OVER_SKIN: Real = 10.0;
/// Number of substeps after a build at which a skin that is too thick is replaced.
const REVIEW_STEP: u64 = 100;
/// Ratio to the optimal skin from which a skin is too thick.
const TOO_THICK: Real = 2.0;
/// The thinnest skin, as a fraction of that of the model, which is the thickest.
const SKIN_SHARE_MIN: Real = 1.0 / 8.0;

/// The skin (m) with the lowest cost if motion continues as since the last build, during which `used` (m) of the
/// skin was used up.
pub(super) fn optimal(model: &Model, lists: &Neighbors, used: Real) -> Real {
    let n = lists.n_since_build.max(1);
    #[expect(clippy::cast_precision_loss, reason = "a count of substeps")]
    let per_substep = used / n as Real;
    let skin = (BUILD_OVER_SKIN * 2.0 * model.radius_max * per_substep).sqrt();
    // NaN gives the thickest skin.
    if skin < model.skin { skin.max(SKIN_SHARE_MIN * model.skin) } else { model.skin }
}

/// True if lists should be rebuilt with a thinner skin although they are complete.
pub(super) fn is_too_thick(model: &Model, lists: &Neighbors, used: Real) -> bool {
    lists.n_since_build == REVIEW_STEP && TOO_THICK * optimal(model, lists, used) < lists.skin
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

    fn lists(skin: Real, n_since_build: u64) -> Neighbors {
        Neighbors { is_built: true, skin, n_since_build, ..Neighbors::default() }
    }

    /// Oracle: the cost formula above, evaluated for many skins.
    #[test]
    fn the_skin_minimizes_the_cost() {
        let model = model();
        let (diameter, per_substep) = (2.0 * model.radius_max, 2e-7);
        let found = optimal(&model, &lists(model.skin, 1000), 1000.0 * per_substep);
        let cost = |skin: Real| skin / diameter + BUILD_OVER_SKIN * per_substep / skin;
        assert!(SKIN_SHARE_MIN * model.skin < found && found < model.skin, "{found} m");
        for k in 1..100 {
            assert!(cost(found) <= cost(f64::from(k) / 50.0 * found) * (1.0 + 1e-12));
        }
    }

    #[test]
    fn the_skin_stays_within_its_limits() {
        // Oracle: the limits; NaN is the worst case.
        let model = model();
        let of = |used: Real| optimal(&model, &lists(model.skin, 1000), used);
        let equal = |a: Real, b: Real| a.to_bits() == b.to_bits();
        assert!(equal(of(0.0), SKIN_SHARE_MIN * model.skin));
        assert!(equal(of(1.0), model.skin) && equal(of(Real::NAN), model.skin));
    }

    #[test]
    fn a_skin_is_replaced_once_and_only_if_much_too_thick() {
        // Oracle: at rest the thinnest skin is optimal, and lists with it are kept.
        let model = model();
        let at_rest = |skin, n| is_too_thick(&model, &lists(skin, n), 0.0);
        assert!(at_rest(model.skin, REVIEW_STEP));
        assert!(!at_rest(model.skin, REVIEW_STEP - 1) && !at_rest(model.skin, REVIEW_STEP + 1));
        assert!(!at_rest(SKIN_SHARE_MIN * model.skin, REVIEW_STEP));
        assert!(!is_too_thick(&model, &lists(model.skin, REVIEW_STEP), model.skin));
    }
}
