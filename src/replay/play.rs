//! Publishes a recording with its original timing: at any speed, in part, in a loop; it can be
//! paused, stepped and sought by commands.
//!
//! Messages are published in the order of the files, each at its time. Late joiners are served as
//! in the run itself: before the first message of a part, the last earlier messages of the latched
//! topics are published. If a file has an index, messages before a part are skipped.

use std::{
    collections::{BTreeMap, VecDeque},
    fs::File,
    io::{self, BufReader},
    path::PathBuf,
    sync::{
        Arc,
        mpsc::{Receiver, Sender},
    },
    time::Duration,
};

use super::player_command::{CommandRequest, PlayerCommand, PlayerStatus};
use crate::{
    bag::{
        index::Index,
        reader::{Channel, Item, Reader, RecordedMessage, items},
    },
    host::{clock::Playhead, shutdown::Shutdown},
};

/// Topic of simulation time.
pub const CLOCK: &str = "/clock";

/// Receives the messages of a recording.
pub trait PlayerOutput {
    /// Opens a topic. Returns false if it cannot be played.
    fn open(&mut self, channel: &Channel) -> bool;

    /// Publishes a message on an open topic.
    fn publish(&mut self, message: &RecordedMessage);

    /// Publishes recorded time, at another rate than it was recorded.
    fn publish_clock(&mut self, time_ns: u64);
}

/// What to play, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Speed relative to the recording.
    pub rate: f64,
    /// Start time, from the first message (ns).
    pub start_ns: u64,
    /// End time, from the first message (ns).
    pub end_ns: Option<u64>,
    /// True to start paused.
    pub is_paused: bool,
    /// True to restart at the end.
    pub is_loop: bool,
    /// Only these topics; a `*` at the end matches any suffix. Empty means all topics.
    pub topics: Vec<String>,
    /// Topics to leave out, with the same patterns.
    pub exclude: Vec<String>,
    /// Time between opening the topics and the first message, for readers to discover them.
    pub delay: Duration,
    /// Publish recorded time at this rate of wall-clock time instead of the recorded clock (Hz).
    pub clock_rate: Option<f64>,
}

/// The result of playing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Played {
    /// Messages published.
    pub n_published: u64,
    /// Topics that could not be played.
    pub unplayable: Vec<String>,
    /// Number of damaged parts.
    pub n_damages: u64,
}

/// Plays the files until the end, or until a command or `shutdown` ends it.
///
/// # Errors
/// If a file cannot be opened.
pub fn play(
    files: &[PathBuf],
    options: &Options,
    output: &mut dyn PlayerOutput,
    commands: &Receiver<CommandRequest>,
    shutdown: &Shutdown,
) -> io::Result<Played> {
    let mut player = Player {
        files,
        options,
        output,
        commands,
        shutdown,
        head: None,
        first_ns: 0,
        indexes: files.iter().map(|_| None).collect(),
        clock_ns: None,
        bursts: VecDeque::new(),
        is_step: false,
        is_open: BTreeMap::new(),
        played: Played::default(),
    };
    player.open_topics()?;
    let mut start_ns = options.start_ns;
    loop {
        let ending = player.play_from(start_ns)?;
        player.end_bursts();
        match ending {
            Ending::End if options.is_loop => start_ns = options.start_ns,
            Ending::Seek(to_ns) => start_ns = to_ns,
            Ending::End | Ending::Quit => return Ok(player.played),
        }
    }
}

type FileReader = Reader<BufReader<File>>;

/// Messages to play at once.
struct Burst {
    n_left: u64,
    n_played: u64,
    reply: Option<Sender<PlayerStatus>>,
}

/// Why a pass through the files ended.
enum Ending {
    End,
    Seek(u64),
    Quit,
}

struct Player<'a> {
    files: &'a [PathBuf],
    options: &'a Options,
    output: &'a mut dyn PlayerOutput,
    commands: &'a Receiver<CommandRequest>,
    shutdown: &'a Shutdown,
    head: Option<Playhead>,
    /// Time of the recording's first message (ns).
    first_ns: u64,
    /// The index of each file, once it has been looked up.
    indexes: Vec<Option<Option<Index>>>,
    /// Recorded time last published by `publish_time` (ns).
    clock_ns: Option<u64>,
    /// Messages to play while paused.
    bursts: VecDeque<Burst>,
    /// True if the next message belongs to a burst.
    is_step: bool,
    /// Whether each topic is played.
    is_open: BTreeMap<String, bool>,
    played: Played,
}

