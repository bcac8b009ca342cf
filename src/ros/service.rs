//! ROS 2 services on bare DDS, so that clients of both ways of carrying a request's identity are
//! served at once: Fast DDS, Connext and RustDDS name it beside the body, Cyclone puts sixteen bytes
//! before it. Which way a client goes is told by what it sends and by whose software it is.

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
use smol::{LocalExecutor, channel, future, stream::StreamExt};

pub use super::client::{RosClient, Way};
use crate::{
    io::published::PublishedUpTo,
    ros::node::{RosError, RosNode, policies},
    wire::{cdr::Cdr, topics::Qos},
};
use crate::{
    io::{
        request_queue::Queue,
        server::{
            Outgoing, RequestId, ServerCounters, ServiceRequest, ServiceServer, ServiceSpec,
            TopicSpec,
        },
    },
    ros::discovery_info::Listed,
};

/// First bytes of the identity of everything that Cyclone DDS makes.
const CYCLONE: [u8; 2] = [0x01, 0x10];
/// Longest time that an answer stays behind its tick's messages.
const TIMEOUT: Duration = Duration::from_secs(1);
/// Answers that wait for their turn; a client that does not read them loses them.
const OUTBOX: usize = 4096;

/// Longest time that one who leaves waits until its last answers have arrived, and the time that it
/// then stays for them to be read.
const ACK_TIMEOUT: Duration = Duration::from_secs(2);
const SHUTDOWN_GRACE: Duration = Duration::from_millis(200);

/// How often is looked for a client's ears, and how long between two looks.
const HEARING_TRIES: usize = 40;
const MATCH_POLL_PERIOD: Duration = Duration::from_millis(5);
/// Clients without ears that are remembered, so that nobody waits for them again.
const UNMATCHED_MAX: usize = 1000;

/// A body with its byte order.
#[derive(Clone, Debug)]
pub struct Raw(pub(super) Cdr);

/// Bytes in, bytes out.
#[derive(Clone, Copy, Debug)]
pub struct RawCdr;

/// Nothing can go wrong in copying bytes.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("cannot happen")]
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

/// The queue, and news of it.
#[derive(Default)]
struct Waiting {
    queue: Mutex<Queue>,
    news: Condvar,
}

/// All services of a node.
pub struct RosServiceServer {
    waiting: Arc<Waiting>,
    outbox: Option<mpsc::SyncSender<(Outgoing, u64)>>,
    stop: channel::Sender<()>,
    threads: Vec<JoinHandle<()>>,
}

impl RosServiceServer {
    /// Opens all services and channels, and lists them below the node. Answers stay behind what `published` counts.
    ///
    /// # Errors
    /// When one cannot be opened.
    pub fn open(
        node: &RosNode,
        offers: &[ServiceSpec],
        channels: &[TopicSpec],
        published: &Arc<PublishedUpTo>,
    ) -> Result<Self, RosError> {
        let participant = &node.participant();
        let queue = Arc::new(Waiting::default());
        let mut readers = Vec::new();
        let (mut answers, mut mouths_of_channels) = (Vec::new(), Vec::new());
        for offer in offers {
            let (ask, answer) =
                (format!("rq{}Request", offer.name), format!("rr{}Reply", offer.name));
            let of = offer.service_type;
            readers.push(reader(participant, &ask, of.request_dds_name)?);
            let mouth = writer(participant, &answer, of.response_dds_name, SERVICE)?;
            answers.push((mouth, BTreeSet::new()));
        }
        for channel in channels {
            let qos = Qos { is_reliable: true, depth: 10, is_latched: channel.is_latched };
            let name = format!("rt{}", channel.name);
            mouths_of_channels.push(writer(participant, &name, &channel.dds_name, qos)?);
        }
        let listed = Listed::open(
            node,
            readers.iter().map(RTPSEntity::guid).collect(),
            answers
                .iter()
                .map(|it| it.0.guid())
                .chain(mouths_of_channels.iter().map(RTPSEntity::guid))
                .collect(),
        )?;
        let mut writers = Writers { answers, channels: mouths_of_channels, deaf: BTreeSet::new() };
        let (stop, stopped) = channel::bounded(1);
        let (outbox, waiting) = mpsc::sync_channel(OUTBOX);
        let (kept, published) = (Arc::clone(&queue), Arc::clone(published));
        let threads = vec![
            thread("ros-questions", move || listen(readers, listed, &kept, &stopped))?,
            thread("ros-answers", move || writers.run(&waiting, &published))?,
        ];
        Ok(Self { waiting: queue, outbox: Some(outbox), stop, threads })
    }
}

impl ServiceServer for RosServiceServer {
    fn take(&mut self, most: usize) -> Vec<ServiceRequest> {
        lock(&self.waiting.queue).take(most)
    }

