//! Discontinuous changes between ticks: insert, remove, teleport, reset.
//!
//! Contacts that a change breaks lose their friction springs; all others keep them. A body that is
//! inserted or teleported must not overlap anything by more than a tenth of a millimeter.

use super::{
    Coupled, FLANGE,
    compile::{body, critical_step_with},
    rapier_world::RapierWorld,
};
use crate::{
    base::{
        Pose, Real, Vec3,
        real::{Twist, real},
    },
    cosim::change_error::ChangeError,
    physics::{
        Model, Scratch, State, System,
        boundary::{
            body::BodyMotion,
            shape::{Bulk, Surface},
        },
        model::{BodyModel, BodySurface},
    },
    scene::{Object, Scene},
};

/// Overlap that a change may cause (m). A body that rests on another one overlaps it slightly.
const OVERLAP_TOLERANCE: Real = 1e-4;

/// What a body would overlap.
enum Obstacle {
    Table,
    Gripper,
    Object(usize),
}

impl Coupled {
    /// Resets to the settled state `start` and the objects of `scene`, in their order.
    pub fn reset_to(&mut self, scene: &Scene, start: &State) {
        let table = self.system.model.bodies.pop();
        let built = scene.objects.iter().filter_map(|object| body(scene, object).ok());
        let (bodies, bulks): (Vec<BodyModel>, Vec<Bulk>) = built.unzip();
        self.system.model.bodies = bodies;
        self.system.model.bodies.extend(table);
        let mut state = start.clone();
        let n_samples = self.system.model.n_samples() * self.system.model.bodies.len();
        state.springs.bodies = vec![Vec3::zeros(); n_samples];
        let step = self.plan.tick / real(self.plan.n_substeps / self.plan.n_per_exchange);
        let world = RapierWorld::new(scene, &self.system.model, bulks, step);
        self.restart(state, world);
    }

    /// Adds `object` after all others.
    ///
    /// # Errors
    /// If it cannot be simulated, or would overlap something.
    pub fn insert(&mut self, scene: &Scene, object: &Object) -> Result<(), ChangeError> {
        let (body, bulk) =
            body(scene, object).map_err(|error| ChangeError::Unusable(error.to_string()))?;
        let critical = critical_step_with(scene, &self.system.model, &body);
        if critical < self.system.model.substep {
            return Err(ChangeError::Unusable(format!(
                "object `{}` needs a substep of at most {critical:.3e} s, but this run uses {:.3e} s: \
                 use a softer material or a scene with a shorter time.substep",
                object.name, self.system.model.substep
            )));
        }
        let pose = super::rapier_world::center_pose(object, &bulk);
        self.check_overlap(scene, &object.name, &body, (&pose, None))?;
        self.world.insert(object, &body, bulk);
        let (n, n_samples) = (self.n_objects(), self.system.model.n_samples());
        self.system.model.bodies.insert(n, body);
        let springs = &mut self.system.state.springs.bodies;
        springs.splice(n * n_samples..n * n_samples, vec![Vec3::zeros(); n_samples]);
        self.rebuild_scratch();
        Ok(())
    }

    /// Removes object `i`.
    pub fn remove(&mut self, i: usize) {
        let n_samples = self.system.model.n_samples();
        self.world.remove(i);
        self.system.model.bodies.remove(i);
        self.system.state.springs.bodies.drain(i * n_samples..(i + 1) * n_samples);
        self.rebuild_scratch();
    }

    /// Moves object `i` to `motion` instantly.
    ///
    /// # Errors
    /// If it would overlap something.
    pub fn place_object(
        &mut self,
        scene: &Scene,
        i: usize,
        motion: &BodyMotion,
    ) -> Result<(), ChangeError> {
        let has_moved = self.world.motion(i).pose != motion.pose;
        if has_moved {
            let (name, body) = (&scene.objects[i].name, &self.system.model.bodies[i]);
            self.check_overlap(scene, name, body, (&motion.pose, Some(i)))?;
            let n_samples = self.system.model.n_samples();
            let springs = &mut self.system.state.springs.bodies;
            springs[i * n_samples..(i + 1) * n_samples].fill(Vec3::zeros());
        }
        self.world.place(i, motion);
        self.rebuild_scratch();
        Ok(())
    }

    /// Moves flange, membrane and grains to `pose` instantly, as one rigid body, and stops the flange.
    ///
    /// # Errors
    /// If the membrane would overlap the table or an object.
    pub fn place_flange(&mut self, scene: &Scene, pose: &Pose) -> Result<(), ChangeError> {
        let mut state = self.system.state.clone();
        move_gripper(&mut state, pose);
        if let Some(other) = self.obstacle_to_gripper(&state) {
            return Err(overlap_error(scene, "gripper_flange", other));
        }
        self.system.state = state;
        self.rebuild_scratch();
        Ok(())
    }

    pub(super) fn rebuild_scratch(&mut self) {
        let System { model, controls, state, scratch } = &mut self.system;
        self.n_objects = model.bodies.len() - 1;
        *controls = super::controls(model, state, &self.world);
        state.springs.surfaces.forget_bodies(state.walls.len());
        *scratch = Scratch::new(model);
    }

