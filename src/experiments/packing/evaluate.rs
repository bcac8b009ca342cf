//! Evaluation of the packings: where each packing jams, and with how many contacts.
//!
//! ```text
//! φ_J  from φ = φ_J + a p^(2/3) through the three lowest pressures          (Hertz)
//! z_J  from z = z_J + b √(φ − φ_J) through the same states
//! ```

use super::{
    super::{
        findings::{Curve, Expected, Findings, Quantity, Row, RowText},
        record::Record,
    },
    cases::Case,
    fit,
    measure::{Jammed, SILBERT, jammed, states},
    moduli, plots,
    scene::PackingScene,
};
use crate::base::Real;

/// Pressure at which growth ends in the source: a hundredth of its vacuum (Pa).
const SOURCE_STOP: Real = 900.0;
/// All findings.
pub(super) fn findings(scene: &PackingScene, records: &[Record]) -> Findings {
    let mut findings = Findings::default();
    let of = |case: Case| records.iter().find(|it| it.case == case.name());
    curves(records, &mut findings);
    let smooth = of(Case::Mono { friction: 0.0 });
    let over_friction: Vec<Jammed> = (scene.frictions.iter())
        .filter_map(|&friction| of(Case::Mono { friction }).and_then(jammed))
        .collect();
    match smooth {
        Some(record) => {
            close_packing(record, &mut findings);
            structure(record, &mut findings);
        }
        None => missing("mono_friction_0", "U24, U25 and g(r)", &mut findings),
    }
    if over_friction.len() == scene.frictions.len() && over_friction.len() > 1 {
        friction_rows(&over_friction, &mut findings);
    } else {
        missing("mono", "U26", &mut findings);
    }
    match of(Case::Poly) {
        Some(record) => growth_rows(scene, record, &mut findings),
        None => missing("poly_smooth", "C6", &mut findings),
    }
    match of(Case::Moduli) {
        Some(record) => moduli::rows(scene, record, &mut findings),
        None => missing("moduli", "U21", &mut findings),
    }
    match of(Case::Confined) {
        Some(record) => stress_rows(scene, record, &mut findings),
        None => missing("confined", "U22", &mut findings),
    }
    rest_rows(records, &mut findings);
    findings.plots = plots::plots(records, smooth, &over_friction);
    findings.notes.push(
        "Packings jam by quasi-static isotropic compression of a dilute state with the friction \
        of the case switched on throughout; φ_J with friction depends on that protocol."
            .to_owned(),
    );
    findings
}

fn missing(case: &str, rows: &str, findings: &mut Findings) {
    findings.notes.push(format!("{rows}: no record of {case}"));
}

/// The tables of all records.
fn curves(records: &[Record], findings: &mut Findings) {
    for record in records {
        let name = record.case.clone();
        findings.curves.push(Curve { name, columns: record.columns.clone() });
        for (table, columns) in &record.tables {
            let name = format!("{}_{table}", record.case);
            findings.curves.push(Curve { name, columns: columns.clone() });
        }
    }
}

/// U24 and U25: the packing of equal grains without friction.
fn close_packing(record: &Record, findings: &mut Findings) {
    let Some(at) = jammed(record) else { return missing(&record.case, "U24, U25", findings) };
    findings.rows.push(Row::new(
        &RowText {
            id: "U24.phi_j",
            quantity: "solid fraction at which equal smooth spheres jam",
            unit: "1",
            oracle: "random close packing, 0.639 ± 0.001 for many grains (O'Hern et al. 2003)",
            reason: "0.005: scatter between packings of 2000 grains, and of the rate of growth",
        },
        Expected::between(0.635, 0.645),
        at.phi,
    ));
    findings.rows.push(Row::new(
        &RowText {
            id: "U25.isostatic",
            quantity: "contacts per grain without rattlers, extrapolated to zero pressure, smooth",
            unit: "1",
            oracle: "isostatic: 6 (Maxwell's count in three dimensions)",
            reason: "0.15: linear fit in √(φ − φ_J) through three states; 3 contacts among 2000 \
                    grains are 0.003",
        },
        Expected::within(6.0, 0.15),
        at.z,
    ));
    let states = states(record);
    let points: Vec<[Real; 2]> = states.iter().map(|s| [s[0], s[1]]).collect();
    if let Some((_, exponent)) = fit::onset(&points, 0.004) {
        findings.rows.push(Row::new(
            &RowText {
                id: "U25.pressure_exponent",
                quantity: "exponent of p over φ − φ_J, with fitted onset",
                unit: "1",
                oracle: "Hertz: 3/2 (O'Hern et al. 2003)",
                reason: "0.1: z rises by a tenth over the range, and increases p",
            },
            Expected::within(1.5, 0.1),
            exponent,
        ));
    }
    let excess: Vec<[Real; 2]> = (states.iter())
        .map(|s| [s[0] - at.phi, s[2] - 6.0])
        .filter(|p| p[0] > 0.0 && p[1] > 0.0)
        .collect();
    if let Some(exponent) = fit::exponent(&excess) {
        findings.rows.push(Row::new(
            &RowText {
                id: "U25.contact_exponent",
                quantity: "exponent of z − 6 over φ − φ_J",
                unit: "1",
                oracle: "1/2 (O'Hern et al. 2003)",
                reason: "0.1: z − 6 at the lowest pressure is 0.2 ± 0.05 in 2000 grains",
            },
            Expected::within(0.5, 0.1),
            exponent,
        ));
    }
}

