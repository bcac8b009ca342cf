//! Checks a recording for damage, and compares its metadata with its contents.

use std::{
    collections::BTreeMap,
    fs, io,
    path::{Path, PathBuf},
};

use serde_json::Value;

use super::{
    OpenBagError,
    info::Info,
    reader::{ChunkSummary, Item, Reader},
    recording::Recording,
};
use crate::scene::json;

/// A problem in a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// True if data are lost or wrong; false if they are only unusual.
    pub is_error: bool,
    /// The file.
    pub path: PathBuf,
    /// The problem, and what to do.
    pub text: String,
}

/// Checks a whole recording.
///
/// # Errors
/// If the path is not a recording.
pub fn check(path: &Path) -> Result<Vec<Finding>, OpenBagError> {
    let info = Info::read(path)?;
    let mut findings = Vec::new();
    for file in &info.files {
        let mut inspector = Inspector::default();
        let reader = Reader::open(&file.path);
        let reader =
            reader.map_err(|error| OpenBagError::Unreadable { path: file.path.clone(), error })?;
        reader.for_each(|item| inspector.inspect(&item));
        let remarks = inspector.finish();
        findings.extend(remarks.into_iter().map(|(is_error, text)| Finding {
            is_error,
            path: file.path.clone(),
            text,
        }));
    }
    if path.is_dir() {
        let path = path.join("metadata.yaml");
        findings.extend(check_metadata(&path, &info));
    }
    findings.extend(check_history(path)?);
    Ok(findings)
}

/// Inspects the items of one file.
#[derive(Default)]
struct Inspector {
    remarks: Vec<(bool, String)>,
    chunks: Vec<ChunkSummary>,
    /// Chunk indexes: position, and first and last time.
    chunk_indexes: Vec<(u64, u64, u64)>,
    counts: BTreeMap<u16, u64>,
    in_chunk: Option<(u64, u64)>,
    time_last: u64,
    n_backwards: u64,
    has_header: bool,
}

impl Inspector {
    fn error(&mut self, text: String) {
        self.remarks.push((true, text));
    }

    fn inspect(&mut self, item: &Item) {
        use mcap::records::Record;
        match item {
            Item::Header(header) => {
                self.has_header = true;
                if header.library.is_empty() {
                    self.remarks.push((false, "the header does not name the writer".to_owned()));
                }
                if !["", "ros1", "ros2"].contains(&header.profile.as_str()) {
                    let text = format!("profile `{}` is not a known MCAP profile", header.profile);
                    self.remarks.push((false, text));
                }
            }
            Item::Chunk(chunk) => {
                self.close_chunk();
                self.chunks.push(chunk.clone());
            }
            Item::Message(message) => {
                *self.counts.entry(message.channel.id).or_default() += 1;
                let time = message.log_time;
                self.n_backwards += u64::from(time < self.time_last);
                self.time_last = self.time_last.max(time);
                let (first, last) = self.in_chunk.unwrap_or((time, time));
                self.in_chunk = Some((first.min(time), last.max(time)));
            }
            Item::Other(Record::ChunkIndex(it)) => {
                let entry = (it.chunk_start_offset, it.message_start_time, it.message_end_time);
                self.chunk_indexes.push(entry);
            }
            Item::Other(Record::DataEnd(_)) => self.close_chunk(),
            Item::Other(Record::Statistics(it)) => self.compare(it),
            Item::Damage(damage) => {
                self.error(format!("{damage}; `jamgrip bag recover` saves the rest"))
            }
            _ => {}
        }
    }

    /// Compares the times in a chunk's header with those of its messages.
    fn close_chunk(&mut self) {
        let Some(found) = self.in_chunk.take() else { return };
        let Some(chunk) = self.chunks.last() else { return };
        let stated = (chunk.header.message_start_time, chunk.header.message_end_time);
        if stated != found && 0 < chunk.n_messages {
            let offset = chunk.offset;
            self.error(format!(
                "chunk at byte {offset}: header times {stated:?}, message times {found:?}"
            ));
        }
    }

    fn compare(&mut self, stated: &mcap::records::Statistics) {
        let counts: BTreeMap<u16, u64> = stated
            .channel_message_counts
            .iter()
            .filter(|it| *it.1 != 0)
            .map(|(k, v)| (*k, *v))
            .collect();
        if counts != self.counts {
            let found: u64 = self.counts.values().sum();
            let stated = stated.message_count;
            self.error(format!("the statistics state {stated} messages, but {found} were found"));
        }
    }

