//! What the records show: rows beside their oracles, and the quantities behind them.

use super::{
    expected,
    measure::{Seen, deviations},
    plots,
    run::Case,
    scene::Scene,
};
use crate::{
    base::{Real, real::real},
    experiments::{
        findings::{Curve, Expected, Findings, Quantity, Report, Row},
        record::Record,
    },
};

/// Everything that the records show.
pub(super) fn findings(scene: &Scene, cases: &[Case], records: &[Record]) -> Findings {
    let mut findings = Findings::default();
    let mut seen = Vec::new();
    for case in cases {
        let record = records.iter().find(|record| record.case == case.name);
        match record.and_then(|record| Seen::new(case, record)) {
            Some(it) => seen.push(it),
            None => findings.notes.push(format!("{}: no record, no rows", case.name)),
        }
    }
    for it in &seen {
        quantities(scene, it, &mut findings);
        let columns = it.record.columns.clone();
        findings.curves.push(Curve { name: it.case.name.to_owned(), columns });
        for fault in it.record.validity.faults() {
            findings.notes.push(format!("{}: {fault}", it.case.name));
        }
    }
    triangles(scene, &seen, &mut findings.rows);
    hard_spheres(scene, &seen, &mut findings.rows);
    spheres(scene, &seen, &mut findings.rows);
    framed(scene, &seen, &mut findings.rows);
    plots::draw(scene, &seen, &mut findings.plots);
    findings
}

pub(super) fn named<'s, 'a>(seen: &'s [Seen<'a>], name: &str) -> Option<&'s Seen<'a>> {
    seen.iter().find(|it| it.case.name == name)
}

/// The largest of what `of` gives for the named cases; `None` if one of them is missing.
fn worst(seen: &[Seen<'_>], names: &[&str], of: impl Fn(&Seen<'_>) -> Real) -> Option<Real> {
    let values: Option<Vec<Real>> = names.iter().map(|name| named(seen, name).map(&of)).collect();
    // NaN must not hide behind a number.
    values.map(|it| it.into_iter().fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a }))
}

fn quantities(scene: &Scene, seen: &Seen<'_>, findings: &mut Findings) {
    let weight = seen.case.weight(scene);
    let friction = seen.spread("friction_force");
    let height = seen.spread("height");
    let mut add = |name: &str, meaning: &str, unit: &str, value: Real| {
        findings.quantities.push(Quantity {
            name: format!("{}_{name}", seen.case.name),
            meaning: meaning.to_owned(),
            value,
            deviation: None,
            n: 1,
            unit: unit.to_owned(),
        });
    };
    add("friction", "mean friction force over weight and load", "1", friction.mean / weight);
    add(
        "friction_least",
        "least friction force over weight and load",
        "1",
        friction.least / weight,
    );
    add(
        "friction_most",
        "largest friction force over weight and load",
        "1",
        friction.most / weight,
    );
    add("height_ripple", "highest less lowest position of the ball", "m", height.range());
}

/// All vertices held, triangles: nothing may be seen of them.
fn triangles(scene: &Scene, seen: &[Seen<'_>], rows: &mut Vec<Row>) {
    let names = ["triangles_rows", "triangles_across", "triangles_skew", "triangles_heavy"];
    let friction = scene.membrane.surface.friction;
    let mut add = |told: Report<'_>, expected: Expected, measured: Option<Real>| {
        rows.extend(measured.map(|it| Row::new(&told, expected, it)));
    };
    let off = |it: &Seen<'_>| {
        (it.spread("friction_force").mean / (friction * it.case.weight(scene)) - 1.0).abs()
    };
    add(
        Report {
            id: "C8.triangle_friction",
            quantity: "friction force over triangles against μ N, worst of three ways and two loads",
            unit: "1",
            oracle: "Coulomb, F_R = μ N; Götz (2024), Fig. 8 (a): constant",
            reason: "0.1 %: what the normal force may still swing after the start",
        },
        Expected::within(0.0, 1e-3),
        worst(seen, &names, off),
    );
    let ripple = |it: &Seen<'_>| {
        let friction = it.spread("friction_force");
        friction.range() / friction.mean
    };
    add(
        Report {
            id: "C8.triangle_ripple",
            quantity: "largest less smallest friction force over triangles, over the mean",
            unit: "1",
            oracle: "Götz (2024), Fig. 8 (a): constant with triangles",
            reason: "0.5 %: less than a line's width in the figure",
        },
        Expected::at_most(5e-3),
        worst(seen, &names, ripple),
    );
    let radius = scene.ball.radius;
    let sunk =
        |it: &Seen<'_>| expected::overlap(&it.case.law(scene), radius, it.case.weight(scene));
    add(
        Report {
            id: "C8.triangle_height",
            quantity: "highest less lowest position over triangles, over the overlap",
            unit: "1",
            oracle: "Götz (2024), Fig. 8 (b): constant with triangles",
            reason: "0.1 % of the overlap, as for the force",
        },
        Expected::at_most(1e-3),
        worst(seen, &names, |it| it.spread("height").range() / sunk(it)),
    );
    add(
        Report {
            id: "C8.triangle_sag",
            quantity: "how deep the ball sinks into triangles against Hertz",
            unit: "1",
            oracle: "Hertz, ξ = (3 W / 4 E* √R)^(2/3)",
            reason: "0.1 %: one contact at rest, no swing",
        },
        Expected::within(0.0, 1e-3),
        worst(seen, &names, |it| ((radius - it.spread("height").mean) / sunk(it) - 1.0).abs()),
    );
    add(
        Report {
            id: "C8.triangle_stick",
            quantity: "distance over which the ball sticks before it slides, over the law's",
            unit: "1",
            oracle: "ξ_t = μ N / (2/3 · 8 G* √(R ξ)) (Götz 2024, eqs. 8 to 10 as resolved)",
            reason: "0.1 %: from the slope of the first straight piece, on which nothing else acts",
        },
        Expected::within(1.0, 1e-3),
        named(seen, "triangles_rows").map(|it| stick(scene, it)),
    );
}

