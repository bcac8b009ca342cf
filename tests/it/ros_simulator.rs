//! What ROS 2 users ask of a simulator, asked of the whole program from outside.

use std::{
    path::Path,
    process::{Child, Command, Stdio},
    sync::Arc,
    time::Duration,
};

use jamgrip::{
    command::change::{Change, ChangeRefused},
    services::{
        Asker, Call, Offer,
        ros::{RosClient, Way},
    },
    simulator::{Simulator, Subject, World, asks, asks::asked},
    sinks::ros::RosNode,
    snapshot::Snapshot,
    wire::{
        cdr::Cdr,
        messages::{
            RosService,
            simulation_interfaces::{
                EntityState, GetEntityStateRequest, GetEntityStateResponse, ResetSimulationRequest,
                ResetSimulationResponse, Result as Told, SetSimulationStateRequest,
                SetSimulationStateResponse, SimulationState, StepSimulationRequest,
                StepSimulationResponse, srv,
            },
        },
    },
};
use proptest::prelude::{ProptestConfig, any, prop, prop_assert, proptest};

use crate::{
    by_tick::{Synthetic, example},
    coarse,
    private_network::{inside, reach},
};

/// The program with the coarse gripper, which waits for someone to begin.
struct Running(Child);

impl Running {
    fn start(folder: &Path) -> Self {
        let scene = folder.join("coarse.yaml");
        std::fs::write(&scene, coarse::TEXT).unwrap();
        let child = Command::new(env!("CARGO_BIN_EXE_jamgrip"))
            .arg("run")
            .arg(&scene)
            .args(["--set", "controller=topics", "--no-bag", "--no-stream", "--threads", "1"])
            .args(["--cache", concat!(env!("CARGO_TARGET_TMPDIR"), "/starts")])
            .env("ROS_DOMAIN_ID", reach().domain_id.to_string())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        Self(child)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may be gone already.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn conformance(arguments: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let _node = Running::start(folder.path());
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
}

/// Oracle: the standard, as a tool that knows nothing else tries it from outside.
#[test]
fn everything_advertised_passes_the_conformance_tool() {
    inside("ros_simulator::everything_advertised_passes_the_conformance_tool", || {
        conformance(&[]);
    });
}

/// Oracle: the same, asked the way that rmw_cyclonedds asks, in the older wire format.
#[test]
fn clients_of_the_other_way_and_version_are_served_too() {
    inside("ros_simulator::clients_of_the_other_way_and_version_are_served_too", || {
        conformance(&["--way", "cyclone", "--version", "1"]);
    });
}

/// A client of one service of the program.
struct Client {
    client: RosClient,
    node: Arc<RosNode>,
}

impl Client {
    fn of<S: RosService>(node: &Arc<RosNode>, name: &str) -> Self {
        let offer = Offer { name: format!("/jamgrip/{name}"), service_type: S::TYPE };
        let client = RosClient::open(node, &offer, Way::Enhanced).unwrap();
        let mut this = Self { client, node: Arc::clone(node) };
        wait_until(name, || this.client.is_matched());
        this
    }

    fn ask<Q: serde::Serialize, A: serde::de::DeserializeOwned>(&mut self, question: &Q) -> A {
        self.client.ask(&Cdr::of(question));
        let mut answer = None;
        wait_until("an answer", || {
            answer = self.client.answer();
            answer.is_some()
        });
        answer.unwrap().read().unwrap()
    }
}

fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    for _ in 0..60_000 {
        if is_so() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("waited a minute for {what}");
}

/// The object's state after a reset and a hundred steps.
fn episode(reset: &mut Client, step: &mut Client, state: &mut Client) -> EntityState {
    let scope = ResetSimulationRequest::SCOPE_ALL;
    let answer: ResetSimulationResponse = reset.ask(&ResetSimulationRequest { scope });
    assert_eq!(answer.result.result, Told::RESULT_OK, "{}", answer.result.error_message);
    let answer: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: 100 });
    assert_eq!(answer.result.result, Told::RESULT_OK, "{}", answer.result.error_message);
    let entity = "cylinder".to_owned();
    let answer: GetEntityStateResponse = state.ask(&GetEntityStateRequest { entity });
    answer.state
}

/// Oracle: the same hundred ticks without the flood, bit by bit; the program answers all the while.
#[test]
fn garbage_and_floods_do_not_reach_the_physics() {
    inside("ros_simulator::garbage_and_floods_do_not_reach_the_physics", || {
        let folder = tempfile::tempdir().unwrap();
        let _node = Running::start(folder.path());
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let mut play = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let answer: SetSimulationStateResponse = play.ask(&SetSimulationStateRequest { state });
        assert_eq!(answer.result.result, Told::RESULT_OK);
        let mut reset = Client::of::<srv::ResetSimulation>(&node, "reset_simulation");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let mut look = Client::of::<srv::GetEntityState>(&node, "get_entity_state");
        let quiet = episode(&mut reset, &mut step, &mut look);

        let (offers, _) = asked("/jamgrip", None);
        let mut floods: Vec<RosClient> = offers
            .iter()
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
                    flood.ask(&Cdr { bytes, is_big_endian: n % 2 == 0 });
                    n += 1;
                }
                std::thread::sleep(Duration::from_millis(1));
            }
            n
        });
        let loud = episode(&mut reset, &mut step, &mut look);
        stop.send(()).unwrap();
        let n_asked = flooder.join().unwrap();
        assert!(100 < n_asked, "{n_asked} requests are no flood");
        assert_eq!(quiet, loud, "the same bits in spite of {n_asked} senseless requests");
        assert!(Arc::strong_count(&play.node) > 1);
    });
}

/// A world that does nothing.
struct Dummy(Synthetic);

impl Subject for Dummy {
    fn look(&self) -> Snapshot {
        self.0.snapshot.clone()
    }

    fn change(&mut self, _change: &Change) -> Result<(), ChangeRefused> {
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
        let n_channels = asks::channels("/jamgrip", None).len();
        let scene = crate::by_tick::scene();
        let mut simulator = Simulator::new(&scene, what, false).with_channels(n_channels);
        let system = Synthetic::new("cylinder");
        let seen = system.snapshot.clone();
        let mut world = World { subject: &mut Dummy(system), seen: &seen };
        let asker = Asker { offer: offer % offers.len(), writer: [0; 16], number: 1, header: None };
        let call = Call { asker, body: Cdr { bytes, is_big_endian } };
        if let Err(reason) = simulator.attend(&call, &mut world) {
            prop_assert!(reason.contains(": "), "names the service: {}", reason);
        }
    }
}
