//! One case: grow, close, rest, evacuate level by level.

use serde::{Deserialize, Serialize};

use super::{
    build::{self, Parts},
    cases::Case,
    measure::object_pressure,
    scene::{HollowSphereScene, Protocol},
};
use crate::{
    base::{
        Real,
        real::{count, real},
    },
    experiments::{
        Progress, ResumeError, Run, StartError,
        record::{Column, Record},
        saved_run,
    },
    measure::{self, rest::unbalanced_force},
    physics::{
        Scratch, System,
        health::Diverged,
        packing::{Grown, Growth, grow},
    },
};

/// Substeps of a slice.
const SLICE: usize = 100;
/// Share of the work that growth counts for.
const GROWTH_SHARE: Real = 0.15;
/// Share of a level, at its end, over which the pressure on the object is averaged.
const MEAN_SHARE: Real = 0.25;
/// Share of a level in which the vacuum rises.
const RISE_SHARE: Real = 0.5;

/// A phase of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Phase {
    /// Grains grow between the held membranes.
    Growing,
    /// The outer membrane shrinks to its own size.
    Closing,
    /// The packing rests without vacuum.
    Resting,
    /// The vacuum rises to a level, from 1, and stays there.
    Evacuating(usize),
    /// The run is over.
    Done,
}

/// Everything needed to resume, in addition to the state.
#[derive(Clone, Serialize, Deserialize)]
struct RunState {
    phase: Phase,
    /// Substeps in this phase.
    n_in_phase: usize,
    growth: grow::Progress,
    /// Sum of the pressures on the object in the current mean (Pa).
    sum: Real,
    /// Number of pressures in that sum.
    n_sum: usize,
    record: Record,
}

/// A running case.
pub(super) struct HollowSphereRun {
    scene: HollowSphereScene,
    case: Case,
    parts: Parts,
    system: System,
    growth: Growth,
    progress: RunState,
}

impl HollowSphereRun {
    /// The case at its start.
    pub(super) fn new(scene: &HollowSphereScene, case: &Case) -> Result<Self, StartError> {
        let (system, parts) = build::system(scene, case)?;
        let growth = build::growth(&parts);
        let mut record = Record {
            case: case.name.clone(),
            seed: scene.seed + case.filling as u64,
            columns: COLUMNS.iter().map(|(name, unit)| Column::new(name, unit)).collect(),
            ..Record::default()
        };
        record.set("youngs_modulus", case.modulus, "Pa");
        record.set("mass_factor", case.mass_factor, "1");
        record.set("substep", system.model.substep, "s");
        let progress = RunState {
            phase: Phase::Growing,
            n_in_phase: 0,
            growth: growth.progress(),
            sum: 0.0,
            n_sum: 0,
            record,
        };
        Ok(Self { scene: scene.clone(), case: case.clone(), parts, system, growth, progress })
    }

    /// Number of substeps of the current phase; growth has no fixed number.
    fn n_substeps(&self) -> usize {
        let it = &self.scene.protocol;
        let time = match self.progress.phase {
            Phase::Growing | Phase::Done => return usize::MAX,
            Phase::Closing => it.close_time,
            Phase::Resting => it.rest_time,
            Phase::Evacuating(_) => it.level_time,
        };
        count(time / self.system.model.substep)
    }

    /// One substep of the current phase; returns true at its end.
    fn step(&mut self) -> bool {
        self.progress.n_in_phase += 1;
        let (k, n) = (self.progress.n_in_phase, self.n_substeps());
        match self.progress.phase {
            Phase::Growing => {
                let grown = self.growth.step(&mut self.system);
                self.progress.growth = self.growth.progress();
                return grown != Grown::Growing;
            }
            Phase::Closing => {
                let stretch = self.scene.membrane.fill_stretch;
                let scale = stretch + (1.0 - stretch) * real(k) / real(n);
                let outer = 0..self.parts.n_outer;
                self.system.model.membrane.scale_rest_lengths_of(outer, scale);
            }
            Phase::Evacuating(level) => {
                let rise = (real(k) / (RISE_SHARE * real(n))).min(1.0);
                self.system.controls.gauge_setpoint =
                    -gauge(&self.scene.protocol, real(level) - 1.0 + rise);
            }
            Phase::Resting | Phase::Done => {}
        }
        self.system.step();
        if matches!(self.progress.phase, Phase::Evacuating(_) | Phase::Resting)
            && real(n - k) < MEAN_SHARE * real(n)
        {
            self.progress.sum += object_pressure(&self.system, self.scene.object.radius);
            self.progress.n_sum += 1;
        }
        k >= n
    }

