//! Quality of service: which messages reach which kind of subscriber.

use jamgrip::{
    io::sink::Sink,
    ros::{
        node::{RosNode, RosSink, policies},
        service::{Raw, RawCdr},
    },
    wire::topics::{CommonTopic, Qos, common},
};
use rustdds::{
    DataReaderStatus, DomainParticipant, StatusEvented, TopicKind, no_key::SimpleDataReader,
};

use crate::{
    private_network::{discovery_range, inside},
    ros_program::wait_until,
    synthetic,
};

/// A subscriber of one kind, and its state.
struct Subscriber {
    what: String,
    reader: SimpleDataReader<Raw, RawCdr>,
    /// DDS: the requested quality of service does not exceed the offered one.
    is_compatible: bool,
    /// It must receive data, because some are published after it has joined or are kept for it.
    is_served: bool,
    is_matched: bool,
    is_rejected: bool,
    n_received: usize,
}

impl Subscriber {
    fn update(&mut self) {
        while let Some(status) = self.reader.try_recv_status() {
            match status {
                DataReaderStatus::SubscriptionMatched { current, .. } => {
                    self.is_matched = 0 < current.count();
                }
                DataReaderStatus::RequestedIncompatibleQos { .. } => self.is_rejected = true,
                _ => {}
            }
        }
        self.reader.drain_read_notifications();
        while let Ok(Some(_)) = self.reader.try_take_one() {
            self.n_received += 1;
        }
    }
}

fn reader(
    participant: &DomainParticipant,
    name: &str,
    type_name: &str,
    qos: Qos,
) -> SimpleDataReader<Raw, RawCdr> {
    let qos = policies(qos);
    let topic = participant
        .create_topic(format!("rt{name}"), type_name.to_owned(), &qos, TopicKind::NoKey)
        .unwrap();
    let subscriber = participant.create_subscriber(&qos).unwrap();
    subscriber.create_simple_datareader_no_key(&topic, Some(qos)).unwrap()
}

/// Oracle: the DDS rules for requested and offered quality of service (reliable is more than best
/// effort, transient local more than volatile), worked out here; and the table of topics: every
/// topic is offered as reliable, latched ones as transient local.
#[test]
fn each_topic_reaches_each_compatible_subscriber() {
    inside("ros_qos::each_topic_reaches_each_compatible_subscriber", || {
        let here = RosNode::join(&discovery_range()).unwrap();
        // Each kind is a separate participant, because data that reach one reader of a
        // participant may be passed to its other readers.
        let kinds = [(true, true), (true, false), (false, true), (false, false)];
        let there = kinds.map(|(is_reliable, is_latched)| {
            let name = format!("reliable_{is_reliable}_latched_{is_latched}");
            (RosNode::join_as(&name, &discovery_range()).unwrap(), is_reliable, is_latched)
        });
        let encoder = synthetic::encoder();
        let mut sink = RosSink::new(&here, &encoder).unwrap();
        // Sent before the subscribers join, and never again.
        let once = [CommonTopic::TfStatic, CommonTopic::MembraneMesh].map(common);
        let mut subscribers = Vec::new();
        for (i, topic) in encoder.topics().iter().enumerate().filter(|(_, it)| !it.is_input) {
            for &(ref node, is_reliable, is_latched) in &there {
                let participant = node.participant();
                let qos = Qos { is_reliable, depth: 10, is_latched };
                subscribers.push(Subscriber {
                    what: format!("{}, reliable {is_reliable}, latched {is_latched}", topic.name),
                    reader: reader(&participant, &topic.name, topic.message_type.dds_name, qos),
                    is_compatible: (topic.qos.is_reliable || !is_reliable)
                        && (topic.qos.is_latched || !is_latched),
                    // A best-effort reader receives no kept data.
                    is_served: !once.contains(&i) || (is_reliable && is_latched),
                    is_matched: false,
                    is_rejected: false,
                    n_received: 0,
                });
            }
        }
        // Two of four kinds are compatible with volatile topics, all four with the four latched
        // topics.
        let n_compatible = subscribers.iter().filter(|it| it.is_compatible).count();
        assert_eq!(n_compatible, subscribers.len() / 2 + 2 * 4);
        wait_until("all are matched or rejected", || {
            subscribers.iter_mut().for_each(Subscriber::update);
            subscribers.iter().all(|it| it.is_matched || it.is_rejected)
        });
        for subscriber in &subscribers {
            assert_eq!(
                (subscriber.is_matched, subscriber.is_rejected),
                (subscriber.is_compatible, !subscriber.is_compatible),
                "{}",
                subscriber.what
            );
        }
        let mut tick = 0;
        wait_until("all compatible subscribers have received data", || {
            // Everything is due at the 200th tick.
            tick += 200;
            sink.write(&synthetic::packet(tick)).unwrap();
            subscribers.iter_mut().for_each(Subscriber::update);
            subscribers.iter().all(|it| 0 < it.n_received || !(it.is_compatible && it.is_served))
        });
        for subscriber in subscribers.iter().filter(|it| !it.is_compatible) {
            assert_eq!(subscriber.n_received, 0, "{}", subscriber.what);
        }
        sink.close().unwrap();
    });
}
