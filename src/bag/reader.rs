//! Records of a recording's files, one after the other, however damaged they are.
//!
//! Nothing is read ahead and no index is needed: what a killed process left behind is read in the
//! same way as a whole file. Only who wants a part of a file may tell what to pass over. Damage is an item of its own; whatever follows it and can still be made
//! out follows. A chunk whose checksum is wrong is left out as a whole, one that is cut off gives
//! the messages before the cut.

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
/// Opcode and length before every record (bytes).
const RECORD_HEAD: usize = 9;

/// A kind of message on a topic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Number in the file.
    pub id: u16,
    /// Topic.
    pub topic: String,
    /// Encoding of messages, such as `cdr`.
    pub encoding: String,
    /// What else is known, such as `offered_qos_profiles`.
    pub metadata: BTreeMap<String, String>,
    /// The type, if one is given.
    pub schema: Option<Arc<Schema>>,
}

impl Channel {
    /// Name of the type; empty without one.
    pub fn type_name(&self) -> &str {
        self.schema.as_ref().map_or("", |schema| &schema.name)
    }
}

/// A type of messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schema {
    /// Number in the file.
    pub id: u16,
    /// Name, such as `std_msgs/msg/String`.
    pub name: String,
    /// Encoding of the definition, such as `ros2msg`.
    pub encoding: String,
    /// The definition.
    pub data: Vec<u8>,
}

/// A message.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// What it came on.
    pub channel: Arc<Channel>,
    /// Its number on the topic, as the writer counted.
    pub sequence: u32,
    /// When it was recorded (ns).
    pub log_time: u64,
    /// When it was published (ns).
    pub publish_time: u64,
    /// The bytes with their header.
    pub data: Vec<u8>,
}

/// What was found in a file.
#[derive(Debug)]
pub enum Item {
    /// The file's first record: profile and library.
    Header(records::Header),
    /// A topic that messages may come on. Once for each number.
    Channel(Arc<Channel>),
    /// A message.
    Message(Recorded),
    /// A file within the file.
    Attachment(Attachment),
    /// Named texts.
    Metadata(records::Metadata),
    /// A chunk of messages: its head and what was in it; the messages follow.
    Chunk(ChunkNote),
    /// Any other record at its place in the file.
    Other(Record<'static>),
    /// Something is wrong here.
    Damage(Damage),
}

/// A file within the file.
#[derive(Clone, Debug)]
pub struct Attachment {
    /// Its name.
    pub name: String,
    /// What it is.
    pub media_type: String,
    /// Times of recording and making (ns).
    pub times: (u64, u64),
    /// Its bytes.
    pub data: Vec<u8>,
}

/// What a chunk says of itself and what was found.
#[derive(Clone, Debug)]
pub struct ChunkNote {
    /// Place in the file.
    pub offset: u64,
    /// Its head.
    pub header: records::ChunkHeader,
    /// Messages in it.
    pub n_messages: usize,
}

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// The file does not begin as an MCAP file does.
    #[error("no MCAP file: it begins with other bytes")]
    NotMcap,
    /// The file ends in the middle of a record.
    #[error(
        "cut off at byte {offset}: {missing} bytes of the record that begins there are missing"
    )]
    Cut {
        /// Where the record begins.
        offset: u64,
        /// What is missing of it.
        missing: u64,
    },
    /// The file ends before it is complete, but not in the middle of a record.
    #[error("it ends at byte {offset} without a footer: it was not closed")]
    NotClosed {
        /// Its length.
        offset: u64,
    },
    /// A chunk that cannot be read, or not to its end.
    #[error("chunk at byte {offset}: {fault}; {n_kept} of its messages are kept")]
    BadChunk {
        /// Where the chunk begins.
        offset: u64,
        /// What is wrong.
        fault: String,
        /// Messages before the fault that are whole.
        n_kept: usize,
    },
    /// Any other record that cannot be read.
    #[error("record {opcode:#04x} at byte {offset}: {fault}")]
    BadRecord {
        /// Where the record begins.
        offset: u64,
        /// What kind of record.
        opcode: u8,
        /// What is wrong.
        fault: String,
    },
    /// The disk failed.
    #[error("byte {offset} cannot be read: {fault}")]
    Unreadable {
        /// Where.
        offset: u64,
        /// What the system says.
        fault: String,
    },
}

