//! Checks on spawning and named poses.

use jamgrip::wire::{
    cdr::Cdr,
    messages::{
        RosService,
        geometry_msgs::PoseStamped,
        simulation_interfaces::{
            Bounds, DeleteEntityRequest, GetEntityBoundsRequest, GetNamedPoseBoundsRequest,
            GetNamedPosesRequest, GetSpawnablesRequest, GetSpawnablesResponse, Resource,
            Result as SimResult, SimulationState as S, SpawnEntitiesRequest, SpawnEntitiesResponse,
            SpawnEntity, SpawnEntityRequest, SpawnEntityResponse, SpawnResult, TagsFilter, srv,
        },
    },
};

use crate::{
    client::{Client, ensure, must_be, must_be_ok},
    entities::{all, near, pose_of},
    run_state::{enter, reset, step},
};

/// A ball, in the format that every simulator with a ROS interface reads.
const BALL: &str = r#"<?xml version="1.0"?>
<robot name="conformance_ball">
  <link name="body">
    <inertial>
      <mass value="0.05"/>
      <inertia ixx="8e-6" ixy="0" ixz="0" iyy="8e-6" iyz="0" izz="8e-6"/>
    </inertial>
    <visual><geometry><sphere radius="0.02"/></geometry></visual>
    <collision><geometry><sphere radius="0.02"/></geometry></collision>
  </link>
</robot>
"#;

/// A request for a ball in free fall, at `x` (m).
fn ball(name: &str, x: f64) -> SpawnEntityRequest {
    let mut initial_pose = PoseStamped::default();
    initial_pose.pose.position.x = x;
    initial_pose.pose.position.z = 0.5;
    initial_pose.pose.orientation.w = 1.0;
    SpawnEntityRequest {
        name: name.to_owned(),
        entity_resource: Resource { uri: String::new(), resource_string: BALL.to_owned() },
        initial_pose,
        ..Default::default()
    }
}

fn spawn(client: &mut Client, request: &SpawnEntityRequest) -> Result<SpawnEntityResponse, String> {
    client.call::<srv::SpawnEntity>("spawn_entity", request)
}

fn delete(client: &mut Client, entity: &str) -> Result<SimResult, String> {
    let request = DeleteEntityRequest { entity: entity.to_owned() };
    Ok(client.call::<srv::DeleteEntity>("delete_entity", &request)?.result)
}

pub(crate) fn spawned_and_deleted(client: &mut Client) -> Result<(), String> {
    enter(client, S::STATE_PAUSED)?;
    let before = all(client)?;
    let request = ball("conformance_ball", 0.75);
    let response = spawn(client, &request)?;
    must_be_ok("spawn_entity", &response.result)?;
    let name = response.entity_name;
    ensure(all(client)?.contains(&name), || format!("`{name}` is not listed"))?;
    let pose = pose_of(client, &name)?;
    ensure(near(&pose, &request.initial_pose.pose), || format!("`{name}` is at {pose:?}"))?;
    must_be_ok("step_simulation", &step(client, 20)?)?;
    let lower = pose_of(client, &name)?;
    let fallen = pose.position.z - lower.position.z;
    ensure(0.0 < fallen && fallen < 0.5, || format!("`{name}` fell by {fallen} m in 20 steps"))?;
    must_be_ok("delete_entity", &delete(client, &name)?)?;
    let after = all(client)?;
    ensure(before == after, || format!("{before:?} became {after:?}"))?;
    must_be("deleting it again", &delete(client, &name)?, SimResult::RESULT_NOT_FOUND)
}

