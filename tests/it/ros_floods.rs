//! A flood of commands, ten thousand a second where the machine can send as many.

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
        topics::{Common, common, topics},
    },
};

use crate::{
    coarse,
    private_network::{inside, reach},
    ros_program::{Client, Running, wait_until},
};

/// Commands that are asked for (Hz).
const RATE: f64 = 10_000.0;
/// Ticks of an episode.
const TICKS: u64 = 500;
/// Commands that are sent during the episodes under the flood, however long that takes.
const COMMANDS_MIN: u32 = 10_000;

#[expect(clippy::disallowed_methods, reason = "how fast commands come is measured")]
fn now() -> Instant {
    Instant::now()
}

/// Senseless commands on three topics, one after the other, at `RATE` until `stopped`, counted in
/// `n_sent`; the time that took (s).
fn flood(node: &RosNode, stopped: &mpsc::Receiver<()>, n_sent: &AtomicU32) -> f64 {
    let all = topics(&coarse::scene(&[]));
    let mut pose = PoseStamped::default();
    pose.pose.position.x = f64::NAN;
    let unknown = ObjectCommand { object: "nobody".to_owned(), ..Default::default() };
    let commands = [
        (Common::VacuumCommand, Float64 { data: f64::NAN }.to_cdr()),
        (Common::FlangePoseCommand, pose.to_cdr()),
        (Common::ObjectCommand, unknown.to_cdr()),
    ];
    let mouths = commands.map(|(topic, cdr)| {
        let topic = &all[common(topic)];
        let mouth = node.publisher(topic).unwrap();
        wait_until("a reader", || 0 < node.n_readers(&topic.name));
        (mouth, cdr)
    });
    let (start, mut n) = (now(), 0_u32);
    while stopped.try_recv().is_err() {
        let due = RATE * start.elapsed().as_secs_f64();
        while f64::from(n) < due {
            let (mouth, cdr) = &mouths[n as usize % mouths.len()];
            // A full history refuses some; what was sent counts.
            n += u32::from(mouth.publish(Body::new(cdr.clone())).is_ok());
            n_sent.store(n, Ordering::Relaxed);
        }
        std::thread::sleep(Duration::from_micros(200));
    }
    start.elapsed().as_secs_f64()
}

/// Oracle: the digests of the same ticks without the flood, tick by tick; counting. Episodes under the
/// flood go on until it has sent enough, so that a busy machine needs more of them.
#[test]
fn ten_thousand_commands_change_no_bit() {
    inside("ros_floods::ten_thousand_commands_change_no_bit", || {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        let program = Running::start_with(folder.path(), &[], &["--bag", bag.to_str().unwrap()]);
        let node = RosNode::join_as("operator", &reach()).unwrap();
        let mut set = Client::of::<srv::SetSimulationState>(&node, "set_simulation_state");
        let mut reset = Client::of::<srv::ResetSimulation>(&node, "reset_simulation");
        let mut step = Client::of::<srv::StepSimulation>(&node, "step_simulation");
        let state = SimulationState { state: SimulationState::STATE_PAUSED };
        let answer: SetSimulationStateResponse = set.ask(&SetSimulationStateRequest { state });
        assert_eq!(answer.result.result, SimResult::RESULT_OK);
        let mut episode = || {
            let since = now();
            let answer: StepSimulationResponse = step.ask(&StepSimulationRequest { steps: TICKS });
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
                let other = RosNode::join_as("flooder", &reach()).unwrap();
                flood(&other, &stopped, &n_sent)
            }
        });
        wait_until("the flood", || 0 < n_sent.load(Ordering::Relaxed));
        let n_before = n_sent.load(Ordering::Relaxed);
        let mut loud_s = Vec::new();
        while n_sent.load(Ordering::Relaxed) < n_before + COMMANDS_MIN {
            let answer: ResetSimulationResponse = reset.ask(&ResetSimulationRequest { scope });
            assert_eq!(answer.result.result, SimResult::RESULT_OK);
            loud_s.push(episode());
            assert!(loud_s.len() < 100, "{n_sent:?} commands in 100 episodes are no flood");
        }
        stop.send(()).unwrap();
        let flood_s = flooder.join().unwrap();
        let n_sent = n_sent.load(Ordering::Relaxed);
        program.end();

        let course = Recording::open(&bag).unwrap().course_of_all(1_000_000).unwrap();
        let digests: Vec<u64> = course.digests.iter().map(|it| it.1).collect();
        let last = usize::try_from(TICKS).unwrap();
        assert_eq!((digests.len(), course.gap_after), ((1 + loud_s.len()) * last + 1, None));
        let n_taken = course.commands.len();
        let rate = f64::from(n_sent) / flood_s;
        writeln!(
            std::io::stderr().lock(),
            "{n_sent} commands in {flood_s:.2} s, {rate:.0} Hz; {n_taken} were taken in; {TICKS} ticks \
             took {quiet_s:.2} s without and {loud_s:.2?} s with them"
        )
        .unwrap();
        // The reset makes the state of the start; the ticks behind it are numbered anew in time.
        for loud in digests[last + 1..].chunks(last) {
            assert_eq!(&digests[1..=last], loud, "the same bits");
        }
        // It was a flood for the physics, not for a full socket: more than one command per tick.
        assert!(loud_s.len() * last < n_taken, "only {n_taken} of {n_sent}");
    });
}
