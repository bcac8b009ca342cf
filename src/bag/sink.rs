//! Writes recordings: rosbag2 folders of MCAP files.
//!
//! A recording holds all published messages, all received commands including rejected ones, changes
//! of the world between ticks, the digest of every tick, and regular checkpoints. Log times are
//! times of the run: simulation time, except that they continue when it is reset, because readers
//! sort by them. A command is logged at the start of its tick.

use std::{
    collections::BTreeMap,
    error::Error,
    fs,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};

pub use crate::bag::{Format, RunDescription};
use crate::io::sink::{Packet, Sink};
use crate::{
    bag::{
        chain::{self, Chain},
        disk::{RESERVE, is_full},
        metadata::{FileContents, TopicMetadata, file_text, information},
        writer::{OpenFile, WriteError, io_error, text},
    },
    command::change::Change,
    wire::{
        messages::{RosMessage, jamgrip_msgs::WorldChange},
        to_ros::Encoder,
        topics::{Message, Topic},
    },
};

/// A crash loses at most the messages of this wall-clock time.
const FLUSH_PERIOD: Duration = Duration::from_secs(1);
/// Why recording has stopped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BagError {
    /// The folder is not empty.
    #[error(
        "bag folder {}: is not empty; choose another folder, or move its contents",
        folder.display()
    )]
    FolderInUse {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder or a file in it cannot be created.
    #[error(
        "bag folder {}: cannot create {} ({reason}); choose a writable folder \
         on a disk with at least {} MiB of free space",
        folder.display(), path.display(), RESERVE >> 20
    )]
    CannotCreate {
        /// The folder.
        folder: PathBuf,
        /// The file or folder that could not be created.
        path: PathBuf,
        /// Reason given by the operating system.
        reason: String,
    },
    /// The disk is full.
    #[error(
        "bag folder {}: the disk is full after {:.3} s of simulation time; the recording up \
         to there is complete; free some space, or choose another disk",
        folder.display(), seconds(*recorded_ns)
    )]
    DiskFull {
        /// The folder.
        folder: PathBuf,
        /// Simulation time of the last message (ns).
        recorded_ns: u64,
    },
    /// The disk reported an error.
    #[error(
        "bag folder {}: cannot write {} ({reason}); recorded up to {:.3} s of simulation time; \
         check the disk, or choose another",
        folder.display(), path.display(), seconds(*recorded_ns)
    )]
    CannotWrite {
        /// The folder.
        folder: PathBuf,
        /// The file.
        path: PathBuf,
        /// Reason given by the operating system.
        reason: String,
        /// Simulation time of the last message (ns).
        recorded_ns: u64,
    },
}

fn seconds(time_ns: u64) -> f64 {
    time_ns as f64 * 1e-9
}

/// The contents of a recording so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BagReport {
    /// Its folder.
    pub folder: PathBuf,
    /// Number of messages on each topic, in the order of the list of topics.
    pub message_counts: Vec<(String, u64)>,
}

/// Provides the report of a recording, during the run and after it.
#[derive(Clone, Debug, Default)]
pub struct BagReporter(Arc<Mutex<BagReport>>);