    /// Enters the next phase.
    fn enter_next(&mut self) {
        let (name, n) = (self.phase_name(), self.progress.n_in_phase as u64);
        self.progress.record.count(name, n);
        match self.progress.phase {
            Phase::Growing => self.progress.phase = Phase::Closing,
            Phase::Closing => self.progress.phase = Phase::Resting,
            Phase::Resting => {
                self.record_row(0);
                self.progress.phase = Phase::Evacuating(1);
            }
            Phase::Evacuating(level) => {
                self.record_row(level);
                self.progress.phase = Phase::Evacuating(level + 1);
                if level == self.scene.protocol.n_levels {
                    self.progress.phase = Phase::Done;
                    self.progress.record.digest = saved_run::digest(&self.system.state);
                }
            }
            Phase::Done => {}
        }
        self.progress.n_in_phase = 0;
        self.hold();
    }

    fn hold(&mut self) {
        build::hold(&mut self.system.model, self.progress.phase == Phase::Growing);
    }

    fn phase_name(&self) -> &'static str {
        match self.progress.phase {
            Phase::Growing => "growing",
            Phase::Closing => "closing",
            Phase::Resting => "resting",
            Phase::Evacuating(_) => "evacuating",
            Phase::Done => "done",
        }
    }

    /// Records a row at the end of a level.
    fn record_row(&mut self, level: usize) {
        let System { model, state, scratch, .. } = &self.system;
        let packing = measure::packing(state, scratch);
        let radii = state.membrane.positions[..self.parts.n_outer].iter().map(|p| p.norm());
        let unbalanced = unbalanced_force(model, state, scratch);
        let row = [
            gauge(&self.scene.protocol, real(level)),
            self.progress.sum / real(self.progress.n_sum.max(1)),
            measure::grain_volume(state) / measure::enclosed_volume(model, state),
            packing.coordination_number,
            radii.sum::<Real>() / real(self.parts.n_outer),
            packing.overlap_max / (2.0 * model.radius_mean),
            unbalanced,
        ];
        let record = &mut self.progress.record;
        record.push_row(&row);
        let validity = &mut record.validity;
        validity.overlap_over_diameter_max = validity.overlap_over_diameter_max.max(row[5]);
        // Without vacuum there is hardly any force to be balanced.
        if level > 0 {
            validity.unbalanced_force = validity.unbalanced_force.max(unbalanced);
        }
        (self.progress.sum, self.progress.n_sum) = (0.0, 0);
    }

    fn share(&self) -> Real {
        let it = &self.scene.protocol;
        let total = it.total_time();
        let before = match self.progress.phase {
            Phase::Growing => return GROWTH_SHARE * self.progress.growth.scale.powi(3),
            Phase::Closing => 0.0,
            Phase::Resting => it.close_time,
            Phase::Evacuating(level) => {
                it.close_time + it.rest_time + (real(level) - 1.0) * it.level_time
            }
            Phase::Done => total,
        };
        let here = real(self.progress.n_in_phase) * self.system.model.substep;
        GROWTH_SHARE + (1.0 - GROWTH_SHARE) * ((before + here) / total).min(1.0)
    }
}

/// Columns of the record.
const COLUMNS: [(&str, &str); 7] = [
    ("vacuum", "Pa"),
    ("object_pressure", "Pa"),
    ("solid_fraction", "1"),
    ("coordination_number", "1"),
    ("outer_radius", "m"),
    ("overlap_over_diameter", "1"),
    ("unbalanced_force", "1"),
];

impl Run for HollowSphereRun {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let phase = self.phase_name();
        for _ in 0..SLICE {
            if self.progress.phase == Phase::Done {
                break;
            }
            if self.step() {
                self.enter_next();
                break;
            }
        }
        self.system.check(self.progress.n_in_phase as u64)?;
        Ok(Progress { phase, share: self.share(), is_done: self.progress.phase == Phase::Done })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.case.name, &self.progress, [&self.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (progress, [state]): (RunState, _) = saved_run::unpack(&self.case.name, bytes)?;
        saved_run::check_scene(&state, &self.system.state)?;
        self.system.scratch = Scratch::new(&self.system.model);
        self.system.controls.gauge_setpoint = state.gauge;
        self.system.state = state;
        self.growth =
            Growth::resumed(self.parts.recipe, self.parts.final_radii.clone(), progress.growth);
        self.progress = progress;
        self.hold();
        if !matches!(self.progress.phase, Phase::Growing | Phase::Closing) {
            let outer = 0..self.parts.n_outer;
            self.system.model.membrane.scale_rest_lengths_of(outer, 1.0);
        }
        Ok(())
    }

    fn record(&self) -> Record {
        self.progress.record.clone()
    }
}

/// Vacuum at a level (Pa).
fn gauge(protocol: &Protocol, level: Real) -> Real {
    protocol.vacuum * level / real(protocol.n_levels)
}
