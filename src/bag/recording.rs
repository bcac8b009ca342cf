//! All of a recording that is needed to run it again: the scene, the commands with their ticks, the
//! digests, and where the checkpoints are.

use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufReader, Seek, SeekFrom},
    path::{Path, PathBuf},
};

use super::{
    CHECKPOINT, NotABag, SCENE, SCENE_FILE, START,
    chain::Chain,
    files,
    reader::{Damage, Item, Reader, Recorded, unpacked},
    writer::CDR_HEADER,
};
use crate::wire::{
    messages::{
        RosMessage,
        jamgrip_msgs::{StateDigest, Statistics, WorldChange},
    },
    topics::{NODE, Topic},
};

/// The fact that names the topics of commands, in the order of the list of topics.
pub const INPUTS: &str = "inputs";

/// What a recording says about its run before anything happens in it.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    /// Its files, in the order they were written.
    pub files: Vec<PathBuf>,
    /// The resolved scene, if there is one.
    pub scene_text: Option<String>,
    /// Files that the scene names: name and contents.
    pub scene_files: Vec<(String, Vec<u8>)>,
    /// Seed, version and more, as texts.
    pub facts: BTreeMap<String, String>,
    /// What wrote it.
    pub library: String,
}

/// What happened in a run, tick by tick.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// Ticks and the digests after them, ascending.
    pub digests: Vec<(u64, u64)>,
    /// True if there is a digest for every tick; false in recordings from before there were, which
    /// have some in their statistics.
    pub is_every_tick: bool,
    /// Commands in the order they took effect.
    pub commands: Vec<Order>,
    /// What was done to the world between ticks, in this order.
    pub changes: Vec<Alteration>,
    /// Where all that is needed to go on is kept, ascending.
    pub checkpoints: Vec<Place>,
    /// What is wrong with the files.
    pub damages: Vec<(PathBuf, Damage)>,
    /// The first tick whose link does not fit what is before it.
    pub broken_at: Option<u64>,
    /// The first tick after which at least one is missing.
    pub gap_after: Option<u64>,
}

/// A command as it was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// The tick in which it took effect.
    pub tick: u64,
    /// Its topic.
    pub topic: String,
    /// The body in CDR.
    pub cdr: Vec<u8>,
}

/// A change of the world as it was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alteration {
    /// The tick after which it was made.
    pub tick: u64,
    /// What was done, in words.
    pub what: String,
    /// The same as bytes that `Change::from_bytes` reads.
    pub change: Vec<u8>,
    /// Digest of the state after it, and after others that were made with it.
    pub digest: Option<u64>,
}

/// Where a checkpoint is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The tick after which it was taken.
    pub tick: u64,
    file: PathBuf,
    offset: u64,
}

impl Recording {
    /// Reads what comes before the first message.
    ///
    /// # Errors
    /// If there is no file, or the first cannot be opened.
    pub fn open(path: &Path) -> Result<Self, NotABag> {
        let files = files(path)?;
        let first = files[0].clone();
        let reader = Reader::open(&first)
            .map_err(|fault| NotABag::Unreadable { path: first.clone(), fault })?;
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

    /// The topics of commands, where the recording says which: a node may have other names than the
    /// scene says.
    pub fn inputs(&self) -> Option<Vec<String>> {
        serde_json::from_str(self.facts.get(INPUTS)?).ok()
    }

    /// Reads all files: digests, commands on those of `topics` that are inputs, places of
    /// checkpoints. A tick has `tick_ns` nanoseconds.
    ///
    /// # Errors
    /// If a file cannot be opened.
    pub fn course(&self, topics: &[Topic], tick_ns: u64) -> io::Result<Course> {
        let names = || topics.iter().filter(|it| it.is_input).map(|it| it.name.clone()).collect();
        let inputs = self.inputs().unwrap_or_else(names);
        self.read_course(Inputs::Named(inputs), tick_ns)
    }

    /// As `course`, with the inputs told by their names alone: for those who do not read the scene.
    ///
    /// # Errors
    /// If a file cannot be opened.
    pub fn course_of_all(&self, tick_ns: u64) -> io::Result<Course> {
        self.read_course(self.inputs().map_or(Inputs::ByName, Inputs::Named), tick_ns)
    }

    fn read_course(&self, inputs: Inputs, tick_ns: u64) -> io::Result<Course> {
        let mut clerk = Clerk {
            inputs,
            tick_ns,
            chain: self.scene_text.as_deref().map(Chain::new),
            sparse: Vec::new(),
            course: Course::default(),
        };
        for file in &self.files {
            let mut reader = Reader::open(file)?;
            loop {
                let offset = reader.offset();
                let Some(item) = reader.next() else { break };
                clerk.note(item, file, offset);
            }
        }
        Ok(clerk.finish())
    }
}

impl Course {
    /// The last checkpoint at or before a tick.
    pub fn checkpoint_before(&self, tick: u64) -> Option<&Place> {
        let n = self.checkpoints.partition_point(|place| place.tick <= tick);
        self.checkpoints[..n].last()
    }

