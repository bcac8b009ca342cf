//! What is there, how it moves, and putting it elsewhere: the objects, the flange, the bag (membrane
//! and grains as one), and the table.
//!
//! An object's frame is that of its centre of mass, as in `/tf`. States are told in the world. A
//! state to be set may name any of the frames; its velocities are those in the world, along
//! that frame's axes. The simulator gives bodies forces, so accelerations cannot be set.

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
    cosim::{rapier_world::TABLE_HALF, refused::ChangeError},
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

/// The plate that the bag hangs from.
pub(super) const FLANGE: &str = apply::FLANGE;
/// Membrane and grains.
pub(super) const BAG: &str = "bag";
/// The table.
pub(super) const TABLE: &str = "table";

/// How far a quaternion's length may be from 1.
const NORMALISED: f64 = 1e-3;

/// One thing in the world.
#[derive(Clone, Debug)]
pub(super) struct Entity {
    pub(super) name: String,
    pub(super) pose: Pose,
    pub(super) twist: Twist,
    /// How far it reaches along its own axes.
    pub(super) extent: Aabb,
}

/// Velocities of all that moves, by name.
pub(super) fn twists(seen: &Snapshot) -> Vec<(String, Twist)> {
    let objects = seen.objects.iter().map(|it| (it.name.clone(), it.body.twist));
    let gripper = [FLANGE, BAG].map(|it| (it.to_owned(), seen.flange.twist));
    objects.chain(gripper).collect()
}

/// Requests of version 1 end before the flags: everything is to be set then.
pub(super) fn read_set_entity_state(
    body: &Cdr,
) -> Result<SetEntityStateRequest, cdr_encoding::Error> {
    body.read().or_else(|fault| {
        let mut bytes = body.bytes.clone();
        bytes.extend([1; 3]);
        let with_flags = Cdr { bytes, is_big_endian: body.is_big_endian };
        with_flags.read().map_err(|_| fault)
    })
}

