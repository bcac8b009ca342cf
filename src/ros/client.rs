//! A client of services on DDS, in either of the two ways in which clients name their requests.

use rustdds::{
    DataReaderStatus, DataWriterStatus, GUID, RTPSEntity, SequenceNumber, StatusEvented,
    WriteOptionsBuilder, rpc::SampleIdentity,
};

use crate::{
    io::server::ServiceSpec,
    ros::service::{Raw, Reader, SERVICE, Writer, reader, writer},
};
use crate::{
    ros::node::{RosError, RosNode},
    wire::cdr::Cdr,
};

/// A client: for controllers, tools and tests. It has one question open at a time.
pub struct RosClient {
    asks: Writer,
    answers: Reader,
    way: Way,
    n_received: i64,
    /// Servers that hear and that are heard.
    n_matched: [i32; 2],
}

/// How a client names its requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Beside the body: rmw_fastrtps, rmw_connextdds.
    Enhanced,
    /// In sixteen bytes before the body: rmw_cyclonedds.
    Cyclone,
}

impl RosClient {
    /// A client of `offer`.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn open(node: &RosNode, offer: &ServiceSpec, way: Way) -> Result<Self, RosError> {
        let participant = &node.participant();
        let of = offer.service_type;
        let (ask, answer) = (format!("rq{}Request", offer.name), format!("rr{}Reply", offer.name));
        Ok(Self {
            answers: reader(participant, &answer, of.response_dds_name)?,
            asks: writer(participant, &ask, of.request_dds_name, SERVICE)?,
            way,
            n_received: 0,
            n_matched: [0; 2],
        })
    }

    /// True once a server has been found that hears and is heard.
    pub fn is_matched(&mut self) -> bool {
        while let Some(status) = self.asks.try_recv_status() {
            if let DataWriterStatus::PublicationMatched { current, .. } = status {
                self.n_matched[0] = current.count();
            }
        }
        while let Some(status) = self.answers.try_recv_status() {
            if let DataReaderStatus::SubscriptionMatched { current, .. } = status {
                self.n_matched[1] = current.count();
            }
        }
        self.n_matched.iter().all(|it| 0 < *it)
    }

    /// Asks. Answers to questions before are not waited for any more.
    pub fn ask(&mut self, body: &Cdr) {
        self.n_received += 1;
        let guid = self.asks_guid();
        let identity = SampleIdentity {
            writer_guid: guid,
            sequence_number: SequenceNumber::from(self.n_received),
        };
        let (bytes, options) = match self.way {
            Way::Enhanced => {
                let options = WriteOptionsBuilder::new().related_sample_identity(identity);
                (body.bytes.clone(), options)
            }
            Way::Cyclone => {
                ([&self.header()[..], &body.bytes].concat(), WriteOptionsBuilder::new())
            }
        };
        let body = Raw(Cdr { bytes, is_big_endian: false });
        if let Err(error) = self.asks.write_with_options(body, options.build()) {
            log::warn!("a request was not taken: {error}");
        }
    }

    /// The answer to the last question, once it is there.
    pub fn answer(&mut self) -> Option<Cdr> {
        self.answers.drain_read_notifications();
        loop {
            let sample = self.answers.try_take_one().ok()??;
            let related = sample.related_sample_identity();
            let body = sample.into_value().0;
            match self.way {
                Way::Enhanced => {
                    let is_mine = related.is_some_and(|it| {
                        i64::from(it.sequence_number) == self.n_received
                            && it.writer_guid == self.asks_guid()
                    });
                    if is_mine {
                        return Some(body);
                    }
                }
                Way::Cyclone => {
                    if let Some(rest) = body.bytes.strip_prefix(&self.header()[..]) {
                        return Some(Cdr { bytes: rest.to_vec(), ..body });
                    }
                }
            }
        }
    }

    fn asks_guid(&self) -> GUID {
        self.asks.guid()
    }

    fn header(&self) -> [u8; 16] {
        let mut header = [0; 16];
        header[..8].copy_from_slice(&self.asks_guid().to_bytes()[8..]);
        let [a, b, c, d, e, f, g, h] = self.n_received.to_le_bytes();
        // The high half of the number comes first.
        header[8..].copy_from_slice(&[e, f, g, h, a, b, c, d]);
        header
    }
}
