//! Curves and plots of the triaxial tests.

use super::{cases::CHECK, scene::TriaxialScene};
use crate::experiments::{
    findings::{Curve, Kind, Plot, Series},
    record::Record,
};

/// All columns of a record.
pub(super) fn curve(record: &Record) -> Curve {
    Curve { name: record.case.clone(), columns: record.columns.clone() }
}

/// Figure 6 and related plots, for each size.
pub(super) fn plots(scene: &TriaxialScene, records: &[Record]) -> Vec<Plot> {
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
        stress.series.extend(mohr_coulomb(scene));
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

/// One column over the strain: a line for each specimen, points for the check.
fn plot(records: &[&Record], (column, label, scale): (&str, &str, f64), title: &str) -> Plot {
    let series = records.iter().filter_map(|record| {
        let (x, y) = (record.column("strain")?, record.column(column)?);
        let kind = if record.case.ends_with(CHECK) { Kind::Points } else { Kind::Line };
        let points = x.iter().zip(y).map(|(x, y)| [*x, y * scale]).collect();
        Some(Series::new(&record.case, kind, points))
    });
    Plot::new(title, "", ["axial strain ε", label], series.collect())
}

/// The stress differences at some friction angles.
fn mohr_coulomb(scene: &TriaxialScene) -> Vec<Series> {
    let of = |degrees: f64| {
        let sine = degrees.to_radians().sin();
        let stress = scene.confining.pressure * 1e-3 * ((1.0 + sine) / (1.0 - sine) - 1.0);
        let points = vec![[0.0, stress], [scene.shear.strain, stress]];
        Series::new(&format!("friction angle {degrees}°"), Kind::Analytic, points)
    };
    [20.0, 24.0].map(of).into()
}
