//! Plots and tables: force over time, holding force over everything that is varied.

use super::{
    cases::{self, modulus_text},
    measure::{self, rows},
    phase::Phase,
    results::Results,
};
use crate::{
    base::Real,
    experiments::{
        findings::{Curve, Findings, Kind, Plot, Quantity, Series},
        record::Column,
    },
};

/// Adds quantities, curves and plots.
pub(super) fn add(results: &Results<'_>, findings: &mut Findings) {
    force_record(results, findings);
    over_modulus(results, findings);
    over_pressure(results, findings);
    over_object(results, findings);
    let points = results.over_count("holding_force");
    if points.len() > 1 {
        let push = results.over_count("force_relaxed").into_iter().map(|[n, f]| [n, -f]).collect();
        let mut plot =
            plot("Filling", "nothing: the number of grains is not given", "grains", "force [N]");
        plot.series = vec![
            Series::new("holding force", Kind::Points, points),
            Series::new("push after relaxation", Kind::Points, push),
        ];
        findings.plots.push(plot);
    }
}

/// Fig. 11.
fn force_record(results: &Results<'_>, findings: &mut Findings) {
    let Some(record) = results.record(&results.reference()) else { return };
    let of_first = |name: &str| -> Vec<Real> {
        Phase::ALL.iter().flat_map(|&phase| rows(record, 0, phase, name)).collect()
    };
    let mut plot = plot(
        "Force on the object over a grip (Fig. 11)",
        "zero, a rising push, relaxation, a change on evacuation, then a pull with a maximum that \
         drops to zero",
        "time [s]",
        "vertical force [N], pull positive",
    );
    let (time, force) = (of_first("time"), of_first("force"));
    let points = time.iter().zip(&force).map(|(&t, &f)| [t, f]).collect();
    plot.series.push(Series::new("force of the membrane on the object", Kind::Line, points));
    findings.plots.push(plot);
    let columns = record.columns.iter().map(|column| Column {
        name: column.name.clone(),
        unit: column.unit.clone(),
        values: of_first(&column.name),
    });
    findings.curves.push(Curve { name: "force_record".to_owned(), columns: columns.collect() });
}

/// Fig. 12.
fn over_modulus(results: &Results<'_>, findings: &mut Findings) {
    let mut plot = plot(
        "Holding force over the grains' modulus (Fig. 12)",
        "large for soft grains, small for hard ones (about 100 MPa and more); no data below 5 MPa",
        "Young's modulus of the grains [Pa]",
        "holding force [N]",
    );
    plot.log_x = true;
    let mut measured =
        Series::new("measured, mean and standard deviation", Kind::Points, Vec::new());
    for modulus in cases::moduli(results.scene) {
        for (quantity, meaning, unit) in [
            ("holding_force", "largest pull, mean over fillings", "N"),
            ("normal_force", "sum of normal forces on the object after evacuation", "N"),
        ] {
            let Some(mean) = results.of_modulus(modulus, quantity) else { continue };
            findings.quantities.push(Quantity {
                name: format!("{quantity}_{}", modulus_text(modulus)),
                meaning: meaning.to_owned(),
                value: mean.value,
                deviation: mean.deviation,
                n: mean.n,
                unit: unit.to_owned(),
            });
            if quantity == "holding_force" {
                measured.points.push([modulus, mean.value]);
                measured.deviations.push(mean.deviation.unwrap_or(0.0));
            }
        }
    }
    let columns = vec![
        column("modulus", "Pa", &measured.points, 0),
        column("holding_force", "N", &measured.points, 1),
        Column { values: measured.deviations.clone(), ..Column::new("deviation", "N") },
    ];
    findings.curves.push(Curve { name: "holding_force_over_modulus".to_owned(), columns });
    plot.series.push(measured);
    findings.plots.push(plot);
    for quantity in ["force_relaxed", "contact_angle", "volume", "coordination"] {
        let unit = match quantity {
            "force_relaxed" => "N",
            "contact_angle" => "rad",
            "volume" => "m^3",
            _ => "1",
        };
        if let Some(value) = results.protocol(quantity) {
            let quantity = Quantity::new(quantity, "of the reference case", value, unit);
            findings.quantities.push(quantity);
        }
    }
}

fn over_pressure(results: &Results<'_>, findings: &mut Findings) {
    let points = results.over_pressure();
    let Some(&[strongest, force]) = points.last() else { return };
    let mut plot = plot(
        "Holding force over the vacuum",
        "one value only, 90 kPa",
        "vacuum [Pa]",
        "holding force [N]",
    );
    plot.series = vec![
        Series::new("measured, from one relaxed state", Kind::Points, points.clone()),
        Series::new("proportional", Kind::Analytic, vec![[0.0, 0.0], [strongest, force]]),
    ];
    findings.plots.push(plot);
    tabulate(findings, "holding_force_over_vacuum", ("vacuum", "Pa"), &points);
}

fn over_object(results: &Results<'_>, findings: &mut Findings) {
    let points = results.over_friction();
    if points.len() > 1 {
        let mut plot = plot(
            "Holding force over the object's friction",
            "one value only, 1.2",
            "friction coefficient",
            "holding force [N]",
        );
        plot.series.push(Series::new("measured, one filling", Kind::Points, points.clone()));
        let pinched =
            results.protocol("normal_force_at_best").zip(results.protocol("contact_angle_at_best"));
        if let Some((normal, angle)) = pinched {
            let at = |k: i32| 0.03 * Real::from(k);
            let line = (0..=50).map(|k| [at(k), measure::pinch(normal, angle, at(k)).max(0.0)]);
            let label = "pinch formula with the normal force and angle of the reference";
            plot.series.push(Series::new(label, Kind::Analytic, line.collect()));
        }
        findings.plots.push(plot);
        tabulate(findings, "holding_force_over_friction", ("friction", "1"), &points);
    }
    let points = results.over_radius();
    if points.len() > 1 {
        let mut plot = plot(
            "Holding force over the object's radius",
            "one value only, 10 mm",
            "radius [m]",
            "holding force [N]",
        );
        plot.series.push(Series::new("measured, one filling", Kind::Points, points.clone()));
        findings.plots.push(plot);
        tabulate(findings, "holding_force_over_radius", ("radius", "m"), &points);
    }
}

fn tabulate(findings: &mut Findings, name: &str, x: (&str, &str), points: &[[Real; 2]]) {
    let columns = vec![column(x.0, x.1, points, 0), column("holding_force", "N", points, 1)];
    findings.curves.push(Curve { name: name.to_owned(), columns });
}

fn column(name: &str, unit: &str, points: &[[Real; 2]], k: usize) -> Column {
    Column { values: points.iter().map(|it| it[k]).collect(), ..Column::new(name, unit) }
}

fn plot(title: &str, source_says: &str, x_label: &str, y_label: &str) -> Plot {
    Plot::new(title, source_says, [x_label, y_label], Vec::new())
}
