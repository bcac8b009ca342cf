//! One case: the ball is pulled over the membrane, substep by substep.
//!
//! The system moves freely for one substep. Then the load, which is not part of the system, is added
//! to the ball's fall, its horizontal motion is replaced by the prescribed one, and its spin is set
//! to zero. That is equivalent to a force and a guide that act during the substep.

use super::{
    build::{self, Patch},
    cases::Case,
    scene::SlideScene,
};
use crate::{
    base::{
        Real, Vec3,
        real::{real, real_of},
    },
    experiments::{
        Progress, ResumeError, Run, StartError,
        record::{Column, Record},
        saved_run,
    },
    measure::packing,
    physics::{Scratch, State, System, contact::sums, health::Diverged, membrane::MembraneContact},
};

/// Substeps of a slice.
const SLICE: u64 = 4000;
/// Columns of the record.
const COLUMNS: [(&str, &str); 6] = [
    ("distance", "m"),
    ("height", "m"),
    ("friction_force", "N"),
    ("force_across", "N"),
    ("normal_force", "N"),
    ("contacts", "1"),
];

/// A running case.
pub(super) struct SlideRun {
    case: Case,
    system: System,
    /// Position of the ball at the start (m).
    start: Vec3,
    /// For each vertex, the vertex one period behind it; empty if the ball is never set back.
    behind: Vec<Option<u32>>,
    /// Length of a period (m).
    period: Real,
    /// Unit vector in the direction of the pull.
    along: Vec3,
    /// Substeps before the ball is pulled.
    n_settling: u64,
    n_substeps: u64,
    n_per_record: u64,
    n_done: u64,
    record: Record,
}

impl SlideRun {
    /// The ball at its start.
    pub(super) fn new(scene: &SlideScene, case: Case) -> Result<Self, StartError> {
        let patch = Patch::new(scene, &case)?;
        let behind =
            if case.is_framed { Vec::new() } else { patch.one_period_behind(case.direction) };
        let period = case.period();
        let start = build::start(scene, &case, &patch);
        let system = build::system(scene, &case, patch, start)?;
        let dt = system.model.substep;
        let settle = if case.is_framed { scene.frame.settle } else { 0.0 };
        let n_settling = count(settle / dt);
        let n_substeps = n_settling + count(case.pull.length / (case.pull.speed * dt));
        let n_per_record = count(scene.record_every / (case.pull.speed * dt)).max(1);
        let columns = COLUMNS.map(|(name, unit)| Column::new(name, unit)).to_vec();
        Ok(Self {
            case,
            system,
            start,
            behind,
            period: period.norm(),
            along: period.normalize(),
            n_settling,
            n_substeps,
            n_per_record,
            n_done: 0,
            record: Record { case: case.name.to_owned(), columns, ..Record::default() },
        })
    }

    fn step(&mut self) {
        let dt = self.system.model.substep;
        let is_settling = self.n_done < self.n_settling;
        let speed = if is_settling { 0.0 } else { self.case.pull.speed };
        let before = self.system.state.grains.positions[0];
        self.system.step();
        if !is_settling && (self.n_done - self.n_settling).is_multiple_of(self.n_per_record) {
            self.record_row(&before);
        }
        let grains = &mut self.system.state.grains;
        let ramp = 2.0 * real_of(self.n_done) / real_of(self.n_settling.max(1));
        let load = if is_settling { ramp.min(1.0) } else { 1.0 } * self.case.load;
        let gained = load / grains.masses[0] * dt;
        let (x, v) = (&mut grains.positions[0], &mut grains.velocities[0]);
        let (height, fall) = (x.z - gained * dt, v.z - gained);
        *v = self.along * speed;
        *x = before + *v * dt;
        (x.z, v.z) = (height, fall);
        grains.angular_velocities[0] = Vec3::zeros();
        self.n_done += 1;
        if !self.behind.is_empty() && (*x - self.start).dot(&self.along) >= self.period {
            self.set_back();
        }
    }

    /// Moves ball and springs back by one period. On a held lattice that changes nothing.
    fn set_back(&mut self) {
        let State { grains, springs, .. } = &mut self.system.state;
        grains.positions[0] -= self.along * self.period;
        let (mut ids, mut kept) = (Vec::new(), Vec::new());
        for (&[grain, vertex], &spring) in springs.spheres.ids.iter().zip(&springs.spheres.springs)
        {
            // A vertex without one behind it is near the patch's end, out of the ball's reach.
            if let Some(behind) = self.behind[vertex as usize] {
                ids.push([grain, behind]);
                kept.push(spring);
            }
        }
        (springs.spheres.ids, springs.spheres.springs) = (ids, kept);
        self.system.scratch.neighbors.is_built = false;
    }

    /// Records the forces of the last substep, which acted on the ball at `position`.
    fn record_row(&mut self, position: &Vec3) {
        let System { model, state, scratch, .. } = &self.system;
        let (force, _) = sums::on_grain(&state.grains, scratch, 0);
        let packing = packing(state, scratch);
        let n_pulled = real_of(self.n_done - self.n_settling);
        let distance = n_pulled * self.case.pull.speed * model.substep;
        let across = Vec3::z().cross(&self.along);
        self.record.push_row(&[
            distance,
            position.z,
            -force.dot(&self.along),
            force.dot(&across),
            force.z,
            real(packing.n_membrane_contacts),
        ]);
        let diameter = match model.membrane.contact {
            MembraneContact::Triangles => 2.0 * model.radius_max,
            MembraneContact::Spheres { radius } => model.radius_max + radius,
        };
        let largest = &mut self.record.validity.overlap_over_diameter_max;
        *largest = largest.max(packing.membrane_overlap_max / diameter);
    }
}

impl Run for SlideRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let until = self.n_substeps.min(self.n_done + SLICE);
        let phase = if self.n_done < self.n_settling { "settling" } else { "sliding" };
        while self.n_done < until {
            self.step();
        }
        self.system.check(self.n_done)?;
        self.record.digest = saved_run::digest(&self.system.state);
        let settled = self.n_done.min(self.n_settling);
        self.record.n_substeps = [("settling", settled), ("sliding", self.n_done - settled)]
            .map(|(phase, n)| (phase.to_owned(), n))
            .into();
        let share = real_of(self.n_done) / real_of(self.n_substeps);
        Ok(Progress { phase, share, is_done: self.n_done == self.n_substeps })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.record.case, &(self.n_done, &self.record), [&self.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let ((n_done, record), [state]) = saved_run::unpack(&self.record.case, bytes)?;
        saved_run::check_scene(&state, &self.system.state)?;
        self.system.state = state;
        self.system.scratch = Scratch::new(&self.system.model);
        (self.n_done, self.record) = (n_done, record);
        Ok(())
    }

    fn record(&self) -> Record {
        self.record.clone()
    }
}

/// A positive number rounded to an integer.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few million substeps"
)]
fn count(value: Real) -> u64 {
    value.round() as u64
}
