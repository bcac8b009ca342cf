//! Evaluation of the records, row by row.

use super::{
    cases::{self, Case, Change},
    force_history, measure, plots,
    results::Results,
    scene::GripperScene,
};
use crate::{
    base::Real,
    experiments::{
        findings::{Expected, Findings, RowText},
        record::Record,
    },
};

/// Possible cause of the failure of a check that starts from the settled state.
const HISTORY: &str = "with vary_relaxed false the two insertions displace the grains \
                      differently; 10 % less speed changes the holding force as much as 50 % \
                      less, so this is scatter and not a rate effect: compare means over fillings";
/// Relative difference below which two holding forces of one filling count as equal.
const SAME: Real = 0.1;

/// All findings.
pub(super) fn findings(scene: &GripperScene, cases: &[Case], records: &[Record]) -> Findings {
    let results = Results { scene, records };
    let mut findings = Findings::default();
    force_history::push(&results, &mut findings);
    force_history::pull(&results, &mut findings);
    over_modulus(&results, &mut findings);
    over_pressure(&results, &mut findings);
    over_object(&results, &mut findings);
    over_count(&results, &mut findings);
    checks(&results, &mut findings);
    plots::add(&results, &mut findings);
    findings.notes.extend(notes(cases, records));
    findings
}

/// Adds a row that names its most likely `cause` if it fails.
fn check_with_cause(
    findings: &mut Findings,
    text: &RowText<'_>,
    expected: Expected,
    measured: Option<Real>,
    cause: &str,
) {
    let reason = format!("{}. Most likely cause: {cause}", text.reason);
    let fails = measured.is_some_and(|it| !expected.holds(it));
    let reason = if fails { &reason } else { text.reason };
    findings.check(&RowText { reason, ..*text }, expected, measured);
}

/// The smallest rise from one point to the next over the largest value; `None` of a single point.
fn smallest_rise(points: &[[Real; 2]]) -> Option<Real> {
    let largest = points.iter().map(|it| it[1].abs()).fold(0.0, Real::max);
    let rises = points.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / largest);
    (points.len() > 1).then(|| rises.fold(Real::INFINITY, Real::min))
}

/// Fig. 12: the holding force over the grains' modulus.
fn over_modulus(results: &Results<'_>, findings: &mut Findings) {
    let moduli = cases::moduli(results.scene);
    let of = |modulus: Option<&Real>| results.of_modulus(*modulus?, "holding_force");
    let ends = of(moduli.first()).zip(of(moduli.last()));
    findings.check(
        &RowText {
            id: "C9.falls_with_modulus",
            quantity: "holding force of the softest grains divided by that of the hardest",
            unit: "1",
            oracle: "Götz (2024), Fig. 12: large with soft grains, small with hard ones",
            reason: "a bound: the text gives no factor; 1.5 exceeds the scatter between fillings",
        },
        Expected::at_least(1.5),
        ends.map(|(soft, hard)| soft.value / hard.value),
    );
    let several = ends.filter(|(soft, hard)| soft.n > 1 && hard.n > 1);
    if several.is_some() {
        findings.check(
            &RowText {
                id: "C9.falls_beyond_scatter",
                quantity: "difference between the holding forces of the softest and the hardest \
                          grains divided by its standard error",
                unit: "1",
                oracle: "Götz (2024), Fig. 12",
                reason: "three standard errors",
            },
            Expected::at_least(3.0),
            several.map(|(soft, hard)| {
                (soft.value - hard.value) / soft.error().hypot(hard.error()).max(1e-12)
            }),
        );
    }
    let points: Vec<[Real; 2]> = moduli
        .iter()
        .rev()
        .filter_map(|&it| Some([it, results.of_modulus(it, "holding_force")?.value]))
        .collect();
    if points.len() > 2 {
        findings.check(
            &RowText {
                id: "C9.falls_steadily",
                quantity: "smallest rise of the holding force to the next softer grains, divided \
                          by its largest value",
                unit: "1",
                oracle: "Götz (2024), Fig. 12: it falls with the modulus over the whole range \
                        above 5 MPa",
                reason: "neighboring values may differ by less than the scatter between fillings, \
                        a tenth of the largest value",
            },
            Expected::at_least(-SAME),
            smallest_rise(&points),
        );
    }
    let hard: Vec<Real> = moduli.iter().copied().filter(|&it| 1e9 <= it).collect();
    if let [.., a, b] = hard.as_slice() {
        let pair =
            results.of_modulus(*a, "holding_force").zip(results.of_modulus(*b, "holding_force"));
        findings.check(
            &RowText {
                id: "C9.hard_plateau",
                quantity: "difference between the holding forces of the two hardest grains \
                          divided by that of the softest",
                unit: "1",
                oracle: "Gómez-Paccapelo et al. (2020): with friction alone, the force does not \
                        depend on the stiffness of hard grains",
                reason: "the scatter between fillings, a tenth of the largest force",
            },
            Expected::within(0.0, SAME),
            pair.zip(ends).map(|((a, b), (soft, _))| (a.value - b.value) / soft.value),
        );
    }
}

