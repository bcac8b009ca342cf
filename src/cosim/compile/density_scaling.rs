//! Density scaling: heavier grains and a heavier membrane allow longer substeps.
//!
//! ```text
//! ρ → f ρ,   A → √f A,   k_diss → √f k_diss,   g → g/f        and so  dt → √f dt
//!
//! dv/dt = F/(f m) + g/f + (1 − 1/f) dv_carrier/dt
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | f | `time.density_scaling` | – |
//! | ρ, m | density and mass of grains and membrane | kg/m³, kg |
//! | A, k_diss | dissipation time of contacts, viscous bending constant | s, N s |
//! | g | gravity that acts on grains and membrane: their weight stays | m/s² |
//! | v_carrier | velocity of the flange | m/s |
//!
//! Forces, stiffnesses, friction, weights, restitution and the objects do not change. Only the dynamics
//! of grains and membrane become slower: waves and rearrangements take √f times as long. The last term
//! moves grains and membrane with the flange. The flange therefore carries and accelerates the real mass
//! in translation, but f times the real moment of inertia in rotation.
//!
//! Valid for quasi-static grips: the inertial number γ̇ d √(f ρ/p) must stay far below one.
//! Source: Thornton & Antony (2000) for grains; the scaling of the damping and the moving frame are ours.

use std::ops::Deref;

use crate::scene::Scene;

/// A scene with density scaling applied to grains and membrane. Laws, masses and substeps are computed
/// from it; the type prevents scaling twice and unscaled use.
#[derive(Clone, Debug)]
pub struct ScaledScene(Scene);

impl ScaledScene {
    /// Scales densities and damping of grains and membrane, but not the objects.
    pub fn new(scene: &Scene) -> Self {
        let factor = scene.time.density_scaling;
        let time_factor = factor.sqrt();
        let mut scaled = scene.clone();
        let Scene { grains, membrane, .. } = &mut scaled;
        grains.material.density *= factor;
        membrane.material.density *= factor;
        grains.dissipation_time *= time_factor;
        membrane.dissipation_time *= time_factor;
        membrane.bending_damping *= time_factor;
        Self(scaled)
    }

    /// The scene without scaling.
    pub(super) fn unscaled(scene: &Scene) -> Self {
        Self(scene.clone())
    }
}

impl Deref for ScaledScene {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        base::{Real, parallel},
        cosim::compile::Compiled,
    };

    fn compiled(scaling: Real) -> Compiled {
        let sets = [format!("time.density_scaling={scaling}"), "time.tick=5 ms".to_owned()];
        let text = "name: heavy\nobject: { shape: { sphere: { radius: 10 mm } }, position: [0 m, 0 m, 10 mm] }";
        let folder = std::path::Path::new("");
        let scene = crate::scene::parse(text, "heavy.yaml", folder, &sets).unwrap();
        Compiled::new(&scene, &parallel::ThreadPool::new(1).unwrap()).unwrap()
    }

    /// Oracle: the formulas at the top of this file. The tick is an integer number of substeps: the
    /// tolerance is one of 44.
    #[test]
    fn substeps_grow_with_the_square_root_and_weights_stay() {
        let (plain, heavy) = (compiled(1.0), compiled(25.0));
        let ratio = heavy.model.substep / plain.model.substep;
        assert!((ratio / 5.0 - 1.0).abs() < 1.0 / 44.0, "{ratio}");
        let weight = |it: &Compiled| it.model.membrane.mass() * it.model.gravity.z;
        assert!((weight(&heavy) / weight(&plain) - 1.0).abs() < 1e-12);
        // The mass of objects does not change.
        assert_eq!(heavy.bulks[0].mass.to_bits(), plain.bulks[0].mass.to_bits());
    }
}