    fn wait(&mut self, at_most: Duration) {
        let queue = lock(&self.waiting.queue);
        let is_empty = |queue: &mut Queue| queue.is_empty();
        let waited = self.waiting.news.wait_timeout_while(queue, at_most, is_empty);
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }

    fn send(&mut self, outgoing: Outgoing, after_packet: u64) {
        if let Some(outbox) = &self.outbox {
            // Full only if nothing leaves any more; the physics does not wait for that.
            drop(outbox.try_send((outgoing, after_packet)));
        }
    }

    fn report_malformed(&mut self, fault: String) {
        lock(&self.waiting.queue).report_malformed(fault);
    }

    fn counters(&self) -> ServerCounters {
        lock(&self.waiting.queue).counters()
    }
}

impl Drop for RosServiceServer {
    fn drop(&mut self) {
        self.stop.close();
        self.outbox = None;
        for thread in self.threads.drain(..) {
            // A thread that panicked has nothing left to stop.
            drop(thread.join());
        }
    }
}

/// Everything that answers leave by.
struct Writers {
    /// For each offer the writer of its answers and the readers that hear it.
    answers: Vec<(Writer, BTreeSet<[u8; 16]>)>,
    channels: Vec<Writer>,
    /// Participants that asked and were not found to hear.
    deaf: BTreeSet<[u8; 12]>,
}

impl Writers {
    /// Waits a moment until the one who asked can hear: an ear may be found later than a question.
    fn find(&mut self, asker: &RequestId) {
        let (writer, ears) = &mut self.answers[asker.offer];
        let mut participant = [0; 12];
        participant.copy_from_slice(&asker.writer[..12]);
        let n_tries = if self.deaf.contains(&participant) { 1 } else { HEARING_TRIES };
        for _ in 0..n_tries {
            while let Some(status) = writer.try_recv_status() {
                if let DataWriterStatus::PublicationMatched { current, reader, .. } = status {
                    if 0 < current.count_change() {
                        ears.insert(reader.to_bytes());
                    } else {
                        ears.remove(&reader.to_bytes());
                    }
                }
            }
            // Ears and mouth of a client are of one participant: twelve bytes are the same.
            if ears.iter().any(|ear| ear[..12] == participant) {
                self.deaf.remove(&participant);
                return;
            }
            std::thread::sleep(MATCH_POLL_PERIOD);
        }
        if UNMATCHED_MAX <= self.deaf.len() {
            self.deaf.clear();
        }
        self.deaf.insert(participant);
    }

    fn run(&mut self, waiting: &mpsc::Receiver<(Outgoing, u64)>, published: &PublishedUpTo) {
        let mut has_spoken = false;
        while let Ok((outgoing, after_packet)) = waiting.recv() {
            has_spoken = true;
            published.wait_for(after_packet, TIMEOUT);
            let said = match outgoing {
                Outgoing::Response(asker, body) => {
                    self.find(&asker);
                    let (body, options) = addressed(&asker, body);
                    self.answers[asker.offer].0.write_with_options(Raw(body), options).map(drop)
                }
                Outgoing::Message(channel, body) => self.channels[channel].write(Raw(body), None),
            };
            if let Err(error) = said {
                log::warn!("an answer was not taken: {error}; is its reader stopped?");
            }
        }
        if has_spoken {
            self.drain();
        }
    }

    /// Waits until the last answers are with those who asked. What is still on its way goes with its
    /// writer; some readers (those of RustDDS) even lose what they hold and have not handed out.
    fn drain(&self) {
        let has_arrived = |(writer, _): &(Writer, _)| {
            writer.wait_for_acknowledgments(ACK_TIMEOUT).is_ok_and(|has_arrived| has_arrived)
        };
        if !self.answers.iter().all(has_arrived) {
            log::warn!(
                "the last answers did not arrive in {ACK_TIMEOUT:?}; did their readers stop?"
            );
        }
        std::thread::sleep(SHUTDOWN_GRACE);
    }
}

/// An answer with what leads it back to its asker.
fn addressed(asker: &RequestId, body: Cdr) -> (Cdr, rustdds::with_key::WriteOptions) {
    let options = WriteOptionsBuilder::new().related_sample_identity(SampleIdentity {
        writer_guid: GUID::from_bytes(asker.writer),
        sequence_number: SequenceNumber::from(asker.number),
    });
    let body = match asker.header {
        Some(header) => Cdr { bytes: [&header[..], &body.bytes].concat(), ..body },
        None => body,
    };
    (body, options.build())
}

