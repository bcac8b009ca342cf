//! Checks on entities.

use jamgrip::wire::{
    cdr::Cdr,
    messages::{
        RosService,
        geometry_msgs::{Pose, Vector3},
        simulation_interfaces::{
            Bounds, EntityCategory, EntityFilters, EntityInfo, EntityState, GetEntitiesRequest,
            GetEntitiesStatesRequest, GetEntityBoundsRequest, GetEntityInfoRequest,
            GetEntityStateRequest, Result as SimResult, SetEntityInfoRequest,
            SetEntityStateRequest, SetEntityStateResponse, SimulationState as S, TagsFilter, srv,
        },
    },
};

use crate::{
    client::{Client, ensure, must_be, must_be_ok, must_fail},
    run_state::{enter, reset},
};

fn select(
    client: &mut Client,
    filters: &EntityFilters,
) -> Result<(SimResult, Vec<String>), String> {
    let request = GetEntitiesRequest { filters: filters.clone() };
    let response = client.call::<srv::GetEntities>("get_entities", &request)?;
    Ok((response.result, response.entities))
}

/// Names of all entities.
pub(crate) fn all(client: &mut Client) -> Result<Vec<String>, String> {
    let (result, entities) = select(client, &EntityFilters::default())?;
    must_be_ok("get_entities", &result)?;
    Ok(entities)
}

fn state_of(client: &mut Client, name: &str) -> Result<EntityState, String> {
    let request = GetEntityStateRequest { entity: name.to_owned() };
    let response = client.call::<srv::GetEntityState>("get_entity_state", &request)?;
    must_be_ok(&format!("get_entity_state of `{name}`"), &response.result)?;
    Ok(response.state)
}

/// The pose of an entity.
pub(crate) fn pose_of(client: &mut Client, name: &str) -> Result<Pose, String> {
    Ok(state_of(client, name)?.pose)
}

fn info_of(client: &mut Client, name: &str) -> Result<EntityInfo, String> {
    let request = GetEntityInfoRequest { entity: name.to_owned() };
    let response = client.call::<srv::GetEntityInfo>("get_entity_info", &request)?;
    must_be_ok(&format!("get_entity_info of `{name}`"), &response.result)?;
    Ok(response.info)
}

/// An entity that can be moved, preferably a dynamic one.
pub(crate) fn movable(client: &mut Client) -> Result<Option<String>, String> {
    for name in all(client)? {
        let category = info_of(client, &name)?.category.category;
        if [EntityCategory::CATEGORY_OBJECT, EntityCategory::CATEGORY_DYNAMIC_OBJECT]
            .contains(&category)
        {
            return Ok(Some(name));
        }
    }
    Ok(None)
}

pub(crate) fn listed(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    let mut entities = all(client)?;
    let n = entities.len();
    ensure(entities.iter().all(|it| !it.is_empty()), || "an entity has no name".to_owned())?;
    entities.sort();
    entities.dedup();
    ensure(n == entities.len(), || format!("names are not unique: {entities:?}"))
}

pub(crate) fn filtered_by_name(client: &mut Client) -> Result<(), String> {
    let entities = all(client)?;
    for name in &entities {
        // Every character with a meaning in POSIX expressions is escaped by brackets.
        let escaped: String =
            name.chars()
                .map(|it| {
                    if it.is_alphanumeric() || it == '_' {
                        it.to_string()
                    } else {
                        format!("[{it}]")
                    }
                })
                .collect();
        let filters = EntityFilters { filter: format!("^{escaped}$"), ..Default::default() };
        let (result, found) = select(client, &filters)?;
        must_be_ok("get_entities", &result)?;
        ensure(found == [name.clone()], || format!("`^{escaped}$` finds {found:?}"))?;
    }
    let alternatives = format!("^({})$", entities.join("|"));
    let filters = EntityFilters { filter: alternatives, ..Default::default() };
    let (_, found) = select(client, &filters)?;
    ensure(found.len() == entities.len(), || format!("alternatives find {found:?}"))?;
    let filters =
        EntityFilters { filter: "^no[[:digit:]]{7}such$".to_owned(), ..Default::default() };
    let (result, found) = select(client, &filters)?;
    must_be_ok("get_entities", &result)?;
    ensure(found.is_empty(), || format!("a filter without match finds {found:?}"))?;
    let filters = EntityFilters { filter: "([".to_owned(), ..Default::default() };
    must_fail("a filter that is no expression", &select(client, &filters)?.0)
}

