//! Services below the node in `ros_discovery_info`, where tools look for them (`ros2 node info`,
//! `ros2 param list`).
//!
//! ros2-client lists the ports that it has made itself, with a writer of its own. Ours says the same with
//! the services added. Who comes late gets what both said last, in no order, so ours is said again
//! for a while after someone has come.

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

/// Time between two looks.
const PERIOD: Duration = Duration::from_millis(200);
/// Looks after which what was said has arrived.
const REPEATS: u32 = 15;

/// What is listed, and where.
pub(super) struct Listed {
    context: Context,
    readers: Vec<GUID>,
    writers: Vec<GUID>,
    mouth: DataWriter<Info, CDRSerializerAdapter<Info, LittleEndian>>,
}

impl Listed {
    /// Lists these ports below the node once `keep_told` runs.
    ///
    /// # Errors
    /// When the writer cannot be made.
    pub(super) fn open(
        node: &RosNode,
        readers: Vec<GUID>,
        writers: Vec<GUID>,
    ) -> Result<Self, RosError> {
        let context = node.context();
        let participant = context.domain_participant();
        let refused = |it: rustdds::dds::result::CreateError| RosError::Topic {
            topic: TOPIC_NAME.to_owned(),
            type_name: TYPE_NAME.to_owned(),
            reason: it.to_string(),
        };
        let topic = participant
            .create_topic(TOPIC_NAME.to_owned(), TYPE_NAME.to_owned(), &QOS_PUB, TopicKind::NoKey)
            .map_err(refused)?;
        let publisher = participant.create_publisher(&QOS_PUB).map_err(refused)?;
        let mouth = publisher.create_datawriter_no_key(&topic, None).map_err(refused)?;
        Ok(Self { context, readers, writers, mouth })
    }

    /// Tells the list whenever it has changed or someone has come.
    pub(super) async fn keep_told(self) {
        let (mut known, mut n_left) = (Vec::new(), REPEATS);
        loop {
            while let Some(status) = self.mouth.try_recv_status() {
                if let DataWriterStatus::PublicationMatched { current, .. } = status
                    && 0 < current.count_change()
                {
                    n_left = REPEATS;
                }
            }
            let theirs = self.context.participant_entities_info();
            if *theirs.nodes() != known {
                (known, n_left) = (theirs.nodes().clone(), REPEATS);
            }
            if 0 < n_left {
                n_left -= 1;
                if let Err(error) = self.mouth.write(self.with_services(&theirs), None) {
                    log::warn!("services are not listed: {error}");
                }
            }
            smol::Timer::after(PERIOD).await;
        }
    }

    /// The same list with the services.
    fn with_services(&self, theirs: &Info) -> Info {
        let mut nodes = theirs.nodes().clone();
        if let Some(node) = nodes.first_mut() {
            self.readers.iter().for_each(|it| node.add_reader((*it).into()));
            self.writers.iter().for_each(|it| node.add_writer((*it).into()));
        }
        Info::new(theirs.gid(), nodes)
    }
}
