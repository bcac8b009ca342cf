//! One case: the ball is drawn along its way, substep by substep.
//!
//! The system moves freely for one substep; then the ball is put where it must be: the load, which
//! the system does not know, is added to its fall, its horizontal motion is set to the prescribed
//! one, and its spin to nothing. That is the same as a force and a guide that act during the substep.

use super::{
    build::{Patch, Way},
    expected::{self, Bed},
    scene::{Pull, Scene},
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
    physics::{
        Scratch, State, System, SystemBuilder,
        builder::{BuildError, Membrane, Vertices, Wall},
        contact::sums,
        health::Diverged,
        law::PairLaw,
        membrane::{MembraneContact, MembraneModel, critical_step},
        state::Grains,
    },
};

/// What is drawn over what.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) has_spheres: bool,
    pub(super) way: Way,
    /// [N]
    pub(super) load: Real,
    /// Factor on the moduli of the contact.
    pub(super) stiffening: Real,
    pub(super) pull: Pull,
    /// True if only the edge of the sheet is held.
    pub(super) is_framed: bool,
    /// Distance of neighbouring vertices [m].
    pub(super) edge: Real,
}

/// Gravity [m/s²].
const GRAVITY: Real = 9.81;
/// Substeps of a slice.
const SLICE: u64 = 4000;
/// Neighbors are listed this share of the ball's radius beyond contact.
const SKIN_SHARE: Real = 0.25;
/// Share of the critical step that a free sheet is computed with.
const SAFETY: Real = 0.8;
/// Columns of the record.
const COLUMNS: [(&str, &str); 6] = [
    ("distance", "m"),
    ("height", "m"),
    ("friction_force", "N"),
    ("force_across", "N"),
    ("normal_force", "N"),
    ("contacts", "1"),
];

impl Case {
    /// Law between ball and membrane.
    pub(super) fn law(&self, scene: &Scene) -> PairLaw {
        let membrane = &scene.membrane;
        let mut law = PairLaw::between(&scene.ball.material, &membrane.material, membrane.surface);
        law.modulus *= self.stiffening;
        law.shear_modulus *= self.stiffening;
        law
    }

    /// Load and weight [N].
    pub(super) fn weight(&self, scene: &Scene) -> Real {
        self.load + mass(scene) * GRAVITY
    }

    /// The spheres under one period of the way, as those that meet the ball see it.
    pub(super) fn bed<'a>(&self, scene: &Scene, centres: &'a [Vec3]) -> Bed<'a> {
        let (ball, sphere) = (scene.ball.radius, scene.membrane.sphere_radius);
        Bed {
            law: self.law(scene),
            reach: ball + sphere,
            shared_radius: ball * sphere / (ball + sphere),
            centres,
            load: self.weight(scene),
            along: self.period().normalize(),
        }
    }

    /// One period of the way [m].
    pub(super) fn period(&self) -> Vec3 {
        self.way.period(self.edge)
    }

    /// The vertices that the ball meets.
    pub(super) fn patch(&self, scene: &Scene) -> Result<Patch, StartError> {
        let edge = self.edge;
        let margin = Vec3::repeat(scene.ball.radius + scene.membrane.sphere_radius + edge);
        let (low, high) = if self.is_framed {
            let half = Vec3::repeat(scene.frame.size / 2.0);
            (-half, half)
        } else {
            let period = self.period();
            (Vec3::zeros().inf(&period) - margin, Vec3::zeros().sup(&period) + margin)
        };
        Ok(Patch::between(edge, &low, &high)?)
    }
}

/// Mass of the ball [kg].
fn mass(scene: &Scene) -> Real {
    4.0 / 3.0 * std::f64::consts::PI * scene.ball.radius.powi(3) * scene.ball.material.density
}

/// A case on its way.
pub(super) struct Ride {
    case: Case,
    system: System,
    /// Where the ball starts [m].
    start: Vec3,
    /// Of each vertex, the one that a period behind it; empty if the ball is not set back.
    behind: Vec<Option<u32>>,
    period: Real,
    along: Vec3,
    /// Substeps before the ball is drawn.
    n_settling: u64,
    n_substeps: u64,
    n_per_record: u64,
    n_done: u64,
    record: Record,
}

