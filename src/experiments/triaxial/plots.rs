//! Curves and pictures of the triaxial tests.

use super::{CHECK, scene::TriaxialScene};
use crate::experiments::{
    findings::{Curve, Kind, Plot, Series},
    record::Record,
};

/// All columns of a record.
pub(super) fn curve(record: &Record) -> Curve {
    Curve { name: record.case.clone(), columns: record.columns.clone() }
}

/// Figure 6 and what belongs to it, for each size.
pub(super) fn plots(setup: &TriaxialScene, records: &[Record]) -> Vec<Plot> {
    let mut plots = Vec::new();
    for size in 1..=2 {
        let prefix = format!("case{size}_");
        let records: Vec<&Record> = (records.iter())
            .filter(|it| it.case.starts_with(&prefix) && !it.columns.is_empty())
            .collect();
        if records.is_empty() {
            continue;
        }
        let panel = ["a", "b"][size - 1];
        let mut stress = plot(
            &records,
            ("stress_difference", "stress difference σ_d [kPa]", 1e-3),
            &format!("Case {size}: stress over strain, on the current area"),
        );
        stress.source_says = format!(
            "Götz (2024), figure 6{panel}: a steep rise to a plateau, the same for both membrane \
             models and both initial states within their scatter."
        );
        stress.series.extend(mohr_coulomb(setup));
        plots.push(stress);
        plots.push(plot(
            &records,
            ("stress_difference_initial_area", "stress difference σ_d [kPa]", 1e-3),
            &format!("Case {size}: stress over strain, on the initial area"),
        ));
        plots.push(plot(
            &records,
            ("volumetric_strain", "volumetric strain [%]", 1e2),
            &format!("Case {size}: volume inside membrane and plates"),
        ));
        plots.push(plot(
            &records,
            ("solid_fraction", "solid fraction", 1.0),
            &format!("Case {size}: solid fraction"),
        ));
    }
    plots
}

/// One column over the strain, a line for each specimen, points for the check.
fn plot(records: &[&Record], (column, label, scale): (&str, &str, f64), title: &str) -> Plot {
    let series = records.iter().filter_map(|record| {
        let (x, y) = (record.column("strain")?, record.column(column)?);
        let kind = if record.case.ends_with(CHECK) { Kind::Points } else { Kind::Line };
        let points = x.iter().zip(y).map(|(x, y)| [*x, y * scale]).collect();
        Some(Series { label: record.case.clone(), kind, points, deviations: Vec::new() })
    });
    Plot {
        title: title.to_owned(),
        source_says: String::new(),
        x_label: "axial strain ε".to_owned(),
        y_label: label.to_owned(),
        log_x: false,
        log_y: false,
        series: series.collect(),
    }
}

/// The stress differences of some friction angles.
fn mohr_coulomb(setup: &TriaxialScene) -> Vec<Series> {
    let of = |degrees: f64| {
        let sine = degrees.to_radians().sin();
        let stress = setup.confining.pressure * 1e-3 * ((1.0 + sine) / (1.0 - sine) - 1.0);
        Series {
            label: format!("friction angle {degrees}°"),
            kind: Kind::Analytic,
            points: vec![[0.0, stress], [setup.shear.strain, stress]],
            deviations: Vec::new(),
        }
    };
    [20.0, 24.0].map(of).into()
}