pub(crate) fn filtered_by_category(client: &mut Client) -> Result<(), String> {
    let mut counted = 0;
    for category in [0, 1, 2, 4, 5] {
        let categories = vec![EntityCategory { category }];
        let filters = EntityFilters { categories, ..Default::default() };
        let (result, found) = select(client, &filters)?;
        must_be_ok("get_entities", &result)?;
        counted += found.len();
        for name in found {
            let its = info_of(client, &name)?.category.category;
            ensure(its == category, || format!("`{name}` of category {its} is among {category}"))?;
        }
    }
    let n = all(client)?.len();
    ensure(counted == n, || format!("{counted} of {n} entities have a category"))
}

fn set_info(client: &mut Client, entity: &str, info: EntityInfo) -> Result<SimResult, String> {
    let request = SetEntityInfoRequest { entity: entity.to_owned(), info };
    Ok(client.call::<srv::SetEntityInfo>("set_entity_info", &request)?.result)
}

pub(crate) fn filtered_by_tags(client: &mut Client) -> Result<(), String> {
    let entities = all(client)?;
    let Some(name) = entities.first() else { return Ok(()) };
    let before = info_of(client, name)?;
    let tags = ["conformance_a", "conformance_b"].map(str::to_owned).to_vec();
    must_be_ok("set_entity_info", &set_info(client, name, EntityInfo { tags, ..before.clone() })?)?;
    let cases: [(&[&str], u8, usize); 4] = [
        (&["conformance_a"], TagsFilter::FILTER_MODE_ANY, 1),
        (&["conformance_a", "conformance_c"], TagsFilter::FILTER_MODE_ANY, 1),
        (&["conformance_a", "conformance_c"], TagsFilter::FILTER_MODE_ALL, 0),
        (&["conformance_a", "conformance_b"], TagsFilter::FILTER_MODE_ALL, 1),
    ];
    for (tags, filter_mode, n) in cases {
        let tags =
            TagsFilter { tags: tags.iter().map(|it| (*it).to_owned()).collect(), filter_mode };
        let filters = EntityFilters { tags: tags.clone(), ..Default::default() };
        let (result, found) = select(client, &filters)?;
        must_be_ok("get_entities", &result)?;
        ensure(found.len() == n, || format!("{tags:?} finds {found:?}"))?;
    }
    must_be_ok("set_entity_info", &set_info(client, name, before)?)
}

pub(crate) fn filtered_by_sphere(client: &mut Client) -> Result<(), String> {
    let sphere = |center: Vector3, radius: f64| Bounds {
        r#type: Bounds::TYPE_SPHERE,
        points: vec![center, Vector3 { x: radius, ..Default::default() }],
    };
    for name in all(client)? {
        let p = pose_of(client, &name)?.position;
        // Large enough to reach any body from the origin of its frame.
        let bounds = sphere(Vector3 { x: p.x, y: p.y, z: p.z }, 1.0);
        let (result, found) = select(client, &EntityFilters { bounds, ..Default::default() })?;
        must_be_ok("get_entities", &result)?;
        ensure(found.contains(&name), || format!("a sphere about `{name}` finds {found:?}"))?;
    }
    let bounds = sphere(Vector3 { x: 1e6, y: 1e6, z: 1e6 }, 1.0);
    let (result, found) = select(client, &EntityFilters { bounds, ..Default::default() })?;
    must_be_ok("get_entities", &result)?;
    ensure(found.is_empty(), || format!("far away there is {found:?}"))
}

