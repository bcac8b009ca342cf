//! What ROS 2 users ask of a simulator, asked of the whole program from outside.

use std::{path::Path, process::Command, time::Duration};

use jamgrip::{
    command::change::Change,
    cosim::refused::ChangeError,
    io::server::{RequestId, ServiceRequest, ServiceSpec},
    ros::{
        node::RosNode,
        service::{RosClient, Way},
    },
    simulator::{
        Simulator, Subject, World,
        services::{self, asked},
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
    private_network::{cyclone_config, inside, inside_with_peers, reach},
    ros_program::{Client, Running, wait_until},
};

fn conformance(changes: &[&str], arguments: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let bag = bag.to_str().unwrap();
    // Another bag, another object, in the same folder.
    std::fs::write(folder.path().join("other.yaml"), coarse::OTHER_TEXT).unwrap();
    let node = Running::start_with(folder.path(), changes, &["--bag", bag]);
    let output = Command::new(example("conformance"))
        .args(["--patience", "60"])
        .args(arguments)
        .env("ROS_DOMAIN_ID", reach().domain_id.to_string())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let complained = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}{complained}");
    // A tool that skips everything would pass too.
    assert!(!said.contains("skip"), "everything is advertised:\n{said}");
    node.end();
    is_verified(bag);
}

/// Whatever was done to the world from outside, the recording can be simulated again.
fn is_verified(bag: &str) {
    let replay = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
        .args(["replay", bag, "--verify", "--json"])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&replay.stdout);
    assert!(replay.status.success(), "{told}{}", String::from_utf8_lossy(&replay.stderr));
    let verdict: serde_json::Value = serde_json::from_str(&told).unwrap();
    // Oracle: the digests of the run itself; the tool makes some hundred steps.
    assert!(verdict["ticks"].as_u64().is_some_and(|it| 50 < it), "{verdict}");
    assert_eq!(verdict["remarks"], serde_json::json!([]));
    let recording = jamgrip::bag::recording::Recording::open(Path::new(bag)).unwrap();
    let course = recording.course_of_all(1_000_000).unwrap();
    assert!(5 < course.changes.len(), "the tool resets, places, spawns and deletes");
    assert_eq!(course.broken_at, None);
}

/// Oracle: the standard, as a tool that knows nothing else tries it from outside.
#[test]
fn everything_advertised_passes_the_conformance_tool() {
    inside("ros_simulator::everything_advertised_passes_the_conformance_tool", || {
        conformance(&[], &[]);
    });
}

/// Oracle: the same, asked the way that rmw_cyclonedds asks, in the older wire format.
#[test]
fn clients_of_the_other_way_and_version_are_served_too() {
    inside("ros_simulator::clients_of_the_other_way_and_version_are_served_too", || {
        let version = ["outputs.ros.interfaces_version=1"];
        conformance(&version, &["--way", "cyclone", "--version", "1"]);
    });
}

/// The object's state after a reset and a hundred steps.
fn episode(reset: &mut Client, step: &mut Client, state: &mut Client) -> EntityState {
    let scope = ResetSimulationRequest::SCOPE_ALL;
    let answer: ResetSimulationResponse = reset.ask(&ResetSimulationRequest { scope });
    assert_eq!(answer.result.result, SimResult::RESULT_OK, "{}", answer.result.error_message);
    let answer: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: 100 });
    assert_eq!(answer.result.result, SimResult::RESULT_OK, "{}", answer.result.error_message);
    let entity = "cylinder".to_owned();
    let answer: GetEntityStateResponse = state.ask(&GetEntityStateRequest { entity });
    answer.state
}

