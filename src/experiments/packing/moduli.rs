//! Elastic moduli of a packing at rest: small strains and the response of the stress.
//!
//! ```text
//! all diameters larger by ε:                K = Δp/(3 ε)
//! box longer by ε, narrower by ε:           G = −Δ(σ_xx − σ_yy)/(4 ε)
//!
//! effective medium (Walton 1987), U21:
//! K = [z² φ² G_p² p/(18 π² (1 − ν)²)]^1/3
//! G = (5 − 4ν)/(5 (2 − ν)) [3 z² φ² G_p² p/(2 π² (1 − ν)²)]^1/3
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | ε | strain, a hundredth of the mean overlap over diameter: few contacts slide | – |
//! | p, σ | pressure and stress that contacts carry, positive in compression | Pa |
//! | z, φ | contacts per grain, solid fraction | – |
//! | G_p, ν | shear modulus and Poisson's ratio of the grains | Pa, – |
//!
//! The theory moves all grains affinely. Real ones relax, slightly in compression and strongly in
//! shear: Makse, Gland, Johnson & Schwartz (1999).

use std::f64::consts::PI;

use super::{
    boxed::{BoxRun, Change, RestState},
    measure::Probe,
    scene::PackingScene,
};
use crate::{
    base::Real,
    experiments::{
        findings::{Expected, Findings, Quantity, Row, RowText},
        record::{Column, Record},
    },
};

/// Name of the table with a row for each pressure.
const TABLE: &str = "moduli";

impl BoxRun {
    /// Starts to measure the moduli of a state at rest.
    pub(super) fn start_probe(&mut self, rest: &RestState) {
        let RestState { pressure, solid_fraction, coordination, .. } = *rest;
        for (name, unit, value) in [
            ("pressure", "Pa", pressure),
            ("solid_fraction", "1", solid_fraction),
            ("coordination", "1", coordination),
        ] {
            self.push_modulus(name, unit, value);
        }
        let strain = self.scene.moduli.probe * rest.overlap;
        self.progress.probe = Some(Probe::Bulk { strain, pressure });
        self.ramp(Change::Sizes, strain, pressure);
    }

    /// Ends a measurement and starts the next one.
    pub(super) fn end_probe(&mut self, probe: Probe, rest: &RestState) {
        let RestState { pressure: now, difference: now_difference, .. } = *rest;
        match probe {
            Probe::Bulk { strain, pressure } => {
                self.push_modulus("bulk_modulus", "Pa", (now - pressure) / (3.0 * strain));
                self.progress.probe = Some(Probe::Shear { strain, difference: now_difference });
                self.ramp(Change::Shape, strain, now);
            }
            Probe::Shear { strain, difference } => {
                let modulus = (difference - now_difference) / (4.0 * strain);
                self.push_modulus("shear_modulus", "Pa", modulus);
                self.progress.n_probed += 1;
            }
        }
    }

    fn push_modulus(&mut self, name: &str, unit: &str, value: Real) {
        let table = self.progress.record.tables.entry(TABLE.to_owned()).or_default();
        match table.iter_mut().find(|it| it.name == name) {
            Some(column) => column.values.push(value),
            None => table.push(Column { values: vec![value], ..Column::new(name, unit) }),
        }
    }
}

/// Adds the rows of both moduli and of the pressure exponent.
pub(super) fn rows(scene: &PackingScene, record: &Record, findings: &mut Findings) {
    let column = |name| record.table_column(TABLE, name).unwrap_or_default();
    let last = |name| column(name).last().copied().unwrap_or(Real::NAN);
    let first = |name| column(name).first().copied().unwrap_or(Real::NAN);
    let (phi, p, z) = (last("solid_fraction"), last("pressure"), last("coordination"));
    let nu = scene.grains.material.poisson_ratio;
    let shear = scene.grains.material.youngs_modulus / (2.0 * (1.0 + nu));
    let factor = (z * phi * shear / (PI * (1.0 - nu))).powi(2) * p;
    let bulk_emt = (factor / 18.0).cbrt();
    let shear_emt = (5.0 - 4.0 * nu) / (5.0 * (2.0 - nu)) * (1.5 * factor).cbrt();
    let (bulk, shear) = (last("bulk_modulus"), last("shear_modulus"));
    for (name, meaning, value) in [
        ("bulk_modulus", "of the packing at the source's vacuum", bulk),
        ("bulk_modulus_emt", "by effective-medium theory", bulk_emt),
        ("shear_modulus", "of the packing at the source's vacuum", shear),
        ("shear_modulus_emt", "by effective-medium theory", shear_emt),
    ] {
        findings.quantities.push(Quantity::new(name, meaning, value, "Pa"));
    }
    let mut row = |id, quantity, oracle, expected, measured| {
        let text =
            RowText { id, quantity, unit: "1", oracle, reason: "a range from the literature" };
        findings.rows.push(Row::new(&text, expected, measured));
    };
    row(
        "U21.bulk_modulus",
        "bulk modulus divided by that of effective-medium theory",
        "0.7 to 1.0: the theory moves all grains affinely, real ones relax (Makse et al. 1999)",
        Expected::between(0.7, 1.0),
        bulk / bulk_emt,
    );
    row(
        "U21.shear_modulus",
        "shear modulus divided by that of effective-medium theory",
        "0.4 to 0.8: real grains relax far more under shear (Makse et al. 1999)",
        Expected::between(0.4, 0.8),
        shear / shear_emt,
    );
    if column("pressure").len() > 1 {
        row(
            "U21.pressure_exponent",
            "exponent with which the bulk modulus rises with pressure",
            "1/3 to 1/2: 1/3 by Hertz at a constant number of contacts, more if the number grows",
            Expected::between(1.0 / 3.0, 0.5),
            (bulk / first("bulk_modulus")).ln() / (p / first("pressure")).ln(),
        );
    }
}