/// Peaks of g(r), E28.
fn structure(record: &Record, findings: &mut Findings) {
    let column = |name| record.table_column("structure", name);
    let (Some(r), Some(g)) = (column("distance_over_diameter"), column("g")) else { return };
    let highest = |from: Real, to: Real| {
        (r.iter().zip(g).filter(|(r, _)| (from..to).contains(*r)))
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map_or([Real::NAN; 2], |(r, g)| [*r, *g])
    };
    let lowest_between = (r.iter().zip(g).filter(|(r, _)| (1.78..1.92).contains(*r)))
        .map(|(_, g)| *g)
        .fold(Real::INFINITY, Real::min);
    let (third, second) = (highest(1.66, 1.82), highest(1.9, 2.1));
    let mut row = |id, quantity, oracle, reason, expected, measured| {
        findings.rows.push(Row::new(
            &RowText { id, quantity, unit: "1", oracle, reason },
            expected,
            measured,
        ));
    };
    row(
        "U24.g_peak_at_2d",
        "position of the second part of the second peak of g(r), in diameters",
        "2: three grains in a line; Götz (2024), Fig. 25 shows decaying peaks, amorphous",
        "0.03: one and a half bins",
        Expected::within(2.0, 0.03),
        second[0],
    );
    row(
        "U24.g_peak_at_sqrt3d",
        "position of the first part of the second peak of g(r), in diameters",
        "√3: two triangles of grains that share a side",
        "0.06: the part is broad",
        Expected::within(3.0_f64.sqrt(), 0.06),
        third[0],
    );
    row(
        "U24.g_split",
        "g at √3 d divided by its lowest value between √3 d and 2 d",
        "above 1: the second peak is split",
        "a bound",
        Expected::at_least(1.0),
        third[1] / lowest_between,
    );
    row(
        "U24.g_no_lattice",
        "highest g within 0.05 d of √2 d",
        "at most 1: a lattice has a shell of neighbors there, a random packing almost its lowest g",
        "a bound",
        Expected::at_most(1.0),
        highest(1.364, 1.464)[1],
    );
}

/// U26: the effect of friction.
fn friction_rows(jammed: &[Jammed], findings: &mut Findings) {
    for at in jammed {
        let name = format!("phi_j_friction_{}", at.friction);
        findings.quantities.push(Quantity::new(
            &name,
            "solid fraction at zero pressure",
            at.phi,
            "1",
        ));
        let name = format!("z_friction_{}", at.friction);
        findings.quantities.push(Quantity::new(
            &name,
            "contacts per grain at zero pressure",
            at.z,
            "1",
        ));
    }
    let largest_rise = |of: fn(&Jammed) -> Real| {
        let rises = jammed.windows(2).map(|pair| of(&pair[1]) - of(&pair[0]));
        rises.fold(Real::NEG_INFINITY, Real::max)
    };
    let mut row = |id, quantity, oracle, reason, expected, measured| {
        findings.rows.push(Row::new(
            &RowText { id, quantity, unit: "1", oracle, reason },
            expected,
            measured,
        ));
    };
    row(
        "U26.phi_falls",
        "largest rise of φ_J from one friction to the next",
        "none: φ_J falls continuously from random close to random loose packing (Silbert 2010)",
        "a bound; φ_J of one packing scatters by about 0.003",
        Expected::at_most(0.003),
        largest_rise(|it| it.phi),
    );
    row(
        "U26.z_falls",
        "largest rise of z from one friction to the next",
        "none: z falls from approximately six to four (Silbert 2010)",
        "a bound; z of one packing scatters by about 0.1",
        Expected::at_most(0.1),
        largest_rise(|it| it.z),
    );
    if let Some(loosest) = jammed.last() {
        row(
            "U26.phi_loosest",
            "φ_J at the largest friction",
            "0.550 ± 0.001, the loosest packing of rough spheres (Jerkins et al. 2008)",
            "0.015: φ_J with friction depends on protocol and rate; Silbert's values scatter by 0.01",
            Expected::within(0.55, 0.015),
            loosest.phi,
        );
        row(
            "U26.z_loosest",
            "z at the largest friction, extrapolated to zero pressure",
            "4: isostatic with infinite friction",
            "0.2: the scatter of Silbert's values",
            Expected::within(4.0, 0.2),
            loosest.z,
        );
    }
    for [friction, phi, z] in SILBERT {
        let Some(at) = jammed.iter().find(|it| (it.friction - friction).abs() < 1e-12) else {
            continue;
        };
        findings.notes.push(format!(
            "friction {friction}: φ_J = {:.4} (Silbert 2010 about {phi}), z = {:.2} (about {z})",
            at.phi, at.z
        ));
    }
}

