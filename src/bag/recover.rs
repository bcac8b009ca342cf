//! Repairs a damaged recording: writes everything that can be read to a new one.
//!
//! Messages, attachments and metadata are copied with their channels; chunks are compressed and
//! indexed again, and `metadata.yaml` is generated from the contents. The damaged recording itself
//! is never changed.

use std::{
    collections::BTreeSet,
    fs::{self, File, OpenOptions},
    io::{self, BufWriter},
    path::{Path, PathBuf},
};

use mcap::{
    Attachment, Compression, WriteOptions, Writer,
    records::{MessageHeader, Metadata, op},
};

use super::{
    OpenBagError, ROSBAG2,
    info::Info,
    metadata::file_text,
    reader::{self, Channel, Damage, Item, Reader, RecordedMessage},
    writer::{WriteError, io_error, text},
};

/// Metadata record about the repair.
pub const RECOVERED: &str = "jamgrip_recovered";

/// Why a recording could not be repaired.
#[derive(Debug, thiserror::Error)]
pub enum RecoverError {
    /// The path is not a recording.
    #[error(transparent)]
    Open(#[from] OpenBagError),
    /// The output already exists.
    #[error("{}: already exists; choose another output", path.display())]
    InUse {
        /// The output.
        path: PathBuf,
    },
    /// The output cannot be written.
    #[error("{}: cannot be written ({reason}); choose another output", path.display())]
    CannotWrite {
        /// The output.
        path: PathBuf,
        /// Reason given by the operating system.
        reason: String,
    },
    /// It contains no readable message.
    #[error("{}: contains no readable messages: {first_damage}", path.display())]
    Nothing {
        /// The recording.
        path: PathBuf,
        /// The first damage.
        first_damage: String,
    },
}

/// The result of a repair.
#[derive(Clone, Debug, Default)]
pub struct Recovered {
    /// The output: a folder, or a file if the input is a file.
    pub output: PathBuf,
    /// Number of messages saved.
    pub n_messages: u64,
    /// Number of attachments saved.
    pub n_attachments: u64,
    /// The damaged parts, with their files.
    pub damages: Vec<(PathBuf, Damage)>,
}

/// The default output: next to the recording, with `_recovered` added to its name.
pub fn default_output(path: &Path) -> PathBuf {
    let name =
        |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    if path.is_file() {
        let stem = name(path.file_stem());
        path.with_file_name(format!("{stem}_recovered.mcap"))
    } else {
        // Paths such as `bags/..` only have a name in canonical form.
        let canonical = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        canonical.with_file_name(format!("{}_recovered", name(canonical.file_name())))
    }
}

/// Writes everything readable in the recording at `path` to `output`, which must not exist yet.
///
/// # Errors
/// If nothing is readable, or the output cannot be written.
pub fn recover(path: &Path, output: &Path) -> Result<Recovered, RecoverError> {
    let files = super::files(path)?;
    if output.exists() {
        return Err(RecoverError::InUse { path: output.to_owned() });
    }
    let is_folder = path.is_dir();
    let cannot_write =
        |at: &Path, reason: String| RecoverError::CannotWrite { path: at.to_owned(), reason };
    if is_folder {
        fs::create_dir_all(output).map_err(|e| cannot_write(output, e.to_string()))?;
    }
    let mut recovered = Recovered { output: output.to_owned(), ..Recovered::default() };
    for file in &files {
        let name = file.file_name().unwrap_or_default();
        let target = if is_folder { output.join(name) } else { output.to_owned() };
        let reader = Reader::open(file)
            .map_err(|error| OpenBagError::Unreadable { path: file.clone(), error })?;
        let result = copy_readable(reader, &target).map_err(|e| cannot_write(&target, text(&e)))?;
        recovered.damages.extend(result.damages.into_iter().map(|it| (file.clone(), it)));
        if result.n_messages + result.n_attachments == 0 {
            // A valid but empty file would be useless.
            drop(fs::remove_file(&target));
        }
        recovered.n_messages += result.n_messages;
        recovered.n_attachments += result.n_attachments;
    }
    if recovered.n_messages == 0 {
        drop(if is_folder { fs::remove_dir_all(output) } else { fs::remove_file(output) });
        let damage = recovered.damages.first();
        let first_damage = damage.map_or("it is empty".to_owned(), |(_, it)| it.to_string());
        return Err(RecoverError::Nothing { path: path.to_owned(), first_damage });
    }
    if is_folder {
        let (rows, contents) = Info::read(output)?.metadata();
        let metadata = output.join("metadata.yaml");
        fs::write(&metadata, file_text(&rows, &contents))
            .map_err(|e| cannot_write(&metadata, e.to_string()))?;
    }
    Ok(recovered)
}

/// The result of repairing one file.
#[derive(Default)]
struct FileResult {
    n_messages: u64,
    n_attachments: u64,
    damages: Vec<Damage>,
}

fn copy_readable(
    reader: impl Iterator<Item = Item>,
    target: &Path,
) -> Result<FileResult, WriteError> {
    let mut reader = reader.peekable();
    let (profile, library) = match reader.peek() {
        Some(Item::Header(header)) => (header.profile.clone(), header.library.clone()),
        _ => (String::new(), String::new()),
    };
    let by = format!("{library} (recovered by jamgrip {})", env!("CARGO_PKG_VERSION"));
    let file = OpenOptions::new().write(true).create_new(true).open(target)?;
    let writer = WriteOptions::new()
        .profile(profile)
        .library(by.trim_start())
        .compression(Some(Compression::Zstd))
        .compression_threads(0)
        .create(BufWriter::new(file))?;
    let mut recovery = Recovery { writer, known: BTreeSet::new(), result: FileResult::default() };
    for item in reader {
        recovery.take(item)?;
    }
    recovery.finish()
}

struct Recovery {
    writer: Writer<BufWriter<File>>,
    /// IDs of the channels that have been written.
    known: BTreeSet<u16>,
    result: FileResult,
}

impl Recovery {
    fn take(&mut self, item: Item) -> Result<(), WriteError> {
        match item {
            Item::Channel(channel) => self.channel(&channel)?,
            Item::Message(message) => self.message(&message)?,
            Item::Attachment(attachment) => self.attachment(&attachment)?,
            // rosbag2's own record counts the original contents; `metadata.yaml` replaces it.
            Item::Metadata(it) if it.name != ROSBAG2 => self.writer.write_metadata(&it)?,
            Item::Damage(damage) => self.result.damages.push(damage),
            _ => {}
        }
        Ok(())
    }