    /// The checkpoint after a tick.
    pub fn checkpoint_at(&self, tick: u64) -> Option<&Place> {
        self.checkpoint_before(tick).filter(|place| place.tick == tick)
    }

    /// The digest of the state after a tick.
    pub fn digest_of(&self, tick: u64) -> Option<u64> {
        let found = self.digests.binary_search_by_key(&tick, |(at, _)| *at).ok()?;
        Some(self.digests[found].1)
    }

    /// What was done to the world after a tick.
    pub fn changes_after(&self, tick: u64) -> impl Iterator<Item = &Alteration> {
        self.changes.iter().filter(move |it| it.tick == tick)
    }

    /// The last tick whose digest is known.
    pub fn last_tick(&self) -> u64 {
        self.digests.last().map_or(0, |(tick, _)| *tick)
    }
}

impl Place {
    /// Reads the checkpoint.
    ///
    /// # Errors
    /// If the file is not as it was when the place was noted.
    pub fn read(&self) -> io::Result<Vec<u8>> {
        let mut file = File::open(&self.file)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(self.offset))?;
        let rest = Reader::from_record(BufReader::new(file), self.offset, length);
        for item in rest.take(1) {
            if let Item::Attachment(it) = item {
                return unpacked(&it.data);
            }
        }
        Err(io::Error::new(io::ErrorKind::InvalidData, "no checkpoint where there was one"))
    }
}

/// Which topics carry commands.
enum Inputs {
    /// These.
    Named(Vec<String>),
    /// Those of our node whose names say so.
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

/// Notes what is read.
struct Clerk {
    inputs: Inputs,
    tick_ns: u64,
    chain: Option<Chain>,
    sparse: Vec<(u64, u64)>,
    course: Course,
}

impl Clerk {
    fn note(&mut self, item: Item, file: &Path, offset: u64) {
        match item {
            Item::Message(message) => self.message(&message),
            Item::Attachment(it) => {
                let tick = it.name.strip_prefix(CHECKPOINT).and_then(|it| it.parse().ok());
                if let Some(tick) = tick {
                    let file = file.to_owned();
                    self.course.checkpoints.push(Place { tick, file, offset });
                }
            }
            Item::Damage(damage) => self.course.damages.push((file.to_owned(), damage)),
            _ => {}
        }
    }

    fn message(&mut self, message: &Recorded) {
        let (topic, kind) = (&message.channel.topic, message.channel.type_name());
        let Some(cdr) = message.data.strip_prefix(&CDR_HEADER) else { return };
        // By their types: a node may have other names than usual.
        if kind == StateDigest::TYPE.name {
            if let Ok(link) = StateDigest::from_cdr(cdr) {
                self.link(&link);
            }
        } else if kind == WorldChange::TYPE.name {
            if let Some(chain) = &mut self.chain {
                chain.command(topic, cdr);
            }
            if let Ok(WorldChange { tick, what, change }) = WorldChange::from_cdr(cdr) {
                self.course.changes.push(Alteration { tick, what, change, digest: None });
            }
        } else if kind == Statistics::TYPE.name {
            if let Ok(it) = Statistics::from_cdr(cdr) {
                self.sparse.push((it.tick, it.state_digest));
            }
        } else if self.inputs.contains(topic) {
            if let Some(chain) = &mut self.chain {
                chain.command(topic, cdr);
            }
            let tick = message.log_time / self.tick_ns + 1;
            self.course.commands.push(Order { tick, topic: topic.clone(), cdr: cdr.to_vec() });
        }
    }

    fn link(&mut self, link: &StateDigest) {
        let course = &mut self.course;
        let last = course.digests.last().map(|(tick, _)| *tick);
        let is_of_change = last == Some(link.tick);
        if let Some(last) = last
            && !is_of_change
            && link.tick != last + 1
        {
            course.gap_after = course.gap_after.or(Some(last));
        }
        let fits = self.chain.as_mut().is_none_or(|it| it.link(link.tick, link.digest) == *link);
        if !fits {
            course.broken_at = course.broken_at.or(Some(link.tick));
        }
        match course.changes.last_mut() {
            Some(change) if is_of_change => change.digest = Some(link.digest),
            _ => course.digests.push((link.tick, link.digest)),
        }
    }

    fn finish(mut self) -> Course {
        self.course.is_every_tick = !self.course.digests.is_empty();
        if !self.course.is_every_tick {
            self.course.digests = self.sparse;
            self.course.digests.dedup();
        }
        self.course.checkpoints.sort_by_key(|place| place.tick);
        self.course
    }
}
