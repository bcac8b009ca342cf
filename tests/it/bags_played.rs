//! Playing a recording: times, order, and skipped topics.

use std::{
    path::{Path, PathBuf},
    sync::mpsc::{self, Sender},
    time::{Duration, Instant},
};

use jamgrip::{
    bag::{
        reader::{Channel, RecordedMessage},
        sink::{Bag, Format, RunDescription},
    },
    host::shutdown::Shutdown,
    io::sink::Sink,
    replay::{
        play::{Options, Played, PlayerOutput, play},
        player_command::{CommandRequest, PlayerCommand},
    },
};

use crate::synthetic;

/// Records 400 ms of simulation time in files of 150 ms.
fn record(folder: &Path) -> Vec<PathBuf> {
    let description = RunDescription {
        scene_text: String::new(),
        scene_files: Vec::new(),
        facts: Vec::new(),
        format: Format { split_ns: Some(150_000_000), ..Format::default() },
    };
    let folder = folder.join("bag");
    let mut bag = Bag::create(&folder, synthetic::encoder(), description).unwrap();
    (1..=400).for_each(|tick| bag.write(&synthetic::packet(tick)).unwrap());
    bag.close().unwrap();
    jamgrip::bag::files(&folder).unwrap()
}

/// Stores the published messages with their times; may send commands.
#[derive(Default)]
struct Memory {
    published: Vec<(String, u64, Instant)>,
    clock: Vec<u64>,
    commands: Vec<(usize, PlayerCommand)>,
    sender: Option<Sender<CommandRequest>>,
}

#[expect(clippy::disallowed_methods, reason = "the test measures times of publication")]
fn now() -> Instant {
    Instant::now()
}

impl PlayerOutput for Memory {
    fn open(&mut self, channel: &Channel) -> bool {
        channel.topic != "/jamgrip/grains"
    }

    fn publish(&mut self, message: &RecordedMessage) {
        self.published.push((message.channel.topic.clone(), message.log_time, now()));
        let n = self.published.len();
        for (_, command) in self.commands.iter().filter(|(after, _)| *after == n) {
            self.sender.as_ref().unwrap().send((*command).into()).unwrap();
        }
    }

    fn publish_clock(&mut self, time_ns: u64) {
        self.clock.push(time_ns);
    }
}

fn options() -> Options {
    Options {
        rate: 4.0,
        start_ns: 0,
        end_ns: None,
        is_loop: false,
        is_paused: false,
        topics: Vec::new(),
        exclude: Vec::new(),
        delay: Duration::ZERO,
        clock_rate: None,
    }
}

fn run(
    files: &[PathBuf],
    options: &Options,
    commands: Vec<(usize, PlayerCommand)>,
) -> (Played, Memory) {
    let (sender, listener) = mpsc::channel();
    let mut output = Memory { commands, sender: Some(sender), ..Memory::default() };
    let played = play(files, options, &mut output, &listener, &Shutdown::default()).unwrap();
    (played, output)
}

fn of(output: &Memory, topic: &str) -> Vec<u64> {
    output.published.iter().filter(|it| it.0 == topic).map(|it| it.1).collect()
}

#[test]
fn every_message_is_played_once_at_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    assert_eq!(files.len(), 3, "400 ms in files of 150 ms");
    let (played, output) = run(&files, &options(), Vec::new());
    assert_eq!(played.n_published, output.published.len() as u64);
    assert_eq!(played.unplayable, ["/jamgrip/grains"]);
    // Oracle: the clock of the run, one message per tick.
    let expected: Vec<u64> = (1..=400).map(|tick| tick * synthetic::TICK_NS).collect();
    assert_eq!(of(&output, "/clock"), expected);
    // The static frames are repeated at the start of each file.
    assert_eq!(of(&output, "/tf_static").len(), 3);
    // Never early, at four times the speed. How late a message may be depends on the machine.
    let begin = output.published[0].2;
    for (topic, time_ns, at) in &output.published {
        let due = Duration::from_nanos(*time_ns).div_f64(4.0);
        let early = due.saturating_sub(*at - begin);
        assert!(early < Duration::from_millis(1), "{topic} at {time_ns} ns is {early:?} early");
    }
}

