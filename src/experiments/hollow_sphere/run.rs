//! One packing on its way: grow, close, rest, evacuate level by level.

use serde::{Deserialize, Serialize};

use super::{
    build::{self, Parts},
    cases::Case,
    scene::{Protocol, Scene},
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
/// Share of the whole that growing is counted as.
const GROWTH_SHARE: Real = 0.15;
/// Share of a level, at its end, over which the pressure on the object is averaged.
const MEAN_SHARE: Real = 0.25;
/// Share of a level in which the vacuum rises.
const RISE_SHARE: Real = 0.5;

/// Where a run is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Stage {
    Growing,
    Closing,
    Resting,
    /// The vacuum rises to a level, from 1, and stays.
    Evacuating(usize),
    Done,
}

/// All that changes, besides the state.
#[derive(Clone, Serialize, Deserialize)]
struct Progressed {
    stage: Stage,
    /// Substeps in this stage.
    n_in_stage: usize,
    growth: grow::Progress,
    /// Sum and number of the object's pressures in the present mean (Pa).
    sum: Real,
    n_sum: usize,
    record: Record,
}

/// A packing on its way.
pub(super) struct Shell {
    scene: Scene,
    case: Case,
    parts: Parts,
    system: System,
    growth: Growth,
    now: Progressed,
}

impl Shell {
    /// At its start.
    pub(super) fn new(scene: &Scene, case: &Case) -> Result<Self, StartError> {
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
        let now = Progressed {
            stage: Stage::Growing,
            n_in_stage: 0,
            growth: growth.progress(),
            sum: 0.0,
            n_sum: 0,
            record,
        };
        Ok(Self { scene: scene.clone(), case: case.clone(), parts, system, growth, now })
    }

    /// Substeps of the present stage; growth has no fixed number.
    fn n_substeps(&self) -> usize {
        let it = &self.scene.protocol;
        let time = match self.now.stage {
            Stage::Growing | Stage::Done => return usize::MAX,
            Stage::Closing => it.close_time,
            Stage::Resting => it.rest_time,
            Stage::Evacuating(_) => it.level_time,
        };
        count(time / self.system.model.substep)
    }

    /// One substep of the present stage; true at its end.
    fn step(&mut self) -> bool {
        self.now.n_in_stage += 1;
        let (k, n) = (self.now.n_in_stage, self.n_substeps());
        match self.now.stage {
            Stage::Growing => {
                let grown = self.growth.step(&mut self.system);
                self.now.growth = self.growth.progress();
                return grown != Grown::Growing;
            }
            Stage::Closing => {
                let stretch = self.scene.membrane.fill_stretch;
                let scale = stretch + (1.0 - stretch) * real(k) / real(n);
                let outer = 0..self.parts.n_outer;
                self.system.model.membrane.scale_rest_lengths_of(outer, scale);
            }
            Stage::Evacuating(level) => {
                let risen = (real(k) / (RISE_SHARE * real(n))).min(1.0);
                self.system.controls.gauge_setpoint =
                    -gauge(&self.scene.protocol, real(level) - 1.0 + risen);
            }
            Stage::Resting | Stage::Done => {}
        }
        self.system.step();
        if matches!(self.now.stage, Stage::Evacuating(_) | Stage::Resting)
            && real(n - k) < MEAN_SHARE * real(n)
        {
            self.now.sum += self.object_pressure();
            self.now.n_sum += 1;
        }
        k >= n
    }

    /// Goes over to the next stage.
    fn turn(&mut self) {
        let (name, n) = (self.stage_name(), self.now.n_in_stage as u64);
        self.now.record.count(name, n);
        match self.now.stage {
            Stage::Growing => self.now.stage = Stage::Closing,
            Stage::Closing => self.now.stage = Stage::Resting,
            Stage::Resting => {
                self.note(0);
                self.now.stage = Stage::Evacuating(1);
            }
            Stage::Evacuating(level) => {
                self.note(level);
                self.now.stage = Stage::Evacuating(level + 1);
                if level == self.scene.protocol.n_levels {
                    self.now.stage = Stage::Done;
                    self.now.record.digest = saved_run::digest(&self.system.state);
                }
            }
            Stage::Done => {}
        }
        self.now.n_in_stage = 0;
        self.hold();
    }

    fn hold(&mut self) {
        build::hold(&mut self.system.model, self.now.stage == Stage::Growing);
    }

