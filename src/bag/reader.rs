//! Reads the records of a file in order, even if it is damaged.
//!
//! The reader needs no index and does not read ahead, so a file of a killed process is read like a
//! complete one. Callers that want only part of a file can skip ranges. Damage is reported as an
//! item of its own, followed by everything after it that can still be read. A chunk with a wrong
//! checksum is dropped as a whole; a truncated one yields the messages before the cut.

use std::{
    collections::{BTreeMap, VecDeque},
    fs::File,
    io::{self, BufReader, Read},
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use mcap::{
    McapError,
    read::{ChunkReader, parse_record},
    records::{self, Record, op},
};

use super::{index::Index, writer::text};

/// First and last bytes of every file.
pub const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";
/// Length of the opcode and length in front of every record (bytes).
const RECORD_HEADER: usize = 9;

/// A channel: messages of one type on a topic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// ID in the file.
    pub id: u16,
    /// Topic.
    pub topic: String,
    /// Encoding of messages, such as `cdr`.
    pub encoding: String,
    /// Other information, such as `offered_qos_profiles`.
    pub metadata: BTreeMap<String, String>,
    /// The type, if given.
    pub schema: Option<Arc<Schema>>,
}

impl Channel {
    /// Name of the type; empty if there is none.
    pub fn type_name(&self) -> &str {
        self.schema.as_ref().map_or("", |schema| &schema.name)
    }
}

/// The type of messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schema {
    /// ID in the file.
    pub id: u16,
    /// Name, such as `std_msgs/msg/String`.
    pub name: String,
    /// Encoding of the definition, such as `ros2msg`.
    pub encoding: String,
    /// The definition.
    pub data: Vec<u8>,
}

/// A recorded message.
#[derive(Clone, Debug)]
pub struct RecordedMessage {
    /// Its channel.
    pub channel: Arc<Channel>,
    /// Sequence number on the topic, counted by the writer.
    pub sequence: u32,
    /// Time of recording (ns).
    pub log_time: u64,
    /// Time of publication (ns).
    pub publish_time: u64,
    /// The encoded message, with its header.
    pub data: Vec<u8>,
}

/// An item of a file.
#[derive(Debug)]
pub enum Item {
    /// The file's first record: profile and library.
    Header(records::Header),
    /// A channel; reported once for each ID.
    Channel(Arc<Channel>),
    /// A message.
    Message(RecordedMessage),
    /// An attached file.
    Attachment(Attachment),
    /// A metadata record.
    Metadata(records::Metadata),
    /// A chunk; its messages follow.
    Chunk(ChunkSummary),
    /// Any other record.
    Other(Record<'static>),
    /// Damage at this position.
    Damage(Damage),
}

/// An attached file.
#[derive(Clone, Debug)]
pub struct Attachment {
    /// Its name.
    pub name: String,
    /// Its media type.
    pub media_type: String,
    /// Times of recording and creation (ns).
    pub times: (u64, u64),
    /// Its contents.
    pub data: Vec<u8>,
}

/// A chunk's header, and the number of messages found.
#[derive(Clone, Debug)]
pub struct ChunkSummary {
    /// Position in the file (bytes).
    pub offset: u64,
    /// Its header.
    pub header: records::ChunkHeader,
    /// Number of messages found in it.
    pub n_messages: usize,
}

/// Damage of a file, with its position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// The file does not begin like an MCAP file.
    #[error("not an MCAP file: it begins with other bytes")]
    NotMcap,
    /// The file ends inside a record.
    #[error("truncated: {missing} bytes of the record at byte {offset} are missing")]
    Cut {
        /// Position of the record (bytes).
        offset: u64,
        /// Number of missing bytes.
        missing: u64,
    },
    /// The file ends between records but is not complete.
    #[error("it ends at byte {offset} without a footer, so it was not closed")]
    NotClosed {
        /// Length of the file (bytes).
        offset: u64,
    },
    /// A chunk cannot be read, or only in part.
    #[error("chunk at byte {offset}: {reason}; {n_kept} of its messages are kept")]
    BadChunk {
        /// Position of the chunk (bytes).
        offset: u64,
        /// The error.
        reason: String,
        /// Number of valid messages before the error.
        n_kept: usize,
    },
    /// Any other record cannot be read.
    #[error("record {opcode:#04x} at byte {offset}: {reason}")]
    BadRecord {
        /// Position of the record (bytes).
        offset: u64,
        /// Type of the record.
        opcode: u8,
        /// The error.
        reason: String,
    },
    /// The disk failed.
    #[error("byte {offset} cannot be read: {reason}")]
    Unreadable {
        /// Position (bytes).
        offset: u64,
        /// Reason given by the operating system.
        reason: String,
    },
}

