//! Counts the contents of a recording, message by message and without an index.

use std::{
    collections::BTreeMap,
    fmt, fs, io,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};

use super::{
    CHECKPOINT, OpenBagError, SCENE,
    metadata::{FileContents, TopicMetadata},
    reader::{Attachment, Channel, Damage, Item, Reader},
    recording::Recording,
};

/// The contents of a recording.
#[derive(Clone, Debug, Default)]
pub struct Info {
    /// Its files.
    pub files: Vec<FileInfo>,
    /// Topics by name.
    pub topics: BTreeMap<String, TopicInfo>,
    /// The facts recorded about the run.
    pub facts: BTreeMap<String, String>,
    /// The program that wrote it.
    pub library: String,
    /// True if a scene is attached.
    pub has_scene: bool,
    /// Ticks of the checkpoints.
    pub checkpoints: Vec<u64>,
    /// Names of all other attachments.
    pub attachments: Vec<String>,
}

/// The contents of a file.
#[derive(Clone, Debug, Default)]
pub struct FileInfo {
    /// Its path.
    pub path: PathBuf,
    /// Its length (bytes).
    pub n_bytes: u64,
    /// Number of messages on each topic.
    pub counts: BTreeMap<String, u64>,
    /// Times of the first and last message (ns).
    pub times: Option<(u64, u64)>,
    /// Damaged parts.
    pub damages: Vec<Damage>,
}

/// A topic.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TopicInfo {
    /// Name of the type.
    pub type_name: String,
    /// Encoding of the messages.
    pub encoding: String,
    /// Offered QoS profiles as YAML.
    pub qos: String,
    /// Hash of the type description.
    pub type_hash: String,
    /// Number of messages.
    pub n_messages: u64,
}

impl FileInfo {
    /// Total number of messages.
    pub fn n_messages(&self) -> u64 {
        self.counts.values().sum()
    }

    /// Counts a message.
    pub fn add(&mut self, topic: &str, time_ns: u64) {
        match self.counts.get_mut(topic) {
            Some(count) => *count += 1,
            None => drop(self.counts.insert(topic.to_owned(), 1)),
        }
        let (first, last) = self.times.unwrap_or((time_ns, time_ns));
        self.times = Some((first.min(time_ns), last.max(time_ns)));
    }
}

impl TopicInfo {
    /// A topic without messages.
    pub fn of(channel: &Channel) -> Self {
        let known = |key: &str| channel.metadata.get(key).cloned().unwrap_or_default();
        Self {
            type_name: channel.type_name().to_owned(),
            encoding: channel.encoding.clone(),
            qos: known("offered_qos_profiles"),
            type_hash: known("topic_type_hash"),
            n_messages: 0,
        }
    }
}

impl Info {
    /// Reads and counts a recording.
    ///
    /// # Errors
    /// If the path is not a recording.
    pub fn read(path: &Path) -> Result<Self, OpenBagError> {
        let recording = Recording::open(path)?;
        let mut info = Self {
            facts: recording.facts,
            library: recording.library,
            has_scene: recording.scene_text.is_some(),
            ..Self::default()
        };
        for path in recording.files {
            info.read_file(&path).map_err(|error| OpenBagError::Unreadable { path, error })?;
        }
        Ok(info)
    }

    fn read_file(&mut self, path: &Path) -> io::Result<()> {
        let n_bytes = fs::metadata(path)?.len();
        let mut file = FileInfo { path: path.to_owned(), n_bytes, ..FileInfo::default() };
        for item in Reader::open(path)? {
            match item {
                Item::Channel(channel) => self.add_topic(&channel),
                Item::Message(message) => {
                    file.add(&message.channel.topic, message.log_time);
                    if let Some(topic) = self.topics.get_mut(&message.channel.topic) {
                        topic.n_messages += 1;
                    }
                }
                Item::Attachment(attachment) => self.add_attachment(&attachment),
                Item::Damage(damage) => file.damages.push(damage),
                _ => {}
            }
        }
        self.files.push(file);
        Ok(())
    }

    fn add_topic(&mut self, channel: &Channel) {
        self.topics.entry(channel.topic.clone()).or_insert_with(|| TopicInfo::of(channel));
    }

