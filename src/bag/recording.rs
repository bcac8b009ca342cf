//! The data of a recording that are needed to simulate its run again: the scene, the commands with
//! their ticks, the digests, and the locations of the checkpoints.

use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufReader, Seek, SeekFrom},
    path::{Path, PathBuf},
};

use super::{
    CHECKPOINT, OpenBagError, SCENE, SCENE_FILE, START,
    chain::Chain,
    files,
    reader::{Damage, Item, Reader, RecordedMessage, decompress},
    writer::CDR_HEADER,
};
use crate::wire::{
    messages::{
        RosMessage,
        jamgrip_msgs::{StateDigest, Statistics, WorldChange},
    },
    topics::{NODE, Topic},
};

/// The fact that lists the command topics, in the order of the topic list.
pub const INPUTS: &str = "inputs";

/// The part of a recording before its first message.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// Its files, in the order they were written.
    pub files: Vec<PathBuf>,
    /// The resolved scene, if there is one.
    pub scene_text: Option<String>,
    /// Files that the scene refers to: name and contents.
    pub scene_files: Vec<(String, Vec<u8>)>,
    /// Seed, version and more, as texts.
    pub facts: BTreeMap<String, String>,
    /// The program that wrote it.
    pub library: String,
}

/// The history of a run, tick by tick.
#[derive(Clone, Debug, Default)]
pub struct RunHistory {
    /// Ticks and the digests after them, in ascending order.
    pub digests: Vec<(u64, u64)>,
    /// True if there is a digest for every tick. False in old recordings, which only have the
    /// digests in their statistics.
    pub is_every_tick: bool,
    /// Commands, in the order they took effect.
    pub commands: Vec<RecordedCommand>,
    /// Changes of the world between ticks, in order.
    pub changes: Vec<RecordedChange>,
    /// Locations of the checkpoints, in ascending order of ticks.
    pub checkpoints: Vec<CheckpointLocation>,
    /// Damaged parts of the files.
    pub damages: Vec<(PathBuf, Damage)>,
    /// The first tick whose chained digest does not match.
    pub broken_at: Option<u64>,
    /// The first tick after which at least one tick is missing.
    pub gap_after: Option<u64>,
}

/// A recorded command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedCommand {
    /// The tick in which it took effect.
    pub tick: u64,
    /// Its topic.
    pub topic: String,
    /// The body in CDR.
    pub cdr: Vec<u8>,
}

/// A recorded change of the world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedChange {
    /// The tick after which it was made.
    pub tick: u64,
    /// Description of the change.
    pub what: String,
    /// The change, encoded for `Change::from_bytes`.
    pub change: Vec<u8>,
    /// Digest of the state after the change, and after others made with it.
    pub digest: Option<u64>,
}

/// The location of a checkpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CheckpointLocation {
    /// The tick after which it was taken.
    pub tick: u64,
    file: PathBuf,
    offset: u64,
}

impl Recording {
    /// Reads the part before the first message.
    ///
    /// # Errors
    /// If there is no file, or the first one cannot be opened.
    pub fn open(path: &Path) -> Result<Self, OpenBagError> {
        let files = files(path)?;
        let first = files[0].clone();
        let reader = Reader::open(&first)
            .map_err(|error| OpenBagError::Unreadable { path: first.clone(), error })?;
        let mut recording = Self { files, ..Self::default() };
        for item in reader {
            match item {
                Item::Header(header) => recording.library = header.library,
                Item::Metadata(it) if it.name == START => recording.facts = it.metadata,
                Item::Attachment(it) if it.name == SCENE => {
                    recording.scene_text = Some(String::from_utf8_lossy(&it.data).into_owned());
                }
                Item::Attachment(it) => {
                    if let Some(name) = it.name.strip_prefix(SCENE_FILE) {
                        recording.scene_files.push((name.to_owned(), it.data));
                    }
                }
                Item::Message(_) | Item::Damage(_) => break,
                _ => {}
            }
        }
        Ok(recording)
    }

    /// The version that recorded it.
    pub fn version(&self) -> &str {
        let by_library = || self.library.strip_prefix("jamgrip ");
        self.facts.get("version").map(String::as_str).or_else(by_library).unwrap_or("unknown")
    }

    /// The command topics, if the recording lists them. The node may have other names than in the
    /// scene.
    pub fn inputs(&self) -> Option<Vec<String>> {
        serde_json::from_str(self.facts.get(INPUTS)?).ok()
    }

    /// Reads all files: digests, commands on the inputs among `topics`, and locations of
    /// checkpoints. A tick has `tick_ns` nanoseconds.
    ///
    /// # Errors
    /// If a file cannot be opened.
    pub fn history(&self, topics: &[Topic], tick_ns: u64) -> io::Result<RunHistory> {
        let names = || topics.iter().filter(|it| it.is_input).map(|it| it.name.clone()).collect();
        let inputs = self.inputs().unwrap_or_else(names);
        self.read_history(Inputs::Named(inputs), tick_ns)
    }

    /// As [`Recording::history`], but recognizes command topics by their names; for callers without
    /// a scene.
    ///
    /// # Errors
    /// If a file cannot be opened.
    pub fn history_without_scene(&self, tick_ns: u64) -> io::Result<RunHistory> {
        self.read_history(self.inputs().map_or(Inputs::ByName, Inputs::Named), tick_ns)
    }

    fn read_history(&self, inputs: Inputs, tick_ns: u64) -> io::Result<RunHistory> {
        let mut history = HistoryReader {
            inputs,
            tick_ns,
            chain: self.scene_text.as_deref().map(Chain::new),
            statistics_digests: Vec::new(),
            history: RunHistory::default(),
        };
        for file in &self.files {
            let mut reader = Reader::open(file)?;
            loop {
                let offset = reader.offset();
                let Some(item) = reader.next() else { break };
                history.add(item, file, offset);
            }
        }
        Ok(history.finish())
    }
}

