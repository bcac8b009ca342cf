//! What the records show, row by row.

use super::{
    cases::{self, Case, Change},
    force_history, measure, plots,
    scene::GripperScene,
};
use crate::{
    base::{Real, real::real},
    experiments::{
        findings::{Expected, Findings, Mean, Report, Row},
        record::Record,
    },
};

/// Why a check from the settled bag on may fail.
const HISTORY: &str = "with vary_relaxed false the two insertions push the grains aside in different \
                       ways; a tenth less speed moves the holding force as much as half the speed \
                       does, so this is scatter and not a rate: compare means over fillings";
/// Below this, two holding forces of the same filling are not told apart.
const SAME: Real = 0.1;

/// All findings.
pub(super) fn findings(scene: &GripperScene, cases: &[Case], records: &[Record]) -> Findings {
    let view = View { scene, records };
    let mut findings = Findings::default();
    let mut judge = Judge { findings: &mut findings };
    force_history::push(&view, &mut judge);
    force_history::pull(&view, &mut judge);
    over_modulus(&view, &mut judge);
    over_pressure(&view, &mut judge);
    over_object(&view, &mut judge);
    over_count(&view, &mut judge);
    checks(&view, &mut judge);
    plots::add(&view, &mut findings);
    findings.notes.extend(notes(cases, records));
    findings
}

/// Scene and records.
pub(super) struct View<'a> {
    pub(super) scene: &'a GripperScene,
    pub(super) records: &'a [Record],
}

impl View<'_> {
    /// The record of a case.
    pub(super) fn record(&self, case: &str) -> Option<&Record> {
        self.records.iter().find(|it| it.case == case)
    }

    /// Name of the case that shows the whole protocol.
    pub(super) fn reference(&self) -> String {
        cases::modulus_name(self.scene.gripper.grains.material.youngs_modulus, 0)
    }

    /// What a grip of a case amounts to.
    pub(super) fn number(&self, case: &str, change: Change, quantity: &str) -> Option<Real> {
        self.record(case)?.scalar(&format!("{}.{quantity}", change.name()))
    }

    /// What the grip with this change amounts to, in whichever case it was done.
    pub(super) fn changed(&self, change: Change, quantity: &str) -> Option<Real> {
        let name = format!("{}.{quantity}", change.name());
        self.records.iter().find_map(|record| record.scalar(&name))
    }

    /// What the protocol amounts to in the reference case.
    pub(super) fn protocol(&self, quantity: &str) -> Option<Real> {
        self.number(&self.reference(), Change::Nothing, quantity)
    }

    /// A quantity of the protocol over all fillings of a modulus.
    pub(super) fn of_modulus(&self, modulus: Real, quantity: &str) -> Option<Mean> {
        let of = |filling| {
            self.number(&cases::modulus_name(modulus, filling), Change::Nothing, quantity)
        };
        Mean::new(&(0..self.scene.sweep.n_fillings).filter_map(of).collect::<Vec<_>>())
    }

    /// Holding force over what `changes` vary, the protocol at `reference` among them: rising.
    fn series(
        &self,
        changes: impl Iterator<Item = (Real, Change)>,
        reference: Real,
    ) -> Vec<[Real; 2]> {
        let quantity = "holding_force";
        let varied = changes.filter_map(|(at, change)| Some([at, self.changed(change, quantity)?]));
        let own = self.protocol(quantity).map(|it| [reference, it]);
        let mut points: Vec<[Real; 2]> = varied.chain(own).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }

    /// Holding force over vacuum, positive (Pa), (N).
    pub(super) fn over_pressure(&self) -> Vec<[Real; 2]> {
        let own = self.scene.protocol.pressure;
        let varied = cases::others(&self.scene.sweep.pressures, own);
        let changes = varied.map(|it| (it.abs(), Change::Pressure(it)));
        self.series(changes, -own)
    }

    /// Holding force over the object's friction.
    pub(super) fn over_friction(&self) -> Vec<[Real; 2]> {
        let own = self.scene.gripper.objects[0].friction;
        let varied = cases::others(&self.scene.sweep.frictions, own);
        let changes = varied.map(|it| (it, Change::Friction(it)));
        self.series(changes, own)
    }

    /// Holding force over the object's radius (m), (N).
    pub(super) fn over_radius(&self) -> Vec<[Real; 2]> {
        let own = self.scene.object_radius();
        let varied = cases::others(&self.scene.sweep.radii, own);
        let changes = varied.map(|it| (it, Change::Radius(it)));
        self.series(changes, own)
    }

    /// A quantity of the protocol over the number of grains.
    pub(super) fn over_count(&self, quantity: &str) -> Vec<[Real; 2]> {
        let counts = cases::counts(self.scene).into_iter();
        let varied = counts.filter_map(|it| {
            let found = self.number(&cases::count_name(it), Change::Nothing, quantity)?;
            Some([real(it), found])
        });
        let own = self.protocol(quantity).map(|it| [real(self.scene.gripper.grains.count), it]);
        let mut points: Vec<[Real; 2]> = varied.chain(own).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }
}