impl BagReporter {
    /// The contents so far.
    pub fn report(&self) -> BagReport {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A recording that is being written.
pub struct Bag {
    encoder: Arc<Encoder>,
    description: RunDescription,
    folder: PathBuf,
    /// The encoder's topics, then those of digests and changes, then topics added during the run.
    topics: Vec<Topic>,
    /// Index of the digests' topic; the topic of changes follows it.
    digest_topic: usize,
    file: Option<OpenFile>,
    /// Contents of the files; the open file is the last.
    files: Vec<FileContents>,
    /// Number of messages written so far on each topic.
    n_written: Vec<u64>,
    /// The last message on each latched topic; repeated at the start of a new file.
    latched: BTreeMap<usize, Message>,
    chain: Chain,
    /// Digest of the last state.
    digest: u64,
    /// Sequence number of the last packet.
    packet_number: u64,
    /// Why recording has stopped early.
    error: Option<BagError>,
    flushed_at: Instant,
    reporter: BagReporter,
}

impl Bag {
    /// Starts a recording in a new or empty folder.
    ///
    /// # Errors
    /// If the folder is not empty or not writable, or its disk is full.
    pub fn create(
        folder: &Path,
        encoder: Arc<Encoder>,
        description: RunDescription,
    ) -> Result<Self, BagError> {
        let cannot_create = |path: &Path, reason: String| BagError::CannotCreate {
            folder: folder.to_owned(),
            path: path.to_owned(),
            reason,
        };
        fs::create_dir_all(folder).map_err(|e| cannot_create(folder, e.to_string()))?;
        let mut entries = fs::read_dir(folder).map_err(|e| cannot_create(folder, e.to_string()))?;
        if entries.next().is_some() {
            return Err(BagError::FolderInUse { folder: folder.to_owned() });
        }
        let mut topics = encoder.topics().to_vec();
        let digest_topic = topics.len();
        let node = &encoder.scene().outputs.ros.node;
        topics.push(chain::topic(node));
        topics.push(chain::changes_topic(node));
        let mut bag = Self {
            folder: folder.to_owned(),
            file: None,
            files: Vec::new(),
            n_written: vec![0; topics.len()],
            latched: BTreeMap::new(),
            chain: Chain::new(&description.scene_text),
            digest: 0,
            packet_number: 0,
            error: None,
            flushed_at: now(),
            reporter: BagReporter::default(),
            topics,
            digest_topic,
            encoder,
            description,
        };
        bag.begin_file().map_err(|error| {
            // Best effort: an empty folder can be used again.
            let _ = fs::remove_file(bag.path());
            cannot_create(&bag.path(), text(&error))
        })?;
        bag.update_metadata().map_err(|e| cannot_create(&bag.metadata_path(), e.to_string()))?;
        Ok(bag)
    }

    /// The reporter of this recording.
    pub fn reporter(&self) -> BagReporter {
        self.reporter.clone()
    }

    fn metadata_path(&self) -> PathBuf {
        self.folder.join("metadata.yaml")
    }

    /// The file that is open, or was last.
    fn path(&self) -> PathBuf {
        self.folder.join(self.files.last().map_or("", |it| &it.file))
    }

    fn begin_file(&mut self) -> Result<(), WriteError> {
        let name = self.folder.file_name().map_or("bag".into(), |name| name.to_string_lossy());
        let name = format!("{name}_{}.mcap", self.files.len());
        self.files.push(FileContents::new(name, self.topics.len()));
        self.file = Some(OpenFile::create(&self.path(), &self.topics, &self.description)?);
        Ok(())
    }

    /// True for a packet that is sent again while the simulation is paused.
    fn is_repeated(&mut self, packet: &Packet) -> bool {
        let before = std::mem::replace(&mut self.packet_number, packet.number);
        packet.number != 0 && packet.number == before
    }

    /// Records a packet's commands, changes, messages, digest and checkpoints.
    fn record(&mut self, packet: &Packet) -> Result<(), WriteError> {
        let snapshot = &packet.snapshot;
        let encoder = Arc::clone(&self.encoder);
        let time_ns = snapshot.run_tick.time_ns(encoder.tick_ns());
        let begin_ns = time_ns.saturating_sub(encoder.tick_ns());
        if self.is_split_due(time_ns) {
            self.split(begin_ns)?;
        }
        if self.chain.tick().is_none() && self.n_written.iter().all(|n| *n == 0) {
            encoder.latched(begin_ns).iter().try_for_each(|message| self.write_message(message))?;
        }
        // The start's checkpoint comes with the first packet; its digest is the first of the chain.
        for it in &packet.checkpoints {
            if it.tick < snapshot.run_tick || !packet.changes.is_empty() {
                self.record_digest(it.tick.0, it.time_ns, it.digest, false)?;
            }
        }
        for change in &packet.changes {
            self.record_change(change, snapshot.run_tick.0, time_ns)?;
        }
        for record in &snapshot.commands {
            let message = encoder.commands().encode(&record.command, begin_ns);
            self.chain.command(&self.topics[message.topic].name, &message.cdr);
            self.write_message(&message)?;
        }
        self.open_topics(packet)?;
        for message in packet.messages(&encoder) {
            let topic = self.recorded_index(message.topic);
            self.write_message(&Message { topic, time_ns, cdr: message.cdr.clone() })?;
        }
        self.record_digest(
            snapshot.run_tick.0,
            time_ns,
            snapshot.digest,
            !packet.changes.is_empty(),
        )?;
        self.digest = snapshot.digest;
        if let Some(file) = &mut self.file {
            packet.checkpoints.iter().try_for_each(|checkpoint| file.attach(checkpoint))?;
        }
        if FLUSH_PERIOD <= self.flushed_at.elapsed() {
            self.flush()?;
        }
        Ok(())
    }

    /// Index in the recording's topics of an encoder's topic.
    fn recorded_index(&self, topic: usize) -> usize {
        if topic < self.digest_topic { topic } else { topic + 2 }
    }

    /// Opens topics that were added since the last packet.
    fn open_topics(&mut self, packet: &Packet) -> Result<(), WriteError> {
        for topic in packet.topics_beyond(self.topics.len() - 2) {
            if let Some(file) = &mut self.file {
                file.open_topic(topic)?;
            }
            self.files.iter_mut().for_each(|it| it.counts.push(0));
            self.n_written.push(0);
            self.topics.push(topic.clone());
        }
        Ok(())
    }

    /// Records the digest of a tick once, and again after a change.
    fn record_digest(
        &mut self,
        tick: u64,
        time_ns: u64,
        digest: u64,
        is_changed: bool,
    ) -> Result<(), WriteError> {
        if !is_changed && self.chain.tick().is_some_and(|last| tick <= last) {
            return Ok(());
        }
        let cdr = self.chain.link(tick, digest).to_cdr();
        self.write_message(&Message { topic: self.digest_topic, time_ns, cdr })
    }

    /// Records a change of the world after a tick.
    fn record_change(
        &mut self,
        change: &Change,
        tick: u64,
        time_ns: u64,
    ) -> Result<(), WriteError> {
        let message = WorldChange { tick, what: change.to_string(), change: change.to_bytes() };
        let (topic, cdr) = (self.digest_topic + 1, message.to_cdr());
        self.chain.command(&self.topics[topic].name, &cdr);
        self.write_message(&Message { topic, time_ns, cdr })
    }

    fn write_message(&mut self, message: &Message) -> Result<(), WriteError> {
        let (Some(file), Some(contents)) = (&mut self.file, self.files.last_mut()) else {
            return Ok(());
        };
        file.write(message, self.n_written[message.topic])?;
        self.n_written[message.topic] += 1;
        contents.add(message.topic, message.time_ns);
        if self.topics[message.topic].qos.is_latched {
            self.latched.insert(message.topic, message.clone());
        }
        Ok(())
    }

    fn is_split_due(&self, time_ns: u64) -> bool {
        let (Some(file), Some(contents)) = (&self.file, self.files.last()) else { return false };
        let Some((first_ns, _)) = contents.times else { return false };
        let Format { split_bytes, split_ns, .. } = self.description.format;
        split_bytes.is_some_and(|limit| limit <= file.status().n_bytes())
            || split_ns.is_some_and(|limit| limit < time_ns - first_ns)
    }

    /// Completes the file and starts the next one, which begins with the latched messages.
    fn split(&mut self, time_ns: u64) -> Result<(), WriteError> {
        self.complete_file()?;
        self.begin_file()?;
        for (_, message) in std::mem::take(&mut self.latched) {
            self.write_message(&Message { time_ns, ..message })?;
        }
        Ok(self.update_metadata()?)
    }

    /// Passes all data to the operating system.
    fn flush(&mut self) -> Result<(), WriteError> {
        self.flushed_at = now();
        if let Some(file) = &mut self.file {
            file.flush()?;
        }
        Ok(self.update_metadata()?)
    }

    fn topic_rows(&self) -> Vec<TopicMetadata> {
        self.topics.iter().map(TopicMetadata::of).collect()
    }

    /// Replaces `metadata.yaml` atomically and updates the report.
    fn update_metadata(&mut self) -> io::Result<()> {
        let names = self.topics.iter().map(|topic| topic.name.clone());
        let report = BagReport {
            folder: self.folder.clone(),
            message_counts: names.zip(self.n_written.iter().copied()).collect(),
        };
        *self.reporter.0.lock().unwrap_or_else(PoisonError::into_inner) = report;
        let path = self.metadata_path();
        let draft = path.with_extension("yaml.new");
        fs::write(&draft, file_text(&self.topic_rows(), &self.files))?;
        fs::rename(&draft, &path)
    }

    /// Completes the open file, if there is one.
    fn complete_file(&mut self) -> Result<(), WriteError> {
        let Some(file) = self.file.take() else { return Ok(()) };
        let n_messages: u64 = self.n_written.iter().sum();
        let facts = vec![
            ("state_digest", format!("{:016x}", self.digest)),
            ("tick", self.chain.tick().unwrap_or(0).to_string()),
            ("message_count", n_messages.to_string()),
        ];
        file.finish(facts, information(&self.topic_rows(), &self.files))
    }

    /// Completes the recording.
    fn finish(&mut self) -> Result<(), WriteError> {
        self.complete_file()?;
        Ok(self.update_metadata()?)
    }

    /// Stops recording, keeping as much as the disk allows.
    fn end(&mut self, error: &WriteError) -> BagError {
        let recorded_ns = self.files.iter().filter_map(|it| Some(it.times?.1)).max().unwrap_or(0);
        let (folder, path) = (self.folder.clone(), self.path());
        let disk_is_full = io_error(error).is_some_and(is_full);
        let bag_error = match self.finish() {
            Ok(()) if disk_is_full => BagError::DiskFull { folder, recorded_ns },
            _ => BagError::CannotWrite { folder, path, reason: text(error), recorded_ns },
        };
        self.error = Some(bag_error.clone());
        bag_error
    }

    /// Turns a failed write or a full disk into the end of the recording.
    fn check(&mut self, result: Result<(), WriteError>) -> Result<(), BagError> {
        let is_disk_full = self.file.as_ref().is_some_and(|file| file.status().is_full());
        match result {
            Ok(()) if !is_disk_full => Ok(()),
            Ok(()) => Err(self.end(&io::Error::from(ErrorKind::StorageFull).into())),
            Err(error) => Err(self.end(&error)),
        }
    }
}

impl Sink for Bag {
    fn name(&self) -> &'static str {
        "bag"
    }

    /// After an error, nothing more is recorded and every packet returns the same error.
    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn Error + Send + Sync>> {
        if let Some(error) = &self.error {
            return Err(Box::new(error.clone()));
        }
        if self.is_repeated(packet) {
            return Ok(());
        }
        let result = self.record(packet);
        Ok(self.check(result)?)
    }

    fn idle(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        if self.error.is_some() {
            return Ok(());
        }
        let result = self.flush();
        Ok(self.check(result)?)
    }

    fn close(&mut self) -> Result<(), Box<dyn Error + Send + Sync>> {
        if self.error.is_some() {
            return Ok(());
        }
        let result = self.flush();
        self.check(result)?;
        let result = self.finish();
        Ok(self.check(result)?)
    }
}

#[expect(clippy::disallowed_methods, reason = "a crash must not lose more than a second of work")]
fn now() -> Instant {
    Instant::now()
}
