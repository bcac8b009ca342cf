//! A recording published again: when, in which order, and what is left out.

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

/// Records 400 ms of simulated time in files of 150 ms.
fn record(folder: &Path) -> Vec<PathBuf> {
    let subject = RunDescription {
        scene_text: String::new(),
        scene_files: Vec::new(),
        facts: Vec::new(),
        format: Format { split_ns: Some(150_000_000), ..Format::default() },
    };
    let folder = folder.join("bag");
    let mut bag = Bag::create(&folder, synthetic::encoder(), subject).unwrap();
    (1..=400).for_each(|tick| bag.write(&synthetic::packet(tick)).unwrap());
    bag.close().unwrap();
    jamgrip::bag::files(&folder).unwrap()
}

/// Remembers what was published, and when; may give cues.
#[derive(Default)]
struct Memory {
    published: Vec<(String, u64, Instant)>,
    clock: Vec<u64>,
    cues: Vec<(usize, PlayerCommand)>,
    teller: Option<Sender<CommandRequest>>,
}

#[expect(clippy::disallowed_methods, reason = "when a message is published is what is tested")]
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
        for (_, cue) in self.cues.iter().filter(|(after, _)| *after == n) {
            self.teller.as_ref().unwrap().send((*cue).into()).unwrap();
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
    cues: Vec<(usize, PlayerCommand)>,
) -> (Played, Memory) {
    let (teller, listener) = mpsc::channel();
    let mut stage = Memory { cues, teller: Some(teller), ..Memory::default() };
    let played = play(files, options, &mut stage, &listener, &Shutdown::default()).unwrap();
    (played, stage)
}

fn of(stage: &Memory, topic: &str) -> Vec<u64> {
    stage.published.iter().filter(|it| it.0 == topic).map(|it| it.1).collect()
}

#[test]
fn every_message_comes_once_in_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    assert_eq!(files.len(), 3, "400 ms in files of 150 ms");
    let (played, stage) = run(&files, &options(), Vec::new());
    assert_eq!(played.n_published, stage.published.len() as u64);
    assert_eq!(played.unplayable, ["/jamgrip/grains"]);
    // Oracle: the clock of the run, one message a tick.
    let expected: Vec<u64> = (1..=400).map(|tick| tick * synthetic::TICK_NS).collect();
    assert_eq!(of(&stage, "/clock"), expected);
    // The frames that stay are repeated at the start of each file.
    assert_eq!(of(&stage, "/tf_static").len(), 3);
    // Never early: 400 ms four times as fast. How late it may be depends on the machine.
    let begin = stage.published[0].2;
    for (topic, time_ns, at) in &stage.published {
        let due = Duration::from_nanos(*time_ns).div_f64(4.0);
        let early = due.saturating_sub(*at - begin);
        assert!(early < Duration::from_millis(1), "{topic} at {time_ns} ns is {early:?} early");
    }
}

#[test]
fn parts_filters_and_an_own_clock() {
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
    let (_, stage) = run(&files, &part, Vec::new());
    // Late readers: what was latched before the part comes first, though it is older.
    assert_eq!(of(&stage, "/tf_static").len(), 1);
    assert!(of(&stage, "/tf_static")[0] < 200_000_000);
    assert!(of(&stage, "/clock").is_empty() && of(&stage, "/tf").is_empty());
    assert!(stage.published.iter().all(|it| !it.0.starts_with("/jamgrip/membrane")));
    let wrenches = of(&stage, "/jamgrip/wrench");
    // Oracle: 100 Hz from 200 ms to 295 ms.
    assert_eq!((wrenches.len(), wrenches[0], wrenches[9]), (10, 200_000_000, 290_000_000));
    let is_rising = stage.clock.windows(2).all(|pair| pair[0] < pair[1]);
    assert!(is_rising && 2 <= stage.clock.len(), "{:?}", stage.clock);
    assert!(stage.clock.iter().all(|it| (200_000_000..=300_000_000).contains(it)));
}

#[test]
fn it_is_wound_stepped_looped_and_ended_by_cues() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    let only_clock = Options { topics: vec!["/clock".to_owned()], is_loop: true, ..options() };
    let ms = |n: u64| n * 1_000_000;
    // After 10 messages back to 5 ms; two steps while it stands still; then to 399 ms, around the
    // end, and out.
    let cues = vec![
        (10, PlayerCommand::Seek(ms(5))),
        (11, PlayerCommand::Next),
        (12, PlayerCommand::Next),
        (13, PlayerCommand::Seek(ms(399))),
        (13, PlayerCommand::Resume),
        (13, PlayerCommand::Rate(50.0)),
        (15, PlayerCommand::Quit),
    ];
    let (_, stage) = run(&files, &only_clock, cues);
    // Oracle: counting by hand. Each cue is heard before the next message.
    let expected: Vec<u64> = (1..=10).chain([5, 6, 7]).chain([399, 400]).map(ms).collect();
    assert_eq!(of(&stage, "/clock"), expected);
}

