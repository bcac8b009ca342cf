//! Objects in and out: from files and texts, alone or many at once.
//!
//! A spawned object's frame is that of its centre of mass, like every object's, along the axes of
//! its file. It is published like the scene's own, and commanded on `~/object_cmd`.

use super::{
    Simulator, Version, World, bounds,
    entities::{BAG, FLANGE, TABLE, read_pose},
    failed, ok,
};
use crate::{
    command::change::Change,
    cosim::{compile::body, refused::ChangeError},
    scene::{
        Object,
        resource::{self, ResourceFault, Shelf},
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

/// Most characters of a name.
const NAME_MAX: usize = 64;
/// Objects that may be there at a time; each costs the membrane's pass over it.
const OBJECTS_MAX: usize = 64;
/// Files that are looked at for one list of spawnables.
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
                format!("{n_failed} of {} were not spawned", results.len()),
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
        if OBJECTS_MAX <= world.seen.objects.len() {
            let why = format!("there are {OBJECTS_MAX} objects already");
            return Err(failed(SimResult::RESULT_OPERATION_FAILED, why));
        }
        let Resource { uri, resource_string } = &request.entity_resource;
        let found = resource::object(uri, resource_string, &self.folder);
        let mut object = found.map_err(|fault| failed(code(&fault), fault))?;
        object.name = self.name(request, &object.name, world)?;
        self.place(&mut object, request, world)?;
        let name = object.name.clone();
        self.change(&Change::Insert(Box::new(object.clone())), world).map_err(|refusal| {
            let code = match refusal {
                ChangeError::NameTaken { .. } => SpawnResult::NAME_NOT_UNIQUE,
                ChangeError::Overlap { .. } => SpawnResult::INVALID_POSE,
                ChangeError::Unusable(_) => SpawnResult::UNSUPPORTED_ASSETS,
                _ => SimResult::RESULT_OPERATION_FAILED,
            };
            failed(code, refusal)
        })?;
        let info = EntityInfo {
            category: EntityCategory { category: EntityCategory::CATEGORY_DYNAMIC_OBJECT },
            description: "a spawned object".to_owned(),
            tags: vec!["object".to_owned(), "spawned".to_owned()],
        };
        self.register.spawned(&self.scene, &object, info);
        Ok(name)
    }

    /// The name that an entity gets: unique, and good for frames.
    fn name(
        &self,
        request: &SpawnEntity,
        own: &str,
        world: &World<'_>,
    ) -> Result<String, SimResult> {
        let namespace = request.entity_namespace.trim_matches('/');
        if !namespace.is_empty() && !namespace.split('/').all(is_word) {
            let why = format!("`{namespace}` is no namespace of ROS 2");
            return Err(failed(SpawnResult::NAMESPACE_INVALID, why));
        }
        let own = if is_word(own) { own } else { "object" };
        let wanted = if request.name.is_empty() { own } else { &request.name };
        if !is_word(wanted) || NAME_MAX < wanted.len() {
            let why = format!(
                "`{wanted}` is no name: use letters, digits and _, at most {NAME_MAX}, a letter first"
            );
            return Err(failed(SpawnResult::NAME_INVALID, why));
        }
        let wanted = match namespace {
            "" => wanted.to_owned(),
            _ => format!("{namespace}/{wanted}"),
        };
        let is_taken = |name: &str| {
            [FLANGE, BAG, TABLE].contains(&name)
                || world.seen.objects.iter().any(|it| it.name == name)
                || self.scene.objects.iter().any(|it| it.name == name)
        };
        if !is_taken(&wanted) {
            return Ok(wanted);
        }
        if !request.allow_renaming && !request.name.is_empty() {
            let why = format!("the name `{wanted}` is taken");
            return Err(failed(SpawnResult::NAME_NOT_UNIQUE, why));
        }
        let numbered = (1_u64..).map(|i| format!("{wanted}_{i}")).find(|it| !is_taken(it));
        Ok(numbered.unwrap_or(wanted))
    }

    /// Puts the centre of mass where the request says.
    fn place(
        &self,
        object: &mut Object,
        request: &SpawnEntity,
        world: &World<'_>,
    ) -> Result<(), SimResult> {
        let invalid = |why: String| failed(SpawnResult::INVALID_POSE, why);
        let frame = self.frame(&request.initial_pose.header.frame_id, world).map_err(invalid)?;
        let pose = frame * read_pose(&request.initial_pose.pose).map_err(invalid)?;
        let (_, bulk) = body(&self.scene, object)
            .map_err(|fault| failed(SpawnResult::UNSUPPORTED_ASSETS, fault))?;
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
            failed(SimResult::RESULT_OPERATION_FAILED, format!("`{name}` belongs to the world"))
        } else {
            match self.change(&Change::Remove { object: name.clone() }, world) {
                Ok(()) => ok(),
                Err(refusal @ ChangeError::UnknownObject { .. }) => {
                    failed(SimResult::RESULT_NOT_FOUND, refusal)
                }
                Err(refusal @ ChangeError::NoScene) => failed(SimResult::RESULT_NOT_FOUND, refusal),
                Err(refusal) => failed(SimResult::RESULT_OPERATION_FAILED, refusal),
            }
        };
        DeleteEntityResponse { result }
    }

    /// The list in the wire format that clients of this version read.
    pub(super) fn get_spawnables(&mut self, request: &GetSpawnablesRequest) -> Cdr {
        let answer = self.spawnables(request);
        match self.version {
            Version::Two => Cdr::of(&answer),
            Version::One => {
                let of_one = |it: &Spawnable| {
                    let uri = it.entity_resource.uri.clone();
                    (uri, it.description.clone(), it.spawn_bounds.clone())
                };
                let spawnables: Vec<_> = answer.spawnables.iter().map(of_one).collect();
                Cdr::of(&(answer.result, spawnables))
            }
        }
    }

    fn spawnables(&mut self, request: &GetSpawnablesRequest) -> GetSpawnablesResponse {
        let mut folders = vec![self.folder.clone()];
        for source in &request.sources {
            match resource::path(source, &self.folder).filter(|it| it.is_dir()) {
                Some(folder) => folders.push(folder),
                None => {
                    let why = format!("source `{source}` is no folder");
                    let result = failed(SimResult::RESULT_NOT_FOUND, why);
                    return GetSpawnablesResponse { result, ..Default::default() };
                }
            }
        }
        // Reading them all takes a while: a list is made again only if a folder has changed.
        let shelf = Shelf::of(&folders);
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
                spawn_bounds: bounds::told(&bounds::extent(&self.scene, &object)),
            })
        });
        let spawnables: Vec<Spawnable> = spawnables.collect();
        self.spawnables = Some((shelf, spawnables.clone()));
        GetSpawnablesResponse { result: ok(), spawnables }
    }
}

fn code(fault: &ResourceFault) -> u8 {
    match fault {
        ResourceFault::UnsupportedFormat(_) => SpawnResult::UNSUPPORTED_FORMAT,
        ResourceFault::NoResource(_) => SpawnResult::NO_RESOURCE,
        ResourceFault::Malformed(_) => SpawnResult::RESOURCE_PARSE_ERROR,
        ResourceFault::MissingAssets(_) => SpawnResult::MISSING_ASSETS,
        ResourceFault::Unsupported(_) => SpawnResult::UNSUPPORTED_ASSETS,
    }
}

/// A word as ROS 2 wants names: letters, digits and `_`, a letter first.
fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