#[test]
fn time_range_topic_filters_and_clock_rate() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    let part = Options {
        rate: 1.0,
        start_ns: 200_000_000,
        end_ns: Some(295_000_000),
        topics: vec!["/jamgrip/*".to_owned(), "/tf_static".to_owned(), "/clock".to_owned()],
        exclude: vec!["/jamgrip/membrane*".to_owned()],
        clock_rate: Some(1000.0),
        ..options()
    };
    let (_, output) = run(&files, &part, Vec::new());
    // For late joiners, latched messages before the range come first.
    assert_eq!(of(&output, "/tf_static").len(), 1);
    assert!(of(&output, "/tf_static")[0] < 200_000_000);
    assert!(of(&output, "/clock").is_empty() && of(&output, "/tf").is_empty());
    assert!(output.published.iter().all(|it| !it.0.starts_with("/jamgrip/membrane")));
    let wrenches = of(&output, "/jamgrip/wrench");
    // Oracle: 100 Hz from 200 ms to 295 ms.
    assert_eq!((wrenches.len(), wrenches[0], wrenches[9]), (10, 200_000_000, 290_000_000));
    let is_rising = output.clock.windows(2).all(|pair| pair[0] < pair[1]);
    assert!(is_rising && 2 <= output.clock.len(), "{:?}", output.clock);
    assert!(output.clock.iter().all(|it| (200_000_000..=300_000_000).contains(it)));
}

#[test]
fn commands_seek_step_loop_and_quit() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    let only_clock = Options { topics: vec!["/clock".to_owned()], is_loop: true, ..options() };
    let ms = |n: u64| n * 1_000_000;
    // After 10 messages, back to 5 ms; two steps while paused; then to 399 ms, around the end, and
    // quit.
    let commands = vec![
        (10, PlayerCommand::Seek(ms(5))),
        (11, PlayerCommand::Next),
        (12, PlayerCommand::Next),
        (13, PlayerCommand::Seek(ms(399))),
        (13, PlayerCommand::Resume),
        (13, PlayerCommand::Rate(50.0)),
        (15, PlayerCommand::Quit),
    ];
    let (_, output) = run(&files, &only_clock, commands);
    // Oracle: counting by hand. Each command is handled before the next message.
    let expected: Vec<u64> = (1..=10).chain([5, 6, 7]).chain([399, 400]).map(ms).collect();
    assert_eq!(of(&output, "/clock"), expected);
}

/// Oracle: the recording read from its beginning, which a copy without an index requires.
#[test]
fn an_index_does_not_change_what_is_played() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    let indexed: Vec<bool> =
        files.iter().map(|it| jamgrip::bag::index::Index::read(it).is_some()).collect();
    assert_eq!(indexed, [true; 3]);
    let copies: Vec<PathBuf> = files
        .iter()
        .map(|file| {
            let copy = file.with_extension("copy");
            let bytes = std::fs::read(file).unwrap();
            // Footer and magic are the last 37 bytes.
            std::fs::write(&copy, &bytes[..bytes.len() - 37]).unwrap();
            assert!(jamgrip::bag::index::Index::read(&copy).is_none());
            copy
        })
        .collect();
    for start_ms in [0, 1, 149, 150, 151, 290, 399, 400] {
        let part = Options { rate: 100.0, start_ns: start_ms * 1_000_000, ..options() };
        let played = |files: &[PathBuf]| -> Vec<(String, u64)> {
            let (_, output) = run(files, &part, Vec::new());
            output.published.into_iter().map(|(topic, time, _)| (topic, time)).collect()
        };
        let expected = played(&copies);
        assert!(!expected.is_empty());
        assert!(played(&files) == expected, "from {start_ms} ms on");
    }
}

/// Oracle: counting by hand.
#[test]
fn replies_are_sent_when_commands_are_done() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    let only_clock = Options { topics: vec!["/clock".to_owned()], is_paused: true, ..options() };
    let (sender, listener) = mpsc::channel();
    let send = |command| {
        let (reply, response) = mpsc::channel();
        sender.send(CommandRequest { command, reply: Some(reply) }).unwrap();
        response
    };
    let (status, five) = (send(PlayerCommand::Status), send(PlayerCommand::Burst(5)));
    let nowhere = send(PlayerCommand::SeekTo(401_000_000));
    let (rate, seek) = (send(PlayerCommand::Rate(3.0)), send(PlayerCommand::SeekTo(399_000_000)));
    let (rest, end) = (send(PlayerCommand::Burst(0)), send(PlayerCommand::Resume));
    let mut output = Memory::default();
    play(&files, &only_clock, &mut output, &listener, &Shutdown::default()).unwrap();
    let status = status.recv().unwrap();
    assert_eq!((status.is_done, status.is_paused, status.rate), (true, true, 4.0));
    // Seeking ends a burst.
    let five = five.recv().unwrap();
    assert_eq!((five.is_done, five.n_played), (false, 0));
    assert!(!nowhere.recv().unwrap().is_done, "the recording ends at 400 ms");
    assert!(seek.recv().unwrap().is_done && rate.recv().unwrap().is_done);
    let rest = rest.recv().unwrap();
    assert_eq!((rest.is_done, rest.n_played), (true, 2), "399 ms and 400 ms");
    assert!(end.recv().unwrap().is_done);
    assert_eq!(of(&output, "/clock"), [399_000_000, 400_000_000]);
}