impl RunHistory {
    /// The last checkpoint at or before a tick.
    pub fn checkpoint_before(&self, tick: u64) -> Option<&CheckpointLocation> {
        let n = self.checkpoints.partition_point(|it| it.tick <= tick);
        self.checkpoints[..n].last()
    }

    /// The checkpoint after a tick.
    pub fn checkpoint_at(&self, tick: u64) -> Option<&CheckpointLocation> {
        self.checkpoint_before(tick).filter(|it| it.tick == tick)
    }

    /// The digest of the state after a tick.
    pub fn digest_of(&self, tick: u64) -> Option<u64> {
        let found = self.digests.binary_search_by_key(&tick, |(at, _)| *at).ok()?;
        Some(self.digests[found].1)
    }

    /// Changes of the world after a tick.
    pub fn changes_after(&self, tick: u64) -> impl Iterator<Item = &RecordedChange> {
        self.changes.iter().filter(move |it| it.tick == tick)
    }

    /// The last tick with a known digest.
    pub fn last_tick(&self) -> u64 {
        self.digests.last().map_or(0, |(tick, _)| *tick)
    }
}

impl CheckpointLocation {
    /// Reads the checkpoint.
    ///
    /// # Errors
    /// If the file has changed since its location was read.
    pub fn read(&self) -> io::Result<Vec<u8>> {
        let mut file = File::open(&self.file)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(self.offset))?;
        let rest = Reader::from_record(BufReader::new(file), self.offset, length);
        for item in rest.take(1) {
            if let Item::Attachment(it) = item {
                return decompress(&it.data);
            }
        }
        Err(io::Error::new(io::ErrorKind::InvalidData, "the checkpoint is no longer in the file"))
    }
}

/// How to recognize command topics.
enum Inputs {
    /// By this list.
    Named(Vec<String>),
    /// By the names of the default node's topics.
    ByName,
}

impl Inputs {
    fn contains(&self, topic: &str) -> bool {
        match self {
            Self::Named(names) => names.iter().any(|it| it == topic),
            Self::ByName => {
                let is_command = topic.ends_with("_cmd") || topic.ends_with("/joint_commands");
                topic.starts_with(NODE) && is_command
            }
        }
    }
}

/// Collects the history from the items of the files.
struct HistoryReader {
    inputs: Inputs,
    tick_ns: u64,
    chain: Option<Chain>,
    /// Ticks and digests from the statistics.
    statistics_digests: Vec<(u64, u64)>,
    history: RunHistory,
}

impl HistoryReader {
    fn add(&mut self, item: Item, file: &Path, offset: u64) {
        match item {
            Item::Message(message) => self.message(&message),
            Item::Attachment(it) => {
                let tick = it.name.strip_prefix(CHECKPOINT).and_then(|it| it.parse().ok());
                if let Some(tick) = tick {
                    let file = file.to_owned();
                    self.history.checkpoints.push(CheckpointLocation { tick, file, offset });
                }
            }
            Item::Damage(damage) => self.history.damages.push((file.to_owned(), damage)),
            _ => {}
        }
    }

    fn message(&mut self, message: &RecordedMessage) {
        let (topic, type_name) = (&message.channel.topic, message.channel.type_name());
        let Some(cdr) = message.data.strip_prefix(&CDR_HEADER) else { return };
        // Recognized by type, because the node may have another name.
        if type_name == StateDigest::TYPE.name {
            if let Ok(link) = StateDigest::from_cdr(cdr) {
                self.link(&link);
            }
        } else if type_name == WorldChange::TYPE.name {
            if let Some(chain) = &mut self.chain {
                chain.command(topic, cdr);
            }
            if let Ok(WorldChange { tick, what, change }) = WorldChange::from_cdr(cdr) {
                self.history.changes.push(RecordedChange { tick, what, change, digest: None });
            }
        } else if type_name == Statistics::TYPE.name {
            if let Ok(it) = Statistics::from_cdr(cdr) {
                self.statistics_digests.push((it.tick, it.state_digest));
            }
        } else if self.inputs.contains(topic) {
            if let Some(chain) = &mut self.chain {
                chain.command(topic, cdr);
            }
            let tick = message.log_time / self.tick_ns + 1;
            self.history.commands.push(RecordedCommand {
                tick,
                topic: topic.clone(),
                cdr: cdr.to_vec(),
            });
        }
    }

    fn link(&mut self, link: &StateDigest) {
        let history = &mut self.history;
        let last = history.digests.last().map(|(tick, _)| *tick);
        let is_of_change = last == Some(link.tick);
        if let Some(last) = last
            && !is_of_change
            && link.tick != last + 1
        {
            history.gap_after = history.gap_after.or(Some(last));
        }
        let fits = self.chain.as_mut().is_none_or(|it| it.link(link.tick, link.digest) == *link);
        if !fits {
            history.broken_at = history.broken_at.or(Some(link.tick));
        }
        match history.changes.last_mut() {
            Some(change) if is_of_change => change.digest = Some(link.digest),
            _ => history.digests.push((link.tick, link.digest)),
        }
    }

    fn finish(mut self) -> RunHistory {
        self.history.is_every_tick = !self.history.digests.is_empty();
        if !self.history.is_every_tick {
            self.history.digests = self.statistics_digests;
            self.history.digests.dedup();
        }
        self.history.checkpoints.sort_by_key(|it| it.tick);
        self.history
    }
}