/// Collects the rows.
pub(super) struct Judge<'a> {
    findings: &'a mut Findings,
}

impl Judge<'_> {
    /// Sets a measured value beside what is expected; without one, a note says so.
    pub(super) fn row(&mut self, told: &Report<'_>, expected: Expected, measured: Option<Real>) {
        self.row_or(told, expected, measured, "");
    }

    /// The same; `cause` is told if the row fails.
    fn row_or(
        &mut self,
        told: &Report<'_>,
        expected: Expected,
        measured: Option<Real>,
        cause: &str,
    ) {
        match measured {
            Some(measured) => {
                let mut row = Row::new(told, expected, measured);
                if !row.pass && !cause.is_empty() {
                    row.reason = format!("{}. Most likely cause: {cause}", row.reason);
                }
                self.findings.rows.push(row);
            }
            None => {
                let note = format!("{} is left out: its cases were not run or failed", told.id);
                self.findings.notes.push(note);
            }
        }
    }
}

/// The smallest rise from one point to the next over the largest value; `None` of a single point.
fn smallest_rise(points: &[[Real; 2]]) -> Option<Real> {
    let largest = points.iter().map(|it| it[1].abs()).fold(0.0, Real::max);
    let rises = points.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / largest);
    (points.len() > 1).then(|| rises.fold(Real::INFINITY, Real::min))
}