/// Reads a file.
pub struct Reader<R> {
    input: R,
    length: u64,
    offset: u64,
    channels: BTreeMap<u16, Arc<Channel>>,
    schemas: BTreeMap<u16, Arc<Schema>>,
    queue: VecDeque<Item>,
    /// Ranges to skip, and how to skip them.
    gaps: VecDeque<Range<u64>>,
    skip: fn(&mut R, u64) -> io::Result<()>,
    is_closed: bool,
    is_finished: bool,
}

impl Reader<BufReader<File>> {
    /// Opens a file.
    ///
    /// # Errors
    /// The errors of the operating system.
    pub fn open(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        Ok(Self::new(BufReader::with_capacity(1 << 18, file), length))
    }

    /// Opens a file and skips the ranges `gaps`, which consist of whole records named by the index.
    /// Channels come from the index, because their records may be skipped, too.
    ///
    /// # Errors
    /// The errors of the operating system.
    pub fn open_with_gaps(path: &Path, index: &Index, gaps: Vec<Range<u64>>) -> io::Result<Self> {
        let mut reader = Self::open(path)?;
        reader.channels = index.channels.clone();
        reader.schemas = index.schemas.clone();
        reader.gaps = gaps.into();
        reader.skip = |input, n| input.seek_relative(i64::try_from(n).unwrap_or(i64::MAX));
        Ok(reader)
    }
}

impl<R: Read> Reader<R> {
    /// Reads an input of `length` bytes.
    pub fn new(mut input: R, length: u64) -> Self {
        let mut magic = [0; MAGIC.len()];
        let is_mcap = input.read_exact(&mut magic).is_ok() && magic == *MAGIC;
        let mut queue = VecDeque::new();
        if !is_mcap {
            queue.push_back(Item::Damage(Damage::NotMcap));
        }
        let reader = Self::from_record(input, MAGIC.len() as u64, length);
        Self { queue, is_finished: !is_mcap, ..reader }
    }

    /// Continues at the record at `offset`, where `input` is positioned, in a file of `length`
    /// bytes.
    pub fn from_record(input: R, offset: u64, length: u64) -> Self {
        Self {
            input,
            length,
            offset,
            channels: BTreeMap::new(),
            schemas: BTreeMap::new(),
            queue: VecDeque::new(),
            gaps: VecDeque::new(),
            skip: |input, n| io::copy(&mut input.take(n), &mut io::sink()).map(drop),
            is_closed: false,
            is_finished: false,
        }
    }

    /// Position of the next record (bytes).
    pub fn offset(&self) -> u64 {
        self.offset
    }

    fn end_with(&mut self, damage: Option<Damage>) {
        self.is_finished = true;
        self.queue.extend(damage.map(Item::Damage));
    }

