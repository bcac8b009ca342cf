//! Results of all grips, found by what was varied.

use super::{
    cases::{self, Change},
    scene::GripperScene,
};
use crate::{
    base::Real,
    base::real::real,
    experiments::{findings::Mean, record::Record},
};

/// Scene and records.
pub(super) struct Results<'a> {
    pub(super) scene: &'a GripperScene,
    pub(super) records: &'a [Record],
}

impl Results<'_> {
    /// The record of a case.
    pub(super) fn record(&self, case: &str) -> Option<&Record> {
        self.records.iter().find(|it| it.case == case)
    }

    /// Name of the case with the complete protocol.
    pub(super) fn reference(&self) -> String {
        cases::modulus_name(self.scene.gripper.grains.material.youngs_modulus, 0)
    }

    /// A result of a grip of a case.
    pub(super) fn number(&self, case: &str, change: Change, quantity: &str) -> Option<Real> {
        self.record(case)?.scalar(&format!("{}.{quantity}", change.name()))
    }

    /// A result of the grip with this change, in any case.
    pub(super) fn changed(&self, change: Change, quantity: &str) -> Option<Real> {
        let name = format!("{}.{quantity}", change.name());
        self.records.iter().find_map(|record| record.scalar(&name))
    }

    /// A result of the protocol in the reference case.
    pub(super) fn protocol(&self, quantity: &str) -> Option<Real> {
        self.number(&self.reference(), Change::Nothing, quantity)
    }

    /// A result of the protocol, averaged over all fillings of a modulus.
    pub(super) fn of_modulus(&self, modulus: Real, quantity: &str) -> Option<Mean> {
        let of = |filling| {
            self.number(&cases::modulus_name(modulus, filling), Change::Nothing, quantity)
        };
        Mean::new(&(0..self.scene.sweep.n_fillings).filter_map(of).collect::<Vec<_>>())
    }

    /// Holding force over the varied values and the reference, in rising order.
    fn series(
        &self,
        changes: impl Iterator<Item = (Real, Change)>,
        reference: Real,
    ) -> Vec<[Real; 2]> {
        let quantity = "holding_force";
        let varied = changes.filter_map(|(at, change)| Some([at, self.changed(change, quantity)?]));
        let own = self.protocol(quantity).map(|it| [reference, it]);
        let mut points: Vec<[Real; 2]> = varied.chain(own).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }

    /// Holding force (N) over vacuum (Pa, positive).
    pub(super) fn over_pressure(&self) -> Vec<[Real; 2]> {
        let own = self.scene.protocol.pressure;
        let varied = cases::others(&self.scene.sweep.pressures, own);
        let changes = varied.map(|it| (it.abs(), Change::Pressure(it)));
        self.series(changes, -own)
    }

    /// Holding force (N) over the object's friction.
    pub(super) fn over_friction(&self) -> Vec<[Real; 2]> {
        let own = self.scene.gripper.object.friction;
        let varied = cases::others(&self.scene.sweep.frictions, own);
        let changes = varied.map(|it| (it, Change::Friction(it)));
        self.series(changes, own)
    }

    /// Holding force (N) over the object's radius (m).
    pub(super) fn over_radius(&self) -> Vec<[Real; 2]> {
        let own = self.scene.gripper.object.radius;
        let varied = cases::others(&self.scene.sweep.radii, own);
        let changes = varied.map(|it| (it, Change::Radius(it)));
        self.series(changes, own)
    }

    /// A result of the protocol over the number of grains.
    pub(super) fn over_count(&self, quantity: &str) -> Vec<[Real; 2]> {
        let counts = cases::counts(self.scene).into_iter();
        let varied = counts.filter_map(|it| {
            let found = self.number(&cases::count_name(it), Change::Nothing, quantity)?;
            Some([real(it), found])
        });
        let own = self.protocol(quantity).map(|it| [real(self.scene.gripper.grains.count), it]);
        let mut points: Vec<[Real; 2]> = varied.chain(own).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }
}
