//! The entities of the world and their states: the objects, the flange, the gripper's bag (membrane
//! and grains as one entity), and the table.
//!
//! The frame of an object has its origin in the center of mass, as in `/tf`. States are reported in
//! the world frame. A state to be set may name any of the frames; its velocities are relative to
//! the world, along the axes of that frame. Accelerations cannot be set, because the simulator
//! computes them from forces.

use super::{Simulator, World, bounds, failed, ok};
use crate::{
    base::{
        Pose, Quat, Vec3,
        real::{Twist, Wrench},
    },
    command::{
        apply::{self, object_frame},
        change::Change,
    },
    cosim::{change_error::ChangeError, rapier_world::TABLE_HALF},
    physics::boundary::shape::Aabb,
    snapshot::Snapshot,
    wire::{
        cdr::Cdr,
        messages::{
            builtin_interfaces::Time,
            geometry_msgs as g,
            simulation_interfaces::{
                EntityState, GetEntitiesRequest, GetEntitiesResponse, GetEntitiesStatesRequest,
                GetEntitiesStatesResponse, GetEntityInfoRequest, GetEntityInfoResponse,
                GetEntityStateRequest, GetEntityStateResponse, Result as SimResult,
                SetEntityInfoRequest, SetEntityInfoResponse, SetEntityStateRequest,
                SetEntityStateResponse,
            },
            std_msgs::Header,
        },
    },
};

/// The entity of the plate that the membrane is attached to.
pub(super) const FLANGE: &str = apply::FLANGE;
/// The entity of membrane and grains.
pub(super) const BAG: &str = "bag";
/// The entity of the table.
pub(super) const TABLE: &str = "table";

/// Largest deviation of a quaternion's norm from 1.
const NORM_TOLERANCE: f64 = 1e-3;

/// An entity of the world.
#[derive(Clone, Debug)]
pub(super) struct Entity {
    pub(super) name: String,
    pub(super) pose: Pose,
    pub(super) twist: Twist,
    /// Bounding box along its own axes.
    pub(super) extent: Aabb,
}

/// Velocities of all moving entities, with their names.
pub(super) fn twists(snapshot: &Snapshot) -> Vec<(String, Twist)> {
    let objects = snapshot.objects.iter().map(|it| (it.name.clone(), it.body.twist));
    let gripper = [FLANGE, BAG].map(|it| (it.to_owned(), snapshot.flange.twist));
    objects.chain(gripper).collect()
}

/// Decodes a request of either version. Requests of version 1 lack the flags; they set everything.
pub(super) fn read_set_entity_state(
    body: &Cdr,
) -> Result<SetEntityStateRequest, cdr_encoding::Error> {
    body.read().or_else(|error| {
        let mut bytes = body.bytes.clone();
        bytes.extend([1; 3]);
        let with_flags = Cdr { bytes, is_big_endian: body.is_big_endian };
        with_flags.read().map_err(|_| error)
    })
}

impl Simulator {
    /// All entities, in a fixed order. The membrane's extent is computed only `with_extents`.
    pub(super) fn entities(&self, world: &World<'_>, with_extents: bool) -> Vec<Entity> {
        if !self.has_world() {
            return Vec::new();
        }
        let snapshot = world.snapshot;
        let nothing = Aabb { min: Vec3::zeros(), max: Vec3::zeros() };
        let objects = snapshot.objects.iter().map(|object| {
            let body = object.body;
            let extent = self.entity_table.extent(&object.name).unwrap_or(nothing);
            Entity { name: object.name.clone(), pose: body.pose, twist: body.twist, extent }
        });
        let mut entities: Vec<Entity> = objects.collect();
        let (pose, twist) = (snapshot.flange.pose, snapshot.flange.twist);
        let radius = self.scene.membrane.radius;
        let plate = Vec3::new(radius, radius, 0.0);
        let extent = Aabb { min: -plate, max: plate };
        entities.push(Entity { name: FLANGE.to_owned(), pose, twist, extent });
        let extent = if with_extents { self.membrane_extent(world) } else { nothing };
        entities.push(Entity { name: BAG.to_owned(), pose, twist, extent });
        let [edge, thickness] = TABLE_HALF;
        let extent = Aabb {
            min: Vec3::new(-edge, -edge, -2.0 * thickness),
            max: Vec3::new(edge, edge, 0.0),
        };
        let pose = Pose::translation(0.0, 0.0, self.scene.table.height);
        entities.push(Entity { name: TABLE.to_owned(), pose, twist: Twist::zero(), extent });
        entities
    }

    /// Bounding box of the membrane along the axes of the flange; all grains are inside it.
    fn membrane_extent(&self, world: &World<'_>) -> Aabb {
        let now = (world.snapshot.time_ns, world.snapshot.digest);
        let mut cached = self.membrane_extent.borrow_mut();
        match *cached {
            Some((when, extent)) if when == now => extent,
            _ => {
                let full = world.access.full_snapshot();
                let points = full.membrane.map(|it| it.positions).unwrap_or_default();
                let extent = bounds::around(&points, &world.snapshot.flange.pose);
                *cached = Some((now, extent));
                extent
            }
        }
    }

