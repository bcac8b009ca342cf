//! Fig. 11: the force on the object over the whole protocol, row by row.

use super::{
    evaluate::{Judge, View},
    phase::Phase,
    summary::rows,
};
use crate::{
    base::Real,
    experiments::findings::{Expected, Mean, Report},
};

/// Scatter below which the force is as good as constant (N).
const NOISE: Real = 1e-3;

/// The force in one phase of the reference case.
fn force(view: &View<'_>, phase: Phase) -> Option<Vec<Real>> {
    let record = view.record(&view.reference())?;
    Some(rows(record, 0, phase, "force")).filter(|it| !it.is_empty())
}

fn last(view: &View<'_>, phase: Phase) -> Option<Real> {
    force(view, phase)?.last().copied()
}

/// The push where the penetration first reaches `share` of the whole (N).
fn push_at(view: &View<'_>, share: Real) -> Option<Real> {
    let record = view.record(&view.reference())?;
    let at = rows(record, 0, Phase::Insert, "penetration");
    let reached = at.iter().position(|&it| share * view.scene.protocol.penetration <= it)?;
    force(view, Phase::Insert)?.get(reached).map(|it| -it)
}

/// The largest force while the object is still below the bag (N).
fn before_contact(view: &View<'_>) -> Option<Real> {
    let record = view.record(&view.reference())?;
    let at = rows(record, 0, Phase::Insert, "penetration");
    let gap = -0.2 * view.scene.protocol.clearance;
    let force = force(view, Phase::Insert)?;
    let apart = force.iter().zip(&at).filter(|(_, at)| **at < gap);
    Some(apart.map(|(force, _)| force.abs()).fold(0.0, Real::max))
}

/// (a) to (c): nothing, the push, the relaxation.
pub(super) fn push(view: &View<'_>, judge: &mut Judge<'_>) {
    judge.row(
        &Report {
            id: "C9.fig11_zero",
            quantity: "largest force while the object is below the bag",
            unit: "N",
            oracle: "Götz (2024), Fig. 11 (a): no force before contact; the object's weight is no part of it",
            reason: "without contact there is no force, to the last bit",
        },
        Expected::within(0.0, 0.0),
        before_contact(view),
    );
    let full = push_at(view, 0.999);
    judge.row(
        &Report {
            id: "C9.fig11_push",
            quantity: "push at the full penetration over that at half of it",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (b): the push rises all the way",
            reason: "a bound: the figure's numbers cannot be read in the text; 1.5 is half-way to proportional",
        },
        Expected::at_least(1.5),
        full.zip(push_at(view, 0.5)).map(|(full, half)| full / half),
    );
    judge.row(
        &Report {
            id: "C9.fig11_relaxation",
            quantity: "push after the relaxation over push at its beginning",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (c): under a fixed deformation a packing relaxes",
            reason: "2 % for the last wave of the stopping object",
        },
        Expected::at_most(1.02),
        last(view, Phase::Relax).zip(full).map(|(relaxed, push)| -relaxed / push),
    );
}

/// (d) and (e): the evacuation, the pull, the end.
pub(super) fn pull(view: &View<'_>, judge: &mut Judge<'_>) {
    let change = last(view, Phase::Hold).zip(last(view, Phase::Relax));
    judge.row(
        &Report {
            id: "C9.fig11_evacuation",
            quantity: "change of the force on evacuation over the push before it",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (d): the force changes while the pressure falls",
            reason: "a bound: 5 % is many times the change during the relaxation",
        },
        Expected::at_least(0.05),
        change.map(|(held, relaxed)| ((held - relaxed) / relaxed).abs()),
    );
    let noise = force(view, Phase::Hold).map(|it| {
        let late = Mean::new(&it[it.len() / 2..]);
        late.and_then(|it| it.deviation).unwrap_or(0.0).max(NOISE)
    });
    let holding = view.protocol("holding_force");
    judge.row(
        &Report {
            id: "C9.fig11_pull",
            quantity: "holding force over the scatter of the force while nothing moves",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (e): on the way down the force changes its sign and has a maximum",
            reason: "ten times the scatter is no accident; a pull counts positive, so the sign is judged too",
        },
        Expected::at_least(10.0),
        holding.zip(noise).map(|(holding, noise)| holding / noise),
    );
    judge.row(
        &Report {
            id: "C9.fig11_free",
            quantity: "force on the object at the end over the holding force",
            unit: "1",
            oracle: "Götz (2024), Fig. 11 (e): the force drops to zero when the object is free",
            reason: "the last row of the record is the mean over the tick in which the last sample parts",
        },
        Expected::within(0.0, 0.01),
        view.protocol("force_at_end").zip(holding).map(|(end, holding)| end / holding),
    );
}
