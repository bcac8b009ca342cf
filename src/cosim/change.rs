//! Changes that no body could make by moving: others in, out, elsewhere, and back to the start.
//!
//! Contacts that a change tears apart lose their friction springs; all others keep them. Whatever is
//! put somewhere must find room there: nothing may overlap by more than a tenth of a millimetre.

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
    cosim::refused::ChangeError,
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

/// Overlap that a body may have where it is put (m): what rests on something sinks in a little.
const OVERLAP_TOLERANCE: Real = 1e-4;

/// Who is in the way.
enum InTheWay {
    Table,
    Bag,
    Object(usize),
}

impl Coupled {
    /// Restarts with the settled bag `start` and the objects of `scene`, in their order.
    pub fn start_anew(&mut self, scene: &Scene, start: &State) {
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

    /// Adds `object` behind all others.
    ///
    /// # Errors
    /// If it cannot be simulated, or something is where it shall be.
    pub fn insert(&mut self, scene: &Scene, object: &Object) -> Result<(), ChangeError> {
        let (body, bulk) =
            body(scene, object).map_err(|fault| ChangeError::Unusable(fault.to_string()))?;
        let critical = critical_step_with(scene, &self.system.model, &body);
        if critical < self.system.model.substep {
            return Err(ChangeError::Unusable(format!(
                "object `{}` needs a substep of {critical:.3e} s, this run has {:.3e} s: take a \
                 softer material, or a scene with a shorter time.substep",
                object.name, self.system.model.substep
            )));
        }
        let pose = super::rapier_world::centre_pose(object, &bulk);
        self.refuse_overlap(scene, &object.name, &body, (&pose, None))?;
        self.world.insert(object, &body, bulk);
        let (n, n_samples) = (self.n_objects(), self.system.model.n_samples());
        self.system.model.bodies.insert(n, body);
        let springs = &mut self.system.state.springs.bodies;
        springs.splice(n * n_samples..n * n_samples, vec![Vec3::zeros(); n_samples]);
        self.start_over_lists();
        Ok(())
    }

    /// Takes object `i` away.
    pub fn remove(&mut self, i: usize) {
        let n_samples = self.system.model.n_samples();
        self.world.remove(i);
        self.system.model.bodies.remove(i);
        self.system.state.springs.bodies.drain(i * n_samples..(i + 1) * n_samples);
        self.start_over_lists();
    }

    /// Puts object `i` elsewhere.
    ///
    /// # Errors
    /// If something is there.
    pub fn place_object(
        &mut self,
        scene: &Scene,
        i: usize,
        motion: &BodyMotion,
    ) -> Result<(), ChangeError> {
        let is_elsewhere = self.world.motion(i).pose != motion.pose;
        if is_elsewhere {
            let (name, body) = (&scene.objects[i].name, &self.system.model.bodies[i]);
            self.refuse_overlap(scene, name, body, (&motion.pose, Some(i)))?;
            let n_samples = self.system.model.n_samples();
            let springs = &mut self.system.state.springs.bodies;
            springs[i * n_samples..(i + 1) * n_samples].fill(Vec3::zeros());
        }
        self.world.place(i, motion);
        self.start_over_lists();
        Ok(())
    }

    /// Puts flange, membrane and grains elsewhere as one rigid body, at rest as a whole.
    ///
    /// # Errors
    /// If the bag would be in the table or in an object there.
    pub fn place_flange(&mut self, scene: &Scene, pose: &Pose) -> Result<(), ChangeError> {
        let mut state = self.system.state.clone();
        carry(&mut state, pose);
        if let Some(other) = self.in_the_bags_way(&state) {
            return Err(refused(scene, "gripper_flange", other));
        }
        self.system.state = state;
        self.start_over_lists();
        Ok(())
    }

    pub(super) fn start_over_lists(&mut self) {
        let System { model, controls, state, scratch } = &mut self.system;
        self.n_objects = model.bodies.len() - 1;
        *controls = super::controls(model, state, &self.world);
        state.springs.surfaces.forget_bodies(state.walls.len());
        *scratch = Scratch::new(model);
    }

    fn refuse_overlap(
        &self,
        scene: &Scene,
        name: &str,
        body: &BodyModel,
        (pose, except): (&Pose, Option<usize>),
    ) -> Result<(), ChangeError> {
        let BodySurface::Shape(surface) = &body.surface else { return Ok(()) };
        let other = if reaches_into(surface, pose, &self.system.state, &self.system.model) {
            Some(InTheWay::Bag)
        } else {
            let other = self.world.overlap(surface, pose, except, OVERLAP_TOLERANCE);
            other.map(|it| it.map_or(InTheWay::Table, InTheWay::Object))
        };
        other.map_or(Ok(()), |other| Err(refused(scene, name, other)))
    }

    fn in_the_bags_way(&self, state: &State) -> Option<InTheWay> {
        let table = self.system.model.table.translation.z;
        let lowest = |points: &[Vec3]| points.iter().map(|it| it.z).fold(Real::INFINITY, Real::min);
        if lowest(&state.membrane.positions) < table - OVERLAP_TOLERANCE {
            return Some(InTheWay::Table);
        }
        (0..self.n_objects()).find_map(|i| match &self.system.model.bodies[i].surface {
            BodySurface::Shape(surface) => {
                let pose = self.world.motion(i).pose;
                let is_there = reaches_into(surface, &pose, state, &self.system.model);
                is_there.then_some(InTheWay::Object(i))
            }
            BodySurface::HalfSpace => None,
        })
    }
}

fn refused(scene: &Scene, what: &str, with: InTheWay) -> ChangeError {
    let with = match with {
        InTheWay::Table => "the table".to_owned(),
        InTheWay::Bag => "the gripper".to_owned(),
        InTheWay::Object(i) => format!("`{}`", scene.objects[i].name),
    };
    ChangeError::Overlap { what: what.to_owned(), with }
}

/// True if a body would have a piece of the bag inside: a vertex, the middle of a facet, a grain, or
/// if it reached through the flange's plane within the rim.
fn reaches_into(surface: &Surface, pose: &Pose, state: &State, model: &Model) -> bool {
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
        || is_enclosed(&pose.translation.vector, state, model)
}

/// True if `point` is inside the bag: the facets, seen from it, cover more than half of what they
/// would cover from inside. The flange's plane closes the bag, so a point inside sees about 2π.
fn is_enclosed(point: &Vec3, state: &State, model: &Model) -> bool {
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

/// Moves the bag with its flange to `pose`; the flange's own motion is taken out of all velocities.
fn carry(state: &mut State, pose: &Pose) {
    let flange = state.walls[FLANGE];
    let way = pose * flange.pose.inverse();
    let turn = way.rotation;
    let origin = flange.pose.translation.vector;
    let velocity = |v: &Vec3, p: &Vec3| turn * (v - flange.twist.at(&(p - origin)));
    let place = |p: &Vec3| way.transform_point(&(*p).into()).coords;
    let grains = &mut state.grains;
    for i in 0..grains.positions.len() {
        grains.velocities[i] = velocity(&grains.velocities[i], &grains.positions[i]);
        grains.angular_velocities[i] = turn * (grains.angular_velocities[i] - flange.twist.angular);
        grains.positions[i] = place(&grains.positions[i]);
    }
    let membrane = &mut state.membrane;
    for i in 0..membrane.positions.len() {
        membrane.velocities[i] = velocity(&membrane.velocities[i], &membrane.positions[i]);
        membrane.positions[i] = place(&membrane.positions[i]);
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
