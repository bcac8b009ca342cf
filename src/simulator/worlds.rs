//! Worlds are scenes: which there are, which one is there, another one in its place, or none.
//!
//! A scene to be loaded is read at once and settled elsewhere, which takes a while; meanwhile there is
//! none. What cannot be had leaves the present one as it was. Of a loaded scene all is taken but what
//! belongs to the run: outputs, who commands, and the length of a tick.

use std::sync::Arc;

use super::{
    Simulator, Unreadable, Version, World, entity_info::Register, failed, named_poses::has_tags, ok,
};
use crate::{
    command::change::{Change, SettledScene},
    io::server::RequestId,
    scene::{
        self, Controller, Scene,
        resource::{self, ResourceFault, Shelf},
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

/// A scene on its way.
pub(super) struct Loading {
    asker: RequestId,
    scene: Scene,
    /// Where it is from, as told.
    resource: Resource,
    /// The state to go back to if it cannot be had.
    before: u8,
}

impl Simulator {
    pub(super) fn load_world(
        &mut self,
        body: &Cdr,
        asker: &RequestId,
    ) -> Result<Option<Cdr>, Unreadable> {
        let request: LoadWorldRequest = body.read()?;
        let refused = |result| Ok(Some(Cdr::of(&Loaded { result, ..Loaded::default() })));
        if self.loading.is_some() {
            let why = "a world is being loaded already: wait for it";
            return refused(failed(SimResult::RESULT_INCORRECT_STATE, why));
        }
        let (scene, resource) = match self.find_world(request) {
            Ok(found) => found,
            Err(result) => return refused(result),
        };
        self.end_all("another world is loaded");
        self.wanted = Some(scene.clone());
        let before = self.running.begin_loading();
        self.loading = Some(Loading { asker: asker.clone(), scene, resource, before });
        Ok(None)
    }

    /// The scene that a request means, as this run can have it.
    fn find_world(&self, request: LoadWorldRequest) -> Result<(Scene, Resource), SimResult> {
        let Resource { uri, resource_string } = &request.world_resource;
        let ignores = request.ignore_missing_or_unsupported_assets;
        let found = resource::scene(uri, resource_string, &self.folder, ignores);
        let scene = found.map_err(|fault| failed(code(&fault), fault))?;
        let [its, ours] = [&scene, &self.scene].map(|it| it.time.tick_ns);
        if request.fail_on_unsupported_element && its != ours {
            let why = format!("time.tick is {its} ns, and stays {ours} ns in this run");
            return Err(failed(Loaded::UNSUPPORTED_ELEMENTS, why));
        }
        let resource = match resource::path(uri, &self.folder) {
            Some(file) if !uri.is_empty() => Resource {
                uri: format!("file://{}", file.display()),
                resource_string: String::new(),
            },
            _ => request.world_resource,
        };
        Ok((self.of_this_run(scene), resource))
    }

    /// The scene with what belongs to the run.
    fn of_this_run(&self, scene: Scene) -> Scene {
        let mut time = scene.time;
        time.tick_ns = self.scene.time.tick_ns;
        let controller = match (&self.scene.controller, scene.controller) {
            (Controller::Builtin(_), Controller::Builtin(its)) => Controller::Builtin(its),
            (ours, _) => ours.clone(),
        };
        Scene { time, controller, outputs: self.scene.outputs.clone(), ..scene }
    }

    /// The scene to be settled, once.
    pub fn take_wanted(&mut self) -> Option<Scene> {
        self.wanted.take()
    }

    /// The scene that was wanted has been settled, or cannot be.
    pub fn loaded(&mut self, settled: Result<Vec<u8>, String>, world: &mut World<'_>) {
        let Some(Loading { asker, scene, resource, before }) = self.loading.take() else { return };
        let entered = settled.and_then(|start| {
            let keeps_time = self.is_monotonic;
            let settled = SettledScene { scene: scene.clone(), start, keeps_time };
            let change = Change::LoadScene(Box::new(settled));
            self.apply(&change, world).map_err(|refusal| refusal.to_string())
        });
        let answer = match entered {
            Ok(()) => {
                self.running.end_loading();
                self.enter(scene, resource);
                Loaded { result: ok(), world: self.world() }
            }
            Err(why) => {
                self.running.give_up_loading(before);
                let result = failed(SimResult::RESULT_OPERATION_FAILED, why);
                Loaded { result, ..Loaded::default() }
            }
        };
        self.send_answer(asker, &answer);
    }

    /// Everything that is known goes by another scene now.
    fn enter(&mut self, scene: Scene, resource: Resource) {
        self.register = Register::new(&scene);
        self.scene = Arc::new(scene);
        self.resource = resource;
        self.spawnables = None;
        self.commands.clear();
        *self.bag.borrow_mut() = None;
    }

    pub(super) fn unload_world(&mut self) -> UnloadWorldResponse {
        let result = if self.loading.is_some() {
            failed(SimResult::RESULT_INCORRECT_STATE, "a world is being loaded: wait for it")
        } else if !self.has_world() {
            failed(UnloadWorldResponse::NO_WORLD_LOADED, "no world is loaded")
        } else {
            self.end_all("the world was unloaded");
            self.running.unload();
            ok()
        };
        UnloadWorldResponse { result }
    }

    /// Whatever is under way belongs to a world that goes.
    fn end_all(&mut self, why: &str) {
        self.end_steps(why);
        self.give_up_grip();
    }

    pub(super) fn get_current_world(&self) -> GetCurrentWorldResponse {
        if !self.has_world() {
            let why = "no world is loaded";
            let result = failed(GetCurrentWorldResponse::NO_WORLD_LOADED, why);
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
                    let why = format!("source `{source}` is no folder");
                    let result = failed(SimResult::RESULT_NOT_FOUND, why);
                    return GetAvailableWorldsResponse { result, ..Default::default() };
                }
            }
        }
        // Reading them all takes a while: a list is made again only if a folder has changed.
        let shelf = Shelf::of(&folders);
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

fn code(fault: &ResourceFault) -> u8 {
    match fault {
        ResourceFault::UnsupportedFormat(_) => Loaded::UNSUPPORTED_FORMAT,
        ResourceFault::NoResource(_) => Loaded::NO_RESOURCE,
        ResourceFault::Malformed(_) => Loaded::RESOURCE_PARSE_ERROR,
        ResourceFault::MissingAssets(_) => Loaded::MISSING_ASSETS,
        ResourceFault::Unsupported(_) => Loaded::UNSUPPORTED_ASSETS,
    }
}

impl Version {
    /// The version that a distribution of ROS 2 carries.
    pub fn of_distribution(name: &str) -> Self {
        match name {
            "humble" | "iron" | "jazzy" | "kilted" => Self::One,
            _ => Self::Two,
        }
    }
}
