//! ROS 2 service servers on plain DDS, so that clients with either mapping of the request identity
//! are served at the same time: Fast DDS, Connext and RustDDS send it beside the body, Cyclone DDS
//! in a header of 16 bytes before the body. The sample and the vendor of its writer determine which
//! mapping the client uses.

use std::{
    collections::BTreeSet,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc},
    thread::JoinHandle,
    time::Duration,
};

use rustdds::{
    DataWriterStatus, DomainParticipant, GUID, QosPolicies, RTPSEntity, RepresentationIdentifier,
    SequenceNumber, StatusEvented, TopicKind, WriteOptionsBuilder,
    bytes::Bytes,
    no_key::{self, DataWriter, SimpleDataReader},
    rpc::SampleIdentity,
};
use smol::{future, stream::StreamExt};

pub use super::client::{RosClient, ServiceMapping};
use crate::{
    io::published::PublishedUpTo,
    ros::node::{RosError, RosNode, policies},
    wire::{cdr::Cdr, topics::Qos},
};
use crate::{
    io::{
        request_queue::RequestQueue,
        server::{
            Outgoing, RequestId, ServerCounters, ServiceRequest, ServiceServer, ServiceSpec,
            TopicSpec,
        },
    },
    ros::{discovery_info::DiscoveryInfo, worker::Worker},
};

/// Vendor bytes at the start of every GUID that Cyclone DDS creates.
const CYCLONE_VENDOR: [u8; 2] = [0x01, 0x10];
/// Longest time that a response waits for the messages of its tick.
const PUBLISH_TIMEOUT: Duration = Duration::from_secs(1);
/// Responses that can wait to be sent; further ones are dropped.
const OUTBOX_DEPTH: usize = 4096;

/// Longest time to wait on shutdown for the acknowledgment of the last responses.
const ACK_TIMEOUT: Duration = Duration::from_secs(2);
/// Time that the writers then stay open, so that clients can take the responses.
const SHUTDOWN_GRACE: Duration = Duration::from_millis(200);

/// Number of polls for a client's response reader to be matched.
const N_MATCH_POLLS: usize = 40;
/// Time between two polls.
const MATCH_POLL_PERIOD: Duration = Duration::from_millis(5);
/// Largest number of clients without a matched reader to remember, so as not to wait for them again.
const UNMATCHED_MAX: usize = 1000;

/// A message body with its byte order.
#[derive(Clone, Debug)]
pub struct Raw(pub(super) Cdr);

/// The adapter that passes bodies through unchanged.
#[derive(Clone, Copy, Debug)]
pub struct RawCdr;

/// The error of an adapter that cannot fail: it only copies bytes.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("copying bytes cannot fail")]
pub struct Never;

impl no_key::DeserializerAdapter<Raw> for RawCdr {
    type Error = Never;
    type Decoded = Raw;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[RepresentationIdentifier::CDR_LE, RepresentationIdentifier::CDR_BE]
    }

    fn transform_decoded(decoded: Raw) -> Raw {
        decoded
    }
}

impl no_key::DefaultDecoder<Raw> for RawCdr {
    type Decoder = Self;
    const DECODER: Self = Self;
}

impl<'de> no_key::Decode<'de, Raw> for RawCdr {
    type Error = Never;

    fn decode_bytes(
        self,
        bytes: &'de [u8],
        encoding: RepresentationIdentifier,
    ) -> Result<Raw, Never> {
        let is_big_endian = encoding == RepresentationIdentifier::CDR_BE;
        Ok(Raw(Cdr { bytes: bytes.to_vec(), is_big_endian }))
    }
}

impl no_key::SerializerAdapter<Raw> for RawCdr {
    type Error = Never;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(value: &Raw) -> Result<Bytes, Never> {
        Ok(Bytes::copy_from_slice(&value.0.bytes))
    }
}

pub(super) type Reader = SimpleDataReader<Raw, RawCdr>;
pub(super) type Writer = DataWriter<Raw, RawCdr>;

/// The request queue, shared with the thread that reads requests.
#[derive(Default)]
struct SharedQueue {
    queue: Mutex<RequestQueue>,
    arrived: Condvar,
}

