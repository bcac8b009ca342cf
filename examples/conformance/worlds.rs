//! Checks on worlds: which there are, which one is there, another one in its place, or none.

use jamgrip::wire::messages::simulation_interfaces::{
    GetAvailableWorldsRequest, GetCurrentWorldRequest, GetCurrentWorldResponse, LoadWorldRequest,
    LoadWorldResponse as R, Resource, Result as SimResult, SimulationState as S, TagsFilter,
    UnloadWorldRequest, UnloadWorldResponse, WorldResource, srv,
};

use crate::{
    client::{Client, ensure, must_be, must_be_ok, must_fail},
    entities::all,
    running::{go_to, set, state, step},
};

/// Worlds that are loaded one after the other.
const WORLDS_TRIED: usize = 3;

fn present(client: &mut Client) -> Result<GetCurrentWorldResponse, String> {
    client.ask::<srv::GetCurrentWorld>("get_current_world", &GetCurrentWorldRequest::default())
}

fn load(client: &mut Client, world_resource: Resource) -> Result<R, String> {
    let request = LoadWorldRequest { world_resource, ..Default::default() };
    client.ask::<srv::LoadWorld>("load_world", &request)
}

fn unload(client: &mut Client) -> Result<SimResult, String> {
    let request = UnloadWorldRequest::default();
    Ok(client.ask::<srv::UnloadWorld>("unload_world", &request)?.result)
}

/// A loaded world stands stopped and is the present one.
fn is_there(client: &mut Client, loaded: &R, name: &str) -> Result<(), String> {
    must_be_ok(&format!("load_world of `{name}`"), &loaded.result)?;
    let found = state(client)?;
    ensure(found == S::STATE_STOPPED, || format!("state {found} after loading, not stopped"))?;
    let now = present(client)?;
    must_be_ok("get_current_world", &now.result)?;
    let is_named = now.world.name == name && loaded.world == now.world;
    ensure(is_named, || format!("`{name}` was loaded, {:?} is there", now.world))
}

/// Ticks can be made in the world that is there.
fn runs(client: &mut Client) -> Result<(), String> {
    go_to(client, S::STATE_PAUSED)?;
    must_be_ok("step_simulation", &step(client, 2)?)
}

pub(crate) fn unloaded_and_loaded(client: &mut Client) -> Result<(), String> {
    go_to(client, S::STATE_PAUSED)?;
    let before = present(client)?.world;
    let entities = all(client)?;
    must_be_ok("unload_world", &unload(client)?)?;
    let found = state(client)?;
    ensure(found == S::STATE_NO_WORLD, || format!("state {found} without a world"))?;
    must_be("a second time", &unload(client)?, UnloadWorldResponse::NO_WORLD_LOADED)?;
    let now = present(client)?;
    must_be("no world", &now.result, GetCurrentWorldResponse::NO_WORLD_LOADED)?;
    let left = all(client)?;
    ensure(left.is_empty(), || format!("without a world there is {left:?}"))?;
    must_fail("playing nothing", &set(client, S::STATE_PLAYING)?)?;
    must_fail("a step of nothing", &step(client, 1)?)?;
    let loaded = load(client, before.world_resource.clone())?;
    is_there(client, &loaded, &before.name)?;
    let again = all(client)?;
    ensure(again == entities, || format!("{entities:?} became {again:?}"))?;
    runs(client)
}

/// From a file's text, where the present world's file can be read here.
pub(crate) fn loaded_from_text(client: &mut Client) -> Result<(), String> {
    let before = present(client)?.world;
    let text = match before.world_resource.uri.strip_prefix("file://") {
        Some(path) => std::fs::read_to_string(path).unwrap_or_default(),
        None => before.world_resource.resource_string.clone(),
    };
    if text.is_empty() {
        return Ok(());
    }
    let loaded = load(client, Resource { uri: String::new(), resource_string: text })?;
    is_there(client, &loaded, &before.name)?;
    runs(client)?;
    let loaded = load(client, before.world_resource)?;
    is_there(client, &loaded, &before.name)
}

