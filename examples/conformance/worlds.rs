//! Checks on worlds: listing, loading and unloading them.

use jamgrip::wire::messages::simulation_interfaces::{
    GetAvailableWorldsRequest, GetCurrentWorldRequest, GetCurrentWorldResponse, LoadWorldRequest,
    LoadWorldResponse as R, Resource, Result as SimResult, SimulationState as S, TagsFilter,
    UnloadWorldRequest, UnloadWorldResponse, WorldResource, srv,
};

use crate::{
    client::{Client, ensure, must_be, must_be_ok, must_fail},
    entities::all,
    run_state::{enter, set, state, step},
};

/// Number of listed worlds that are loaded.
const WORLDS_TRIED: usize = 3;

fn current(client: &mut Client) -> Result<GetCurrentWorldResponse, String> {
    client.call::<srv::GetCurrentWorld>("get_current_world", &GetCurrentWorldRequest::default())
}

fn load(client: &mut Client, world_resource: Resource) -> Result<R, String> {
    let request = LoadWorldRequest { world_resource, ..Default::default() };
    client.call::<srv::LoadWorld>("load_world", &request)
}

fn unload(client: &mut Client) -> Result<SimResult, String> {
    let request = UnloadWorldRequest::default();
    Ok(client.call::<srv::UnloadWorld>("unload_world", &request)?.result)
}

/// Checks that the loaded world is stopped and is the current one.
fn check_loaded(client: &mut Client, loaded: &R, name: &str) -> Result<(), String> {
    must_be_ok(&format!("load_world of `{name}`"), &loaded.result)?;
    let found = state(client)?;
    ensure(found == S::STATE_STOPPED, || format!("state {found} after loading, not stopped"))?;
    let now = current(client)?;
    must_be_ok("get_current_world", &now.result)?;
    let is_named = now.world.name == name && loaded.world == now.world;
    ensure(is_named, || format!("`{name}` was loaded, {:?} is there", now.world))
}

/// Checks that the current world can be stepped.
fn check_steps(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    must_be_ok("step_simulation", &step(client, 2)?)
}

pub(crate) fn unloaded_and_loaded(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    let before = current(client)?.world;
    let entities = all(client)?;
    must_be_ok("unload_world", &unload(client)?)?;
    let found = state(client)?;
    ensure(found == S::STATE_NO_WORLD, || format!("state {found} without a world"))?;
    must_be("a second time", &unload(client)?, UnloadWorldResponse::NO_WORLD_LOADED)?;
    let now = current(client)?;
    must_be("no world", &now.result, GetCurrentWorldResponse::NO_WORLD_LOADED)?;
    let left = all(client)?;
    ensure(left.is_empty(), || format!("without a world there is {left:?}"))?;
    must_fail("playing without a world", &set(client, S::STATE_PLAYING)?)?;
    must_fail("a step without a world", &step(client, 1)?)?;
    let loaded = load(client, before.world_resource.clone())?;
    check_loaded(client, &loaded, &before.name)?;
    let again = all(client)?;
    ensure(again == entities, || format!("{entities:?} became {again:?}"))?;
    check_steps(client)
}

/// Loads a world from the text of a file, if the current world's file can be read here.
pub(crate) fn loaded_from_text(client: &mut Client) -> Result<(), String> {
    let before = current(client)?.world;
    let text = match before.world_resource.uri.strip_prefix("file://") {
        Some(path) => std::fs::read_to_string(path).unwrap_or_default(),
        None => before.world_resource.resource_string.clone(),
    };
    if text.is_empty() {
        return Ok(());
    }
    let loaded = load(client, Resource { uri: String::new(), resource_string: text })?;
    check_loaded(client, &loaded, &before.name)?;
    check_steps(client)?;
    let loaded = load(client, before.world_resource)?;
    check_loaded(client, &loaded, &before.name)
}

pub(crate) fn rejected(client: &mut Client) -> Result<(), String> {
    let before = current(client)?.world;
    let uri = |it: &str| Resource { uri: it.to_owned(), ..Resource::default() };
    let text = |it: &str| Resource { resource_string: it.to_owned(), ..Resource::default() };
    must_be("neither file nor text", &load(client, Resource::default())?.result, R::NO_RESOURCE)?;
    let strange = load(client, text("<conformance/>"))?.result;
    let is_rejected = [R::UNSUPPORTED_FORMAT, R::RESOURCE_PARSE_ERROR].contains(&strange.result);
    ensure(is_rejected, || format!("a text of unknown format: result {}", strange.result))?;
    for (what, resource) in [
        ("a missing file", uri("file:///no/such/world.yaml")),
        ("an unknown address", uri("conformance://no/such/world")),
        ("a truncated text", text("name: [")),
    ] {
        must_fail(what, &load(client, resource)?.result)?;
    }
    // The standard does not say whether the previous world is kept.
    let found = state(client)?;
    if found == S::STATE_NO_WORLD {
        let loaded = load(client, before.world_resource)?;
        return check_loaded(client, &loaded, &before.name);
    }
    let now = current(client)?.world;
    ensure(now == before, || format!("{before:?} became {now:?}"))
}

pub(crate) fn others_loaded(client: &mut Client) -> Result<(), String> {
    let before = current(client)?.world;
    let request = GetAvailableWorldsRequest::default();
    let response = client.call::<srv::GetAvailableWorlds>("get_available_worlds", &request)?;
    must_be_ok("get_available_worlds", &response.result)?;
    for world in response.worlds.into_iter().take(WORLDS_TRIED) {
        let WorldResource { name, world_resource, .. } = world;
        let loaded = load(client, world_resource)?;
        check_loaded(client, &loaded, &name)?;
        let entities = all(client)?;
        ensure(!entities.is_empty(), || format!("world `{name}` is empty"))?;
        check_steps(client)?;
    }
    let loaded = load(client, before.world_resource)?;
    check_loaded(client, &loaded, &before.name)
}

pub(crate) fn current_world(client: &mut Client) -> Result<(), String> {
    let request = GetCurrentWorldRequest::default();
    let response = client.call::<srv::GetCurrentWorld>("get_current_world", &request)?;
    must_be_ok("get_current_world", &response.result)?;
    ensure(!response.world.name.is_empty(), || "the world has no name".to_owned())
}

pub(crate) fn available_worlds(client: &mut Client) -> Result<(), String> {
    let request = GetAvailableWorldsRequest::default();
    let response = client.call::<srv::GetAvailableWorlds>("get_available_worlds", &request)?;
    must_be_ok("get_available_worlds", &response.result)?;
    for world in response.worlds.iter().take(3) {
        let filter =
            TagsFilter { tags: world.tags.clone(), filter_mode: TagsFilter::FILTER_MODE_ALL };
        let request = GetAvailableWorldsRequest { filter, ..Default::default() };
        let found =
            client.call::<srv::GetAvailableWorlds>("get_available_worlds", &request)?.worlds;
        ensure(found.contains(world), || format!("its own tags do not find `{}`", world.name))?;
    }
    let filter = TagsFilter { tags: vec!["no such tag".to_owned()], filter_mode: 0 };
    let request = GetAvailableWorldsRequest { filter, ..Default::default() };
    let found = client.call::<srv::GetAvailableWorlds>("get_available_worlds", &request)?.worlds;
    ensure(found.is_empty(), || format!("no tag finds {found:?}"))?;
    let additional_sources = vec!["/no/such/folder".to_owned()];
    let request = GetAvailableWorldsRequest { additional_sources, ..Default::default() };
    let response = client.call::<srv::GetAvailableWorlds>("get_available_worlds", &request)?;
    must_fail("worlds from nowhere", &response.result)
}
