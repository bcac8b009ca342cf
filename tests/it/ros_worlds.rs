//! Loading another scene and spawning objects while the program runs, from outside.

use std::{path::Path, process::Command};

use jamgrip::{
    ros::node::RosNode,
    wire::{
        messages::{
            geometry_msgs::PoseStamped,
            shape_msgs::Mesh,
            simulation_interfaces::{
                GetSimulationStateRequest, GetSimulationStateResponse, LoadWorldRequest,
                LoadWorldResponse, Resource, Result as SimResult, SetSimulationStateRequest,
                SetSimulationStateResponse, SimulationState, SpawnEntityRequest,
                SpawnEntityResponse, StepSimulationRequest, StepSimulationResponse, srv,
            },
        },
        topics::{Qos, Topic},
    },
};

use crate::{
    coarse,
    private_network::{discovery_range, inside},
    ros_program::{Client, Program, wait_until},
};

fn load(uri: &str) -> LoadWorldRequest {
    let world_resource = Resource { uri: uri.to_owned(), ..Default::default() };
    LoadWorldRequest { world_resource, ..Default::default() }
}

/// Verifies a recording. Returns the number of ticks, which are all equal.
fn verify(bag: &Path) -> u64 {
    let replay = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
        .arg("replay")
        .arg(bag)
        .args(["--verify", "--json"])
        .output()
        .unwrap();
    let output = String::from_utf8_lossy(&replay.stdout);
    assert!(replay.status.success(), "{output}{}", String::from_utf8_lossy(&replay.stderr));
    let report: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert_eq!(report["first_difference"], serde_json::Value::Null);
    report["ticks"].as_u64().unwrap()
}

/// Oracle: requests are served while the start state of a scene is settled; a late joiner receives
/// the mesh of the new scene; the recording with both scenes can be verified.
#[test]
fn a_scene_is_settled_while_requests_are_served() {
    inside("ros_worlds::a_scene_is_settled_while_requests_are_served", || {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        // A unique seed, so that the start state is in no cache.
        let seed = format!("seed: {}", std::process::id());
        let text = coarse::OTHER_TEXT.replace("seed: 2", &seed);
        std::fs::write(folder.path().join("other.yaml"), text).unwrap();
        let cache = folder.path().join("cache");
        let line = ["--bag", bag.to_str().unwrap(), "--cache", cache.to_str().unwrap()];
        let program = Program::start_with(folder.path(), &[], &line);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let mut set = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut get_state = Client::of::<srv::GetSimulationState>(&node, "get_simulation_state");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut world = Client::of::<srv::LoadWorld>(&node, "load_world");
        let mut steps = |n: u64| {
            let state = SimulationState { state: SimulationState::STATE_PAUSED };
            let _: SetSimulationStateResponse = set.call(&SetSimulationStateRequest { state });
            let response: StepSimulationResponse = step.call(&StepSimulationRequest { steps: n });
            assert_eq!(
                response.result.result,
                SimResult::RESULT_OK,
                "{}",
                response.result.error_message
            );
        };
        steps(20);

        world.send(&load("other.yaml"));
        let mut n_responses = 0;
        let response: LoadWorldResponse = loop {
            let it: GetSimulationStateResponse =
                get_state.call(&GetSimulationStateRequest::default());
            n_responses += u32::from(it.state.state == SimulationState::STATE_LOADING_WORLD);
            if it.state.state == SimulationState::STATE_STOPPED {
                break world.receive();
            }
        };
        assert_eq!(
            response.result.result,
            SimResult::RESULT_OK,
            "{}",
            response.result.error_message
        );
        assert_eq!(response.world.name, "other");
        // Settling takes a second or more, a response a few milliseconds.
        assert!(10 < n_responses, "{n_responses} requests were served in the meantime");

        let topic = Topic::input::<Mesh>("/jamgrip/membrane/mesh", Qos::latched());
        let mesh = node.subscription::<Mesh>(&topic).unwrap();
        let mut n_vertices = 0;
        wait_until("the mesh", || {
            n_vertices = mesh.take().ok().flatten().map_or(n_vertices, |it| it.0.vertices.len());
            // An icosphere of frequency f, cut at its equator, has 5 f² + 5 f/2 + 1 vertices.
            n_vertices == 5 * 36 + 15 + 1
        });
        steps(30);
        program.end();
        assert_eq!(verify(&bag), 50);
    });
}

/// Oracle: counting, and the requested pose. A spawned object is published like those of the scene,
/// and recorded on separate channels from then on.
#[test]
fn spawned_objects_have_topics() {
    inside("ros_worlds::spawned_objects_have_topics", || {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        let program = Program::start_with(
            folder.path(),
            &["outputs.state_rate=1 kHz"],
            &["--bag", bag.to_str().unwrap()],
        );
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let mut set = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut spawn = Client::of::<srv::SpawnEntity>(&node, "spawn_entity");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let _: SetSimulationStateResponse = set.call(&SetSimulationStateRequest { state });
        let text = "name: x\nobject: { shape: { sphere: { radius: 10 mm } } }".to_owned();
        let entity_resource = Resource { resource_string: text, ..Default::default() };
        let mut initial_pose = PoseStamped::default();
        initial_pose.pose.position.x = 0.5;
        initial_pose.pose.position.z = 0.3;
        initial_pose.pose.orientation.w = 1.0;
        let name = "spawned".to_owned();
        let request =
            SpawnEntityRequest { name, entity_resource, initial_pose, ..Default::default() };
        let response: SpawnEntityResponse = spawn.call(&request);
        assert_eq!(
            response.result.result,
            SimResult::RESULT_OK,
            "{}",
            response.result.error_message
        );
        let topic = Topic::input::<PoseStamped>("/jamgrip/object/spawned/pose", Qos::reliable(100));
        let poses = node.subscription::<PoseStamped>(&topic).unwrap();
        wait_until("its topics", || {
            let has_writer =
                |it: &str| node.n_writers(&format!("/jamgrip/object/spawned/{it}")) == 1;
            ["pose", "twist", "contact_wrench"].into_iter().all(has_writer)
        });
        let response: StepSimulationResponse = step.call(&StepSimulationRequest { steps: 40 });
        assert_eq!(
            response.result.result,
            SimResult::RESULT_OK,
            "{}",
            response.result.error_message
        );
        let mut last = PoseStamped::default();
        wait_until("its last pose", || {
            while let Some((it, _)) = poses.take().unwrap() {
                last = it;
            }
            last.header.stamp.nanosec == 40_000_000
        });
        // Free fall, as in `changes`: 8 mm in 40 ms.
        assert!((last.pose.position.z - (0.3 - 9.81 * 0.04 * 0.04 / 2.0)).abs() < 1e-4, "{last:?}");
        program.end();
        assert_eq!(verify(&bag), 40);
        let metadata = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
        // Forty ticks; nothing is due at time zero, when it was spawned.
        let row = metadata.split("- topic_metadata:").find(|it| it.contains("object/spawned/pose"));
        assert!(row.is_some_and(|it| it.contains("message_count: 40")), "{row:?}");
    });
}