pub(crate) fn rejected(client: &mut Client) -> Result<(), String> {
    let before = all(client)?;
    let first = spawn(client, &ball("conformance_ball", 0.75))?;
    must_be_ok("spawn_entity", &first.result)?;
    type R = SpawnEntityResponse;
    let with = |change: &dyn Fn(&mut SpawnEntityRequest)| {
        let mut request = ball("conformance_other", 1.0);
        change(&mut request);
        request
    };
    let cases: [(&str, SpawnEntityRequest, u8); 7] = [
        ("a name in use", with(&|it| it.name = "conformance_ball".to_owned()), 101),
        ("an invalid name", with(&|it| it.name = "a b/!".to_owned()), 102),
        ("no resource", with(&|it| it.entity_resource.resource_string.clear()), 104),
        (
            "a missing file",
            with(&|it| {
                it.entity_resource =
                    Resource { uri: "/no/such.urdf".to_owned(), ..Default::default() };
            }),
            104,
        ),
        ("an invalid namespace", with(&|it| it.entity_namespace = "a b".to_owned()), 105),
        ("a truncated file", with(&|it| it.entity_resource.resource_string.truncate(90)), 106),
        ("a pose of NaN", with(&|it| it.initial_pose.pose.position.y = f64::NAN), 109),
    ];
    for (what, request, code) in cases {
        let response = spawn(client, &request)?;
        must_be(what, &response.result, code)?;
    }
    let renamed = with(&|it| {
        it.name = "conformance_ball".to_owned();
        it.allow_renaming = true;
    });
    let response: R = spawn(client, &renamed)?;
    must_be_ok("a name in use, with renaming", &response.result)?;
    let is_new = response.entity_name != first.entity_name;
    ensure(is_new, || format!("two entities are called `{}`", response.entity_name))?;
    for name in [first.entity_name, response.entity_name] {
        must_be_ok("delete_entity", &delete(client, &name)?)?;
    }
    let after = all(client)?;
    ensure(before == after, || format!("{before:?} became {after:?}"))
}

pub(crate) fn many(client: &mut Client) -> Result<(), String> {
    let item = |name: &str, x: f64| {
        let SpawnEntityRequest { name, entity_resource, initial_pose, .. } = ball(name, x);
        SpawnEntity { name, entity_resource, initial_pose, ..Default::default() }
    };
    let mut wrong = item("conformance_c", 0.9);
    wrong.entity_resource = Resource::default();
    let spawn_requests = vec![item("conformance_a", 0.7), wrong, item("conformance_b", 0.8)];
    let request = SpawnEntitiesRequest { spawn_requests };
    let response = client.call::<srv::SpawnEntities>("spawn_entities", &request)?;
    must_be(
        "two valid requests and an invalid one",
        &response.result,
        SpawnEntitiesResponse::ENTITIES_SPAWN_FAILED,
    )?;
    let codes: Vec<u8> = response.results.iter().map(|it| it.result.result).collect();
    let expected = [SimResult::RESULT_OK, SpawnResult::NO_RESOURCE, SimResult::RESULT_OK];
    ensure(codes == expected, || format!("results {codes:?}"))?;
    for name in ["conformance_a", "conformance_b"] {
        must_be_ok("delete_entity", &delete(client, name)?)?;
    }
    Ok(())
}

pub(crate) fn spawnables(client: &mut Client) -> Result<(), String> {
    let request = Cdr::of(&GetSpawnablesRequest::default());
    let response = client.call_raw("get_spawnables", srv::GetSpawnables::TYPE, &request)?;
    let uris: Vec<String> = if client.version() == 2 {
        let response: GetSpawnablesResponse = response.read().map_err(|it| it.to_string())?;
        must_be_ok("get_spawnables", &response.result)?;
        response.spawnables.into_iter().map(|it| it.entity_resource.uri).collect()
    } else {
        type Flat = (SimResult, Vec<(String, String, Bounds)>);
        let (result, list): Flat = response.read().map_err(|it| it.to_string())?;
        must_be_ok("get_spawnables", &result)?;
        list.into_iter().map(|it| it.0).collect()
    };
    for uri in uris.into_iter().take(3) {
        let mut request = ball("conformance_listed", 1.25);
        request.entity_resource = Resource { uri: uri.clone(), ..Default::default() };
        let response = spawn(client, &request)?;
        must_be_ok(&format!("spawning `{uri}`"), &response.result)?;
        must_be_ok("delete_entity", &delete(client, &response.entity_name)?)?;
    }
    Ok(())
}

pub(crate) fn deleted_by_reset(client: &mut Client) -> Result<(), String> {
    let before = all(client)?;
    must_be_ok("spawn_entity", &spawn(client, &ball("conformance_ball", 0.75))?.result)?;
    must_be_ok("reset_simulation", &reset(client, 3)?)?;
    let kept = all(client)?;
    ensure(kept.len() == before.len() + 1, || format!("scope 3 leaves {kept:?}"))?;
    must_be_ok("reset_simulation", &reset(client, 4)?)?;
    let after = all(client)?;
    ensure(before == after, || format!("scope 4 leaves {after:?}"))
}

