//! Writes one MCAP file of a recording: the description of the run, messages, checkpoints, and its
//! end.

use std::{collections::BTreeMap, io::BufWriter, path::Path};

use mcap::{
    Attachment, Compression, McapError, WriteOptions, Writer,
    records::{MessageHeader, Metadata},
    write::NoSeek,
};

use super::{
    CHECKPOINT, END, ROSBAG2, RunDescription, SCENE, SCENE_FILE, START,
    disk::{FileStatus, ReservedFile},
    metadata::qos_profiles,
};
use crate::{
    scene::BagCompression,
    snapshot::checkpoint::Checkpoint,
    wire::topics::{Message, Topic},
};

/// Length of a chunk of messages that are compressed together (bytes).
const CHUNK_LENGTH: u64 = 768 << 10;
/// Encapsulation header of a message: CDR, little endian.
pub const CDR_HEADER: [u8; 4] = [0, 1, 0, 0];
/// Compression level of checkpoints: fast, and half the size.
const CHECKPOINT_LEVEL: i32 = 1;

/// The error of a write to the file.
pub type WriteError = McapError;

/// An MCAP file that is being written.
pub struct OpenFile {
    writer: Writer<NoSeek<BufWriter<ReservedFile>>>,
    status: FileStatus,
    /// Channel ID of each topic.
    channels: Vec<u16>,
    /// Buffer for a message with its header.
    bytes: Vec<u8>,
}

impl OpenFile {
    /// Creates the file, which must not exist yet, with the description of the run.
    ///
    /// # Errors
    /// The errors of the disk.
    pub fn create(
        path: &Path,
        topics: &[Topic],
        description: &RunDescription,
    ) -> Result<Self, WriteError> {
        let disk = ReservedFile::create(path)?;
        let status = disk.status();
        let compression = match description.format.compression {
            BagCompression::Zstd => Some(Compression::Zstd),
            BagCompression::Lz4 => Some(Compression::Lz4),
            BagCompression::Uncompressed => None,
        };
        // Chunks are assembled in memory and written as a whole. The file always contains complete
        // chunks, and readers find all messages in them.
        let mut writer = WriteOptions::new()
            .profile("ros2")
            .library(concat!("jamgrip ", env!("CARGO_PKG_VERSION")))
            .compression(compression)
            .compression_threads(0)
            .chunk_size(Some(CHUNK_LENGTH))
            .disable_seeking(true)
            .create(NoSeek::new(BufWriter::new(disk)))?;
        let facts = description.facts.iter().map(|(key, value)| (*key, value.clone()));
        writer.write_metadata(&record(START, facts))?;
        writer.attach(&attachment(
            SCENE,
            "application/yaml",
            0,
            description.scene_text.as_bytes(),
        ))?;
        for (name, contents) in &description.scene_files {
            let name = format!("{SCENE_FILE}{name}");
            writer.attach(&attachment(&name, "application/octet-stream", 0, contents))?;
        }
        let (channels, bytes) = (Vec::with_capacity(topics.len()), Vec::new());
        let mut file = Self { writer, status, channels, bytes };
        topics.iter().try_for_each(|topic| file.open_topic(topic))?;
        file.flush()?;
        Ok(file)
    }

    /// Adds a channel for a topic after all others.
    ///
    /// # Errors
    /// The errors of the disk.
    pub fn open_topic(&mut self, topic: &Topic) -> Result<(), WriteError> {
        let message_type = topic.message_type;
        let schema = self.writer.add_schema(
            message_type.name,
            "ros2msg",
            message_type.definition.as_bytes(),
        )?;
        let metadata = BTreeMap::from([
            ("offered_qos_profiles".to_owned(), qos_profiles(topic.qos)),
            ("topic_type_hash".to_owned(), message_type.type_hash.to_owned()),
        ]);
        self.channels.push(self.writer.add_channel(schema, &topic.name, "cdr", &metadata)?);
        Ok(())
    }

    /// Writes a message; `n_before` is the number of earlier messages on its topic.
    ///
    /// # Errors
    /// The errors of the disk.
    pub fn write(&mut self, message: &Message, n_before: u64) -> Result<(), WriteError> {
        self.bytes.clear();
        self.bytes.extend_from_slice(&CDR_HEADER);
        self.bytes.extend_from_slice(&message.cdr);
        #[expect(clippy::cast_possible_truncation, reason = "sequence numbers may wrap")]
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
    /// The errors of the disk.
    pub fn attach(&mut self, checkpoint: &Checkpoint) -> Result<(), WriteError> {
        let packed = zstd::bulk::compress(&checkpoint.bytes, CHECKPOINT_LEVEL)?;
        let name = format!("{CHECKPOINT}{:09}", checkpoint.tick.0);
        self.writer.attach(&attachment(&name, "application/zstd", checkpoint.time_ns, &packed))
    }

    /// Passes all data to the operating system.
    ///
    /// # Errors
    /// The errors of the disk.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.writer.flush()
    }

    /// Length of the file, and whether the disk is full.
    pub fn status(&self) -> &FileStatus {
        &self.status
    }

    /// Completes the file with the final metadata and its index.
    ///
    /// # Errors
    /// The errors of the disk.
    pub fn finish(
        mut self,
        facts: Vec<(&'static str, String)>,
        information: String,
    ) -> Result<(), WriteError> {
        self.writer.write_metadata(&record(END, facts))?;
        let rosbag2 = [("serialized_metadata", information), ("ROS_DISTRO", "jazzy".to_owned())];
        self.writer.write_metadata(&record(ROSBAG2, rosbag2))?;
        self.writer.finish()?;
        let inner = self.writer.into_inner().into_inner();
        let disk = inner.into_inner().map_err(|error| McapError::Io(error.into_error()))?;
        // Dropping `disk` also frees the reserve, so there is space for metadata.yaml.
        Ok(disk.sync()?)
    }
}

fn attachment<'a>(name: &str, media_type: &str, time_ns: u64, bytes: &'a [u8]) -> Attachment<'a> {
    Attachment {
        log_time: time_ns,
        create_time: time_ns,
        name: name.to_owned(),
        media_type: media_type.to_owned(),
        data: bytes.into(),
    }
}

fn record(name: &str, values: impl IntoIterator<Item = (&'static str, String)>) -> Metadata {
    let metadata = values.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    Metadata { name: name.to_owned(), metadata }
}

/// The message of an error with its causes, because the message of the crate alone is not informative.
pub fn text(error: &WriteError) -> String {
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(error);
    while let Some(error) = cause {
        text += &format!(": {error}");
        cause = error.source();
    }
    text
}

/// The operating system's error that caused an error, if there is one.
pub fn io_error(error: &WriteError) -> Option<&std::io::Error> {
    match error {
        McapError::Io(error) => Some(error),
        _ => None,
    }
}
