//! Another scene while the program runs, asked for from outside.

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
    private_network::{inside, reach},
    ros_program::{Client, Running, wait_until},
};

fn load(uri: &str) -> LoadWorldRequest {
    let world_resource = Resource { uri: uri.to_owned(), ..Default::default() };
    LoadWorldRequest { world_resource, ..Default::default() }
}

/// Verifies a recording: ticks that were simulated again, all of them equal.
fn verified(bag: &Path) -> u64 {
    let replay = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
        .arg("replay")
        .arg(bag)
        .args(["--verify", "--json"])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&replay.stdout);
    assert!(replay.status.success(), "{told}{}", String::from_utf8_lossy(&replay.stderr));
    let verdict: serde_json::Value = serde_json::from_str(&told).unwrap();
    assert_eq!(verdict["first_difference"], serde_json::Value::Null);
    verdict["ticks"].as_u64().unwrap()
}

/// Oracle: the contract. While a bag is filled questions are answered; who comes late gets the mesh of
/// the scene that is there now; the recording, with both scenes in it, can be simulated again.
#[test]
fn a_scene_is_filled_while_questions_are_answered() {
    inside("ros_worlds::a_scene_is_filled_while_questions_are_answered", || {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        // A seed of its own: this bag is in no cache.
        let seed = format!("seed: {}", std::process::id());
        let text = coarse::OTHER_TEXT.replace("seed: 2", &seed);
        std::fs::write(folder.path().join("other.yaml"), text).unwrap();
        let cache = folder.path().join("cache");
        let line = ["--bag", bag.to_str().unwrap(), "--cache", cache.to_str().unwrap()];
        let program = Running::start_with(folder.path(), &[], &line);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let mut set = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut look = Client::of::<srv::GetSimulationState>(&node, "get_simulation_state");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut world = Client::of::<srv::LoadWorld>(&node, "load_world");
        let mut steps = |n: u64| {
            let state = SimulationState { state: SimulationState::STATE_PAUSED };
            let _: SetSimulationStateResponse = set.ask(&SetSimulationStateRequest { state });
            let answer: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: n });
            assert_eq!(
                answer.result.result,
                SimResult::RESULT_OK,
                "{}",
                answer.result.error_message
            );
        };
        steps(20);

        world.say(&load("other.yaml"));
        let mut n_answers = 0;
        let answer: LoadWorldResponse = loop {
            let it: GetSimulationStateResponse = look.ask(&GetSimulationStateRequest::default());
            n_answers += u32::from(it.state.state == SimulationState::STATE_LOADING_WORLD);
            if it.state.state == SimulationState::STATE_STOPPED {
                break world.hear();
            }
        };
        assert_eq!(answer.result.result, SimResult::RESULT_OK, "{}", answer.result.error_message);
        assert_eq!(answer.world.name, "other");
        // The filling takes a second or more, an answer some milliseconds.
        assert!(10 < n_answers, "{n_answers} questions were answered meanwhile");

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
        assert_eq!(verified(&bag), 50);
    });
}

/// Oracle: counting, and the pose that was asked for. What came later is published like the scene's
/// own and recorded, each with a channel from then on.
#[test]
fn objects_that_come_later_have_topics() {
    inside("ros_worlds::objects_that_come_later_have_topics", || {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        let program = Running::start_with(
            folder.path(),
            &["outputs.state_rate=1 kHz"],
            &["--bag", bag.to_str().unwrap()],
        );
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let mut set = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut spawn = Client::of::<srv::SpawnEntity>(&node, "spawn_entity");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let _: SetSimulationStateResponse = set.ask(&SetSimulationStateRequest { state });
        let text = "name: x\nobject: { shape: { sphere: { radius: 10 mm } } }".to_owned();
        let entity_resource = Resource { resource_string: text, ..Default::default() };
        let mut initial_pose = PoseStamped::default();
        initial_pose.pose.position.x = 0.5;
        initial_pose.pose.position.z = 0.3;
        initial_pose.pose.orientation.w = 1.0;
        let name = "guest".to_owned();
        let request =
            SpawnEntityRequest { name, entity_resource, initial_pose, ..Default::default() };
        let answer: SpawnEntityResponse = spawn.ask(&request);
        assert_eq!(answer.result.result, SimResult::RESULT_OK, "{}", answer.result.error_message);
        let topic = Topic::input::<PoseStamped>("/jamgrip/object/guest/pose", Qos::reliable(100));
        let poses = node.subscription::<PoseStamped>(&topic).unwrap();
        wait_until("its topics", || {
            let is_there = |it: &str| node.n_writers(&format!("/jamgrip/object/guest/{it}")) == 1;
            ["pose", "twist", "contact_wrench"].into_iter().all(is_there)
        });
        let answer: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: 40 });
        assert_eq!(answer.result.result, SimResult::RESULT_OK, "{}", answer.result.error_message);
        let mut last = PoseStamped::default();
        wait_until("its last pose", || {
            while let Some((it, _)) = poses.take().unwrap() {
                last = it;
            }
            last.header.stamp.nanosec == 40_000_000
        });
        // Galileo, as in `changes`: it has fallen 8 mm in 40 ms.
        assert!((last.pose.position.z - (0.3 - 9.81 * 0.04 * 0.04 / 2.0)).abs() < 1e-4, "{last:?}");
        program.end();
        assert_eq!(verified(&bag), 40);
        let metadata = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
        // Forty ticks; at time zero, where it came, nothing is due.
        let row = metadata.split("- topic_metadata:").find(|it| it.contains("object/guest/pose"));
        assert!(row.is_some_and(|it| it.contains("message_count: 40")), "{row:?}");
    });
}
