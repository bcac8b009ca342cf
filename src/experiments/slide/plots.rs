//! The pictures: Fig. 8 of the source for both membranes, and what stands behind it.

use super::{
    evaluate::named,
    expected,
    measure::{Seen, at_phase},
    scene::Scene,
};
use crate::{
    base::Real,
    experiments::findings::{Kind, Plot, Series},
};

/// Length of the ways that are drawn (m).
const SHOWN: Real = 8e-3;

/// Draws all pictures whose records are there.
pub(super) fn draw(scene: &Scene, seen: &[Seen<'_>], plots: &mut Vec<Plot>) {
    let sets: [(&str, &[&str]); 4] = [
        ("all vertices held, along rows", &["triangles_rows", "spheres_rows"]),
        (
            "all vertices held, across rows and askew",
            &["triangles_across", "spheres_across", "spheres_skew"],
        ),
        ("hard contacts, slowly", &["hard_spheres_rows", "hard_spheres_across"]),
        (
            "held at the edge only",
            &["triangles_framed", "small_triangles_framed", "spheres_framed"],
        ),
    ];
    for (title, names) in sets {
        let shown: Vec<&Seen<'_>> = names.iter().filter_map(|name| named(seen, name)).collect();
        if !shown.is_empty() {
            plots.push(friction(scene, title, &shown));
            plots.push(height(scene, title, &shown));
        }
    }
}

fn friction(scene: &Scene, title: &str, shown: &[&Seen<'_>]) -> Plot {
    let mut series = Vec::new();
    for it in shown {
        let weight = it.case.weight(scene);
        series.push(measured(it, "friction_force", |force| force / weight));
        if it.case.has_spheres && !it.case.is_framed {
            series.push(computed(it, scene, "computed", |rest| rest.friction / weight));
        }
    }
    let friction = scene.membrane.surface.friction;
    let points = vec![[0.0, friction], [1e3 * SHOWN, friction]];
    series.push(Series {
        label: "μ".to_owned(),
        kind: Kind::Analytic,
        points,
        deviations: Vec::new(),
    });
    Plot {
        title: format!("Friction force, {title}"),
        source_says: "Götz (2024), Fig. 8 (a): constant with triangles, oscillating with particles"
            .to_owned(),
        x_label: "distance / mm".to_owned(),
        y_label: "F_R / (weight and load)".to_owned(),
        log_x: false,
        log_y: false,
        series,
    }
}

/// Heights above the place where the ball starts.
fn height(scene: &Scene, title: &str, shown: &[&Seen<'_>]) -> Plot {
    let mut series = Vec::new();
    let reach = scene.ball.radius + scene.membrane.sphere_radius;
    for it in shown {
        let start = it.all("height").first().copied().unwrap_or(Real::NAN);
        series.push(measured(it, "height", |z| 1e3 * (z - start)));
        if it.case.has_spheres && !it.case.is_framed {
            series.push(computed(it, scene, "computed", |rest| 1e3 * (rest.height - start)));
        }
    }
    for (distance, label) in [
        (scene.membrane.edge / 2.0, "bridge, geometry"),
        (scene.membrane.edge / 3.0_f64.sqrt(), "hollow, geometry"),
    ] {
        let fallen = -1e3 * expected::fall(reach, distance);
        series.push(Series {
            label: label.to_owned(),
            kind: Kind::Analytic,
            points: vec![[0.0, fallen], [1e3 * SHOWN, fallen]],
            deviations: Vec::new(),
        });
    }
    Plot {
        title: format!("Vertical position, {title}"),
        source_says: "Götz (2024), Fig. 8 (b): constant with triangles, oscillating with particles"
            .to_owned(),
        x_label: "distance / mm".to_owned(),
        y_label: "height above the start / mm".to_owned(),
        log_x: false,
        log_y: false,
        series,
    }
}

fn measured(seen: &Seen<'_>, column: &str, value: impl Fn(Real) -> Real) -> Series {
    let points = (seen.all("distance").iter().zip(seen.all(column)))
        .take_while(|(x, _)| **x <= SHOWN)
        .map(|(x, y)| [1e3 * x, value(*y)])
        .collect();
    let label = seen.case.name.replace('_', " ");
    Series { label, kind: Kind::Line, points, deviations: Vec::new() }
}

/// The quasi-static curve at the places of the record.
fn computed(
    seen: &Seen<'_>,
    scene: &Scene,
    what: &str,
    value: impl Fn(&expected::Rest) -> Real,
) -> Series {
    let curve = seen.expected(scene);
    let period = seen.case.period().norm();
    let points = (seen.all("distance").iter())
        .take_while(|x| **x <= SHOWN && !curve.is_empty())
        .map(|x| [1e3 * x, value(&at_phase(&curve, x / period))])
        .collect();
    let label = format!("{}, {what}", seen.case.name.replace('_', " "));
    Series { label, kind: Kind::Analytic, points, deviations: Vec::new() }
}
