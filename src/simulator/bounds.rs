//! Bounding volumes of entities, and volumes in filters.

use super::{Simulator, World, entities::Entity, failed, ok};
use crate::{
    base::{Pose, Vec3},
    cosim::{compile::body, rapier_world::center_pose, volume},
    physics::{boundary::shape::Aabb, model::BodySurface},
    scene::{Object, Scene, Shape},
    wire::messages::{
        geometry_msgs::Vector3,
        simulation_interfaces::{
            Bounds, GetEntityBoundsRequest, GetEntityBoundsResponse, Result as SimResult,
        },
    },
};

/// Largest number of points in a convex hull of a filter.
const POINTS_MAX: usize = 1000;
/// Largest number of corners reported for an object's hull; above it, the bounding box is reported.
const CORNERS_MAX: usize = 4000;

/// A volume in the world frame.
pub(super) struct Volume(volume::Volume);

impl Volume {
    /// The volume of a filter, or `None` if it is empty.
    pub(super) fn of_filter(bounds: &Bounds) -> Result<Option<Self>, String> {
        let points: Vec<Vec3> = bounds.points.iter().map(|p| Vec3::new(p.x, p.y, p.z)).collect();
        if points.iter().any(|p| !p.iter().all(|it| (it * it).is_finite())) {
            return Err("the bounds contain numbers that are not finite".to_owned());
        }
        let volume = match (bounds.r#type, points.as_slice()) {
            (Bounds::TYPE_EMPTY, _) => return Ok(None),
            (Bounds::TYPE_BOX, &[a, b]) => {
                let middle = (a + b) / 2.0;
                let pose = Pose::translation(middle.x, middle.y, middle.z);
                volume::Volume::Box { pose, half: (a - b).abs() / 2.0 }
            }
            (Bounds::TYPE_CONVEX_HULL, [_, _, _, ..]) if points.len() <= POINTS_MAX => {
                volume::Volume::Hull { points }
            }
            (Bounds::TYPE_SPHERE, &[center, size]) if 0.0 <= size.x => {
                volume::Volume::Ball { center, radius: size.x }
            }
            (kind, points) => {
                let n = points.len();
                return Err(format!("{n} points do not define bounds of type {kind}"));
            }
        };
        // A hull without volume is detected here, not while entities are being tested.
        volume.overlaps(&volume::Volume::Ball { center: Vec3::zeros(), radius: 1.0 })?;
        Ok(Some(Self(volume)))
    }

    /// The bounding box of an entity.
    pub(super) fn around(pose: &Pose, extent: &Aabb) -> Self {
        let middle = (extent.min + extent.max) / 2.0;
        let pose = pose * Pose::translation(middle.x, middle.y, middle.z);
        Self(volume::Volume::Box { pose, half: (extent.max - extent.min) / 2.0 })
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.0.overlaps(&other.0).unwrap_or(false)
    }
}

/// Bounding box of an object, relative to its center of mass and along its own axes.
pub(super) fn extent(scene: &Scene, object: &Object) -> Aabb {
    let built = body(scene, object).map(|(model, _)| model.surface);
    match built {
        Ok(BodySurface::Shape(surface)) => surface.aabb(),
        _ => Aabb { min: Vec3::zeros(), max: Vec3::zeros() },
    }
}

/// Corners of the convex hull of a mesh or hull object, relative to its center of mass and along its
/// own axes; none for other shapes.
pub(super) fn corners(scene: &Scene, object: &Object) -> Vec<Vec3> {
    let points = match &object.shape {
        Shape::Mesh { vertices, .. } => vertices,
        Shape::ConvexHull { points } => points,
        Shape::Sphere { .. }
        | Shape::Box { .. }
        | Shape::Cylinder { .. }
        | Shape::Capsule { .. } => {
            return Vec::new();
        }
    };
    let Ok((_, bulk)) = body(scene, object) else { return Vec::new() };
    let corners = volume::hull_corners(points).unwrap_or_default();
    let corners = if corners.len() <= CORNERS_MAX { corners } else { Vec::new() };
    corners.into_iter().map(|it| it - bulk.center_of_mass).collect()
}

/// Initial pose of an object's center of mass.
pub(super) fn center(scene: &Scene, object: &Object) -> Pose {
    body(scene, object).map_or(object.pose, |(_, bulk)| center_pose(object, &bulk))
}

/// Bounding box of points, along the axes of `frame`.
pub(super) fn around(points: &[Vec3], frame: &Pose) -> Aabb {
    let local = points.iter().map(|p| frame.inverse_transform_point(&(*p).into()).coords);
    let empty = Aabb { min: Vec3::repeat(f64::INFINITY), max: Vec3::repeat(-f64::INFINITY) };
    let all = local.fold(empty, |it, p| Aabb { min: it.min.inf(&p), max: it.max.sup(&p) });
    if points.is_empty() { Aabb { min: Vec3::zeros(), max: Vec3::zeros() } } else { all }
}

fn hull_bounds(corners: &[Vec3]) -> Bounds {
    Bounds { r#type: Bounds::TYPE_CONVEX_HULL, points: corners.iter().map(vector).collect() }
}

fn vector(v: &Vec3) -> Vector3 {
    Vector3 { x: v.x, y: v.y, z: v.z }
}

/// A box message: the standard puts the upper corner first.
pub(super) fn box_bounds(extent: &Aabb) -> Bounds {
    Bounds { r#type: Bounds::TYPE_BOX, points: vec![vector(&extent.max), vector(&extent.min)] }
}

impl Entity {
    pub(super) fn volume(&self) -> Volume {
        Volume::around(&self.pose, &self.extent)
    }
}

impl Simulator {
    pub(super) fn get_entity_bounds(
        &mut self,
        request: &GetEntityBoundsRequest,
        world: &World<'_>,
    ) -> GetEntityBoundsResponse {
        match self.find_entity(&request.entity, world) {
            Ok(entity) => {
                let bounds = match self.entity_table.corners(&entity.name) {
                    [] => box_bounds(&entity.extent),
                    corners => hull_bounds(corners),
                };
                GetEntityBoundsResponse { result: ok(), bounds }
            }
            Err(reason) => GetEntityBoundsResponse {
                result: failed(SimResult::RESULT_NOT_FOUND, reason),
                ..Default::default()
            },
        }
    }
}
