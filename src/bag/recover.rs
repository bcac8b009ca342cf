//! What can be saved of a damaged recording, written as a whole one beside it.
//!
//! Messages, attachments and metadata are kept as they are, with their channels; chunks are packed
//! anew and indexed, and `metadata.yaml` is made from what was found. The damaged recording itself is
//! never touched.

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
    NotABag, ROSBAG2,
    info::Info,
    metadata::file_text,
    reader::{self, Channel, Damage, Item, Reader, Recorded},
    writer::{WriteError, of_system, text},
};

/// Metadata record that tells of the rescue.
pub const RECOVERED: &str = "jamgrip_recovered";

/// Why nothing was saved.
#[derive(Debug, thiserror::Error)]
pub enum RecoverError {
    /// There is no recording.
    #[error(transparent)]
    NotABag(#[from] NotABag),
    /// There is something where the result shall be.
    #[error("{}: exists already; choose another output", path.display())]
    InUse {
        /// Where.
        path: PathBuf,
    },
    /// The result cannot be written.
    #[error("{}: cannot be written ({fault}); choose another output", path.display())]
    CannotWrite {
        /// Where.
        path: PathBuf,
        /// What the system says.
        fault: String,
    },
    /// There is no whole message in it.
    #[error("{}: nothing in it can be saved: {first_damage}", path.display())]
    Nothing {
        /// The recording.
        path: PathBuf,
        /// What is wrong with it first.
        first_damage: String,
    },
}

/// What was saved.
#[derive(Clone, Debug, Default)]
pub struct Recovered {
    /// Where it is: a folder, or a file if one file was given.
    pub output: PathBuf,
    /// Messages saved.
    pub n_messages: u64,
    /// Attachments saved.
    pub n_attachments: u64,
    /// What was wrong, by file.
    pub damages: Vec<(PathBuf, Damage)>,
}

/// Where the result goes if nothing is said: beside the recording, its name and `_recovered`.
pub fn default_output(path: &Path) -> PathBuf {
    let name =
        |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    if path.is_file() {
        let stem = name(path.file_stem());
        path.with_file_name(format!("{stem}_recovered.mcap"))
    } else {
        // `bags/..` and the like have names only when written out.
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        whole.with_file_name(format!("{}_recovered", name(whole.file_name())))
    }
}

/// Saves what can be saved of the recording at `path` into `output`, which must not exist yet.
///
/// # Errors
/// If there is nothing to save, or no place to save it to.
pub fn recover(path: &Path, output: &Path) -> Result<Recovered, RecoverError> {
    let files = super::files(path)?;
    if output.exists() {
        return Err(RecoverError::InUse { path: output.to_owned() });
    }
    let is_folder = path.is_dir();
    let cannot_write =
        |at: &Path, fault: String| RecoverError::CannotWrite { path: at.to_owned(), fault };
    if is_folder {
        fs::create_dir_all(output).map_err(|e| cannot_write(output, e.to_string()))?;
    }
    let mut recovered = Recovered { output: output.to_owned(), ..Recovered::default() };
    for file in &files {
        let name = file.file_name().unwrap_or_default();
        let target = if is_folder { output.join(name) } else { output.to_owned() };
        let reader = Reader::open(file)
            .map_err(|fault| NotABag::Unreadable { path: file.clone(), fault })?;
        let saved = save(reader, &target).map_err(|e| cannot_write(&target, text(&e)))?;
        recovered.damages.extend(saved.damages.into_iter().map(|it| (file.clone(), it)));
        if saved.n_messages + saved.n_attachments == 0 {
            // A whole file with nothing in it would only be in the way.
            drop(fs::remove_file(&target));
        }
        recovered.n_messages += saved.n_messages;
        recovered.n_attachments += saved.n_attachments;
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

/// What was saved of one file.
#[derive(Default)]
struct Saved {
    n_messages: u64,
    n_attachments: u64,
    damages: Vec<Damage>,
}

fn save(reader: impl Iterator<Item = Item>, target: &Path) -> Result<Saved, WriteError> {
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
    let mut rescue = Rescue { writer, known: BTreeSet::new(), saved: Saved::default() };
    for item in reader {
        rescue.take(item)?;
    }
    rescue.finish()
}

struct Rescue {
    writer: Writer<BufWriter<File>>,
    /// Numbers of the channels that are written.
    known: BTreeSet<u16>,
    saved: Saved,
}

impl Rescue {
    fn take(&mut self, item: Item) -> Result<(), WriteError> {
        match item {
            Item::Channel(channel) => self.channel(&channel)?,
            Item::Message(message) => self.message(&message)?,
            Item::Attachment(attachment) => self.attachment(&attachment)?,
            // rosbag2's own record counts what was there; it is told anew by metadata.yaml.
            Item::Metadata(it) if it.name != ROSBAG2 => self.writer.write_metadata(&it)?,
            Item::Damage(damage) => self.saved.damages.push(damage),
            _ => {}
        }
        Ok(())
    }

    fn channel(&mut self, channel: &Channel) -> Result<(), WriteError> {
        match self.add(channel) {
            Ok(()) => drop(self.known.insert(channel.id)),
            Err(error) if of_system(&error).is_some() => return Err(error),
            Err(error) => {
                // A number that means two things: what comes under it now cannot be told apart.
                self.known.remove(&channel.id);
                let (opcode, fault) = (op::CHANNEL, text(&error));
                self.saved.damages.push(Damage::BadRecord { offset: 0, opcode, fault });
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

    fn message(&mut self, message: &Recorded) -> Result<(), WriteError> {
        let channel_id = message.channel.id;
        if !self.known.contains(&channel_id) {
            return Ok(());
        }
        let &Recorded { sequence, log_time, publish_time, .. } = message;
        let header = MessageHeader { channel_id, sequence, log_time, publish_time };
        self.writer.write_to_known_channel(&header, &message.data)?;
        self.saved.n_messages += 1;
        Ok(())
    }

    fn attachment(&mut self, attachment: &reader::Attachment) -> Result<(), WriteError> {
        let (log_time, create_time) = attachment.times;
        self.saved.n_attachments += 1;
        self.writer.attach(&Attachment {
            log_time,
            create_time,
            name: attachment.name.clone(),
            media_type: attachment.media_type.clone(),
            data: attachment.data.as_slice().into(),
        })
    }

    fn finish(mut self) -> Result<Saved, WriteError> {
        let damages: Vec<String> = self.saved.damages.iter().map(ToString::to_string).collect();
        let metadata = [
            ("version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("damages".to_owned(), damages.join("; ")),
        ];
        let metadata = Metadata { name: RECOVERED.to_owned(), metadata: metadata.into() };
        self.writer.write_metadata(&metadata)?;
        self.writer.finish()?;
        let file = self.writer.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        Ok(self.saved)
    }
}