impl Simulator {
    /// Everything, in a fixed order. The bag's extent is looked up only if it is asked for.
    pub(super) fn entities(&self, world: &World<'_>, with_extents: bool) -> Vec<Entity> {
        if !self.has_world() {
            return Vec::new();
        }
        let seen = world.seen;
        let nothing = Aabb { min: Vec3::zeros(), max: Vec3::zeros() };
        let objects = seen.objects.iter().map(|object| {
            let body = object.body;
            let extent = self.register.extent(&object.name).unwrap_or(nothing);
            Entity { name: object.name.clone(), pose: body.pose, twist: body.twist, extent }
        });
        let mut entities: Vec<Entity> = objects.collect();
        let (pose, twist) = (seen.flange.pose, seen.flange.twist);
        let radius = self.scene.membrane.radius;
        let plate = Vec3::new(radius, radius, 0.0);
        let extent = Aabb { min: -plate, max: plate };
        entities.push(Entity { name: FLANGE.to_owned(), pose, twist, extent });
        let extent = if with_extents { self.bag_extent(world) } else { nothing };
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

    /// How far membrane and grains reach; grains stay inside the membrane.
    fn bag_extent(&self, world: &World<'_>) -> Aabb {
        let now = (world.seen.time_ns, world.seen.digest);
        let mut kept = self.bag.borrow_mut();
        match *kept {
            Some((when, extent)) if when == now => extent,
            _ => {
                let look = world.subject.look();
                let points = look.membrane.map(|it| it.positions).unwrap_or_default();
                let extent = bounds::around(&points, &world.seen.flange.pose);
                *kept = Some((now, extent));
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
                states: found.iter().map(|it| self.state(it, world.seen.time_ns)).collect(),
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
                let state = self.state(&entity, world.seen.time_ns);
                GetEntityStateResponse { result: ok(), state }
            }
            Err(why) => {
                let result = failed(SimResult::RESULT_NOT_FOUND, why);
                GetEntityStateResponse { result, ..Default::default() }
            }
        }
    }

    fn state(&self, entity: &Entity, time_ns: u64) -> EntityState {
        let acceleration = self.acceleration(&entity.name, time_ns);
        EntityState {
            header: Header { stamp: stamp(time_ns), frame_id: apply::WORLD.to_owned() },
            pose: told_pose(&entity.pose),
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

    /// Change of velocity over the last tick; zero where two ticks in a row are not known.
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
            Err(why) => failed(SimResult::RESULT_NOT_FOUND, why),
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
        let frame = frame.map_err(|why| failed(INVALID, why))?;
        let mut pose = entity.pose;
        if request.set_pose {
            pose = frame * read_pose(&request.state.pose).map_err(|why| failed(INVALID, why))?;
        }
        let mut twist = entity.twist;
        if request.set_twist {
            let asked = &request.state.twist;
            let linear = Vec3::new(asked.linear.x, asked.linear.y, asked.linear.z);
            let angular = Vec3::new(asked.angular.x, asked.angular.y, asked.angular.z);
            if [linear, angular].iter().any(|v| !v.norm_squared().is_finite()) {
                let why = "the twist has numbers that are not finite";
                return Err(failed(SimResult::RESULT_OPERATION_FAILED, why));
            }
            twist = Twist { linear: frame.rotation * linear, angular: frame.rotation * angular };
        }
        if !request.set_pose && !request.set_twist {
            return Ok(());
        }
        let change = match entity.name.as_str() {
            TABLE => {
                let why = "the table stands still";
                return Err(failed(SimResult::RESULT_OPERATION_FAILED, why));
            }
            FLANGE | BAG if request.set_twist && twist != Twist::zero() => {
                let why = "the gripper moves as commanded on ~/flange/pose_cmd: set its pose only";
                return Err(failed(SimResult::RESULT_OPERATION_FAILED, why));
            }
            FLANGE | BAG => Change::PlaceFlange { pose },
            name => Change::PlaceObject { object: name.to_owned(), pose, twist },
        };
        self.change(&change, world).map_err(|refusal| match refusal {
            ChangeError::Overlap { .. } => failed(INVALID, refusal),
            _ => failed(SimResult::RESULT_OPERATION_FAILED, refusal),
        })
    }

    /// Pose of a frame in the world.
    pub(super) fn frame(&self, frame_id: &str, world: &World<'_>) -> Result<Pose, String> {
        match frame_id {
            "" | apply::WORLD => Ok(Pose::identity()),
            FLANGE | "membrane" => Ok(world.seen.flange.pose),
            other => {
                let objects = &world.seen.objects;
                let found = objects.iter().find(|it| object_frame(&it.name) == other);
                found.map(|it| it.body.pose).ok_or_else(|| format!("there is no frame `{other}`"))
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
                GetEntityInfoResponse { result: ok(), info: self.register.get(&entity.name) }
            }
            Err(why) => {
                let result = failed(SimResult::RESULT_NOT_FOUND, why);
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
                self.register.set(&entity.name, request.info);
                ok()
            }
            Err(why) => failed(SimResult::RESULT_NOT_FOUND, why),
        };
        SetEntityInfoResponse { result }
    }
}

/// A pose as it is told.
pub(super) fn told_pose(pose: &Pose) -> g::Pose {
    let (p, q) = (pose.translation.vector, pose.rotation);
    g::Pose {
        position: g::Point { x: p.x, y: p.y, z: p.z },
        orientation: g::Quaternion { x: q.i, y: q.j, z: q.k, w: q.w },
    }
}

/// A pose as it came.
pub(super) fn read_pose(pose: &g::Pose) -> Result<Pose, String> {
    let g::Pose { position: p, orientation: q } = pose;
    let position = Vec3::new(p.x, p.y, p.z);
    let quaternion = nalgebra::Quaternion::new(q.w, q.x, q.y, q.z);
    if !position.norm_squared().is_finite() {
        return Err("the position has numbers that are not finite".to_owned());
    }
    let length = quaternion.norm();
    // Written so that NaN does not pass.
    let is_normalised = (length - 1.0).abs() <= NORMALISED;
    if !is_normalised {
        return Err(format!("the orientation has length {length}: normalise the quaternion"));
    }
    // What is 1 to the last bit stays as it came, so that a state read and set is the same state.
    let is_exact = (length - 1.0).abs() <= 4.0 * f64::EPSILON;
    let rotation =
        if is_exact { Quat::new_unchecked(quaternion) } else { Quat::from_quaternion(quaternion) };
    Ok(Pose::from_parts(position.into(), rotation))
}

fn vector(v: &Vec3) -> g::Vector3 {
    g::Vector3 { x: v.x, y: v.y, z: v.z }
}

/// Simulated time as ROS 2 tells it.
pub(super) fn stamp(time_ns: u64) -> Time {
    Time {
        sec: i32::try_from(time_ns / 1_000_000_000).unwrap_or(i32::MAX),
        nanosec: u32::try_from(time_ns % 1_000_000_000).unwrap_or(0),
    }
}
