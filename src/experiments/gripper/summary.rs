//! What a grip amounts to: its end, and its numbers, read from the rows of the record.

use super::{build::Ready, measure, phase::Phase, scene::GripperScene};
use crate::{
    base::{Real, real::real},
    experiments::record::Record,
};

/// Share of the penetration without any pull after which none is to come: without vacuum, the bag
/// pushes the object out all the way.
const NO_PULL_WITHIN: Real = 1.0 / 3.0;

/// Way since the largest pull after which a lesser one is no mere tremble (m).
const PAST_AFTER: Real = 1e-3;

/// True if the grip may end: so much of the largest pull is gone that it is past, or nothing was
/// pulled at all on the first third of the way.
pub(super) fn has_passed(record: &Record, grip: usize, scene: &GripperScene) -> bool {
    let until = scene.accelerations.withdraw_until;
    let force = rows(record, grip, Phase::Withdraw, "force");
    let at = rows(record, grip, Phase::Withdraw, "penetration");
    let best = (0..force.len()).max_by(|&a, &b| force[a].total_cmp(&force[b]));
    if let Some(best) = best.filter(|&k| force[k] > 0.0) {
        let gone_on = at[best] - at[at.len() - 1];
        return gone_on > PAST_AFTER && force[force.len() - 1] < until * force[best];
    }
    let depth = scene.protocol.penetration;
    until > 0.0 && at.last().is_some_and(|&at| at < depth * (1.0 - NO_PULL_WITHIN))
}

/// The values of a column in one phase of one grip.
pub(super) fn rows(record: &Record, grip: usize, phase: Phase, name: &str) -> Vec<Real> {
    let column = |name: &str| record.column(name).unwrap_or(&[]);
    let keys = column("grip").iter().zip(column("phase"));
    let wanted = [real(grip), real(phase as usize)].map(Real::to_bits);
    keys.zip(column(name))
        .filter(|((grip, phase), _)| [grip.to_bits(), phase.to_bits()] == wanted)
        .map(|(_, value)| *value)
        .collect()
}

/// What a grip amounts to, as numbers under its name.
pub(super) fn summarise(record: &mut Record, grip: usize, ready: &Ready) {
    let name = ready.change.name();
    let last = |record: &Record, phase, column: &str| {
        rows(record, grip, phase, column).last().copied().unwrap_or(Real::NAN)
    };
    let pull = rows(record, grip, Phase::Withdraw, "force");
    let best = (0..pull.len()).max_by(|&a, &b| pull[a].total_cmp(&pull[b]));
    let at_best = |column: &str| {
        let values = rows(record, grip, Phase::Withdraw, column);
        best.and_then(|k| values.get(k).copied()).unwrap_or(Real::NAN)
    };
    let friction = ready.scene.gripper.objects[0].friction;
    let normal = last(record, Phase::Hold, "normal_force");
    let angle = last(record, Phase::Hold, "contact_angle");
    let depth = ready.scene.protocol.penetration;
    let numbers = [
        // A grip that ends before the object is free would let it go without any pull.
        ("holding_force", at_best("force").max(0.0), "N"),
        ("holding_distance", depth - at_best("penetration"), "m"),
        ("normal_force_at_best", at_best("normal_force"), "N"),
        ("contact_angle_at_best", at_best("contact_angle"), "rad"),
        ("coulomb_limit_at_best", at_best("coulomb_limit"), "N"),
        ("force_relaxed", last(record, Phase::Relax, "force"), "N"),
        ("force_held", last(record, Phase::Hold, "force"), "N"),
        ("normal_force", normal, "N"),
        ("contact_angle", angle, "rad"),
        ("pinch_force", measure::pinch(normal, angle, friction), "N"),
        ("volume", last(record, Phase::Hold, "volume"), "m^3"),
        ("coordination", last(record, Phase::Hold, "coordination"), "1"),
        ("force_at_end", pull.last().copied().unwrap_or(Real::NAN), "N"),
    ];
    // A grip that begins inserted has not relaxed.
    for (quantity, value, unit) in numbers.into_iter().filter(|it| !it.1.is_nan()) {
        record.set(&format!("{name}.{quantity}"), value, unit);
    }
}