/// Reads one file.
pub struct Reader<R> {
    input: R,
    length: u64,
    offset: u64,
    channels: BTreeMap<u16, Arc<Channel>>,
    schemas: BTreeMap<u16, Arc<Schema>>,
    waiting: VecDeque<Item>,
    /// What to pass over, and how.
    gaps: VecDeque<Range<u64>>,
    pass_over: fn(&mut R, u64) -> io::Result<()>,
    is_closed: bool,
    is_over: bool,
}

impl Reader<BufReader<File>> {
    /// Opens a file.
    ///
    /// # Errors
    /// As the system says.
    pub fn open(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        Ok(Self::new(BufReader::with_capacity(1 << 18, file), length))
    }

    /// Opens a file to pass over parts of it, whole records each, that an index named. Channels are
    /// those of the index: where they were told may be passed over too.
    ///
    /// # Errors
    /// As the system says.
    pub fn open_in_part(path: &Path, index: &Index, gaps: Vec<Range<u64>>) -> io::Result<Self> {
        let mut reader = Self::open(path)?;
        reader.channels = index.channels.clone();
        reader.schemas = index.schemas.clone();
        reader.gaps = gaps.into();
        reader.pass_over = |input, n| input.seek_relative(i64::try_from(n).unwrap_or(i64::MAX));
        Ok(reader)
    }
}

impl<R: Read> Reader<R> {
    /// Reads `length` bytes.
    pub fn new(mut input: R, length: u64) -> Self {
        let mut magic = [0; MAGIC.len()];
        let is_mcap = input.read_exact(&mut magic).is_ok() && magic == *MAGIC;
        let mut waiting = VecDeque::new();
        if !is_mcap {
            waiting.push_back(Item::Damage(Damage::NotMcap));
        }
        let reader = Self::from_record(input, MAGIC.len() as u64, length);
        Self { waiting, is_over: !is_mcap, ..reader }
    }

    /// Reads on from the record at `offset`, where `input` stands, in a file of `length` bytes.
    pub fn from_record(input: R, offset: u64, length: u64) -> Self {
        Self {
            input,
            length,
            offset,
            channels: BTreeMap::new(),
            schemas: BTreeMap::new(),
            waiting: VecDeque::new(),
            gaps: VecDeque::new(),
            pass_over: |input, n| io::copy(&mut input.take(n), &mut io::sink()).map(drop),
            is_closed: false,
            is_over: false,
        }
    }