#[test]
fn commands_are_parsed_or_rejected() {
    assert_eq!(PlayerCommand::parse("seek 1.5s\n"), Ok(PlayerCommand::Seek(1_500_000_000)));
    assert_eq!(PlayerCommand::parse("rate 0.5"), Ok(PlayerCommand::Rate(0.5)));
    assert_eq!(PlayerCommand::parse(""), Ok(PlayerCommand::Toggle));
    for wrong in ["seek", "seek -1s", "seek 3", "rate 0", "rate fast", "stop"] {
        assert!(PlayerCommand::parse(wrong).is_err(), "{wrong}");
    }
}

/// Oracle: the recording; its clock has 1 kHz, and is played at 100 Hz of wall-clock time.
#[cfg(feature = "ros")]
#[test]
fn a_played_recording_reaches_a_subscriber() {
    use jamgrip::{
        replay::player_node::RosPlayerNode,
        ros::node::RosNode,
        wire::{
            messages::{geometry_msgs::WrenchStamped, rosgraph_msgs::Clock, tf2_msgs::TFMessage},
            topics::{Topic, topics},
        },
    };

    use crate::private_network::{discovery_range, inside};

    inside("bags_played::a_played_recording_reaches_a_subscriber", || {
        let folder = tempfile::tempdir().unwrap();
        let files = record(folder.path());
        let topic = |name: &str| -> Topic {
            topics(&synthetic::scene()).into_iter().find(|it| it.name == name).unwrap()
        };
        let node = RosNode::join_as("listener", &discovery_range()).unwrap();
        let wrench = node.subscription::<WrenchStamped>(&topic("/jamgrip/wrench")).unwrap();
        let clock = node.subscription::<Clock>(&topic("/clock")).unwrap();
        let mut output = RosPlayerNode::join(&discovery_range(), true).unwrap();
        let options = Options {
            rate: 1.0,
            delay: Duration::from_secs(2),
            clock_rate: Some(100.0),
            exclude: vec!["/jamgrip/*_cmd".to_owned()],
            ..options()
        };
        let (_sender, listener) = mpsc::channel();
        let played = play(&files, &options, &mut output, &listener, &Shutdown::default()).unwrap();
        assert!(played.unplayable.is_empty() && output.errors.0 == 0, "{:?}", output.errors);
        let (mut forces, mut times, mut late) = (Vec::new(), Vec::new(), None);
        let frames = node.subscription::<TFMessage>(&topic("/tf_static")).unwrap();
        let begin = now();
        while now() - begin < Duration::from_secs(60) && (forces.len() < 40 || late.is_none()) {
            while let Some((message, _)) = wrench.take().unwrap() {
                forces.push((message.header.stamp.nanosec / 1_000_000, message.wrench.force.z));
            }
            while let Some((message, _)) = clock.take().unwrap() {
                times.push(message.clock.nanosec);
            }
            late = late.or_else(|| frames.take().unwrap());
            std::thread::sleep(Duration::from_millis(2));
        }
        // A late joiner receives the static frames, although they were published long ago.
        assert!(late.is_some());
        let expected: Vec<(u32, f64)> = (1..=40).map(|i| (10 * i, -9.81)).collect();
        // A subscription keeps ten messages; the last ones arrive in order.
        let n = forces.len();
        assert!(10 <= n && forces == expected[40 - n..], "{forces:?}");
        assert!(!times.is_empty() && times.windows(2).all(|it| it[0] < it[1]), "{times:?}");
    });
}

/// A client of a player's services, which alternates between the two service mappings.
#[cfg(feature = "ros")]
struct PlayerClient {
    /// The clients are valid as long as the node exists.
    _node: std::sync::Arc<jamgrip::ros::node::RosNode>,
    clients: Vec<jamgrip::ros::service::RosClient>,
}

#[cfg(feature = "ros")]
impl PlayerClient {
    fn join() -> Self {
        use jamgrip::{
            replay::{player_node, player_services},
            ros::{
                node::RosNode,
                service::{RosClient, ServiceMapping},
            },
        };

        let node = RosNode::join_as("someone", &crate::private_network::discovery_range()).unwrap();
        let specs = player_services::services(player_node::NODE_NAME);
        let clients = specs.iter().enumerate().map(|(i, spec)| {
            let mapping = if i.is_multiple_of(2) {
                ServiceMapping::Enhanced
            } else {
                ServiceMapping::Cyclone
            };
            RosClient::open(&node, spec, mapping).unwrap()
        });
        let clients = clients.collect();
        Self { _node: node, clients }
    }

