//! What is said of entities: category, description and tags, which others may change.

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

/// What is known of entities besides their motion, by name.
#[derive(Clone, Debug, Default)]
pub(super) struct Register {
    infos: BTreeMap<String, EntityInfo>,
    extents: BTreeMap<String, Aabb>,
    corners: BTreeMap<String, Vec<Vec3>>,
}

impl Register {
    pub(super) fn new(scene: &Scene) -> Self {
        let mut register = Self::default();
        use EntityCategory as C;
        register.add(FLANGE, C::CATEGORY_ROBOT, "the plate that the bag hangs from", "gripper");
        register.add(BAG, C::CATEGORY_ROBOT, "membrane and grains of the gripper", "gripper");
        register.add(TABLE, C::CATEGORY_STATIC_OBJECT, "the table", "table");
        for object in &scene.objects {
            let what = "an object of the scene";
            register.add(&object.name, C::CATEGORY_DYNAMIC_OBJECT, what, "object");
            register.measure(scene, object);
        }
        register
    }

    /// Notes how far an object reaches.
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

    /// How far an object reaches along its own axes.
    pub(super) fn extent(&self, name: &str) -> Option<Aabb> {
        self.extents.get(name).copied()
    }

    /// Corners of an object's convex hull, if a box does not do.
    pub(super) fn corners(&self, name: &str) -> &[Vec3] {
        self.corners.get(name).map_or(&[], Vec::as_slice)
    }

    /// What is said of `name`.
    pub(super) fn get(&self, name: &str) -> EntityInfo {
        self.infos.get(name).cloned().unwrap_or_default()
    }

    /// Says something else of `name`.
    pub(super) fn set(&mut self, name: &str, info: EntityInfo) {
        self.infos.insert(name.to_owned(), info);
    }

    /// An object was added.
    pub(super) fn spawned(&mut self, scene: &Scene, object: &Object, info: EntityInfo) {
        self.infos.insert(object.name.clone(), info);
        self.measure(scene, object);
    }

    /// Objects that were added are gone.
    pub(super) fn forget_spawned(&mut self, scene: &Scene) {
        let is_own = |name: &str| {
            [FLANGE, BAG, TABLE].contains(&name) || scene.objects.iter().any(|it| it.name == name)
        };
        self.infos.retain(|name, _| is_own(name));
        self.extents.retain(|name, _| is_own(name));
        self.corners.retain(|name, _| is_own(name));
    }
}