    /// Where the next record begins.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    fn end_with(&mut self, damage: Option<Damage>) {
        self.is_over = true;
        self.waiting.extend(damage.map(Item::Damage));
    }

    /// Reads the next record and queues what is in it.
    fn read_record(&mut self) {
        if let Err(error) = self.pass_gaps() {
            return self.end_with(Some(unreadable(self.offset, &error)));
        }
        let offset = self.offset;
        let left = self.length.saturating_sub(offset);
        if self.is_closed || left == 0 {
            let damage = (!self.is_closed).then_some(Damage::NotClosed { offset });
            return self.end_with(damage);
        }
        let mut head = [0; RECORD_HEAD];
        if left < RECORD_HEAD as u64 {
            return self.end_with(Some(Damage::Cut { offset, missing: RECORD_HEAD as u64 - left }));
        }
        if let Err(error) = self.input.read_exact(&mut head) {
            return self.end_with(Some(unreadable(offset, &error)));
        }
        let [opcode, length @ ..] = head;
        let length = u64::from_le_bytes(length);
        let there = length.min(left - RECORD_HEAD as u64);
        let mut body = Vec::new();
        if let Err(error) = (&mut self.input).take(there).read_to_end(&mut body) {
            return self.end_with(Some(unreadable(offset, &error)));
        }
        self.offset += RECORD_HEAD as u64 + there;
        if there < length {
            if opcode == op::CHUNK {
                self.cut_chunk(offset, &body);
            }
            return self.end_with(Some(Damage::Cut { offset, missing: length - there }));
        }
        match opcode {
            op::CHUNK => self.chunk(offset, &body),
            _ => self.record(offset, opcode, &body),
        }
    }

    fn pass_gaps(&mut self) -> io::Result<()> {
        while let Some(gap) = self.gaps.front().filter(|gap| gap.start == self.offset) {
            (self.pass_over)(&mut self.input, gap.end - gap.start)?;
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
                if let Some(item) = self.take_in(record.into_owned()) {
                    self.waiting.push_back(item);
                }
            }
            Err(error) => {
                let fault = text(&error);
                self.waiting.push_back(Item::Damage(Damage::BadRecord { offset, opcode, fault }));
            }
        }
    }

    /// Makes an item of a record; schemas and repetitions give none.
    fn take_in(&mut self, record: Record<'static>) -> Option<Item> {
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
                Some(Item::Message(Recorded {
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
                let damage = Damage::BadChunk { offset, fault: text(&error), n_kept: 0 };
                self.waiting.push_back(Item::Damage(damage));
            }
        }
    }

    /// The messages of a chunk up to where it is cut off.
    fn cut_chunk(&mut self, offset: u64, body: &[u8]) {
        // Times, length, checksum: 28 bytes; then the compression's name and the length.
        let Some(name_length) = body.get(28..32).and_then(|it| it.try_into().ok()) else { return };
        let end = (u32::from_le_bytes(name_length) as usize).saturating_add(40);
        let Some(data) = body.get(end..) else { return };
        // A head of its own makes the crate read what there is.
        let mut whole = body[..end].to_vec();
        whole[end - 8..].copy_from_slice(&(data.len() as u64).to_le_bytes());
        whole.extend_from_slice(data);
        if let Ok(Record::Chunk { header, data }) = parse_record(op::CHUNK, &whole) {
            self.unpack(offset, header, &data, false);
        }
    }

    fn unpack(&mut self, offset: u64, header: records::ChunkHeader, data: &[u8], is_whole: bool) {
        let (mut records, mut fault) = (Vec::new(), None);
        match ChunkReader::new(header.clone(), data) {
            Ok(reader) => {
                for record in reader {
                    match record {
                        Ok(record) => records.push(record.into_owned()),
                        Err(error) => fault = fault.or_else(|| Some(text(&error))),
                    }
                    if fault.is_some() {
                        break;
                    }
                }
            }
            Err(error) => fault = Some(text(&error)),
        }
        if fault.is_some() && is_whole {
            // Which of its messages are as they were cannot be told.
            records.retain(|it| !matches!(it, Record::Message { .. }));
        }
        let items: Vec<Item> = records.into_iter().filter_map(|it| self.take_in(it)).collect();
        let n_messages = items.iter().filter(|it| matches!(it, Item::Message(_))).count();
        self.waiting.push_back(Item::Chunk(ChunkNote { offset, header, n_messages }));
        self.waiting.extend(items);
        if let Some(fault) = fault {
            let damage = Damage::BadChunk { offset, fault, n_kept: n_messages };
            self.waiting.push_back(Item::Damage(damage));
        }
    }
}

/// An attachment without what may stand behind its checksum, which the crate takes from the end.
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
    Damage::Unreadable { offset, fault: error.to_string() }
}

impl<R: Read> Iterator for Reader<R> {
    type Item = Item;

    fn next(&mut self) -> Option<Item> {
        loop {
            if let Some(item) = self.waiting.pop_front() {
                return Some(item);
            }
            if self.is_over {
                return None;
            }
            self.read_record();
        }
    }
}

/// Items of all files of a recording in their order, each with the place of its file in the list.
///
/// # Errors
/// If a file cannot be opened.
pub fn items(files: &[PathBuf]) -> io::Result<impl Iterator<Item = (usize, Item)>> {
    let readers: Vec<_> = files.iter().map(|file| Reader::open(file)).collect::<Result<_, _>>()?;
    let numbered = readers.into_iter().enumerate();
    Ok(numbered.flat_map(|(file, reader)| reader.map(move |item| (file, item))))
}

/// What a checkpoint was before it was compressed.
///
/// # Errors
/// If the bytes are no whole frame.
pub fn unpacked(packed: &[u8]) -> io::Result<Vec<u8>> {
    zstd::stream::decode_all(packed)
}
