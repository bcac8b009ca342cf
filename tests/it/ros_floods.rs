//! A flood of commands: ten thousand per second if the machine can send as many.

use std::{
    io::Write,
    sync::{
        Arc,
        atomic::{AtomicU32, Ordering},
        mpsc,
    },
    time::{Duration, Instant},
};

use jamgrip::{
    bag::recording::Recording,
    ros::node::{Body, RosNode},
    wire::{
        messages::{
            RosMessage,
            geometry_msgs::PoseStamped,
            jamgrip_msgs::ObjectCommand,
            simulation_interfaces::{
                ResetSimulationRequest, ResetSimulationResponse, Result as SimResult,
                SetSimulationStateRequest, SetSimulationStateResponse, SimulationState,
                StepSimulationRequest, StepSimulationResponse, srv,
            },
            std_msgs::Float64,
        },
        topics::{CommonTopic, common, topics},
    },
};

use crate::{
    coarse,
    private_network::{discovery_range, inside},
    ros_program::{Client, Program, wait_until},
};

/// Requested rate of commands (Hz).
const RATE: f64 = 10_000.0;
/// Ticks of an episode.
const TICKS: u64 = 500;
/// Number of commands to send during the episodes under the flood, however long that takes.
const COMMANDS_MIN: u32 = 10_000;

#[expect(clippy::disallowed_methods, reason = "the test measures the rate of commands")]
fn now() -> Instant {
    Instant::now()
}

/// Sends invalid commands on three topics in turn, at `RATE` until `stopped`, and counts them in
/// `n_sent`. Returns the time that this took (s).
fn flood(node: &RosNode, stopped: &mpsc::Receiver<()>, n_sent: &AtomicU32) -> f64 {
    let all = topics(&coarse::scene(&[]));
    let mut pose = PoseStamped::default();
    pose.pose.position.x = f64::NAN;
    let unknown = ObjectCommand { object: "unknown".to_owned(), ..Default::default() };
    let commands = [
        (CommonTopic::VacuumCommand, Float64 { data: f64::NAN }.to_cdr()),
        (CommonTopic::FlangePoseCommand, pose.to_cdr()),
        (CommonTopic::ObjectCommand, unknown.to_cdr()),
    ];
    let publishers = commands.map(|(topic, cdr)| {
        let topic = &all[common(topic)];
        let publisher = node.publisher(topic).unwrap();
        wait_until("a reader", || 0 < node.n_readers(&topic.name));
        (publisher, cdr)
    });
    let (start, mut n) = (now(), 0_u32);
    while stopped.try_recv().is_err() {
        let due = RATE * start.elapsed().as_secs_f64();
        while f64::from(n) < due {
            let (publisher, cdr) = &publishers[n as usize % publishers.len()];
            // A full history rejects some; only sent ones count.
            n += u32::from(publisher.publish(Body::new(cdr.clone())).is_ok());
            n_sent.store(n, Ordering::Relaxed);
        }
        std::thread::sleep(Duration::from_micros(200));
    }
    start.elapsed().as_secs_f64()
}

/// Oracle: the digests of the same ticks without the flood, tick by tick; counting. Episodes under
/// the flood continue until it has sent enough, so a busy machine needs more of them.
#[test]
fn ten_thousand_commands_change_no_bit() {
    inside("ros_floods::ten_thousand_commands_change_no_bit", || {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        let program = Program::start_with(folder.path(), &[], &["--bag", bag.to_str().unwrap()]);
        let node = RosNode::join_as("operator", &discovery_range()).unwrap();
        let mut set = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut reset = Client::of::<srv::ResetSimulation>(&node, "reset_simulation");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let answer: SetSimulationStateResponse = set.call(&SetSimulationStateRequest { state });
        assert_eq!(answer.result.result, SimResult::RESULT_OK);
        let mut episode = || {
            let since = now();
            let answer: StepSimulationResponse = step.call(&StepSimulationRequest { steps: TICKS });
            assert_eq!(
                answer.result.result,
                SimResult::RESULT_OK,
                "{}",
                answer.result.error_message
            );
            since.elapsed().as_secs_f64()
        };
        let quiet_s = episode();
        let scope = ResetSimulationRequest::SCOPE_ALL;
        let (stop, stopped) = mpsc::channel();
        let n_sent = Arc::new(AtomicU32::new(0));
        let flooder = std::thread::spawn({
            let n_sent = Arc::clone(&n_sent);
            move || {
                let other = RosNode::join_as("flooder", &discovery_range()).unwrap();
                flood(&other, &stopped, &n_sent)
            }
        });
        wait_until("the flood", || 0 < n_sent.load(Ordering::Relaxed));
        let n_before = n_sent.load(Ordering::Relaxed);
        let mut under_flood_s = Vec::new();
        while n_sent.load(Ordering::Relaxed) < n_before + COMMANDS_MIN {
            let answer: ResetSimulationResponse = reset.call(&ResetSimulationRequest { scope });
            assert_eq!(answer.result.result, SimResult::RESULT_OK);
            under_flood_s.push(episode());
            assert!(
                under_flood_s.len() < 100,
                "{n_sent:?} commands in 100 episodes are not a flood"
            );
        }
        stop.send(()).unwrap();
        let flood_s = flooder.join().unwrap();
        let n_sent = n_sent.load(Ordering::Relaxed);
        program.end();

        let history = Recording::open(&bag).unwrap().history_without_scene(1_000_000).unwrap();
        let digests: Vec<u64> = history.digests.iter().map(|it| it.1).collect();
        let last = usize::try_from(TICKS).unwrap();
        assert_eq!(
            (digests.len(), history.gap_after),
            ((1 + under_flood_s.len()) * last + 1, None)
        );
        let n_received = history.commands.len();
        let rate = f64::from(n_sent) / flood_s;
        writeln!(
            std::io::stderr().lock(),
            "{n_sent} commands in {flood_s:.2} s, {rate:.0} Hz; {n_received} were received; {TICKS} ticks \
             took {quiet_s:.2} s without and {under_flood_s:.2?} s with them"
        )
        .unwrap();
        // The reset restores the start state; the ticks after it are numbered from there.
        for under_flood in digests[last + 1..].chunks(last) {
            assert_eq!(&digests[1..=last], under_flood, "the same bits");
        }
        // A flood for the physics, not for a full socket: more than one command per tick.
        assert!(under_flood_s.len() * last < n_received, "only {n_received} of {n_sent}");
    });
}