/// All services of a node.
pub struct RosServiceServer {
    requests: Arc<SharedQueue>,
    outbox: Option<mpsc::SyncSender<(Outgoing, u64)>>,
    reader: Option<Worker>,
    writer: Option<JoinHandle<()>>,
}

impl RosServiceServer {
    /// Opens all services and topics, and lists them in `ros_discovery_info`. A response is sent
    /// once `published` has reached its packet.
    ///
    /// # Errors
    /// If a service or topic cannot be opened.
    pub fn open(
        node: &RosNode,
        services: &[ServiceSpec],
        topics: &[TopicSpec],
        published: &Arc<PublishedUpTo>,
    ) -> Result<Self, RosError> {
        let participant = &node.participant();
        let mut request_readers = Vec::new();
        let (mut response_writers, mut topic_writers) = (Vec::new(), Vec::new());
        for ServiceSpec { name, service_type } in services {
            let (request, response) = (format!("rq{name}Request"), format!("rr{name}Reply"));
            request_readers.push(reader(participant, &request, service_type.request_dds_name)?);
            let type_name = service_type.response_dds_name;
            let writer = writer(participant, &response, type_name, SERVICE_QOS)?;
            response_writers.push((writer, BTreeSet::new()));
        }
        for topic in topics {
            let qos = Qos { is_reliable: true, depth: 10, is_latched: topic.is_latched };
            let name = format!("rt{}", topic.name);
            topic_writers.push(writer(participant, &name, &topic.dds_name, qos)?);
        }
        let response_guids = response_writers.iter().map(|(writer, _)| writer.guid());
        let info = DiscoveryInfo::open(
            node,
            request_readers.iter().map(RTPSEntity::guid).collect(),
            response_guids.chain(topic_writers.iter().map(RTPSEntity::guid)).collect(),
        )?;
        let mut writers = Writers {
            responses: response_writers,
            topics: topic_writers,
            unmatched_clients: BTreeSet::new(),
        };
        let requests = Arc::new(SharedQueue::default());
        let (outbox, outgoing) = mpsc::sync_channel(OUTBOX_DEPTH);
        let (queue, published) = (Arc::clone(&requests), Arc::clone(published));
        let reader = Worker::start("ros-requests", move |executor| {
            executor.spawn(info.run()).detach();
            for (service, reader) in request_readers.into_iter().enumerate() {
                executor.spawn(read_requests(service, reader, Arc::clone(&queue))).detach();
            }
            executor.spawn(log_malformed(queue)).detach();
        })?;
        let writer = std::thread::Builder::new()
            .name("ros-responses".to_owned())
            .spawn(move || writers.run(&outgoing, &published))
            .map_err(|reason| RosError::Thread { reason })?;
        Ok(Self { requests, outbox: Some(outbox), reader: Some(reader), writer: Some(writer) })
    }
}

impl ServiceServer for RosServiceServer {
    fn take(&mut self, n_max: usize) -> Vec<ServiceRequest> {
        lock(&self.requests.queue).take(n_max)
    }

    fn wait(&mut self, timeout: Duration) {
        let queue = lock(&self.requests.queue);
        let is_empty = |queue: &mut RequestQueue| queue.is_empty();
        let waited = self.requests.arrived.wait_timeout_while(queue, timeout, is_empty);
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }

    fn send(&mut self, outgoing: Outgoing, after_packet: u64) {
        if let Some(outbox) = &self.outbox {
            // The outbox is full only if responses are stuck; the physics does not wait for them.
            drop(outbox.try_send((outgoing, after_packet)));
        }
    }

    fn report_malformed(&mut self, error: String) {
        lock(&self.requests.queue).report_malformed(error);
    }

    fn counters(&self) -> ServerCounters {
        lock(&self.requests.queue).counters()
    }
}

impl Drop for RosServiceServer {
    fn drop(&mut self) {
        self.reader = None;
        // Closing the outbox ends the writer thread.
        self.outbox = None;
        if let Some(writer) = self.writer.take() {
            // A thread that panicked has nothing left to stop.
            drop(writer.join());
        }
    }
}

