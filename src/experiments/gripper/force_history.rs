//! Evaluation of Fig. 11: the force on the object over the whole protocol.

use super::{measure::rows, phase::Phase, results::Results};
use crate::{
    base::Real,
    experiments::findings::{Expected, Findings, Mean, RowText},
};

/// Scatter below which the force counts as constant (N).
const NOISE: Real = 1e-3;

/// The force in one phase of the reference case.
fn force(results: &Results<'_>, phase: Phase) -> Option<Vec<Real>> {
    let record = results.record(&results.reference())?;
    Some(rows(record, 0, phase, "force")).filter(|it| !it.is_empty())
}

fn last(results: &Results<'_>, phase: Phase) -> Option<Real> {
    force(results, phase)?.last().copied()
}

/// The push at which the penetration first reaches `share` of the whole (N).
fn push_at(results: &Results<'_>, share: Real) -> Option<Real> {
    let record = results.record(&results.reference())?;
    let at = rows(record, 0, Phase::Insert, "penetration");
    let reached = at.iter().position(|&it| share * results.scene.protocol.penetration <= it)?;
    force(results, Phase::Insert)?.get(reached).map(|it| -it)
}

/// The largest force while the object is still below the membrane (N).
fn before_contact(results: &Results<'_>) -> Option<Real> {
    let record = results.record(&results.reference())?;
    let at = rows(record, 0, Phase::Insert, "penetration");
    let gap = -0.2 * results.scene.protocol.clearance;
    let force = force(results, Phase::Insert)?;
    let separated = force.iter().zip(&at).filter(|(_, at)| **at < gap);
    Some(separated.map(|(force, _)| force.abs()).fold(0.0, Real::max))
}

/// Parts (a) to (c): no contact, the push, the relaxation.
pub(super) fn push(results: &Results<'_>, findings: &mut Findings) {
    findings.check(
        &RowText {
            id: "C9.fig11_zero",
            quantity: "largest force while the object is below the membrane",
            unit: "N",
            oracle: "Götz (2024), Fig. 11 (a): no force before contact; the object's weight is \
                    not included",
            reason: "exact: without contact there is no force",
        },
        Expected::within(0.0, 0.0),
        before_contact(results),
    );
    let full = push_at(results, 0.999);
    findings.check(
        &RowText {
            id: "C9.fig11_push",
            quantity: "push at full penetration divided by the push at half of it",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (b): the push rises during the whole insertion",
            reason: "a bound: the text gives no numbers for the figure; 1.5 is half-way to \
                    proportionality",
        },
        Expected::at_least(1.5),
        full.zip(push_at(results, 0.5)).map(|(full, half)| full / half),
    );
    findings.check(
        &RowText {
            id: "C9.fig11_relaxation",
            quantity: "push after relaxation divided by the push before it",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (c): at fixed deformation a packing relaxes",
            reason: "2 %: the last stress wave of the stopping object",
        },
        Expected::at_most(1.02),
        last(results, Phase::Relax).zip(full).map(|(relaxed, push)| -relaxed / push),
    );
}

/// Parts (d) and (e): the evacuation, the pull, the end.
pub(super) fn pull(results: &Results<'_>, findings: &mut Findings) {
    let change = last(results, Phase::Hold).zip(last(results, Phase::Relax));
    findings.check(
        &RowText {
            id: "C9.fig11_evacuation",
            quantity: "change of the force during evacuation divided by the push before it",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (d): the force changes while the pressure falls",
            reason: "a bound: 5 % is many times the change during the relaxation",
        },
        Expected::at_least(0.05),
        change.map(|(held, relaxed)| ((held - relaxed) / relaxed).abs()),
    );
    let noise = force(results, Phase::Hold).map(|it| {
        let late = Mean::new(&it[it.len() / 2..]);
        late.and_then(|it| it.deviation).unwrap_or(0.0).max(NOISE)
    });
    let holding = results.protocol("holding_force");
    findings.check(
        &RowText {
            id: "C9.fig11_pull",
            quantity: "holding force divided by the scatter of the force while nothing moves",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (e): during withdrawal the force changes its sign and \
                    has a maximum",
            reason: "ten times the scatter is significant; a pull is positive, so the row also \
                    checks the sign",
        },
        Expected::at_least(10.0),
        holding.zip(noise).map(|(holding, noise)| holding / noise),
    );
    findings.check(
        &RowText {
            id: "C9.fig11_free",
            quantity: "force on the object at the end divided by the holding force",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (e): the force drops to zero when the object is free",
            reason: "the last row of the record is the mean over the tick in which the last \
                    contact opens",
        },
        Expected::within(0.0, 0.01),
        results.protocol("force_at_end").zip(holding).map(|(end, holding)| end / holding),
    );
}
