//! The recorded series of a specimen: means over the substeps between two points of strain, and the
//! state of the specimen at each point.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::measure;
use crate::{
    base::{Real, real::real},
    experiments::record::{Column, Record, Scalar, Validity},
    measure as packing_measure,
    physics::System,
};

/// Names and units of the columns.
const COLUMNS: [(&str, &str); 14] = [
    ("strain", "1"),
    ("stress_difference", "Pa"),
    ("stress_difference_initial_area", "Pa"),
    ("plate_pressure_bottom", "Pa"),
    ("plate_pressure_top", "Pa"),
    ("axial_stress", "Pa"),
    ("lateral_stress", "Pa"),
    ("hoop_pressure", "Pa"),
    ("volumetric_strain", "1"),
    ("solid_fraction", "1"),
    ("coordination_number", "1"),
    ("middle_radius", "m"),
    ("end_radius", "m"),
    ("unbalanced_force", "1"),
];

/// The record so far.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct TimeSeries {
    columns: Vec<Vec<Real>>,
    scalars: BTreeMap<String, Scalar>,
    n_substeps: BTreeMap<String, u64>,
    pub(super) validity: Validity,
    /// Difference of strain between two points.
    strain_step: Real,
    /// Confining pressure (Pa).
    pressure: Real,
    /// Distance of the plates at the start of shearing (m).
    height_0: Real,
    /// Volume at the start of shearing (m³).
    volume_0: Real,
    /// Sums of the forces on both plates since the last point (N).
    sums: [Real; 2],
    n_in_sums: u64,
}

impl TimeSeries {
    /// An empty series for `n_points` up to `strain`.
    pub(super) fn new(strain: Real, n_points: usize) -> Self {
        Self {
            columns: vec![Vec::new(); COLUMNS.len()],
            scalars: BTreeMap::new(),
            n_substeps: BTreeMap::new(),
            validity: Validity::default(),
            strain_step: strain / real(n_points),
            pressure: 0.0,
            height_0: 0.0,
            volume_0: 0.0,
            sums: [0.0; 2],
            n_in_sums: 0,
        }
    }

    /// Sets a number.
    pub(super) fn set(&mut self, name: &str, value: Real, unit: &str) {
        self.scalars.insert(name.to_owned(), Scalar { value, unit: unit.to_owned() });
    }

    /// Adds `n` substeps of `phase`.
    pub(super) fn count(&mut self, phase: &str, n: u64) {
        *self.n_substeps.entry(phase.to_owned()).or_default() += n;
    }

    /// Records the isotropic state, in which the plates carry `forces` (N) under `pressure` (Pa).
    pub(super) fn start(&mut self, system: &System, pressure: Real, forces: [Real; 2]) {
        self.pressure = pressure;
        self.height_0 = measure::height(system);
        self.volume_0 = measure::volume(system);
        self.sums = forces;
        self.n_in_sums = 1;
        self.set("initial_height", self.height_0, "m");
        self.set("initial_volume", self.volume_0, "m^3");
        self.point(system);
    }

    /// Records a substep of shearing at a relative speed (m/s) up to a last strain, with grains of
    /// a density (kg/m³). Returns true at the last point.
    pub(super) fn record(
        &mut self,
        system: &System,
        forces: [Real; 2],
        (speed, strain, density): (Real, Real, Real),
    ) -> bool {
        for (sum, force) in self.sums.iter_mut().zip(forces) {
            *sum += force;
        }
        self.n_in_sums += 1;
        let height = measure::height(system);
        let strain_now = (self.height_0 / height).ln();
        let n_points = self.columns[0].len();
        // Rounding must not skip the last point.
        if strain_now < self.strain_step * (real(n_points) - 1e-9) {
            return false;
        }
        let diameter = 2.0 * system.model.radius_mean;
        let inertial = speed / height * diameter * (density / self.pressure).sqrt();
        self.validity.inertial_number_max = self.validity.inertial_number_max.max(inertial);
        self.point(system);
        strain_now >= strain * (1.0 - 1e-9)
    }

    /// Records that a grain has left the membrane.
    pub(super) fn leak(&mut self, system: &System) {
        self.validity.n_leaked = 1;
        self.set("strain_of_leak", (self.height_0 / measure::height(system)).ln(), "1");
    }

    /// Adds a point and starts new means.
    fn point(&mut self, system: &System) {
        let (height, volume) = (measure::height(system), measure::volume(system));
        let n = real(usize::try_from(self.n_in_sums).unwrap_or(usize::MAX));
        let [bottom, top] = self.sums.map(|sum| sum / n);
        (self.sums, self.n_in_sums) = ([0.0; 2], 0);
        let (area, area_0) = (volume / height, self.volume_0 / self.height_0);
        let mean = 0.5 * (bottom + top);
        let contacts = measure::contacts(system);
        let [axial, lateral] = contacts.stress;
        let [middle, end] = measure::radii(system);
        let values = [
            (self.height_0 / height).ln(),
            mean / area - self.pressure,
            mean / area_0 - self.pressure,
            bottom / area,
            top / area,
            axial,
            lateral,
            measure::hoop_pressure(system),
            volume / self.volume_0 - 1.0,
            packing_measure::grain_volume(&system.state) / volume,
            contacts.coordination,
            middle,
            end,
            contacts.unbalanced,
        ];
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(value);
        }
        let largest = &mut self.validity.overlap_over_diameter_max;
        *largest = largest.max(contacts.overlap_over_diameter);
    }

    /// The series as a record.
    pub(super) fn to_record(&self, case: &str, seed: u64) -> Record {
        let columns = COLUMNS.iter().zip(&self.columns).map(|((name, unit), values)| {
            let mut column = Column::new(name, unit);
            column.values.clone_from(values);
            column
        });
        Record {
            case: case.to_owned(),
            seed,
            columns: columns.collect(),
            scalars: self.scalars.clone(),
            validity: self.validity,
            n_substeps: self.n_substeps.clone(),
            ..Record::default()
        }
    }
}