    fn add_attachment(&mut self, attachment: &Attachment) {
        match attachment.name.strip_prefix(CHECKPOINT).and_then(|it| it.parse().ok()) {
            Some(tick) => self.checkpoints.push(tick),
            None if attachment.name != SCENE && !self.attachments.contains(&attachment.name) => {
                self.attachments.push(attachment.name.clone());
            }
            None => {}
        }
    }

    /// Times of the first and last message (ns).
    pub fn times(&self) -> Option<(u64, u64)> {
        let first = self.files.iter().filter_map(|it| Some(it.times?.0)).min()?;
        let last = self.files.iter().filter_map(|it| Some(it.times?.1)).max()?;
        Some((first, last))
    }

    /// Total number of messages.
    pub fn n_messages(&self) -> u64 {
        self.files.iter().map(FileInfo::n_messages).sum()
    }

    /// True if no file is damaged.
    pub fn is_undamaged(&self) -> bool {
        self.files.iter().all(|file| file.damages.is_empty())
    }

    /// The topics and files for `metadata.yaml`.
    pub fn metadata(&self) -> (Vec<TopicMetadata>, Vec<FileContents>) {
        let row = |(name, topic): (&String, &TopicInfo)| TopicMetadata {
            name: name.clone(),
            type_name: topic.type_name.clone(),
            encoding: topic.encoding.clone(),
            qos: super::metadata::qos_with_names(&topic.qos),
            type_hash: topic.type_hash.clone(),
        };
        let contents = |file: &FileInfo| FileContents {
            file: file.path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            counts: self.topics.keys().map(|it| *file.counts.get(it).unwrap_or(&0)).collect(),
            times: file.times,
        };
        (self.topics.iter().map(row).collect(), self.files.iter().map(contents).collect())
    }

    /// The contents as JSON.
    pub fn to_json(&self) -> Value {
        let times = self.times();
        let file = |it: &FileInfo| {
            let damages: Vec<String> = it.damages.iter().map(ToString::to_string).collect();
            json!({
                "path": it.path.display().to_string(),
                "bytes": it.n_bytes,
                "messages": it.n_messages(),
                "damages": damages,
            })
        };
        let topic = |(name, it): (&String, &TopicInfo)| {
            let value = json!({"type": it.type_name, "messages": it.n_messages});
            (name.clone(), value)
        };
        json!({
            "files": self.files.iter().map(file).collect::<Vec<_>>(),
            "topics": self.topics.iter().map(topic).collect::<serde_json::Map<_, _>>(),
            "messages": self.n_messages(),
            "start_ns": times.map(|it| it.0),
            "end_ns": times.map(|it| it.1),
            "library": self.library,
            "facts": self.facts,
            "has_scene": self.has_scene,
            "checkpoints": self.checkpoints,
            "attachments": self.attachments,
            "is_whole": self.is_undamaged(),
        })
    }
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = |time_ns: u64| std::time::Duration::from_nanos(time_ns).as_secs_f64();
        let (first, last) = self.times().unwrap_or_default();
        writeln!(f, "written by  {}", self.library)?;
        writeln!(f, "starts at   {:.3} s", seconds(first))?;
        writeln!(f, "lasts       {:.3} s", seconds(last - first))?;
        for (key, value) in &self.facts {
            writeln!(f, "{key:<11} {value}")?;
        }
        writeln!(f, "scene       {}", if self.has_scene { "attached" } else { "none" })?;
        let ticks: Vec<String> = self.checkpoints.iter().map(ToString::to_string).collect();
        if !ticks.is_empty() {
            writeln!(f, "checkpoints after ticks {}", ticks.join(", "))?;
        }
        for name in &self.attachments {
            writeln!(f, "attached    {name}")?;
        }
        for file in &self.files {
            let (path, n_messages) = (file.path.display(), file.n_messages());
            writeln!(f, "{path}: {n_messages} messages, {} bytes", file.n_bytes)?;
            file.damages.iter().try_for_each(|damage| writeln!(f, "  damaged: {damage}"))?;
        }
        let width = self.topics.keys().map(String::len).max().unwrap_or(0);
        for (name, topic) in &self.topics {
            writeln!(f, "{:>9} {name:<width$}  {}", topic.n_messages, topic.type_name)?;
        }
        Ok(())
    }
}
