//! Named poses of the scene: the start poses and a free area on the table.

use super::{Simulator, bounds, entities::pose_message, failed, ok};
use crate::{
    base::{Pose, Vec3},
    physics::boundary::shape::Aabb,
    wire::messages::simulation_interfaces::{
        Bounds, GetNamedPoseBoundsRequest, GetNamedPoseBoundsResponse, GetNamedPosesRequest,
        GetNamedPosesResponse, NamedPose, Result as SimResult, TagsFilter,
    },
};

/// Half of the edge length of the free area on the table (m).
const FREE_AREA_HALF: f64 = 0.1;
/// Distance of the free area from the center of the table, where the gripper works (m).
const FREE_AREA_X: f64 = 0.5;

/// A named pose with its bounds.
struct BoundedPose {
    pose: NamedPose,
    bounds: Bounds,
}

impl Simulator {
    fn named_poses(&self) -> Vec<BoundedPose> {
        if !self.has_world() {
            return Vec::new();
        }
        let named_pose =
            |name: String, description: &str, tag: &str, pose: &Pose, bounds| BoundedPose {
                pose: NamedPose {
                    name,
                    description: description.to_owned(),
                    tags: vec![tag.to_owned()],
                    pose: pose_message(pose),
                },
                bounds,
            };
        let flange = &self.scene.flange.pose;
        let empty = Bounds::default();
        let description = "start pose of the flange";
        let mut named_poses =
            vec![named_pose("flange_start".to_owned(), description, "gripper", flange, empty)];
        for object in &self.scene.objects {
            let extent = bounds::extent(&self.scene, object);
            let (name, description) =
                (format!("{}_start", object.name), "start pose of the object");
            let pose = bounds::center(&self.scene, object);
            named_poses.push(named_pose(
                name,
                description,
                "object",
                &pose,
                bounds::box_bounds(&extent),
            ));
        }
        let free = Pose::translation(FREE_AREA_X, 0.0, self.scene.table.height);
        let half = Vec3::new(FREE_AREA_HALF, FREE_AREA_HALF, 0.0);
        let extent = Aabb { min: -half, max: half + Vec3::z() * (2.0 * FREE_AREA_HALF) };
        let description = "a free area on the table, out of the gripper's reach";
        named_poses.push(named_pose(
            "table_free".to_owned(),
            description,
            "table",
            &free,
            bounds::box_bounds(&extent),
        ));
        named_poses
    }

    pub(super) fn get_named_poses(&self, request: &GetNamedPosesRequest) -> GetNamedPosesResponse {
        let poses = self.named_poses().into_iter().map(|it| it.pose);
        let poses = poses.filter(|it| has_tags(&it.tags, &request.tags)).collect();
        GetNamedPosesResponse { result: ok(), poses }
    }

    pub(super) fn get_named_pose_bounds(
        &self,
        request: &GetNamedPoseBoundsRequest,
    ) -> GetNamedPoseBoundsResponse {
        let found = self.named_poses().into_iter().find(|it| it.pose.name == request.name);
        match found {
            Some(it) => GetNamedPoseBoundsResponse { result: ok(), bounds: it.bounds },
            None => GetNamedPoseBoundsResponse {
                result: failed(
                    SimResult::RESULT_NOT_FOUND,
                    format!("there is no pose `{}`", request.name),
                ),
                ..Default::default()
            },
        }
    }
}

pub(super) fn has_tags(tags: &[String], filter: &TagsFilter) -> bool {
    let has = |tag: &String| tags.contains(tag);
    filter.tags.is_empty()
        || match filter.filter_mode {
            TagsFilter::FILTER_MODE_ALL => filter.tags.iter().all(has),
            _ => filter.tags.iter().any(has),
        }
}
