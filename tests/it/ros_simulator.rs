//! The simulator services and actions, tested from outside the program.

use std::{path::Path, process::Command, time::Duration};

use jamgrip::{
    command::change::Change,
    cosim::change_error::ChangeError,
    io::server::{RequestId, ServiceRequest, ServiceSpec},
    ros::{
        node::RosNode,
        service::{RosClient, ServiceMapping},
    },
    simulator::{
        Simulator, World, WorldAccess,
        services::{self, endpoints},
    },
    snapshot::Snapshot,
    wire::{
        cdr::Cdr,
        messages::{
            RosService,
            geometry_msgs::WrenchStamped,
            rcl_interfaces::{
                DescribeParametersRequest, DescribeParametersResponse, GetParametersRequest,
                GetParametersResponse, ListParametersRequest, ListParametersResponse, Parameter,
                ParameterEvent, ParameterType, ParameterValue, SetParametersAtomicallyRequest,
                SetParametersAtomicallyResponse, SetParametersRequest, SetParametersResponse,
                srv as rcl,
            },
            simulation_interfaces::{
                EntityState, GetEntityStateRequest, GetEntityStateResponse, ResetSimulationRequest,
                ResetSimulationResponse, Result as SimResult, SetSimulationStateRequest,
                SetSimulationStateResponse, SimulationState, StepSimulationRequest,
                StepSimulationResponse, srv,
            },
        },
        topics::{Qos, Topic},
    },
};
use proptest::prelude::{ProptestConfig, any, prop, prop_assert, proptest};

use crate::{
    by_tick::{Synthetic, example},
    coarse, peers,
    private_network::{cyclone_config, discovery_range, inside, inside_with_peers},
    ros_program::{Client, Program, wait_until},
};

fn conformance(changes: &[&str], arguments: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let bag = bag.to_str().unwrap();
    // Another gripper and another object, in the same folder.
    std::fs::write(folder.path().join("other.yaml"), coarse::OTHER_TEXT).unwrap();
    let program = Program::start_with(folder.path(), changes, &["--bag", bag]);
    let output = Command::new(example("conformance"))
        .args(["--timeout", "60"])
        .args(arguments)
        .env("ROS_DOMAIN_ID", discovery_range().domain_id.to_string())
        .output()
        .unwrap();
    let output_text = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{output_text}{errors}");
    // A tool that skips everything would also pass.
    assert!(!output_text.contains("skip"), "everything is advertised:\n{output_text}");
    program.end();
    verify(bag);
}

/// Verifies the recording, including all changes of the world.
fn verify(bag: &str) {
    let replay = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(["replay", bag, "--verify", "--json"])
        .output()
        .unwrap();
    let output = String::from_utf8_lossy(&replay.stdout);
    assert!(replay.status.success(), "{output}{}", String::from_utf8_lossy(&replay.stderr));
    let report: serde_json::Value = serde_json::from_str(&output).unwrap();
    // Oracle: the digests of the run itself; the tool makes a few hundred steps.
    assert!(report["ticks"].as_u64().is_some_and(|it| 50 < it), "{report}");
    assert_eq!(report["remarks"], serde_json::json!([]));
    let recording = jamgrip::bag::recording::Recording::open(Path::new(bag)).unwrap();
    let history = recording.history_without_scene(1_000_000).unwrap();
    assert!(5 < history.changes.len(), "the tool resets, places, spawns and deletes");
    assert_eq!(history.broken_at, None);
}

/// Oracle: the standard, as tested by an independent tool.
#[test]
fn everything_advertised_passes_the_conformance_tool() {
    inside("ros_simulator::everything_advertised_passes_the_conformance_tool", || {
        conformance(&[], &[]);
    });
}

/// Oracle: the same, with Cyclone's service mapping and the older wire format.
#[test]
fn clients_with_the_other_mapping_and_version_are_served() {
    inside("ros_simulator::clients_with_the_other_mapping_and_version_are_served", || {
        let version = ["outputs.ros.interfaces_version=1"];
        conformance(&version, &["--way", "cyclone", "--version", "1"]);
    });
}

