//! Category, description and tags of entities, which clients can change.

use std::collections::BTreeMap;

use super::{
    bounds,
    entities::{BAG, FLANGE, TABLE},
};
use crate::{
    base::Vec3,
    physics::boundary::shape::Aabb,
    scene::{Object, Scene},
    wire::messages::simulation_interfaces::{EntityCategory, EntityInfo},
};

/// Properties of entities other than their motion, by name.
#[derive(Clone, Debug, Default)]
pub(super) struct EntityTable {
    infos: BTreeMap<String, EntityInfo>,
    extents: BTreeMap<String, Aabb>,
    corners: BTreeMap<String, Vec<Vec3>>,
}

impl EntityTable {
    pub(super) fn new(scene: &Scene) -> Self {
        let mut table = Self::default();
        use EntityCategory as C;
        table.add(
            FLANGE,
            C::CATEGORY_ROBOT,
            "the plate that the membrane is attached to",
            "gripper",
        );
        table.add(BAG, C::CATEGORY_ROBOT, "membrane and grains of the gripper", "gripper");
        table.add(TABLE, C::CATEGORY_STATIC_OBJECT, "the table", "table");
        for object in &scene.objects {
            let description = "an object of the scene";
            table.add(&object.name, C::CATEGORY_DYNAMIC_OBJECT, description, "object");
            table.measure(scene, object);
        }
        table
    }

    /// Stores the bounds of an object.
    fn measure(&mut self, scene: &Scene, object: &Object) {
        self.extents.insert(object.name.clone(), bounds::extent(scene, object));
        self.corners.insert(object.name.clone(), bounds::corners(scene, object));
    }

    fn add(&mut self, name: &str, category: u8, description: &str, tag: &str) {
        let info = EntityInfo {
            category: EntityCategory { category },
            description: description.to_owned(),
            tags: vec![tag.to_owned()],
        };
        self.infos.insert(name.to_owned(), info);
    }

    /// Bounding box of an object along its own axes.
    pub(super) fn extent(&self, name: &str) -> Option<Aabb> {
        self.extents.get(name).copied()
    }

    /// Corners of an object's convex hull, if it is not described by its bounding box.
    pub(super) fn corners(&self, name: &str) -> &[Vec3] {
        self.corners.get(name).map_or(&[], Vec::as_slice)
    }

    /// The properties of `name`.
    pub(super) fn get(&self, name: &str) -> EntityInfo {
        self.infos.get(name).cloned().unwrap_or_default()
    }

    /// Replaces the properties of `name`.
    pub(super) fn set(&mut self, name: &str, info: EntityInfo) {
        self.infos.insert(name.to_owned(), info);
    }

    /// Adds a spawned object.
    pub(super) fn add_spawned(&mut self, scene: &Scene, object: &Object, info: EntityInfo) {
        self.infos.insert(object.name.clone(), info);
        self.measure(scene, object);
    }

    /// Removes all spawned objects.
    pub(super) fn remove_spawned(&mut self, scene: &Scene) {
        let is_permanent = |name: &str| {
            [FLANGE, BAG, TABLE].contains(&name) || scene.objects.iter().any(|it| it.name == name)
        };
        self.infos.retain(|name, _| is_permanent(name));
        self.extents.retain(|name, _| is_permanent(name));
        self.corners.retain(|name, _| is_permanent(name));
    }
}
