//! One MCAP file of a recording: what it holds before the first message, messages, checkpoints, and
//! its completion.

use std::{collections::BTreeMap, io::BufWriter, path::Path};

use mcap::{
    Attachment, Compression, McapError, WriteOptions, Writer,
    records::{MessageHeader, Metadata},
    write::NoSeek,
};

use super::{
    CHECKPOINT, END, ROSBAG2, SCENE, SCENE_FILE, START, Subject,
    disk::{Gauge, ReservedFile},
    metadata::qos_profiles,
};
use crate::{
    scene::BagCompression,
    snapshot::checkpoint::Checkpoint,
    wire::topics::{Message, Topic},
};

/// Messages are compressed together up to this length (bytes).
const CHUNK: u64 = 768 << 10;
/// Names the encoding of a message: CDR, little endian.
pub const CDR_HEADER: [u8; 4] = [0, 1, 0, 0];
/// Fast, and half the size.
const CHECKPOINT_LEVEL: i32 = 1;

/// The disk does not do what it should, or the file was not begun.
pub type WriteError = McapError;

/// The MCAP file while it is written.
pub struct OpenFile {
    writer: Writer<NoSeek<BufWriter<ReservedFile>>>,
    gauge: Gauge,
    /// Channel of each topic.
    channels: Vec<u16>,
    /// A message with its header, put together here.
    bytes: Vec<u8>,
}

impl OpenFile {
    /// Creates the file, which must not exist yet, with all that explains it.
    ///
    /// # Errors
    /// As the disk says.
    pub fn create(path: &Path, topics: &[Topic], subject: &Subject) -> Result<Self, WriteError> {
        let disk = ReservedFile::create(path)?;
        let gauge = disk.gauge();
        let compression = match subject.format.compression {
            BagCompression::Zstd => Some(Compression::Zstd),
            BagCompression::Lz4 => Some(Compression::Lz4),
            BagCompression::Uncompressed => None,
        };
        // Chunks are put together in memory and written whole: whatever happens, the file holds
        // whole chunks, and readers find all messages of them.
        let mut writer = WriteOptions::new()
            .profile("ros2")
            .library(concat!("jamgrip ", env!("CARGO_PKG_VERSION")))
            .compression(compression)
            .compression_threads(0)
            .chunk_size(Some(CHUNK))
            .disable_seeking(true)
            .create(NoSeek::new(BufWriter::new(disk)))?;
        let facts = subject.facts.iter().map(|(key, value)| (*key, value.clone()));
        writer.write_metadata(&record(START, facts))?;
        writer.attach(&attachment(SCENE, "application/yaml", 0, subject.scene_text.as_bytes()))?;
        for (name, contents) in &subject.scene_files {
            let name = format!("{SCENE_FILE}{name}");
            writer.attach(&attachment(&name, "application/octet-stream", 0, contents))?;
        }
        let (channels, bytes) = (Vec::with_capacity(topics.len()), Vec::new());
        let mut file = Self { writer, gauge, channels, bytes };
        topics.iter().try_for_each(|topic| file.open_topic(topic))?;
        file.flush()?;
        Ok(file)
    }

    /// Opens a channel for a topic, behind all others.
    ///
    /// # Errors
    /// As the disk says.
    pub fn open_topic(&mut self, topic: &Topic) -> Result<(), WriteError> {
        let kind = topic.message_type;
        let schema = self.writer.add_schema(kind.name, "ros2msg", kind.definition.as_bytes())?;
        let metadata = BTreeMap::from([
            ("offered_qos_profiles".to_owned(), qos_profiles(topic.qos)),
            ("topic_type_hash".to_owned(), kind.type_hash.to_owned()),
        ]);
        self.channels.push(self.writer.add_channel(schema, &topic.name, "cdr", &metadata)?);
        Ok(())
    }

    /// Writes a message; `n_before` is its number on its topic.
    ///
    /// # Errors
    /// As the disk says.
    pub fn write(&mut self, message: &Message, n_before: u64) -> Result<(), WriteError> {
        self.bytes.clear();
        self.bytes.extend_from_slice(&CDR_HEADER);
        self.bytes.extend_from_slice(&message.cdr);
        #[expect(clippy::cast_possible_truncation, reason = "sequence numbers may start anew")]
        let header = MessageHeader {
            channel_id: self.channels[message.topic],
            sequence: n_before as u32,
            log_time: message.time_ns,
            publish_time: message.time_ns,
        };
        self.writer.write_to_known_channel(&header, &self.bytes)
    }

    /// Writes a checkpoint, compressed.
    ///
    /// # Errors
    /// As the disk says.
    pub fn attach(&mut self, checkpoint: &Checkpoint) -> Result<(), WriteError> {
        let packed = zstd::bulk::compress(&checkpoint.bytes, CHECKPOINT_LEVEL)?;
        let name = format!("{CHECKPOINT}{:09}", checkpoint.tick.0);
        self.writer.attach(&attachment(&name, "application/zstd", checkpoint.time_ns, &packed))
    }

    /// Hands everything to the operating system.
    ///
    /// # Errors
    /// As the disk says.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.writer.flush()
    }

    /// Length and fullness.
    pub fn gauge(&self) -> &Gauge {
        &self.gauge
    }

    /// Completes the file with what is known at its end, and its index.
    ///
    /// # Errors
    /// As the disk says.
    pub fn finish(
        mut self,
        facts: Vec<(&'static str, String)>,
        information: String,
    ) -> Result<(), WriteError> {
        self.writer.write_metadata(&record(END, facts))?;
        let of_rosbag2 = [("serialized_metadata", information), ("ROS_DISTRO", "jazzy".to_owned())];
        self.writer.write_metadata(&record(ROSBAG2, of_rosbag2))?;
        self.writer.finish()?;
        let inner = self.writer.into_inner().into_inner();
        let disk = inner.into_inner().map_err(|error| McapError::Io(error.into_error()))?;
        // With `disk` goes the reserve, so that there is room for metadata.yaml as well.
        Ok(disk.sync()?)
    }
}

fn attachment<'a>(name: &str, kind: &str, time_ns: u64, bytes: &'a [u8]) -> Attachment<'a> {
    Attachment {
        log_time: time_ns,
        create_time: time_ns,
        name: name.to_owned(),
        media_type: kind.to_owned(),
        data: bytes.into(),
    }
}

fn record(name: &str, values: impl IntoIterator<Item = (&'static str, String)>) -> Metadata {
    let metadata = values.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    Metadata { name: name.to_owned(), metadata }
}

/// An error and what caused it: the crate's own words say little.
pub fn text(error: &WriteError) -> String {
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(error);
    while let Some(error) = cause {
        text += &format!(": {error}");
        cause = error.source();
    }
    text
}

/// The error of the system behind an error, if there is one.
pub fn of_system(error: &WriteError) -> Option<&std::io::Error> {
    match error {
        McapError::Io(error) => Some(error),
        _ => None,
    }
}
