//! The cases: which grips belong together, what each of them varies, and from which state it
//! starts.
//!
//! A case is one filling. Its grips share the settled state, and those that differ only from the
//! relaxed state on also share the insertion, so that the scatter between fillings does not affect
//! comparisons.

use super::scene::GripperScene;
use crate::base::{Real, real::real};

/// One filling and its grips.
#[derive(Clone, Debug)]
pub(super) struct Case {
    /// Name of the case.
    pub(super) name: String,
    /// Index of the filling; added to the scene's seed.
    pub(super) filling: usize,
    /// Modulus of the grains (Pa).
    pub(super) modulus: Real,
    /// Number of grains.
    pub(super) count: usize,
    /// The grips, in their order.
    pub(super) grips: Vec<Grip>,
}

/// A grip: what differs from the protocol.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grip {
    /// What is varied.
    pub(super) change: Change,
    /// True if it starts from the relaxed state of the case's first grip, with the object inserted.
    pub(super) is_inserted: bool,
}

/// What a grip varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    /// Nothing.
    Nothing,
    /// Another gauge pressure (Pa).
    Pressure(Real),
    /// Another friction of the object.
    Friction(Real),
    /// Another radius of the object (m).
    Radius(Real),
    /// Another damping ratio of the membrane's springs.
    SpringDamping(Real),
    /// Both speeds of the object multiplied by this factor.
    Slowdown(Real),
}

impl Change {
    /// Name, a part of the names of recorded numbers.
    pub(super) fn name(self) -> String {
        match self {
            Self::Nothing => "protocol".to_owned(),
            Self::Pressure(pressure) => {
                format!("pressure_{}", rounded(pressure.abs() / 1e3, "kPa"))
            }
            Self::Friction(friction) => format!("friction_{}", rounded(friction, "")),
            Self::Radius(radius) => format!("radius_{}", rounded(radius * 1e3, "mm")),
            Self::SpringDamping(ratio) => format!("spring_damping_{}", rounded(ratio, "")),
            Self::Slowdown(factor) => format!("slowdown_{}", rounded(factor, "")),
        }
    }

    /// The scene with this change.
    pub(super) fn apply(self, scene: &GripperScene) -> GripperScene {
        let mut changed = scene.clone();
        match self {
            Self::Nothing => {}
            Self::Pressure(pressure) => changed.protocol.pressure = pressure,
            Self::Friction(friction) => changed.gripper.object.friction = friction,
            Self::Radius(radius) => changed.gripper.object.radius = radius,
            Self::SpringDamping(ratio) => changed.gripper.membrane.spring_damping = ratio,
            Self::Slowdown(factor) => {
                changed.accelerations.insert_speed_factor *= factor;
                changed.accelerations.withdraw_speed_factor *= factor;
            }
        }
        changed
    }
}

/// All cases of a scene.
pub(super) fn cases(scene: &GripperScene) -> Vec<Case> {
    let mut cases = over_modulus(scene);
    let grains = &scene.gripper.grains;
    let (modulus, count) = (grains.material.youngs_modulus, grains.count);
    let radii = others(&scene.sweep.radii, scene.gripper.object.radius).map(Change::Radius);
    let mut families = vec![("radius", radii.collect::<Vec<_>>())];
    if !scene.accelerations.is_varied_relaxed {
        families.push(("history", variations(scene)));
    }
    for (family, changes) in families {
        if !changes.is_empty() {
            let grips = changes.into_iter().map(Grip::from_settled).collect();
            let name = format!("{family}_filling_0");
            cases.push(Case { name, filling: 0, modulus, count, grips });
        }
    }
    for count in counts(scene) {
        let (name, grips) = (count_name(count), vec![Grip::from_settled(Change::Nothing)]);
        cases.push(Case { name, filling: 0, modulus, count, grips });
    }
    cases
}

/// Changes that may also start from the relaxed state.
fn variations(scene: &GripperScene) -> Vec<Change> {
    let (own, sweep) = (&scene.gripper, &scene.sweep);
    others(&sweep.frictions, own.object.friction)
        .map(Change::Friction)
        .chain(
            others(&sweep.spring_dampings, own.membrane.spring_damping).map(Change::SpringDamping),
        )
        .chain(others(&sweep.slowdowns, 1.0).map(Change::Slowdown))
        .collect()
}