/// Fig. 12: the holding force over the grains' modulus.
fn over_modulus(view: &View<'_>, judge: &mut Judge<'_>) {
    let moduli = cases::moduli(view.scene);
    let of = |modulus: Option<&Real>| view.of_modulus(*modulus?, "holding_force");
    let ends = of(moduli.first()).zip(of(moduli.last()));
    judge.row(
        &Report {
            id: "C9.falls_with_modulus",
            quantity: "holding force of the softest grains over that of the hardest",
            unit: "1",
            oracle: "Götz (2024), Fig. 12: large with soft grains, small with hard ones",
            reason: "a bound: the factor cannot be read in the text; 1.5 is beyond the scatter between fillings",
        },
        Expected::at_least(1.5),
        ends.map(|(soft, hard)| soft.value / hard.value),
    );
    let several = ends.filter(|(soft, hard)| soft.n > 1 && hard.n > 1);
    if several.is_some() {
        judge.row(
            &Report {
                id: "C9.falls_beyond_scatter",
                quantity: "difference of the holding forces of softest and hardest grains over its standard error",
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
        .filter_map(|&it| Some([it, view.of_modulus(it, "holding_force")?.value]))
        .collect();
    if points.len() > 2 {
        judge.row(
            &Report {
                id: "C9.falls_steadily",
                quantity: "smallest rise of the holding force to the next softer grains, over its largest value",
                unit: "1",
                oracle: "Götz (2024), Fig. 12: it falls with the modulus throughout, from 5 MPa on",
                reason: "neighbours may differ by less than the scatter between fillings, a tenth of the largest value",
            },
            Expected::at_least(-SAME),
            smallest_rise(&points),
        );
    }
    let hard: Vec<Real> = moduli.iter().copied().filter(|&it| 1e9 <= it).collect();
    if let [.., a, b] = hard.as_slice() {
        let pair = view.of_modulus(*a, "holding_force").zip(view.of_modulus(*b, "holding_force"));
        judge.row(
            &Report {
                id: "C9.hard_plateau",
                quantity: "difference of the holding forces of the two hardest grains over that of the softest",
                unit: "1",
                oracle: "Gómez-Paccapelo et al. (2020): with friction alone, the force does not depend on the material of hard grains",
                reason: "the scatter between fillings, a tenth of the largest force",
            },
            Expected::within(0.0, SAME),
            pair.zip(ends).map(|((a, b), (soft, _))| (a.value - b.value) / soft.value),
        );
    }
}

/// The vacuum level.
fn over_pressure(view: &View<'_>, judge: &mut Judge<'_>) {
    let points = view.over_pressure();
    judge.row(
        &Report {
            id: "C9.rises_with_vacuum",
            quantity: "smallest rise of the holding force to the next stronger vacuum, over its largest value",
            unit: "1",
            oracle: "Brown et al. (2010) and all grippers since: more vacuum holds more",
            reason: "all from one relaxed state, so that no scatter between fillings enters",
        },
        Expected::at_least(0.0),
        smallest_rise(&points),
    );
    let full = points.last().copied();
    let none = points.first().copied().filter(|it| it[0].abs() < 1.0);
    judge.row(
        &Report {
            id: "C9.no_vacuum",
            quantity: "holding force without vacuum over that at full vacuum",
            unit: "1",
            oracle: "no vacuum, no jamming: what is left is the membrane's pre-tension",
            reason: "the pre-tension presses the grains with some 10 kPa, a tenth of the vacuum",
        },
        Expected::within(0.0, 0.15),
        none.zip(full).map(|(none, full)| none[1] / full[1]),
    );
    let weak = points.iter().copied().find(|it| it[0] > 1.0);
    let weak = weak.filter(|it| full.is_some_and(|full| it[0] < full[0]));
    judge.row_or(
        &Report {
            id: "C9.proportional_to_vacuum",
            quantity: "holding force per vacuum at the weakest level over that at the strongest",
            unit: "1",
            oracle: "stresses of jammed hard grains scale with the pressure; published as about linear, saturating",
            reason: "20 %: soft grains change their shape with the pressure",
        },
        Expected::within(1.0, 0.2),
        weak.zip(full).map(|(weak, full)| weak[1] / weak[0] / (full[1] / full[0])),
        "the stretched membrane pushes the object out, and a weaker vacuum leaves more of that push: \
         it has to be unloaded over a longer way before anything is pulled, and by then the contact \
         angle has come down to near the threshold (columns force and contact_angle of the record)",
    );
}

/// Friction and size of the object.
fn over_object(view: &View<'_>, judge: &mut Judge<'_>) {
    judge.row(
        &Report {
            id: "C9.rises_with_friction",
            quantity: "smallest rise of the holding force to the next higher friction, over its largest value",
            unit: "1",
            oracle: "pinch formula: F_h = 2 π R² p_n [μ (θ/2 − sin 2θ/4) − ½ sin² θ] rises with μ",
            reason: "all from one settled bag; below the threshold both forces are zero",
        },
        Expected::at_least(0.0),
        smallest_rise(&view.over_friction()),
    );
    let friction = view.scene.gripper.objects[0].friction;
    judge.row(
        &Report {
            id: "C9.pinch_threshold",
            quantity: "contact angle of the grip at its largest pull, over the least that holds by friction",
            unit: "1",
            oracle: "pinch formula under even pressure: 60.8° at μ = 1.2",
            reason: "a bound: below it nothing could be held by friction, and something is held",
        },
        Expected::at_least(1.0),
        view.protocol("contact_angle_at_best").map(|it| it / measure::pinch_threshold(friction)),
    );
    judge.row(
        &Report {
            id: "C9.coulomb_limit",
            quantity: "holding force over what Coulomb friction allows with the normal forces of that instant",
            unit: "1",
            oracle: "|F_t| ≤ μ F_n at every sample of the sheet: F ≤ Σ F_n (μ sin θ − cos θ)",
            reason: "5 %: the force is the mean over a tick, the limit that of its end",
        },
        Expected::at_most(1.05),
        view.protocol("holding_force")
            .zip(view.protocol("coulomb_limit_at_best"))
            .map(|(force, limit)| force / limit),
    );
}

/// The filling level.
fn over_count(view: &View<'_>, judge: &mut Judge<'_>) {
    let push: Vec<[Real; 2]> =
        view.over_count("force_relaxed").into_iter().map(|[n, force]| [n, -force]).collect();
    if push.len() < 2 {
        return;
    }
    judge.row(
        &Report {
            id: "C9.push_rises_with_filling",
            quantity: "smallest rise of the push after relaxation to the next fuller bag, over its largest value",
            unit: "1",
            oracle: "Kremer et al. (2022): the filling level controls the activation force",
            reason: "a sign",
        },
        Expected::at_least(0.0),
        smallest_rise(&push),
    );
}

/// What the holding force must not depend on.
fn checks(view: &View<'_>, judge: &mut Judge<'_>) {
    let own = view.protocol("holding_force");
    let ratio = |change| view.changed(change, "holding_force").zip(own);
    let sweep = &view.scene.sweep;
    let spring_damping = view.scene.gripper.membrane.spring_damping;
    let dampings = cases::others(&sweep.spring_dampings, spring_damping).map(|it| {
        (
            Change::SpringDamping(it),
            "holding force with this damping ratio of the membrane's springs over the protocol's",
            "a quasi-static result does not depend on damping; the source's membranes have 0.3 and 0.15",
        )
    });
    let slowdowns = cases::others(&sweep.slowdowns, 1.0).map(|it| {
        (
            Change::Slowdown(it),
            "holding force with both ways slower by this factor over the protocol's",
            "the accelerated protocol is legal if a slower one gives the same",
        )
    });
    for (change, quantity, oracle) in dampings.chain(slowdowns) {
        judge.row_or(
            &Report {
                id: &format!("C9.{}", change.name()),
                quantity,
                unit: "1",
                oracle,
                reason: "10 %, what two histories of one bag may differ by",
            },
            Expected::within(1.0, SAME),
            ratio(change).map(|(changed, own)| changed / own),
            HISTORY,
        );
    }
}

fn notes(cases: &[Case], records: &[Record]) -> Vec<String> {
    let mut notes = vec![
        "The source leaves the number of grains out. It fills the bag while the membrane is held at \
         1.25 radii, \"to insert more granulate\"; the scene takes as many grains as that bowl holds."
            .to_owned(),
        "There is no suction between membrane and object, here as in the source: F_h is friction \
         and shape alone."
            .to_owned(),
    ];
    for record in records.iter().filter(|it| cases.iter().any(|case| case.name == it.case)) {
        for fault in record.validity.faults() {
            notes.push(format!("{}: {fault}", record.case));
        }
    }
    notes
}