    /// Reads the next record and queues its items.
    fn read_record(&mut self) {
        if let Err(error) = self.skip_gaps() {
            return self.end_with(Some(unreadable(self.offset, &error)));
        }
        let offset = self.offset;
        let left = self.length.saturating_sub(offset);
        if self.is_closed || left == 0 {
            let damage = (!self.is_closed).then_some(Damage::NotClosed { offset });
            return self.end_with(damage);
        }
        let mut head = [0; RECORD_HEADER];
        if left < RECORD_HEADER as u64 {
            return self
                .end_with(Some(Damage::Cut { offset, missing: RECORD_HEADER as u64 - left }));
        }
        if let Err(error) = self.input.read_exact(&mut head) {
            return self.end_with(Some(unreadable(offset, &error)));
        }
        let [opcode, length @ ..] = head;
        let length = u64::from_le_bytes(length);
        let available = length.min(left - RECORD_HEADER as u64);
        let mut body = Vec::new();
        if let Err(error) = (&mut self.input).take(available).read_to_end(&mut body) {
            return self.end_with(Some(unreadable(offset, &error)));
        }
        self.offset += RECORD_HEADER as u64 + available;
        if available < length {
            if opcode == op::CHUNK {
                self.truncated_chunk(offset, &body);
            }
            return self.end_with(Some(Damage::Cut { offset, missing: length - available }));
        }
        match opcode {
            op::CHUNK => self.chunk(offset, &body),
            _ => self.record(offset, opcode, &body),
        }
    }

    fn skip_gaps(&mut self) -> io::Result<()> {
        while let Some(gap) = self.gaps.front().filter(|gap| gap.start == self.offset) {
            (self.skip)(&mut self.input, gap.end - gap.start)?;
            self.offset = gap.end;
            self.gaps.pop_front();
        }
        Ok(())
    }

    fn record(&mut self, offset: u64, opcode: u8, body: &[u8]) {
        let body = if opcode == op::ATTACHMENT { attachment(body) } else { Some(body) };
        let record = body.map_or(Err(McapError::UnexpectedEof), |it| parse_record(opcode, it));
        match record {
            Ok(record) => {
                if let Some(item) = self.item_of(record.into_owned()) {
                    self.queue.push_back(item);
                }
            }
            Err(error) => {
                let reason = text(&error);
                self.queue.push_back(Item::Damage(Damage::BadRecord { offset, opcode, reason }));
            }
        }
    }

    /// Converts a record to an item; schemas and repeated channels yield none.
    fn item_of(&mut self, record: Record<'static>) -> Option<Item> {
        match record {
            Record::Header(header) => Some(Item::Header(header)),
            Record::Schema { header, data } => {
                let records::SchemaHeader { id, name, encoding } = header;
                let schema = Schema { id, name, encoding, data: data.into_owned() };
                self.schemas.insert(id, Arc::new(schema));
                None
            }
            Record::Channel(channel) => {
                let records::Channel { id, schema_id, topic, message_encoding, metadata } = channel;
                let schema = self.schemas.get(&schema_id).cloned();
                let channel = Channel { id, topic, encoding: message_encoding, metadata, schema };
                if self.channels.get(&id).is_some_and(|known| **known == channel) {
                    return None;
                }
                let channel = Arc::new(channel);
                self.channels.insert(id, Arc::clone(&channel));
                Some(Item::Channel(channel))
            }
            Record::Message { header, data } => {
                let channel = Arc::clone(self.channels.get(&header.channel_id)?);
                Some(Item::Message(RecordedMessage {
                    channel,
                    sequence: header.sequence,
                    log_time: header.log_time,
                    publish_time: header.publish_time,
                    data: data.into_owned(),
                }))
            }
            Record::Attachment { header, data, .. } => Some(Item::Attachment(Attachment {
                name: header.name,
                media_type: header.media_type,
                times: (header.log_time, header.create_time),
                data: data.into_owned(),
            })),
            Record::Metadata(metadata) => Some(Item::Metadata(metadata)),
            Record::Footer(_) => {
                self.is_closed = true;
                None
            }
            other => Some(Item::Other(other)),
        }
    }

    fn chunk(&mut self, offset: u64, body: &[u8]) {
        match parse_record(op::CHUNK, body) {
            Ok(Record::Chunk { header, data }) => self.unpack(offset, header, &data, true),
            Ok(_) => {}
            Err(error) => {
                let damage = Damage::BadChunk { offset, reason: text(&error), n_kept: 0 };
                self.queue.push_back(Item::Damage(damage));
            }
        }
    }