    fn check_overlap(
        &self,
        scene: &Scene,
        name: &str,
        body: &BodyModel,
        (pose, except): (&Pose, Option<usize>),
    ) -> Result<(), ChangeError> {
        let BodySurface::Shape(surface) = &body.surface else { return Ok(()) };
        let other = if overlaps_gripper(surface, pose, &self.system.state, &self.system.model) {
            Some(Obstacle::Gripper)
        } else {
            let other = self.world.overlap(surface, pose, except, OVERLAP_TOLERANCE);
            other.map(|it| it.map_or(Obstacle::Table, Obstacle::Object))
        };
        other.map_or(Ok(()), |other| Err(overlap_error(scene, name, other)))
    }

    fn obstacle_to_gripper(&self, state: &State) -> Option<Obstacle> {
        let table = self.system.model.table.translation.z;
        let lowest = |points: &[Vec3]| points.iter().map(|it| it.z).fold(Real::INFINITY, Real::min);
        if lowest(&state.membrane.positions) < table - OVERLAP_TOLERANCE {
            return Some(Obstacle::Table);
        }
        (0..self.n_objects()).find_map(|i| match &self.system.model.bodies[i].surface {
            BodySurface::Shape(surface) => {
                let pose = self.world.motion(i).pose;
                let overlaps = overlaps_gripper(surface, &pose, state, &self.system.model);
                overlaps.then_some(Obstacle::Object(i))
            }
            BodySurface::HalfSpace => None,
        })
    }
}

fn overlap_error(scene: &Scene, what: &str, with: Obstacle) -> ChangeError {
    let with = match with {
        Obstacle::Table => "the table".to_owned(),
        Obstacle::Gripper => "the gripper".to_owned(),
        Obstacle::Object(i) => format!("`{}`", scene.objects[i].name),
    };
    ChangeError::Overlap { what: what.to_owned(), with }
}

/// True if a body would contain a part of the gripper (a vertex, the center of a facet, a grain, the
/// origin of the flange), or if its own center would be inside the membrane.
fn overlaps_gripper(surface: &Surface, pose: &Pose, state: &State, model: &Model) -> bool {
    let is_inside = |point: &Vec3| {
        let local = pose.inverse_transform_point(&(*point).into()).coords;
        surface.distance(&local).distance < -OVERLAP_TOLERANCE
    };
    let at = |v: u32| state.membrane.positions[v as usize];
    let centroids =
        model.membrane.mesh.triangles.iter().map(|&[a, b, c]| (at(a) + at(b) + at(c)) / 3.0);
    state.membrane.positions.iter().any(is_inside)
        || state.grains.positions.iter().any(is_inside)
        || centroids.into_iter().any(|it| is_inside(&it))
        || is_inside(&state.walls[FLANGE].pose.translation.vector)
        || is_inside_membrane(&pose.translation.vector, state, model)
}

/// True if `point` is inside the membrane: below the flange, and the solid angle of all facets as seen
/// from it exceeds π. The plane of the flange closes the membrane, so a point inside sees about 2π.
fn is_inside_membrane(point: &Vec3, state: &State, model: &Model) -> bool {
    let solid_angle = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|v| state.membrane.positions[v as usize] - point);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let below = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * a.dot(&b.cross(&c)).atan2(below)
    };
    let seen: Real = model.membrane.mesh.triangles.iter().map(solid_angle).sum();
    let flange = &state.walls[FLANGE].pose;
    let is_below = flange.inverse_transform_point(&(*point).into()).z < 0.0;
    is_below && std::f64::consts::PI < seen.abs()
}

/// Moves the gripper to `pose`; the velocity field of the flange is subtracted from all velocities.
fn move_gripper(state: &mut State, pose: &Pose) {
    let flange = state.walls[FLANGE];
    let motion = pose * flange.pose.inverse();
    let turn = motion.rotation;
    let origin = flange.pose.translation.vector;
    let velocity = |v: &Vec3, p: &Vec3| turn * (v - flange.twist.at(&(p - origin)));
    let position = |p: &Vec3| motion.transform_point(&(*p).into()).coords;
    let grains = &mut state.grains;
    for i in 0..grains.positions.len() {
        grains.velocities[i] = velocity(&grains.velocities[i], &grains.positions[i]);
        grains.angular_velocities[i] = turn * (grains.angular_velocities[i] - flange.twist.angular);
        grains.positions[i] = position(&grains.positions[i]);
    }
    let membrane = &mut state.membrane;
    for i in 0..membrane.positions.len() {
        membrane.velocities[i] = velocity(&membrane.velocities[i], &membrane.positions[i]);
        membrane.positions[i] = position(&membrane.positions[i]);
    }
    let springs = &mut state.springs;
    for spring in springs
        .pairs
        .iter_mut()
        .chain(&mut springs.walls.springs)
        .chain(&mut springs.spheres.springs)
    {
        *spring = turn * *spring;
    }
    for patches in &mut springs.patches {
        for patch in &mut patches.slots[..patches.n] {
            patch.spring = turn * patch.spring;
            patch.normal = turn * patch.normal;
        }
    }
    for history in &mut springs.surfaces.histories {
        history.spring = turn * history.spring;
        history.normal = turn * history.normal;
    }
    springs.bodies.fill(Vec3::zeros());
    state.walls[FLANGE] = BodyMotion { pose: *pose, twist: Twist::zero() };
}