impl Player<'_> {
    /// Opens the topics that come before the first message, and waits for readers.
    fn open_topics(&mut self) -> io::Result<()> {
        for (_, item) in items(self.files)? {
            match item {
                Item::Channel(channel) => drop(self.is_played(&channel)),
                Item::Message(message) => {
                    self.first_ns = message.log_time;
                    break;
                }
                _ => {}
            }
        }
        std::thread::sleep(self.options.delay);
        Ok(())
    }

    /// Plays once through the files, from `start_ns` on.
    fn play_from(&mut self, start_ns: u64) -> io::Result<Ending> {
        let mut latched: BTreeMap<String, RecordedMessage> = BTreeMap::new();
        let mut has_begun = false;
        for item in self.readers(start_ns)?.into_iter().flatten() {
            let message = match item {
                Item::Message(message) => message,
                Item::Damage(_) => {
                    self.played.n_damages += 1;
                    continue;
                }
                _ => continue,
            };
            if !self.is_played(&message.channel) {
                continue;
            }
            let at_ns = message.log_time.saturating_sub(self.first_ns);
            if at_ns < start_ns {
                if is_latched(&message.channel) {
                    latched.insert(message.channel.topic.clone(), message);
                }
                if self.shutdown.is_requested() {
                    return Ok(Ending::Quit);
                }
                continue;
            }
            if self.options.end_ns.is_some_and(|end_ns| end_ns < at_ns) {
                break;
            }
            if !has_begun {
                self.begin(start_ns, &latched);
                has_begun = true;
            }
            if let Some(ending) = self.wait_for(at_ns) {
                return Ok(ending);
            }
            self.output.publish(&message);
            self.played.n_published += 1;
            self.count_step();
        }
        Ok(Ending::End)
    }

    /// Readers of all files, which skip messages before `start_ns`.
    fn readers(&mut self, start_ns: u64) -> io::Result<Vec<FileReader>> {
        let is_kept = |channel: &Channel| {
            self.is_open.get(&channel.topic).copied().unwrap_or(true) && is_latched(channel)
        };
        let files = self.files.iter().zip(&mut self.indexes);
        files
            .map(|(file, index)| {
                if start_ns == 0 {
                    return Reader::open(file);
                }
                match index.get_or_insert_with(|| Index::read(file)) {
                    Some(index) => {
                        let gaps = index.before(self.first_ns.saturating_add(start_ns), &is_kept);
                        Reader::open_with_gaps(file, index, gaps)
                    }
                    None => Reader::open(file),
                }
            })
            .collect()
    }

    /// Starts a part: moves the playhead and publishes the latched messages.
    fn begin(&mut self, start_ns: u64, latched: &BTreeMap<String, RecordedMessage>) {
        match &mut self.head {
            Some(head) => head.jump(start_ns),
            None => {
                let mut head = Playhead::start(start_ns, self.options.rate);
                head.set_paused(self.options.is_paused);
                self.head = Some(head);
            }
        }
        for message in latched.values() {
            self.output.publish(message);
            self.played.n_published += 1;
        }
    }

    /// Waits until a message is due, and handles commands meanwhile.
    fn wait_for(&mut self, at_ns: u64) -> Option<Ending> {
        loop {
            if let Some(ending) = self.handle_commands() {
                return Some(ending);
            }
            self.publish_time();
            if !self.bursts.is_empty() {
                self.is_step = true;
                self.head.as_mut()?.jump(at_ns);
                return None;
            }
            if self.head.as_ref()?.wait_for(at_ns) {
                return None;
            }
        }
    }

    fn handle_commands(&mut self) -> Option<Ending> {
        if self.shutdown.is_requested() {
            return Some(Ending::Quit);
        }
        while let Ok(CommandRequest { command, reply }) = self.commands.try_recv() {
            let head = self.head.as_mut()?;
            let is_paused = head.is_paused();
            let (mut is_done, mut ending) = (true, None);
            match command {
                PlayerCommand::Pause => head.set_paused(true),
                PlayerCommand::Resume => head.set_paused(false),
                PlayerCommand::Toggle => head.set_paused(!is_paused),
                PlayerCommand::Next | PlayerCommand::Burst(_)
                    if is_paused || command == PlayerCommand::Next =>
                {
                    head.set_paused(true);
                    let n = if let PlayerCommand::Burst(n) = command { n } else { 1 };
                    let n_left = if n == 0 { u64::MAX } else { n };
                    self.bursts.push_back(Burst { n_left, n_played: 0, reply });
                    continue;
                }
                PlayerCommand::Next | PlayerCommand::Burst(_) => is_done = false,
                PlayerCommand::Rate(rate) => head.set_rate(rate),
                PlayerCommand::Seek(to_ns) => ending = Some(Ending::Seek(to_ns)),
                PlayerCommand::SeekTo(time_ns) => {
                    is_done = self.last_ns().is_none_or(|last| time_ns <= last);
                    let to_ns = time_ns.saturating_sub(self.first_ns);
                    ending = is_done.then_some(Ending::Seek(to_ns));
                }
                PlayerCommand::Status => {}
                PlayerCommand::Quit => ending = Some(Ending::Quit),
            }
            self.send_status(reply.as_ref(), is_done, 0);
            if let Some(Ending::Seek(to_ns)) = ending {
                self.head.as_mut()?.jump(to_ns);
                self.clock_ns = None;
            }
            if ending.is_some() {
                return ending;
            }
        }
        None
    }

    /// Sends the status to the sender of a command.
    fn send_status(&self, reply: Option<&Sender<PlayerStatus>>, is_done: bool, n_played: u64) {
        let (Some(reply), Some(head)) = (reply, &self.head) else { return };
        let (is_paused, rate) = (head.is_paused(), head.rate());
        let status = PlayerStatus { is_done, is_paused, rate, n_played };
        // The receiver may be gone.
        let _ = reply.send(status);
    }

    /// Counts a published message, and ends its burst if it was the last.
    fn count_step(&mut self) {
        if !std::mem::take(&mut self.is_step) {
            return;
        }
        let Some(mut burst) = self.bursts.pop_front() else { return };
        burst.n_played += 1;
        burst.n_left -= 1;
        if burst.n_left == 0 {
            self.send_status(burst.reply.as_ref(), true, burst.n_played);
        } else {
            self.bursts.push_front(burst);
        }
    }

    /// Ends all bursts, because no messages are left.
    fn end_bursts(&mut self) {
        for burst in std::mem::take(&mut self.bursts) {
            self.send_status(burst.reply.as_ref(), 0 < burst.n_played, burst.n_played);
        }
    }

    /// Time of the recording's last message (ns), if all files have an index.
    fn last_ns(&mut self) -> Option<u64> {
        let files = self.files.iter().zip(&mut self.indexes);
        let ends = files.map(|(file, index)| {
            index.get_or_insert_with(|| Index::read(file)).as_ref().map(Index::last_ns)
        });
        ends.collect::<Option<Vec<_>>>()?.into_iter().max()
    }

    /// Publishes recorded time at the requested rate.
    fn publish_time(&mut self) {
        let (Some(rate_hz), Some(head)) = (self.options.clock_rate, &self.head) else { return };
        let now_ns = head.now_ns();
        #[expect(clippy::cast_possible_truncation, reason = "it saturates")]
        #[expect(clippy::cast_sign_loss, reason = "rates are above zero")]
        let period_ns = (1e9 * self.options.rate / rate_hz) as u64;
        if self.clock_ns.is_none_or(|last| last + period_ns <= now_ns || now_ns < last) {
            self.clock_ns = Some(now_ns);
            self.output.publish_clock(self.first_ns + now_ns);
        }
    }

    fn is_played(&mut self, channel: &Arc<Channel>) -> bool {
        if let Some(is_open) = self.is_open.get(&channel.topic) {
            return *is_open;
        }
        let is_selected = is_selected(&channel.topic, self.options);
        let is_open = is_selected && self.output.open(channel);
        if is_selected && !is_open {
            self.played.unplayable.push(channel.topic.clone());
        }
        self.is_open.insert(channel.topic.clone(), is_open);
        is_open
    }
}

fn is_selected(topic: &str, options: &Options) -> bool {
    let matches = |pattern: &String| match pattern.strip_suffix('*') {
        Some(start) => topic.starts_with(start),
        None => topic == pattern,
    };
    let is_own_clock = options.clock_rate.is_some() && topic == CLOCK;
    (options.topics.is_empty() || options.topics.iter().any(matches))
        && !options.exclude.iter().any(matches)
        && !is_own_clock
}

/// True for latched topics, whose last message late joiners receive.
pub fn is_latched(channel: &Channel) -> bool {
    channel.metadata.get("offered_qos_profiles").is_some_and(|qos| {
        crate::bag::metadata::qos_with_names(qos).contains("durability: transient_local")
    })
}