/// The protocol for each modulus and filling. The first filling of the reference modulus also
/// covers other pressures and everything that is varied from the relaxed state on.
fn over_modulus(scene: &GripperScene) -> Vec<Case> {
    let own = &scene.gripper.grains;
    let mut cases = Vec::new();
    for modulus in moduli(scene) {
        for filling in 0..scene.sweep.n_fillings {
            let mut changes = Vec::new();
            if filling == 0 && is_same(modulus, own.material.youngs_modulus) {
                let pressures = others(&scene.sweep.pressures, scene.protocol.pressure);
                changes.extend(pressures.map(Change::Pressure));
                if scene.accelerations.is_varied_relaxed {
                    changes.extend(variations(scene));
                }
            }
            let mut grips = vec![Grip::from_settled(Change::Nothing)];
            grips.extend(changes.into_iter().map(|change| Grip { change, is_inserted: true }));
            let name = modulus_name(modulus, filling);
            cases.push(Case { name, filling, modulus, count: own.count, grips });
        }
    }
    cases
}

/// Run time of a grip of 4200 soft grains at ten times the source's speed, on one thread of a
/// machine of 2026 (s); the filling takes half of it.
const GRIP_S: Real = 35.0;
/// Modulus above which the grains, not the membrane, limit the substep (Pa).
const HARD: Real = 3.2e7;

impl Case {
    /// Expected run time on one thread (s).
    pub(super) fn expected_s(&self, scene: &GripperScene) -> Real {
        let size = real(self.count) / 4200.0;
        let hardness = (self.modulus / HARD).sqrt().max(1.0);
        let speed = 10.0 / scene.accelerations.insert_speed_factor;
        let slowness = |grip: &Grip| match grip.change {
            Change::Slowdown(factor) => 1.0 / factor,
            _ => 1.0,
        };
        // Without insertion it takes a third.
        let share = |grip: &Grip| if grip.is_inserted { 1.0 / 3.0 } else { 1.0 };
        let grips: Real = self.grips.iter().map(|grip| slowness(grip) * share(grip)).sum();
        GRIP_S * size * hardness * (0.5 + speed * grips)
    }
}

impl Grip {
    fn from_settled(change: Change) -> Self {
        Self { change, is_inserted: false }
    }
}

/// All moduli including the reference, rising (Pa).
pub(super) fn moduli(scene: &GripperScene) -> Vec<Real> {
    let reference = scene.gripper.grains.material.youngs_modulus;
    let mut moduli: Vec<Real> = others(&scene.sweep.moduli, reference).collect();
    moduli.push(reference);
    moduli.sort_by(Real::total_cmp);
    moduli
}

/// Numbers of grains other than the reference.
pub(super) fn counts(scene: &GripperScene) -> Vec<usize> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the scene's limits keep it between 1 and 200 000"
    )]
    let rounded = |it: &Real| it.round() as usize;
    let counts = scene.sweep.counts.iter().map(rounded);
    counts.filter(|&it| it != scene.gripper.grains.count).collect()
}

/// The values that differ from the reference.
pub(super) fn others(values: &[Real], reference: Real) -> impl Iterator<Item = Real> {
    values.iter().copied().filter(move |&it| !is_same(it, reference))
}

/// True for values that were written equally.
fn is_same(a: Real, b: Real) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
}

/// Name of the case of a modulus and a filling.
pub(super) fn modulus_name(modulus: Real, filling: usize) -> String {
    format!("modulus_{}_filling_{filling}", modulus_text(modulus))
}

/// Name of the case of a number of grains.
pub(super) fn count_name(count: usize) -> String {
    format!("count_{count}_filling_0")
}

/// A modulus in a name.
pub(super) fn modulus_text(modulus: Real) -> String {
    if modulus < 1e9 { rounded(modulus / 1e6, "MPa") } else { rounded(modulus / 1e9, "GPa") }
}

/// A number without the rounding error of its last digits.
fn rounded(value: Real, unit: &str) -> String {
    format!("{}{unit}", (value * 1e6).round() / 1e6)
}
