//! Plots of the packings.

use super::{
    super::{
        findings::{Kind, Plot, Series},
        record::Record,
    },
    measure::{Jammed, SILBERT, jammed, states},
};
use crate::base::Real;

/// All plots that there are records for.
pub(super) fn plots(
    records: &[Record],
    smooth: Option<&Record>,
    over_friction: &[Jammed],
) -> Vec<Plot> {
    let mut plots = Vec::new();
    plots.push(pressures(records));
    plots.extend(
        smooth.into_iter().flat_map(|record| [scaling(record), structure(record), cut(record)]),
    );
    if !over_friction.is_empty() {
        plots.extend(frictions(over_friction));
    }
    plots
}

fn plot(
    title: &str,
    source_says: &str,
    labels: [&str; 2],
    logs: [bool; 2],
    series: Vec<Series>,
) -> Plot {
    Plot::new(title, source_says, labels, series).with_logs(logs)
}

fn pressures(records: &[Record]) -> Plot {
    let of = |record: &Record| {
        let points = states(record).iter().map(|s| [s[0], s[1]]).collect();
        Series::new(&record.case, Kind::Points, points)
    };
    let boxed = records.iter().filter(|it| it.column("solid_fraction").is_some());
    plot(
        "Pressure over solid fraction",
        "p grows as (φ − φ_J)^(3/2) from jamming on (O'Hern et al. 2003)",
        ["solid fraction", "pressure [Pa]"],
        [false, true],
        boxed.map(of).collect(),
    )
}

fn scaling(record: &Record) -> Plot {
    let (mut pressure, mut contacts) = (Vec::new(), Vec::new());
    let mut lines = [Vec::new(), Vec::new()];
    if let Some(at) = jammed(record) {
        let states = states(record);
        let top = states.first().map_or([at.phi, 1.0, 6.0], |it| *it);
        for [phi, p, z] in states {
            let (excess, share) = (phi - at.phi, (phi - at.phi) / (top[0] - at.phi));
            pressure.push([excess, p / top[1]]);
            contacts.push([excess, z - 6.0]);
            lines[0].push([excess, share.powf(1.5)]);
            lines[1].push([excess, (top[2] - 6.0) * share.sqrt()]);
        }
    }
    let [hertz, root] = lines;
    plot(
        "Smooth equal spheres above jamming",
        "z − 6 ~ (φ − φ_J)^0.5 and p ~ (φ − φ_J)^1.5 (O'Hern et al. 2003)",
        ["φ − φ_J", "p / p_max, z − 6"],
        [true, true],
        vec![
            Series::new("p / p_max", Kind::Points, pressure),
            Series::new("exponent 3/2", Kind::Analytic, hertz),
            Series::new("z − 6", Kind::Points, contacts),
            Series::new("exponent 1/2", Kind::Analytic, root),
        ],
    )
}

fn frictions(over_friction: &[Jammed]) -> [Plot; 2] {
    // A logarithmic axis has no zero: smooth grains are drawn where friction hardly matters.
    let at = |friction: Real| friction.max(0.01);
    let measured = |of: fn(&Jammed) -> Real| {
        let points = over_friction.iter().map(|it| [at(it.friction), of(it)]).collect();
        Series::new("measured", Kind::Line, points)
    };
    let silbert = |k: usize| {
        let points = SILBERT.iter().map(|row| [at(row[0]), row[k]]).collect();
        Series::new("Silbert (2010), from memory", Kind::Source, points)
    };
    let label = "friction (0 drawn at 0.01)";
    [
        plot(
            "Solid fraction at jamming over friction",
            "falls continuously from random close packing, 0.64, to random loose packing, 0.55",
            [label, "φ_J"],
            [true, false],
            vec![measured(|it| it.phi), silbert(1)],
        ),
        plot(
            "Contacts per grain at jamming over friction",
            "falls from approximately six to four; Götz (2024), Fig. 24 a: z falls with friction",
            [label, "z"],
            [true, false],
            vec![measured(|it| it.z), silbert(2)],
        ),
    ]
}

fn table(record: &Record, name: &str) -> Vec<[Real; 2]> {
    let column = |name| record.table_column("structure", name).unwrap_or_default();
    column("distance_over_diameter").iter().zip(column(name)).map(|(&r, &g)| [r, g]).collect()
}

fn structure(record: &Record) -> Plot {
    let ones = vec![[0.0, 1.0], [4.0, 1.0]];
    plot(
        "Pair distribution of the centers",
        "Götz (2024), Fig. 25: decaying peaks, amorphous; a random packing's second peak is split \
        at √3 d and 2 d, a lattice has a peak at √2 d",
        ["distance / diameter", "g"],
        [false, false],
        vec![
            Series::new("measured", Kind::Line, table(record, "g")),
            Series::new("without correlations", Kind::Analytic, ones),
        ],
    )
}

fn cut(record: &Record) -> Plot {
    let phi = states(record).last().map_or(0.64, |it| it[0]);
    let limit = |r: Real| 1.5 * phi / std::f64::consts::PI * (1.0 + 1.0 / (12.0 * r * r));
    let points = table(record, "eq42");
    let without = points.iter().map(|p| [p[0], limit(p[0])]).filter(|p| p[0] > 0.5).collect();
    plot(
        "Pair distribution as in eq. 42",
        "Götz (2024), eq. 42: grains intersected by a sphere; the kernel is a diameter wide and \
        hides narrow peaks",
        ["distance / diameter", "g of eq. 42"],
        [false, false],
        vec![
            Series::new("measured", Kind::Line, points),
            Series::new("without correlations", Kind::Analytic, without),
        ],
    )
}
