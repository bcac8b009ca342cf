//! Publishes a recording again with its original timing: faster or slower, in part, over and over,
//! paused and wound by whoever gives the cues.
//!
//! Messages go out in the order of the files, each when its time has come. Late readers are served as
//! in the run itself: before the first message of a part, the last ones before it on latched topics
//! are published. What lies before a part is passed over where a file has an index.

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

use super::player_command::{Answer, Asked, PlayerCommand};
use crate::{
    bag::{
        index::Index,
        reader::{Channel, Item, Reader, Recorded, items},
    },
    host::{clock::Playhead, shutdown::Shutdown},
};

/// Topic of simulated time.
pub const CLOCK: &str = "/clock";

/// Where messages go.
pub trait PlayerOutput {
    /// A topic that messages will come on. False if it cannot be played.
    fn open(&mut self, channel: &Channel) -> bool;

    /// One message on an open topic.
    fn publish(&mut self, message: &Recorded);

    /// Recorded time, for those who want it more or less often than it was recorded.
    fn clock(&mut self, time_ns: u64);
}

/// What is played, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// How many times as fast as recorded.
    pub rate: f64,
    /// Where to begin, from the first message on (ns).
    pub start_ns: u64,
    /// Where to end, from the first message on (ns).
    pub end_ns: Option<u64>,
    /// True stands still at first.
    pub is_paused: bool,
    /// True begins again at the end.
    pub is_loop: bool,
    /// Only these topics; `*` at the end stands for any rest. Empty means all.
    pub topics: Vec<String>,
    /// Not these.
    pub exclude: Vec<String>,
    /// Time between announcing the topics and the first message, for readers to find them.
    pub delay: Duration,
    /// Publish recorded time this often in wall time, in place of the recorded clock (Hz).
    pub clock_rate: Option<f64>,
}

/// What was played.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Played {
    /// Messages published.
    pub n_published: u64,
    /// Topics that could not be played.
    pub refused: Vec<String>,
    /// Damages met.
    pub n_damages: u64,
}

