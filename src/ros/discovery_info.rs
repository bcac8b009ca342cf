//! Lists the services in `ros_discovery_info`, where tools such as `ros2 node info` and `ros2 param
//! list` look for them.
//!
//! ros2-client publishes the readers and writers that it has created, with a writer of its own.
//! This writer publishes the same list with the services added. A late joiner receives the last
//! sample of both, in any order, so this one is published again for a while after a reader has
//! joined.

use std::time::Duration;

use byteorder::LittleEndian;
use ros2_client::{
    Context,
    builtin_topics::ros_discovery::{QOS_PUB, TOPIC_NAME, TYPE_NAME},
    entities_info::ParticipantEntitiesInfo,
};
use rustdds::{
    CDRSerializerAdapter, DataWriterStatus, GUID, StatusEvented, TopicKind, no_key::DataWriter,
};

use crate::ros::node::{RosError, RosNode};

type Info = ParticipantEntitiesInfo;

/// Time between two checks for changes and new readers.
const CHECK_PERIOD: Duration = Duration::from_millis(200);
/// How often the list is published after a change; by then it has arrived.
const N_REPEATS: u32 = 15;

/// The readers and writers to list, and the writer that publishes them.
pub(super) struct DiscoveryInfo {
    context: Context,
    readers: Vec<GUID>,
    writers: Vec<GUID>,
    writer: DataWriter<Info, CDRSerializerAdapter<Info, LittleEndian>>,
}

impl DiscoveryInfo {
    /// Lists these readers and writers as part of the node while `run` runs.
    ///
    /// # Errors
    /// If the writer cannot be created.
    pub(super) fn open(
        node: &RosNode,
        readers: Vec<GUID>,
        writers: Vec<GUID>,
    ) -> Result<Self, RosError> {
        let context = node.context();
        let participant = context.domain_participant();
        let to_error = |it: rustdds::dds::result::CreateError| RosError::Topic {
            topic: TOPIC_NAME.to_owned(),
            type_name: TYPE_NAME.to_owned(),
            reason: it.to_string(),
        };
        let topic = participant
            .create_topic(TOPIC_NAME.to_owned(), TYPE_NAME.to_owned(), &QOS_PUB, TopicKind::NoKey)
            .map_err(to_error)?;
        let publisher = participant.create_publisher(&QOS_PUB).map_err(to_error)?;
        let writer = publisher.create_datawriter_no_key(&topic, None).map_err(to_error)?;
        Ok(Self { context, readers, writers, writer })
    }

    /// Publishes the list whenever it changes or a reader joins.
    pub(super) async fn run(self) {
        let (mut known, mut n_left) = (Vec::new(), N_REPEATS);
        loop {
            while let Some(status) = self.writer.try_recv_status() {
                if let DataWriterStatus::PublicationMatched { current, .. } = status
                    && 0 < current.count_change()
                {
                    n_left = N_REPEATS;
                }
            }
            let published = self.context.participant_entities_info();
            if *published.nodes() != known {
                (known, n_left) = (published.nodes().clone(), N_REPEATS);
            }
            if 0 < n_left {
                n_left -= 1;
                if let Err(error) = self.writer.write(self.with_services(&published), None) {
                    log::warn!("services are not listed in `{TOPIC_NAME}`: {error}");
                }
            }
            smol::Timer::after(CHECK_PERIOD).await;
        }
    }

    /// The published list with the services added.
    fn with_services(&self, published: &Info) -> Info {
        let mut nodes = published.nodes().clone();
        if let Some(node) = nodes.first_mut() {
            self.readers.iter().for_each(|it| node.add_reader((*it).into()));
            self.writers.iter().for_each(|it| node.add_writer((*it).into()));
        }
        Info::new(published.gid(), nodes)
    }
}
