//! Places with names: what is known of a scene before anything runs.

use super::{Simulator, bounds, entities::told_pose, failed, ok};
use crate::{
    base::{Pose, Vec3},
    physics::boundary::shape::Aabb,
    wire::messages::simulation_interfaces::{
        Bounds, GetNamedPoseBoundsRequest, GetNamedPoseBoundsResponse, GetNamedPosesRequest,
        GetNamedPosesResponse, NamedPose, Result as SimResult, TagsFilter,
    },
};

/// Half of the edge of the free place on the table (m).
const FREE_PLACE: f64 = 0.1;
/// Distance of the free place from the middle of the table, where the gripper works (m).
const FREE_PLACE_X: f64 = 0.5;

/// A place, and how much room there is.
struct Place {
    pose: NamedPose,
    bounds: Bounds,
}

impl Simulator {
    fn places(&self) -> Vec<Place> {
        if !self.has_world() {
            return Vec::new();
        }
        let place = |name: String, what: &str, tag: &str, pose: &Pose, bounds| Place {
            pose: NamedPose {
                name,
                description: what.to_owned(),
                tags: vec![tag.to_owned()],
                pose: told_pose(pose),
            },
            bounds,
        };
        let flange = &self.scene.flange.pose;
        let nothing = Bounds::default();
        let what = "where the flange starts";
        let mut places = vec![place("flange_start".to_owned(), what, "gripper", flange, nothing)];
        for object in &self.scene.objects {
            let extent = bounds::extent(&self.scene, object);
            let (name, what) = (format!("{}_start", object.name), "where the object starts");
            let pose = bounds::centre(&self.scene, object);
            places.push(place(name, what, "object", &pose, bounds::told(&extent)));
        }
        let free = Pose::translation(FREE_PLACE_X, 0.0, self.scene.table.height);
        let half = Vec3::new(FREE_PLACE, FREE_PLACE, 0.0);
        let room = Aabb { min: -half, max: half + Vec3::z() * (2.0 * FREE_PLACE) };
        let what = "a free place on the table, out of the gripper's way";
        places.push(place("table_free".to_owned(), what, "table", &free, bounds::told(&room)));
        places
    }

    pub(super) fn get_named_poses(&self, request: &GetNamedPosesRequest) -> GetNamedPosesResponse {
        let poses = self.places().into_iter().map(|it| it.pose);
        let poses = poses.filter(|it| has_tags(&it.tags, &request.tags)).collect();
        GetNamedPosesResponse { result: ok(), poses }
    }

    pub(super) fn get_named_pose_bounds(
        &self,
        request: &GetNamedPoseBoundsRequest,
    ) -> GetNamedPoseBoundsResponse {
        let found = self.places().into_iter().find(|it| it.pose.name == request.name);
        match found {
            Some(place) => GetNamedPoseBoundsResponse { result: ok(), bounds: place.bounds },
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
