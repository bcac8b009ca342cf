//! The index at the end of a complete file: the positions of its chunks, with their topics and
//! times.
//!
//! It only saves work: with it, a reader skips chunks that are not needed. A file without an index,
//! or whose index does not match, is read from its beginning.

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

/// The index of a file.
#[derive(Clone, Debug)]
pub struct Index {
    /// Chunks, in the order of the file.
    chunks: Vec<ChunkIndex>,
    /// Positions of the attachments (bytes).
    attachments: Vec<Range<u64>>,
    pub(super) channels: BTreeMap<u16, Arc<Channel>>,
    pub(super) schemas: BTreeMap<u16, Arc<Schema>>,
}

impl Index {
    /// Reads the index of a file; `None` if there is none or it does not match the file.
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

    /// Ranges of the file (bytes, ascending) that can be skipped if only messages from `time_ns` on
    /// are needed, plus the last earlier message of each channel that is `kept`.
    pub fn before(&self, time_ns: u64, kept: &dyn Fn(&Channel) -> bool) -> Vec<Range<u64>> {
        let kept: BTreeSet<u16> =
            self.channels.values().filter(|it| kept(it)).map(|it| it.id).collect();
        let mut needed = kept;
        let mut gaps = self.attachments.clone();
        for chunk in self.chunks.iter().rev() {
            let has = |id: &u16| chunk.message_index_offsets.contains_key(id);
            // Without a message index, the channels in the chunk are unknown.
            if time_ns <= chunk.message_end_time || chunk.message_index_length == 0 {
                continue;
            }
            if needed.iter().any(has) {
                needed.retain(|id| !has(id));
            } else {
                gaps.extend(range(chunk));
            }
        }
        gaps.sort_by_key(|it| it.start);
        merged(gaps)
    }
}

/// Merges adjacent ranges.
fn merged(ranges: Vec<Range<u64>>) -> Vec<Range<u64>> {
    let mut merged: Vec<Range<u64>> = Vec::new();
    for range in ranges {
        match merged.last_mut() {
            Some(before) if before.end == range.start => before.end = range.end,
            _ => merged.push(range),
        }
    }
    merged
}

/// The range of a chunk and its message indexes.
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

    /// Oracle: a sketched file: five chunks, an attachment after the fourth.
    #[test]
    fn only_unneeded_ranges_are_skipped() {
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
        assert_eq!(before(39, ""), [(0, 300), (400, 450)], "needed up to the last message");
        assert_eq!(
            before(45, "/2"),
            [(0, 200), (300, 450)],
            "the last on /2 is in the third chunk"
        );
        assert_eq!(before(45, "/1 /2"), [(0, 200), (400, 450)]);
        assert_eq!(before(0, ""), [(400, 450)]);
    }
}