    fn channel(&mut self, channel: &Channel) -> Result<(), WriteError> {
        match self.add(channel) {
            Ok(()) => drop(self.known.insert(channel.id)),
            Err(error) if io_error(&error).is_some() => return Err(error),
            Err(error) => {
                // An ID that is used twice: later messages with it are ambiguous.
                self.known.remove(&channel.id);
                let (opcode, reason) = (op::CHANNEL, text(&error));
                self.result.damages.push(Damage::BadRecord { offset: 0, opcode, reason });
            }
        }
        Ok(())
    }

    fn add(&mut self, channel: &Channel) -> Result<(), WriteError> {
        let schema = match &channel.schema {
            Some(it) => self.writer.add_schema_with_id(it.id, &it.name, &it.encoding, &it.data)?,
            None => 0,
        };
        let Channel { id, topic, encoding, metadata, .. } = channel;
        self.writer.add_channel_with_id(*id, schema, topic, encoding, metadata)?;
        Ok(())
    }

    fn message(&mut self, message: &RecordedMessage) -> Result<(), WriteError> {
        let channel_id = message.channel.id;
        if !self.known.contains(&channel_id) {
            return Ok(());
        }
        let &RecordedMessage { sequence, log_time, publish_time, .. } = message;
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        self.writer.write_to_known_channel(&header, &message.data)?;
        self.result.n_messages += 1;
        Ok(())
    }

    fn attachment(&mut self, attachment: &reader::Attachment) -> Result<(), WriteError> {
        let (log_time, create_time) = attachment.times;
        self.result.n_attachments += 1;
        self.writer.attach(&Attachment {
            log_time,
            create_time,
            name: attachment.name.clone(),
            media_type: attachment.media_type.clone(),
            data: attachment.data.as_slice().into(),
        })
    }

    fn finish(mut self) -> Result<FileResult, WriteError> {
        let damages: Vec<String> = self.result.damages.iter().map(ToString::to_string).collect();
        let metadata = [
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("damages".to_owned(), damages.join("; ")),
        ];
        let metadata = Metadata { name: RECOVERED.to_owned(), metadata: metadata.into() };
        self.writer.write_metadata(&metadata)?;
        self.writer.finish()?;
        let file = self.writer.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        Ok(self.result)
    }
}
