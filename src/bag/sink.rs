//! Recordings while they are made: a rosbag2 folder of MCAP files.
//!
//! They hold every message that is published, every command that was received, refused ones too,
//! what was done to the world between ticks, the digest of every tick and, now and then, all that is
//! needed to go on. Log times are those of the run: simulated time, except that they go on when it is
//! reset, because readers sort by them. A command has the time at which its tick began.

use std::{
    collections::BTreeMap,
    error::Error,
    fs,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};

pub use crate::bag::{Format, Subject};
use crate::io::sink::{Packet, Sink};
use crate::{
    bag::{
        chain::{self, Chain},
        disk::{RESERVE, is_full},
        metadata::{Contents, Row, file_text, information},
        writer::{OpenFile, WriteError, of_system, text},
    },
    command::change::Change,
    wire::{
        messages::{RosMessage, jamgrip_msgs::WorldChange},
        to_ros::Encoder,
        topics::{Message, Topic},
    },
};

/// A crash loses at most what came in this time, in wall time.
const FLUSH_PERIOD: Duration = Duration::from_secs(1);
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
        /// Simulated time of the last message (ns).
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
        /// Simulated time of the last message (ns).
        recorded_ns: u64,
    },
}

fn seconds(time_ns: u64) -> f64 {
    time_ns as f64 * 1e-9
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
    /// The encoder's topics, then those of the digests and of changes, then those that came later.
    topics: Vec<Topic>,
    /// Place of the digests' topic; that of changes is behind it.
    links: usize,
    file: Option<OpenFile>,
    /// What each file holds, the open one last.
    files: Vec<Contents>,
    /// Messages of each topic so far.
    n_sent: Vec<u64>,
    /// The last message of each topic that late readers get; repeated when a new file begins.
    latched: BTreeMap<usize, Message>,
    chain: Chain,
    /// Digest of the last state.
    digest: u64,
    /// Number of the last packet.
    number: u64,
    /// Why the recording has ended early.
    fault: Option<BagError>,
    flushed_at: Instant,
    reporter: BagReporter,
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
        let mut topics = encoder.topics().to_vec();
        let links = topics.len();
        let node = &encoder.scene().outputs.ros.node;
        topics.push(chain::topic(node));
        topics.push(chain::changes_topic(node));
        let mut bag = Self {
            folder: folder.to_owned(),
            file: None,
            files: Vec::new(),
            n_sent: vec![0; topics.len()],
            latched: BTreeMap::new(),
            chain: Chain::new(&subject.scene_text),
            digest: 0,
            number: 0,
            fault: None,
            flushed_at: now(),
            reporter: BagReporter::default(),
            topics,
            links,
            encoder,
            subject,
        };
        bag.begin_file().map_err(|error| {
            // An empty folder can be used again; that it cannot be emptied is the smaller fault.
            let _ = fs::remove_file(bag.path());
            cannot_create(&bag.path(), text(&error))
        })?;
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

    /// The file that is written now, or was last.
    fn path(&self) -> PathBuf {
        self.folder.join(self.files.last().map_or("", |it| &it.file))
    }

    fn begin_file(&mut self) -> Result<(), WriteError> {
        let name = self.folder.file_name().map_or("bag".into(), |name| name.to_string_lossy());
        let name = format!("{name}_{}.mcap", self.files.len());
        self.files.push(Contents::new(name, self.topics.len()));
        self.file = Some(OpenFile::create(&self.path(), &self.topics, &self.subject)?);
        Ok(())
    }

    /// True for a packet that is shown once more while time stands still.
    fn is_known(&mut self, packet: &Packet) -> bool {
        let before = std::mem::replace(&mut self.number, packet.number);
        packet.number != 0 && packet.number == before
    }

    /// Records a packet's commands and messages, its digest and its checkpoints.
    fn record(&mut self, packet: &Packet) -> Result<(), WriteError> {
        let snapshot = &packet.snapshot;
        let encoder = Arc::clone(&self.encoder);
        let time_ns = snapshot.run_tick.time_ns(encoder.tick_ns());
        let begin_ns = time_ns.saturating_sub(encoder.tick_ns());
        if self.is_split_due(time_ns) {
            self.split(begin_ns)?;
        }
        if self.chain.tick().is_none() && self.n_sent.iter().all(|n| *n == 0) {
            encoder.latched(begin_ns).iter().try_for_each(|message| self.put(message))?;
        }
        // The start's checkpoint comes with the first packet: its digest is the first link.
        for it in &packet.checkpoints {
            if it.tick < snapshot.run_tick || !packet.changes.is_empty() {
                self.link(it.tick.0, it.time_ns, it.digest, false)?;
            }
        }
        for change in &packet.changes {
            self.alter(change, snapshot.run_tick.0, time_ns)?;
        }
        for record in &snapshot.commands {
            let message = encoder.commands().encode(&record.command, begin_ns);
            self.chain.command(&self.topics[message.topic].name, &message.cdr);
            self.put(&message)?;
        }
        self.open_topics(packet)?;
        for message in packet.messages(&encoder) {
            let topic = self.place(message.topic);
            self.put(&Message { topic, time_ns, cdr: message.cdr.clone() })?;
        }
        self.link(snapshot.run_tick.0, time_ns, snapshot.digest, !packet.changes.is_empty())?;
        self.digest = snapshot.digest;
        if let Some(file) = &mut self.file {
            packet.checkpoints.iter().try_for_each(|checkpoint| file.attach(checkpoint))?;
        }
        if FLUSH_PERIOD <= self.flushed_at.elapsed() {
            self.flush()?;
        }
        Ok(())
    }

    /// Place among the recording's topics of one of the encoder's.
    fn place(&self, topic: usize) -> usize {
        if topic < self.links { topic } else { topic + 2 }
    }

    /// Topics that have come since the last packet.
    fn open_topics(&mut self, packet: &Packet) -> Result<(), WriteError> {
        for topic in packet.topics_beyond(self.topics.len() - 2) {
            if let Some(file) = &mut self.file {
                file.open_topic(topic)?;
            }
            self.files.iter_mut().for_each(|it| it.counts.push(0));
            self.n_sent.push(0);
            self.topics.push(topic.clone());
        }
        Ok(())
    }

    /// Links a tick, once, and once more after a change.
    fn link(
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
        self.put(&Message { topic: self.links, time_ns, cdr })
    }

    /// Records what was done to the world after a tick.
    fn alter(&mut self, change: &Change, tick: u64, time_ns: u64) -> Result<(), WriteError> {
        let message = WorldChange { tick, what: change.to_string(), change: change.to_bytes() };
        let (topic, cdr) = (self.links + 1, message.to_cdr());
        self.chain.command(&self.topics[topic].name, &cdr);
        self.put(&Message { topic, time_ns, cdr })
    }

    fn put(&mut self, message: &Message) -> Result<(), WriteError> {
        let (Some(file), Some(contents)) = (&mut self.file, self.files.last_mut()) else {
            return Ok(());
        };
        file.write(message, self.n_sent[message.topic])?;
        self.n_sent[message.topic] += 1;
        contents.add(message.topic, message.time_ns);
        if self.topics[message.topic].qos.is_latched {
            self.latched.insert(message.topic, message.clone());
        }
        Ok(())
    }

    fn is_split_due(&self, time_ns: u64) -> bool {
        let (Some(file), Some(contents)) = (&self.file, self.files.last()) else { return false };
        let Some((first_ns, _)) = contents.times else { return false };
        let Format { split_bytes, split_ns, .. } = self.subject.format;
        split_bytes.is_some_and(|longest| longest <= file.gauge().n_bytes())
            || split_ns.is_some_and(|longest| longest < time_ns - first_ns)
    }

    /// Completes the file and begins the next, with what late readers get repeated.
    fn split(&mut self, time_ns: u64) -> Result<(), WriteError> {
        self.complete_file()?;
        self.begin_file()?;
        for (_, message) in std::mem::take(&mut self.latched) {
            self.put(&Message { time_ns, ..message })?;
        }
        Ok(self.note()?)
    }

    /// Hands everything to the operating system.
    fn flush(&mut self) -> Result<(), WriteError> {
        self.flushed_at = now();
        if let Some(file) = &mut self.file {
            file.flush()?;
        }
        Ok(self.note()?)
    }

    fn rows(&self) -> Vec<Row> {
        self.topics.iter().map(Row::of).collect()
    }

    /// Writes `metadata.yaml` anew, in one step, and brings the report up to date.
    fn note(&mut self) -> io::Result<()> {
        let names = self.topics.iter().map(|topic| topic.name.clone());
        let report = BagReport {
            folder: self.folder.clone(),
            message_counts: names.zip(self.n_sent.iter().copied()).collect(),
        };
        *self.reporter.0.lock().unwrap_or_else(PoisonError::into_inner) = report;
        let path = self.metadata_path();
        let draft = path.with_extension("yaml.new");
        fs::write(&draft, file_text(&self.rows(), &self.files))?;
        fs::rename(&draft, &path)
    }

    /// Completes the file that is open, if there is one.
    fn complete_file(&mut self) -> Result<(), WriteError> {
        let Some(file) = self.file.take() else { return Ok(()) };
        let n_messages: u64 = self.n_sent.iter().sum();
        let facts = vec![
            ("state_digest", format!("{:016x}", self.digest)),
            ("tick", self.chain.tick().unwrap_or(0).to_string()),
            ("message_count", n_messages.to_string()),
        ];
        file.finish(facts, information(&self.rows(), &self.files))
    }

    /// Completes the recording.
    fn finish(&mut self) -> Result<(), WriteError> {
        self.complete_file()?;
        Ok(self.note()?)
    }

    /// Ends the recording early, with as much of it kept as the disk allows.
    fn end(&mut self, error: &WriteError) -> BagError {
        let recorded_ns = self.files.iter().filter_map(|it| Some(it.times?.1)).max().unwrap_or(0);
        let (folder, path) = (self.folder.clone(), self.path());
        let disk_is_full = of_system(error).is_some_and(is_full);
        let fault = match self.finish() {
            Ok(()) if disk_is_full => BagError::DiskFull { folder, recorded_ns },
            _ => BagError::CannotWrite { folder, path, fault: text(error), recorded_ns },
        };
        self.fault = Some(fault.clone());
        fault
    }

    /// Says and remembers what became of an attempt; a full disk is found here.
    fn conclude(&mut self, outcome: Result<(), WriteError>) -> Result<(), BagError> {
        let is_disk_full = self.file.as_ref().is_some_and(|file| file.gauge().is_full());
        match outcome {
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

    /// After a fault it gives that fault for every packet: nothing more is recorded.
    fn write(&mut self, packet: &Packet) -> Result<(), Box<dyn Error + Send + Sync>> {
        if let Some(fault) = &self.fault {
            return Err(Box::new(fault.clone()));
        }
        if self.is_known(packet) {
            return Ok(());
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

#[expect(clippy::disallowed_methods, reason = "a crash must not lose more than a second of work")]
fn now() -> Instant {
    Instant::now()
}