/// The state of the object after a reset and a hundred steps.
fn episode(reset: &mut Client, step: &mut Client, state: &mut Client) -> EntityState {
    let scope = ResetSimulationRequest::SCOPE_ALL;
    let response: ResetSimulationResponse = reset.call(&ResetSimulationRequest { scope });
    assert_eq!(response.result.result, SimResult::RESULT_OK, "{}", response.result.error_message);
    let response: StepSimulationResponse = step.call(&StepSimulationRequest { steps: 100 });
    assert_eq!(response.result.result, SimResult::RESULT_OK, "{}", response.result.error_message);
    let entity = "cylinder".to_owned();
    let response: GetEntityStateResponse = state.call(&GetEntityStateRequest { entity });
    response.state
}

/// Oracle: the same hundred ticks without the flood, bit for bit; the program responds throughout.
#[test]
fn garbage_and_floods_do_not_reach_the_physics() {
    inside("ros_simulator::garbage_and_floods_do_not_reach_the_physics", || {
        let folder = tempfile::tempdir().unwrap();
        let _node = Program::start(folder.path(), &[]);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let mut play = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let response: SetSimulationStateResponse = play.call(&SetSimulationStateRequest { state });
        assert_eq!(response.result.result, SimResult::RESULT_OK);
        let mut reset = Client::of::<srv::ResetSimulation>(&node, "reset_simulation");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut get_state = Client::of::<srv::GetEntityState>(&node, "get_entity_state");
        let quiet = episode(&mut reset, &mut step, &mut get_state);

        let (specs, _) = endpoints("/jamgrip", None);
        // A request to unload the world has no fields, so any bytes are a valid request.
        let mut floods: Vec<RosClient> = specs
            .iter()
            .filter(|spec| !spec.name.ends_with("/unload_world"))
            .map(|spec| RosClient::open(&node, spec, ServiceMapping::Enhanced).unwrap())
            .collect();
        for flood in &mut floods {
            wait_until("a server", || flood.is_matched());
        }
        let (stop, stopped) = std::sync::mpsc::channel::<()>();
        let flooder = std::thread::spawn(move || {
            let mut n = 0_u32;
            while stopped.try_recv().is_err() {
                for flood in &mut floods {
                    // Too short for any request with fields, too long to be a count.
                    let bytes = (0..n % 3).map(|it| it.to_le_bytes()[0] | 0xf0).collect();
                    flood.send(&Cdr { bytes, is_big_endian: n.is_multiple_of(2) });
                    n += 1;
                }
                std::thread::sleep(Duration::from_millis(1));
            }
            n
        });
        let loud = episode(&mut reset, &mut step, &mut get_state);
        stop.send(()).unwrap();
        let n_received = flooder.join().unwrap();
        assert!(100 < n_received, "{n_received} requests are not a flood");
        assert_eq!(quiet, loud, "the state changed under {n_received} malformed requests");
    });
}

/// A world that never changes.
struct Dummy(Synthetic);

impl WorldAccess for Dummy {
    fn full_snapshot(&self) -> Snapshot {
        self.0.snapshot.clone()
    }

