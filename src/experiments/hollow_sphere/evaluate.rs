//! Evaluation of the packings: the pressure on the object over modulus and vacuum, compared with
//! continuum theory.

use super::{
    cases::Kind,
    measure::{Group, groups, last},
    plots,
    scene::HollowSphereScene,
};
use crate::experiments::{
    findings::{Expected, Findings, Row, RowText},
    oracles::shell::shell_object_pressure,
    record::Record,
};

/// All findings.
pub(super) fn findings(scene: &HollowSphereScene, records: &[Record]) -> Findings {
    let mut findings = Findings::default();
    let groups = groups(scene, records);
    for group in &groups {
        findings.quantities.push(group.quantity());
    }
    let of = |kind| groups.iter().filter(move |it: &&Group<'_>| it.case.kind == kind);
    let sweep: Vec<&Group<'_>> = of(Kind::Plain).collect();
    let smooth: Vec<&Group<'_>> = of(Kind::Frictionless).collect();
    let stiff: Vec<&Group<'_>> = of(Kind::StiffContacts).collect();
    let unscaled: Vec<&Group<'_>> = of(Kind::Unscaled).collect();
    let continuum = shell_object_pressure(
        scene.grains.material.poisson_ratio,
        scene.membrane.radius / scene.object.radius,
    );
    let vacuum = scene.protocol.vacuum;
    rows_of_sweep(&sweep, &mut findings);
    rows_of_levels(scene, &sweep, &mut findings);
    rows_of_smooth(scene, &smooth, &mut findings);
    row_of_scaling(&unscaled, &sweep, &mut findings);
    findings.plots.push(plots::over_modulus([&sweep, &smooth, &stiff], continuum, vacuum));
    findings.plots.push(plots::over_vacuum(&sweep, &smooth));
    findings.curves.push(plots::table(&groups));
    findings.notes.push(
        "In the source's contact law a grain indents the membrane with the membrane's own low \
        modulus, by a few tenths of a millimeter under full vacuum. Hard grains do not move that \
        much closer together, so the inner membrane lifts off the object between them. \
        `sweep.stiff_contacts` repeats a case with contacts as stiff as the grains."
            .to_owned(),
    );
    findings.notes.push(format!(
        "Continuum theory (Götz 2024, eq. 33) gives {:.1} kPa as derived from Lamé's equations \
        and {:.1} kPa as printed; it depends on Poisson's ratio only, and the text does not say \
        which of the two figure 14 shows.",
        continuum.corrected * vacuum / 1e3,
        continuum.printed * vacuum / 1e3
    ));
    findings
}

fn rows_of_sweep(sweep: &[&Group<'_>], findings: &mut Findings) {
    let falls: Vec<f64> =
        sweep.windows(2).map(|pair| pair[0].pressure().0 - pair[1].pressure().0).collect();
    if let Some(smallest) = falls.iter().copied().reduce(f64::min) {
        findings.rows.push(Row::new(
            &RowText {
                id: "C10.rises_when_soft",
                quantity: "smallest decrease of the pressure on the object from one modulus to \
                          the next higher one",
                unit: "Pa",
                oracle: "Götz (2024), Fig. 14: p_obj rises monotonically as E_p falls",
                reason: "a bound; the source gives no numbers in the text",
            },
            Expected::at_least(0.0),
            smallest,
        ));
        let vacuum = last(sweep[0].records[0], "vacuum");
        let fall = sweep[0].pressure().0 - sweep[sweep.len() - 1].pressure().0;
        findings.rows.push(Row::new(
            &RowText {
                id: "C10.not_constant",
                quantity: "pressure on the object with the softest grains minus that with the \
                          hardest, divided by the vacuum",
                unit: "1",
                oracle: "Götz (2024), 4.4 and eq. 33: constant for a continuum, but not as \
                        measured",
                reason: "a bound: a twentieth of the vacuum exceeds the scatter between packings",
            },
            Expected::at_least(0.05),
            fall / vacuum,
        ));
    }
}

fn rows_of_levels(scene: &HollowSphereScene, sweep: &[&Group<'_>], findings: &mut Findings) {
    let all = || sweep.iter().flat_map(|it| it.records.iter());
    let lowest = all().flat_map(|it| it.column("object_pressure").unwrap_or_default()).copied();
    if let Some(lowest) = lowest.reduce(f64::min) {
        findings.rows.push(Row::new(
            &RowText {
                id: "C10.never_pulls",
                quantity: "smallest pressure on the object at any level",
                unit: "Pa",
                oracle: "a contact cannot pull",
                reason: "a bound",
            },
            Expected::at_least(0.0),
            lowest,
        ));
    }
    let softest = sweep.first().into_iter().flat_map(|it| it.records.iter());
    if let Some(worst) = softest.map(|it| nonlinearity(it)).reduce(f64::max) {
        findings.rows.push(Row::new(
            &RowText {
                id: "C10.proportional",
                quantity: "softest grains: largest deviation of p_obj(p_vac) from the straight \
                          line between its ends, divided by its last value",
                unit: "1",
                oracle: "linear theory: the problem has no other pressure scale",
                reason: "overlaps of up to a tenth of a diameter and the tension of the membranes \
                        bend the curve by about as much",
            },
            Expected::at_most(0.15),
            worst,
        ));
    }
    let radius = all().map(|it| it.column("outer_radius").map_or(f64::NAN, |it| it[0]));
    if let Some(worst) =
        radius.max_by(|a, b| radius_error(*a, scene).total_cmp(&radius_error(*b, scene)))
    {
        findings.rows.push(Row::new(
            &RowText {
                id: "C10.relaxed_radius",
                quantity: "mean radius of the outer membrane before evacuation, worst packing",
                unit: "m",
                oracle: "Götz (2024), 4.3: R_gripper = 40 mm",
                reason: "half a grain radius: the number of grains is not given and was chosen to \
                        match this radius",
            },
            Expected::within(scene.membrane.radius, 1e-3),
            worst,
        ));
    }
}

fn radius_error(radius: f64, scene: &HollowSphereScene) -> f64 {
    (radius - scene.membrane.radius).abs()
}

/// Largest deviation of the levels from a straight line, over the last level.
fn nonlinearity(record: &Record) -> f64 {
    let (Some(vacuum), Some(pressure)) =
        (record.column("vacuum"), record.column("object_pressure"))
    else {
        return f64::NAN;
    };
    let (Some(&end), Some(&high), Some(&start)) =
        (vacuum.last(), pressure.last(), pressure.first())
    else {
        return f64::NAN;
    };
    let off = |(p, q): (&f64, &f64)| ((q - start) - (high - start) * p / end).abs() / high;
    vacuum.iter().zip(pressure).map(off).fold(0.0, f64::max)
}

fn rows_of_smooth(scene: &HollowSphereScene, smooth: &[&Group<'_>], findings: &mut Findings) {
    for group in smooth {
        findings.rows.push(Row::new(
            &RowText {
                id: "C10.frictionless_flows",
                quantity: "pressure on the object divided by the vacuum, hard grains without \
                          friction",
                unit: "1",
                oracle: "a packing that cannot carry shear is a fluid: Poisson's ratio 1/2, eq. \
                        33 gives 0",
                reason: "a bound: near jamming the shear modulus is small compared with the bulk \
                        modulus but not zero, and grows with the overlaps",
            },
            Expected::at_most(0.1),
            group.pressure().0 / scene.protocol.vacuum,
        ));
    }
}

fn row_of_scaling(unscaled: &[&Group<'_>], sweep: &[&Group<'_>], findings: &mut Findings) {
    for group in unscaled {
        let Some(scaled) =
            sweep.iter().find(|it| it.case.modulus.to_bits() == group.case.modulus.to_bits())
        else {
            continue;
        };
        findings.rows.push(Row::new(
            &RowText {
                id: "C10.mass_scaling",
                quantity: "change of the pressure on the object with heavier grains, divided by \
                          the vacuum",
                unit: "1",
                oracle: "quasi-static results do not depend on mass",
                reason: "2 % of the vacuum: the same packing rearranges slightly differently if \
                        it is closed at another rate",
            },
            Expected::within(0.0, 0.02),
            (last(scaled.records[0], "object_pressure") - group.pressure().0)
                / last(scaled.records[0], "vacuum"),
        ));
    }
}