impl Ride {
    /// The ball at its start.
    pub(super) fn new(scene: &Scene, case: Case) -> Result<Self, StartError> {
        let patch = case.patch(scene)?;
        let behind = if case.is_framed { Vec::new() } else { patch.behind(case.way) };
        let period = case.period();
        let start = start(scene, &case, &patch);
        let system = system(scene, &case, patch, start)?;
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
            self.look(&before);
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

    /// Sets ball and springs back by one period: on a held lattice that changes nothing.
    fn set_back(&mut self) {
        let State { grains, springs, .. } = &mut self.system.state;
        grains.positions[0] -= self.along * self.period;
        let (mut ids, mut kept) = (Vec::new(), Vec::new());
        for (&[grain, vertex], &spring) in springs.spheres.ids.iter().zip(&springs.spheres.springs)
        {
            // What has nothing behind it lies before the patch's end, out of the ball's reach.
            if let Some(behind) = self.behind[vertex as usize] {
                ids.push([grain, behind]);
                kept.push(spring);
            }
        }
        (springs.spheres.ids, springs.spheres.springs) = (ids, kept);
        self.system.scratch.neighbors.is_built = false;
    }

    /// Records the forces of the last substep at the place where they acted.
    fn look(&mut self, at: &Vec3) {
        let System { model, state, scratch, .. } = &self.system;
        let (force, _) = sums::on_grain(&state.grains, scratch, 0);
        let seen = packing(state, scratch);
        let n_drawn = real_of(self.n_done - self.n_settling);
        let distance = n_drawn * self.case.pull.speed * model.substep;
        let across = Vec3::z().cross(&self.along);
        let row = [
            distance,
            at.z,
            -force.dot(&self.along),
            force.dot(&across),
            force.z,
            real(seen.n_membrane_contacts),
        ];
        for (column, value) in self.record.columns.iter_mut().zip(row) {
            column.values.push(value);
        }
        let diameter = match model.membrane.contact {
            MembraneContact::Triangles => 2.0 * model.radius_max,
            MembraneContact::Spheres { radius } => model.radius_max + radius,
        };
        let worst = &mut self.record.validity.overlap_over_diameter_max;
        *worst = worst.max(seen.membrane_overlap_max / diameter);
    }
}

impl Run for Ride {
    fn advance(&mut self) -> Result<Progress, Diverged> {
        let until = self.n_substeps.min(self.n_done + SLICE);
        let stage = if self.n_done < self.n_settling { "settling" } else { "sliding" };
        while self.n_done < until {
            self.step();
        }
        self.system.check(self.n_done)?;
        self.record.digest = saved_run::digest(&self.system.state);
        let settled = self.n_done.min(self.n_settling);
        self.record.n_substeps = [("settling", settled), ("sliding", self.n_done - settled)]
            .map(|(stage, n)| (stage.to_owned(), n))
            .into();
        let share = real_of(self.n_done) / real_of(self.n_substeps);
        Ok(Progress { stage, share, is_done: self.n_done == self.n_substeps })
    }

    fn save(&self) -> Vec<u8> {
        saved_run::pack(&self.record.case, &(self.n_done, &self.record), [&self.system.state])
    }

    fn resume(&mut self, bytes: &[u8]) -> Result<(), ResumeError> {
        let ((n_done, record), [state]) = saved_run::unpack(&self.record.case, bytes)?;
        saved_run::of_one_scene(&state, &self.system.state)?;
        self.system.state = state;
        self.system.scratch = Scratch::new(&self.system.model);
        (self.n_done, self.record) = (n_done, record);
        Ok(())
    }

    fn record(&self) -> Record {
        self.record.clone()
    }
}

/// Above a vertex: at rest under its load where all vertices are held, else just in touch.
fn start(scene: &Scene, case: &Case, patch: &Patch) -> Vec3 {
    let law = case.law(scene);
    let radius = scene.ball.radius;
    if case.is_framed {
        let n_edges = (scene.frame.length / 2.0 / case.edge).round();
        let up = if case.has_spheres { radius + scene.membrane.sphere_radius } else { radius };
        return Vec3::new(-n_edges * case.edge, 0.0, up);
    }
    let height = if case.has_spheres {
        case.bed(scene, &patch.mesh.positions).rest(&Vec3::zeros(), 0.0).height
    } else {
        radius - expected::overlap(&law, radius, case.weight(scene))
    };
    Vec3::z() * height
}

/// The ball over the membrane, which a frame holds.
fn system(scene: &Scene, case: &Case, patch: Patch, start: Vec3) -> Result<System, BuildError> {
    let radius = scene.ball.radius;
    let law = case.law(scene);
    let mut membrane = MembraneModel::new(patch.mesh, scene.membrane.sheet);
    let mut contact_radius = radius;
    if case.has_spheres {
        let sphere = scene.membrane.sphere_radius;
        membrane.contact = MembraneContact::Spheres { radius: sphere };
        contact_radius = radius * sphere / (radius + sphere);
    }
    let (mut substep, mut held) = (case.pull.substep, Vertices::All);
    if case.is_framed {
        held = Vertices::Rims;
        membrane.scale_rest_lengths(1.0 / (1.0 + scene.frame.stretch));
        let stiffness = law.stiffness(contact_radius, case.weight(scene));
        let longest = SAFETY * critical_step::critical_step(&membrane, stiffness);
        substep = substep.min(longest);
    }
    let mut builder = SystemBuilder::new(law);
    builder.gravity(Vec3::z() * -GRAVITY).substep(substep).skin(SKIN_SHARE * radius);
    builder.grains(Grains::at_rest(vec![start], vec![radius], vec![mass(scene)]));
    let frame = builder.wall(Wall::frame());
    builder.membrane(Membrane::of(membrane).hold(held, frame));
    builder.build()
}

/// A positive real as a whole number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "some million substeps"
)]
fn count(value: Real) -> u64 {
    value.round() as u64
}
