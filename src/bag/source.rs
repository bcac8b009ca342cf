//! Commands from a recording, each in the tick in which it was given.
//!
//! Recordings of jamgrip's know their ticks. In others the first message is taken for the start of
//! the run, and a message is a command of the tick in which it was recorded.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use crate::io::source::{Source, SourceCounters};
use crate::{
    bag::{
        NotABag, START,
        reader::{Item, Reader, Recorded},
        writer::CDR_HEADER,
    },
    command::Command,
    snapshot::Snapshot,
    wire::{from_ros::CommandCodec, topics::Topic},
};

/// Why there are no commands.
#[derive(Debug, thiserror::Error)]
pub enum NoCommands {
    /// There is no recording.
    #[error(transparent)]
    NotABag(#[from] NotABag),
    /// None of its topics carries commands for this scene.
    #[error(
        "{}: no messages on a topic that carries commands; these do: {known}", path.display()
    )]
    NoTopic {
        /// The recording.
        path: PathBuf,
        /// The topics that this scene listens to, with their types.
        known: String,
    },
}

/// Commands, each with the tick in which it takes effect. Copies share the list.
#[derive(Clone, Debug, Default)]
pub struct Script {
    commands: Arc<Vec<(u64, Command)>>,
    next: usize,
    counters: SourceCounters,
}

impl Script {
    /// Commands with their ticks; those of one tick keep their order.
    pub fn new(mut commands: Vec<(u64, Command)>) -> Self {
        commands.sort_by_key(|(tick, _)| *tick);
        Self { commands: Arc::new(commands), ..Self::default() }
    }

    /// The commands in a recording, whoever made it, on `topics` as `codec` reads them.
    ///
    /// # Errors
    /// If there is no recording, or nothing of use in it.
    pub fn read(
        path: &Path,
        topics: &[Topic],
        codec: &CommandCodec,
        tick_ns: u64,
    ) -> Result<Self, NoCommands> {
        let mut gathered = Gathered::default();
        for file in crate::bag::files(path)? {
            let reader = Reader::open(&file)
                .map_err(|fault| NotABag::Unreadable { path: file.clone(), fault })?;
            for item in reader {
                match item {
                    Item::Metadata(it) if it.name == START => gathered.is_ours = true,
                    Item::Message(message) => gathered.take(&message, topics, codec),
                    _ => {}
                }
            }
        }
        if gathered.commands.is_empty() {
            let known = topics.iter().filter(|it| it.is_input);
            let known: Vec<String> =
                known.map(|it| format!("{} ({})", it.name, it.message_type.name)).collect();
            let (path, known) = (path.to_owned(), known.join(", "));
            return Err(NoCommands::NoTopic { path, known });
        }
        let start_ns = if gathered.is_ours { 0 } else { gathered.first_ns.unwrap_or(0) };
        let in_tick = |(time_ns, command): (u64, Command)| {
            (time_ns.saturating_sub(start_ns) / tick_ns + 1, command)
        };
        let script = Self::new(gathered.commands.into_iter().map(in_tick).collect());
        Ok(Self { counters: gathered.counters, ..script })
    }

    /// The commands of a tick. Ticks are asked for in ascending order; what lies before is skipped.
    pub fn of(&mut self, tick: u64) -> Vec<Command> {
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

    fn drain(&mut self, seen: &Snapshot) -> Vec<Command> {
        self.of(seen.run_tick.0 + 1)
    }

    fn has_received(&self) -> bool {
        true
    }

    fn counters(&self) -> SourceCounters {
        self.counters
    }
}

/// What was found so far.
#[derive(Default)]
struct Gathered {
    is_ours: bool,
    first_ns: Option<u64>,
    commands: Vec<(u64, Command)>,
    counters: SourceCounters,
}

impl Gathered {
    fn take(&mut self, message: &Recorded, topics: &[Topic], codec: &CommandCodec) {
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
            // Another type, another byte order, or no command at all.
            _ => self.counters.n_malformed += 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the list itself.
    #[test]
    fn every_command_comes_once_in_its_tick() {
        let vacuum = |gauge_pa| Command::Vacuum { gauge_pa };
        let list = vec![(5, vacuum(3.0)), (2, vacuum(1.0)), (2, vacuum(2.0)), (9, vacuum(4.0))];
        let mut script = Script::new(list);
        assert_eq!(script.of(1), []);
        assert_eq!(script.of(2), [1.0, 2.0].map(vacuum));
        assert_eq!(script.of(3), []);
        // A run that begins later leaves out what was before.
        assert_eq!(script.of(9), [vacuum(4.0)]);
        assert_eq!((script.of(10), script.last_tick()), (Vec::new(), 9));
    }
}
