//! What the packings show: the pressure on the object over modulus and vacuum, beside continuum
//! theory.

use super::{
    cases::{self, Case, Kind},
    scene::Scene,
};
use crate::experiments::{
    findings::{self, Curve, Expected, Findings, Mean, Plot, Quantity, Report, Row, Series},
    oracles::shell::{ObjectPressure, shell_object_pressure},
    record::{Column, Record},
};

/// A kind of packing with what its repetitions gave.
struct Group<'a> {
    case: Case,
    records: Vec<&'a Record>,
}

/// Everything that can be said of `records`.
pub(super) fn findings(scene: &Scene, records: &[Record]) -> Findings {
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
    findings.plots.push(over_modulus([&sweep, &smooth, &stiff], continuum, vacuum));
    findings.plots.push(over_vacuum(&sweep, &smooth));
    findings.curves.push(table(&groups));
    findings.notes.push(
        "In the source's law a grain sinks into the sheet with the sheet's own soft modulus, by \
         some tenths of a millimetre under the full vacuum. Hard grains do not come that much closer \
         together, so the inner membrane lifts off the object between them. `sweep.stiff_contacts` \
         repeats a case with contacts as hard as the grains."
            .to_owned(),
    );
    findings.notes.push(format!(
        "Continuum theory (Götz 2024, eq. 33) has {:.1} kPa as derived from Lamé's equations and {:.1} \
         kPa as printed; it knows only Poisson's ratio, and which of the two figure 14 shows cannot \
         be seen from the text.",
        continuum.corrected * vacuum / 1e3,
        continuum.printed * vacuum / 1e3
    ));
    findings
}

fn groups<'a>(scene: &Scene, records: &'a [Record]) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    for case in cases::of(scene) {
        let Some(record) = records.iter().find(|it| it.case == case.name) else { continue };
        let same = |it: &&mut Group<'_>| {
            Case { filling: 0, name: String::new(), ..it.case.clone() }
                == Case { filling: 0, name: String::new(), ..case.clone() }
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.records.push(record),
            None => groups.push(Group { case, records: vec![record] }),
        }
    }
    groups
}

impl Group<'_> {
    /// Mean of the pressure on the object under full vacuum, and its standard deviation (Pa).
    fn pressure(&self) -> (f64, f64) {
        self.of(|record| last(record, "object_pressure"))
    }

    fn of(&self, value: impl Fn(&Record) -> f64) -> (f64, f64) {
        let values: Vec<f64> = self.records.iter().map(|it| value(it)).collect();
        let mean = Mean::new(&values);
        mean.map_or((f64::NAN, 0.0), |it| (it.value, it.deviation.unwrap_or(0.0)))
    }

    fn label(&self) -> String {
        cases::in_words(self.case.modulus) + self.case.kind.in_words()
    }

    fn quantity(&self) -> Quantity {
        let (value, deviation) = self.pressure();
        Quantity {
            name: format!("object_pressure_{}", self.label().replace(' ', "_")),
            meaning: format!(
                "pressure on the object under full vacuum, grains of {}",
                self.label()
            ),
            value,
            deviation: (self.records.len() > 1).then_some(deviation),
            n: self.records.len(),
            unit: "Pa".to_owned(),
        }
    }
}

fn last(record: &Record, column: &str) -> f64 {
    record.column(column).and_then(|it| it.last().copied()).unwrap_or(f64::NAN)
}

