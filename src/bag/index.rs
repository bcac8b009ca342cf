//! The index at the end of a whole file: where its chunks are, and which topics and times they hold.
//!
//! It only saves work: with it a reader passes over chunks in which nothing is wanted. A file without
//! one, or whose index does not fit the file, is read from its beginning.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs::File,
    io::{Read, Seek},
    ops::Range,
    path::Path,
    sync::Arc,
};

use mcap::{
    McapError, Summary,
    records::ChunkIndex,
    sans_io::summary_reader::{SummaryReadEvent, SummaryReader, SummaryReaderOptions},
};

use super::reader::{Channel, Schema};

/// What the index of a file says.
#[derive(Clone, Debug)]
pub struct Index {
    /// In the order of the file.
    chunks: Vec<ChunkIndex>,
    /// Places of the attachments.
    attachments: Vec<Range<u64>>,
    pub(super) channels: BTreeMap<u16, Arc<Channel>>,
    pub(super) schemas: BTreeMap<u16, Arc<Schema>>,
}

impl Index {
    /// Reads the index of a file; `None` without one that can be used.
    pub fn read(path: &Path) -> Option<Self> {
        let mut file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        let summary = summary(&mut file, length).ok().flatten()?;
        Self::of(summary, length)
    }

    fn of(summary: Summary, length: u64) -> Option<Self> {
        let stats = summary.stats?;
        let schemas = summary.schemas.iter().map(|(id, it)| {
            let (name, encoding) = (it.name.clone(), it.encoding.clone());
            (*id, Arc::new(Schema { id: *id, name, encoding, data: it.data.to_vec() }))
        });
        let schemas: BTreeMap<u16, Arc<Schema>> = schemas.collect();
        let channels = summary.channels.iter().map(|(id, it)| {
            let schema = it.schema.as_ref().and_then(|it| schemas.get(&it.id)).cloned();
            let (topic, encoding) = (it.topic.clone(), it.message_encoding.clone());
            let metadata = it.metadata.clone();
            (*id, Arc::new(Channel { id: *id, topic, encoding, metadata, schema }))
        });
        let channels: BTreeMap<u16, Arc<Channel>> = channels.collect();
        let mut chunks = summary.chunk_indexes;
        chunks.sort_by_key(|it| it.chunk_start_offset);
        let mut end = super::reader::MAGIC.len() as u64;
        for chunk in &chunks {
            let range = range(chunk)?;
            let is_known = chunk.message_index_offsets.keys().all(|id| channels.contains_key(id));
            if range.start < end || length < range.end || !is_known {
                return None;
            }
            end = range.end;
        }
        let attachments: Option<Vec<_>> = summary
            .attachment_indexes
            .iter()
            .map(|it| Some(it.offset..it.offset.checked_add(it.length)?))
            .collect();
        let is_complete = stats.chunk_count as usize == chunks.len()
            && stats.channel_count as usize == channels.len()
            && !chunks.is_empty();
        is_complete.then_some(Self { chunks, attachments: attachments?, channels, schemas })
    }

    /// Time of the last message (ns).
    pub fn last_ns(&self) -> u64 {
        self.chunks.iter().map(|it| it.message_end_time).max().unwrap_or(0)
    }

    /// What can be passed over by those who want nothing but messages from `time_ns` on, and before it the last
    /// ones on channels that are `kept`: places in the file, ascending.
    pub fn before(&self, time_ns: u64, kept: &dyn Fn(&Channel) -> bool) -> Vec<Range<u64>> {
        let kept: BTreeSet<u16> =
            self.channels.values().filter(|it| kept(it)).map(|it| it.id).collect();
        let mut missing = kept;
        let mut gaps = self.attachments.clone();
        for chunk in self.chunks.iter().rev() {
            let has = |id: &u16| chunk.message_index_offsets.contains_key(id);
            // Without a message index nobody knows what is in it.
            if time_ns <= chunk.message_end_time || chunk.message_index_length == 0 {
                continue;
            }
            if missing.iter().any(has) {
                missing.retain(|id| !has(id));
            } else {
                gaps.extend(range(chunk));
            }
        }
        gaps.sort_by_key(|it| it.start);
        joined(gaps)
    }
}

