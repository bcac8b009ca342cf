//! Density scaling: heavier grains and a heavier membrane bear longer substeps.
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
//! | A, k_diss | dissipation time of contacts, dissipative bending constant | s, N s |
//! | g | gravity, as grains and membrane feel it: their weight stays | m/s² |
//! | v_carrier | velocity of the flange | m/s |
//!
//! Forces, stiffnesses, friction, weights, restitution and all of the objects stay as they are. What
//! changes is how fast grains and membrane follow: waves and rearrangements take √f times as long. The
//! last term moves all of them with the flange, so that hanging on it and being carried on straight
//! ways costs the flange the real mass; turning it costs f times the real moment of inertia.
//!
//! Valid while grips are quasi-static: the inertial number γ̇ d √(f ρ/p) must stay far below one.
//! Source: Thornton & Antony (2000) for grains; the shares of damping and the carried frame are ours.

use std::ops::Deref;

use crate::scene::Scene;

/// A scene as grains and membrane see it under density scaling. Laws, masses and substeps are made
/// from this, so that nothing is scaled twice or not at all.
#[derive(Clone, Debug)]
pub struct ScaledScene(Scene);

impl ScaledScene {
    /// Scales densities and damping of grains and membrane. Objects stay as they are.
    pub fn new(scene: &Scene) -> Self {
        let factor = scene.time.density_scaling;
        let slower = factor.sqrt();
        let mut scaled = scene.clone();
        let Scene { grains, membrane, .. } = &mut scaled;
        grains.material.density *= factor;
        membrane.material.density *= factor;
        grains.dissipation_time *= slower;
        membrane.dissipation_time *= slower;
        membrane.bending_damping *= slower;
        Self(scaled)
    }

    /// The scene as it is.
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

    /// Oracle: the formulas of the file's head. Substeps are whole parts of the tick: one of 44 is the
    /// tolerance.
    #[test]
    fn substeps_get_longer_with_the_root_and_weights_stay() {
        let (plain, heavy) = (compiled(1.0), compiled(25.0));
        let ratio = heavy.model.substep / plain.model.substep;
        assert!((ratio / 5.0 - 1.0).abs() < 1.0 / 44.0, "{ratio}");
        let weight = |it: &Compiled| it.model.membrane.mass() * it.model.gravity.z;
        assert!((weight(&heavy) / weight(&plain) - 1.0).abs() < 1e-12);
        // Objects keep their mass.
        assert_eq!(heavy.bulks[0].mass.to_bits(), plain.bulks[0].mass.to_bits());
    }
}