/// Oracle: the same hundred ticks without the flood, bit by bit; the program answers all the while.
#[test]
fn garbage_and_floods_do_not_reach_the_physics() {
    inside("ros_simulator::garbage_and_floods_do_not_reach_the_physics", || {
        let folder = tempfile::tempdir().unwrap();
        let _node = Running::start(folder.path(), &[]);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let mut play = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let answer: SetSimulationStateResponse = play.ask(&SetSimulationStateRequest { state });
        assert_eq!(answer.result.result, SimResult::RESULT_OK);
        let mut reset = Client::of::<srv::ResetSimulation>(&node, "reset_simulation");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut look = Client::of::<srv::GetEntityState>(&node, "get_entity_state");
        let quiet = episode(&mut reset, &mut step, &mut look);

        let (offers, _) = asked("/jamgrip", None);
        // A request to unload the world has no field: whatever its bytes, it is one.
        let mut floods: Vec<RosClient> = offers
            .iter()
            .filter(|offer| !offer.name.ends_with("/unload_world"))
            .map(|offer| RosClient::open(&node, offer, Way::Enhanced).unwrap())
            .collect();
        for flood in &mut floods {
            wait_until("a server", || flood.is_matched());
        }
        let (stop, stopped) = std::sync::mpsc::channel::<()>();
        let flooder = std::thread::spawn(move || {
            let mut n = 0_u32;
            while stopped.try_recv().is_err() {
                for flood in &mut floods {
                    // Too short for anything that has a field, too long to be a count.
                    let bytes = (0..n % 3).map(|it| it.to_le_bytes()[0] | 0xf0).collect();
                    flood.ask(&Cdr { bytes, is_big_endian: n.is_multiple_of(2) });
                    n += 1;
                }
                std::thread::sleep(Duration::from_millis(1));
            }
            n
        });
        let loud = episode(&mut reset, &mut step, &mut look);
        stop.send(()).unwrap();
        let n_received = flooder.join().unwrap();
        assert!(100 < n_received, "{n_received} requests are no flood");
        assert_eq!(quiet, loud, "the same bits in spite of {n_received} senseless requests");
    });
}

/// A world that does nothing.
struct Dummy(Synthetic);

impl Subject for Dummy {
    fn look(&self) -> Snapshot {
        self.0.snapshot.clone()
    }

    fn change(&mut self, _change: &Change) -> Result<(), ChangeError> {
        Ok(())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Oracle: the contract. Whatever the bytes, there is an answer or a reason, and no panic.
    #[test]
    fn no_question_does_harm(
        offer in 0_usize..64,
        bytes in prop::collection::vec(any::<u8>(), 0..300),
        is_big_endian in any::<bool>(),
    ) {
        let (offers, what) = asked("/jamgrip", None);
        let n_channels = services::channels("/jamgrip", None).len();
        let scene = crate::by_tick::scene();
        let mut simulator = Simulator::new(&std::sync::Arc::new(scene), what, false).with_channels(n_channels);
        let system = Synthetic::new("cylinder");
        let seen = system.snapshot.clone();
        let mut world = World { subject: &mut Dummy(system), seen: &seen };
        let asker = RequestId { offer: offer % offers.len(), writer: [0; 16], number: 1, header: None };
        let call = ServiceRequest { asker, body: Cdr { bytes, is_big_endian } };
        if let Err(reason) = simulator.handle_requests(&call, &mut world) {
            prop_assert!(reason.contains(": "), "names the service: {}", reason);
        }
    }
}

/// Oracle: counting, by a client on another implementation of DDS that was told only ROS 2's names
/// and types and goes the way of rmw_cyclonedds.
#[test]
fn an_independent_dds_calls_services_and_an_action() {
    inside_with_peers("ros_simulator::an_independent_dds_calls_services_and_an_action", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Running::start(folder.path(), &[]);
        let output = peers::script("call_services.py")
            .env("ROS_DOMAIN_ID", reach().domain_id.to_string())
            .env("CYCLONEDDS_URI", format!("file://{}", cyclone_config(folder.path()).display()))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
        let seen: serde_json::Value = serde_json::from_str(&said).unwrap();
        // The ports of topics, /rosout, /parameter_events and ros_discovery_info, and of services.
        let topics = jamgrip::wire::topics::topics(&coarse::scene(&[]));
        let n_inputs = topics.iter().filter(|it| it.is_input).count();
        let n_offers = asked("/jamgrip", None).0.len();
        let n_channels = services::channels("/jamgrip", None).len();
        let n_outputs = topics.len() - n_inputs + 3;
        let listed = [n_inputs + n_offers, n_outputs + n_offers + n_channels];
        let expected = serde_json::json!({
            "listed": listed,
            "paused": 1, "stepped": 1, "accepted": true, "status": 4, "ended": 1,
            "gripped": true, "types": [3, 0, 2], "n_ticks": 12, "feedback": [[1, 4], [5, 0]],
        });
        assert_eq!(seen, expected);
    });
}

