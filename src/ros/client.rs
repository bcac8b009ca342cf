//! A DDS client of ROS 2 services, for both mappings of the request identity.

use rustdds::{
    DataReaderStatus, DataWriterStatus, GUID, RTPSEntity, SequenceNumber, StatusEvented,
    WriteOptionsBuilder, rpc::SampleIdentity,
};

use crate::{
    io::server::ServiceSpec,
    ros::service::{Raw, Reader, SERVICE_QOS, Writer, reader, writer},
};
use crate::{
    ros::node::{RosError, RosNode},
    wire::cdr::Cdr,
};

/// A service client for controllers, tools and tests. Only the last request is tracked.
pub struct RosClient {
    requests: Writer,
    responses: Reader,
    mapping: ServiceMapping,
    n_requests: i64,
    /// Number of matched servers: those that read our requests, those whose responses we read.
    n_matched: [i32; 2],
}

/// How a client identifies its requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServiceMapping {
    /// In the sample's related identity, beside the body: rmw_fastrtps, rmw_connextdds.
    Enhanced,
    /// In a header of 16 bytes before the body: rmw_cyclonedds.
    Cyclone,
}

impl RosClient {
    /// Opens a client of the service `spec`.
    ///
    /// # Errors
    /// If the topics of the service cannot be opened.
    pub fn open(
        node: &RosNode,
        spec: &ServiceSpec,
        mapping: ServiceMapping,
    ) -> Result<Self, RosError> {
        let participant = &node.participant();
        let service_type = spec.service_type;
        let (request, response) =
            (format!("rq{}Request", spec.name), format!("rr{}Reply", spec.name));
        Ok(Self {
            responses: reader(participant, &response, service_type.response_dds_name)?,
            requests: writer(participant, &request, service_type.request_dds_name, SERVICE_QOS)?,
            mapping,
            n_requests: 0,
            n_matched: [0; 2],
        })
    }

    /// True once a server is matched in both directions.
    pub fn is_matched(&mut self) -> bool {
        while let Some(status) = self.requests.try_recv_status() {
            if let DataWriterStatus::PublicationMatched { current, .. } = status {
                self.n_matched[0] = current.count();
            }
        }
        while let Some(status) = self.responses.try_recv_status() {
            if let DataReaderStatus::SubscriptionMatched { current, .. } = status {
                self.n_matched[1] = current.count();
            }
        }
        self.n_matched.iter().all(|it| 0 < *it)
    }

    /// Sends a request. Responses to earlier requests are ignored from now on.
    pub fn send(&mut self, body: &Cdr) {
        self.n_requests += 1;
        let guid = self.request_writer_guid();
        let identity = SampleIdentity {
            writer_guid: guid,
            sequence_number: SequenceNumber::from(self.n_requests),
        };
        let (bytes, options) = match self.mapping {
            ServiceMapping::Enhanced => {
                let options = WriteOptionsBuilder::new().related_sample_identity(identity);
                (body.bytes.clone(), options)
            }
            ServiceMapping::Cyclone => {
                ([&self.header()[..], &body.bytes].concat(), WriteOptionsBuilder::new())
            }
        };
        let body = Raw(Cdr { bytes, is_big_endian: false });
        if let Err(error) = self.requests.write_with_options(body, options.build()) {
            log::warn!("the request could not be sent: {error}");
        }
    }

    /// The response to the last request, once it has arrived.
    pub fn take_response(&mut self) -> Option<Cdr> {
        self.responses.drain_read_notifications();
        loop {
            let sample = self.responses.try_take_one().ok()??;
            let related = sample.related_sample_identity();
            let body = sample.into_value().0;
            match self.mapping {
                ServiceMapping::Enhanced => {
                    let is_mine = related.is_some_and(|it| {
                        i64::from(it.sequence_number) == self.n_requests
                            && it.writer_guid == self.request_writer_guid()
                    });
                    if is_mine {
                        return Some(body);
                    }
                }
                ServiceMapping::Cyclone => {
                    if let Some(rest) = body.bytes.strip_prefix(&self.header()[..]) {
                        return Some(Cdr { bytes: rest.to_vec(), ..body });
                    }
                }
            }
        }
    }

    fn request_writer_guid(&self) -> GUID {
        self.requests.guid()
    }

    fn header(&self) -> [u8; 16] {
        let mut header = [0; 16];
        header[..8].copy_from_slice(&self.request_writer_guid().to_bytes()[8..]);
        let [a, b, c, d, e, f, g, h] = self.n_requests.to_le_bytes();
        // The high half of the number comes first.
        header[8..].copy_from_slice(&[e, f, g, h, a, b, c, d]);
        header
    }
}
