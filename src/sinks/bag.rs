//! Recordings: a rosbag2 folder with one MCAP file that explains itself.
//!
//! It holds every message that is published, every command that was received, refused ones too,
//! and the scene. Log times are simulated time; a command has the time at which its tick began.

use std::{
    collections::BTreeMap,
    error::Error,
    fs,
    io::{self, BufWriter, ErrorKind},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};

use mcap::{
    Attachment, Compression, McapError, WriteOptions, Writer,
    records::{MessageHeader, Metadata},
    write::NoSeek,
};

use super::{
    Packet, Sink,
    bag_metadata::{Contents, file_text, information, qos_profiles},
    disk::{FullFlag, RESERVE, ReservedFile, is_full},
};
use crate::wire::{
    to_ros::Encoder,
    topics::{Message, Topic},
};

/// A crash loses at most what came in this time, in wall time.
const FLUSH_PERIOD: Duration = Duration::from_secs(1);
/// Messages are compressed together up to this length [bytes].
const CHUNK: u64 = 768 << 10;
/// Names the encoding of a message: CDR, little endian.
const CDR_HEADER: [u8; 4] = [0, 1, 0, 0];

/// Why nothing more is recorded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BagError {
    /// The folder is there already.
    #[error(
        "bag folder {}: there is something in it already; choose another folder, or move it away",
        folder.display()
    )]
    FolderInUse {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder or a file in it cannot be made.
    #[error(
        "bag folder {}: cannot create {} ({fault}); choose a folder that can be written, \
         on a disk with at least {} MiB of room",
        folder.display(), path.display(), RESERVE >> 20
    )]
    CannotCreate {
        /// The folder.
        folder: PathBuf,
        /// What could not be created.
        path: PathBuf,
        /// What the system says.
        fault: String,
    },
    /// There is no room on the disk.
    #[error(
        "bag folder {}: the disk is full after {:.3} s of simulated time; what was recorded until \
         then is complete; make room, or choose another disk",
        folder.display(), seconds(*recorded_ns)
    )]
    DiskFull {
        /// The folder.
        folder: PathBuf,
        /// Simulated time of the last message [ns].
        recorded_ns: u64,
    },
    /// The disk does not do what it should.
    #[error(
        "bag folder {}: cannot write {} ({fault}); recorded up to {:.3} s of simulated time; \
         check the disk, or choose another",
        folder.display(), path.display(), seconds(*recorded_ns)
    )]
    CannotWrite {
        /// The folder.
        folder: PathBuf,
        /// The file.
        path: PathBuf,
        /// What the system says.
        fault: String,
        /// Simulated time of the last message [ns].
        recorded_ns: u64,
    },
}

fn seconds(time_ns: u64) -> f64 {
    time_ns as f64 * 1e-9
}

/// What a recording is about.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Text of the resolved scene; kept in the recording as `scene.yaml`.
    pub scene_text: String,
    /// Seed of the scene.
    pub seed: u64,
}

/// What a recording holds so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BagReport {
    /// Its folder.
    pub folder: PathBuf,
    /// Number of messages on each topic, in the order of the list of topics.
    pub message_counts: Vec<(String, u64)>,
}

/// Reads the report of a recording while it runs and after it has ended.
#[derive(Clone, Debug, Default)]
pub struct BagReporter(Arc<Mutex<BagReport>>);

