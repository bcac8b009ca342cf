//! Commands from a recording, each in the tick in which it was given.
//!
//! jamgrip's own recordings store the ticks. For other recordings, the time of the first message is
//! taken as the start of the run, and a command belongs to the tick in which it was recorded.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use crate::io::source::{Source, SourceCounters};
use crate::{
    bag::{
        OpenBagError, START,
        reader::{Item, Reader, RecordedMessage},
        writer::CDR_HEADER,
    },
    command::Command,
    snapshot::Snapshot,
    wire::{from_ros::CommandCodec, topics::Topic},
};

/// Why a recording yields no commands.
#[derive(Debug, thiserror::Error)]
pub enum ScriptError {
    /// The path is not a recording.
    #[error(transparent)]
    Open(#[from] OpenBagError),
    /// None of its topics carries commands for this scene.
    #[error(
        "{}: contains no messages on the command topics {known}", path.display()
    )]
    NoTopic {
        /// The recording.
        path: PathBuf,
        /// The command topics of the scene, with their types.
        known: String,
    },
}

/// Commands with the ticks in which they take effect. Clones share the list.
#[derive(Clone, Debug, Default)]
pub struct Script {
    commands: Arc<Vec<(u64, Command)>>,
    next: usize,
    counters: SourceCounters,
}

impl Script {
    /// Creates a script; commands of the same tick keep their order.
    pub fn new(mut commands: Vec<(u64, Command)>) -> Self {
        commands.sort_by_key(|(tick, _)| *tick);
        Self { commands: Arc::new(commands), ..Self::default() }
    }

    /// Reads the commands on `topics` from a recording of any program, decoded by `codec`.
    ///
    /// # Errors
    /// If the path is not a recording, or it contains no commands.
    pub fn read(
        path: &Path,
        topics: &[Topic],
        codec: &CommandCodec,
        tick_ns: u64,
    ) -> Result<Self, ScriptError> {
        let mut found = FoundCommands::default();
        for file in crate::bag::files(path)? {
            let reader = Reader::open(&file)
                .map_err(|error| OpenBagError::Unreadable { path: file.clone(), error })?;
            for item in reader {
                match item {
                    Item::Metadata(it) if it.name == START => found.is_own_recording = true,
                    Item::Message(message) => found.take(&message, topics, codec),
                    _ => {}
                }
            }
        }
        if found.commands.is_empty() {
            let known = topics.iter().filter(|it| it.is_input);
            let known: Vec<String> =
                known.map(|it| format!("{} ({})", it.name, it.message_type.name)).collect();
            let (path, known) = (path.to_owned(), known.join(", "));
            return Err(ScriptError::NoTopic { path, known });
        }
        let start_ns = if found.is_own_recording { 0 } else { found.first_ns.unwrap_or(0) };
        let in_tick = |(time_ns, command): (u64, Command)| {
            (time_ns.saturating_sub(start_ns) / tick_ns + 1, command)
        };
        let script = Self::new(found.commands.into_iter().map(in_tick).collect());
        Ok(Self { counters: found.counters, ..script })
    }

    /// The commands of a tick. Ticks must be requested in ascending order; earlier commands are
    /// skipped.
    pub fn commands_in(&mut self, tick: u64) -> Vec<Command> {
        let left = &self.commands[self.next..];
        let n_before = left.partition_point(|(at, _)| *at < tick);
        let of_tick = left[n_before..].iter().take_while(|(at, _)| *at == tick);
        let of_tick: Vec<_> = of_tick.map(|(_, command)| command.clone()).collect();
        self.next += n_before + of_tick.len();
        of_tick
    }

    /// The last tick with a command.
    pub fn last_tick(&self) -> u64 {
        self.commands.last().map_or(0, |(tick, _)| *tick)
    }
}

impl Source for Script {
    fn name(&self) -> &'static str {
        "bag"
    }

    fn drain(&mut self, snapshot: &Snapshot) -> Vec<Command> {
        self.commands_in(snapshot.run_tick.0 + 1)
    }

    fn has_received(&self) -> bool {
        true
    }

    fn counters(&self) -> SourceCounters {
        self.counters
    }
}

/// The commands found so far.
#[derive(Default)]
struct FoundCommands {
    is_own_recording: bool,
    first_ns: Option<u64>,
    commands: Vec<(u64, Command)>,
    counters: SourceCounters,
}

impl FoundCommands {
    fn take(&mut self, message: &RecordedMessage, topics: &[Topic], codec: &CommandCodec) {
        let earliest = self.first_ns.unwrap_or(message.log_time).min(message.log_time);
        self.first_ns = Some(earliest);
        let name = &message.channel.topic;
        let Some(index) = topics.iter().position(|it| it.is_input && it.name == *name) else {
            return;
        };
        let has_type = message.channel.type_name() == topics[index].message_type.name;
        let body = message.data.strip_prefix(&CDR_HEADER).filter(|_| has_type);
        match body.map(|cdr| codec.decode(index, cdr)) {
            Some(Ok(command)) => {
                self.counters.n_received += 1;
                self.commands.push((message.log_time, command));
            }
            // Wrong type, wrong byte order, or not a command.
            _ => self.counters.n_malformed += 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the list itself.
    #[test]
    fn every_command_is_returned_once_in_its_tick() {
        let vacuum = |gauge_pa| Command::Vacuum { gauge_pa };
        let list = vec![(5, vacuum(3.0)), (2, vacuum(1.0)), (2, vacuum(2.0)), (9, vacuum(4.0))];
        let mut script = Script::new(list);
        assert_eq!(script.commands_in(1), []);
        assert_eq!(script.commands_in(2), [1.0, 2.0].map(vacuum));
        assert_eq!(script.commands_in(3), []);
        // Earlier commands are skipped if the run starts later.
        assert_eq!(script.commands_in(9), [vacuum(4.0)]);
        assert_eq!((script.commands_in(10), script.last_tick()), (Vec::new(), 9));
    }
}