pub(crate) fn states_agree(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    let request = GetEntitiesStatesRequest::default();
    let response = client.call::<srv::GetEntitiesStates>("get_entities_states", &request)?;
    must_be_ok("get_entities_states", &response.result)?;
    let (names, states) = (response.entities, response.states);
    ensure(names.len() == states.len(), || format!("{} states of {names:?}", states.len()))?;
    let listed = all(client)?;
    ensure(names == listed, || format!("states of {names:?}, entities {listed:?}"))?;
    for (name, state) in names.iter().zip(states) {
        let single = state_of(client, name)?;
        ensure(single == state, || format!("`{name}` is {single:?} and {state:?}"))?;
        let q = &state.pose.orientation;
        let length = (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w).sqrt();
        ensure((length - 1.0).abs() < 1e-6, || {
            format!("the quaternion of `{name}` has norm {length}")
        })?;
    }
    Ok(())
}

pub(crate) fn unknown(client: &mut Client) -> Result<(), String> {
    let request = GetEntityStateRequest { entity: "no such entity".to_owned() };
    let response = client.call::<srv::GetEntityState>("get_entity_state", &request)?;
    must_be("the state of an unknown entity", &response.result, SimResult::RESULT_NOT_FOUND)
}

fn set_state(client: &mut Client, request: &SetEntityStateRequest) -> Result<SimResult, String> {
    if client.version() == 2 {
        return Ok(client.call::<srv::SetEntityState>("set_entity_state", request)?.result);
    }
    // Requests of version 1 end before the three flags.
    let mut body = Cdr::of(request);
    body.bytes.truncate(body.bytes.len() - 3);
    let response = client.call_raw("set_entity_state", srv::SetEntityState::TYPE, &body)?;
    let response: SetEntityStateResponse = response.read().map_err(|it| it.to_string())?;
    Ok(response.result)
}

pub(crate) fn state_is_set(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    let Some(name) = movable(client)? else { return Ok(()) };
    let before = state_of(client, &name)?;
    let mut state = before.clone();
    state.pose.position.x += 0.5;
    state.pose.position.z += 0.25;
    state.twist.linear = Vector3 { x: 0.25, y: 0.0, z: 0.5 };
    let mut request = SetEntityStateRequest { entity: name.clone(), state, ..Default::default() };
    (request.set_pose, request.set_twist) = (true, true);
    must_be_ok("pose and twist", &set_state(client, &request)?)?;
    let now = state_of(client, &name)?;
    let is_set = near(&now.pose, &request.state.pose)
        && (now.twist.linear.x - 0.25).abs() < 1e-9
        && (now.twist.linear.z - 0.5).abs() < 1e-9;
    ensure(is_set, || format!("`{name}` was set to {:?} and is {now:?}", request.state))?;
    if client.version() == 2 {
        let mut only = request.clone();
        (only.set_pose, only.set_twist) = (true, false);
        only.state.pose.position.x += 0.1;
        only.state.twist.linear.x = 9.0;
        must_be_ok("pose alone", &set_state(client, &only)?)?;
        let after = state_of(client, &name)?;
        ensure(near(&after.pose, &only.state.pose), || format!("the pose is {:?}", after.pose))?;
        ensure(after.twist == now.twist, || format!("the twist became {:?}", after.twist))?;
        (only.set_pose, only.set_twist) = (false, true);
        only.state.pose.position.x += 0.1;
        only.state.twist.linear.x = 0.125;
        must_be_ok("twist alone", &set_state(client, &only)?)?;
        let last = state_of(client, &name)?;
        ensure(near(&last.pose, &after.pose), || format!("the pose became {:?}", last.pose))?;
        ensure((last.twist.linear.x - 0.125).abs() < 1e-9, || format!("{:?}", last.twist))?;
    }
    must_be_ok("reset_simulation", &reset(client, 0)?)
}

/// True if two poses are equal within a tolerance.
pub(crate) fn near(a: &Pose, b: &Pose) -> bool {
    let (p, q) = (&a.position, &b.position);
    (p.x - q.x).abs() < 1e-9 && (p.y - q.y).abs() < 1e-9 && (p.z - q.z).abs() < 1e-9
}

