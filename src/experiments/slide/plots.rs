//! Plots: Fig. 8 of the source for both membranes, and further cases.

use super::{
    expected,
    measure::{CaseRecord, interpolate, named},
    scene::SlideScene,
};
use crate::{
    base::Real,
    experiments::findings::{Kind, Plot, Series},
};

/// Distance that is plotted (m).
const SHOWN: Real = 8e-3;

/// Adds all plots that there are records for.
pub(super) fn add(scene: &SlideScene, records: &[CaseRecord<'_>], plots: &mut Vec<Plot>) {
    let sets: [(&str, &[&str]); 4] = [
        ("all vertices held, along rows", &["triangles_rows", "spheres_rows"]),
        (
            "all vertices held, across rows and at an angle",
            &["triangles_across", "spheres_across", "spheres_skew"],
        ),
        ("hard contacts, slowly", &["hard_spheres_rows", "hard_spheres_across"]),
        (
            "held at the edge only",
            &["triangles_framed", "small_triangles_framed", "spheres_framed"],
        ),
    ];
    for (title, names) in sets {
        let shown: Vec<&CaseRecord<'_>> =
            names.iter().filter_map(|name| named(records, name)).collect();
        if !shown.is_empty() {
            plots.push(friction(scene, title, &shown));
            plots.push(height(scene, title, &shown));
        }
    }
}

fn friction(scene: &SlideScene, title: &str, shown: &[&CaseRecord<'_>]) -> Plot {
    let mut series = Vec::new();
    for it in shown {
        let weight = it.case.weight(scene);
        series.push(measured(it, "friction_force", |force| force / weight));
        if it.case.has_spheres && !it.case.is_framed {
            series.push(computed(it, scene, |rest| rest.friction / weight));
        }
    }
    let friction = scene.membrane.friction;
    let points = vec![[0.0, friction], [1e3 * SHOWN, friction]];
    series.push(Series::new("μ", Kind::Analytic, points));
    Plot::new(
        &format!("Friction force, {title}"),
        "Götz (2024), Fig. 8 (a): constant with triangles, oscillating with particles",
        ["distance / mm", "F_R / (weight and load)"],
        series,
    )
}

/// Heights above the ball's first position.
fn height(scene: &SlideScene, title: &str, shown: &[&CaseRecord<'_>]) -> Plot {
    let mut series = Vec::new();
    let reach = scene.ball.radius + scene.membrane.sphere_radius;
    for it in shown {
        let start = it.all("height").first().copied().unwrap_or(Real::NAN);
        series.push(measured(it, "height", |z| 1e3 * (z - start)));
        if it.case.has_spheres && !it.case.is_framed {
            series.push(computed(it, scene, |rest| 1e3 * (rest.height - start)));
        }
    }
    for (distance, label) in [
        (scene.membrane.edge / 2.0, "bridge, geometry"),
        (scene.membrane.edge / 3.0_f64.sqrt(), "hollow, geometry"),
    ] {
        let height = -1e3 * expected::fall(reach, distance);
        let points = vec![[0.0, height], [1e3 * SHOWN, height]];
        series.push(Series::new(label, Kind::Analytic, points));
    }
    Plot::new(
        &format!("Vertical position, {title}"),
        "Götz (2024), Fig. 8 (b): constant with triangles, oscillating with particles",
        ["distance / mm", "height above the start / mm"],
        series,
    )
}

fn measured(it: &CaseRecord<'_>, column: &str, value: impl Fn(Real) -> Real) -> Series {
    let points = (it.all("distance").iter().zip(it.all(column)))
        .take_while(|(x, _)| **x <= SHOWN)
        .map(|(x, y)| [1e3 * x, value(*y)])
        .collect();
    Series::new(&it.case.name.replace('_', " "), Kind::Line, points)
}

/// The expected quasi-static curve at the recorded distances.
fn computed(
    it: &CaseRecord<'_>,
    scene: &SlideScene,
    value: impl Fn(&expected::Rest) -> Real,
) -> Series {
    let curve = it.expected(scene);
    let period = it.case.period().norm();
    let points = (it.all("distance").iter())
        .take_while(|x| **x <= SHOWN && !curve.is_empty())
        .map(|x| [1e3 * x, value(&interpolate(&curve, x / period))])
        .collect();
    let label = format!("{}, computed", it.case.name.replace('_', " "));
    Series::new(&label, Kind::Analytic, points)
}
