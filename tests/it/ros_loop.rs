//! The ROS 2 transport: published messages reach subscribers, and received commands arrive.

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
    private_network::{cyclone_config, discovery_range, inside, inside_with_peers},
};

#[expect(clippy::disallowed_methods, reason = "a timeout of the test")]
fn now() -> Instant {
    Instant::now()
}

/// Waits until the condition is true, at most a minute.
fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let start = now();
    while !condition() {
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

/// Oracle: the formula of the synthetic system, message by message; a late joiner receives the
/// latched messages, once.
#[test]
fn published_messages_reach_subscribers() {
    inside("ros_loop::published_messages_reach_subscribers", || {
        let here = RosNode::join(&discovery_range()).unwrap();
        let there = RosNode::join_as("listener", &discovery_range()).unwrap();
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
            // The clock's writer keeps one message, so the next tick is sent when this one was
            // received.
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

/// Oracle: the commands as sent; invalid messages are counted and do not delay others.
#[test]
fn commands_wait_in_order_for_the_next_tick() {
    inside("ros_loop::commands_wait_in_order_for_the_next_tick", || {
        let here = RosNode::join(&discovery_range()).unwrap();
        let there = RosNode::join_as("operator", &discovery_range()).unwrap();
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
        assert!(!source.has_received());

        let mut pose = PoseStamped::default();
        pose.header.frame_id = "world".to_owned();
        pose.header.stamp.sec = 3;
        pose.pose.position.z = f64::NAN; // invalid values also arrive: they are rejected later
        pose.pose.orientation.w = 1.0;
        flange.publish(Body::new(pose.to_cdr())).unwrap();
        wait_until("a first command", || source.has_received());
        let Some(Command::FlangePose(received)) = source.drain(&seen).pop() else {
            panic!("no flange pose")
        };
        assert_eq!((received.frame_id.as_str(), received.stamp_ns), ("world", 3_000_000_000));
        assert!(received.position[2].is_nan());

        flange.publish(Body::new(vec![1, 2, 3])).unwrap();
        let unknown = ObjectCommand { mode: 9, ..Default::default() };
        release.publish(Body::new(unknown.to_cdr())).unwrap();
        wait_until("two malformed messages", || source.counters().n_malformed == 2);

        pose.pose.position.z = 0.5;
        object.publish(Body::new(pose.to_cdr())).unwrap();
        wait_until("the pose", || source.counters().n_received == 2);
        let mode = ObjectCommand::MODE_RELEASE;
        let command = ObjectCommand { mode, object: "cylinder".to_owned(), ..Default::default() };
        release.publish(Body::new(command.to_cdr())).unwrap();
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

/// Oracle: under a flood the newest setpoint arrives, a single command on another topic is kept, no
/// drain returns more than the capacity of the queues, and every message is counted.
#[test]
fn a_flood_of_commands_delays_no_others() {
    inside("ros_loop::a_flood_of_commands_delays_no_others", || {
        let here = RosNode::join(&discovery_range()).unwrap();
        let there = RosNode::join_as("flooder", &discovery_range()).unwrap();
        let mut source = RosSource::new(&here, &encoder()).unwrap();
        let seen = Synthetic::new("cylinder").snapshot;
        let vacuum = there.publisher(&topic("/jamgrip/vacuum_cmd")).unwrap();
        let flange = there.publisher(&topic("/jamgrip/flange/pose_cmd")).unwrap();
        wait_until("readers", || {
            there.n_readers("/jamgrip/vacuum_cmd") == 1
                && there.n_readers("/jamgrip/flange/pose_cmd") == 1
        });
        flange.publish(Body::new(PoseStamped::default().to_cdr())).unwrap();
        wait_until("the single command", || source.has_received());
        let is_enough = Arc::new(AtomicBool::new(false));
        let stop = Arc::clone(&is_enough);
        let flood = std::thread::spawn(move || {
            for i in 0.. {
                // A full window only affects the sender of the flood.
                let _said = vacuum.publish(Body::new(Float64 { data: f64::from(i) }.to_cdr()));
                if stop.load(Ordering::Relaxed) {
                    break;
                }
            }
            wait_until("space for the last command", || {
                vacuum.publish(Body::new(Float64 { data: -70e3 }.to_cdr())).is_ok()
            });
            vacuum
        });
        wait_until("some of the flood", || 2_000 < source.counters().n_received);
        is_enough.store(true, Ordering::Relaxed);
        let mut drained = source.drain(&seen);
        assert!(
            matches!(drained[0], Command::FlangePose(_)),
            "the single command: {:?}",
            drained[0]
        );
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
        assert!(0 < counters.n_dropped, "the flood must exceed the capacity of the queue");
    });
}

/// Oracle: another DDS implementation that only uses the ROS 2 names and types. It receives every
/// tick and the right forces, and its commands arrive as sent. The clock's writer keeps one
/// message, so a tick is sent only after the peer has received the one before.
#[test]
fn an_independent_dds_subscribes_and_publishes() {
    inside_with_peers("ros_loop::an_independent_dds_subscribes_and_publishes", || {
        let node = RosNode::join(&discovery_range()).unwrap();
        let encoder = encoder();
        let mut sink = RosSink::new(&node, &encoder).unwrap();
        let mut source = RosSource::new(&node, &encoder).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let seconds = std::env::var("JAMGRIP_LOOP_SECONDS").unwrap_or_else(|_| "2".to_owned());
        let mut peer = peers::script("subscribe_and_publish.py")
            .arg(&seconds)
            .env("ROS_DOMAIN_ID", discovery_range().domain_id.to_string())
            .env("CYCLONEDDS_URI", format!("file://{}", cyclone_config(folder.path()).display()))
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut peer_output = BufReader::new(peer.stdout.take().unwrap());
        let mut line = String::new();
        peer_output.read_line(&mut line).unwrap();
        assert_eq!(line, "ready\n", "the peer is matched");

        let (send, lines) = mpsc::channel();
        let listener = std::thread::spawn(move || {
            peer_output.lines().map_while(Result::ok).try_for_each(|line| send.send(line))
        });
        let n_ticks = 1000 * seconds.parse::<u64>().unwrap();
        let mut system = Synthetic::new("cylinder");
        let (mut received, mut small, mut large) = (Vec::new(), Cost::default(), Cost::default());
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
            received.extend(source.drain(&system.snapshot));
            let due = start + Duration::from_millis(tick);
            std::thread::sleep(due.saturating_duration_since(now()));
            // A lost tick shows in the end; the test does not wait for it forever.
            let expected = format!("received {tick}");
            while tick < n_ticks
                && lines.recv_timeout(Duration::from_secs(10)).is_ok_and(|it| it != expected)
            {
            }
        }
        writeln!(std::io::stderr(), "without clouds {small:?}, with clouds {large:?}").unwrap();
        listener.join().unwrap().unwrap();
        let line = lines.try_iter().last().unwrap_or_default();
        assert!(peer.wait().unwrap().success(), "the peer printed: {line}");
        received.extend(source.drain(&system.snapshot));
        check_received_by_peer(&serde_json::from_str(&line).unwrap(), n_ticks);
        check_received_from_peer(&received);
        assert_eq!(source.counters().n_malformed, 0);
    });
}

/// Time that publishing took on the sink's thread.
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

fn check_received_by_peer(peer: &serde_json::Value, n_ticks: u64) {
    let n_inputs = topics(&scene()).iter().filter(|it| it.is_input).count();
    let n_outputs = topics(&scene()).len() - n_inputs;
    // Besides its topics, the node writes /rosout, /parameter_events and ros_discovery_info.
    let listed = serde_json::json!([n_inputs, n_outputs + 3]);
    assert_eq!(peer["nodes"]["/jamgrip"], listed, "the node and its topics in the graph");
    assert_eq!(peer["errors"], serde_json::json!([]));
    assert_eq!((&peer["n_ticks"], &peer["n_ticks_missed"]), (&n_ticks.into(), &0.into()));
    assert_eq!(peer["is_clock_steady"], true);
    assert_eq!(peer["status"], 3, "NO_OBJECT_DETECTED");
    assert_eq!(
        (&peer["are_forces_right"], &peer["wrench_frame"]),
        (&true.into(), &"gripper_flange".into())
    );
    // The peer stops at the last clock message; other messages of the same tick may follow it.
    let n_forces = peer["n_forces"].as_u64().unwrap();
    assert!((n_ticks / 4 - 1..=n_ticks / 4).contains(&n_forces), "{n_forces} wrenches");
    for list in ["n_clouds", "n_membranes"] {
        let count = peer[list].as_u64().unwrap();
        assert!((n_ticks / 33 - 1..=n_ticks / 33).contains(&count), "{list}: {count}");
    }
}

fn check_received_from_peer(received: &[Command]) {
    let vacuum: Vec<f64> = received
        .iter()
        .filter_map(|it| match it {
            Command::Vacuum { gauge_pa } => Some(*gauge_pa),
            _ => None,
        })
        .collect();
    let expected: Vec<f64> = (0..100).map(|it| -100.0 * f64::from(it)).collect();
    assert_eq!(vacuum, expected, "the vacuum commands in order");
    let poses: Vec<&PoseCommand> = received
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