    fn change(&mut self, _change: &Change) -> Result<(), ChangeError> {
        Ok(())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Oracle: any bytes lead to a response or an error, and never to a panic.
    #[test]
    fn malformed_requests_are_harmless(
        spec in 0_usize..64,
        bytes in prop::collection::vec(any::<u8>(), 0..300),
        is_big_endian in any::<bool>(),
    ) {
        let (specs, endpoints) = endpoints("/jamgrip", None);
        let n_topics = services::action_topics("/jamgrip", None).len();
        let scene = crate::by_tick::scene();
        let mut simulator = Simulator::new(&std::sync::Arc::new(scene), endpoints, false)
            .with_n_topics(n_topics);
        let system = Synthetic::new("cylinder");
        let result = system.snapshot.clone();
        let mut world = World { access: &mut Dummy(system), snapshot: &result };
        let id = RequestId { service: spec % specs.len(), writer: [0; 16], number: 1, header: None };
        let request = ServiceRequest { id, body: Cdr { bytes, is_big_endian } };
        if let Err(reason) = simulator.handle_request(&request, &mut world) {
            prop_assert!(reason.contains(": "), "the error names the service: {}", reason);
        }
    }
}

/// Oracle: counting, by a client on another DDS implementation that only uses the ROS 2 names and
/// types, and uses Cyclone's service mapping.
#[test]
fn an_independent_dds_calls_services_and_an_action() {
    inside_with_peers("ros_simulator::an_independent_dds_calls_services_and_an_action", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Program::start(folder.path(), &[]);
        let output = peers::script("call_services.py")
            .env("ROS_DOMAIN_ID", discovery_range().domain_id.to_string())
            .env("CYCLONEDDS_URI", format!("file://{}", cyclone_config(folder.path()).display()))
            .output()
            .unwrap();
        let output_text = String::from_utf8_lossy(&output.stdout);
        assert!(
            output.status.success(),
            "{output_text}{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let result: serde_json::Value = serde_json::from_str(&output_text).unwrap();
        // The readers and writers of topics, /rosout, /parameter_events, ros_discovery_info and
        // services.
        let topics = jamgrip::wire::topics::topics(&coarse::scene(&[]));
        let n_inputs = topics.iter().filter(|it| it.is_input).count();
        let n_offers = endpoints("/jamgrip", None).0.len();
        let n_topics = services::action_topics("/jamgrip", None).len();
        let n_outputs = topics.len() - n_inputs + 3;
        let listed = [n_inputs + n_offers, n_outputs + n_offers + n_topics];
        let expected = serde_json::json!({
            "listed": listed,
            "paused": 1, "stepped": 1, "accepted": true, "status": 4, "ended": 1,
            "gripped": true, "types": [3, 0, 2], "n_ticks": 12, "feedback": [[1, 4], [5, 0]],
        });
        assert_eq!(result, expected);
    });
}

fn double(name: &str, double_value: f64) -> Parameter {
    let r#type = ParameterType::PARAMETER_DOUBLE;
    let value = ParameterValue { r#type, double_value, ..Default::default() };
    Parameter { name: name.to_owned(), value }
}

/// Oracle: the parameter services as ROS 2 defines them; names and values of the scene.
#[test]
fn parameters_are_listed_described_read_and_set() {
    inside("ros_simulator::parameters_are_listed_described_read_and_set", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Program::start(folder.path(), &[]);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let mut list = Client::of::<rcl::ListParameters>(&node, "list_parameters");
        let prefixes = vec!["chamber".to_owned()];
        let found: ListParametersResponse =
            list.call(&ListParametersRequest { prefixes, depth: 0 });
        assert_eq!(found.result.names, ["chamber.lag", "chamber.rate_max"]);
        let names = ["chamber.lag", "seed", "no.such"].map(str::to_owned).to_vec();
        let mut describe = Client::of::<rcl::DescribeParameters>(&node, "describe_parameters");
        let described: DescribeParametersResponse =
            describe.call(&DescribeParametersRequest { names: names.clone() });
        assert!(
            described.descriptors[0].description.contains("[s]")
                && !described.descriptors[0].read_only
        );
        assert_eq!(described.descriptors[0].floating_point_range.len(), 1);
        assert!(described.descriptors[1].read_only);

        let topic = Topic::input::<ParameterEvent>("/parameter_events", Qos::reliable(100));
        let events = node.subscription::<ParameterEvent>(&topic).unwrap();
        // The node's own writer of this topic, which it never uses, and that of the simulator.
        wait_until("writers", || node.n_writers("/parameter_events") == 2);
        let mut set = Client::of::<rcl::SetParameters>(&node, "set_parameters");
        let parameters = vec![
            double("chamber.lag", 0.5),
            double("grains.friction", -1.0),
            double("grains.friction", f64::NAN),
            double("seed", 1.0),
            double("no.such", 1.0),
        ];
        let response: SetParametersResponse = set.call(&SetParametersRequest { parameters });
        let accepted: Vec<bool> = response.results.iter().map(|it| it.successful).collect();
        assert_eq!(accepted, [true, false, false, false, false], "{:?}", response.results);
        let mut event = None;
        wait_until("an event", || {
            event = events.take().unwrap().map(|it| it.0);
            event.is_some()
        });
        let event = event.unwrap();
        assert_eq!(event.node, "/jamgrip");
        assert_eq!(event.changed_parameters, [double("chamber.lag", 0.5)], "only accepted changes");
        let mut atomically =
            Client::of::<rcl::SetParametersAtomically>(&node, "set_parameters_atomically");
        let parameters = vec![double("chamber.lag", 0.7), double("seed", 1.0)];
        let response: SetParametersAtomicallyResponse =
            atomically.call(&SetParametersAtomicallyRequest { parameters });
        assert!(!response.result.successful, "all or nothing");
        let mut get = Client::of::<rcl::GetParameters>(&node, "get_parameters");
        let values: GetParametersResponse = get.call(&GetParametersRequest { names });
        assert!((values.values[0].double_value - 0.5).abs() < 1e-12, "{:?}", values.values[0]);
        assert_eq!((values.values[1].integer_value, values.values[2].r#type), (1, 0));
        assert_eq!(events.take().unwrap(), None, "rejected changes are not published");
    });
}

/// Oracle: counting: the rate in simulation time, before and after the change.
#[test]
fn rates_of_topics_are_parameters() {
    inside("ros_simulator::rates_of_topics_are_parameters", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Program::start(folder.path(), &["outputs.state_rate=1 kHz"]);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let topic = Topic::input::<WrenchStamped>("/jamgrip/wrench", Qos::reliable(1000));
        let wrench = node.subscription::<WrenchStamped>(&topic).unwrap();
        let mut play = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut set = Client::of::<rcl::SetParameters>(&node, "set_parameters");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let _: SetSimulationStateResponse = play.call(&SetSimulationStateRequest { state });
        wait_until("a writer", || node.n_writers("/jamgrip/wrench") == 1);
        let mut last = 0;
        // Time stamps (ms) of the wrenches of the next 100 ticks.
        let mut stamps = || {
            let response: StepSimulationResponse = step.call(&StepSimulationRequest { steps: 100 });
            assert_eq!(response.result.result, SimResult::RESULT_OK);
            last += 100;
            let mut found = Vec::new();
            wait_until("the last wrench", || {
                while let Some((it, _)) = wrench.take().unwrap() {
                    found.push(it.header.stamp.nanosec / 1_000_000);
                }
                found.last() == Some(&last)
            });
            found
        };
        let all = stamps();
        assert!((1..=100).all(|it| all.contains(&it)), "every tick: {all:?}");
        let parameters = vec![
            double("outputs.state_rate", 50.0),
            double("outputs.grains_rate", 0.0),
            double("outputs.membrane_rate", 1001.0),
        ];
        let response: SetParametersResponse = set.call(&SetParametersRequest { parameters });
        let accepted: Vec<bool> = response.results.iter().map(|it| it.successful).collect();
        assert_eq!(accepted, [true, false, false], "{:?}", response.results);
        assert_eq!(stamps(), [120, 140, 160, 180, 200], "50 Hz");
    });
}

/// Oracle: the rules of ROS 2 for names on the command line, checked from outside.
#[test]
fn names_on_the_command_line_appear_in_the_graph() {
    inside("ros_simulator::names_on_the_command_line_appear_in_the_graph", || {
        let folder = tempfile::tempdir().unwrap();
        let line = ["--ros-args", "-r", "__ns:=/left", "-r", "__node:=grip", "-r", "~/wrench:=/ft"];
        let more = ["-r", "~/get_entities:=~/renamed", "-p", "outputs.ros.interfaces_prefix:=/sim"];
        let bag = folder.path().join("bag");
        let recorded = ["--bag", bag.to_str().unwrap()];
        let line = [&recorded[..], &line[..], &more[..]].concat();
        let program = Program::start_with(folder.path(), &[], &line);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        wait_until("the names", || {
            ["/ft", "/left/grip/pressure", "/clock"].iter().all(|it| node.n_writers(it) == 1)
        });
        assert_eq!(node.n_writers("/left/grip/wrench") + node.n_writers("/jamgrip/pressure"), 0);
        for name in ["/left/grip/renamed", "/left/grip/step_simulation", "/sim/step_simulation"] {
            let service_type = srv::StepSimulation::TYPE;
            let spec = ServiceSpec { name: name.to_owned(), service_type };
            let mut client = RosClient::open(&node, &spec, ServiceMapping::Enhanced).unwrap();
            wait_until(name, || client.is_matched());
        }
        let set = srv::SetSimulationState::TYPE;
        let mut set = Client::at(&node, "/left/grip/set_simulation_state", set);
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let _: SetSimulationStateResponse = set.call(&SetSimulationStateRequest { state });
        let mut step = Client::at(&node, "/sim/step_simulation", srv::StepSimulation::TYPE);
        let _: StepSimulationResponse = step.call(&StepSimulationRequest { steps: 3 });
        program.end();
        // The recording's own topics are also in the namespace of the node.
        let recording = jamgrip::bag::recording::Recording::open(&bag).unwrap();
        let history = recording.history_without_scene(1_000_000).unwrap();
        assert_eq!((history.last_tick(), history.broken_at), (3, None));
        let metadata = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
        assert!(metadata.contains("/left/grip/world_change") && !metadata.contains("/jamgrip/"));
    });
}
