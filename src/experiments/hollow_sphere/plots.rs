//! Plots and tables of the packings.

use super::{
    cases,
    measure::{Group, last},
};
use crate::experiments::{
    findings::{Curve, Kind, Plot, Series},
    oracles::shell::ObjectPressure,
    record::Column,
};

/// Fig. 14.
pub(super) fn over_modulus(
    [sweep, smooth, stiff]: [&[&Group<'_>]; 3],
    continuum: ObjectPressure,
    vacuum: f64,
) -> Plot {
    let measured = |groups: &[&Group<'_>], label: &str| Series {
        label: label.to_owned(),
        kind: Kind::Points,
        points: groups.iter().map(|it| [it.case.modulus / 1e6, it.pressure().0 / 1e3]).collect(),
        deviations: groups.iter().map(|it| it.pressure().1 / 1e3).collect(),
    };
    let ends = [
        sweep.first().map_or(5.0, |it| it.case.modulus / 1e6),
        sweep.last().map_or(1e4, |it| it.case.modulus / 1e6),
    ];
    let level = |label: &str, share: f64| {
        let points = ends.iter().map(|&x| [x, share * vacuum / 1e3]).collect();
        Series::new(label, Kind::Analytic, points)
    };
    let series = [
        measured(sweep, "measured"),
        measured(smooth, "measured, without friction"),
        measured(stiff, "measured, equally stiff contacts with the membrane"),
        level("continuum, derived", continuum.corrected),
        level("continuum, as printed (eq. 33)", continuum.printed),
    ];
    Plot::new(
        "Pressure on the object over the grains' modulus",
        "Götz (2024), Fig. 14: the pressure on the object rises as the grains get softer; \
        continuum theory (dashed there) does not depend on the modulus.",
        ["Young's modulus of the grains [MPa]", "pressure on the object [kPa]"],
        series.into_iter().filter(|it| !it.points.is_empty()).collect(),
    )
    .with_logs([true, false])
}

/// Pressure on the object over the vacuum, one line for each modulus.
pub(super) fn over_vacuum(sweep: &[&Group<'_>], smooth: &[&Group<'_>]) -> Plot {
    let line = |group: &&Group<'_>| {
        let record = group.records[0];
        let points = record.points("vacuum", "object_pressure");
        let points = points.into_iter().map(|[p, q]| [p / 1e3, q / 1e3]).collect();
        Series::new(&group.label(), Kind::Line, points)
    };
    Plot::new(
        "Pressure on the object while the vacuum rises",
        "Not shown there; linear theory predicts straight lines through zero.",
        ["vacuum [kPa]", "pressure on the object [kPa]"],
        sweep.iter().chain(smooth).map(line).collect(),
    )
}

/// The pressure on the object and the state of the packing for each kind.
pub(super) fn table(groups: &[Group<'_>]) -> Curve {
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
            f64::from(u8::from(group.case.kind == cases::Kind::Frictionless)),
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