/// Listens to all services until `stopped` closes.
fn listen(
    readers: Vec<Reader>,
    listed: Listed,
    waiting: &Waiting,
    stopped: &channel::Receiver<()>,
) {
    let executor = LocalExecutor::new();
    executor.spawn(listed.keep_told()).detach();
    for (offer, reader) in readers.into_iter().enumerate() {
        executor.spawn(attend(offer, reader, waiting)).detach();
    }
    executor.spawn(tell_faults(&waiting.queue)).detach();
    // The channel carries nothing: its only news is that it was closed.
    let _closed = smol::block_on(executor.run(stopped.recv()));
}

async fn attend(offer: usize, reader: Reader, waiting: &Waiting) {
    let queue = &waiting.queue;
    let mut samples = std::pin::pin!(reader.as_async_stream());
    while let Some(sample) = samples.next().await {
        match sample {
            Ok(sample) => {
                let id = (sample.writer_guid(), i64::from(sample.sequence_number));
                let related = sample.related_sample_identity();
                let related = related.map(|it| (it.writer_guid, i64::from(it.sequence_number)));
                match call(offer, id, related, sample.into_value().0) {
                    Some(call) => {
                        lock(queue).offer(call);
                        waiting.news.notify_all();
                    }
                    None => lock(queue).report_malformed("a request without a body".to_owned()),
                }
            }
            Err(error) => lock(queue).report_malformed(error.to_string()),
        }
        // A flood on one service lets the others have their turn.
        future::yield_now().await;
    }
}

/// Makes a call of what arrived: `id` is the sample's own writer and number, `related` what its
/// sender wrote beside it.
fn call(
    offer: usize,
    id: (GUID, i64),
    related: Option<(GUID, i64)>,
    body: Cdr,
) -> Option<ServiceRequest> {
    let writer = id.0.to_bytes();
    // Others that go Cyclone's way put half of their writer's identity first.
    let is_headed =
        related.is_none() && (writer[..2] == CYCLONE || body.bytes.starts_with(&writer[8..]));
    let (header, body) = if is_headed {
        let (header, rest) = body.bytes.split_first_chunk::<16>()?;
        (Some(*header), Cdr { bytes: rest.to_vec(), ..body })
    } else {
        (None, body)
    };
    // Fast DDS names the reader that the answer shall go to, and leaves the number open.
    let (writer, number) = related.unwrap_or(id);
    let number = if number == i64::from(SequenceNumber::UNKNOWN) { id.1 } else { number };
    let asker = RequestId { offer, writer: writer.to_bytes(), number, header };
    Some(ServiceRequest { asker, body })
}

/// Says once a second what could not be read, if anything.
async fn tell_faults(queue: &Mutex<Queue>) {
    loop {
        smol::Timer::after(Duration::from_secs(1)).await;
        let (counters, fault) = {
            let mut queue = lock(queue);
            (queue.counters(), queue.take_fault())
        };
        if let Some(fault) = fault {
            let n = counters.n_malformed;
            log::warn!("{n} requests could not be read so far, the last: {fault}");
        }
    }
}

/// How services are offered and asked.
pub(super) const SERVICE: Qos = Qos::reliable(100);

pub(super) fn reader(
    participant: &DomainParticipant,
    name: &str,
    kind: &str,
) -> Result<Reader, RosError> {
    let qos: QosPolicies = policies(SERVICE);
    let refused = |it: rustdds::dds::result::CreateError| refused(name, kind, &it);
    let topic = participant
        .create_topic(name.to_owned(), kind.to_owned(), &qos, TopicKind::NoKey)
        .map_err(refused)?;
    let subscriber = participant.create_subscriber(&qos).map_err(refused)?;
    subscriber.create_simple_datareader_no_key(&topic, Some(qos)).map_err(refused)
}

pub(super) fn writer(
    participant: &DomainParticipant,
    name: &str,
    kind: &str,
    qos: Qos,
) -> Result<Writer, RosError> {
    let qos: QosPolicies = policies(qos);
    let refused = |it: rustdds::dds::result::CreateError| refused(name, kind, &it);
    let topic = participant
        .create_topic(name.to_owned(), kind.to_owned(), &qos, TopicKind::NoKey)
        .map_err(refused)?;
    let publisher = participant.create_publisher(&qos).map_err(refused)?;
    publisher.create_datawriter_no_key(&topic, Some(qos)).map_err(refused)
}

fn refused(name: &str, kind: &str, reason: &dyn std::fmt::Display) -> RosError {
    RosError::Topic {
        topic: name.to_owned(),
        type_name: kind.to_owned(),
        reason: reason.to_string(),
    }
}

fn thread(name: &str, body: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, RosError> {
    let builder = std::thread::Builder::new().name(name.to_owned());
    builder.spawn(body).map_err(|reason| RosError::Thread { reason })
}

/// A queue is whole between any two calls, so a panic elsewhere does not spoil it.
fn lock(queue: &Mutex<Queue>) -> MutexGuard<'_, Queue> {
    queue.lock().unwrap_or_else(PoisonError::into_inner)
}
