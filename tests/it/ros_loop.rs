//! The ROS 2 side: what goes out reaches others, what others say comes in.

use std::{
    io::{BufRead, BufReader, Write},
    process::Stdio,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    time::{Duration, Instant},
};

use jamgrip::{
    command::{Command, PoseCommand},
    io::{
        inbox,
        sink::{Packet, Sink},
        source::Source,
    },
    ros::{
        node::{Body, RosNode, RosSink},
        subscribe::RosSource,
    },
    wire::{
        messages::{
            RosMessage,
            geometry_msgs::{PoseStamped, WrenchStamped},
            jamgrip_msgs::{ObjectCommand, ObjectDetectionStatus},
            rosgraph_msgs::Clock,
            std_msgs::Float64,
        },
        to_ros::Encoder,
        topics::{Topic, topics},
    },
};

use crate::{
    by_tick::{Synthetic, scene},
    peers,
    private_network::{cyclone_config, inside, inside_with_peers, reach},
};

#[expect(clippy::disallowed_methods, reason = "a limit on how long a test waits")]
fn now() -> Instant {
    Instant::now()
}

/// Waits until `is_so`, at most a minute.
fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = now();
    while !is_so() {
        assert!(now() - start < Duration::from_secs(60), "waited a minute for {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn topic(name: &str) -> Topic {
    let found = topics(&scene()).into_iter().find(|it| it.name == name);
    found.unwrap_or_else(|| panic!("no topic `{name}`"))
}

/// The encoder of the scene, with a membrane that has no triangles.
fn encoder() -> Arc<Encoder> {
    Arc::new(Encoder::new(&Arc::new(scene()), &[], &[]))
}

/// Oracle: the synthetic system's formula, message by message; and who comes late gets what is
/// latched, once.
#[test]
fn what_is_published_reaches_our_own_subscribers() {
    inside("ros_loop::what_is_published_reaches_our_own_subscribers", || {
        let here = RosNode::join(&reach()).unwrap();
        let there = RosNode::join_as("listener", &reach()).unwrap();
        let mut sink = RosSink::new(&here, &encoder()).unwrap();
        let clock = there.subscription::<Clock>(&topic("/clock")).unwrap();
        let wrench = there.subscription::<WrenchStamped>(&topic("/jamgrip/wrench")).unwrap();
        wait_until("readers", || {
            here.n_readers("/clock") == 1 && here.n_readers("/jamgrip/wrench") == 1
        });
        wait_until("writers", || {
            there.n_writers("/clock") == 1 && there.n_writers("/jamgrip/wrench") == 1
        });

        let mut system = Synthetic::new("cylinder");
        let (mut ticks, mut forces) = (Vec::new(), Vec::new());
        let mut listen = |tick| {
            while let Some((message, _)) = clock.take().unwrap() {
                ticks.push(message.clock.nanosec / 1_000_000);
            }
            while let Some((message, _)) = wrench.take().unwrap() {
                forces.push((message.header.stamp.nanosec / 1_000_000, message.wrench.force.z));
            }
            ticks.last() == Some(&tick) && forces.last().map_or(0, |it| it.0) == tick / 4 * 4
        };
        for tick in 1..=400_u32 {
            system.advance_to(u64::from(tick));
            sink.write(&Packet::new(system.snapshot.clone(), None)).unwrap();
            // The clock's writer keeps one message: the next tick comes when this one was heard.
            wait_until("the clock of this tick", || listen(tick));
        }
        assert_eq!(ticks, (1..=400).collect::<Vec<_>>(), "every tick once, in order");
        let expected: Vec<_> = (1..=100).map(|it| (4 * it, f64::from(4 * it))).collect();
        assert_eq!(forces, expected, "250 Hz of a 1 kHz tick, each with its own force");

        let status = topic("/jamgrip/object_detection_status");
        let late = there.subscription::<ObjectDetectionStatus>(&status).unwrap();
        wait_until("the latched status", || late.take().unwrap().is_some());
        sink.close().unwrap();
    });
}

/// Oracle: the commands as they were said; what is none is counted and holds up nothing.
#[test]
fn commands_wait_in_order_for_the_next_tick() {
    inside("ros_loop::commands_wait_in_order_for_the_next_tick", || {
        let here = RosNode::join(&reach()).unwrap();
        let there = RosNode::join_as("operator", &reach()).unwrap();
        let mut source = RosSource::new(&here, &encoder()).unwrap();
        let seen = Synthetic::new("cylinder").snapshot;
        let flange = there.publisher(&topic("/jamgrip/flange/pose_cmd")).unwrap();
        let object = there.publisher(&topic("/jamgrip/object/cylinder/pose_cmd")).unwrap();
        let release = there.publisher(&topic("/jamgrip/object_cmd")).unwrap();
        wait_until("readers", || {
            ["flange/pose_cmd", "object/cylinder/pose_cmd", "object_cmd"]
                .iter()
                .all(|it| there.n_readers(&format!("/jamgrip/{it}")) == 1)
        });
        assert!(!source.has_heard());

        let mut pose = PoseStamped::default();
        pose.header.frame_id = "world".to_owned();
        pose.header.stamp.sec = 3;
        pose.pose.position.z = f64::NAN; // senseless values arrive too: they are refused later
        pose.pose.orientation.w = 1.0;
        flange.publish(Body::new(pose.to_cdr())).unwrap();
        wait_until("a first command", || source.has_heard());
        let Some(Command::FlangePose(heard)) = source.drain(&seen).pop() else {
            panic!("no flange pose")
        };
        assert_eq!((heard.frame_id.as_str(), heard.stamp_ns), ("world", 3_000_000_000));
        assert!(heard.position[2].is_nan());

        flange.publish(Body::new(vec![1, 2, 3])).unwrap();
        let unknown = ObjectCommand { mode: 9, ..Default::default() };
        release.publish(Body::new(unknown.to_cdr())).unwrap();
        wait_until("two refusals", || source.counters().n_malformed == 2);

        pose.pose.position.z = 0.5;
        object.publish(Body::new(pose.to_cdr())).unwrap();
        wait_until("the pose", || source.counters().n_received == 2);
        let mode = ObjectCommand::MODE_RELEASE;
        let ask = ObjectCommand { mode, object: "cylinder".to_owned(), ..Default::default() };
        release.publish(Body::new(ask.to_cdr())).unwrap();
        wait_until("the release", || source.counters().n_received == 3);
        let pose = PoseCommand {
            frame_id: "world".to_owned(),
            stamp_ns: 3_000_000_000,
            position: [0.0, 0.0, 0.5],
            orientation: [0.0, 0.0, 0.0, 1.0],
        };
        let object = "cylinder".to_owned();
        let expected = [
            Command::ObjectPose { object: object.clone(), pose },
            Command::ObjectRelease { object },
        ];
        assert_eq!(source.drain(&seen), expected);
        assert_eq!((source.counters().n_dropped, source.drain(&seen).len()), (0, 0));
    });
}

/// Oracle: the contract. Under a flood the newest set-point arrives, a lone command on another
/// topic survives, no drain returns more than the queues hold, and every message is counted.
#[test]
fn a_flood_of_commands_holds_up_nothing() {
    inside("ros_loop::a_flood_of_commands_holds_up_nothing", || {
        let here = RosNode::join(&reach()).unwrap();
        let there = RosNode::join_as("flooder", &reach()).unwrap();
        let mut source = RosSource::new(&here, &encoder()).unwrap();
        let seen = Synthetic::new("cylinder").snapshot;
        let vacuum = there.publisher(&topic("/jamgrip/vacuum_cmd")).unwrap();
        let flange = there.publisher(&topic("/jamgrip/flange/pose_cmd")).unwrap();
        wait_until("readers", || {
            there.n_readers("/jamgrip/vacuum_cmd") == 1
                && there.n_readers("/jamgrip/flange/pose_cmd") == 1
        });
        flange.publish(Body::new(PoseStamped::default().to_cdr())).unwrap();
        wait_until("the lone command", || source.has_heard());
        let is_enough = Arc::new(AtomicBool::new(false));
        let stop = Arc::clone(&is_enough);
        let flood = std::thread::spawn(move || {
            for i in 0.. {
                // A full window is the flooder's own trouble.
                let _said = vacuum.publish(Body::new(Float64 { data: f64::from(i) }.to_cdr()));
                if stop.load(Ordering::Relaxed) {
                    break;
                }
            }
            wait_until("room for the last command", || {
                vacuum.publish(Body::new(Float64 { data: -70e3 }.to_cdr())).is_ok()
            });
            vacuum
        });
        wait_until("some of the flood", || 2_000 < source.counters().n_received);
        is_enough.store(true, Ordering::Relaxed);
        let mut drained = source.drain(&seen);
        assert!(matches!(drained[0], Command::FlangePose(_)), "the lone command: {:?}", drained[0]);
        let mut n_drained = 0;
        wait_until("the end of the flood", || {
            assert!(drained.len() <= 2 * inbox::DEPTH, "{} at once", drained.len());
            n_drained += drained.len() as u64;
            let is_last = drained.last() == Some(&Command::Vacuum { gauge_pa: -70e3 });
            drained = source.drain(&seen);
            is_last
        });
        let _vacuum = flood.join().unwrap();
        let counters = source.counters();
        n_drained += drained.len() as u64;
        assert_eq!(counters.n_received, n_drained + counters.n_dropped);
        assert!(0 < counters.n_dropped, "a flood that fits the queue proves nothing");
    });
}

/// Oracle: another implementation of DDS, told ROS 2's names and types only. It hears every tick
/// and the right forces, and what it says arrives as it was said. The clock's writer keeps one message,
/// so a tick comes no sooner than the peer has heard the one before.
#[test]
fn an_independent_dds_hears_and_is_heard() {
    inside_with_peers("ros_loop::an_independent_dds_hears_and_is_heard", || {
        let node = RosNode::join(&reach()).unwrap();
        let encoder = encoder();
        let mut sink = RosSink::new(&node, &encoder).unwrap();
        let mut source = RosSource::new(&node, &encoder).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let seconds = std::env::var("JAMGRIP_LOOP_SECONDS").unwrap_or_else(|_| "2".to_owned());
        let mut peer = peers::script("hear_and_say.py")
            .arg(&seconds)
            .env("ROS_DOMAIN_ID", reach().domain_id.to_string())
            .env("CYCLONEDDS_URI", format!("file://{}", cyclone_config(folder.path()).display()))
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut said = BufReader::new(peer.stdout.take().unwrap());
        let mut line = String::new();
        said.read_line(&mut line).unwrap();
        assert_eq!(line, "ready\n", "the peer found its partners");

        let (send, lines) = mpsc::channel();
        let listener = std::thread::spawn(move || {
            said.lines().map_while(Result::ok).try_for_each(|line| send.send(line))
        });
        let n_ticks = 1000 * seconds.parse::<u64>().unwrap();
        let mut system = Synthetic::new("cylinder");
        let (mut heard, mut small, mut large) = (Vec::new(), Cost::default(), Cost::default());
        let start = now();
        for tick in 1..=n_ticks {
            system.advance_to(tick);
            system.snapshot.grains = (tick % 33 == 0).then(|| system.grains());
            system.snapshot.membrane = (tick % 33 == 0).then(|| system.membrane());
            let packet = Packet::new(system.snapshot.clone(), None);
            let n_messages = u32::try_from(packet.messages(&encoder).len()).unwrap();
            let before = now();
            sink.write(&packet).unwrap();
            let cost = if packet.snapshot.grains.is_some() { &mut large } else { &mut small };
            cost.add(n_messages, now() - before);
            heard.extend(source.drain(&system.snapshot));
            let due = start + Duration::from_millis(tick);
            std::thread::sleep(due.saturating_duration_since(now()));
            // A tick that was lost shows in the end; it is not waited for for ever.
            let wanted = format!("heard {tick}");
            while tick < n_ticks
                && lines.recv_timeout(Duration::from_secs(10)).is_ok_and(|it| it != wanted)
            {
            }
        }
        writeln!(std::io::stderr(), "without clouds {small:?}, with clouds {large:?}").unwrap();
        listener.join().unwrap().unwrap();
        let line = lines.try_iter().last().unwrap_or_default();
        assert!(peer.wait().unwrap().success(), "the peer said: {line}");
        heard.extend(source.drain(&system.snapshot));
        check_what_the_peer_heard(&serde_json::from_str(&line).unwrap(), n_ticks);
        check_what_was_heard_of_the_peer(&heard);
        assert_eq!(source.counters().n_malformed, 0);
    });
}

/// What publishing cost the sink's thread.
#[derive(Debug, Default)]
struct Cost {
    n_ticks: u32,
    n_messages: u32,
    total: Duration,
    longest: Duration,
}

impl Cost {
    fn add(&mut self, n_messages: u32, time: Duration) {
        self.n_ticks += 1;
        self.n_messages += n_messages;
        self.total += time;
        self.longest = self.longest.max(time);
    }
}

fn check_what_the_peer_heard(peer: &serde_json::Value, n_ticks: u64) {
    let n_inputs = topics(&scene()).iter().filter(|it| it.is_input).count();
    let n_outputs = topics(&scene()).len() - n_inputs;
    // Besides its topics the node writes /rosout, /parameter_events and ros_discovery_info.
    let listed = serde_json::json!([n_inputs, n_outputs + 3]);
    assert_eq!(peer["nodes"]["/jamgrip"], listed, "the node and its topics in the graph");
    assert_eq!(peer["faults"], serde_json::json!([]));
    assert_eq!((&peer["n_ticks"], &peer["n_ticks_missed"]), (&n_ticks.into(), &0.into()));
    assert_eq!(peer["is_clock_steady"], true);
    assert_eq!(peer["status"], 3, "NO_OBJECT_DETECTED");
    assert_eq!(
        (&peer["are_forces_right"], &peer["wrench_frame"]),
        (&true.into(), &"gripper_flange".into())
    );
    // The peer stops at the last clock; what belongs to the same tick may come behind it.
    let n_forces = peer["n_forces"].as_u64().unwrap();
    assert!((n_ticks / 4 - 1..=n_ticks / 4).contains(&n_forces), "{n_forces} wrenches");
    for list in ["n_clouds", "n_sheets"] {
        let count = peer[list].as_u64().unwrap();
        assert!((n_ticks / 33 - 1..=n_ticks / 33).contains(&count), "{list}: {count}");
    }
}

fn check_what_was_heard_of_the_peer(heard: &[Command]) {
    let vacuum: Vec<f64> = heard
        .iter()
        .filter_map(|it| match it {
            Command::Vacuum { gauge_pa } => Some(*gauge_pa),
            _ => None,
        })
        .collect();
    let expected: Vec<f64> = (0..100).map(|it| -100.0 * f64::from(it)).collect();
    assert_eq!(vacuum, expected, "the vacuum commands in order");
    let poses: Vec<&PoseCommand> = heard
        .iter()
        .filter_map(|it| match it {
            Command::FlangePose(pose) => Some(pose),
            _ => None,
        })
        .collect();
    assert_eq!(poses.len(), 100, "the flange commands");
    for (i, pose) in (0_i32..).zip(poses) {
        assert_eq!(pose.stamp_ns, i64::from(i) * 1_000_000_000 + 5);
        let expected = [0.0, 0.0, 0.001 * f64::from(i)];
        assert_eq!(pose.position.map(f64::to_bits), expected.map(f64::to_bits));
        assert_eq!(
            (pose.frame_id.as_str(), pose.orientation[3].to_bits()),
            ("world", 1.0_f64.to_bits())
        );
    }
}