pub(crate) fn refused(client: &mut Client) -> Result<(), String> {
    let before = present(client)?.world;
    let uri = |it: &str| Resource { uri: it.to_owned(), ..Resource::default() };
    let text = |it: &str| Resource { resource_string: it.to_owned(), ..Resource::default() };
    must_be("neither file nor text", &load(client, Resource::default())?.result, R::NO_RESOURCE)?;
    let strange = load(client, text("<conformance/>"))?.result;
    let is_refused = [R::UNSUPPORTED_FORMAT, R::RESOURCE_PARSE_ERROR].contains(&strange.result);
    ensure(is_refused, || format!("a text in no format: result {}", strange.result))?;
    for (what, resource) in [
        ("a file that is not there", uri("file:///no/such/world.yaml")),
        ("an address of nothing", uri("conformance://no/such/world")),
        ("half a text", text("name: [")),
    ] {
        must_fail(what, &load(client, resource)?.result)?;
    }
    // The standard leaves open whether the world before is still there.
    let found = state(client)?;
    if found == S::STATE_NO_WORLD {
        let loaded = load(client, before.world_resource)?;
        return is_there(client, &loaded, &before.name);
    }
    let now = present(client)?.world;
    ensure(now == before, || format!("{before:?} became {now:?}"))
}

pub(crate) fn others_loaded(client: &mut Client) -> Result<(), String> {
    let before = present(client)?.world;
    let request = GetAvailableWorldsRequest::default();
    let answer = client.ask::<srv::GetAvailableWorlds>("get_available_worlds", &request)?;
    must_be_ok("get_available_worlds", &answer.result)?;
    for world in answer.worlds.into_iter().take(WORLDS_TRIED) {
        let WorldResource { name, world_resource, .. } = world;
        let loaded = load(client, world_resource)?;
        is_there(client, &loaded, &name)?;
        let entities = all(client)?;
        ensure(!entities.is_empty(), || format!("world `{name}` is empty"))?;
        runs(client)?;
    }
    let loaded = load(client, before.world_resource)?;
    is_there(client, &loaded, &before.name)
}

pub(crate) fn current_world(client: &mut Client) -> Result<(), String> {
    let request = GetCurrentWorldRequest::default();
    let answer = client.ask::<srv::GetCurrentWorld>("get_current_world", &request)?;
    must_be_ok("get_current_world", &answer.result)?;
    ensure(!answer.world.name.is_empty(), || "the world has no name".to_owned())
}

pub(crate) fn available_worlds(client: &mut Client) -> Result<(), String> {
    let request = GetAvailableWorldsRequest::default();
    let answer = client.ask::<srv::GetAvailableWorlds>("get_available_worlds", &request)?;
    must_be_ok("get_available_worlds", &answer.result)?;
    for world in answer.worlds.iter().take(3) {
        let filter =
            TagsFilter { tags: world.tags.clone(), filter_mode: TagsFilter::FILTER_MODE_ALL };
        let request = GetAvailableWorldsRequest { filter, ..Default::default() };
        let found = client.ask::<srv::GetAvailableWorlds>("get_available_worlds", &request)?.worlds;
        ensure(found.contains(world), || format!("its own tags do not find `{}`", world.name))?;
    }
    let filter = TagsFilter { tags: vec!["no such tag".to_owned()], filter_mode: 0 };
    let request = GetAvailableWorldsRequest { filter, ..Default::default() };
    let found = client.ask::<srv::GetAvailableWorlds>("get_available_worlds", &request)?.worlds;
    ensure(found.is_empty(), || format!("no tag finds {found:?}"))?;
    let additional_sources = vec!["/no/such/folder".to_owned()];
    let request = GetAvailableWorldsRequest { additional_sources, ..Default::default() };
    let answer = client.ask::<srv::GetAvailableWorlds>("get_available_worlds", &request)?;
    must_fail("worlds from nowhere", &answer.result)
}