    /// Reads the messages of a truncated chunk before the cut.
    fn truncated_chunk(&mut self, offset: u64, body: &[u8]) {
        // Times, length and checksum take 28 bytes; then come the name of the compression and the
        // length.
        let Some(name_length) = body.get(28..32).and_then(|it| it.try_into().ok()) else { return };
        let end = (u32::from_le_bytes(name_length) as usize).saturating_add(40);
        let Some(data) = body.get(end..) else { return };
        // A header with the available length makes the crate read the rest.
        let mut chunk = body[..end].to_vec();
        chunk[end - 8..].copy_from_slice(&(data.len() as u64).to_le_bytes());
        chunk.extend_from_slice(data);
        if let Ok(Record::Chunk { header, data }) = parse_record(op::CHUNK, &chunk) {
            self.unpack(offset, header, &data, false);
        }
    }

    fn unpack(&mut self, offset: u64, header: records::ChunkHeader, data: &[u8], is_whole: bool) {
        let (mut records, mut reason) = (Vec::new(), None);
        match ChunkReader::new(header.clone(), data) {
            Ok(reader) => {
                for record in reader {
                    match record {
                        Ok(record) => records.push(record.into_owned()),
                        Err(error) => reason = reason.or_else(|| Some(text(&error))),
                    }
                    if reason.is_some() {
                        break;
                    }
                }
            }
            Err(error) => reason = Some(text(&error)),
        }
        if reason.is_some() && is_whole {
            // The checksum does not show which messages are valid.
            records.retain(|it| !matches!(it, Record::Message { .. }));
        }
        let items: Vec<Item> = records.into_iter().filter_map(|it| self.item_of(it)).collect();
        let n_messages = items.iter().filter(|it| matches!(it, Item::Message(_))).count();
        self.queue.push_back(Item::Chunk(ChunkSummary { offset, header, n_messages }));
        self.queue.extend(items);
        if let Some(reason) = reason {
            let damage = Damage::BadChunk { offset, reason, n_kept: n_messages };
            self.queue.push_back(Item::Damage(damage));
        }
    }
}

/// Removes bytes after the checksum of an attachment, because the crate takes the checksum from the
/// end.
fn attachment(body: &[u8]) -> Option<&[u8]> {
    let mut end: usize = 16; // both times
    for width in [4, 4, 8] {
        let mut length = [0; 8];
        length[..width].copy_from_slice(body.get(end..end.checked_add(width)?)?);
        let length = usize::try_from(u64::from_le_bytes(length)).ok()?;
        end = (end + width).checked_add(length)?;
    }
    body.get(..end.checked_add(4)?)
}

fn unreadable(offset: u64, error: &io::Error) -> Damage {
    Damage::Unreadable { offset, reason: error.to_string() }
}

impl<R: Read> Iterator for Reader<R> {
    type Item = Item;

    fn next(&mut self) -> Option<Item> {
        loop {
            if let Some(item) = self.queue.pop_front() {
                return Some(item);
            }
            if self.is_finished {
                return None;
            }
            self.read_record();
        }
    }
}

/// The items of all files of a recording in order, each with the index of its file.
///
/// # Errors
/// If a file cannot be opened.
pub fn items(files: &[PathBuf]) -> io::Result<impl Iterator<Item = (usize, Item)>> {
    let readers: Vec<_> = files.iter().map(|file| Reader::open(file)).collect::<Result<_, _>>()?;
    let numbered = readers.into_iter().enumerate();
    Ok(numbered.flat_map(|(file, reader)| reader.map(move |item| (file, item))))
}

/// Decompresses a checkpoint.
///
/// # Errors
/// If the data are not a complete frame.
pub fn decompress(packed: &[u8]) -> io::Result<Vec<u8>> {
    zstd::stream::decode_all(packed)
}