/// Plays the files until the end, a cue, or `shutdown` ends it.
///
/// # Errors
/// If a file cannot be opened.
pub fn play(
    files: &[PathBuf],
    options: &Options,
    stage: &mut dyn PlayerOutput,
    cues: &Receiver<Asked>,
    shutdown: &Shutdown,
) -> io::Result<Played> {
    let mut player = Player {
        files,
        options,
        stage,
        cues,
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
    player.announce()?;
    let mut start_ns = options.start_ns;
    loop {
        let ending = player.pass(start_ns)?;
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
    reply: Option<Sender<Answer>>,
}

/// How one pass through the files ended.
enum Ending {
    End,
    Seek(u64),
    Quit,
}

struct Player<'a> {
    files: &'a [PathBuf],
    options: &'a Options,
    stage: &'a mut dyn PlayerOutput,
    cues: &'a Receiver<Asked>,
    shutdown: &'a Shutdown,
    head: Option<Playhead>,
    /// Time of the recording's first message (ns).
    first_ns: u64,
    /// Of each file, once it was looked for.
    indexes: Vec<Option<Option<Index>>>,
    /// Recorded time last told to the stage (ns).
    clock_ns: Option<u64>,
    /// Messages to play although it stands still.
    bursts: VecDeque<Burst>,
    /// True if the message to come is one of them.
    is_step: bool,
    /// Whether each topic is played.
    is_open: BTreeMap<String, bool>,
    played: Played,
}

impl Player<'_> {
    /// Opens the topics that are known before the first message, and waits for readers.
    fn announce(&mut self) -> io::Result<()> {
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

    /// Plays once through the files from `start_ns` on.
    fn pass(&mut self, start_ns: u64) -> io::Result<Ending> {
        let mut latched: BTreeMap<String, Recorded> = BTreeMap::new();
        let mut is_begun = false;
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
            if !is_begun {
                self.begin(start_ns, &latched);
                is_begun = true;
            }
            if let Some(ending) = self.wait_for(at_ns) {
                return Ok(ending);
            }
            self.stage.publish(&message);
            self.played.n_published += 1;
            self.count_step();
        }
        Ok(Ending::End)
    }

    /// Readers of all files that pass over what is before `start_ns`.
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
                        Reader::open_in_part(file, index, gaps)
                    }
                    None => Reader::open(file),
                }
            })
            .collect()
    }

    /// Sets the head to the start of a part and serves late readers.
    fn begin(&mut self, start_ns: u64, latched: &BTreeMap<String, Recorded>) {
        match &mut self.head {
            Some(head) => head.jump(start_ns),
            None => {
                let mut head = Playhead::start(start_ns, self.options.rate);
                head.set_paused(self.options.is_paused);
                self.head = Some(head);
            }
        }
        for message in latched.values() {
            self.stage.publish(message);
            self.played.n_published += 1;
        }
    }

    /// Waits until a message is due, and listens to cues meanwhile.
    fn wait_for(&mut self, at_ns: u64) -> Option<Ending> {
        loop {
            if let Some(ending) = self.listen() {
                return Some(ending);
            }
            self.tell_time();
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

    fn listen(&mut self) -> Option<Ending> {
        if self.shutdown.is_requested() {
            return Some(Ending::Quit);
        }
        while let Ok(Asked { command, reply }) = self.cues.try_recv() {
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
                PlayerCommand::Look => {}
                PlayerCommand::Quit => ending = Some(Ending::Quit),
            }
            self.answer(reply.as_ref(), is_done, 0);
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

    /// Tells whoever asked; nobody may listen any more.
    fn answer(&self, reply: Option<&Sender<Answer>>, is_done: bool, n_played: u64) {
        let (Some(reply), Some(head)) = (reply, &self.head) else { return };
        let (is_paused, rate) = (head.is_paused(), head.rate());
        let answer = Answer { is_done, is_paused, rate, n_played };
        // An asker that has gone needs no answer.
        let _ = reply.send(answer);
    }

    /// A message was published.
    fn count_step(&mut self) {
        if !std::mem::take(&mut self.is_step) {
            return;
        }
        let Some(mut burst) = self.bursts.pop_front() else { return };
        burst.n_played += 1;
        burst.n_left -= 1;
        if burst.n_left == 0 {
            self.answer(burst.reply.as_ref(), true, burst.n_played);
        } else {
            self.bursts.push_front(burst);
        }
    }

    /// Nothing is left to play at once: those who wait for it are told.
    fn end_bursts(&mut self) {
        for burst in std::mem::take(&mut self.bursts) {
            self.answer(burst.reply.as_ref(), 0 < burst.n_played, burst.n_played);
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

    /// Tells recorded time as often as asked for.
    fn tell_time(&mut self) {
        let (Some(rate_hz), Some(head)) = (self.options.clock_rate, &self.head) else { return };
        let now_ns = head.now_ns();
        #[expect(clippy::cast_possible_truncation, reason = "it saturates")]
        #[expect(clippy::cast_sign_loss, reason = "rates are above zero")]
        let period_ns = (1e9 * self.options.rate / rate_hz) as u64;
        if self.clock_ns.is_none_or(|told| told + period_ns <= now_ns || now_ns < told) {
            self.clock_ns = Some(now_ns);
            self.stage.clock(self.first_ns + now_ns);
        }
    }

    fn is_played(&mut self, channel: &Arc<Channel>) -> bool {
        if let Some(is_open) = self.is_open.get(&channel.topic) {
            return *is_open;
        }
        let is_chosen = is_chosen(&channel.topic, self.options);
        let is_open = is_chosen && self.stage.open(channel);
        if is_chosen && !is_open {
            self.played.refused.push(channel.topic.clone());
        }
        self.is_open.insert(channel.topic.clone(), is_open);
        is_open
    }
}

fn is_chosen(topic: &str, options: &Options) -> bool {
    let matches = |pattern: &String| match pattern.strip_suffix('*') {
        Some(start) => topic.starts_with(start),
        None => topic == pattern,
    };
    let is_own_clock = options.clock_rate.is_some() && topic == CLOCK;
    (options.topics.is_empty() || options.topics.iter().any(matches))
        && !options.exclude.iter().any(matches)
        && !is_own_clock
}

/// True for topics whose last message late readers get.
pub fn is_latched(channel: &Channel) -> bool {
    channel.metadata.get("offered_qos_profiles").is_some_and(|qos| {
        crate::bag::metadata::qos_in_words(qos).contains("durability: transient_local")
    })
}