/// The vacuum.
fn over_pressure(results: &Results<'_>, findings: &mut Findings) {
    let points = results.over_pressure();
    findings.check(
        &RowText {
            id: "C9.rises_with_vacuum",
            quantity: "smallest rise of the holding force to the next stronger vacuum, divided by \
                      its largest value",
            unit: "1",
            oracle: "Brown et al. (2010) and all later grippers: a stronger vacuum gives a larger \
                    holding force",
            reason: "all grips start from one relaxed state, so there is no scatter between \
                    fillings",
        },
        Expected::at_least(0.0),
        smallest_rise(&points),
    );
    let full = points.last().copied();
    let none = points.first().copied().filter(|it| it[0].abs() < 1.0);
    findings.check(
        &RowText {
            id: "C9.no_vacuum",
            quantity: "holding force without vacuum divided by that at full vacuum",
            unit: "1",
            oracle: "no jamming without vacuum: only the pre-tension of the membrane remains",
            reason: "the pre-tension compresses the grains by about 10 kPa, a tenth of the vacuum",
        },
        Expected::within(0.0, 0.15),
        none.zip(full).map(|(none, full)| none[1] / full[1]),
    );
    let weak = points.iter().copied().find(|it| it[0] > 1.0);
    let weak = weak.filter(|it| full.is_some_and(|full| it[0] < full[0]));
    check_with_cause(
        findings,
        &RowText {
            id: "C9.proportional_to_vacuum",
            quantity: "holding force per vacuum at the weakest level divided by that at the \
                      strongest",
            unit: "1",
            oracle: "stresses of jammed hard grains scale with the pressure; published curves are \
                    roughly linear and saturate",
            reason: "20 %: soft grains change their shape with the pressure",
        },
        Expected::within(1.0, 0.2),
        weak.zip(full).map(|(weak, full)| weak[1] / weak[0] / (full[1] / full[0])),
        "the stretched membrane pushes the object out, and a weaker vacuum leaves more of that \
        push: it must be unloaded over a longer distance before there is any pull, and by then \
        the contact angle has decreased to near the threshold (columns force and contact_angle of \
        the record)",
    );
}