/// Oracle: the recording read from its beginning, which a copy without an index forces.
#[test]
fn an_index_changes_nothing_but_the_time_it_takes() {
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
        let what = |files: &[PathBuf]| -> Vec<(String, u64)> {
            let (_, stage) = run(files, &part, Vec::new());
            stage.published.into_iter().map(|(topic, time, _)| (topic, time)).collect()
        };
        let expected = what(&copies);
        assert!(!expected.is_empty());
        assert!(what(&files) == expected, "from {start_ms} ms on");
    }
}

/// Oracle: counting by hand.
#[test]
fn who_asks_is_told_when_it_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let files = record(folder.path());
    let only_clock = Options { topics: vec!["/clock".to_owned()], is_paused: true, ..options() };
    let (teller, listener) = mpsc::channel();
    let ask = |cue| {
        let (reply, answer) = mpsc::channel();
        teller.send(CommandRequest { command: cue, reply: Some(reply) }).unwrap();
        answer
    };
    let (look, five) = (ask(PlayerCommand::Status), ask(PlayerCommand::Burst(5)));
    let nowhere = ask(PlayerCommand::SeekTo(401_000_000));
    let (rate, there) = (ask(PlayerCommand::Rate(3.0)), ask(PlayerCommand::SeekTo(399_000_000)));
    let (rest, end) = (ask(PlayerCommand::Burst(0)), ask(PlayerCommand::Resume));
    let mut stage = Memory::default();
    play(&files, &only_clock, &mut stage, &listener, &Shutdown::default()).unwrap();
    let look = look.recv().unwrap();
    assert_eq!((look.is_done, look.is_paused, look.rate), (true, true, 4.0));
    // Going elsewhere ends what was to be played at once.
    let five = five.recv().unwrap();
    assert_eq!((five.is_done, five.n_played), (false, 0));
    assert!(!nowhere.recv().unwrap().is_done, "the recording ends at 400 ms");
    assert!(there.recv().unwrap().is_done && rate.recv().unwrap().is_done);
    let rest = rest.recv().unwrap();
    assert_eq!((rest.is_done, rest.n_played), (true, 2), "399 ms and 400 ms");
    assert!(end.recv().unwrap().is_done);
    assert_eq!(of(&stage, "/clock"), [399_000_000, 400_000_000]);
}

#[test]
fn cues_are_read_and_refused() {
    assert_eq!(PlayerCommand::parse("seek 1.5s\n"), Ok(PlayerCommand::Seek(1_500_000_000)));
    assert_eq!(PlayerCommand::parse("rate 0.5"), Ok(PlayerCommand::Rate(0.5)));
    assert_eq!(PlayerCommand::parse(""), Ok(PlayerCommand::Toggle));
    for wrong in ["seek", "seek -1s", "seek 3", "rate 0", "rate fast", "stop"] {
        assert!(PlayerCommand::parse(wrong).is_err(), "{wrong}");
    }
}

/// Oracle: the recording; the clock is 1 kHz there, and told at 100 Hz of wall time here.
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

    use crate::private_network::{inside, reach};

    inside("bags_played::a_played_recording_reaches_a_subscriber", || {
        let folder = tempfile::tempdir().unwrap();
        let files = record(folder.path());
        let topic = |name: &str| -> Topic {
            topics(&synthetic::scene()).into_iter().find(|it| it.name == name).unwrap()
        };
        let there = RosNode::join_as("listener", &reach()).unwrap();
        let wrench = there.subscription::<WrenchStamped>(&topic("/jamgrip/wrench")).unwrap();
        let clock = there.subscription::<Clock>(&topic("/clock")).unwrap();
        let mut stage = RosPlayerNode::join(&reach(), true).unwrap();
        let options = Options {
            rate: 1.0,
            delay: Duration::from_secs(2),
            clock_rate: Some(100.0),
            exclude: vec!["/jamgrip/*_cmd".to_owned()],
            ..options()
        };
        let (_teller, listener) = mpsc::channel();
        let played = play(&files, &options, &mut stage, &listener, &Shutdown::default()).unwrap();
        assert!(played.unplayable.is_empty() && stage.errors.0 == 0, "{:?}", stage.errors);
        let (mut forces, mut times, mut late) = (Vec::new(), Vec::new(), None);
        let frames = there.subscription::<TFMessage>(&topic("/tf_static")).unwrap();
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
        // Who comes late gets the frames that stay, though they were published long ago.
        assert!(late.is_some());
        let expected: Vec<(u32, f64)> = (1..=40).map(|i| (10 * i, -9.81)).collect();
        // A subscription keeps ten; the last ones are there, in order.
        let n = forces.len();
        assert!(10 <= n && forces == expected[40 - n..], "{forces:?}");
        assert!(!times.is_empty() && times.windows(2).all(|it| it[0] < it[1]), "{times:?}");
    });
}