/// All DDS writers: of responses and of topics.
struct Writers {
    /// For each service, the writer of its responses and the readers matched with it.
    responses: Vec<(Writer, BTreeSet<[u8; 16]>)>,
    topics: Vec<Writer>,
    /// Participants whose response reader was not matched in time.
    unmatched_clients: BTreeSet<[u8; 12]>,
}

impl Writers {
    /// Waits a moment until the client's response reader is matched, because a reader may be
    /// discovered later than the first request arrives.
    fn wait_for_match(&mut self, request: &RequestId) {
        let (writer, matched_readers) = &mut self.responses[request.service];
        let mut participant = [0; 12];
        participant.copy_from_slice(&request.writer[..12]);
        let n_polls = if self.unmatched_clients.contains(&participant) { 1 } else { N_MATCH_POLLS };
        for _ in 0..n_polls {
            while let Some(status) = writer.try_recv_status() {
                if let DataWriterStatus::PublicationMatched { current, reader, .. } = status {
                    if 0 < current.count_change() {
                        matched_readers.insert(reader.to_bytes());
                    } else {
                        matched_readers.remove(&reader.to_bytes());
                    }
                }
            }
            // A client's reader and writer belong to one participant, so 12 bytes are equal.
            if matched_readers.iter().any(|reader| reader[..12] == participant) {
                self.unmatched_clients.remove(&participant);
                return;
            }
            std::thread::sleep(MATCH_POLL_PERIOD);
        }
        if UNMATCHED_MAX <= self.unmatched_clients.len() {
            self.unmatched_clients.clear();
        }
        self.unmatched_clients.insert(participant);
    }

    fn run(&mut self, outbox: &mpsc::Receiver<(Outgoing, u64)>, published: &PublishedUpTo) {
        let mut has_written = false;
        while let Ok((outgoing, after_packet)) = outbox.recv() {
            has_written = true;
            published.wait_for(after_packet, PUBLISH_TIMEOUT);
            let result = match outgoing {
                Outgoing::Response(request, body) => {
                    self.wait_for_match(&request);
                    let (body, options) = addressed(&request, body);
                    let (writer, _) = &self.responses[request.service];
                    writer.write_with_options(Raw(body), options).map(drop)
                }
                Outgoing::Message(topic, body) => self.topics[topic].write(Raw(body), None),
            };
            if let Err(error) = result {
                log::warn!("a response could not be sent: {error}; is its reader stopped?");
            }
        }
        if has_written {
            self.drain();
        }
    }

    /// Waits until the last responses are acknowledged. Samples that are not acknowledged are lost
    /// with their writer. Some readers, such as those of RustDDS, even lose samples that they have
    /// received but not yet handed out.
    fn drain(&self) {
        let is_acknowledged = |(writer, _): &(Writer, _)| {
            writer
                .wait_for_acknowledgments(ACK_TIMEOUT)
                .is_ok_and(|is_acknowledged| is_acknowledged)
        };
        if !self.responses.iter().all(is_acknowledged) {
            log::warn!(
                "the last responses were not acknowledged within {ACK_TIMEOUT:?}; are their \
                 readers stopped?"
            );
        }
        std::thread::sleep(SHUTDOWN_GRACE);
    }
}

/// The body and the write options that address a response to its request.
fn addressed(request: &RequestId, body: Cdr) -> (Cdr, rustdds::with_key::WriteOptions) {
    let options = WriteOptionsBuilder::new().related_sample_identity(SampleIdentity {
        writer_guid: GUID::from_bytes(request.writer),
        sequence_number: SequenceNumber::from(request.number),
    });
    let body = match request.header {
        Some(header) => Cdr { bytes: [&header[..], &body.bytes].concat(), ..body },
        None => body,
    };
    (body, options.build())
}

