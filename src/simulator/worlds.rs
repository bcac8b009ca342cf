//! Worlds, which are scenes: listing, loading and unloading them.
//!
//! A requested scene is read at once and settled in the background, which takes a while; until
//! then, no scene is loaded. If loading fails, the current scene stays loaded. A loaded scene
//! replaces everything except what belongs to the run: outputs, the kind of controller, and the
//! length of a tick.

use std::sync::Arc;

use super::{
    DecodeError, Simulator, Version, World, entity_info::EntityTable, failed,
    named_poses::has_tags, ok,
};
use crate::{
    command::change::{Change, SettledScene},
    io::server::RequestId,
    scene::{
        self, Controller, Scene,
        resource::{self, FolderState, ResourceError},
    },
    wire::{
        cdr::Cdr,
        messages::simulation_interfaces::{
            GetAvailableWorldsRequest, GetAvailableWorldsResponse, GetCurrentWorldResponse,
            LoadWorldRequest, LoadWorldResponse as Loaded, Resource, Result as SimResult,
            UnloadWorldResponse, WorldResource,
        },
    },
};

/// A scene that is being loaded.
pub(super) struct Loading {
    id: RequestId,
    scene: Scene,
    /// Where the scene comes from, as reported to clients.
    resource: Resource,
    /// The state to return to if loading fails.
    state_before: u8,
}

impl Simulator {
    pub(super) fn load_world(
        &mut self,
        body: &Cdr,
        id: &RequestId,
    ) -> Result<Option<Cdr>, DecodeError> {
        let request: LoadWorldRequest = body.read()?;
        let rejected = |result| Ok(Some(Cdr::of(&Loaded { result, ..Loaded::default() })));
        if self.loading.is_some() {
            let reason = "a world is already being loaded: wait for it";
            return rejected(failed(SimResult::RESULT_INCORRECT_STATE, reason));
        }
        let (scene, resource) = match self.find_world(request) {
            Ok(found) => found,
            Err(result) => return rejected(result),
        };
        self.end_running("another world is loaded");
        self.scene_to_settle = Some(scene.clone());
        let state_before = self.run_state.begin_loading();
        self.loading = Some(Loading { id: id.clone(), scene, resource, state_before });
        Ok(None)
    }

    /// The requested scene, adapted to this run.
    fn find_world(&self, request: LoadWorldRequest) -> Result<(Scene, Resource), SimResult> {
        let Resource { uri, resource_string } = &request.world_resource;
        let ignores_missing = request.ignore_missing_or_unsupported_assets;
        let found = resource::scene(uri, resource_string, &self.folder, ignores_missing);
        let scene = found.map_err(|error| failed(code(&error), error))?;
        let [its_tick_ns, tick_ns] = [&scene, &self.scene].map(|it| it.time.tick_ns);
        if request.fail_on_unsupported_element && its_tick_ns != tick_ns {
            let reason = format!("time.tick is {its_tick_ns} ns, but this run needs {tick_ns} ns");
            return Err(failed(Loaded::UNSUPPORTED_ELEMENTS, reason));
        }
        let resource = match resource::path(uri, &self.folder) {
            Some(file) if !uri.is_empty() => Resource {
                uri: format!("file://{}", file.display()),
                resource_string: String::new(),
            },
            _ => request.world_resource,
        };
        Ok((self.adapted_to_run(scene), resource))
    }

    /// The scene with the settings that belong to the run.
    fn adapted_to_run(&self, scene: Scene) -> Scene {
        let mut time = scene.time;
        time.tick_ns = self.scene.time.tick_ns;
        let controller = match (&self.scene.controller, scene.controller) {
            (Controller::Builtin(_), Controller::Builtin(its)) => Controller::Builtin(its),
            (ours, _) => ours.clone(),
        };
        Scene { time, controller, outputs: self.scene.outputs.clone(), ..scene }
    }

    /// Takes the scene to settle, once.
    pub fn take_scene_to_settle(&mut self) -> Option<Scene> {
        self.scene_to_settle.take()
    }

    /// Finishes loading, once the scene has been settled or settling has failed.
    pub fn finish_loading(&mut self, settled: Result<Vec<u8>, String>, world: &mut World<'_>) {
        let Some(Loading { id, scene, resource, state_before }) = self.loading.take() else {
            return;
        };
        let changed = settled.and_then(|start| {
            let keeps_time = self.is_monotonic;
            let settled = SettledScene { scene: scene.clone(), start, keeps_time };
            let change = Change::LoadScene(Box::new(settled));
            self.apply(&change, world).map_err(|error| error.to_string())
        });
        let response = match changed {
            Ok(()) => {
                self.run_state.end_loading();
                self.replace_scene(scene, resource);
                Loaded { result: ok(), world: self.world() }
            }
            Err(reason) => {
                self.run_state.abort_loading(state_before);
                let result = failed(SimResult::RESULT_OPERATION_FAILED, reason);
                Loaded { result, ..Loaded::default() }
            }
        };
        self.send_response(id, &response);
    }