impl BagReporter {
    /// What the recording holds so far.
    pub fn report(&self) -> BagReport {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A recording.
pub struct Bag {
    encoder: Arc<Encoder>,
    subject: Subject,
    folder: PathBuf,
    file_name: String,
    file: Option<OpenFile>,
    contents: Contents,
    /// Digest of the last state.
    digest: u64,
    /// Why the recording has ended early.
    fault: Option<BagError>,
    flushed_at: Instant,
    reporter: BagReporter,
}

/// The MCAP file while it is written.
struct OpenFile {
    writer: Writer<NoSeek<BufWriter<ReservedFile>>>,
    full: FullFlag,
    /// Channel of each topic.
    channels: Vec<u16>,
    /// A message with its header, put together here.
    bytes: Vec<u8>,
}

impl Bag {
    /// Starts a recording in a folder that does not exist yet, or is empty.
    ///
    /// # Errors
    /// If the folder is in use, cannot be written, or its disk has no room.
    pub fn create(
        folder: &Path,
        encoder: Arc<Encoder>,
        subject: Subject,
    ) -> Result<Self, BagError> {
        let cannot_create = |path: &Path, fault: String| BagError::CannotCreate {
            folder: folder.to_owned(),
            path: path.to_owned(),
            fault,
        };
        fs::create_dir_all(folder).map_err(|e| cannot_create(folder, e.to_string()))?;
        let mut entries = fs::read_dir(folder).map_err(|e| cannot_create(folder, e.to_string()))?;
        if entries.next().is_some() {
            return Err(BagError::FolderInUse { folder: folder.to_owned() });
        }
        let name = folder.file_name().map_or("bag".into(), |name| name.to_string_lossy());
        let file_name = format!("{name}_0.mcap");
        let path = folder.join(&file_name);
        let opened = OpenFile::create(&path, encoder.topics(), &subject.scene_text);
        let file = opened.map_err(|error| {
            // An empty folder can be used again; that it cannot be emptied is the smaller fault.
            let _ = fs::remove_file(&path);
            cannot_create(&path, text(&error))
        })?;
        let mut bag = Self {
            contents: Contents::new(encoder.topics().len()),
            folder: folder.to_owned(),
            file_name,
            file: Some(file),
            digest: 0,
            fault: None,
            flushed_at: now(),
            reporter: BagReporter::default(),
            encoder,
            subject,
        };
        bag.note().map_err(|e| cannot_create(&bag.metadata_path(), e.to_string()))?;
        Ok(bag)
    }

    /// Where the report of this recording can be read.
    pub fn reporter(&self) -> BagReporter {
        self.reporter.clone()
    }

    fn metadata_path(&self) -> PathBuf {
        self.folder.join("metadata.yaml")
    }

    /// Records a packet's commands and messages.
    fn record(&mut self, packet: &Packet) -> Result<(), McapError> {
        let snapshot = &packet.snapshot;
        let begin_ns = snapshot.time_ns.saturating_sub(self.encoder.tick_ns());
        if self.contents.times.is_none() {
            let encoder = Arc::clone(&self.encoder);
            encoder.latched(begin_ns).iter().try_for_each(|message| self.put(message))?;
        }
        for record in &snapshot.commands {
            let message = self.encoder.commands().encode(&record.command, begin_ns);
            self.put(&message)?;
        }
        let encoder = Arc::clone(&self.encoder);
        packet.messages(&encoder).iter().try_for_each(|message| self.put(message))?;
        self.digest = snapshot.digest;
        if FLUSH_PERIOD <= self.flushed_at.elapsed() {
            self.flush()?;
        }
        Ok(())
    }

    fn put(&mut self, message: &Message) -> Result<(), McapError> {
        let Some(file) = &mut self.file else { return Ok(()) };
        file.write(message, self.contents.counts[message.topic])?;
        self.contents.add(message.topic, message.time_ns);
        Ok(())
    }

    /// Hands everything to the operating system.
    fn flush(&mut self) -> Result<(), McapError> {
        self.flushed_at = now();
        if let Some(file) = &mut self.file {
            file.writer.flush()?;
        }
        Ok(self.note()?)
    }

    /// Writes `metadata.yaml` anew, in one step, and brings the report up to date.
    fn note(&mut self) -> io::Result<()> {
        let topics = self.encoder.topics();
        let names = topics.iter().map(|topic| topic.name.clone());
        let report = BagReport {
            folder: self.folder.clone(),
            message_counts: names.zip(self.contents.counts.iter().copied()).collect(),
        };
        *self.reporter.0.lock().unwrap_or_else(PoisonError::into_inner) = report;
        let path = self.metadata_path();
        let draft = path.with_extension("yaml.new");
        fs::write(&draft, file_text(topics, &self.contents, &self.file_name))?;
        fs::rename(&draft, &path)
    }

    /// Completes the file with its metadata and index.
    fn finish(&mut self) -> Result<(), McapError> {
        let Some(mut file) = self.file.take() else { return Ok(()) };
        let topics = self.encoder.topics();
        let whole = information(topics, &self.contents, &self.file_name);
        let (digest, n_messages) = (self.digest, self.contents.n_messages());
        file.writer.write_metadata(&record(
            "jamgrip",
            [
                ("seed", self.subject.seed.to_string()),
                ("version", env!("CARGO_PKG_VERSION").to_owned()),
                ("commit", option_env!("JAMGRIP_COMMIT").unwrap_or("unknown").to_owned()),
                ("state_digest", format!("{digest:016x}")),
                ("message_count", n_messages.to_string()),
            ],
        ))?;
        file.writer.write_metadata(&record(
            "rosbag2",
            [("serialized_metadata", whole), ("ROS_DISTRO", "jazzy".to_owned())],
        ))?;
        file.writer.finish()?;
        let inner = file.writer.into_inner().into_inner();
        let disk = inner.into_inner().map_err(|error| McapError::Io(error.into_error()))?;
        disk.sync()?;
        // From here on the reserve is free, so that there is room for metadata.yaml as well.
        drop(disk);
        Ok(self.note()?)
    }

    /// Ends the recording early, with as much of it kept as the disk allows.
    fn end(&mut self, error: &McapError) -> BagError {
        let recorded_ns = self.contents.times.map_or(0, |(_, last)| last);
        let folder = self.folder.clone();
        let path = folder.join(&self.file_name);
        let disk_is_full = matches!(error, McapError::Io(error) if is_full(error));
        let fault = match self.finish() {
            Ok(()) if disk_is_full => BagError::DiskFull { folder, recorded_ns },
            _ => BagError::CannotWrite { folder, path, fault: text(error), recorded_ns },
        };
        self.fault = Some(fault.clone());
        fault
    }

    /// Says and remembers what became of an attempt; a full disk is found here.
    fn conclude(&mut self, outcome: Result<(), McapError>) -> Result<(), BagError> {
        let is_disk_full = self.file.as_ref().is_some_and(|file| file.full.is_set());
        match outcome {
            Ok(()) if !is_disk_full => Ok(()),
            Ok(()) => Err(self.end(&McapError::Io(ErrorKind::StorageFull.into()))),
            Err(error) => Err(self.end(&error)),
        }
    }
}

impl Sink for Bag {
    fn name(&self) -> &'static str {
        "bag"
    }

    /// After a fault it gives that fault for every packet: nothing more is recorded.
    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn Error + Send + Sync>> {
        if let Some(fault) = &self.fault {
            return Err(Box::new(fault.clone()));
        }
        let outcome = self.record(packet);
        Ok(self.conclude(outcome)?)
    }

    fn idle(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        if self.fault.is_some() {
            return Ok(());
        }
        let outcome = self.flush();
        Ok(self.conclude(outcome)?)
    }

    fn close(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        if self.fault.is_some() {
            return Ok(());
        }
        let outcome = self.flush();
        self.conclude(outcome)?;
        let outcome = self.finish();
        Ok(self.conclude(outcome)?)
    }
}

impl OpenFile {
    fn create(path: &Path, topics: &[Topic], scene_text: &str) -> Result<Self, McapError> {
        let disk = ReservedFile::create(path)?;
        let full = disk.full_flag();
        // Chunks are put together in memory and written whole: whatever happens, the file holds
        // whole chunks, and readers find all messages of them.
        let mut writer = WriteOptions::new()
            .profile("ros2")
            .library(concat!("jamgrip ", env!("CARGO_PKG_VERSION")))
            .compression(Some(Compression::Zstd))
            .compression_threads(0)
            .chunk_size(Some(CHUNK))
            .disable_seeking(true)
            .create(NoSeek::new(BufWriter::new(disk)))?;
        writer.attach(&Attachment {
            log_time: 0,
            create_time: 0,
            name: "scene.yaml".to_owned(),
            media_type: "application/yaml".to_owned(),
            data: scene_text.as_bytes().into(),
        })?;
        let mut channels = Vec::with_capacity(topics.len());
        for topic in topics {
            let kind = topic.message_type;
            let schema = writer.add_schema(kind.name, "ros2msg", kind.definition.as_bytes())?;
            let metadata = BTreeMap::from([
                ("offered_qos_profiles".to_owned(), qos_profiles(topic.qos)),
                ("topic_type_hash".to_owned(), kind.type_hash.to_owned()),
            ]);
            channels.push(writer.add_channel(schema, &topic.name, "cdr", &metadata)?);
        }
        writer.flush()?;
        Ok(Self { writer, full, channels, bytes: Vec::new() })
    }

    fn write(&mut self, message: &Message, n_before: u64) -> Result<(), McapError> {
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
}

/// An error and what caused it: the crate's own words say little.
fn text(error: &McapError) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text += &format!(": {error}");
        cause = error.source();
    }
    text
}

fn record<const N: usize>(name: &str, values: [(&str, String); N]) -> Metadata {
    let metadata = values.map(|(key, value)| (key.to_owned(), value)).into();
    Metadata { name: name.to_owned(), metadata }
}

#[expect(clippy::disallowed_methods, reason = "a crash must not lose more than a second of work")]
fn now() -> Instant {
    Instant::now()
}