pub(crate) fn named_poses(client: &mut Client) -> Result<(), String> {
    let request = GetNamedPosesRequest::default();
    let response = client.call::<srv::GetNamedPoses>("get_named_poses", &request)?;
    must_be_ok("get_named_poses", &response.result)?;
    let all = response.poses;
    for pose in &all {
        let request = GetNamedPoseBoundsRequest { name: pose.name.clone() };
        let response = client.call::<srv::GetNamedPoseBounds>("get_named_pose_bounds", &request)?;
        must_be_ok("get_named_pose_bounds", &response.result)?;
        let Some(tag) = pose.tags.first() else { continue };
        let tags = TagsFilter { tags: vec![tag.clone()], filter_mode: TagsFilter::FILTER_MODE_ALL };
        let request = GetNamedPosesRequest { tags };
        let found = client.call::<srv::GetNamedPoses>("get_named_poses", &request)?.poses;
        let is_right = found.contains(pose) && found.iter().all(|it| it.tags.contains(tag));
        ensure(is_right, || format!("tag `{tag}` finds {found:?}"))?;
    }
    let request = GetNamedPoseBoundsRequest { name: "no such pose".to_owned() };
    let response = client.call::<srv::GetNamedPoseBounds>("get_named_pose_bounds", &request)?;
    must_be("bounds of an unknown pose", &response.result, SimResult::RESULT_NOT_FOUND)
}

/// Corners (m) of a regular tetrahedron, and its faces as seen from outside.
const TETRAHEDRON: ([[f64; 3]; 4], [[usize; 3]; 4]) = (
    [[0.02, 0.02, 0.02], [0.02, -0.02, -0.02], [-0.02, 0.02, -0.02], [-0.02, -0.02, 0.02]],
    [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
);

/// The tetrahedron as an STL file.
fn tetrahedron() -> String {
    let (corners, faces) = TETRAHEDRON;
    let mut text = "solid conformance\n".to_owned();
    for face in faces {
        text += "facet normal 0 0 0\nouter loop\n";
        for corner in face {
            let [x, y, z] = corners[corner];
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid conformance\n"
}

/// Checks the convex hull of a mesh, if the simulator can read a file from here; otherwise it
/// reports missing assets.
pub(crate) fn convex_hull(client: &mut Client) -> Result<(), String> {
    let file = std::env::temp_dir().join(format!("conformance_{}.stl", std::process::id()));
    std::fs::write(&file, tetrahedron()).map_err(|it| format!("{}: {it}", file.display()))?;
    let mesh = format!("<mesh filename=\"file://{}\"/>", file.display());
    let mut request = ball("conformance_mesh", 0.75);
    request.entity_resource.resource_string = BALL.replace("<sphere radius=\"0.02\"/>", &mesh);
    let spawned = spawn(client, &request);
    drop(std::fs::remove_file(&file));
    let spawned = spawned?;
    if spawned.result.result == SpawnResult::MISSING_ASSETS {
        return Ok(());
    }
    must_be_ok("spawning a mesh", &spawned.result)?;
    let entity = spawned.entity_name.clone();
    let request = GetEntityBoundsRequest { entity };
    let response = client.call::<srv::GetEntityBounds>("get_entity_bounds", &request)?;
    must_be_ok("get_entity_bounds", &response.result)?;
    must_be_ok("delete_entity", &delete(client, &spawned.entity_name)?)?;
    let Bounds { r#type: kind, points } = &response.bounds;
    ensure(*kind == Bounds::TYPE_CONVEX_HULL, || format!("bounds of a mesh are of type {kind}"))?;
    ensure(points.len() == 4, || format!("a tetrahedron has corners {points:?}"))?;
    let edge = 0.04 * 2.0_f64.sqrt();
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            let squares = [a.x - b.x, a.y - b.y, a.z - b.z].map(|it| it * it);
            let length = squares.iter().sum::<f64>().sqrt();
            // Mesh formats store seven digits.
            ensure((length - edge).abs() < 1e-6, || format!("an edge of {edge} m is {length} m"))?;
        }
    }
    Ok(())
}