/// C6: growth, as the source prepares its samples.
fn growth_rows(scene: &PackingScene, record: &Record, findings: &mut Findings) {
    let Some(at) = jammed(record) else { return missing(&record.case, "C6", findings) };
    let grains = &scene.grains;
    let uniform =
        (grains.radius_max - grains.radius_min) / (12.0_f64.sqrt() * grains.radius_mean());
    let column = |name| record.column(name).unwrap_or_default();
    let overlap = (column("pressure").iter().zip(column("overlap_max_over_diameter")))
        .find(|(p, _)| **p <= SOURCE_STOP)
        .map_or(Real::NAN, |(_, overlap)| *overlap);
    let mut row = |id, quantity, oracle, reason, expected, measured| {
        findings.rows.push(Row::new(
            &RowText { id, quantity, unit: "1", oracle, reason },
            expected,
            measured,
        ));
    };
    row(
        "C6.phi_j",
        "solid fraction at which smooth spheres of ±8 % jam after growth",
        "0.64 for slow growth without friction",
        "0.005: scatter between packings",
        Expected::within(0.64, 0.005),
        at.phi,
    );
    row(
        "C6.isostatic",
        "contacts per grain without rattlers, extrapolated to zero pressure",
        "isostatic: 6",
        "0.15: as for equal spheres",
        Expected::within(6.0, 0.15),
        at.z,
    );
    row(
        "C6.overlap",
        "largest overlap divided by diameter where growth ends, below 1e-2 of the vacuum",
        "at most 1 %: grains keep their size",
        "a bound",
        Expected::at_most(0.01),
        overlap,
    );
    row(
        "C6.radius_spread",
        "standard deviation of the radii divided by their mean, after growth",
        "uniform between 2.3 and 2.7 mm: (R_max − R_min)/(√12 R̄), Götz (2024), table 2",
        "5 %: four standard errors of a sample of 2000",
        Expected::within(uniform, 0.05 * uniform),
        record.scalar("radius_spread").unwrap_or(Real::NAN),
    );
}

/// U22: the stress inside equals the pressure outside.
fn stress_rows(scene: &PackingScene, record: &Record, findings: &mut Findings) {
    let pressure = scene.confined.pressure;
    let mean = record.scalar("mean_stress").unwrap_or(Real::NAN);
    for name in ["stress_x", "stress_y", "stress_z"] {
        let value = record.column(name).and_then(|it| it.last()).copied().unwrap_or(Real::NAN);
        findings.quantities.push(Quantity::new(
            name,
            "normal stress of the confined sample",
            value,
            "Pa",
        ));
    }
    findings.rows.push(Row::new(
        &RowText {
            id: "U22.stress",
            quantity: "mean stress of a sample in a membrane divided by the vacuum",
            unit: "1",
            oracle: "1: equilibrium, σ = 1/V Σ f l (Love, Weber)",
            reason: "2 %: the share carried by the tension of the membrane, 2/3 of its work \
                    divided by that of the volume",
        },
        Expected::within(1.0, 0.02),
        mean / pressure,
    ));
}

/// U23: every recorded state is at rest.
fn rest_rows(records: &[Record], findings: &mut Findings) {
    let worst = |name: &str| {
        let of_columns = records.iter().filter_map(|it| it.column(name)).flatten().copied();
        let of_scalars = records.iter().filter_map(|it| it.scalar(name));
        of_columns.chain(of_scalars).fold(Real::NEG_INFINITY, Real::max)
    };
    for (id, name, quantity, bound) in [
        (
            "U23.unbalanced",
            "unbalanced_force",
            "largest unbalanced force divided by contact force",
            1e-3,
        ),
        ("U23.kinetic", "kinetic_over_elastic", "largest kinetic divided by elastic energy", 1e-6),
    ] {
        findings.rows.push(Row::new(
            &RowText {
                id,
                quantity,
                unit: "1",
                oracle: "quasi-static: below 1e-3, and 1e-6 of the energy, in every recorded state",
                reason: "a bound",
            },
            Expected::at_most(bound),
            worst(name),
        ));
    }
}