    /// Replaces the scene and everything derived from it.
    fn replace_scene(&mut self, scene: Scene, resource: Resource) {
        self.entity_table = EntityTable::new(&scene);
        self.scene = Arc::new(scene);
        self.resource = resource;
        self.spawnables = None;
        self.commands.clear();
        *self.membrane_extent.borrow_mut() = None;
    }

    pub(super) fn unload_world(&mut self) -> UnloadWorldResponse {
        let result = if self.loading.is_some() {
            failed(SimResult::RESULT_INCORRECT_STATE, "a world is being loaded: wait for it")
        } else if !self.has_world() {
            failed(UnloadWorldResponse::NO_WORLD_LOADED, "no world is loaded")
        } else {
            self.end_running("the world was unloaded");
            self.run_state.unload();
            ok()
        };
        UnloadWorldResponse { result }
    }

    /// Ends running steps and goals before the world is replaced or unloaded.
    fn end_running(&mut self, reason: &str) {
        self.end_steps(reason);
        self.abort_grip();
    }

    pub(super) fn get_current_world(&self) -> GetCurrentWorldResponse {
        if !self.has_world() {
            let reason = "no world is loaded";
            let result = failed(GetCurrentWorldResponse::NO_WORLD_LOADED, reason);
            return GetCurrentWorldResponse { result, ..Default::default() };
        }
        GetCurrentWorldResponse { result: ok(), world: self.world() }
    }

    fn world(&self) -> WorldResource {
        world_of(&self.scene, self.resource.clone())
    }

    pub(super) fn get_available_worlds(
        &mut self,
        request: &GetAvailableWorldsRequest,
    ) -> GetAvailableWorldsResponse {
        let mut folders = vec![self.folder.clone()];
        for source in &request.additional_sources {
            match resource::path(source, &self.folder).filter(|it| it.is_dir()) {
                Some(folder) => folders.push(folder),
                None if request.continue_on_error => {}
                None => {
                    let reason = format!("source `{source}` is not a folder");
                    let result = failed(SimResult::RESULT_NOT_FOUND, reason);
                    return GetAvailableWorldsResponse { result, ..Default::default() };
                }
            }
        }
        // Reading all files takes a while, so the list is cached until a folder changes.
        let shelf = FolderState::of(&folders);
        if self.worlds.as_ref().is_none_or(|it| it.0 != shelf) {
            let files = folders.iter().flat_map(|folder| resource::files(folder, &["yaml"]));
            let worlds = files.filter_map(|file| {
                let scene = scene::load(&file, &[]).ok()?;
                let uri = format!("file://{}", file.display());
                Some(world_of(&scene, Resource { uri, resource_string: String::new() }))
            });
            self.worlds = Some((shelf, worlds.collect()));
        }
        let worlds = self.worlds.iter().flat_map(|it| &it.1);
        let worlds = worlds.filter(|it| has_tags(&it.tags, &request.filter)).cloned().collect();
        GetAvailableWorldsResponse { result: ok(), worlds }
    }
}

fn world_of(scene: &Scene, world_resource: Resource) -> WorldResource {
    let objects = scene.objects.iter().map(|it| it.name.clone());
    WorldResource {
        name: scene.name.clone(),
        world_resource,
        description: format!("{} grains in the gripper", scene.grains.count),
        tags: std::iter::once("gripper".to_owned()).chain(objects).collect(),
    }
}

fn code(error: &ResourceError) -> u8 {
    match error {
        ResourceError::UnsupportedFormat(_) => Loaded::UNSUPPORTED_FORMAT,
        ResourceError::NoResource(_) => Loaded::NO_RESOURCE,
        ResourceError::Malformed(_) => Loaded::RESOURCE_PARSE_ERROR,
        ResourceError::MissingAssets(_) => Loaded::MISSING_ASSETS,
        ResourceError::Unsupported(_) => Loaded::UNSUPPORTED_ASSETS,
    }
}

impl Version {
    /// The version that a ROS 2 distribution uses.
    pub fn of_distribution(name: &str) -> Self {
        match name {
            "humble" | "iron" | "jazzy" | "kilted" => Self::One,
            _ => Self::Two,
        }
    }
}