pub(crate) fn invalid_states(client: &mut Client) -> Result<(), String> {
    let Some(name) = movable(client)? else { return Ok(()) };
    let before = state_of(client, &name)?;
    let mut request =
        SetEntityStateRequest { entity: name.clone(), state: before.clone(), ..Default::default() };
    (request.set_pose, request.set_twist) = (true, true);
    let mut wrong = request.clone();
    wrong.state.pose.position.x = f64::NAN;
    must_be("a pose of NaN", &set_state(client, &wrong)?, SetEntityStateResponse::INVALID_POSE)?;
    let mut wrong = request.clone();
    wrong.state.pose.orientation.w = 5.0;
    must_be(
        "a long quaternion",
        &set_state(client, &wrong)?,
        SetEntityStateResponse::INVALID_POSE,
    )?;
    let mut wrong = request.clone();
    wrong.state.twist.angular.z = f64::INFINITY;
    must_fail("an infinite twist", &set_state(client, &wrong)?)?;
    let mut wrong = request.clone();
    wrong.state.header.frame_id = "no_such_frame".to_owned();
    must_fail("an unknown frame", &set_state(client, &wrong)?)?;
    let mut wrong = request;
    wrong.entity = "no such entity".to_owned();
    must_be(
        "the state of an unknown entity",
        &set_state(client, &wrong)?,
        SimResult::RESULT_NOT_FOUND,
    )?;
    let after = state_of(client, &name)?;
    ensure(after.pose == before.pose, || format!("`{name}` has moved to {:?}", after.pose))
}

pub(crate) fn info_is_set(client: &mut Client) -> Result<(), String> {
    for name in all(client)? {
        let before = info_of(client, &name)?;
        let mut info = before.clone();
        info.description = "conformance: a description".to_owned();
        info.tags.push("conformance".to_owned());
        must_be_ok("set_entity_info", &set_info(client, &name, info.clone())?)?;
        let now = info_of(client, &name)?;
        ensure(now == info, || format!("`{name}` was set to {info:?} and is {now:?}"))?;
        must_be_ok("set_entity_info", &set_info(client, &name, before)?)?;
    }
    let result = set_info(client, "no such entity", EntityInfo::default())?;
    must_be("information about an unknown entity", &result, SimResult::RESULT_NOT_FOUND)
}

pub(crate) fn bounds(client: &mut Client) -> Result<(), String> {
    let names = all(client)?;
    for name in names.iter().map(String::as_str).chain(["no such entity"]) {
        let request = GetEntityBoundsRequest { entity: name.to_owned() };
        let response = client.call::<srv::GetEntityBounds>("get_entity_bounds", &request)?;
        if !names.iter().any(|it| it == name) {
            must_be("bounds of an unknown entity", &response.result, SimResult::RESULT_NOT_FOUND)?;
            continue;
        }
        must_be_ok(&format!("bounds of `{name}`"), &response.result)?;
        let points = &response.bounds.points;
        let is_right = match response.bounds.r#type {
            Bounds::TYPE_EMPTY => points.is_empty(),
            Bounds::TYPE_BOX => matches!(points.as_slice(), [high, low]
                if low.x <= high.x && low.y <= high.y && low.z <= high.z),
            Bounds::TYPE_CONVEX_HULL => 3 <= points.len(),
            Bounds::TYPE_SPHERE => points.len() == 2 && 0.0 <= points[1].x,
            _ => false,
        };
        ensure(is_right, || format!("bounds of `{name}` are {:?}", response.bounds))?;
    }
    Ok(())
}

pub(crate) fn reset_spawned(client: &mut Client) -> Result<(), String> {
    let before = all(client)?;
    must_be_ok("reset_simulation", &reset(client, 4)?)?;
    let after = all(client)?;
    ensure(before == after, || format!("{before:?} became {after:?} though nothing was spawned"))
}