/// Friction and size of the object.
fn over_object(results: &Results<'_>, findings: &mut Findings) {
    findings.check(
        &RowText {
            id: "C9.rises_with_friction",
            quantity: "smallest rise of the holding force to the next higher friction, divided by \
                      its largest value",
            unit: "1",
            oracle: "pinch formula: F_h = 2 π R² p_n [μ (θ/2 − sin 2θ/4) − ½ sin² θ] rises with μ",
            reason: "all grips start from one settled state; below the threshold both forces are \
                    zero",
        },
        Expected::at_least(0.0),
        smallest_rise(&results.over_friction()),
    );
    let friction = results.scene.gripper.object.friction;
    findings.check(
        &RowText {
            id: "C9.pinch_threshold",
            quantity: "contact angle of the grip at its largest pull divided by the smallest at \
                      which friction holds",
            unit: "1",
            oracle: "pinch formula with uniform pressure: 60.8° at μ = 1.2",
            reason: "a bound: below that angle friction could not hold anything",
        },
        Expected::at_least(1.0),
        results.protocol("contact_angle_at_best").map(|it| it / measure::pinch_threshold(friction)),
    );
    findings.check(
        &RowText {
            id: "C9.coulomb_limit",
            quantity: "holding force divided by the Coulomb limit with the normal forces at that \
                      time",
            unit: "1",
            oracle: "|F_t| ≤ μ F_n at every sample of the membrane: F ≤ Σ F_n (μ sin θ − cos θ)",
            reason: "5 %: the force is the mean over a tick, the limit is taken at its end",
        },
        Expected::at_most(1.05),
        results
            .protocol("holding_force")
            .zip(results.protocol("coulomb_limit_at_best"))
            .map(|(force, limit)| force / limit),
    );
}

/// The number of grains.
fn over_count(results: &Results<'_>, findings: &mut Findings) {
    let push: Vec<[Real; 2]> =
        results.over_count("force_relaxed").into_iter().map(|[n, force]| [n, -force]).collect();
    if push.len() < 2 {
        return;
    }
    findings.check(
        &RowText {
            id: "C9.push_rises_with_filling",
            quantity: "smallest rise of the push after relaxation to the next higher filling, \
                      divided by its largest value",
            unit: "1",
            oracle: "Kremer et al. (2022): the filling level controls the activation force",
            reason: "a sign",
        },
        Expected::at_least(0.0),
        smallest_rise(&push),
    );
}

/// Parameters that the holding force must not depend on.
fn checks(results: &Results<'_>, findings: &mut Findings) {
    let own = results.protocol("holding_force");
    let ratio = |change| results.changed(change, "holding_force").zip(own);
    let sweep = &results.scene.sweep;
    let spring_damping = results.scene.gripper.membrane.spring_damping;
    let dampings = cases::others(&sweep.spring_dampings, spring_damping).map(|it| {
        (
            Change::SpringDamping(it),
            "holding force with this damping ratio of the membrane's springs divided by that of \
            the protocol",
            "a quasi-static result does not depend on damping; the source's membranes have 0.3 and 0.15",
        )
    });
    let slowdowns = cases::others(&sweep.slowdowns, 1.0).map(|it| {
        (
            Change::Slowdown(it),
            "holding force with both speeds multiplied by this factor, divided by that of the \
            protocol",
            "the accelerated protocol is valid if a slower one gives the same result",
        )
    });
    for (change, quantity, oracle) in dampings.chain(slowdowns) {
        check_with_cause(
            findings,
            &RowText {
                id: &format!("C9.{}", change.name()),
                quantity,
                unit: "1",
                oracle,
                reason: "10 %: the scatter between two histories of one filling",
            },
            Expected::within(1.0, SAME),
            ratio(change).map(|(changed, own)| changed / own),
            HISTORY,
        );
    }
}

fn notes(cases: &[Case], records: &[Record]) -> Vec<String> {
    let mut notes = vec![
        "The source does not give the number of grains. It fills the membrane while it is held at \
        1.25 radii, \"to insert more granulate\"; the scene takes as many grains as fit into that \
        volume."
            .to_owned(),
        "There is no suction between membrane and object, as in the source: F_h is due to \
        friction and shape only."
            .to_owned(),
    ];
    for record in records.iter().filter(|it| cases.iter().any(|case| case.name == it.case)) {
        for violation in record.validity.violations() {
            notes.push(format!("{}: {violation}", record.case));
        }
    }
    notes
}
