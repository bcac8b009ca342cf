//! Spawning and deleting objects, from files or texts, alone or many at once.
//!
//! The frame of a spawned object has its origin in the center of mass, like those of all objects,
//! and the axes of its file. The object is published like the scene's own, and commanded on
//! `~/object_cmd`.

use super::{
    Simulator, Version, World, bounds,
    entities::{BAG, FLANGE, TABLE, read_pose},
    failed, ok,
};
use crate::{
    command::change::Change,
    cosim::{change_error::ChangeError, compile::body},
    scene::{
        Object,
        resource::{self, FolderState, ResourceError},
    },
    wire::{
        cdr::Cdr,
        messages::simulation_interfaces::{
            DeleteEntityRequest, DeleteEntityResponse, EntityCategory, EntityInfo,
            GetSpawnablesRequest, GetSpawnablesResponse, Resource, Result as SimResult,
            SpawnEntitiesRequest, SpawnEntitiesResponse, SpawnEntity, SpawnEntityRequest,
            SpawnEntityResponse, SpawnResult, Spawnable,
        },
    },
};

/// Largest length of a name (characters).
const NAME_MAX: usize = 64;
/// Largest number of objects at a time; each one costs a membrane pass.
const OBJECTS_MAX: usize = 64;
/// Largest number of files read for a list of spawnables.
const FILES_MAX: usize = 200;

impl Simulator {
    pub(super) fn spawn_entity(
        &mut self,
        request: SpawnEntityRequest,
        world: &mut World<'_>,
    ) -> SpawnEntityResponse {
        let request = SpawnEntity {
            name: request.name,
            allow_renaming: request.allow_renaming,
            entity_resource: request.entity_resource,
            entity_namespace: request.entity_namespace,
            initial_pose: request.initial_pose,
        };
        let SpawnResult { result, entity_name } = self.spawn(&request, world);
        SpawnEntityResponse { result, entity_name }
    }

    pub(super) fn spawn_entities(
        &mut self,
        request: &SpawnEntitiesRequest,
        world: &mut World<'_>,
    ) -> SpawnEntitiesResponse {
        let spawn = |it: &SpawnEntity| self.spawn(it, world);
        let results: Vec<SpawnResult> = request.spawn_requests.iter().map(spawn).collect();
        let n_failed = results.iter().filter(|it| it.result.result != SimResult::RESULT_OK).count();
        let result = match n_failed {
            0 => ok(),
            _ => failed(
                SpawnEntitiesResponse::ENTITIES_SPAWN_FAILED,
                format!("{n_failed} of {} objects could not be spawned", results.len()),
            ),
        };
        SpawnEntitiesResponse { result, results }
    }

    fn spawn(&mut self, request: &SpawnEntity, world: &mut World<'_>) -> SpawnResult {
        match self.try_spawn(request, world) {
            Ok(entity_name) => SpawnResult { result: ok(), entity_name },
            Err(result) => SpawnResult { result, entity_name: String::new() },
        }
    }

    fn try_spawn(
        &mut self,
        request: &SpawnEntity,
        world: &mut World<'_>,
    ) -> Result<String, SimResult> {
        if !self.has_world() {
            return Err(failed(SimResult::RESULT_INCORRECT_STATE, ChangeError::NoScene));
        }
        if OBJECTS_MAX <= world.snapshot.objects.len() {
            let reason = format!("there are already {OBJECTS_MAX} objects");
            return Err(failed(SimResult::RESULT_OPERATION_FAILED, reason));
        }
        let Resource { uri, resource_string } = &request.entity_resource;
        let found = resource::object(uri, resource_string, &self.folder);
        let mut object = found.map_err(|error| failed(code(&error), error))?;
        object.name = self.name(request, &object.name, world)?;
        self.set_pose(&mut object, request, world)?;
        let name = object.name.clone();
        self.change(&Change::Insert(Box::new(object.clone())), world).map_err(|error| {
            let code = match error {
                ChangeError::NameTaken { .. } => SpawnResult::NAME_NOT_UNIQUE,
                ChangeError::Overlap { .. } => SpawnResult::INVALID_POSE,
                ChangeError::Unusable(_) => SpawnResult::UNSUPPORTED_ASSETS,
                _ => SimResult::RESULT_OPERATION_FAILED,
            };
            failed(code, error)
        })?;
        let info = EntityInfo {
            category: EntityCategory { category: EntityCategory::CATEGORY_DYNAMIC_OBJECT },
            description: "a spawned object".to_owned(),
            tags: vec!["object".to_owned(), "spawned".to_owned()],
        };
        self.entity_table.add_spawned(&self.scene, &object, info);
        Ok(name)
    }