/// One range in place of those that follow each other.
fn joined(ranges: Vec<Range<u64>>) -> Vec<Range<u64>> {
    let mut joined: Vec<Range<u64>> = Vec::new();
    for range in ranges {
        match joined.last_mut() {
            Some(before) if before.end == range.start => before.end = range.end,
            _ => joined.push(range),
        }
    }
    joined
}

/// A chunk with its message indexes.
fn range(chunk: &ChunkIndex) -> Option<Range<u64>> {
    let length = chunk.chunk_length.checked_add(chunk.message_index_length)?;
    Some(chunk.chunk_start_offset..chunk.chunk_start_offset.checked_add(length)?)
}

fn summary(file: &mut (impl Read + Seek), length: u64) -> Result<Option<Summary>, McapError> {
    let options = SummaryReaderOptions::default().with_file_size(length);
    let mut reader = SummaryReader::new_with_options(options);
    while let Some(event) = reader.next_event() {
        match event? {
            SummaryReadEvent::ReadRequest(n) => {
                let n = file.read(reader.insert(n))?;
                reader.notify_read(n);
            }
            SummaryReadEvent::SeekRequest(to) => {
                reader.notify_seeked(file.seek(to)?);
            }
        }
    }
    Ok(reader.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chunk(start: u64, times: (u64, u64), channels: &[u16]) -> ChunkIndex {
        ChunkIndex {
            message_start_time: times.0,
            message_end_time: times.1,
            chunk_start_offset: start,
            chunk_length: 80,
            message_index_offsets: channels.iter().map(|id| (*id, start + 80)).collect(),
            message_index_length: 20,
            compression: String::new(),
            compressed_size: 50,
            uncompressed_size: 50,
        }
    }

    fn index(chunks: Vec<ChunkIndex>) -> Index {
        let channel = |id: u16| Channel {
            id,
            topic: format!("/{id}"),
            encoding: "cdr".to_owned(),
            metadata: BTreeMap::new(),
            schema: None,
        };
        let channels = (1..=2).map(|id| (id, Arc::new(channel(id)))).collect();
        let attachments = Vec::from([Range { start: 400, end: 450 }]);
        Index { chunks, attachments, channels, schemas: BTreeMap::new() }
    }

    /// Oracle: a file drawn on paper: five chunks, an attachment behind the fourth.
    #[test]
    fn only_what_nobody_wants_is_passed_over() {
        let chunks = [(0, (0, 9), &[1, 2][..]), (100, (10, 19), &[1]), (200, (20, 29), &[1, 2])];
        let more = [(300, (30, 39), &[1][..]), (450, (40, 49), &[1])];
        let chunks = chunks.into_iter().chain(more);
        let index = index(chunks.map(|(at, times, ids)| chunk(at, times, ids)).collect());
        let before = |time_ns, kept: &str| -> Vec<(u64, u64)> {
            let gaps = index.before(time_ns, &|it| kept.contains(&it.topic));
            gaps.into_iter().map(|it| (it.start, it.end)).collect()
        };
        assert_eq!(before(45, ""), [(0, 450)]);
        assert_eq!(before(30, ""), [(0, 300), (400, 450)]);
        assert_eq!(before(39, ""), [(0, 300), (400, 450)], "wanted up to the last message");
        assert_eq!(
            before(45, "/2"),
            [(0, 200), (300, 450)],
            "the last on /2 is in the third chunk"
        );
        assert_eq!(before(45, "/1 /2"), [(0, 200), (400, 450)]);
        assert_eq!(before(0, ""), [(400, 450)]);
    }
}