    fn stage_name(&self) -> &'static str {
        match self.now.stage {
            Stage::Growing => "growing",
            Stage::Closing => "closing",
            Stage::Resting => "resting",
            Stage::Evacuating(_) => "evacuating",
            Stage::Done => "done",
        }
    }

    /// Pressure of the membrane on the object: the sum of its radial forces over the surface (Pa).
    fn object_pressure(&self) -> Real {
        let radial: Real = (self.system.scratch.sample_forces.iter())
            .filter(|sample| sample.flags.touches())
            .map(|sample| sample.force.dot(&sample.point.normalize()))
            .sum();
        radial / (4.0 * std::f64::consts::PI * self.scene.object.radius.powi(2))
    }

    /// A row of the record at the end of a level.
    fn note(&mut self, level: usize) {
        let System { model, state, scratch, .. } = &self.system;
        let packing = measure::packing(state, scratch);
        let radii = state.membrane.positions[..self.parts.n_outer].iter().map(|p| p.norm());
        let unbalanced = unbalanced_force(model, state, scratch);
        let row = [
            gauge(&self.scene.protocol, real(level)),
            self.now.sum / real(self.now.n_sum.max(1)),
            measure::grain_volume(state) / measure::enclosed_volume(model, state),
            packing.coordination_number,
            radii.sum::<Real>() / real(self.parts.n_outer),
            packing.overlap_max / (2.0 * model.radius_mean),
            unbalanced,
        ];
        let record = &mut self.now.record;
        for (column, value) in record.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
        let validity = &mut record.validity;
        validity.overlap_over_diameter_max = validity.overlap_over_diameter_max.max(row[5]);
        // Before there is a vacuum hardly a force is there to be balanced.
        if level > 0 {
            validity.unbalanced_force = validity.unbalanced_force.max(unbalanced);
        }
        (self.now.sum, self.now.n_sum) = (0.0, 0);
    }

    fn share(&self) -> Real {
        let it = &self.scene.protocol;
        let all = it.total_time();
        let before = match self.now.stage {
            Stage::Growing => return GROWTH_SHARE * self.now.growth.scale.powi(3),
            Stage::Closing => 0.0,
            Stage::Resting => it.close_time,
            Stage::Evacuating(level) => {
                it.close_time + it.rest_time + (real(level) - 1.0) * it.level_time
            }
            Stage::Done => all,
        };
        let here = real(self.now.n_in_stage) * self.system.model.substep;
        GROWTH_SHARE + (1.0 - GROWTH_SHARE) * ((before + here) / all).min(1.0)
    }
}

/// Names and units of the record's columns.
const COLUMNS: [(&str, &str); 7] = [
    ("vacuum", "Pa"),
    ("object_pressure", "Pa"),
    ("solid_fraction", "1"),
    ("coordination_number", "1"),
    ("outer_radius", "m"),
    ("overlap_over_diameter", "1"),
    ("unbalanced_force", "1"),
];

impl Run for Shell {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let stage = self.stage_name();
        for _ in 0..SLICE {
            if self.now.stage == Stage::Done {
                break;
            }
            if self.step() {
                self.turn();
                break;
            }
        }
        self.system.check(self.now.n_in_stage as u64)?;
        Ok(Progress { stage, share: self.share(), is_done: self.now.stage == Stage::Done })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.case.name, &self.now, [&self.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let (now, [state]): (Progressed, _) = saved_run::unpack(&self.case.name, bytes)?;
        saved_run::of_one_scene(&state, &self.system.state)?;
        self.system.scratch = Scratch::new(&self.system.model);
        self.system.controls.gauge_setpoint = state.gauge;
        self.system.state = state;
        self.growth =
            Growth::resumed(self.parts.recipe, self.parts.final_radii.clone(), now.growth);
        self.now = now;
        self.hold();
        if !matches!(self.now.stage, Stage::Growing | Stage::Closing) {
            let outer = 0..self.parts.n_outer;
            self.system.model.membrane.scale_rest_lengths_of(outer, 1.0);
        }
        Ok(())
    }

    fn record(&self) -> Record {
        self.now.record.clone()
    }
}

/// Vacuum at a level (Pa).
fn gauge(protocol: &Protocol, level: Real) -> Real {
    protocol.vacuum * level / real(protocol.n_levels)
}