    fn finish(mut self) -> Vec<(bool, String)> {
        if !self.has_header {
            self.error("there is no header".to_owned());
        }
        if 0 < self.n_backwards {
            let text = format!("{} messages are older than one before them", self.n_backwards);
            self.remarks.push((false, text));
        }
        for (offset, first, last) in std::mem::take(&mut self.chunk_indexes) {
            let chunk = self.chunks.iter().find(|it| it.offset == offset);
            let fits = chunk.is_some_and(|it| {
                (it.header.message_start_time, it.header.message_end_time) == (first, last)
            });
            if !fits {
                self.error(format!("the index lists a chunk at byte {offset} that does not exist"));
            }
        }
        self.remarks
    }
}

/// Compares `metadata.yaml` with the counted contents.
fn check_metadata(path: &Path, info: &Info) -> Vec<Finding> {
    let finding = |is_error, text| Finding { is_error, path: path.to_owned(), text };
    let rewrite = "`jamgrip bag recover` rewrites it";
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return vec![finding(true, format!("it is missing; {rewrite}"))];
        }
        Err(error) => return vec![finding(true, format!("cannot be read: {error}"))],
    };
    let tree = match json::parse(&text, &path.display().to_string()) {
        Ok(tree) => tree,
        Err(error) => return vec![finding(true, format!("{error}; {rewrite}"))],
    };
    let tree = &tree["rosbag2_bagfile_information"];
    let mut findings = Vec::new();
    let stated = tree["message_count"].as_u64();
    if stated != Some(info.n_messages()) {
        let stated = stated.map_or("missing".to_owned(), |it| it.to_string());
        let text =
            format!("message_count is {stated}, {} were found; {rewrite}", info.n_messages());
        findings.push(finding(true, text));
    }
    let empty = Vec::new();
    let topics = tree["topics_with_message_count"].as_array().unwrap_or(&empty);
    let mut differing = topics.iter().filter_map(|topic| {
        let (name, stated) = (&topic["topic_metadata"]["name"], &topic["message_count"]);
        let name = name.as_str().unwrap_or_default();
        let found = info.topics.get(name).map(|it| it.n_messages);
        let text = || format!("{name}: {stated} messages stated, {} found", found.unwrap_or(0));
        (found != stated.as_u64()).then(text)
    });
    if let Some(first) = differing.next() {
        let others = match differing.count() {
            0 => String::new(),
            n => format!(" ({n} more topics differ)"),
        };
        findings.push(finding(true, format!("{first}{others}; {rewrite}")));
    }
    let names: Vec<String> = info.metadata().1.into_iter().map(|it| it.file).collect();
    let stated: Vec<&str> = tree["relative_file_paths"]
        .as_array()
        .map(|it| it.iter().filter_map(Value::as_str).collect())
        .unwrap_or_default();
    if stated != names {
        let text = format!("files {stated:?} are listed, {names:?} exist; {rewrite}");
        findings.push(finding(true, text));
    }
    findings
}

/// Checks the chain of digests and the checkpoints, if the recording has them.
fn check_history(path: &Path) -> Result<Vec<Finding>, OpenBagError> {
    let finding = |is_error, text| Finding { is_error, path: path.to_owned(), text };
    let recording = Recording::open(path)?;
    let Some(tick_ns) = recording.facts.get("tick_ns").and_then(|it| it.parse().ok()) else {
        return Ok(Vec::new());
    };
    let history = recording
        .history_without_scene(tick_ns)
        .map_err(|error| OpenBagError::Unreadable { path: path.to_owned(), error })?;
    let mut findings = Vec::new();
    if let Some(tick) = history.broken_at {
        let text = format!(
            "the chain of digests is broken at tick {tick}: a command, a digest or the scene was \
             altered after it was recorded"
        );
        findings.push(finding(true, text));
    }
    if let Some(tick) = history.gap_after {
        findings.push(finding(true, format!("ticks after {tick} are missing")));
    }
    for checkpoint in &history.checkpoints {
        if let Err(error) = checkpoint.read() {
            let text = format!("checkpoint at tick {}: {error}", checkpoint.tick);
            findings.push(finding(true, text));
        }
    }
    Ok(findings)
}