    /// The name of the new entity: unique, and valid in names of frames.
    fn name(
        &self,
        request: &SpawnEntity,
        default_name: &str,
        world: &World<'_>,
    ) -> Result<String, SimResult> {
        let namespace = request.entity_namespace.trim_matches('/');
        if !namespace.is_empty() && !namespace.split('/').all(is_word) {
            let reason = format!("`{namespace}` is not a ROS 2 namespace");
            return Err(failed(SpawnResult::NAMESPACE_INVALID, reason));
        }
        let default_name = if is_word(default_name) { default_name } else { "object" };
        let requested = if request.name.is_empty() { default_name } else { &request.name };
        if !is_word(requested) || NAME_MAX < requested.len() {
            let reason = format!(
                "`{requested}` is not a valid name: start with a letter, use letters, digits and _, at \
                most {NAME_MAX} characters"
            );
            return Err(failed(SpawnResult::NAME_INVALID, reason));
        }
        let requested = match namespace {
            "" => requested.to_owned(),
            _ => format!("{namespace}/{requested}"),
        };
        let is_in_use = |name: &str| {
            [FLANGE, BAG, TABLE].contains(&name)
                || world.snapshot.objects.iter().any(|it| it.name == name)
                || self.scene.objects.iter().any(|it| it.name == name)
        };
        if !is_in_use(&requested) {
            return Ok(requested);
        }
        if !request.allow_renaming && !request.name.is_empty() {
            let reason = format!("the name `{requested}` is already in use");
            return Err(failed(SpawnResult::NAME_NOT_UNIQUE, reason));
        }
        let numbered = (1_u64..).map(|i| format!("{requested}_{i}")).find(|it| !is_in_use(it));
        Ok(numbered.unwrap_or(requested))
    }

    /// Places the center of mass at the requested pose.
    fn set_pose(
        &self,
        object: &mut Object,
        request: &SpawnEntity,
        world: &World<'_>,
    ) -> Result<(), SimResult> {
        let invalid = |reason: String| failed(SpawnResult::INVALID_POSE, reason);
        let frame = self.frame(&request.initial_pose.header.frame_id, world).map_err(invalid)?;
        let pose = frame * read_pose(&request.initial_pose.pose).map_err(invalid)?;
        let (_, bulk) = body(&self.scene, object)
            .map_err(|error| failed(SpawnResult::UNSUPPORTED_ASSETS, error))?;
        object.pose = pose;
        object.pose.translation.vector -= pose.rotation * bulk.center_of_mass;
        Ok(())
    }

    pub(super) fn delete_entity(
        &mut self,
        request: &DeleteEntityRequest,
        world: &mut World<'_>,
    ) -> DeleteEntityResponse {
        let name = &request.entity;
        let result = if [FLANGE, BAG, TABLE].contains(&name.as_str()) {
            failed(SimResult::RESULT_OPERATION_FAILED, format!("`{name}` cannot be deleted"))
        } else {
            match self.change(&Change::Remove { object: name.clone() }, world) {
                Ok(()) => ok(),
                Err(error @ ChangeError::UnknownObject { .. }) => {
                    failed(SimResult::RESULT_NOT_FOUND, error)
                }
                Err(error @ ChangeError::NoScene) => failed(SimResult::RESULT_NOT_FOUND, error),
                Err(error) => failed(SimResult::RESULT_OPERATION_FAILED, error),
            }
        };
        DeleteEntityResponse { result }
    }

    /// The list of spawnables, in the wire format of this version.
    pub(super) fn get_spawnables(&mut self, request: &GetSpawnablesRequest) -> Cdr {
        let response = self.spawnables(request);
        match self.version {
            Version::Two => Cdr::of(&response),
            Version::One => {
                let version_one = |it: &Spawnable| {
                    let uri = it.entity_resource.uri.clone();
                    (uri, it.description.clone(), it.spawn_bounds.clone())
                };
                let spawnables: Vec<_> = response.spawnables.iter().map(version_one).collect();
                Cdr::of(&(response.result, spawnables))
            }
        }
    }

    fn spawnables(&mut self, request: &GetSpawnablesRequest) -> GetSpawnablesResponse {
        let mut folders = vec![self.folder.clone()];
        for source in &request.sources {
            match resource::path(source, &self.folder).filter(|it| it.is_dir()) {
                Some(folder) => folders.push(folder),
                None => {
                    let reason = format!("source `{source}` is not a folder");
                    let result = failed(SimResult::RESULT_NOT_FOUND, reason);
                    return GetSpawnablesResponse { result, ..Default::default() };
                }
            }
        }
        // Reading all files takes a while, so the list is cached until a folder changes.
        let shelf = FolderState::of(&folders);
        if let Some((_, spawnables)) = self.spawnables.as_ref().filter(|it| it.0 == shelf) {
            return GetSpawnablesResponse { result: ok(), spawnables: spawnables.clone() };
        }
        let files = folders.iter().flat_map(|folder| resource::files(folder, &resource::FORMATS));
        let spawnables = files.take(FILES_MAX).filter_map(|file| {
            let uri = format!("file://{}", file.display());
            let object = resource::object(&uri, "", &self.folder).ok()?;
            Some(Spawnable {
                entity_resource: Resource { uri, resource_string: String::new() },
                description: format!("object `{}`", object.name),
                spawn_bounds: bounds::box_bounds(&bounds::extent(&self.scene, &object)),
            })
        });
        let spawnables: Vec<Spawnable> = spawnables.collect();
        self.spawnables = Some((shelf, spawnables.clone()));
        GetSpawnablesResponse { result: ok(), spawnables }
    }
}

fn code(error: &ResourceError) -> u8 {
    match error {
        ResourceError::UnsupportedFormat(_) => SpawnResult::UNSUPPORTED_FORMAT,
        ResourceError::NoResource(_) => SpawnResult::NO_RESOURCE,
        ResourceError::Malformed(_) => SpawnResult::RESOURCE_PARSE_ERROR,
        ResourceError::MissingAssets(_) => SpawnResult::MISSING_ASSETS,
        ResourceError::Unsupported(_) => SpawnResult::UNSUPPORTED_ASSETS,
    }
}

/// True for a valid token of ROS 2 names: letters, digits and `_`, starting with a letter.
fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