    /// Sends a request and waits for the response.
    fn call<A>(&mut self, name: &str, request: &impl serde::Serialize) -> A
    where
        A: serde::de::DeserializeOwned,
    {
        use jamgrip::{replay::player_services, wire::cdr::Cdr};

        let i = player_services::SERVICES.iter().position(|it| it.0 == name).unwrap();
        let client = &mut self.clients[i];
        let begin = now();
        let wait = || {
            assert!(now() - begin < Duration::from_secs(30), "{name} got no response");
            std::thread::sleep(Duration::from_millis(1));
        };
        while !client.is_matched() {
            wait();
        }
        client.send(&Cdr::of(request));
        loop {
            if let Some(response) = client.take_response() {
                return response.read().unwrap();
            }
            wait();
        }
    }

    fn is_paused(&mut self) -> bool {
        use jamgrip::wire::messages::rosbag2_interfaces::{IsPausedRequest, IsPausedResponse};

        let response: IsPausedResponse = self.call("is_paused", &IsPausedRequest::default());
        response.paused
    }
}

/// Oracle: the service definitions in rosbag2_interfaces, and counting by hand.
#[cfg(feature = "ros")]
#[test]
fn services_pause_seek_and_step() {
    use jamgrip::{
        replay::player_node::RosPlayerNode,
        wire::messages::{
            builtin_interfaces::Time,
            rosbag2_interfaces::{
                BurstRequest, BurstResponse, GetRateRequest, GetRateResponse, PauseRequest,
                PauseResponse, PlayNextRequest, PlayNextResponse, SeekRequest, SeekResponse,
                SetRateRequest, SetRateResponse, StopRequest, StopResponse, TogglePausedRequest,
                TogglePausedResponse,
            },
        },
    };

    use crate::private_network::{discovery_range, inside};

    inside("bags_played::services_pause_seek_and_step", || {
        let folder = tempfile::tempdir().unwrap();
        let files = record(folder.path());
        let mut client = PlayerClient::join();
        let player = std::thread::spawn(move || {
            let output = RosPlayerNode::join(&discovery_range(), false).unwrap();
            let (sender, listener) = mpsc::channel();
            let _services = output.open_services(sender).unwrap();
            let only_clock =
                Options { topics: vec!["/clock".to_owned()], is_paused: true, ..options() };
            let mut memory = Memory::default();
            play(&files, &only_clock, &mut memory, &listener, &Shutdown::default()).unwrap();
            memory
        });
        assert!(client.is_paused());
        let next: PlayNextResponse = client.call("play_next", &PlayNextRequest::default());
        assert!(next.success);
        let burst: BurstResponse = client.call("burst", &BurstRequest { num_messages: 9 });
        assert_eq!(burst.actually_burst, 9);
        for (sec, ms, expected) in [(9, 0, false), (0, 300, true)] {
            let time = Time { sec, nanosec: ms * 1_000_000 };
            let seek: SeekResponse = client.call("seek", &SeekRequest { time });
            assert_eq!(seek.success, expected);
        }
        for (rate, expected) in [(-1.0, false), (1e-3, true)] {
            let set: SetRateResponse = client.call("set_rate", &SetRateRequest { rate });
            assert_eq!(set.success, expected);
        }
        let rate: GetRateResponse = client.call("get_rate", &GetRateRequest::default());
        assert_eq!(rate.rate.to_bits(), 1e-3_f64.to_bits());
        // At a thousandth of the speed it plays little before it is paused again.
        let toggle = TogglePausedRequest::default();
        let TogglePausedResponse { .. } = client.call("toggle_paused", &toggle);
        assert!(!client.is_paused());
        let burst: BurstResponse = client.call("burst", &BurstRequest { num_messages: 2 });
        assert_eq!(burst.actually_burst, 0, "only when paused");
        let PauseResponse { .. } = client.call("pause", &PauseRequest::default());
        assert!(client.is_paused());
        let StopResponse { .. } = client.call("stop", &StopRequest::default());
        let ticks: Vec<u64> = of(&player.join().unwrap(), "/clock");
        let expected: Vec<u64> = (1..=10).map(|tick| tick * 1_000_000).collect();
        assert_eq!(ticks[..10], expected);
        assert!(ticks[10..].iter().all(|it| (300_000_000..400_000_000).contains(it)), "{ticks:?}");
    });
}