    pub(super) fn find_entity(&self, name: &str, world: &World<'_>) -> Result<Entity, String> {
        let all = self.entities(world, name == BAG);
        all.into_iter().find(|it| it.name == name).ok_or_else(|| format!("no entity `{name}`"))
    }

    pub(super) fn get_entities(
        &self,
        request: &GetEntitiesRequest,
        world: &World<'_>,
    ) -> GetEntitiesResponse {
        let with_extents = request.filters.bounds.r#type != 0;
        match self.filtered(self.entities(world, with_extents), &request.filters) {
            Ok(found) => {
                let entities = found.into_iter().map(|it| it.name).collect();
                GetEntitiesResponse { result: ok(), entities }
            }
            Err(result) => GetEntitiesResponse { result, ..Default::default() },
        }
    }

    pub(super) fn get_entities_states(
        &self,
        request: &GetEntitiesStatesRequest,
        world: &World<'_>,
    ) -> GetEntitiesStatesResponse {
        let with_extents = request.filters.bounds.r#type != 0;
        match self.filtered(self.entities(world, with_extents), &request.filters) {
            Ok(found) => GetEntitiesStatesResponse {
                result: ok(),
                states: found.iter().map(|it| self.state(it, world.snapshot.time_ns)).collect(),
                entities: found.into_iter().map(|it| it.name).collect(),
            },
            Err(result) => GetEntitiesStatesResponse { result, ..Default::default() },
        }
    }

    pub(super) fn get_entity_state(
        &self,
        request: &GetEntityStateRequest,
        world: &World<'_>,
    ) -> GetEntityStateResponse {
        match self.find_entity(&request.entity, world) {
            Ok(entity) => {
                let state = self.state(&entity, world.snapshot.time_ns);
                GetEntityStateResponse { result: ok(), state }
            }
            Err(reason) => {
                let result = failed(SimResult::RESULT_NOT_FOUND, reason);
                GetEntityStateResponse { result, ..Default::default() }
            }
        }
    }

    fn state(&self, entity: &Entity, time_ns: u64) -> EntityState {
        let acceleration = self.acceleration(&entity.name, time_ns);
        EntityState {
            header: Header { stamp: stamp(time_ns), frame_id: apply::WORLD.to_owned() },
            pose: pose_message(&entity.pose),
            twist: g::Twist {
                linear: vector(&entity.twist.linear),
                angular: vector(&entity.twist.angular),
            },
            acceleration: g::Accel {
                linear: vector(&acceleration.force),
                angular: vector(&acceleration.torque),
            },
        }
    }

    /// Mean acceleration over the last tick; zero unless two consecutive ticks are known.
    fn acceleration(&self, name: &str, time_ns: u64) -> Wrench {
        let [(before_ns, before), (now_ns, now)] = &self.twists;
        let find = |twists: &[(String, Twist)]| {
            twists.iter().find(|(it, _)| it == name).map(|(_, twist)| *twist)
        };
        match (find(before), find(now)) {
            (Some(a), Some(b)) if *now_ns == time_ns && before_ns < now_ns => {
                let dt = std::time::Duration::from_nanos(now_ns - before_ns).as_secs_f64();
                Wrench { force: (b.linear - a.linear) / dt, torque: (b.angular - a.angular) / dt }
            }
            _ => Wrench::zero(),
        }
    }

    pub(super) fn set_entity_state(
        &mut self,
        request: &SetEntityStateRequest,
        world: &mut World<'_>,
    ) -> SetEntityStateResponse {
        let result = match self.find_entity(&request.entity, world) {
            Err(reason) => failed(SimResult::RESULT_NOT_FOUND, reason),
            Ok(entity) => match self.set_state(&entity, request, world) {
                Ok(()) => ok(),
                Err(result) => result,
            },
        };
        SetEntityStateResponse { result }
    }