/// μ N over the slope with which the friction force rises, over the law's stick length.
fn stick(scene: &Scene, seen: &Seen<'_>) -> Real {
    let weight = seen.case.weight(scene);
    let law = seen.case.law(scene);
    let (x, force) = (seen.all("distance"), seen.all("friction_force"));
    let full = law.friction * weight;
    let rising: Vec<usize> = (1..x.len()).take_while(|&k| force[k] < 0.9 * full).collect();
    let [Some(&first), Some(&last)] = [rising.first(), rising.last()] else { return Real::NAN };
    let slope = (force[last] - force[first]) / (x[last] - x[first]);
    full / slope / expected::stick_length(&law, scene.ball.radius, weight)
}

/// Spheres so hard that only geometry counts.
fn hard_spheres(scene: &Scene, seen: &[Seen<'_>], rows: &mut Vec<Row>) {
    let reach = scene.ball.radius + scene.membrane.sphere_radius;
    let edge = scene.membrane.edge;
    let friction = scene.membrane.surface.friction;
    let ways = [
        ("hard_spheres_rows", "C8.particle_bridge", 2.0, edge / 2.0, "bridge, l = s/2"),
        (
            "hard_spheres_across",
            "C8.particle_hollow",
            3.0,
            edge / 3.0_f64.sqrt(),
            "hollow, l = s/√3",
        ),
    ];
    for (name, id, n_spheres, distance, place) in ways {
        let Some(it) = named(seen, name) else { continue };
        let bed = it.case.bed(scene, &[]);
        let sunk = |load: Real| expected::overlap(&bed.law, bed.shared_radius, load);
        // The share of the load that each of the spheres below carries along its normal.
        let upright = (1.0 - (distance / reach).powi(2)).sqrt();
        let between = reach - sunk(bed.load / (n_spheres * upright));
        let on_top = reach - sunk(bed.load);
        let fallen = on_top - (between * between - distance * distance).sqrt();
        let bare = 1e3 * expected::fall(reach, distance);
        rows.push(Row::new(
            &Report {
                id,
                quantity: &format!("height ripple over hard spheres, down into a {place}"),
                unit: "m",
                oracle: &format!(
                    "(R + r) − √((R + r)² − l²) = {bare:.3} mm, less the difference of Hertz sags; \
                     Götz (2024), Fig. 8 (b)"
                ),
                reason: "1 %: the ball is recorded every 20 µm and swings a little at the bottom",
            },
            Expected::within(fallen, 0.01 * fallen),
            it.spread("height").range(),
        ));
    }
    let Some(it) = named(seen, "hard_spheres_rows") else { return };
    for (id, share, place) in [
        ("C8.particle_descending", 0.25, "a quarter after the top of a sphere"),
        ("C8.particle_climbing", 0.75, "a quarter before the top of a sphere"),
    ] {
        let behind = if share < 0.5 { share * edge } else { (share - 1.0) * edge };
        let oracle = expected::friction_on_one(friction, reach, behind);
        rows.push(Row::new(
            &Report {
                id,
                quantity: &format!("friction force over weight and load on hard spheres, {place}"),
                unit: "1",
                oracle: "one sphere, F_R = W tan(φ − θ), sin θ = u/(R + r), tan φ = μ",
                reason: "1 %: contact of finite stiffness, so that the path is not quite a circle",
            },
            Expected::within(oracle, 0.01 * oracle),
            it.friction_at(share) / it.case.weight(scene),
        ));
    }
    let extreme = |behind: Real| expected::friction_on_one(friction, reach, behind);
    let oracle = extreme(-edge / 2.0) - extreme(edge / 2.0);
    rows.push(Row::new(
        &Report {
            id: "C8.particle_friction_range",
            quantity: "largest less smallest friction force over hard spheres, over weight and load",
            unit: "1",
            oracle: "one sphere at both ends of a bridge, tan(φ + θ) − tan(φ − θ), sin θ = s/2(R + r)",
            reason: "2 %: both extremes lie where the ball is handed on, within 20 µm",
        },
        Expected::within(oracle, 0.02 * oracle),
        it.spread("friction_force").range() / it.case.weight(scene),
    ));
}

/// Spheres as they are, against the quasi-static sum over all of them.
fn spheres(scene: &Scene, seen: &[Seen<'_>], rows: &mut Vec<Row>) {
    let names = ["spheres_rows", "spheres_across", "spheres_skew"];
    for (name, way) in names.into_iter().zip(["along rows", "across rows", "askew"]) {
        let Some(it) = named(seen, name) else { continue };
        let (height, friction) = deviations(it, &it.expected(scene));
        let short = name.trim_start_matches("spheres_");
        rows.push(Row::new(
            &Report {
                id: &format!("C8.particle_height_{short}"),
                quantity: &format!("height over spheres {way} against the computed one, rms over range"),
                unit: "1",
                oracle: "forces of all touched spheres in balance; Götz (2024), Fig. 8 (b)",
                reason: "3 %: inertia at 50 mm/s, 1 % of the load, and the friction spring's memory",
            },
            Expected::at_most(0.03),
            height,
        ));
        rows.push(Row::new(
            &Report {
                id: &format!("C8.particle_friction_{short}"),
                quantity: &format!(
                    "friction over spheres {way} against the computed one, rms over range"
                ),
                unit: "1",
                oracle: "horizontal part of normal forces and friction; Götz (2024), Fig. 8 (a)",
                reason: "3 %: the computed curve slides everywhere; the springs of the law need \
                         0.1 mm to turn into the direction of slip",
            },
            Expected::at_most(0.03),
            friction,
        ));
    }
    for (name, id) in [
        ("spheres_rows", "C8.particle_period_rows"),
        ("spheres_across", "C8.particle_period_across"),
    ] {
        let Some(it) = named(seen, name) else { continue };
        let period = it.case.period().norm();
        rows.push(Row::new(
            &Report {
                id,
                quantity: "distance between two tops of the path over spheres",
                unit: "m",
                oracle: "the lattice: s along rows, √3 s across",
                reason: "0.1 %: interpolated between records, averaged over many periods",
            },
            Expected::within(period, 1e-3 * period),
            it.ups(),
        ));
    }
}

/// Only the edge held: facets of a sheet that gives way.
fn framed(scene: &Scene, seen: &[Seen<'_>], rows: &mut Vec<Row>) {
    let Some(it) = named(seen, "triangles_framed") else { return };
    let forces = it.whole_periods("friction_force");
    let mean = forces.iter().sum::<Real>() / real(forces.len());
    let friction = scene.membrane.surface.friction * it.case.weight(scene);
    rows.push(Row::new(
        &Report {
            id: "C8.framed_friction",
            quantity: "mean friction force over triangles held at the edge only, over μ N",
            unit: "1",
            oracle: "Coulomb: ups and downs of facets cancel over whole periods",
            reason: "2 %: the way through the bowl of the sheet is not quite symmetric, and facets \
                     that tilt by some degrees make it longer",
        },
        Expected::within(1.0, 0.02),
        mean / friction,
    ));
    let told = "A sheet that gives way bends at its vertices into facets, of 1.33 mm under a ball of \
                2 mm; the ball climbs the front half of each and goes down the rear half, \
                F_R = W tan(φ ± tilt). The source does not say how its membrane was held";
    let reason = match named(seen, "small_triangles_framed") {
        Some(small) => format!(
            "{told}. Tried: triangles of half the size, {:.1} % in place of {:.1} %",
            100.0 * small.ripple(),
            100.0 * it.ripple()
        ),
        None => format!("{told}. The full size tries triangles of half the size"),
    };
    rows.push(Row::new(
        &Report {
            id: "C8.framed_ripple",
            quantity: "standard deviation of the friction force over triangles held at the edge only, \
                       over its mean",
            unit: "1",
            oracle: "Götz (2024), Fig. 8 (a): constant with triangles",
            reason: &reason,
        },
        Expected::at_most(5e-3),
        it.ripple(),
    ));
    let Some(spheres) = named(seen, "spheres_framed") else { return };
    rows.push(Row::new(
        &Report {
            id: "C8.framed_smoother",
            quantity: "the same over that of spheres",
            unit: "1",
            oracle: "Götz (2024), section 3.3.2: triangles are smoother",
            reason: "A bound: the source gives no number",
        },
        Expected::at_most(1.0),
        it.ripple() / spheres.ripple(),
    ));
}
