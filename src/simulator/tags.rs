//! What is said of entities: category, description and tags, which others may change.

use std::collections::BTreeMap;

use super::{
    bounds::extent,
    entities::{BAG, FLANGE, TABLE},
};
use crate::{
    physics::boundary::shape::Aabb,
    scene::Scene,
    wire::messages::simulation_interfaces::{EntityCategory, EntityInfo},
};

/// What is known of entities besides their motion, by name.
#[derive(Clone, Debug, Default)]
pub(super) struct Register {
    infos: BTreeMap<String, EntityInfo>,
    extents: BTreeMap<String, Aabb>,
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
            register.extents.insert(object.name.clone(), extent(scene, object));
        }
        register
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

    /// What is said of `name`.
    pub(super) fn get(&self, name: &str) -> EntityInfo {
        self.infos.get(name).cloned().unwrap_or_default()
    }

    /// Says something else of `name`.
    pub(super) fn set(&mut self, name: &str, info: EntityInfo) {
        self.infos.insert(name.to_owned(), info);
    }

    /// An object was added.
    pub(super) fn spawned(&mut self, name: &str, info: EntityInfo, extent: Aabb) {
        self.infos.insert(name.to_owned(), info);
        self.extents.insert(name.to_owned(), extent);
    }

    /// Objects that were added are gone.
    pub(super) fn forget_spawned(&mut self, scene: &Scene) {
        let is_own = |name: &str| {
            [FLANGE, BAG, TABLE].contains(&name) || scene.objects.iter().any(|it| it.name == name)
        };
        self.infos.retain(|name, _| is_own(name));
        self.extents.retain(|name, _| is_own(name));
    }
}