    fn set_state(
        &mut self,
        entity: &Entity,
        request: &SetEntityStateRequest,
        world: &mut World<'_>,
    ) -> Result<(), SimResult> {
        const INVALID: u8 = SetEntityStateResponse::INVALID_POSE;
        let frame = self.frame(&request.state.header.frame_id, world);
        let frame = frame.map_err(|reason| failed(INVALID, reason))?;
        let mut pose = entity.pose;
        if request.set_pose {
            pose =
                frame * read_pose(&request.state.pose).map_err(|reason| failed(INVALID, reason))?;
        }
        let mut twist = entity.twist;
        if request.set_twist {
            let requested = &request.state.twist;
            let linear = Vec3::new(requested.linear.x, requested.linear.y, requested.linear.z);
            let angular = Vec3::new(requested.angular.x, requested.angular.y, requested.angular.z);
            if [linear, angular].iter().any(|v| !v.norm_squared().is_finite()) {
                let reason = "the twist contains numbers that are not finite";
                return Err(failed(SimResult::RESULT_OPERATION_FAILED, reason));
            }
            twist = Twist { linear: frame.rotation * linear, angular: frame.rotation * angular };
        }
        if !request.set_pose && !request.set_twist {
            return Ok(());
        }
        let change = match entity.name.as_str() {
            TABLE => {
                let reason = "the table cannot move";
                return Err(failed(SimResult::RESULT_OPERATION_FAILED, reason));
            }
            FLANGE | BAG if request.set_twist && twist != Twist::zero() => {
                let reason = "the gripper follows ~/flange/pose_cmd: set only its pose";
                return Err(failed(SimResult::RESULT_OPERATION_FAILED, reason));
            }
            FLANGE | BAG => Change::PlaceFlange { pose },
            name => Change::PlaceObject { object: name.to_owned(), pose, twist },
        };
        self.change(&change, world).map_err(|error| match error {
            ChangeError::Overlap { .. } => failed(INVALID, error),
            _ => failed(SimResult::RESULT_OPERATION_FAILED, error),
        })
    }

    /// Pose of a frame in the world.
    pub(super) fn frame(&self, frame_id: &str, world: &World<'_>) -> Result<Pose, String> {
        match frame_id {
            "" | apply::WORLD => Ok(Pose::identity()),
            FLANGE | "membrane" => Ok(world.snapshot.flange.pose),
            other => {
                let objects = &world.snapshot.objects;
                let found = objects.iter().find(|it| object_frame(&it.name) == other);
                found.map(|it| it.body.pose).ok_or_else(|| format!("unknown frame `{other}`"))
            }
        }
    }

    pub(super) fn get_entity_info(
        &self,
        request: &GetEntityInfoRequest,
        world: &World<'_>,
    ) -> GetEntityInfoResponse {
        match self.find_entity(&request.entity, world) {
            Ok(entity) => {
                GetEntityInfoResponse { result: ok(), info: self.entity_table.get(&entity.name) }
            }
            Err(reason) => {
                let result = failed(SimResult::RESULT_NOT_FOUND, reason);
                GetEntityInfoResponse { result, ..Default::default() }
            }
        }
    }

    pub(super) fn set_entity_info(
        &mut self,
        request: SetEntityInfoRequest,
        world: &World<'_>,
    ) -> SetEntityInfoResponse {
        let result = match self.find_entity(&request.entity, world) {
            Ok(entity) => {
                self.entity_table.set(&entity.name, request.info);
                ok()
            }
            Err(reason) => failed(SimResult::RESULT_NOT_FOUND, reason),
        };
        SetEntityInfoResponse { result }
    }
}

/// A pose as a ROS 2 message.
pub(super) fn pose_message(pose: &Pose) -> g::Pose {
    let (p, q) = (pose.translation.vector, pose.rotation);
    g::Pose {
        position: g::Point { x: p.x, y: p.y, z: p.z },
        orientation: g::Quaternion { x: q.i, y: q.j, z: q.k, w: q.w },
    }
}

/// Reads the pose in a message.
///
/// # Errors
/// If a number is not finite or the quaternion is not normalized.
pub(super) fn read_pose(pose: &g::Pose) -> Result<Pose, String> {
    let g::Pose { position: p, orientation: q } = pose;
    let position = Vec3::new(p.x, p.y, p.z);
    let quaternion = nalgebra::Quaternion::new(q.w, q.x, q.y, q.z);
    if !position.norm_squared().is_finite() {
        return Err("the position contains numbers that are not finite".to_owned());
    }
    let norm = quaternion.norm();
    // Written so that NaN is rejected.
    let is_normalized = (norm - 1.0).abs() <= NORM_TOLERANCE;
    if !is_normalized {
        return Err(format!("the quaternion has norm {norm}: normalize it"));
    }
    // A unit quaternion is kept exactly, so that reading and setting a state does not change it.
    let is_exact = (norm - 1.0).abs() <= 4.0 * f64::EPSILON;
    let rotation =
        if is_exact { Quat::new_unchecked(quaternion) } else { Quat::from_quaternion(quaternion) };
    Ok(Pose::from_parts(position.into(), rotation))
}

fn vector(v: &Vec3) -> g::Vector3 {
    g::Vector3 { x: v.x, y: v.y, z: v.z }
}

/// Simulation time as a ROS 2 message.
pub(super) fn stamp(time_ns: u64) -> Time {
    Time {
        sec: i32::try_from(time_ns / 1_000_000_000).unwrap_or(i32::MAX),
        nanosec: u32::try_from(time_ns % 1_000_000_000).unwrap_or(0),
    }
}