/// Someone who asks a player's services, in both ways in turn.
#[cfg(feature = "ros")]
struct Someone {
    /// Its clients are found as long as it is there.
    _node: std::sync::Arc<jamgrip::ros::node::RosNode>,
    clients: Vec<jamgrip::ros::service::RosClient>,
}

#[cfg(feature = "ros")]
impl Someone {
    fn join() -> Self {
        use jamgrip::{
            replay::{player_node, player_services},
            ros::{
                node::RosNode,
                service::{RosClient, ServiceMapping},
            },
        };

        let node = RosNode::join_as("someone", &crate::private_network::reach()).unwrap();
        let offers = player_services::services(player_node::NODE_NAME);
        let clients = offers.iter().enumerate().map(|(i, offer)| {
            let way = if i.is_multiple_of(2) {
                ServiceMapping::Enhanced
            } else {
                ServiceMapping::Cyclone
            };
            RosClient::open(&node, offer, way).unwrap()
        });
        let clients = clients.collect();
        Self { _node: node, clients }
    }

    /// Asks and waits for the answer.
    fn ask<A>(&mut self, name: &str, question: &impl serde::Serialize) -> A
    where
        A: serde::de::DeserializeOwned,
    {
        use jamgrip::{replay::player_services, wire::cdr::Cdr};

        let i = player_services::SERVICES.iter().position(|it| it.0 == name).unwrap();
        let client = &mut self.clients[i];
        let begin = now();
        let nap = || {
            assert!(now() - begin < Duration::from_secs(30), "{name} is not answered");
            std::thread::sleep(Duration::from_millis(1));
        };
        while !client.is_matched() {
            nap();
        }
        client.send(&Cdr::of(question));
        loop {
            if let Some(answer) = client.take_response() {
                return answer.read().unwrap();
            }
            nap();
        }
    }

    fn sees_it_paused(&mut self) -> bool {
        use jamgrip::wire::messages::rosbag2_interfaces::{IsPausedRequest, IsPausedResponse};

        let answer: IsPausedResponse = self.ask("is_paused", &IsPausedRequest::default());
        answer.paused
    }
}

/// Oracle: the meaning of the services in rosbag2_interfaces, and counting by hand.
#[cfg(feature = "ros")]
#[test]
fn services_pause_wind_and_step_it() {
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

    use crate::private_network::{inside, reach};

    inside("bags_played::services_pause_wind_and_step_it", || {
        let folder = tempfile::tempdir().unwrap();
        let files = record(folder.path());
        let mut someone = Someone::join();
        let player = std::thread::spawn(move || {
            let stage = RosPlayerNode::join(&reach(), false).unwrap();
            let (teller, listener) = mpsc::channel();
            let _prompter = stage.open_services(teller).unwrap();
            let only_clock =
                Options { topics: vec!["/clock".to_owned()], is_paused: true, ..options() };
            let mut memory = Memory::default();
            play(&files, &only_clock, &mut memory, &listener, &Shutdown::default()).unwrap();
            memory
        });
        assert!(someone.sees_it_paused());
        let next: PlayNextResponse = someone.ask("play_next", &PlayNextRequest::default());
        assert!(next.success);
        let burst: BurstResponse = someone.ask("burst", &BurstRequest { num_messages: 9 });
        assert_eq!(burst.actually_burst, 9);
        for (sec, ms, expected) in [(9, 0, false), (0, 300, true)] {
            let time = Time { sec, nanosec: ms * 1_000_000 };
            let sought: SeekResponse = someone.ask("seek", &SeekRequest { time });
            assert_eq!(sought.success, expected);
        }
        for (rate, expected) in [(-1.0, false), (1e-3, true)] {
            let set: SetRateResponse = someone.ask("set_rate", &SetRateRequest { rate });
            assert_eq!(set.success, expected);
        }
        let rate: GetRateResponse = someone.ask("get_rate", &GetRateRequest::default());
        assert_eq!(rate.rate.to_bits(), 1e-3_f64.to_bits());
        // A thousand times as slowly it does not come far before it is paused again.
        let toggle = TogglePausedRequest::default();
        let TogglePausedResponse { .. } = someone.ask("toggle_paused", &toggle);
        assert!(!someone.sees_it_paused());
        let burst: BurstResponse = someone.ask("burst", &BurstRequest { num_messages: 2 });
        assert_eq!(burst.actually_burst, 0, "only when paused");
        let PauseResponse { .. } = someone.ask("pause", &PauseRequest::default());
        assert!(someone.sees_it_paused());
        let StopResponse { .. } = someone.ask("stop", &StopRequest::default());
        let ticks: Vec<u64> = of(&player.join().unwrap(), "/clock");
        let expected: Vec<u64> = (1..=10).map(|tick| tick * 1_000_000).collect();
        assert_eq!(ticks[..10], expected);
        assert!(ticks[10..].iter().all(|it| (300_000_000..400_000_000).contains(it)), "{ticks:?}");
    });
}