/// Reads the requests of one service into the queue.
async fn read_requests(service: usize, reader: Reader, requests: Arc<SharedQueue>) {
    let queue = &requests.queue;
    let mut samples = std::pin::pin!(reader.as_async_stream());
    while let Some(sample) = samples.next().await {
        match sample {
            Ok(sample) => {
                let id = (sample.writer_guid(), i64::from(sample.sequence_number));
                let related = sample.related_sample_identity();
                let related = related.map(|it| (it.writer_guid, i64::from(it.sequence_number)));
                match request(service, id, related, sample.into_value().0) {
                    Some(request) => {
                        lock(queue).push(request);
                        requests.arrived.notify_all();
                    }
                    None => lock(queue).report_malformed("a request without a body".to_owned()),
                }
            }
            Err(error) => lock(queue).report_malformed(error.to_string()),
        }
        // A flood on one service must not starve the others.
        future::yield_now().await;
    }
}

/// The request in a received sample: `id` is the sample's own writer and sequence number,
/// `related` its related identity. Returns nothing if the header is incomplete.
fn request(
    service: usize,
    id: (GUID, i64),
    related: Option<(GUID, i64)>,
    body: Cdr,
) -> Option<ServiceRequest> {
    let writer = id.0.to_bytes();
    // Other clients with Cyclone's mapping also begin with half of their writer's GUID.
    let has_header = related.is_none()
        && (writer[..2] == CYCLONE_VENDOR || body.bytes.starts_with(&writer[8..]));
    let (header, body) = if has_header {
        let (header, rest) = body.bytes.split_first_chunk::<16>()?;
        (Some(*header), Cdr { bytes: rest.to_vec(), ..body })
    } else {
        (None, body)
    };
    // Fast DDS names the reader that the response is for, and leaves the number unknown.
    let (writer, number) = related.unwrap_or(id);
    let number = if number == i64::from(SequenceNumber::UNKNOWN) { id.1 } else { number };
    let id = RequestId { service, writer: writer.to_bytes(), number, header };
    Some(ServiceRequest { id, body })
}

/// Logs the last malformed request, at most once a second.
async fn log_malformed(requests: Arc<SharedQueue>) {
    loop {
        smol::Timer::after(Duration::from_secs(1)).await;
        let (counters, error) = {
            let mut queue = lock(&requests.queue);
            (queue.counters(), queue.take_error())
        };
        if let Some(error) = error {
            let n = counters.n_malformed;
            log::warn!("{n} malformed requests so far, the last: {error}");
        }
    }
}

/// Quality of service of requests and responses.
pub(super) const SERVICE_QOS: Qos = Qos::reliable(100);

pub(super) fn reader(
    participant: &DomainParticipant,
    name: &str,
    type_name: &str,
) -> Result<Reader, RosError> {
    let qos: QosPolicies = policies(SERVICE_QOS);
    let to_error = |it: rustdds::dds::result::CreateError| to_error(name, type_name, &it);
    let topic = participant
        .create_topic(name.to_owned(), type_name.to_owned(), &qos, TopicKind::NoKey)
        .map_err(to_error)?;
    let subscriber = participant.create_subscriber(&qos).map_err(to_error)?;
    subscriber.create_simple_datareader_no_key(&topic, Some(qos)).map_err(to_error)
}

pub(super) fn writer(
    participant: &DomainParticipant,
    name: &str,
    type_name: &str,
    qos: Qos,
) -> Result<Writer, RosError> {
    let qos: QosPolicies = policies(qos);
    let to_error = |it: rustdds::dds::result::CreateError| to_error(name, type_name, &it);
    let topic = participant
        .create_topic(name.to_owned(), type_name.to_owned(), &qos, TopicKind::NoKey)
        .map_err(to_error)?;
    let publisher = participant.create_publisher(&qos).map_err(to_error)?;
    publisher.create_datawriter_no_key(&topic, Some(qos)).map_err(to_error)
}

fn to_error(name: &str, type_name: &str, reason: &dyn std::fmt::Display) -> RosError {
    RosError::Topic {
        topic: name.to_owned(),
        type_name: type_name.to_owned(),
        reason: reason.to_string(),
    }
}

/// Locks the queue. It stays usable after a panic, because every call leaves it consistent.
fn lock(queue: &Mutex<RequestQueue>) -> MutexGuard<'_, RequestQueue> {
    queue.lock().unwrap_or_else(PoisonError::into_inner)
}