fn rows_of_sweep(sweep: &[&Group<'_>], findings: &mut Findings) {
    let falls: Vec<f64> =
        sweep.windows(2).map(|pair| pair[0].pressure().0 - pair[1].pressure().0).collect();
    if let Some(smallest) = falls.iter().copied().reduce(f64::min) {
        findings.rows.push(Row::new(
            &Report {
                id: "C10.rises_when_soft",
                quantity: "smallest fall of the pressure on the object from one modulus to the next \
                           harder one",
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
            &Report {
                id: "C10.not_constant",
                quantity: "pressure on the object, softest less hardest grains, over the vacuum",
                unit: "1",
                oracle: "Götz (2024), 4.4 and eq. 33: a continuum's would be constant, the \
                         measured one is not",
                reason: "a bound: a twentieth of the vacuum is more than packings scatter",
            },
            Expected::at_least(0.05),
            fall / vacuum,
        ));
    }
}

fn rows_of_levels(scene: &Scene, sweep: &[&Group<'_>], findings: &mut Findings) {
    let all = || sweep.iter().flat_map(|it| it.records.iter());
    let lowest = all().flat_map(|it| it.column("object_pressure").unwrap_or_default()).copied();
    if let Some(lowest) = lowest.reduce(f64::min) {
        findings.rows.push(Row::new(
            &Report {
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
    if let Some(worst) = softest.map(|it| disproportion(it)).reduce(f64::max) {
        findings.rows.push(Row::new(
            &Report {
                id: "C10.proportional",
                quantity: "softest grains: largest distance of p_obj(p_vac) from the straight line \
                           between its ends, over its end",
                unit: "1",
                oracle: "linear theory: no other pressure is in the problem",
                reason: "overlaps of up to a tenth of a diameter and the membranes' own tension bend \
                         the line by about as much",
            },
            Expected::at_most(0.15),
            worst,
        ));
    }
    let radius = all().map(|it| it.column("outer_radius").map_or(f64::NAN, |it| it[0]));
    if let Some(furthest) =
        radius.max_by(|a, b| distance(*a, scene).total_cmp(&distance(*b, scene)))
    {
        findings.rows.push(Row::new(
            &Report {
                id: "C10.relaxed_radius",
                quantity: "mean radius of the outer membrane before the vacuum, the worst packing",
                unit: "m",
                oracle: "Götz (2024), 4.3: R_gripper = 40 mm",
                reason: "half a grain radius: the number of grains is not given and was chosen for \
                         this",
            },
            Expected::within(scene.membrane.radius, 1e-3),
            furthest,
        ));
    }
}

fn distance(radius: f64, scene: &Scene) -> f64 {
    (radius - scene.membrane.radius).abs()
}

/// Distance of the levels from a straight line, over the last level.
fn disproportion(record: &Record) -> f64 {
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

fn rows_of_smooth(scene: &Scene, smooth: &[&Group<'_>], findings: &mut Findings) {
    for group in smooth {
        findings.rows.push(Row::new(
            &Report {
                id: "C10.frictionless_flows",
                quantity: "pressure on the object over the vacuum, hard grains without friction",
                unit: "1",
                oracle: "a packing that cannot bear shear is a fluid: Poisson's ratio 1/2, eq. 33 \
                         gives 0",
                reason: "a bound: near jamming the shear modulus is small against the bulk modulus, \
                         not zero, and grows with the overlaps",
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
            &Report {
                id: "C10.mass_scaling",
                quantity: "change of the pressure on the object by heavier grains, over the vacuum",
                unit: "1",
                oracle: "quasi-static results know no mass",
                reason: "two hundredths of the vacuum: the same packing closed at another pace \
                         rearranges a little differently",
            },
            Expected::within(0.0, 0.02),
            (last(scaled.records[0], "object_pressure") - group.pressure().0)
                / last(scaled.records[0], "vacuum"),
        ));
    }
}

fn over_modulus(
    [sweep, smooth, stiff]: [&[&Group<'_>]; 3],
    continuum: ObjectPressure,
    vacuum: f64,
) -> Plot {
    let measured = |groups: &[&Group<'_>], label: &str, kind| Series {
        label: label.to_owned(),
        kind,
        points: groups.iter().map(|it| [it.case.modulus / 1e6, it.pressure().0 / 1e3]).collect(),
        deviations: groups.iter().map(|it| it.pressure().1 / 1e3).collect(),
    };
    let ends = [
        sweep.first().map_or(5.0, |it| it.case.modulus / 1e6),
        sweep.last().map_or(1e4, |it| it.case.modulus / 1e6),
    ];
    let level = |label: &str, share: f64| Series {
        label: label.to_owned(),
        kind: findings::Kind::Analytic,
        points: ends.iter().map(|&x| [x, share * vacuum / 1e3]).collect(),
        deviations: Vec::new(),
    };
    Plot {
        title: "Pressure on the object over the grains' modulus".to_owned(),
        source_says: "Götz (2024), Fig. 14: the pressure on the object rises as the grains get \
                      softer; continuum theory (dashed there) does not know the modulus."
            .to_owned(),
        x_label: "Young's modulus of the grains [MPa]".to_owned(),
        y_label: "pressure on the object [kPa]".to_owned(),
        log_x: true,
        log_y: false,
        series: [
            measured(sweep, "measured", findings::Kind::Points),
            measured(smooth, "measured, without friction", findings::Kind::Points),
            measured(stiff, "measured, contacts with the sheet as hard", findings::Kind::Points),
            level("continuum, derived", continuum.corrected),
            level("continuum, as printed (eq. 33)", continuum.printed),
        ]
        .into_iter()
        .filter(|it| !it.points.is_empty())
        .collect(),
    }
}

fn over_vacuum(sweep: &[&Group<'_>], smooth: &[&Group<'_>]) -> Plot {
    let line = |group: &&Group<'_>| {
        let record = group.records[0];
        let vacuum = record.column("vacuum").unwrap_or_default();
        let pressure = record.column("object_pressure").unwrap_or_default();
        Series {
            label: group.label(),
            kind: findings::Kind::Line,
            points: vacuum.iter().zip(pressure).map(|(p, q)| [p / 1e3, q / 1e3]).collect(),
            deviations: Vec::new(),
        }
    };
    Plot {
        title: "Pressure on the object while the vacuum rises".to_owned(),
        source_says: "Not shown there; linear theory has straight lines through zero.".to_owned(),
        x_label: "vacuum [kPa]".to_owned(),
        y_label: "pressure on the object [kPa]".to_owned(),
        log_x: false,
        log_y: false,
        series: sweep.iter().chain(smooth).map(line).collect(),
    }
}

fn table(groups: &[Group<'_>]) -> Curve {
    let mut columns = vec![
        Column::new("youngs_modulus", "Pa"),
        Column::new("is_frictionless", "1"),
        Column::new("mass_factor", "1"),
        Column::new("object_pressure", "Pa"),
        Column::new("object_pressure_deviation", "Pa"),
        Column::new("solid_fraction", "1"),
        Column::new("coordination_number", "1"),
    ];
    for group in groups {
        let (pressure, deviation) = group.pressure();
        let row = [
            group.case.modulus,
            f64::from(u8::from(group.case.kind == Kind::Frictionless)),
            group.case.mass_factor,
            pressure,
            deviation,
            group.of(|it| last(it, "solid_fraction")).0,
            group.of(|it| last(it, "coordination_number")).0,
        ];
        for (column, value) in columns.iter_mut().zip(row) {
            column.values.push(value);
        }
    }
    Curve { name: "object_pressure".to_owned(), columns }
}