fn double(name: &str, double_value: f64) -> Parameter {
    let r#type = ParameterType::PARAMETER_DOUBLE;
    let value = ParameterValue { r#type, double_value, ..Default::default() };
    Parameter { name: name.to_owned(), value }
}

/// Oracle: the meaning that ROS 2 gives to the parameter services; names and values of the scene.
#[test]
fn parameters_are_listed_described_read_and_set() {
    inside("ros_simulator::parameters_are_listed_described_read_and_set", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Running::start(folder.path(), &[]);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let mut list = Client::of::<rcl::ListParameters>(&node, "list_parameters");
        let prefixes = vec!["chamber".to_owned()];
        let found: ListParametersResponse = list.ask(&ListParametersRequest { prefixes, depth: 0 });
        assert_eq!(found.result.names, ["chamber.lag", "chamber.rate_max"]);
        let names = ["chamber.lag", "seed", "no.such"].map(str::to_owned).to_vec();
        let mut describe = Client::of::<rcl::DescribeParameters>(&node, "describe_parameters");
        let told: DescribeParametersResponse =
            describe.ask(&DescribeParametersRequest { names: names.clone() });
        assert!(told.descriptors[0].description.contains("[s]") && !told.descriptors[0].read_only);
        assert_eq!(told.descriptors[0].floating_point_range.len(), 1);
        assert!(told.descriptors[1].read_only);

        let topic = Topic::input::<ParameterEvent>("/parameter_events", Qos::reliable(100));
        let events = node.subscription::<ParameterEvent>(&topic).unwrap();
        // The node's own writer there, which it never uses, and ours.
        wait_until("writers", || node.n_writers("/parameter_events") == 2);
        let mut set = Client::of::<rcl::SetParameters>(&node, "set_parameters");
        let parameters = vec![
            double("chamber.lag", 0.5),
            double("grains.friction", -1.0),
            double("grains.friction", f64::NAN),
            double("seed", 1.0),
            double("no.such", 1.0),
        ];
        let answer: SetParametersResponse = set.ask(&SetParametersRequest { parameters });
        let taken: Vec<bool> = answer.results.iter().map(|it| it.successful).collect();
        assert_eq!(taken, [true, false, false, false, false], "{:?}", answer.results);
        let mut event = None;
        wait_until("an event", || {
            event = events.take().unwrap().map(|it| it.0);
            event.is_some()
        });
        let event = event.unwrap();
        assert_eq!(event.node, "/jamgrip");
        assert_eq!(
            event.changed_parameters,
            [double("chamber.lag", 0.5)],
            "what was taken, no more"
        );
        let mut atomically =
            Client::of::<rcl::SetParametersAtomically>(&node, "set_parameters_atomically");
        let parameters = vec![double("chamber.lag", 0.7), double("seed", 1.0)];
        let answer: SetParametersAtomicallyResponse =
            atomically.ask(&SetParametersAtomicallyRequest { parameters });
        assert!(!answer.result.successful, "all or nothing");
        let mut get = Client::of::<rcl::GetParameters>(&node, "get_parameters");
        let values: GetParametersResponse = get.ask(&GetParametersRequest { names });
        assert!((values.values[0].double_value - 0.5).abs() < 1e-12, "{:?}", values.values[0]);
        assert_eq!((values.values[1].integer_value, values.values[2].r#type), (1, 0));
        assert_eq!(events.take().unwrap(), None, "all or nothing is told");
    });
}

/// Oracle: counting. A rate in simulated time, before and after it was changed.
#[test]
fn rates_of_topics_are_parameters() {
    inside("ros_simulator::rates_of_topics_are_parameters", || {
        let folder = tempfile::tempdir().unwrap();
        let _program = Running::start(folder.path(), &["outputs.state_rate=1 kHz"]);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let topic = Topic::input::<WrenchStamped>("/jamgrip/wrench", Qos::reliable(1000));
        let wrench = node.subscription::<WrenchStamped>(&topic).unwrap();
        let mut play = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut set = Client::of::<rcl::SetParameters>(&node, "set_parameters");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let _: SetSimulationStateResponse = play.ask(&SetSimulationStateRequest { state });
        wait_until("a writer", || node.n_writers("/jamgrip/wrench") == 1);
        let mut last = 0;
        // Stamps after `from_ns` of the wrenches in the next 100 ticks [ms].
        let mut stamps = || {
            let answer: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: 100 });
            assert_eq!(answer.result.result, SimResult::RESULT_OK);
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
        let answer: SetParametersResponse = set.ask(&SetParametersRequest { parameters });
        let taken: Vec<bool> = answer.results.iter().map(|it| it.successful).collect();
        assert_eq!(taken, [true, false, false], "{:?}", answer.results);
        assert_eq!(stamps(), [120, 140, 160, 180, 200], "50 Hz");
    });
}

/// Oracle: ROS 2's rules for names on the command line, seen from outside.
#[test]
fn names_on_the_command_line_are_those_in_the_graph() {
    inside("ros_simulator::names_on_the_command_line_are_those_in_the_graph", || {
        let folder = tempfile::tempdir().unwrap();
        let line = ["--ros-args", "-r", "__ns:=/left", "-r", "__node:=grip", "-r", "~/wrench:=/ft"];
        let more = ["-r", "~/get_entities:=~/things", "-p", "outputs.ros.interfaces_prefix:=/sim"];
        let bag = folder.path().join("bag");
        let recorded = ["--bag", bag.to_str().unwrap()];
        let line = [&recorded[..], &line[..], &more[..]].concat();
        let program = Running::start_with(folder.path(), &[], &line);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        wait_until("the names", || {
            ["/ft", "/left/grip/pressure", "/clock"].iter().all(|it| node.n_writers(it) == 1)
        });
        assert_eq!(node.n_writers("/left/grip/wrench") + node.n_writers("/jamgrip/pressure"), 0);
        for name in ["/left/grip/things", "/left/grip/step_simulation", "/sim/step_simulation"] {
            let service_type = srv::StepSimulation::TYPE;
            let offer = ServiceSpec { name: name.to_owned(), service_type };
            let mut client = RosClient::open(&node, &offer, Way::Enhanced).unwrap();
            wait_until(name, || client.is_matched());
        }
        let set = srv::SetSimulationState::TYPE;
        let mut set = Client::at(&node, "/left/grip/set_simulation_state", set);
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let _: SetSimulationStateResponse = set.ask(&SetSimulationStateRequest { state });
        let mut step = Client::at(&node, "/sim/step_simulation", srv::StepSimulation::TYPE);
        let _: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: 3 });
        program.end();
        // The recording's own topics are below the node as well, and are found there.
        let recording = jamgrip::bag::recording::Recording::open(&bag).unwrap();
        let course = recording.course_of_all(1_000_000).unwrap();
        assert_eq!((course.last_tick(), course.broken_at), (3, None));
        let metadata = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
        assert!(metadata.contains("/left/grip/world_change") && !metadata.contains("/jamgrip/"));
    });
}
