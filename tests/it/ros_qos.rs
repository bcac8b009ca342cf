//! Quality of service: who hears what, for each topic and each kind of subscriber.

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
    private_network::{inside, reach},
    ros_program::wait_until,
    synthetic,
};

/// A subscriber of one kind, and what has become of it.
struct Ear {
    what: String,
    reader: SimpleDataReader<Raw, RawCdr>,
    /// DDS: what is requested must not be more than what is offered.
    is_entitled: bool,
    /// It must get data, since some are published after it has come or are kept for it.
    is_served: bool,
    is_matched: bool,
    is_refused: bool,
    n_heard: usize,
}

impl Ear {
    fn look(&mut self) {
        while let Some(status) = self.reader.try_recv_status() {
            match status {
                DataReaderStatus::SubscriptionMatched { current, .. } => {
                    self.is_matched = 0 < current.count();
                }
                DataReaderStatus::RequestedIncompatibleQos { .. } => self.is_refused = true,
                _ => {}
            }
        }
        self.reader.drain_read_notifications();
        while let Ok(Some(_)) = self.reader.try_take_one() {
            self.n_heard += 1;
        }
    }
}

fn reader(
    participant: &DomainParticipant,
    name: &str,
    kind: &str,
    qos: Qos,
) -> SimpleDataReader<Raw, RawCdr> {
    let qos = policies(qos);
    let topic = participant
        .create_topic(format!("rt{name}"), kind.to_owned(), &qos, TopicKind::NoKey)
        .unwrap();
    let subscriber = participant.create_subscriber(&qos).unwrap();
    subscriber.create_simple_datareader_no_key(&topic, Some(qos)).unwrap()
}

/// Oracle: the rules of DDS for what is requested and offered (reliable is more than best effort,
/// transient local more than volatile), worked out here; and the table of topics: everything is
/// offered reliable, what is latched is offered transient local.
#[test]
fn each_topic_reaches_each_kind_of_subscriber_that_may_hear_it() {
    inside("ros_qos::each_topic_reaches_each_kind_of_subscriber_that_may_hear_it", || {
        let here = RosNode::join(&reach()).unwrap();
        // Each kind is a participant of its own, because what reaches one reader of a participant may
        // be given to its neighbours.
        let kinds = [(true, true), (true, false), (false, true), (false, false)];
        let there = kinds.map(|(is_reliable, is_latched)| {
            let name = format!("reliable_{is_reliable}_latched_{is_latched}");
            (RosNode::join_as(&name, &reach()).unwrap(), is_reliable, is_latched)
        });
        let encoder = synthetic::encoder();
        let mut sink = RosSink::new(&here, &encoder).unwrap();
        // Sent before anyone is there, and never again.
        let once = [CommonTopic::TfStatic, CommonTopic::MembraneMesh].map(common);
        let mut ears = Vec::new();
        for (i, topic) in encoder.topics().iter().enumerate().filter(|(_, it)| !it.is_input) {
            for &(ref node, is_reliable, is_latched) in &there {
                let participant = node.participant();
                let qos = Qos { is_reliable, depth: 10, is_latched };
                ears.push(Ear {
                    what: format!("{}, reliable {is_reliable}, latched {is_latched}", topic.name),
                    reader: reader(&participant, &topic.name, topic.message_type.dds_name, qos),
                    is_entitled: (topic.qos.is_reliable || !is_reliable)
                        && (topic.qos.is_latched || !is_latched),
                    // A best-effort reader is sent nothing that was kept.
                    is_served: !once.contains(&i) || (is_reliable && is_latched),
                    is_matched: false,
                    is_refused: false,
                    n_heard: 0,
                });
            }
        }
        // Two kinds of four may hear what is volatile, all four the four topics that are latched.
        let n_entitled = ears.iter().filter(|it| it.is_entitled).count();
        assert_eq!(n_entitled, ears.len() / 2 + 2 * 4);
        wait_until("all are matched or refused", || {
            ears.iter_mut().for_each(Ear::look);
            ears.iter().all(|it| it.is_matched || it.is_refused)
        });
        for ear in &ears {
            assert_eq!(
                (ear.is_matched, ear.is_refused),
                (ear.is_entitled, !ear.is_entitled),
                "{}",
                ear.what
            );
        }
        let mut tick = 0;
        wait_until("all who may hear have heard", || {
            // At the 200th tick everything is due.
            tick += 200;
            sink.write(&synthetic::packet(tick)).unwrap();
            ears.iter_mut().for_each(Ear::look);
            ears.iter().all(|it| 0 < it.n_heard || !(it.is_entitled && it.is_served))
        });
        for ear in ears.iter().filter(|it| !it.is_entitled) {
            assert_eq!(ear.n_heard, 0, "{}", ear.what);
        }
        sink.close().unwrap();
    });
}
